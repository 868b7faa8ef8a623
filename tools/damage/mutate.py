"""tools/damage/mutate.py: ways of damaging a file, by the form it has: text of scenes, JSON, GLB, PLY, plain bytes. Every
function takes the draw (random.Random) and bytes, and returns other bytes."""
import copy
import gzip
import json
import re
import struct
import zlib

NUMBERS = ["-1", "0", "nan", "inf", "-inf", "1e308", "-1e308", "1e39", "1e999", "1e-320", "4294967295", "4294967296", "2147483647",
           "-2147483648", "99999999999999999999", "1000000000", "0x10", "1e", "--1", "1.2.3", "1,5", "0.1", "1e10", "3"]


def some_bytes(draw, data):
    """Bits, runs, cuts, pieces twice or not at all, telling numbers: for whatever has no form, or whose form shall break."""
    data = bytearray(data)
    ways = draw.choice([[0, 1, 5, 6, 7, 8], range(9)])  # as long as it was, or not
    for _ in range(draw.choice([1, 1, 2, 4, 12])):
        if not data:
            break
        # headers are small and matter most
        at = draw.randrange(min(len(data), 256)) if draw.random() < 0.4 else draw.randrange(len(data))
        length = min(draw.choice([1, 2, 4, 8, 40, 400]), len(data) - at)
        way = draw.choice(ways)
        if way == 0:
            data[at] ^= 1 << draw.randrange(8)
        elif way == 1:
            data[at] = draw.randrange(256)
        elif way == 2:
            del data[at:]
        elif way == 3:
            del data[at:at + length]
        elif way == 4:
            data[at:at] = data[at:at + length]
        elif way == 5:
            data[at:at + length] = bytes([draw.choice([0, 255, 127, 128])]) * length
        elif way == 6:
            value = draw.choice([0, 1, 0xffffffff, 0x7fffffff, 0x80000000, 0x10000, 0xffff, 0x40000000])
            data[at:at + 4] = struct.pack(draw.choice("<>") + "I", value)
        elif way == 7:
            data[at:at + 4] = struct.pack(draw.choice("<>") + "f", draw.choice([float("nan"), float("inf"), -1e38, 3e38, 1e-45, -0.0]))
        else:
            other = draw.randrange(len(data))
            a, b = data[at:at + length], data[other:other + length]
            data[at:at + length], data[other:other + length] = b, a
    return bytes(data)


def image(draw, data):
    """An image's bytes. A PNG gets right sums over its chunks half the time: else nobody looks behind the first wrong one."""
    data = bytearray(some_bytes(draw, data))
    if data[:4] == b"\x89PNG" and draw.random() < 0.5:
        at = 8
        while at + 12 <= len(data):
            end = at + 8 + struct.unpack_from(">I", data, at)[0]
            if end + 4 > len(data):
                break
            struct.pack_into(">I", data, end, zlib.crc32(data[at + 4:end]))
            at = end + 4
    return bytes(data)


def number(draw, text):
    """One number becomes another."""
    spans = [m.span() for m in re.finditer(rb"[-+]?[0-9]+\.?[0-9]*(?:[eE][-+]?[0-9]+)?", text)]
    if not spans:
        return text
    a, b = draw.choice(spans)
    return text[:a] + draw.choice(NUMBERS).encode() + text[b:]


def swap(draw, text, pattern):
    spans = [m.span() for m in re.finditer(pattern, text)]
    if len(spans) < 2:
        return text
    (a, b), (c, d) = sorted(draw.sample(spans, 2))
    return text[:a] + text[c:d] + text[b:c] + text[a:b] + text[d:]


def lines(draw, text):
    """A line is lost, comes twice, or changes its place."""
    rows = text.split(b"\n")
    i, way = draw.randrange(len(rows)), draw.randrange(4)
    if way == 0:
        del rows[i]
    elif way == 1:
        rows.insert(i, rows[i])
    elif way == 2:
        row = rows.pop(i)
        rows.insert(draw.randrange(len(rows) + 1), row)
    else:
        rows[i:i] = [rows[i]] * draw.choice([10, 1000])
    return b"\n".join(rows)


