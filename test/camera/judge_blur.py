"""judge_blur.py VELO FOLDER: the blur of spots in images of a lens of many elements and of a lens that is turned
(Scheimpflug), against rays traced here by Snell's law and against the circle of confusion of Gaussian optics. And the
poses of a toe-in pair, which OpenCV finds from points that velo projects. Exit 1 when one is off."""
import json
import math
import os
import subprocess
import sys

import cv2
import numpy as np

from judge_images import Lens, crop_around, moments, rendered, results, say, spot_scene, velo_camera

# ---- a toe-in pair's points ----


def project(velo, folder, camera, points):
    path = os.path.join(folder, "eye.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(camera, file)
    lines = "".join("%.17g,%.17g,%.17g\n" % tuple(p) for p in points)
    run = subprocess.run([velo, "camera", "project", "--camera", path, "--pixel-origin", "center", "-"], input=lines,
                         stdout=subprocess.PIPE, check=True, text=True)
    rows = np.array([line.split(",") for line in run.stdout.splitlines()[1:]], float)
    assert len(rows) == len(points) and (rows[:, 3] == 1).all()
    return rows[:, :2].copy()


def toe_in_points(velo, folder):
    """solvePnP finds each eye; between them lie the base line and twice atan(b / 2c). Triangulation finds the points."""
    random = np.random.default_rng(6)
    turned, base, space = 0.0, 0.0, 0.0
    for between, cross in ((0.065, 1.5), (0.6, 9.0), (2.0, 4.0)):
        matrix = np.array([[random.uniform(600, 900), 0, 470.0], [0, random.uniform(600, 900), 350.0], [0, 0, 1]])
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = cv2.Rodrigues(random.uniform(-1, 1, 3))[0], random.uniform(-3, 3, 3)
        local = random.uniform([-0.3, -0.25, 0.6], [0.3, 0.25, 1.6], (60, 3)) * cross
        world = local @ pose[:3, :3].T + pose[:3, 3]
        eyes, pixels = [], []
        for name in ("left", "right"):
            p = project(velo, folder, velo_camera(matrix, pose, stereo="toe-in", interocular=between, convergence=cross,
                                                  stereo_eye=name), world)
            _, r, t = cv2.solvePnP(local, p, matrix, None, flags=cv2.SOLVEPNP_ITERATIVE)
            r, t = cv2.solvePnPRefineLM(local, p, matrix, None, r, t, (3, 100, 1e-15))
            pixels.append(p)
            eyes.append((cv2.Rodrigues(r)[0], t.ravel()))
        (r0, t0), (r1, t1) = eyes
        rotation = cv2.Rodrigues(r1 @ r0.T)[0].ravel()  # about y alone: the right eye is turned to the left
        turned = max(turned, np.abs(rotation - [0, 2 * math.atan(between / (2 * cross)), 0]).max())
        base = max(base, np.abs(r0.T @ t0 - r1.T @ t1 - [between, 0, 0]).max() / between)
        intended = []
        for side in (-1, 1):
            r = cv2.Rodrigues(np.array([0, side * math.atan(between / (2 * cross)), 0]))[0]
            intended.append(matrix @ np.c_[r, -r @ np.array([side * between / 2, 0, 0])])
        found = cv2.triangulatePoints(*intended, *(p.T for p in pixels))
        space = max(space, np.abs((found[:3] / found[3]).T / local[:, 2:] - local / local[:, 2:]).max())
    say("toe-in", turned < 1e-6 and base < 1e-6 and space < 1e-6, "projected points: rotation between the eyes off by "
        "%.2g radians, base line by %.2g, triangulated points by %.2g" % (turned, base, space))


FILTER = 0.8  # a Gaussian of this standard deviation: moments do not depend on where in a pixel a spot lies


def soft_spot(folder, name, *arguments):
    spot_scene(folder, name, *arguments)
    path = os.path.join(folder, name)
    with open(path, encoding="utf-8") as file:
        text = file.read()
    soft = 'PixelFilter "gaussian" "float sigma" %g "float xradius" 4 "float yradius" 4' % FILTER
    assert 'PixelFilter "box"' in text
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace('PixelFilter "box"', soft))


