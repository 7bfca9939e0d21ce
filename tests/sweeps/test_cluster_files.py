"""The files for Slurm and Kubernetes: their commands compute every part of a study."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
CLUSTER = ROOT / "examples" / "cluster"
TASKS = 37


@pytest.fixture(name="programs")
def _programs(tmp_path: Path) -> dict[str, str]:
    """An environment in which ``asperity`` says how it was called."""
    program = tmp_path / "bin" / "asperity"
    program.parent.mkdir()
    program.write_text('#!/bin/sh\nprintf "%s\\n" "$@"\n')
    program.chmod(0o755)
    return {"PATH": f"{program.parent}:{os.environ['PATH']}", "TMPDIR": str(tmp_path)}


def said(command: list[str], env: dict[str, str], **more: str) -> list[str]:
    ran = subprocess.run(command, env=env | more, capture_output=True, text=True, check=True)
    return ran.stdout.splitlines()


def tasks_of(arguments: list[str]) -> list[int]:
    """Tasks that a command computes, by its ``--shard``."""
    number, parts = arguments[arguments.index("--shard") + 1].split("/")
    return list(range(int(number) - 1, TASKS, int(parts)))


def documents(name: str) -> list[dict[str, Any]]:
    return list(yaml.safe_load_all((CLUSTER / name).read_text()))


def container(name: str) -> dict[str, Any]:
    (job,) = (each for each in documents(name) if each["kind"] == "Job")
    (found,) = job["spec"]["template"]["spec"]["containers"]
    return found


def test_the_jobs_of_the_array_compute_each_task_once(programs: dict[str, str]):
    script = CLUSTER / "slurm.sh"
    found = re.search(r"^#SBATCH --array=1-(\d+)$", script.read_text(), re.MULTILINE)
    assert found is not None
    tasks = []
    for number in range(1, int(found[1]) + 1):
        arguments = said(
            ["bash", str(script), "a study.toml"], programs, SLURM_ARRAY_TASK_ID=str(number),
            SLURM_ARRAY_TASK_MAX=found[1], SLURM_CPUS_PER_TASK="4",
        )  # fmt: skip
        assert arguments[:3] == ["sweep", "a study.toml", "--resume"]
        assert arguments[arguments.index("--workers") + 1] == "4"
        tasks += tasks_of(arguments)
    assert sorted(tasks) == list(range(TASKS))
    # Some jobs again: the array has fewer, the parts are as many as were.
    again = said(
        ["bash", str(script), "study.toml", "16"], programs, SLURM_ARRAY_TASK_ID="3",
        SLURM_ARRAY_TASK_MAX="7", SLURM_CPUS_PER_TASK="4",
    )  # fmt: skip
    assert tasks_of(again) == list(range(2, TASKS, 16))


def test_the_script_needs_a_study(programs: dict[str, str]):
    ran = subprocess.run(
        ["bash", str(CLUSTER / "slurm.sh")], env=programs, capture_output=True, check=False
    )
    assert ran.returncode != 0
    assert b"usage" in ran.stderr


def test_the_indices_of_the_job_compute_each_task_once(programs: dict[str, str]):
    (job,) = (each for each in documents("kubernetes.yaml") if each["kind"] == "Job")
    assert job["spec"]["completionMode"] == "Indexed"
    pod = container("kubernetes.yaml")
    variables = {each["name"]: each["value"] for each in pod["env"]}
    assert pod["resources"]["limits"]["cpu"] == variables["WORKERS"]
    tasks = []
    for index in range(job["spec"]["completions"]):
        command = [*pod["command"], *pod["args"]]
        tasks += tasks_of(said(command, programs | variables, JOB_COMPLETION_INDEX=str(index)))
    assert sorted(tasks) == list(range(TASKS))


def test_the_merging_job_takes_every_store_from_the_volume_of_the_others(
    programs: dict[str, str], tmp_path: Path
):
    for number in range(1, 4):
        (tmp_path / f"study.{number}-of-3.zarr").mkdir()
        (tmp_path / f"study.{number}-of-3.zarr.manifest").touch()
    pod = container("kubernetes-merge.yaml")
    ran = subprocess.run(
        [*pod["command"], *pod["args"]],
        env=programs, cwd=tmp_path, capture_output=True, text=True, check=True,
    )  # fmt: skip
    stores = [f"study.{number}-of-3.zarr" for number in range(1, 4)]
    assert ran.stdout.split() == ["merge", *stores, "--force"]
    (volume,) = (each for each in pod["volumeMounts"] if each["name"] == "stores")
    assert volume in container("kubernetes.yaml")["volumeMounts"]
    assert volume["mountPath"] == pod["workingDir"] == container("kubernetes.yaml")["workingDir"]
