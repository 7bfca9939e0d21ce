"""The program with studies of numbers that cost nothing; for tests of stores, kills and commands.

``python fake_sweep.py ARGUMENTS...`` is ``asperity ARGUMENTS...`` with such studies: their file
holds the fields of a `fake_study.FakeStudy`.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import fake_study
from asperity.cli import main
from asperity.sweeps.compute import clients

if __name__ == "__main__":
    sys.modules["asperity.sweeps.study.study"] = fake_study
    sys.modules["asperity.sweeps.compute.batch"] = fake_study
    clients.PATIENCE = 2.0  # s: a scheduler on this machine answers sooner, or never
    main()
