"""judge_images.py VELO FOLDER: measures images of a toe-in pair, of a tilted lens and of a lens of many
elements, against OpenCV and against the laws of optics written a second time here. Exit 1 when one is off."""
import json
import math
import os
import subprocess
import sys

import cv2
import numpy as np

from calibrate_opencv import ACROSS, DOWN, HEIGHT, WIDTH, Camera, random_pose, write_scene

SPP = "16"
results = []


def say(name, good, text):
    print("%-12s %s%s" % (name, text, "" if good else "  <-- too much"), flush=True)
    results.append(bool(good))


def rendered(velo, folder, scene, camera=None, more=()):
    """The green channel of an image, in floats."""
    out = os.path.join(folder, "view.pfm")
    use = []
    if camera is not None:
        with open(os.path.join(folder, "camera.json"), "w", encoding="utf-8") as file:
            json.dump(camera, file)
        use = ["--camera", os.path.join(folder, "camera.json")]
    subprocess.run([velo, "render", os.path.join(folder, scene), "--spp", SPP, "--sampler", "sobol", "--color", "rgb",
                    "--quiet", "-o", out, *use, *more], check=True)
    return cv2.imread(out, cv2.IMREAD_UNCHANGED)[:, :, 1]


def soft(image):
    return np.clip(cv2.GaussianBlur(image, (0, 0), 1.2) * 255 + 0.5, 0, 255).astype(np.uint8)


def velo_camera(matrix, world_from_camera, **more):
    return dict({"velo_camera": 1, "pixel_origin": "center", "width": WIDTH, "height": HEIGHT, "fx": matrix[0, 0],
                 "fy": matrix[1, 1], "cx": matrix[0, 2], "cy": matrix[1, 2],
                 "world_from_camera": np.asarray(world_from_camera).tolist()}, **more)


def pose_matrix(rvec, tvec):
    m = np.eye(4)
    m[:3, :3], m[:3, 3] = cv2.Rodrigues(rvec)[0], tvec
    return m


# ---- toe-in ----

