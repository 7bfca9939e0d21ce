"""Where the pages that are run work: a fresh folder, with the examples that they use."""

import atexit
import os
import shutil
import sys
import tempfile
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def enter(*examples: str) -> None:
    """Make a folder with copies of examples the working directory, and `asperity` a command.

    The examples lie there as they lie in `examples`.
    The console script stands beside the interpreter, which `make` calls by its path.
    """
    folder = tempfile.mkdtemp(prefix="asperity-page-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for name in examples:
        copy = Path(folder, name)
        copy.parent.mkdir(exist_ok=True)
        shutil.copyfile(EXAMPLES / name, copy)
    os.chdir(folder)
    program = str(Path(sys.executable).parent)
    os.environ["PATH"] = program + os.pathsep + os.environ["PATH"]
    os.environ["COLUMNS"] = "80"
