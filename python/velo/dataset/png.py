"""Writes grey and colour PNG files of 8 and 16 bits (the PNG specification, 3rd edition)."""
from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy


def png(pixels: Any) -> bytes:
    """A PNG of an array of height x width (grey; bool: 0 and 255) or height x width x 3, uint8 or uint16."""
    array = numpy.asarray(pixels)
    if array.dtype == bool:
        array = array.astype("uint8") * 255
    height, width = array.shape[:2]
    depth, color = array.itemsize * 8, 2 if array.ndim == 3 else 0
    rows = array.astype(">u2" if depth == 16 else "u1").tobytes()
    stride = len(rows) // height

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    # Filter 0 (none) in front of every row.
    lines = b"".join(b"\0" + rows[y * stride:(y + 1) * stride] for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines, 3)) + chunk(b"IEND", b""))
