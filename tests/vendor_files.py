"""Tiny files of instruments' formats, written after their descriptions, byte by byte."""

import hashlib
import io
import struct
import zipfile

import numpy as np


def gwyddion(
    channels: dict[str, tuple[np.ndarray, str]], size: tuple[float, float], mask=None
) -> bytes:
    """A .gwy file (Gwyddion's user guide, "GWY file format") of named fields and their units.

    ``size`` is in metres; ``mask`` marks missing pixels of the first channel.
    """
    items = b""
    for number, (name, (values, unit)) in enumerate(channels.items()):
        items += _object(f"/{number}/data", "GwyDataField", _field(values, size, unit))
        items += _item(f"/{number}/data/title", b"s", name.encode() + b"\0")
    if mask is not None:
        items += _object("/0/mask", "GwyDataField", _field(mask.astype(float), size, ""))
    return b"GWYP" + _packed("GwyContainer", items)


def x3p(heights: np.ndarray, step: tuple[float, float]) -> bytes:
    """An .x3p file (ISO 25178-72): XML beside the heights [m], x fastest, NaN where missing."""
    rows, columns = heights.shape
    binary = heights.astype("<f8").tobytes()
    axis = "<{0}><AxisType>{1}</AxisType><DataType>{2}</DataType>{3}</{0}>"
    increment = "<Increment>{!r}</Increment><Offset>0.0</Offset>"
    main = (
        '<?xml version="1.0" encoding="UTF-8"?>'
        '<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1>'
        "<Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>"
        + axis.format("CX", "I", "D", increment.format(step[0]))
        + axis.format("CY", "I", "D", increment.format(step[1]))
        + axis.format("CZ", "A", "D", "")
        + "</Axes></Record1><Record3><MatrixDimension>"
        f"<SizeX>{columns}</SizeX><SizeY>{rows}</SizeY><SizeZ>1</SizeZ></MatrixDimension><DataLink>"
        "<PointDataLink>bindata/data.bin</PointDataLink>"
        f"<MD5ChecksumPointData>{hashlib.md5(binary).hexdigest()}</MD5ChecksumPointData>"
        "</DataLink></Record3></p:ISO5436_2>"
    )
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w") as archive:
        archive.writestr("main.xml", main)
        archive.writestr("bindata/data.bin", binary)
        archive.writestr("md5checksum.hex", hashlib.md5(main.encode()).hexdigest() + " *main.xml")
    return held.getvalue()


def _field(values: np.ndarray, size: tuple[float, float], unit: str) -> bytes:
    rows, columns = values.shape
    words = _item("unitstr", b"s", unit.encode() + b"\0")
    return (
        _item("xres", b"i", struct.pack("<i", columns))
        + _item("yres", b"i", struct.pack("<i", rows))
        + _item("xreal", b"d", struct.pack("<d", size[0]))
        + _item("yreal", b"d", struct.pack("<d", size[1]))
        + _object("si_unit_xy", "GwySIUnit", _item("unitstr", b"s", b"m\0"))
        + _object("si_unit_z", "GwySIUnit", words)
        + _item("data", b"D", struct.pack("<I", values.size) + values.astype("<f8").tobytes())
    )


def _item(name: str, kind: bytes, value: bytes) -> bytes:
    return name.encode() + b"\0" + kind + value


def _object(name: str, kind: str, content: bytes) -> bytes:
    return _item(name, b"o", _packed(kind, content))


def _packed(kind: str, content: bytes) -> bytes:
    return kind.encode() + b"\0" + struct.pack("<I", len(content)) + content