def letters(draw, text):
    """A word is misspelt."""
    spans = [m.span() for m in re.finditer(rb"[A-Za-z_]{3,}", text)]
    if not spans:
        return text
    a, b = draw.choice(spans)
    word = bytearray(text[a:b])
    i, way = draw.randrange(len(word)), draw.randrange(4)
    if way == 0:
        del word[i]
    elif way == 1:
        word.insert(i, word[i])
    elif way == 2:
        word[i] = draw.randrange(97, 123)
    else:
        word[i:i + 2] = word[i:i + 2][::-1]
    return text[:a] + bytes(word) + text[b:]


def insert(draw, text, words):
    at = draw.choice([m.start() for m in re.finditer(rb"\s", text)] or [0])
    return text[:at] + b" " + draw.choice(words) + b" " + text[at:]


def scene_words(name):
    deep = 20000
    return [b"\"", b"[", b"]", b"\0", b"\xff\xfe", b"#", b"Include \"%s\"" % name, b"Import \"%s\"" % name, b"Include \".\"",
            b"WorldBegin", b"AttributeBegin", b"AttributeEnd", b"ObjectEnd", b"AttributeBegin " * deep,
            b"AttributeBegin " * deep + b"AttributeEnd " * deep, b"[ " * deep, b"ObjectBegin \"a\" ObjectInstance \"a\" ObjectEnd",
            b"ObjectBegin \"a\" ObjectInstance \"b\" ObjectEnd ObjectBegin \"b\" ObjectInstance \"a\" ObjectEnd ObjectInstance \"a\"",
            b"ReverseOrientation", b"Identity", b"Scale 0 0 0", b"Scale 1e30 1e-30 1", b"Scale 1e20 1e20 1e20", b"Translate 1e38 1e38 1e38",
            b"Rotate 1e308 1 0 0", b"Rotate 90 0 0 0", b"Transform [ 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 ]",
            b"ConcatTransform [ 1 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1 ]", b"LookAt 0 0 0 0 0 0 0 0 0", b"ActiveTransform EndTime",
            b"TransformTimes 1 1", b"TransformTimes 1 0", b"CoordSysTransform \"nowhere\"", b"MediumInterface \"a\" \"b\"",
            b"Shape \"sphere\" \"float radius\" [ " + b"1 " * 100000 + b"]", b"Shape \"sphere\" \"float radius\" [ ]",
            b"\"string " + b"x" * 70000 + b"\" [ \"y\" ]", b"Texture \"t\" \"spectrum\" \"mix\" \"texture tex1\" \"t\"",
            b"Material \"mix\" \"string materials\" [ \"m\" \"m\" ]", b"NamedMaterial \"m\"",
            b"MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [ \"m\" \"m\" ]",
            b"Shape \"loopsubdiv\" \"integer levels\" 30 \"integer indices\" [ 0 1 2 ] \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]",
            b"Shape \"trianglemesh\" \"integer indices\" [ 0 1 4294967295 ] \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]",
            b"Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 ] \"integer splitdepth\" 30", b"Shape \"sphere\" \"float radius\" -1",
            b"AreaLightSource \"diffuse\" \"float scale\" 1e38", b"LightSource \"infinite\" \"float scale\" 1e38",
            b"LightSource \"distant\" \"point3 from\" [ 0 0 0 ] \"point3 to\" [ 0 0 0 ]", b"Option \"seed\" 1e99",
            b"Material \"dielectric\" \"float eta\" 0", b"Material \"dielectric\" \"float eta\" -1.5",
            b"MakeNamedMedium \"h\" \"string type\" \"uniformgrid\" \"integer nx\" 100000 \"integer ny\" 100000 \"integer nz\" 100000",
            b"\"float %s\" 1" % (b"a" * 3000), b"\x1f\x8b\x08", b"\r", b"/* */", b"$ { } ;"]


def scene(draw, text, name):
    """Text of a pbrt scene."""
    words = scene_words(name.encode())
    for _ in range(draw.choice([1, 1, 1, 2, 3])):
        way = draw.randrange(12)
        if way < 3:
            text = number(draw, text)
        elif way == 3:
            text = swap(draw, text, rb"\"[^\"\n]*\"")
        elif way == 4:
            text = swap(draw, text, rb"[-+]?[0-9.]+")
        elif way == 5:
            text = lines(draw, text)
        elif way == 6:
            text = letters(draw, text)
        elif way < 10:
            text = insert(draw, text, words)
        elif way == 10:
            text = swap(draw, text, rb"\[[^\]]*\]")
        else:
            text = some_bytes(draw, text)
    return text


