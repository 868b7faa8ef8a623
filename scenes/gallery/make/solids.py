"""Solids as text of pbrt-v4, for the scenes that the programs beside this file write. Lengths are
metres; y is up; numbers are rounded to a tenth of a millimetre."""
import math
import random

Point = tuple[float, float, float]


def number(value: float) -> str:
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def numbers(values) -> str:
    return " ".join(number(v) for v in values)


def flat(rows) -> list:
    return [value for row in rows for value in row]


def mesh(points: list[Point], triangles, normals=None, uv=None) -> str:
    text = f'Shape "trianglemesh" "point3 P" [{numbers(flat(points))}]\n'
    text += f'  "integer indices" [{" ".join(str(i) for i in flat(triangles))}]'
    if normals:
        text += f'\n  "normal N" [{" ".join(number(round(v, 3)) for v in flat(normals))}]'
    if uv:
        text += f'\n  "point2 uv" [{numbers(flat(uv))}]'
    return text + "\n"


def patch(a: Point, b: Point, c: Point, d: Point) -> str:
    """A flat rectangle; its normal is (b - a) x (c - a)."""
    return f'Shape "bilinearmesh" "point3 P" [{numbers(a + b + c + d)}]\n'


def box(low: Point, high: Point) -> str:
    (a, b, c), (d, e, f) = low, high
    corners = [(x, y, z) for z in (c, f) for y in (b, e) for x in (a, d)]
    faces = [(0, 2, 1, 3), (4, 5, 6, 7), (0, 1, 4, 5), (2, 6, 3, 7), (0, 4, 2, 6), (1, 3, 5, 7)]
    points = flat([[corners[i] for i in face] for face in faces])
    indices = " ".join(str(i) for i in range(24))
    return (f'Shape "bilinearmesh" "point3 P" [{numbers(flat(points))}]\n'
            f'  "integer indices" [{indices}]\n')


def lathe(profile: list[tuple[float, float]], count: int = 32, smooth: bool = True) -> str:
    """Turns a profile of (radius, height), from below to above, around the y axis. Where two
    pieces of the profile meet at more than 50 degrees there is an edge."""
    pieces = []
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        length = math.hypot(r1 - r0, y1 - y0) or 1.0
        pieces.append(((y1 - y0) / length, (r0 - r1) / length))
    points, normals, triangles = [], [], []

    def ring(point: tuple[float, float], n: tuple[float, float]) -> int:
        for i in range(count):
            angle = 2.0 * math.pi * i / count
            c, s = math.cos(angle), math.sin(angle)
            points.append((point[0] * c, point[1], point[0] * s))
            normals.append((n[0] * c, n[1], n[0] * s))
        return len(points) - count

    above = None
    for k, (start, end) in enumerate(zip(profile, profile[1:])):
        low = ring(start, pieces[k]) if above is None else above
        n, above = pieces[k], None
        if smooth and k + 1 < len(pieces):
            m = pieces[k + 1]
            if n[0] * m[0] + n[1] * m[1] > 0.64:
                size = math.hypot(n[0] + m[0], n[1] + m[1])
                above = ring(end, ((n[0] + m[0]) / size, (n[1] + m[1]) / size))
        high = ring(end, n) if above is None else above
        for i in range(count):
            j = (i + 1) % count
            if start[0] > 0.0:
                triangles.append((low + i, high + i, low + j))
            if end[0] > 0.0:
                triangles.append((low + j, high + i, high + j))
    return mesh(points, triangles, normals)


def grid(height, across: int, along: int) -> str:
    """A smooth surface: height(s, t) gives the point of s and t in 0..1."""
    points, normals, triangles = [], [], []
    step = 1e-4
    for j in range(along + 1):
        for i in range(across + 1):
            s, t = i / across, j / along
            points.append(height(s, t))
            p = [height(min(s + step, 1.0), t), height(max(s - step, 0.0), t),
                 height(s, min(t + step, 1.0)), height(s, max(t - step, 0.0))]
            u = [a - b for a, b in zip(p[0], p[1])]
            v = [a - b for a, b in zip(p[2], p[3])]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            size = math.sqrt(sum(x * x for x in n)) or 1.0
            normals.append(tuple(x / size for x in n))
    for j in range(along):
        for i in range(across):
            a = j * (across + 1) + i
            b, c, d = a + 1, a + across + 1, a + across + 2
            triangles += [(a, b, d), (a, d, c)]
    return mesh(points, triangles, normals)


def prism(outline: list[tuple[float, float]], low: float, high: float, holes=()) -> str:
    """Extrudes a ring: between an outline and, if given, one hole with the same number of
    points; without a hole the outline must be seen whole from its mean."""
    n = len(outline)
    inner = holes[0] if holes else [(sum(p[0] for p in outline) / n, sum(p[1] for p in outline) / n)]
    points, triangles = [], []
    for z, turned in ((high, False), (low, True)):
        first = len(points)
        points += [(x, y, z) for x, y in outline] + [(x, y, z) for x, y in inner]
        for i in range(n):
            j = (i + 1) % n
            a, b = first + i, first + j
            c, d = (first + n + i, first + n + j) if holes else (first + n, first + n)
            ring = [(a, b, c)] if not holes else [(a, b, d), (a, d, c)]
            triangles += [(p, r, q) for p, q, r in ring] if turned else ring
    for ring, inside in ((outline, False),) + tuple((h, True) for h in holes):
        for i in range(len(ring)):
            (x0, y0), (x1, y1) = ring[i], ring[(i + 1) % len(ring)]
            first = len(points)
            points += [(x0, y0, low), (x1, y1, low), (x0, y0, high), (x1, y1, high)]
            a, b, c, d = range(first, first + 4)
            triangles += [(a, d, b), (a, c, d)] if inside else [(a, b, d), (a, d, c)]
    return mesh(points, triangles)


def circle(radius: float, count: int, x: float = 0.0, y: float = 0.0) -> list[tuple[float, float]]:
    return [(x + radius * math.cos(2.0 * math.pi * i / count),
             y + radius * math.sin(2.0 * math.pi * i / count)) for i in range(count)]


def leaves(random_of: random.Random, count: int, radius: float, size: float) -> str:
    """Small bent leaves in a ball, denser towards its surface."""
    points, indices = [], []
    for k in range(count):
        direction = [random_of.gauss(0.0, 1.0) for _ in range(3)]
        far = math.sqrt(sum(x * x for x in direction))
        centre = [x / far * radius * random_of.uniform(0.55, 1.0) for x in direction]
        u = [random_of.gauss(0.0, 1.0) for _ in range(3)]
        v = [random_of.gauss(0.0, 1.0) for _ in range(3)]
        long_u = math.sqrt(sum(x * x for x in u)) / size
        long_v = math.sqrt(sum(x * x for x in v)) / (0.4 * size)
        u, v = [x / long_u for x in u], [x / long_v for x in v]
        points += [[c - a for c, a in zip(centre, u)], [c - a for c, a in zip(centre, v)],
                   [c + a for c, a in zip(centre, v)], [c + a for c, a in zip(centre, u)]]
        indices += range(4 * k, 4 * k + 4)
    return (f'Shape "bilinearmesh" "point3 P" [{numbers(flat(points))}]\n'
            f'  "integer indices" [{" ".join(str(i) for i in indices)}]\n')


def attribute(text: str, *before: str) -> str:
    return "AttributeBegin\n" + "\n".join(before) + ("\n" if before else "") + text + "AttributeEnd\n"


def instance(name: str, *before: str) -> str:
    return attribute(f'ObjectInstance "{name}"\n', *before)
