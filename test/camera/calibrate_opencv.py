"""calibrate_opencv.py VELO FOLDER [--seeds N] [--kinds pinhole,rational,fisheye] [--views N]: OpenCV as the judge of
images. A chessboard is rendered by velo in many views through random distorted cameras: OpenCV's pinhole with 5 or 8
(rational) coefficients, its fisheye with 4. findChessboardCorners, cornerSubPix and calibrateCamera are given nothing but the
images and must find the camera again: RMS <= 0.05 pixels, fx and fy within 0.1 %, cx and cy within 0.1 pixels. Exit 1
when not. Behind +- stands what calibrateCamera itself believes that its numbers are worth: one standard deviation."""
import argparse
import json
import os
import subprocess
import sys

import cv2
import numpy as np

WIDTH, HEIGHT, ACROSS, DOWN = 960, 720, 11, 8  # pixels; inner corners


def write_scene(path):
    """Black squares before a white sky. The board lies in z = 0, its first corner in the origin."""
    squares = [(i, j) for j in range(-1, DOWN) for i in range(-1, ACROSS) if (i + j) % 2 == 0]
    points = " ".join("%d %d 0 %d %d 0 %d %d 0 %d %d 0" % (i, j, i + 1, j, i + 1, j + 1, i, j + 1) for i, j in squares)
    indices = " ".join("%d %d %d %d %d %d" % tuple(4 * k + n for n in (0, 1, 2, 0, 2, 3)) for k in range(len(squares)))
    with open(path, "w") as f:
        f.write('Camera "perspective"\nFilm "rgb" "integer xresolution" %d "integer yresolution" %d\n'
                'PixelFilter "box"\nIntegrator "path" "integer maxdepth" 0\nWorldBegin\n'
                'LightSource "infinite" "rgb L" [ 1 1 1 ]\nMaterial "diffuse" "rgb reflectance" [ 0 0 0 ]\n'
                'Shape "trianglemesh" "point3 P" [ %s ] "integer indices" [ %s ]\n' % (WIDTH, HEIGHT, points, indices))


class Camera:
    def __init__(self, kind, random):
        self.kind = kind
        fx = random.uniform(0.45, 0.55) * WIDTH if kind == "fisheye" else random.uniform(0.6, 0.75) * WIDTH
        fy = fx * random.uniform(0.97, 1.03)
        cx, cy = (WIDTH - 1) / 2 + random.uniform(-20, 20), (HEIGHT - 1) / 2 + random.uniform(-20, 20)
        self.matrix = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
        if kind == "fisheye":
            self.k = random.uniform(-1, 1, 4) * [0.05, 0.02, 0.005, 0.001]
        elif kind == "rational":
            self.k = np.array([-0.1, 0.05, 0, 0, 0.01, 0.15, 0.05, 0.01])
            self.k += random.uniform(-1, 1, 8) * [0.1, 0.03, 2e-3, 2e-3, 0.01, 0.1, 0.03, 0.01]
        else:
            self.k = np.array([-0.2, 0.06, 0, 0, 0]) + random.uniform(-1, 1, 5) * [0.1, 0.03, 2e-3, 2e-3, 0.01]

    def project(self, points, rvec, tvec):
        if self.kind == "fisheye":
            return cv2.fisheye.projectPoints(points.reshape(1, -1, 3), rvec, tvec, self.matrix, self.k)[0].reshape(-1, 2)
        return cv2.projectPoints(points, rvec, tvec, self.matrix, self.k)[0].reshape(-1, 2)

    def folds(self, space, pixels):
        """Whether a point (camera space) lies where the lens's polynomial has bent back: the way back leads elsewhere."""
        if self.kind == "fisheye":
            back = cv2.fisheye.undistortPoints(pixels.reshape(1, -1, 2), self.matrix, self.k).reshape(-1, 2)
        else:
            back = cv2.undistortPointsIter(pixels.reshape(-1, 1, 2), self.matrix, self.k, None, None,
                                           (3, 200, 1e-12)).reshape(-1, 2)
        return not (np.abs(back - space[:, :2] / space[:, 2:]) < 1e-3).all()