def plain_text(draw, text):
    """Lists of numbers and words: OBJ, MTL, spectra, lenses, poses, YAML, XML."""
    words = [b"\"", b"-", b"\0", b"\xff", b"nan", b"1e999", b"-1", b"0", b"999999999999", b"{", b"[", b"[" * 5000, b"<a>" * 5000, b"&lt;",
             b"<!DOCTYPE a [<!ENTITY b \"c\">]>", b"&b;", b"*x", b"&x", b"!!binary", b"'", b"\r\n", b"\t", b",,,", b"x" * 70000, b"/", b"//", b"\\\n"]
    for _ in range(draw.choice([1, 1, 2, 3])):
        way = draw.randrange(8)
        if way < 2:
            text = number(draw, text)
        elif way == 2:
            text = swap(draw, text, rb"[-+]?[0-9.]+")
        elif way == 3:
            text = lines(draw, text)
        elif way == 4:
            text = letters(draw, text)
        elif way == 5:
            text = insert(draw, text, words)
        elif way == 6:
            text = swap(draw, text, rb"[A-Za-z_]+")
        else:
            text = some_bytes(draw, text)
    return text


# ---- JSON -----------------------------------------------------------------------------------------------------------

VALUES = [None, True, False, 0, -1, 1, 2, 0.5, 3, 255, 65535, 5121, 5126, 1e308, -1e308, 1e39, 1e-320, 2147483647, 2147483648, 4294967295,
          9007199254740993, -9223372036854775808, "", "a", "x" * 70000, "../../../../etc/passwd", "data:,", "data:image/png;base64,!!",
          "data:application/octet-stream;base64,AAAA", "%00", "%zz", "a\u0000b", "\ud83d\ude00", [], {}, [[]], [0] * 1000, [0, 0, 0], [1, 1],
          {"": {}}, ["a"], [None], "MAT4", "SCALAR", "VEC3", "BLEND", "POSITION", "file:///dev/zero", "/dev/zero", "."]


def places(node, found):
    for key in (node if isinstance(node, dict) else range(len(node)) if isinstance(node, list) else ()):
        found.append((node, key))
        places(node[key], found)


def json_tree(draw, tree):
    tree = copy.deepcopy(tree)
    for _ in range(draw.choice([1, 1, 1, 2, 4])):
        found = []
        places(tree, found)
        if not found:
            break
        # long lists of numbers are not where mistakes live
        telling = [f for f in found if not (isinstance(f[0], list) and len(f[0]) > 4 and isinstance(f[0][f[1]], (int, float)))]
        node, key = draw.choice(telling or found)
        value, way = node[key], draw.randrange(10)
        numeric = isinstance(value, (int, float)) and not isinstance(value, bool)
        if way == 0:
            del node[key]
        elif way == 1 or (way < 6 and not numeric):
            node[key] = copy.deepcopy(draw.choice(VALUES))
        elif way == 2:
            node[key] = value + draw.choice([-1, 1, 2, -value, 1000])
        elif way in (3, 4):
            node[key] = draw.choice([v for v in VALUES if isinstance(v, (int, float)) and not isinstance(v, bool)])
        elif way == 5:
            node[key] = draw.choice([value * 1e30, -value, value * 4, int(value) + (1 << 32), int(value) + (1 << 62)])
        elif way == 6:
            if isinstance(node, list):
                node[key:key] = [copy.deepcopy(value)] * draw.choice([1, 3, 300])
            else:
                node[draw.choice(["a", key + "s", key.upper(), key[:-1] or "b"])] = node.pop(key)
        elif way == 7:
            other, there = draw.choice(telling or found)
            node[key], other[there] = copy.deepcopy(other[there]), copy.deepcopy(value)
        elif way == 8 and isinstance(tree.get("nodes") if isinstance(tree, dict) else None, list) and tree["nodes"]:
            some = draw.choice(tree["nodes"])
            if isinstance(some, dict):
                some["children"] = [draw.randrange(len(tree["nodes"])) for _ in range(draw.choice([1, 2, 50]))]
        else:
            other = draw.choice(telling or found)
            node[key] = copy.deepcopy(other[0][other[1]])
    return tree


