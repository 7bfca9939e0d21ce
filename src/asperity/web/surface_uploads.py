"""Surface files that were dropped into the page: kept aside, read in a process of their own."""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
import sys
import tempfile
import threading
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from asperity.config import Case
from asperity.errors import InputError
from asperity.results.result import Curve, Result
from asperity.surfaces.files.content import digest
from asperity.web.upload_reader import SECONDS
from asperity.writing import told

Made = TypeVar("Made", bound=Result | Curve)

MOST_FILES = 16
"""Uploads that are kept; the one longest unused goes first."""

MOST_BYTES = 512 << 20
"""Their length together [bytes]."""

MOST_MAPS = 4
"""Maps that are kept of one upload, the newest: each size or unit of it makes another."""

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._ -]{0,79}")
_PATIENCE = SECONDS + 15.0


class Upload(NamedTuple):
    """A file that was dropped in, as its user knows it.

    Attributes
    ----------
    name
        Its name.
    sha256
        Of its content.
    notes
        What its reader has to say, a line each.
    """

    name: str
    sha256: str
    notes: tuple[str, ...]


class Surfaces:
    """Uploads by the hash of their content, in a folder that goes with this object.

    Nothing that a client sends becomes a path: a name serves as a name alone once it holds letters,
    digits, dots, blanks and dashes, and the folder's name is the hash that is computed here.
    """

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="asperity-", ignore_cleanup_errors=True)
        self._kept: OrderedDict[str, int] = OrderedDict()
        self._notes: dict[Path, tuple[str, ...]] = {}
        self._lock = threading.Lock()
        self._reading = threading.Semaphore(1)

    def close(self) -> None:
        """Remove every file."""
        self._folder.cleanup()

    def keep(self, name: str, content: bytes) -> str:
        """Keep a file; what to ask for it by.

        Raises
        ------
        InputError
            Where the name is none, or the file is empty.
        OutputError
            Where it cannot be kept.
        """
        if not _NAME.fullmatch(name):
            raise InputError(
                "a surface file's name must be of letters, digits, `.`, `-`, `_` and blanks, at "
                "most 80; rename the file"
            )
        if not content:
            raise InputError(f"{name}: the file is empty")
        token = hashlib.sha256(name.encode() + b"\0" + content).hexdigest()[:32]
        with self._lock:
            place = self._place(token)
            with told(name, "kept"):
                place.mkdir(exist_ok=True)
                (place / name).write_bytes(content)
            self._kept[token] = len(content)
            self._kept.move_to_end(token)
            self._make_room()
        return token

    def _place(self, token: str) -> Path:
        return Path(self._folder.name) / token

    def _make_room(self) -> None:
        while len(self._kept) > MOST_FILES or sum(self._kept.values()) > MOST_BYTES:
            token, _ = self._kept.popitem(last=False)
            place = self._place(token)
            for file in place.iterdir():
                file.unlink(missing_ok=True)
                self._notes.pop(file, None)
            place.rmdir()

    def resolved(self, case: Case, tokens: Mapping[str, str]) -> tuple[Case, dict[str, Upload]]:
        """The case with its files' names replaced by those of maps read from the uploads.

        Parameters
        ----------
        case
            The case; its ``roughness.files`` are names.
        tokens
            What :meth:`keep` gave, by name.

        Returns
        -------
        The case to compute, and for each path in it the upload.

        Raises
        ------
        InputError
            Where a name is of no upload, or a file cannot be read.
        """
        rough = case.roughness
        if rough is None or rough.files is None:
            return case, {}
        options = {"size": rough.map_size, "unit": rough.unit, "channel": rough.channel}
        paths, uploads = [], {}
        for name in rough.files:
            path, upload = self._map_of(name, tokens.get(name, ""), options)
            paths.append(str(path))
            uploads[str(path)] = upload
        changes = {"files": paths, "size": None, "unit": None, "channel": None}
        return case.model_copy(update={"roughness": rough.model_copy(update=changes)}), uploads

    def _map_of(self, name: str, token: str, options: dict[str, Any]) -> tuple[Path, Upload]:
        """The upload as a map in netCDF, read anew for each set of options."""
        with self._lock:
            if token not in self._kept:
                raise InputError(
                    f"`files` must name surface files that were dropped into this page; drop "
                    f"{name[:80]!r} in (again, if the server was started since)",
                    key="roughness.files",
                )
            self._kept.move_to_end(token)
            place = self._place(token)
            # No upload's name begins with a dot, and every map's does.
            source = next(file for file in place.iterdir() if not file.name.startswith("."))
        asked = json.dumps(options, sort_keys=True)
        target = place / f".{hashlib.sha256(asked.encode()).hexdigest()[:16]}.nc"
        with self._reading:
            notes = self._notes.get(target)
            if notes is None:
                notes = _notes(_read(source, target, asked), options)
                with self._lock:
                    self._notes[target] = notes
                    self._drop_old_maps(place)
        return target, Upload(source.name, digest(str(source)), notes)

    def _drop_old_maps(self, place: Path) -> None:
        for old in [target for target in self._notes if target.parent == place][:-MOST_MAPS]:
            old.unlink(missing_ok=True)
            del self._notes[old]


def _notes(found: dict[str, Any], options: dict[str, Any]) -> tuple[str, ...]:
    """What the reader said, and the channel it took where there was a choice."""
    notes = list(found["notes"])
    if options["channel"] is None and len(found["channels"]) > 1:
        notes.append(f"channel {found['channel']} was read, of {', '.join(found['channels'])}")
    return tuple(notes)


def _read(source: Path, target: Path, options: str) -> dict[str, Any]:
    """What a process of its own says of a file that it reads; killed where it takes too long."""
    command = [
        sys.executable,
        "-m",
        "asperity.web.upload_reader",
        str(source),
        str(target),
        options,
    ]
    try:
        done = subprocess.run(command, capture_output=True, timeout=_PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        raise _refusal(source, f"takes longer than {_PATIENCE:.0f} s to read") from None
    try:
        found: dict[str, Any] = json.loads(done.stdout)
    except ValueError:
        raise _refusal(source, "cannot be read: its reader failed on it") from None
    if "refusal" in found:
        raise InputError(
            str(found["refusal"]).replace(f"{source.parent}/", ""), key="roughness.files"
        )
    return found


def _refusal(source: Path, rule: str) -> InputError:
    return InputError(f"{source.name}: {rule}", key="roughness.files")


def renamed(result: Made, case: Case, uploads: Mapping[str, Upload]) -> Made:
    """A result, or a curve, with the user's own files in place of those of this server.

    Parameters
    ----------
    result
        Of the case that :meth:`Surfaces.resolved` gave.
    case
        The user's.
    uploads
        The user's files by path.
    """
    if not uploads or result.surface is None:
        return replace(result, case=case)
    files = [
        {**each, "file": uploads[each["file"]].name, "sha256": uploads[each["file"]].sha256}
        for each in result.surface["files"]
    ]
    notes = [f"{one.name}: {note}" for one in uploads.values() for note in one.notes]
    return replace(
        result,
        case=case,
        surface={**result.surface, "files": files},
        warnings=[*notes, *(retold(warning, uploads) for warning in result.warnings)],
    )


def retold(text: str, uploads: Mapping[str, Upload]) -> str:
    """A text with the user's own names of files."""
    for path, upload in uploads.items():
        text = text.replace(path, upload.name)
    return text
