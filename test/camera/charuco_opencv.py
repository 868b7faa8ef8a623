"""charuco_opencv.py VELO FOLDER: OpenCV's Charuco detector and calibration as judges of images. Boards of
cv2.aruco's own dictionary are rendered by velo through a random camera with 5 distortion coefficients; most views cut
parts of the board off. Limits: RMS 0.1 pixels, fx and fy 0.05 %, cx and cy 0.1 pixels; no marker and no corner may
have a wrong name. Exit 1 when one is off."""
import json
import os
import subprocess
import sys

import cv2
import numpy as np

WIDTH, HEIGHT, VIEWS = 960, 720, 16
SQUARES_X, SQUARES_Y, MARKER, BITS = 12, 9, 0.6, 4  # squares of side 1; a marker's side; its bits across, without border
DICTIONARY = cv2.aruco.DICT_4X4_100


def black_cells(board, dictionary):
    """The board's black squares (x0, y0, x1, y1). The markers' places are the board's, their bits the dictionary's."""
    corners = np.array(board.chessboardCorners).reshape(SQUARES_Y - 1, SQUARES_X - 1, 3)
    assert np.allclose(corners[0, 0, :2], 1) and np.allclose(corners[-1, -1, :2], (SQUARES_X - 1, SQUARES_Y - 1))
    objects = [np.array(p).reshape(4, 3)[:, :2] for p in board.objPoints]
    with_marker = {tuple(np.floor(p.mean(0)).astype(int)) for p in objects}
    cells = [(x, y, x + 1, y + 1) for y in range(SQUARES_Y) for x in range(SQUARES_X) if (x, y) not in with_marker]
    assert len(cells) + len(objects) == SQUARES_X * SQUARES_Y
    side = BITS + 2
    for name, p in zip(np.array(board.ids).ravel(), objects):
        bits = np.zeros((side, side), int)
        bits[1:-1, 1:-1] = cv2.aruco.Dictionary_getBitsFromByteList(dictionary.bytesList[name:name + 1], BITS)
        right, down = (p[1] - p[0]) / side, (p[3] - p[0]) / side  # corners: clockwise from the marker's first
        for row, column in np.argwhere(bits == 0):
            a = p[0] + column * right + row * down
            cells.append((*a, *(a + right + down)))
    return cells


def write_scene(path, cells):
    points = " ".join("%.9g %.9g 0 %.9g %.9g 0 %.9g %.9g 0 %.9g %.9g 0" % (a, b, c, b, c, d, a, d) for a, b, c, d in cells)
    indices = " ".join("%d %d %d %d %d %d" % tuple(4 * k + n for n in (0, 1, 2, 0, 2, 3)) for k in range(len(cells)))
    with open(path, "w", encoding="utf-8") as file:
        file.write('Camera "perspective"\nFilm "rgb"\nPixelFilter "box"\nIntegrator "path" "integer maxdepth" 0\nWorldBegin\n'
                   'LightSource "infinite" "rgb L" [ 1 1 1 ]\nMaterial "diffuse" "rgb reflectance" [ 0 0 0 ]\n'
                   'Shape "trianglemesh" "point3 P" [ %s ] "integer indices" [ %s ]\n' % (points, indices))