def toe_in(velo, folder, between=0.6, cross=9.0):
    """Corners where the geometry of two turned eyes puts them, and stereoCalibrate's angle and base line."""
    random = np.random.default_rng(5)
    camera = Camera("pinhole", random)
    camera.k = np.zeros(5)
    board = np.array([(i, j, 0) for j in range(DOWN) for i in range(ACROSS)], np.float32)
    angle = math.atan(between / (2 * cross))
    eyes = []
    for side in (-1, 1):  # the left eye stands at -between/2 and is turned to the right
        a = -side * angle
        r = np.array([[math.cos(a), 0, -math.sin(a)], [0, 1, 0], [math.sin(a), 0, math.cos(a)]])
        m = np.eye(4)
        m[:3, :3], m[:3, 3] = r, -r @ np.array([side * between / 2, 0, 0])
        eyes.append(m)
    objects, seen, errors = [], ([], []), []
    for view in range(8):
        rvec, tvec, _ = random_pose(camera, random, np.array([0.06 * (view % 3 - 1), 0.06 * (view // 3 % 3 - 1)]))
        tvec = np.array(tvec) * 1.5  # some room: the eyes look from the side
        found = []
        for eye, name in zip(eyes, ("left", "right")):
            middle = pose_matrix(rvec, tvec)
            image = soft(rendered(velo, folder, "board.pbrt", velo_camera(
                camera.matrix, np.linalg.inv(middle), stereo="toe-in", interocular=between, convergence=cross,
                stereo_eye=name)))
            good, corners = cv2.findChessboardCorners(image, (ACROSS, DOWN), flags=cv2.CALIB_CB_ADAPTIVE_THRESH)
            if not good:
                break
            grid = corners.reshape(DOWN, ACROSS, 2)
            nearest = min(np.linalg.norm(np.diff(grid, axis=a), axis=2).min() for a in (0, 1))
            window = int(np.clip(0.45 * nearest, 3, 11))
            corners = cv2.cornerSubPix(image, corners, (window, window), (-1, -1), (3, 100, 1e-5)).reshape(-1, 2)
            space = (eye @ middle @ np.c_[board, np.ones(len(board))].T)[:3].T
            truth = space[:, :2] / space[:, 2:] @ np.diag(np.diag(camera.matrix)[:2]) + camera.matrix[:2, 2]
            if np.abs(corners[0] - truth[0]).max() > np.abs(corners[0] - truth[-1]).max():
                corners = corners[::-1].copy()
            errors.append(((corners - truth) ** 2).sum(1).mean())
            found.append(corners.astype(np.float32))
        if len(found) == 2:
            objects.append(board)
            for k in range(2):
                seen[k].append(found[k])
    rms = math.sqrt(np.mean(errors))
    _, _, _, _, _, r, t, _, _ = cv2.stereoCalibrate(objects, *seen, camera.matrix, np.zeros(5), camera.matrix, np.zeros(5),
                                                    (WIDTH, HEIGHT), flags=cv2.CALIB_FIX_INTRINSIC,
                                                    criteria=(3, 200, 1e-12))
    turned = np.linalg.norm(cv2.Rodrigues(r)[0])
    off = math.degrees(turned - 2 * angle), 100 * (np.linalg.norm(t) / between - 1)
    say("toe-in", len(objects) >= 6 and rms < 0.05 and abs(off[0]) < 0.01 and abs(off[1]) < 0.2,
        "%d pairs: corners %.4f px; stereoCalibrate: angle %+.5f degrees, base line %+.4f %%" % (len(objects), rms, *off))


# ---- a tilted lens ----

def spot_scene(folder, name, camera, place, size, film=""):
    x, y, z = place
    corners = "%r %r %r %r %r %r %r %r %r %r %r %r" % (x - size, y - size, z, x + size, y - size, z, x + size, y + size, z,
                                                       x - size, y + size, z)
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write('%s\nFilm "rgb" %s\nPixelFilter "box"\nIntegrator "path" "integer maxdepth" 0\nWorldBegin\n'
                   'AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true\nShape "trianglemesh" "point3 P" [ %s ] '
                   '"integer indices" [ 0 1 2 0 2 3 ]\n' % (camera, film, corners))


def crop_around(x, y, half):
    return [int(x) - half, int(y) - half, int(x) + half, int(y) + half]


def moments(image, crop):
    """Centre and standard deviations of a spot, in pixels, the first pixel's centre at (0.5, 0.5)."""
    weight = image.astype(float)
    y, x = np.mgrid[0:image.shape[0], 0:image.shape[1]] + 0.5
    x, y = x + crop[0], y + crop[1]
    total = weight.sum()
    cx, cy = (weight * x).sum() / total, (weight * y).sum() / total
    return cx, cy, math.sqrt((weight * (x - cx) ** 2).sum() / total), math.sqrt((weight * (y - cy) ** 2).sum() / total)


def tilt(velo, folder):
    """Spots before a lens whose plane in focus is p.a = 1, a = (tan ty, tan tx, 1) / F: a film point sees the place of that
    plane on its own line through the lens's middle, from every point of the lens."""
    f, radius, focus, size = 400.0, 0.25, 4.0, 0.02
    worst, sharp, spots = 0.0, 0.0, 0
    u, v = np.mgrid[-1:1:101j, -1:1:101j]
    disc = np.stack([u.ravel(), v.ravel()])[:, (u * u + v * v).ravel() <= 1] * radius
    for tx, ty in ((0.0, 0.0), (0.5, 0.0), (0.0, 0.4), (-0.3, 0.35)):
        a = np.array([math.tan(ty), math.tan(tx), 1.0]) / focus
        for x, y, z in ((0.0, 0.0, 3.0), (0.5, -0.3, 3.2), (-0.6, 0.5, 5.0), (0.3, 0.6, None)):
            if z is None:
                z = (1.0 - a[0] * x - a[1] * y) / a[2]  # in the plane in focus
                in_focus = True
            else:
                in_focus = False
            spot_scene(folder, "spot.pbrt", 'Camera "perspective"', (x, y, z), size,
                       '"integer xresolution" 320 "integer yresolution" 320')
            o = np.vstack([disc, np.zeros(disc.shape[1])])

            def film(x, y):
                d = np.array([[x], [y], [z]]) - o
                p = o + (1.0 - a @ o) / (a @ d) * d
                return f * p[0] / p[2] + 160, f * p[1] / p[2] + 160

            # a film point gets the share of the lens that sees the spot: the lens's points weigh what a step of the spot
            # moves on the film
            (px, py), (px1, py1), (px2, py2) = film(x, y), film(x + 1e-6, y), film(x, y + 1e-6)
            weight = np.abs((px1 - px) * (py2 - py) - (px2 - px) * (py1 - py))
            mx, my = np.average(px, weights=weight), np.average(py, weights=weight)
            vx, vy = np.average((px - mx) ** 2, weights=weight), np.average((py - my) ** 2, weights=weight)
            crop = crop_around(mx, my, 26)
            image = rendered(velo, folder, "spot.pbrt", {
                "velo_camera": 1, "width": 320, "height": 320, "fx": f, "fy": f, "cx": 160, "cy": 160,
                "lens_radius": radius, "focus_distance": focus, "tilt_x": tx, "tilt_y": ty,
                "world_from_camera": np.eye(4).tolist()}, ["--spp", "2048", "--crop", "%d,%d,%d,%d" % tuple(crop)])
            # the spot's own size on the film, and the pixel's
            own = [(2 * size * np.average(np.hypot(*step), weights=weight) * 1e6) ** 2 / 12 + 1 / 12
                   for step in ((px1 - px, px2 - px), (py1 - py, py2 - py))]
            want = mx, my, math.sqrt(vx + own[0]), math.sqrt(vy + own[1])
            got = moments(image, crop)
            off = max(abs(g - w) for g, w in zip(got, want))
            spots += 1
            worst = max(worst, off)
            if in_focus:
                sharp = max(sharp, got[2] - math.sqrt(own[0]), got[3] - math.sqrt(own[1]))
    say("lens tilt", worst < 0.1 and sharp < 0.05, "%d spots: centre and spread off by %.4f px at most; in the plane in focus the "
        "spread is %.4f px above the spot's own" % (spots, worst, sharp))


# ---- a lens of many elements ----

class Lens:
    """Spherical surfaces from the scene's side, in millimetres; Snell's law in three dimensions. Light goes to +z."""

    def __init__(self, path, stop):
        self.surfaces, z, before = [], 0.0, 1.0
        with open(path, encoding="utf-8") as file:
            for line in file:
                numbers = line.split("#")[0].split()
                if len(numbers) != 4:
                    continue
                radius, thickness, index, diameter = map(float, numbers)
                after = index if index > 0 else 1.0
                if radius == 0:
                    after = before
                    self.stop_z = z
                self.surfaces.append((radius, z, before, after, stop if radius == 0 else diameter))
                z, before = z + thickness, after
        self.back = self.surfaces[-1][1]

    def trace(self, o, d, until=None):
        """The ray behind the last surface, or where it meets the stop (until='stop')."""
        for radius, z, before, after, _ in self.surfaces:
            if radius == 0:
                if until == "stop":
                    return o + (z - o[2]) / d[2] * d
                continue
            center = np.array([0, 0, z + radius])
            b, c = np.dot(o - center, d), np.dot(o - center, o - center) - radius * radius
            root = math.sqrt(b * b - c)
            o = o + (-b - math.copysign(root, radius)) * d
            n = (center - o) / radius  # along the light
            cos = np.dot(n, d)
            n, cos = (n, cos) if cos > 0 else (-n, -cos)
            ratio = before / after
            d = ratio * d + (math.sqrt(1 - ratio * ratio * (1 - cos * cos)) - ratio * cos) * n
        return o, d

    def focus(self, distance):
        """The film's z for an object `distance` before the film: the thick lens approximation."""
        tiny = 1e-4
        o, d = self.trace(np.array([tiny, 0, -10.0]), np.array([0, 0, 1.0]))
        f = -tiny / (d[0] / d[2])
        focal_back = o[2] - o[0] / (d[0] / d[2])
        principal_back = focal_back - f
        mirrored = Lens.__new__(Lens)  # the way back: surfaces turned round
        mirrored.surfaces = [(-r, self.back - z, a, b, w) for r, z, b, a, w in reversed(self.surfaces)]
        o, d = mirrored.trace(np.array([tiny, 0, -10.0]), np.array([0, 0, 1.0]))
        focal_front = self.back - (o[2] - o[0] / (d[0] / d[2]))
        principal_front = focal_front + f
        # distance = s + s' + (principal_back - principal_front), 1/s + 1/s' = 1/f
        total = distance - (principal_back - principal_front)
        image = (total - math.sqrt(total * total - 4 * f * total)) / 2
        return principal_back + image, f

    def chief(self, point, film):
        """Where the ray from a point through the middle of the stop meets the film: the secant method in the plane of the
        axis."""
        away = math.hypot(point[0], point[1])
        side = np.array([point[0], point[1], 0]) / away

        def at(h):
            target = np.array([0, 0, 0.0]) + side * h
            d = target - point
            return point, d / np.linalg.norm(d)

        a, b = 0.0, -0.1
        fa, fb = (np.dot(self.trace(*at(h), until="stop"), side) for h in (a, b))
        for _ in range(60):
            if fa == fb or abs(fb) < 1e-13:
                break
            a, b, fa = b, b - fb * (b - a) / (fb - fa), fb
            fb = np.dot(self.trace(*at(b), until="stop"), side)
        o, d = self.trace(*at(b))
        return o + (film - o[2]) / d[2] * d


def optics(velo, folder, source):
    path = os.path.join(source, "scenes/cameras/lenses/double_gauss_50mm.dat")
    lens = Lens(path, 1.0)
    film, f = lens.focus(1000.0)
    width, height, diagonal = 600, 400, 43.0
    pixel = diagonal / math.hypot(width, height)
    worst, radii = 0.0, []
    for x, y in ((0.02, 0.01), (120, 80), (-200, 60), (150, -170), (-260, -150)):  # millimetres
        z = 1000.0  # before the film
        # pbrt's camera space: x right, y up, z forward, in metres, the film at the origin
        spot_scene(folder, "optics.pbrt", 'Camera "realistic" "string lensfile" "%s" "float aperturediameter" 1 '
                   '"float focusdistance" 1' % path, (x / 1000, y / 1000, z / 1000), 0.0005,
                   '"integer xresolution" %d "integer yresolution" %d "float diagonal" %g "float iso" 4000000' %
                   (width, height, diagonal))
        hit = lens.chief(np.array([x, y, film - z]), film)
        want = width / 2 - hit[0] / pixel, height / 2 + hit[1] / pixel
        crop = crop_around(*want, 10)
        got = moments(rendered(velo, folder, "optics.pbrt", None, ["--spp", "2048", "--crop", "%d,%d,%d,%d" % tuple(crop)]),
                      crop)
        worst = max(worst, abs(got[0] - want[0]), abs(got[1] - want[1]))
        radii.append(math.hypot(want[0] - width / 2, want[1] - height / 2))
    say("optics", worst < 0.05, "focal length %.3f mm; spots up to %.0f px from the axis off by %.4f px at most" %
        (f, max(radii), worst))


def main():
    velo, folder = sys.argv[1:3]
    source = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    write_scene(os.path.join(folder, "board.pbrt"))
    toe_in(velo, folder)
    tilt(velo, folder)
    optics(velo, folder, source)
    sys.exit(not all(results))


if __name__ == "__main__":
    main()