def random_pose(camera, random, place):
    """The board tilted by 20 to 45 degrees, turned, its middle towards `place` in the image, as near as its squares
    are all in it: what a calibration lives on is boards that lean all ways and reach the image's corners."""
    edge = np.array([(x, y, 0) for x in np.linspace(-1.2, ACROSS + 0.2, 9) for y in np.linspace(-1.2, DOWN + 0.2, 9)])
    middle = np.array([(ACROSS - 1) / 2, (DOWN - 1) / 2, 0])
    # findChessboardCorners does not take boards that a fisheye bends much
    smallest, nearest = (0.1, 8) if camera.kind == "fisheye" else (0.26, 5)
    while True:
        tilt, lean, turn = random.uniform(0.35, 0.8), random.uniform(0, 2 * np.pi), random.uniform(-0.5, 0.5)
        tilted = cv2.Rodrigues(np.array([np.cos(lean), np.sin(lean), 0]) * tilt)[0]
        rotation = tilted @ cv2.Rodrigues(np.array([0, 0, turn]))[0]
        rvec = cv2.Rodrigues(rotation)[0].ravel()
        x, y = place + random.uniform(-0.06, 0.06, 2)
        x, y = x * WIDTH / camera.matrix[0, 0], y * HEIGHT / camera.matrix[1, 1]
        for distance in np.linspace(nearest, 30, 80):
            tvec = distance * np.array([x, y, 1]) - rotation @ middle
            space = edge @ rotation.T + tvec
            if (space[:, 2] < 1).any():
                continue
            p = camera.project(edge, rvec, tvec)
            if (p > [2, 2]).all() and (p < [WIDTH - 3, HEIGHT - 3]).all() and not camera.folds(space, p):
                if cv2.contourArea(cv2.convexHull(p.astype(np.float32))) > smallest * WIDTH * HEIGHT:
                    return rvec, tvec, p
                break


def render(velo, folder, camera, rvec, tvec, edge):
    values = {"image_width": WIDTH, "image_height": HEIGHT, "camera_matrix": camera.matrix.tolist(),
              "distortion_coefficients": list(camera.k), "rvec": list(rvec), "tvec": list(tvec)}
    if camera.kind == "fisheye":
        values["distortion_model"] = "fisheye"
    with open(os.path.join(folder, "camera.json"), "w") as f:
        json.dump(values, f)
    low, high = np.floor(edge.min(0)).clip(0), np.ceil(edge.max(0) + 1)
    crop = (int(low[0]), int(low[1]), min(int(high[0]), WIDTH), min(int(high[1]), HEIGHT))
    out = os.path.join(folder, "view.pfm")
    subprocess.run([velo, "render", os.path.join(folder, "board.pbrt"), "--camera", os.path.join(folder, "camera.json"),
                    "--spp", "16", "--sampler", "sobol", "--color", "rgb", "--quiet", "-o", out,
                    "--crop", "%d,%d,%d,%d" % crop], check=True)
    image = np.ones((HEIGHT, WIDTH), np.float32)
    image[crop[1]:crop[3], crop[0]:crop[2]] = cv2.imread(out, cv2.IMREAD_UNCHANGED)[:, :, 1]
    # as soft as a lens makes it: cornerSubPix reads between pixels by straight lines, which edges of one pixel are not
    return np.clip(cv2.GaussianBlur(image, (0, 0), 1.2) * 255 + 0.5, 0, 255).astype(np.uint8)


