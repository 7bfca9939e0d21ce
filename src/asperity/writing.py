"""Writing a file: whole or not at all, and in one line why it cannot be."""

from __future__ import annotations

import contextlib
import csv
import errno
import io
import os
import secrets
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

from asperity.errors import InputError, OutputError

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@contextlib.contextmanager
def told(
    path: str | os.PathLike[str], done: str = "written", *, if_full: str = ""
) -> Iterator[None]:
    """Failures of the system as `OutputError`, with the path and the reason.

    Parameters
    ----------
    path
        What is being written.
    done
        What cannot be done with it, as a participle.
    if_full
        What to do about a full disk, after the reason.
    """
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        reason = error.strerror or str(error)
        remedy = if_full * (error.errno in _FULL)
        raise OutputError(
            f"{path}: cannot be {done}: {reason}{remedy}", path=os.fspath(path)
        ) from error


def csv_of(heads: Iterable[str], rows: Iterable[Iterable[object]], about: str = "") -> bytes:
    """A table as CSV: lines about it, the heads of its columns, its rows."""
    text = io.StringIO()
    text.write(about)
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(rows)
    return text.getvalue().encode()


def ending_of(target: Path, endings: Collection[str], found: str | None = None) -> str:
    """The ending of a file, in lower case, refused where it is none of these.

    Parameters
    ----------
    target
        The file to come.
    endings
        Those that it may have.
    found
        Its ending, where the last one of its name does not count, as ``.gz`` does not.

    Raises
    ------
    InputError
        Where its ending is another.
    """
    found = target.suffix.lower() if found is None else found
    if found not in endings:
        raise InputError(
            f"{target}: must end in {'one of ' * (len(endings) > 1)}{' '.join(endings)}; "
            f"got {found or 'no ending'!r}",
            file=str(target),
        )
    return found


def check_file(target: Path, *, force: bool) -> None:
    """See to it, before anything is computed, that a file can be written.

    Parameters
    ----------
    target
        The file to come.
    force
        Whether one that is there may be replaced.

    Raises
    ------
    InputError
        Where it is there and ``force`` is not set.
    OutputError
        Where it cannot be written.
    """
    with told(target):
        if target.is_dir():
            raise IsADirectoryError("Is a directory")
        refuse_present(target, force=force)
        trial = _beside(target)
        trial.touch()
        trial.unlink()


def refuse_present(target: Path, *, force: bool) -> None:
    """Refuse a file that is there already.

    Raises
    ------
    InputError
        Where it is, and ``force`` is not set.
    """
    if target.exists() and not force:
        raise InputError(
            f"{target}: must not be there yet; got a file; use --force to replace it",
            file=str(target),
        )


@contextlib.contextmanager
def aside(target: Path, *, force: bool) -> Iterator[Path]:
    """A path beside the target to write to, which takes the target's place if all goes well.

    Parameters
    ----------
    target, force
        As `check_file`.

    Raises
    ------
    InputError, OutputError
        As `check_file`.
    """
    check_file(target, force=force)
    path = _beside(target)
    with told(target):
        try:
            yield path
            path.replace(target)
        finally:
            with contextlib.suppress(OSError):
                path.unlink(missing_ok=True)


def _beside(target: Path) -> Path:
    return target.with_name(f".{target.name}.{secrets.token_hex(4)}")
