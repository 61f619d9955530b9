# SPDX-License-Identifier: MIT
"""The screen of an Xvfb started with -fbdir: that file is an X window dump (XWD version 7), which becomes a PNG here."""
import struct
import zlib
from pathlib import Path

HEADER = struct.Struct(">25I")  # X11/XWDFile.h, always most significant byte first
VERSION = 7
Z_PIXMAP = 2


class Picture:
    """8-bit RGB rows."""

    def __init__(self, width, height, rgb):
        self.width, self.height, self.rgb = width, height, rgb

    def distinct_colors(self, left, top, right, bottom):
        """Number of different colours in a part of the picture, edges in pixels."""
        colors = set()
        for row in range(top, bottom):
            begin = 3 * (row * self.width)
            colors.update(self.rgb[i:i + 3] for i in range(begin + 3 * left, begin + 3 * right, 3))
        return len(colors)

    def save(self, path):
        """Writes a PNG; the file appears when it is complete."""
        def chunk(name, data):
            return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

        row = 3 * self.width
        rows = b"".join(b"\0" + self.rgb[i:i + row] for i in range(0, len(self.rgb), row))
        head = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_name(path.name + ".part")
        chunks = chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b"")
        part.write_bytes(b"\x89PNG\r\n\x1a\n" + chunks)
        part.replace(path)


def read(path):
    """The picture in an X window dump of 32 bits a pixel; ValueError with the reason when it is something else."""
    dump = Path(path).read_bytes()
    if len(dump) < HEADER.size:
        raise ValueError(f"{path}: {len(dump)} bytes are no X window dump")
    header = HEADER.unpack_from(dump)
    size, version, pixmap, depth, width, height, _, byte_order, _, _, _, bits, stride = header[:13]
    red, green, blue, _, _, colors = header[14:20]
    layout = (version, pixmap, byte_order, bits, red, green, blue)
    if layout != (VERSION, Z_PIXMAP, 0, 32, 0xFF0000, 0x00FF00, 0x0000FF):
        raise ValueError(f"{path}: an X window dump that is not 32-bit BGRX (depth {depth}, layout {layout})")
    begin = size + 12 * colors
    if len(dump) < begin + height * stride:
        raise ValueError(f"{path}: {len(dump)} bytes, too short for {width} x {height} pixels")
    rgb = bytearray(3 * width * height)
    for row in range(height):
        bgrx = dump[begin + row * stride:begin + row * stride + 4 * width]
        line = slice(3 * width * row, 3 * width * (row + 1))
        part = bytearray(3 * width)
        part[0::3], part[1::3], part[2::3] = bgrx[2::4], bgrx[1::4], bgrx[0::4]
        rgb[line] = part
    return Picture(width, height, bytes(rgb))
