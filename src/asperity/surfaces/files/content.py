"""What is in a file: its bytes, unpacked where it is packed, within bounds."""

from __future__ import annotations

import gzip
import hashlib
import io
import zlib
from pathlib import Path

from ...errors import InputError

MOST_BYTES = 2**32
"""Longest file read, unpacked [bytes]: a small packed file must not fill the memory."""

MOST_PIXELS = 2**28
"""Largest map read, 16384 x 16384 pixels: 2 GB of heights."""

_PACKED = ".gz"


def suffix_of(file: str) -> str:
    """The ending that names the format, in lower case: ``".csv"`` of ``"A.CSV.gz"``."""
    name = Path(file).name.lower()
    return Path(name.removesuffix(_PACKED)).suffix


def content_of(file: str) -> bytes:
    """The bytes of a file, unpacked if its name ends in ``.gz``.

    Raises
    ------
    InputError
        Where there is no such regular file, it cannot be read, it is empty, cut short while
        packed, or longer than `MOST_BYTES`.
    """
    path = Path(file)
    try:
        if not path.exists():
            raise refusal(file, "no such file; check the path")
        if not path.is_file():
            raise refusal(file, "must be a regular file; got a folder or a device; name a file")
        if path.stat().st_size > MOST_BYTES:
            raise _too_long(file)
        content = path.read_bytes()
    except InputError:
        raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise refusal(file, f"must be readable; got: {reason}; check its permissions") from None
    except ValueError:  # a zero byte in the name
        raise refusal(file, "no such file; check the path") from None
    if path.name.lower().endswith(_PACKED):
        content = _unpacked(content, file)
    if not content:
        raise refusal(file, "must hold a surface; got an empty file; export it again")
    return content


def digest(file: str) -> str:
    """SHA-256 of a file as it lies on the disk, packed or not.

    Raises
    ------
    InputError
        Where it cannot be read.
    """
    try:
        return hashlib.sha256(Path(file).read_bytes()).hexdigest()
    except OSError as error:
        raise refusal(file, f"cannot be read: {error.strerror}") from None


def refusal(file: str, rule: str) -> InputError:
    """The error that a file breaks a rule."""
    return InputError(f"{file}: {rule}", file=file)


def cut_short(file: str, what: str) -> InputError:
    """The error that a file ends too early or is damaged."""
    return refusal(file, f"must be whole; got {what}; copy or export it again")


def _unpacked(content: bytes, file: str) -> bytes:
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(content)) as packed:
            unpacked = packed.read(MOST_BYTES + 1)
    except (OSError, EOFError, zlib.error) as error:
        raise cut_short(file, f"a packed file that cannot be unpacked ({error})") from None
    if len(unpacked) > MOST_BYTES:
        raise _too_long(file)
    return unpacked


def _too_long(file: str) -> InputError:
    return refusal(
        file, f"must have at most {MOST_BYTES} bytes, unpacked; got more; cut a smaller map out"
    )