def json_text(draw, text):
    """The text of a JSON file: its structure mostly, its letters sometimes."""
    if not text:  # an earlier damage has cut it off
        return text
    if draw.random() < 0.8:
        try:
            return json.dumps(json_tree(draw, json.loads(text)), separators=(",", ":")).encode()
        except (ValueError, RecursionError, OverflowError):
            pass
    way = draw.randrange(7)
    if way == 0:
        at = text.find(b"{", draw.randrange(len(text))) + 1
        return text[:at] + b'"deep":' + b"[" * 100000 + (b"]" * 100000 if draw.random() < 0.5 else b"") + b"," + text[at:]
    if way == 1:
        return number(draw, text)
    if way == 2:
        return swap(draw, text, rb"\"[^\"\n]{1,60}\"")
    if way == 3:
        return b"\xef\xbb\xbf" + text
    if way == 4:
        return insert(draw, text, [b"NaN", b"1e999", b"//", b"\"", b",", b"}", b"\0", b"{\"a\":1,\"a\":2}", b"\"\\ud800\"", b"\xff"])
    return some_bytes(draw, text)


def receipt(draw, data):
    """An image with another receipt in its header: damaged JSON, and now and then damaged bytes of the whole."""
    name = b"velo.receipt\0string\0"
    at = data.index(name) + len(name)
    size = struct.unpack_from("<I", data, at)[0]
    text = json_text(draw, data[at + 4:at + 4 + size])
    end = at + 4 + size  # the other attributes follow, then a zero, then the table of offsets
    while data[end]:
        kind = data.index(b"\0", end) + 1
        value = data.index(b"\0", kind) + 1
        end = value + 4 + struct.unpack_from("<I", data, value)[0]
    first = struct.unpack_from("<Q", data, end + 1)[0]
    count = (first - end - 1) // 8
    table = [o + len(text) - size for o in struct.unpack_from("<%dQ" % count, data, end + 1)]
    whole = data[:at] + struct.pack("<I", len(text)) + text + data[at + 4 + size:end + 1] + struct.pack("<%dQ" % count, *table) + data[first:]
    return some_bytes(draw, whole) if draw.random() < 0.1 else whole


def glb(draw, data):
    """A GLB: its JSON with the right lengths around it, its binary part, or its headers."""
    length = struct.unpack_from("<I", data, 12)[0]
    text, rest = data[20:20 + length].rstrip(b" \0"), data[20 + length:]
    way = draw.random()
    if way < 0.6:
        text = json_text(draw, text)
    elif way < 0.85 and len(rest) > 8:
        rest = rest[:8] + some_bytes(draw, rest[8:])
    else:
        return some_bytes(draw, data[:40]) + data[40:] if draw.random() < 0.5 else some_bytes(draw, data)
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4e4f534a) + text + rest


def packed(draw, data):
    """A gzip stream: damaged inside or outside."""
    if draw.random() < 0.5:
        return gzip.compress(some_bytes(draw, gzip.decompress(data)), mtime=0)
    return some_bytes(draw, data)


def ply(draw, data):
    """A PLY: the header's words and numbers, or what follows."""
    end = data.find(b"end_header")
    if end < 0 or draw.random() < 0.4:
        return some_bytes(draw, data)
    head, body = data[:end], data[end:]
    way = draw.randrange(7)
    if way == 0:
        head = number(draw, head)
    elif way == 1:
        head = lines(draw, head)
    elif way == 2:
        head = letters(draw, head)
    elif way == 3:
        kinds = [b"char", b"uchar", b"short", b"ushort", b"int", b"uint", b"float", b"double", b"list uchar int", b"list uint int"]
        spans = [m.span(1) for m in re.finditer(rb"property (list \w+ \w+|\w+)", head)]
        if spans:
            a, b = draw.choice(spans)
            head = head[:a] + draw.choice(kinds) + head[b:]
    elif way == 4:
        head = swap(draw, head, rb"\w+")
    elif way == 5:
        head = re.sub(rb"(ascii|binary_\w+)", draw.choice([b"ascii", b"binary_little_endian", b"binary_big_endian"]), head, count=1)
    else:
        body = body[:11] + (number(draw, body[11:]) if b"ascii" in head else some_bytes(draw, body[11:]))
    return head + body