def random_pose(random, matrix, view):
    """A tilted board whose middle lies towards one of nine places of the image: most of them cut a part off."""
    place = np.array([0.15 * (view % 3 - 1), 0.15 * (view // 3 % 3 - 1)])
    tilt, lean, turn = random.uniform(0.45, 0.75), 2.4 * view, random.uniform(-1, 1)
    rotation = (cv2.Rodrigues(np.array([np.cos(lean), np.sin(lean), 0]) * tilt)[0] @
                cv2.Rodrigues(np.array([0, 0, turn]))[0])
    x, y = place * [WIDTH / matrix[0, 0], HEIGHT / matrix[1, 1]]
    middle = np.array([SQUARES_X / 2, SQUARES_Y / 2, 0])
    return cv2.Rodrigues(rotation)[0].ravel(), random.uniform(9.5, 11) * np.array([x, y, 1]) - rotation @ middle


def render(velo, folder, values):
    with open(os.path.join(folder, "camera.json"), "w", encoding="utf-8") as file:
        json.dump(values, file)
    out = os.path.join(folder, "view.pfm")
    subprocess.run([velo, "render", os.path.join(folder, "charuco.pbrt"), "--camera", os.path.join(folder, "camera.json"),
                    "--spp", "16", "--sampler", "sobol", "--color", "rgb", "--quiet", "-o", out], check=True)
    # as soft as a lens makes it: cornerSubPix reads between pixels by straight lines
    image = cv2.GaussianBlur(cv2.imread(out, cv2.IMREAD_UNCHANGED)[:, :, 1], (0, 0), 1.2)
    return np.clip(image * 255 + 0.5, 0, 255).astype(np.uint8)


def refined(image, corners, which):
    """The detector counts from the image's corner and stops at steps of 0.1 pixels: cornerSubPix goes on, in windows
    that reach neither a marker nor the image's edge. Corners without room for such a window are left out."""
    at = dict(zip(which.ravel(), corners.reshape(-1, 2) - np.float32(0.5)))
    kept = {}
    for n, p in at.items():
        beside = [n + step for step in (-SQUARES_X + 1, SQUARES_X - 1) if n + step in at]
        beside += [n + step for step, last in ((-1, 0), (1, SQUARES_X - 2)) if n % (SQUARES_X - 1) != last and n + step in at]
        room = (1 - MARKER) / 2 * min((np.abs(at[m] - p).max() for m in beside), default=0) - 1
        window = int(min(room, 11, *(p - 2), *([WIDTH - 3, HEIGHT - 3] - p)))
        if window >= 5:
            kept[n] = cv2.cornerSubPix(image, p.reshape(1, 1, 2), (window, window), (-1, -1), (3, 100, 1e-5))[0]
    return np.array(list(kept.values()), np.float32), np.array(list(kept), np.int32).reshape(-1, 1)


def main():
    velo, folder = sys.argv[1:3]
    random = np.random.default_rng(15)
    dictionary = cv2.aruco.getPredefinedDictionary(DICTIONARY)
    board = cv2.aruco.CharucoBoard_create(SQUARES_X, SQUARES_Y, 1.0, MARKER, dictionary)
    write_scene(os.path.join(folder, "charuco.pbrt"), black_cells(board, dictionary))
    fx = random.uniform(0.6, 0.7) * WIDTH
    matrix = np.array([[fx, 0, (WIDTH - 1) / 2 + random.uniform(-15, 15)],
                       [0, fx * random.uniform(0.98, 1.02), (HEIGHT - 1) / 2 + random.uniform(-15, 15)], [0, 0, 1]])
    k = np.array([-0.15, 0.04, 0, 0, 0]) + random.uniform(-1, 1, 5) * [0.05, 0.02, 1e-3, 1e-3, 0.005]
    places = np.array(board.chessboardCorners, float)
    parameters = cv2.aruco.DetectorParameters_create()
    seen, names, errors, worst, markers, cut = [], [], [], 0.0, 0, 0
    for view in range(VIEWS):
        rvec, tvec = random_pose(random, matrix, view)
        image = render(velo, folder, {"image_width": WIDTH, "image_height": HEIGHT, "camera_matrix": matrix.tolist(),
                                      "distortion_coefficients": list(k), "rvec": list(rvec), "tvec": list(tvec)})
        found, ids, _ = cv2.aruco.detectMarkers(image, dictionary, parameters=parameters)
        markers += 0 if ids is None else len(ids)
        count, corners, which = cv2.aruco.interpolateCornersCharuco(found, ids, image, board) if ids is not None else (0, 0, 0)
        if count < 8:
            continue
        corners, which = refined(image, corners, which)
        ground_truth = cv2.projectPoints(places[which.ravel()], rvec, tvec, matrix, k)[0].reshape(-1, 2)
        off = np.linalg.norm(corners.reshape(-1, 2) - ground_truth, axis=1)
        worst = max(worst, off.max())
        errors.append((off ** 2).mean())
        seen.append(corners)
        names.append(which)
        outline = [(x, y, 0.0) for x in (0, SQUARES_X) for y in (0, SQUARES_Y)]
        p = cv2.projectPoints(np.array(outline), rvec, tvec, matrix, k)[0].reshape(-1, 2)
        cut += not ((p >= -0.5) & (p <= [WIDTH - 0.5, HEIGHT - 0.5])).all()
    if len(seen) < VIEWS - 2:
        print("the board was found in %d of %d images" % (len(seen), VIEWS))
        sys.exit(1)
    rms, got, _, _, _, deviations, _, _ = cv2.aruco.calibrateCameraCharucoExtended(
        seen, names, board, (WIDTH, HEIGHT), None, None, flags=0, criteria=(3, 300, 1e-13))
    focal = [100 * (got[i, i] / matrix[i, i] - 1) for i in range(2)]
    center = [got[i, 2] - matrix[i, 2] for i in range(2)]
    d = deviations.ravel()
    good = rms < 0.1 and max(map(abs, focal)) < 0.05 and max(map(abs, center)) < 0.1 and worst < 1 and cut >= VIEWS // 3
    print("%d views, %d with parts cut off, %d markers, %d corners: RMS %.4f px; fx %+.4f %%, fy %+.4f %%, cx %+.3f px, "
          "cy %+.3f px (+- %.4f %.4f %%, %.3f %.3f px); corners %.4f px, at most %.3f px%s" %
          (len(seen), cut, markers, sum(map(len, seen)), rms, *focal, *center, 100 * d[0] / matrix[0, 0],
           100 * d[1] / matrix[1, 1], d[2], d[3], np.sqrt(np.mean(errors)), worst, "" if good else "  <-- too much"))
    sys.exit(not good)


if __name__ == "__main__":
    main()
