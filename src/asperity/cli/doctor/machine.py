"""What the program runs on: processors, accelerators, memory, disk."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any

from asperity.cli.stack import version_of

_PLUGINS = ("jax-cuda13-plugin", "jax-cuda12-plugin", "jax-rocm7-plugin", "jax-metal")
_SAYING = ("JAX_PLATFORMS", "XLA_FLAGS", "NPROC", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
_QUOTA = Path("/sys/fs/cgroup/cpu.max")
_MEMORY = Path("/proc/meminfo")


def machine() -> dict[str, Any]:
    """Processors, memory and disk as plain numbers; None for what cannot be told."""
    return {
        "processors": os.cpu_count(),
        "usable_processors": usable_processors(),
        "processor_quota": processor_quota(),
        "memory": _memory("MemTotal"),
        "available_memory": _memory("MemAvailable"),
        "disk_room": _room(),
        "environment": {name: os.environ[name] for name in _SAYING if name in os.environ},
    }


def usable_processors() -> int:
    """Processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def processor_quota(file: Path = _QUOTA) -> float | None:
    """Processors' time that a container may use, in processors; None without a limit.

    Parameters
    ----------
    file : Path
        Where Linux says it: the time and the period in microseconds, or "max".
    """
    try:
        time, period = file.read_text().split()
        return None if time == "max" else int(time) / int(period)
    except (OSError, ValueError):  # another system, or an older one
        return None


def devices() -> dict[str, Any]:
    """What JAX computes on, and why no GPU is among it."""
    from asperity._jax import jax

    found = jax.devices()
    gpus = [device.device_kind for device in found if device.platform != "cpu"]
    return {
        "backend": jax.default_backend(),
        "devices": [str(device) for device in found],
        "gpus": gpus,
        "without_gpu": None if gpus else why_no_gpu(),
    }


def why_no_gpu(hardware: bool | None = None, plugin: bool | None = None) -> str:
    """Why JAX has no GPU, in words.

    Parameters
    ----------
    hardware : bool, optional
        Whether the system shows one; looked for unless given.
    plugin : bool, optional
        Whether a build of JAX for GPUs is installed; looked for unless given.
    """
    if hardware is None:
        hardware = any(Path("/dev").glob("nvidia[0-9]*")) or Path("/dev/kfd").exists()
    if plugin is None:
        plugin = any(version_of(name) for name in _PLUGINS)
    asked = os.environ.get("JAX_PLATFORMS", "")
    if asked and hardware and plugin:
        return f"one is there, and JAX_PLATFORMS={asked} leaves it out"
    if hardware and plugin:
        return "one is there, but JAX cannot use it: the driver may be too old"
    if hardware:
        return "one is there, but this build of JAX is for processors alone"
    if plugin:
        return "the system shows none, though JAX could use one"
    return "the system shows none, and this build of JAX is for processors alone"


def _memory(name: str) -> int | None:
    """A figure of the system's memory [bytes]."""
    try:
        for line in _MEMORY.read_text().splitlines():
            key, _, value = line.partition(":")
            if key == name:
                return 1024 * int(value.split()[0])
    except (OSError, ValueError):  # no Linux
        pass
    if name == "MemTotal" and "SC_PHYS_PAGES" in getattr(os, "sysconf_names", {}):
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return None


def _room() -> int | None:
    """Room on the disk of the current folder [bytes]."""
    try:
        return shutil.disk_usage(".").free
    except OSError:
        return None
