"""Where the pages that are run work: a fresh folder, with the examples that they use."""

import atexit
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from IPython import get_ipython

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def enter(*examples: str) -> None:
    """Make a folder with copies of examples the working directory, and `%%console` a magic.

    The examples lie there as they lie in `examples`.
    """
    folder = tempfile.mkdtemp(prefix="asperity-page-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for name in examples:
        copy = Path(folder, name)
        copy.parent.mkdir(exist_ok=True)
        shutil.copyfile(EXAMPLES / name, copy)
    os.chdir(folder)
    get_ipython().register_magic_function(console, "cell")


def console(line: str, commands: str) -> None:
    """Run shell commands and print what they say; the first that fails ends the page.

    IPython's own `%%bash` gives the output in pieces that end within lines. The command `asperity`
    stands beside the interpreter, which `make` calls by its path.
    """
    program = str(Path(sys.executable).parent)
    told = {
        "PATH": program + os.pathsep + os.environ["PATH"],
        "COLUMNS": "80",
        "TF_CPP_MIN_LOG_LEVEL": "3",  # on a slow machine XLA complains of the time it takes
    }
    ran = subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", commands],
        env={**os.environ, **told},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    sys.stdout.write(ran.stdout)
    ran.check_returncode()