def collect(velo, folder, camera, views, random):
    """Board and image points of each view, and how far OpenCV's corners are from the truth (RMS)."""
    objects, images, errors, tried = [], [], [], 0
    board = np.array([(i, j, 0) for j in range(DOWN) for i in range(ACROSS)], np.float32)
    places = [np.array([x, y]) for y in (-0.18, 0.0, 0.18) for x in (-0.2, -0.1, 0.0, 0.1, 0.2)]
    while len(images) < views and tried < 2 * views:
        rvec, tvec, edge = random_pose(camera, random, places[7 * tried % len(places)])
        tried += 1
        image = render(velo, folder, camera, rvec, tvec, edge)
        # not NORMALIZE_IMAGE, which makes noise of an image that has no greys to speak of
        found, corners = cv2.findChessboardCorners(image, (ACROSS, DOWN), flags=cv2.CALIB_CB_ADAPTIVE_THRESH)
        if not found:
            continue
        grid = corners.reshape(DOWN, ACROSS, 2)  # no window may reach a neighbour
        nearest = min(np.linalg.norm(np.diff(grid, axis=a), axis=2).min() for a in (0, 1))
        window = int(np.clip(0.45 * nearest, 3, 11))
        corners = cv2.cornerSubPix(image, corners, (window, window), (-1, -1), (3, 100, 1e-5)).reshape(-1, 2)
        truth = camera.project(board.astype(float), rvec, tvec)
        if np.abs(corners[0] - truth[0]).max() > np.abs(corners[0] - truth[-1]).max():
            corners = corners[::-1].copy()
        errors.append(((corners - truth) ** 2).sum(1).mean())
        objects.append(board)
        images.append(corners.astype(np.float32))
    return objects, images, np.sqrt(np.mean(errors)) if errors else 0.0, tried


def judge(velo, folder, kind, views, seed):
    random = np.random.default_rng([seed, {"pinhole": 0, "rational": 1, "fisheye": 2}[kind]])
    camera = Camera(kind, random)
    objects, images, corner, tried = collect(velo, folder, camera, views, random)
    if len(images) < views:
        print("%-9s the board was found in %d of %d images" % (kind, len(images), tried))
        return False
    criteria, deviations = (3, 300, 1e-13), None
    if kind == "fisheye":
        flags = (cv2.fisheye.CALIB_RECOMPUTE_EXTRINSIC | cv2.fisheye.CALIB_FIX_SKEW |
                 cv2.fisheye.CALIB_USE_INTRINSIC_GUESS)  # its own first guess is one that it fails with
        guess = np.array([[0.5 * WIDTH, 0, WIDTH / 2], [0, 0.5 * WIDTH, HEIGHT / 2], [0, 0, 1]])
        rms, got, _, _, _ = cv2.fisheye.calibrate([b.reshape(-1, 1, 3).astype(float) for b in objects],
                                                  [p.reshape(-1, 1, 2).astype(float) for p in images],
                                                  (WIDTH, HEIGHT), guess, np.zeros((4, 1)), flags=flags, criteria=criteria)
    else:
        flags = cv2.CALIB_RATIONAL_MODEL if kind == "rational" else 0
        rms, got, _, _, _, deviations, _, _ = cv2.calibrateCameraExtended(objects, images, (WIDTH, HEIGHT), None, None,
                                                                          flags=flags, criteria=criteria)
    truth = camera.matrix
    focal = [100 * (got[i, i] / truth[i, i] - 1) for i in range(2)]
    center = [got[i, 2] - truth[i, 2] for i in range(2)]
    good = rms <= 0.05 and max(map(abs, focal)) <= 0.1 and max(map(abs, center)) <= 0.1
    belief = ""
    if deviations is not None:
        d = deviations.ravel()
        belief = " (+- %.4f %.4f %%, %.3f %.3f px)" % (100 * d[0] / truth[0, 0], 100 * d[1] / truth[1, 1], d[2], d[3])
    print("%-9s seed %d, %2d of %2d views: RMS %.4f px; fx %+.4f %%, fy %+.4f %%, cx %+.3f px, cy %+.3f px%s; corners %.4f px%s"
          % (kind, seed, len(images), tried, rms, *focal, *center, belief, corner, "" if good else "  <-- too much"), flush=True)
    return good


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("velo")
    parser.add_argument("folder")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--kinds", default="pinhole")
    parser.add_argument("--views", type=int, default=32)
    a = parser.parse_args()
    write_scene(os.path.join(a.folder, "board.pbrt"))
    results = [judge(a.velo, a.folder, kind, a.views, seed) for seed in range(1, a.seeds + 1) for kind in a.kinds.split(",")]
    sys.exit(not all(results))


if __name__ == "__main__":
    main()
