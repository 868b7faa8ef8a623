"""tools/damage/film.py: ways of damaging a film file (docs/film-files.md): its header's JSON, the heads, ranges and sums of its
blocks, or any bytes. Most damaged films get right sizes and CRCs: else nobody looks behind the first wrong one."""
import struct
import zlib

import mutate

PREAMBLE, HEAD = 24, 48
COUNTS = [0, 1, 2, 3, 31, 32, 33, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff, 1 << 16, (1 << 16) + 1]


def blocks_of(data):
    """Offset and length without CRC of each block, as far as they can be followed."""
    at, found = PREAMBLE + struct.unpack_from("<I", data, 12)[0], []
    while at + HEAD + 4 <= len(data):
        ranges, size = struct.unpack_from("<I", data, at + 4)[0], struct.unpack_from("<Q", data, at + 24)[0]
        length = HEAD + 8 * ranges + size
        if at + length + 4 > len(data):
            break
        found.append((at, length))
        at += length + 4
    return found


def repair(data):
    """CRCs of preamble, header and blocks."""
    data = bytearray(data)
    if len(data) < PREAMBLE or struct.unpack_from("<I", data, 12)[0] > len(data) - PREAMBLE:
        return bytes(data)
    size = struct.unpack_from("<I", data, 12)[0]
    struct.pack_into("<I", data, 16, zlib.crc32(data[PREAMBLE:PREAMBLE + size]))
    struct.pack_into("<I", data, 20, zlib.crc32(data[:20]))
    for at, length in blocks_of(data):
        struct.pack_into("<I", data, at + length, zlib.crc32(data[at:at + length]))
    return bytes(data)


def header(draw, data):
    size = struct.unpack_from("<I", data, 12)[0]
    text = mutate.json_text(draw, data[PREAMBLE:PREAMBLE + size])
    return data[:12] + struct.pack("<I", len(text)) + data[16:PREAMBLE] + text + data[PREAMBLE + size:]


def block(draw, data):
    """A block comes twice, is lost or changes its place; or its head, its ranges or its sums change."""
    found, data = blocks_of(data), bytearray(data)
    if not found:
        return bytes(data)
    at, length = draw.choice(found)
    whole, way = bytes(data[at:at + length + 4]), draw.randrange(8)
    if way == 0:
        data[at:at] = whole
    elif way == 1:
        del data[at:at + length + 4]
    elif way == 2:
        del data[at:at + length + 4]
        other, _ = draw.choice(found)
        data[min(other, len(data)):min(other, len(data))] = whole
    elif way < 5:
        struct.pack_into("<I", data, at + 4 * draw.randrange(min(length, HEAD + 16) // 4), draw.choice(COUNTS))
    elif way == 5:  # more ranges than there were
        more = b"".join(struct.pack("<II", draw.choice(COUNTS), draw.choice(COUNTS)) for _ in range(draw.choice([1, 2, 300])))
        struct.pack_into("<I", data, at + 4, struct.unpack_from("<I", data, at + 4)[0] + len(more) // 8)
        data[at + HEAD:at + HEAD] = more
    elif length > HEAD + 16:
        place = draw.randrange(at + HEAD + 8, at + length - 7)
        word = draw.choice([b"\xff" * 8, b"\0" * 7 + b"\x80", b"\xff" * 7 + b"\x7f", b"\0" * 8, bytes(draw.randrange(256) for _ in range(8))])
        data[place:place + 8] = word
    return bytes(data)


def damaged(draw, data):
    for _ in range(draw.choice([1, 1, 1, 2, 4])):
        way = draw.random()
        try:
            data = header(draw, data) if way < 0.45 else block(draw, data) if way < 0.85 else mutate.some_bytes(draw, data)
        except struct.error:  # too short by now
            break
    return repair(data) if draw.random() < 0.8 else data
