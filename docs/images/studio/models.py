"""Writes knot.obj and balls.obj, the models of docs/importers.md, into the current folder."""
from math import cos, pi, sin, sqrt


def unit(v):
    length = sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def curve(t):
    return [sin(t) + 2 * sin(2 * t), cos(t) - 2 * cos(2 * t), -sin(3 * t)]


def grid(file, rows, columns, first, point, closed):
    """Points and normals of a surface over two angles, and its quads."""
    for i in range(rows):
        for j in range(columns):
            position, normal = point(i / (rows if closed else rows - 1), 2 * pi * j / columns)
            file.write("v %.5f %.5f %.5f\n" % tuple(position))
            file.write("vn %.5f %.5f %.5f\n" % tuple(normal))
    for i in range(rows if closed else rows - 1):
        for j in range(columns):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            numbers = [first + 1 + a % rows * columns + b % columns for a, b in corners]
            file.write("f " + " ".join("%d//%d" % (n, n) for n in numbers) + "\n")
    return first + rows * columns


def knot(s, angle):
    t = 2 * pi * s
    along = unit([b - a for a, b in zip(curve(t - 1e-4), curve(t + 1e-4))])
    side = unit(cross(along, [0, 0, 1]) if abs(along[2]) < 0.95 else cross(along, [1, 0, 0]))
    over = cross(along, side)
    normal = [cos(angle) * a + sin(angle) * b for a, b in zip(side, over)]
    return [p + 0.62 * n for p, n in zip(curve(t), normal)], normal


def ball(middle, radius):
    def point(s, angle):
        normal = [sin(pi * s) * cos(angle), cos(pi * s), -sin(pi * s) * sin(angle)]
        return [m + radius * n for m, n in zip(middle, normal)], normal
    return point


with open("knot.obj", "w") as file:
    grid(file, 240, 32, 0, knot, True)
with open("balls.mtl", "w") as file:
    file.write("newmtl gold\nKd .95 .66 .28\nPm 1\nPr .18\n")
    file.write("newmtl lacquer\nKd .55 .03 .03\nPm 0\nPr .08\n")
    file.write("newmtl plaster\nKd .7 .7 .7\nPm 0\nPr 1\n")
with open("balls.obj", "w") as file:
    file.write("mtllib balls.mtl\n")
    count = 0
    for name, middle, radius in (("gold", (-1.15, 0.8, -0.3), 0.8), ("lacquer", (0.55, 1, -0.6), 1), ("plaster", (0.25, 0.45, 1), 0.45)):
        file.write("usemtl %s\n" % name)
        count = grid(file, 64, 96, count, ball(middle, radius), False)
