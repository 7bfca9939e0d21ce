"""Make `.venv` from the hashed locks, or bring it up to date; the standard library alone.

`python tools/environment.py run` holds what the program needs, `dev` what the tests need too. What
was installed is noted inside `.venv` by content (hashes of the locks and of pyproject.toml), and
the note is taken away while something is being installed: an environment without a note is
half-made and made anew.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
import venv
from pathlib import Path

try:
    import fcntl
except ImportError:  # not a POSIX system: two makes at once are then not held apart
    fcntl = None  # type: ignore[assignment]

ROOT = Path(__file__).resolve().parents[1]
LOCKS = {"run": "requirements.lock", "dev": "requirements-dev.lock"}


def wanted(kind: str, root: Path = ROOT) -> dict[str, str]:
    """What the note of an up-to-date environment of this kind says.

    The dev lock holds everything that the run lock holds, so a dev environment is both.
    """
    kinds = ["run", "dev"] if kind == "dev" else ["run"]
    note = {name: _hash(root / LOCKS[name]) for name in kinds}
    note["package"] = _hash(root / "pyproject.toml")
    note["root"] = str(root)
    note["python"] = "{}.{}".format(*sys.version_info)
    return note


def steps(noted: dict[str, str] | None, wanted: dict[str, str]) -> list[str]:
    """What is left to do: of "make", "run" or "dev" (a lock), "package", in this order.

    Parameters
    ----------
    noted : dict or None
        The note found in the environment; None where there is none.
    wanted : dict
        The note that the environment should have.
    """
    lock = "dev" if "dev" in wanted else "run"
    if noted is None or any(noted.get(k) != wanted[k] for k in ("root", "python", "run")):
        return ["make", lock, "package"]
    if noted.get(lock, wanted[lock]) != wanted[lock]:
        return ["make", lock, "package"]
    left = [] if lock in noted else [lock]
    return left if noted.get("package") == wanted["package"] else [*left, "package"]


def main(kind: str) -> int:
    """Bring `.venv` up to date for this kind of work; 0 when it is."""
    with (ROOT / LOCKS["run"]).open() as held:
        if fcntl is not None:
            fcntl.flock(held, fcntl.LOCK_EX)
        place = ROOT / ".venv"
        target = wanted(kind)
        noted = _read(place)
        for step in steps(noted, target):
            _forget(place)
            _do(step, place)
            if step == "make":
                noted = {}
            noted = {**(noted or {}), **{k: target[k] for k in _told_by(step)}}
            if step != "make":
                _note(place).write_text(json.dumps(noted, indent=2) + "\n")
    return 0


def _do(step: str, place: Path) -> None:
    if step == "make":
        print(f"Making {place.name} with Python {sys.version.split()[0]}", flush=True)
        venv.EnvBuilder(with_pip=True, clear=True, symlinks=True).create(place)
    elif step == "package":
        _pip(place, "--no-deps", "--no-build-isolation", "--editable", str(ROOT))
    else:
        print(f"Installing {LOCKS[step]}", flush=True)
        _pip(place, "--require-hashes", "--requirement", str(ROOT / LOCKS[step]))


def _told_by(step: str) -> list[str]:
    return {
        "make": ["root", "python"],
        "run": ["run"],
        "dev": ["run", "dev"],
        "package": ["package"],
    }[step]


def _pip(place: Path, *arguments: str) -> None:
    quiet = ["--quiet", "--disable-pip-version-check", "--no-input"]
    python = str(place / "bin" / "python")
    subprocess.run([python, "-m", "pip", "install", *quiet, *arguments], check=True)


def _note(place: Path) -> Path:
    return place / "asperity-environment.json"


def _read(place: Path) -> dict[str, str] | None:
    python = place / "bin" / "python"
    try:
        noted = json.loads(_note(place).read_text())
        subprocess.run([python, "-c", "import pip"], check=True, capture_output=True)
    except (OSError, ValueError, subprocess.CalledProcessError):
        return None
    return noted if isinstance(noted, dict) else None


def _forget(place: Path) -> None:
    _note(place).unlink(missing_ok=True)


def _hash(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


if __name__ == "__main__":
    if sys.argv[1:] not in (["run"], ["dev"]):
        sys.exit("usage: environment.py run|dev")
    try:
        sys.exit(main(sys.argv[1]))
    except (OSError, subprocess.CalledProcessError) as error:
        said = (
            "pip failed, see above" if isinstance(error, subprocess.CalledProcessError) else error
        )
        sys.exit(f".venv could not be made: {said}")
    except KeyboardInterrupt:
        sys.exit(130)
