"""calibrate_opencv.py VELO FOLDER [CAMERAS [VIEWS]]: OpenCV as the judge of pictures. A chessboard is rendered by velo
in many views through random distorted cameras (the first is an OpenCV pinhole with 5 coefficients, then a fisheye, 8
coefficients, in turn); findChessboardCorners, cornerSubPix and calibrateCamera are given nothing but the pictures and
must find the camera again: RMS <= 0.05 pixels, fx and fy within 0.1 %, cx and cy within 0.1 pixels. Exit 1 when not."""
import json
import os
import subprocess
import sys

import cv2
import numpy as np

WIDTH, HEIGHT, ACROSS, DOWN = 640, 480, 10, 7  # pixels; inner corners
random = np.random.default_rng(7)


def write_scene(path):
    """White squares and the margin shine; black is nothing. The board lies in z = 0, its first corner in the origin."""
    rectangles = [(i, j, i + 1, j + 1) for j in range(-1, DOWN) for i in range(-1, ACROSS) if (i + j) % 2]
    rectangles += [(-2, -2, ACROSS + 1, -1), (-2, DOWN, ACROSS + 1, DOWN + 1), (-2, -1, -1, DOWN),
                   (ACROSS, -1, ACROSS + 1, DOWN)]
    points = " ".join("%d %d 0 %d %d 0 %d %d 0 %d %d 0" % (a, b, c, b, c, d, a, d) for a, b, c, d in rectangles)
    indices = " ".join("%d %d %d %d %d %d" % tuple(4 * k + n for n in (0, 1, 2, 0, 2, 3)) for k in range(len(rectangles)))
    with open(path, "w") as f:
        f.write('Camera "perspective"\nFilm "rgb" "integer xresolution" %d "integer yresolution" %d\n'
                'PixelFilter "gaussian"\nIntegrator "path" "integer maxdepth" 0\nWorldBegin\n'
                'AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true\n'
                'Shape "trianglemesh" "point3 P" [ %s ] "integer indices" [ %s ]\n' % (WIDTH, HEIGHT, points, indices))


def random_camera(kind):
    fx = random.uniform(220, 300) if kind == "fisheye" else random.uniform(320, 450)
    fy = fx * random.uniform(0.97, 1.03)
    cx, cy = (WIDTH - 1) / 2 + random.uniform(-15, 15), (HEIGHT - 1) / 2 + random.uniform(-15, 15)
    if kind == "fisheye":
        k = random.uniform(-1, 1, 4) * [0.05, 0.02, 0.005, 0.001]
    elif kind == "rational":
        k = np.array([-0.1, 0.05, 0, 0, 0.01, 0.15, 0.05, 0.01]) + random.uniform(-1, 1, 8) * [.1, .03, 2e-3, 2e-3, .01, .1, .03, .01]
    else:
        k = np.array([-0.25, 0.08, 0, 0, 0]) + random.uniform(-1, 1, 5) * [0.1, 0.03, 2e-3, 2e-3, 0.01]
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]), k


def project(kind, points, rvec, tvec, matrix, k):
    if kind == "fisheye":
        return cv2.fisheye.projectPoints(points.reshape(1, -1, 3), rvec, tvec, matrix, k)[0].reshape(-1, 2)
    return cv2.projectPoints(points, rvec, tvec, matrix, k)[0].reshape(-1, 2)


def random_pose(kind, matrix, k):
    """The board tilted, turned, somewhere in the picture with all of its margin, as large as it can be."""
    edge = np.array([(x, y, 0) for x in np.linspace(-2, ACROSS + 1, 8) for y in np.linspace(-2, DOWN + 1, 8)], float)
    middle = np.array([(ACROSS - 1) / 2, (DOWN - 1) / 2, 0])
    # a fisheye bends large boards more than findChessboardCorners takes
    share = 0.14 if kind == "fisheye" else 0.3
    while True:
        tilt, lean, turn = random.uniform(0.3, 0.7), random.uniform(0, 2 * np.pi), random.uniform(-0.4, 0.4)
        tilted = cv2.Rodrigues(np.array([np.cos(lean), np.sin(lean), 0]) * tilt)[0]
        rotation = tilted @ cv2.Rodrigues(np.array([0, 0, turn]))[0]
        rvec = cv2.Rodrigues(rotation)[0].ravel()
        x, y = random.uniform(-0.3, 0.3) * WIDTH / matrix[0, 0], random.uniform(-0.3, 0.3) * HEIGHT / matrix[1, 1]
        for distance in np.linspace(4 if share > 0.2 else 7, 30, 53):
            tvec = distance * np.array([x, y, 1]) - rotation @ middle
            if ((edge @ rotation.T + tvec)[:, 2] < 1).any():
                continue
            p = project(kind, edge, rvec, tvec, matrix, k)
            if (p > [2, 2]).all() and (p < [WIDTH - 3, HEIGHT - 3]).all():
                if cv2.contourArea(cv2.convexHull(p.astype(np.float32))) > share * WIDTH * HEIGHT:
                    return rvec, tvec, p
                break


