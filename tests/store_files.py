"""The files of a store: what they hold, and damage to one."""

from __future__ import annotations

from pathlib import Path


def contents(path: Path) -> dict[str, bytes]:
    """Every file of a store and of what stands beside it, the log apart."""
    files = [*path.rglob("*"), *path.parent.glob(f"{path.name}.*")]
    return {
        str(file.relative_to(path.parent)).removeprefix(path.name): file.read_bytes()
        for file in files
        if file.is_file() and file.suffix != ".log"
    }


def flip(file: Path) -> None:
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)