# ---- a turned lens ----

def turned_lens(velo, folder):
    """Spots on the axis through a lens turned about both axes: f/2, 50 mm, in scene units of 10 mm. The plane in focus is
    p.a = 1, a = (sin ty / f, sin tx / f, 1 / F)."""
    f, focus, size, width, tx, ty = 5.0, 20.0, 0.02, 320, 0.12, -0.07
    scale, radius = width * 50 / 36, f / 4
    a = np.array([math.sin(ty) / f, math.sin(tx) / f, 1 / focus])
    worst, sharp = 0.0, 0.0
    for x, y, depth in ((0.1, 0.15, 1.0), (-0.2, -0.1, 1.0), (0.15, -0.2, 1.0), (0.1, 0.15, 0.93), (-0.2, -0.1, 1.1)):
        z = depth / (a @ [x, y, 1])
        soft_spot(folder, "spot.pbrt", 'Camera "perspective"', (x * z, y * z, z), size)
        crop = crop_around(scale * x + 160, scale * y + 160, 40)
        image = rendered(velo, folder, "spot.pbrt", {
            "velo_camera": 1, "width": width, "height": width, "focal_mm": 50, "sensor_width_mm": 36, "fov_axis": "horizontal",
            "f_number": 2, "unit_mm": 10, "focus_distance": focus, "lens_tilt_x": tx, "lens_tilt_y": ty,
            "world_from_camera": np.eye(4).tolist()}, ["--spp", "2048", "--crop", "%d,%d,%d,%d" % tuple(crop)])
        _, _, sx, sy = moments(image, crop)
        own = (2 * size * scale / z) ** 2 / 12 + FILTER ** 2
        blur = scale * radius * abs(depth - 1) / z  # the circle of confusion's radius
        off = max(abs(s - math.sqrt(own + blur ** 2 / 4)) for s in (sx, sy))
        worst = max(worst, off)
        if depth == 1.0:
            sharp = max(sharp, off)
    say("turned lens", worst < 0.1 and sharp < 0.02, "spread in the plane in focus off by %.4f px, before and behind it by "
        "%.4f px at most (circle of confusion: radius %.2f px)" % (sharp, worst, blur))


# ---- a lens of many elements ----

def bundle(lens, point, film, spread):
    """The film points of rays from a point to the first surface's disc of radius `spread`, and their weights: the solid
    angle that each stands for, and the cosine at the spot. Rays that an edge stops are left out."""
    u, v = (g.ravel() * spread for g in np.mgrid[-1:1:401j, -1:1:401j])
    d = np.stack([u, v, np.zeros_like(u)], 1) - point
    length = np.linalg.norm(d, axis=1, keepdims=True)
    d = d / length
    weight = d[:, 2] ** 2 / length[:, 0] ** 2
    o = np.repeat(point[None, :], len(d), 0)
    good = np.ones(len(d), bool)
    for radius, z, before, after, diameter in lens.surfaces:
        if radius == 0:
            o = o + ((z - o[:, 2]) / d[:, 2])[:, None] * d
        else:
            away = o - [0, 0, z + radius]
            b = (away * d).sum(1)
            square = b * b - (away * away).sum(1) + radius * radius
            good &= square > 0
            o = o + (-b - math.copysign(1, radius) * np.sqrt(np.maximum(square, 0)))[:, None] * d
            n = ([0, 0, z + radius] - o) / radius
            cos = (n * d).sum(1)
            ratio = before / after
            inside = 1 - ratio * ratio * (1 - cos * cos)
            good &= inside > 0
            d = ratio * d + (np.sqrt(np.maximum(inside, 0)) - ratio * cos)[:, None] * n
        good &= np.hypot(o[:, 0], o[:, 1]) <= diameter / 2
    hit = o + ((film - o[:, 2]) / d[:, 2])[:, None] * d
    return hit[good, :2], weight[good]