def render(velo, folder, kind, matrix, k, rvec, tvec, edge):
    camera = {"image_width": WIDTH, "image_height": HEIGHT, "camera_matrix": matrix.tolist(),
              "distortion_coefficients": list(k), "rvec": list(rvec), "tvec": list(tvec)}
    if kind == "fisheye":
        camera["distortion_model"] = "fisheye"
    with open(os.path.join(folder, "camera.json"), "w") as f:
        json.dump(camera, f)
    low, high = np.floor(edge.min(0)).clip(0), np.ceil(edge.max(0) + 1)
    crop = (int(low[0]), int(low[1]), min(int(high[0]), WIDTH), min(int(high[1]), HEIGHT))
    out = os.path.join(folder, "view.pfm")
    subprocess.run([velo, "render", os.path.join(folder, "board.pbrt"), "--camera", os.path.join(folder, "camera.json"),
                    "--spp", "36", "--sampler", "multijittered", "--color", "rgb", "--quiet", "-o", out,
                    "--crop", "%d,%d,%d,%d" % crop], check=True)
    part = cv2.imread(out, cv2.IMREAD_UNCHANGED)
    picture = np.zeros((HEIGHT, WIDTH), np.float32)
    picture[crop[1]:crop[3], crop[0]:crop[2]] = part[:, :, 1]
    # as soft as a lens makes it: cornerSubPix reads between pixels by straight lines, which edges of one pixel are not
    return np.clip(cv2.GaussianBlur(picture, (0, 0), 0.8) * 255 + 0.5, 0, 255).astype(np.uint8)


def judge(velo, folder, kind, views):
    matrix, k = random_camera(kind)
    objects, images = [], []
    board = np.array([(i, j, 0) for j in range(DOWN) for i in range(ACROSS)], np.float32)
    worst_corner, tried = 0.0, 0
    while len(images) < views and tried < 3 * views:
        tried += 1
        rvec, tvec, edge = random_pose(kind, matrix, k)
        picture = render(velo, folder, kind, matrix, k, rvec, tvec, edge)
        found, corners = cv2.findChessboardCorners(picture, (ACROSS, DOWN))
        if not found:
            continue
        corners = cv2.cornerSubPix(picture, corners, (7, 7), (-1, -1), (3, 100, 1e-5)).reshape(-1, 2)
        truth = project(kind, board.astype(float), rvec, tvec, matrix, k)
        if np.abs(corners[0] - truth[0]).max() > np.abs(corners[0] - truth[-1]).max():
            corners = corners[::-1].copy()
        worst_corner = max(worst_corner, np.linalg.norm(corners - truth, axis=1).max())
        objects.append(board)
        images.append(corners.astype(np.float32))
    if len(images) < views:
        print("%-9s the board was found in %d of %d pictures" % (kind, len(images), tried))
        return False
    criteria = (3, 200, 1e-12)
    if kind == "fisheye":
        flags = cv2.fisheye.CALIB_RECOMPUTE_EXTRINSIC | cv2.fisheye.CALIB_FIX_SKEW
        rms, got, kk, _, _ = cv2.fisheye.calibrate([b.reshape(-1, 1, 3).astype(float) for b in objects],
                                                   [p.reshape(-1, 1, 2).astype(float) for p in images],
                                                   (WIDTH, HEIGHT), None, None, flags=flags, criteria=criteria)
    else:
        flags = cv2.CALIB_RATIONAL_MODEL if kind == "rational" else 0
        rms, got, kk, _, _ = cv2.calibrateCamera(objects, images, (WIDTH, HEIGHT), None, None, flags=flags,
                                                 criteria=criteria)
    focal = max(abs(got[0, 0] / matrix[0, 0] - 1), abs(got[1, 1] / matrix[1, 1] - 1))
    center = max(abs(got[0, 2] - matrix[0, 2]), abs(got[1, 2] - matrix[1, 2]))
    good = rms <= 0.05 and focal <= 1e-3 and center <= 0.1
    print("%-9s %2d views: RMS %.4f px, f off by %.4f %%, c by %.3f px, corners by %.3f px at most%s" %
          (kind, len(images), rms, 100 * focal, center, worst_corner, "" if good else "  <-- too much"))
    return good


def main():
    velo, folder = sys.argv[1:3]
    cameras = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    views = int(sys.argv[4]) if len(sys.argv) > 4 else 12
    write_scene(os.path.join(folder, "board.pbrt"))
    kinds = ["pinhole", "fisheye", "rational"]
    results = [judge(velo, folder, kinds[i % 3], views) for i in range(cameras)]
    sys.exit(not all(results))


main()
