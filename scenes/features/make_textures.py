#!/usr/bin/env python3
"""Makes the images in textures/ (standard library only): letters.png, leaf.png, bricks_height.png, bricks_normal.png,
sky.pfm. Run it in this folder; the results are kept in the repository."""
import math, struct, zlib


def write_png(path, width, height, channels, pixel):
    kind = {1: 0, 3: 2, 4: 6}[channels]
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in pixel(x, y)) for y in range(height))
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)) +
                chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def to_8bit(x):
    return max(0, min(255, round(255 * x)))


# An F on a gradient: shows which way is up and whether it is mirrored.
F = ["11111", "10000", "11110", "10000", "10000", "10000", "10000"]
def letters(x, y):
    column, row = (x - 20) // 8, (y - 4) // 8
    if 0 <= row < 7 and 0 <= column < 5 and F[row][column] == "1":
        return 250, 250, 240
    return 40 + 2 * x, 60 + 2 * y, 120
write_png("textures/letters.png", 64, 64, 3, letters)


# A leaf that covers its middle: colour and coverage.
def leaf(x, y):
    u, v = (x + 0.5) / 64, (y + 0.5) / 64
    half = 0.42 * math.sin(math.pi * min(1, max(0, v))) ** 0.8
    inside = abs(u - 0.5) < half
    vein = abs(u - 0.5) < 0.015 or abs((v + 0.8 * abs(u - 0.5)) * 6 % 1 - 0.5) < 0.06
    green = (110, 150, 50) if vein else (50, 110 + int(60 * v), 30)
    return green + ((255,) if inside else (0,))
write_png("textures/leaf.png", 64, 64, 4, leaf)


# Bricks: height, and the normals that belong to it. Periodic.
def height(u, v):
    row = math.floor(v * 6)
    fu, fv = (u * 3 + 0.5 * (row % 2)) % 1, v * 6 % 1
    edge = min(fu, 1 - fu) * 2, min(fv, 1 - fv)
    return min(1, min(edge) / 0.12)
write_png("textures/bricks_height.png", 96, 96, 1, lambda x, y: (to_8bit(height((x + .5) / 96, 1 - (y + .5) / 96)),))
def normal(x, y):
    u, v, e, slope = (x + .5) / 96, 1 - (y + .5) / 96, 1 / 96, 0.03
    a = (height(u + e, v) - height(u - e, v)) / (2 * e) * slope
    b = (height(u, v + e) - height(u, v - e)) / (2 * e) * slope
    l = math.sqrt(a * a + b * b + 1)
    return to_8bit(0.5 - 0.5 * a / l), to_8bit(0.5 - 0.5 * b / l), to_8bit(0.5 + 0.5 / l)
write_png("textures/bricks_normal.png", 96, 96, 3, normal)


# A sky in the equal-area octahedral square (Clarberg 2008), z up: blue above, a sun towards +x, red towards +y, brown below.
def square_to_sphere(u, v):
    u, v = 2 * u - 1, 2 * v - 1
    d = 1 - (abs(u) + abs(v))
    r = 1 - abs(d)
    phi = (1 if r == 0 else (abs(v) - abs(u)) / r + 1) * math.pi / 4
    s = r * math.sqrt(2 - r * r)
    return math.copysign(math.cos(phi), u) * s, math.copysign(math.sin(phi), v) * s, math.copysign(1 - r * r, d)
def sky(x, y, n):
    dx, dy, dz = square_to_sphere((x + .5) / n, (y + .5) / n)
    c = [0.25 + 0.1 * (1 - dz), 0.4 + 0.1 * (1 - dz), 0.8]
    warm = max(0, dy) ** 4
    c = [a + warm * b for a, b in zip(c, (0.9, 0.1, -0.4))]
    sun = dx * math.cos(0.6) + dz * math.sin(0.6)
    if sun > math.cos(0.25):
        c = [36, 32, 26]
    ground = min(1, max(0, 0.5 - dz / 0.12))
    c = [(1 - ground) * a + ground * b for a, b in zip(c, (0.16, 0.12, 0.09))]
    return [max(0, v) for v in c]
n = 96
with open("textures/sky.pfm", "wb") as f:
    f.write(b"PF\n%d %d\n-1.0\n" % (n, n))
    for y in reversed(range(n)):  # PFM's rows go up
        for x in range(n):
            f.write(struct.pack("<3f", *sky(x, y, n)))
