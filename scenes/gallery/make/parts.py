#!/usr/bin/python3
"""Writes parts/*.pbrt for still_life, shaft and materials: control meshes for Loop subdivision, and a tuft of hair.
Run it in the folder above; it needs nothing but Python. The same files each time."""
import math
import random


def number(x):
    return ("%.3f" % x).rstrip("0").rstrip(".").replace("-0", "0" if abs(x) < 5e-5 else "-0")


def wrap(words, width=118):
    line, lines = "   ", []
    for word in words:
        if len(line) + 1 + len(word) > width:
            lines.append(line)
            line = "   "
        line += " " + word
    return "\n".join(lines + [line])


def subdivision(name, comment, points, faces, levels):
    with open("parts/%s.pbrt" % name, "w", encoding="ascii") as file:
        file.write("# %s (make_parts.py)\n" % comment)
        file.write('Shape "loopsubdiv" "integer levels" %d "integer indices" [\n' % levels)
        file.write(wrap([str(i) for face in faces for i in face]))
        file.write('\n    ] "point3 P" [\n')
        file.write(wrap([number(x) for p in points for x in p]))
        file.write("\n    ]\n")


def lathe(profile, sides):
    """A closed solid of revolution about y; the profile runs from the axis to the axis: (radius, height)."""
    points, faces = [(0.0, profile[0][1], 0.0)], []
    for k, (r, y) in enumerate(profile[1:-1]):
        for i in range(sides):
            a = 2 * math.pi * (i + 0.5 * (k % 2)) / sides
            points.append((r * math.cos(a), y, r * math.sin(a)))
    rings = len(profile) - 2
    points.append((0.0, profile[-1][1], 0.0))
    last = len(points) - 1
    at = lambda k, i: 1 + k * sides + i % sides
    for i in range(sides):
        faces.append((0, at(0, i), at(0, i + 1)))
        faces.append((last, at(rings - 1, i + 1), at(rings - 1, i)))
        for k in range(rings - 1):
            if k % 2 == 0:  # the next ring is turned by half a step
                faces += [(at(k, i), at(k + 1, i), at(k, i + 1)), (at(k, i + 1), at(k + 1, i), at(k + 1, i + 1))]
            else:
                faces += [(at(k, i), at(k + 1, i), at(k + 1, i + 1)), (at(k, i), at(k + 1, i + 1), at(k, i + 1))]
    return points, [face[::-1] for face in faces]  # normals point outwards


def knot(p, q, segments, sides, radius):
    """A tube along the torus knot (p, q)."""
    def centre(t):
        r = 1 + 0.42 * math.cos(q * t)
        return (r * math.cos(p * t), r * math.sin(p * t), 0.55 * math.sin(q * t))

    def minus(a, b):
        return tuple(x - y for x, y in zip(a, b))

    def unit(a):
        n = math.sqrt(sum(x * x for x in a))
        return tuple(x / n for x in a)

    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    points, faces = [], []
    for k in range(segments):
        t = 2 * math.pi * k / segments
        c = centre(t)
        along = unit(minus(centre(t + 1e-3), centre(t - 1e-3)))
        out = unit(minus(c, (c[0] / math.hypot(c[0], c[1]), c[1] / math.hypot(c[0], c[1]), 0.0)))
        up = unit(cross(along, out))
        out = cross(up, along)
        for i in range(sides):
            a = 2 * math.pi * i / sides
            points.append(tuple(c[j] + radius * (math.cos(a) * out[j] + math.sin(a) * up[j]) for j in range(3)))
    for k in range(segments):
        for i in range(sides):
            a, b = k * sides + i, k * sides + (i + 1) % sides
            c, d = (k + 1) % segments * sides + i, (k + 1) % segments * sides + (i + 1) % sides
            faces += [(a, c, b), (b, c, d)]
    return points, faces


def fur(count, length):
    """Hairs on a unit sphere, combed downwards and slightly curled."""
    rng = random.Random(1)
    lines = ["# Hairs on a unit sphere (make_parts.py)"]
    for k in range(count):
        y = 1 - 2 * (k + 0.5) / count
        a = k * math.pi * (3 - math.sqrt(5)) + rng.uniform(-0.1, 0.1)
        r = math.sqrt(1 - y * y)
        n = (r * math.cos(a), y, r * math.sin(a))
        grow = length * rng.uniform(0.75, 1.25)
        side = [rng.uniform(-0.35, 0.35) for _ in range(3)]
        values = []
        for step in range(4):
            f = step / 3
            bend = f * f
            values += [number(n[j] * (0.99 + grow * f * (1 - 0.25 * bend)) + grow * (side[j] * bend - (0.55 * bend if j == 1 else 0)))
                       for j in range(3)]
        lines.append('Shape "curve" "point3 P" [%s]' % " ".join(values))
    with open("parts/fur.pbrt", "w", encoding="ascii") as file:
        file.write("\n".join(lines) + "\n")


def main():
    goblet = [(0, 0), (0.3, 0), (0.56, 0.0), (0.6, 0.03), (0.56, 0.06), (0.3, 0.09), (0.1, 0.16), (0.06, 0.4), (0.055, 0.75),
              (0.08, 1.0), (0.3, 1.1), (0.55, 1.3), (0.66, 1.6), (0.64, 1.95), (0.55, 2.3), (0.52, 2.42), (0.505, 2.43),
              (0.49, 2.42), (0.525, 2.28), (0.61, 1.95), (0.63, 1.6), (0.52, 1.34), (0.28, 1.16), (0, 1.12)]
    points, faces = lathe(goblet, 20)
    subdivision("goblet", "A goblet: a closed solid of glass", points, faces, 3)
    vase = [(0, 0), (0.3, 0), (0.42, 0.02), (0.5, 0.15), (0.72, 0.5), (0.78, 0.85), (0.62, 1.25), (0.36, 1.55), (0.26, 1.85),
            (0.28, 2.1), (0.4, 2.26), (0.4, 2.3), (0.34, 2.28), (0.23, 2.1), (0.21, 1.85), (0.3, 1.6), (0.3, 1.2), (0, 1.1)]
    points, faces = lathe(vase, 20)
    subdivision("vase", "A vase", points, faces, 3)
    points, faces = knot(2, 3, 60, 8, 0.26)
    subdivision("knot", "A tube along the torus knot (2, 3)", points, faces, 3)
    fur(1600, 0.32)


if __name__ == "__main__":
    main()