def exit_pupil(lens):
    """z and magnification of the stop's image through the surfaces behind it, by paraxial rays."""
    behind = Lens.__new__(Lens)
    behind.surfaces = [s for s in lens.surfaces if s[1] > lens.stop_z]
    ends = []
    for height in (0.0, 1e-4):  # from the stop's middle and from beside it, both at the same small angle
        d = np.array([1e-4, 0, 1.0])
        o, d = behind.trace(np.array([height, 0, lens.stop_z]), d / np.linalg.norm(d))
        ends.append((o, d))
    (o, d), (o1, d1) = ends
    z = o[2] - o[0] * d[2] / d[0]
    return z, (o1[0] + (z - o1[2]) * d1[0] / d1[2]) / 1e-4


def optics(velo, folder, source):
    path = os.path.join(source, "scenes/cameras/lenses/double_gauss_50mm.dat")
    stop, width, height, diagonal, size = 5.0, 600, 400, 43.0, 0.5
    lens = Lens(path, stop)
    film, f = lens.focus(1000.0)
    pixel = diagonal / math.hypot(width, height)
    pupil, magnified = exit_pupil(lens)
    worst, cone, spots = 0.0, 0.0, 0
    for x, y, z in ((0.02, 0.01, 1000.0), (0.02, 0.01, 500.0), (0.02, 0.01, 5000.0), (80, 60, 520.0), (-700, -500, 4000.0)):
        soft_spot(folder, "optics.pbrt", 'Camera "realistic" "string lensfile" "%s" "float aperturediameter" %g '
                   '"float focusdistance" 1' % (path, stop), (x / 1000, y / 1000, z / 1000), size * z / 1e6,
                   '"integer xresolution" %d "integer yresolution" %d "float diagonal" %g "float iso" 40000' %
                   (width, height, diagonal))
        point = np.array([x, y, film - z])
        hit, weight = bundle(lens, point, film, 12.6)
        px, py = width / 2 - hit[:, 0] / pixel, height / 2 + hit[:, 1] / pixel
        mx, my = np.average(px, weights=weight), np.average(py, weights=weight)
        beside, its_weight = bundle(lens, point + [1, 1, 0], film, 12.6)
        step = (np.average(beside, axis=0, weights=its_weight) - np.average(hit, axis=0, weights=weight)) / pixel
        own = (2 * size * z / 1000 * step) ** 2 / 12 + FILTER ** 2
        want = mx, my, *(math.sqrt(np.average((p - m) ** 2, weights=weight) + o) for p, m, o in ((px, mx, own[0]), (py, my, own[1])))
        crop = crop_around(mx, my, 24)
        got = moments(rendered(velo, folder, "optics.pbrt", None, ["--spp", "2048", "--crop", "%d,%d,%d,%d" % tuple(crop)]),
                      crop)
        worst = max(worst, max(abs(g - w) for g, w in zip(got, want)))
        spots += 1
        if abs(x) < 1 and z != 1000.0:
            # Gaussian optics: the cone from the exit pupil's edge to the image, cut by the film
            image, _ = lens.focus(z)  # the film's place were it focused at z, measured from there
            for _ in range(20):
                image, _ = lens.focus(z + image - film)
            radius = magnified * stop / 2 * abs(film - image) / (image - pupil) / pixel
            blur = math.sqrt(4 * max(got[2] ** 2 - own[0], 0))
            cone = max(cone, abs(blur / radius - 1))
    say("optics", worst < 0.1 and cone < 0.05, "%d spots: centre and spread off by %.4f px at most; radius of the circle of "
        "confusion within %.2f %% of the exit pupil's cone" % (spots, worst, 100 * cone))


def main():
    velo, folder = sys.argv[1:3]
    source = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    toe_in_points(velo, folder)
    turned_lens(velo, folder)
    optics(velo, folder, source)
    sys.exit(not all(results))


if __name__ == "__main__":
    main()
