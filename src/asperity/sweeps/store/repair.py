"""A store that is there already: its metadata written again, or the whole of it removed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from asperity.errors import InputError
from asperity.sweeps.store.array import (
    METADATA,
    metadata,
    other_study,
    read_array,
    read_group,
    refuse_other_cut,
    same,
    stored,
)
from asperity.sweeps.store.manifest import Manifest, manifest_of
from asperity.sweeps.store.whole_files import beside, clear, put, told

if TYPE_CHECKING:
    from asperity.sweeps.study.study import Study


def mend(path: str | Path, study: Study) -> list[str]:
    """Write metadata of a study's store again where they are not what they were.

    Returns
    -------
    list of str
        The files that were written.

    Raises
    ------
    InputError
        Where neither the store nor its manifest says that it is this study's, or another version
        of this program cut it into other tasks.
    OutputError
        Where they cannot be written, or another process writes the store.
    """
    path = Path(path)
    manifest = Manifest.read(file) if (file := manifest_of(path)).exists() else None
    known = manifest or read_group(path)
    if known.fingerprint != study.fingerprint:
        raise other_study(path)
    files = metadata(study)
    for column in stored(study):
        _refuse_other_cut(path / column.name / METADATA, study)
    wrong = {name: content for name, content in files.items() if not same(path / name, content)}
    try:
        if manifest is not None:
            manifest.hold()
        for name, content in wrong.items():
            with told(path / name):
                (path / name).parent.mkdir(parents=True, exist_ok=True)
            put(path / name, content, beside(path, ".part"))
    finally:
        if manifest is not None:
            manifest.end()
    return [str(path / name) for name in wrong]


def _refuse_other_cut(file: Path, study: Study) -> None:
    """Refuse to write metadata over those of chunks of another size."""
    try:
        array = read_array(file, len(study.shape))
    except InputError:
        return
    refuse_other_cut(file, array, study)


def remove(path: str | Path) -> None:
    """Remove a store and its manifest.

    Raises
    ------
    InputError
        Where something else is there.
    OutputError
        Where it cannot be removed, or another process writes it.
    """
    path = Path(path)
    file = manifest_of(path)
    if not path.exists() and not path.is_symlink():
        return
    if file.exists():
        held = Manifest.read(file)
        held.hold()
        held.end()
    else:
        read_group(path)
    with told(path):
        clear(path)
        file.unlink(missing_ok=True)
