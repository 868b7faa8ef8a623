"""compare_opencv.py HELPER: random OpenCV cameras, pinhole with 4 to 14 coefficients and fisheye, against
cv2.projectPoints and cv2.fisheye.projectPoints: within 1e-9 relative wherever velo calls the point valid, and valid
wherever OpenCV's own formula has not yet folded. Exit 1 when not."""
import subprocess
import sys

import cv2
import numpy as np

CAMERAS, POINTS, WIDTH, HEIGHT = 1000, 1000, 1280, 960
random = np.random.default_rng(20)


def camera(index):
    fisheye = index % 4 == 3
    fx = random.uniform(300, 2000)
    fy = fx * random.uniform(0.9, 1.1)
    cx, cy = WIDTH * random.uniform(0.4, 0.6), HEIGHT * random.uniform(0.4, 0.6)  # OpenCV's: first pixel at (0, 0)
    if fisheye:
        k = random.uniform(-1, 1, 4) * [0.1, 0.05, 0.02, 0.005]
    else:
        k = random.uniform(-1, 1, 14) * [0.4, 0.2, 0.01, 0.01, 0.1, 0.3, 0.1, 0.05, 0.01, 0.005, 0.01, 0.005, 0.1, 0.1]
        k = k[:random.choice([4, 5, 8, 12, 14])]
    rvec, tvec = random.normal(0, 1, 3), random.normal(0, 5, 3)
    return fisheye, fx, fy, cx, cy, k, rvec, tvec


def folded(k, x, y):
    """Whether the determinant of the distortion's derivative, by differences of cv2 itself, is not positive somewhere
    on the way from the centre to each point."""
    result = np.zeros(len(x), bool)
    h, zero = 1e-6, np.zeros(3)
    for share in np.linspace(0.02, 1, 50):
        a, b = x * share, y * share
        at = np.concatenate([np.stack([a + i * h, b + j * h, np.ones(len(a))], 1)
                             for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1))])
        p = cv2.projectPoints(at, zero, zero, np.eye(3), k)[0].reshape(4, -1, 2)
        dx, dy = (p[0] - p[1]) / (2 * h), (p[2] - p[3]) / (2 * h)
        result |= ~(dx[:, 0] * dy[:, 1] - dx[:, 1] * dy[:, 0] > 0)
    return result


def main():
    cameras, stream, expected = [camera(i) for i in range(CAMERAS)], [], []
    for fisheye, fx, fy, cx, cy, k, rvec, tvec in cameras:
        rotation = cv2.Rodrigues(rvec)[0]
        world_from_camera = np.eye(4)
        world_from_camera[:3, :3] = rotation.T
        world_from_camera[:3, 3] = -rotation.T @ tvec
        # points that an ideal camera would show on an image a little larger, at 0.5 to 50 units
        u, v = random.uniform(-0.1, 1.1, POINTS) * WIDTH, random.uniform(-0.1, 1.1, POINTS) * HEIGHT
        z = np.exp(random.uniform(np.log(0.5), np.log(50), POINTS))
        local = np.stack([(u - cx) / fx * z, (v - cy) / fy * z, z], 1)
        world = (local - tvec) @ rotation
        if fisheye:
            p = cv2.fisheye.projectPoints(world[:, None], rvec, tvec, np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]), k)[0]
        else:
            p = cv2.projectPoints(world, rvec, tvec, np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]), k)[0]
        expected.append((p.reshape(-1, 2), local))
        header = [float(fisheye), WIDTH, HEIGHT, fx, fy, cx + 0.5, cy + 0.5, len(k)]
        stream.append(np.concatenate([header, np.pad(k, (0, 14 - len(k))), world_from_camera.ravel(), [POINTS],
                                      world.ravel()]))
    run = subprocess.run([sys.argv[1]], input=np.concatenate(stream).tobytes(), stdout=subprocess.PIPE, check=True)
    out = np.frombuffer(run.stdout).reshape(CAMERAS, 2 + 4 * POINTS)

    worst, seen, missed, doubtful = 0.0, 0, 0, 0
    for (fisheye, fx, fy, cx, cy, k, rvec, tvec), (p, local), answer in zip(cameras, expected, out):
        radius, answer = answer[1], answer[2:].reshape(-1, 4)
        valid = answer[:, 3] > 0
        error = np.abs(answer[:, :2] - 0.5 - p) / np.maximum(1, np.abs(p))
        if valid.any():
            worst = max(worst, error[valid].max())
        seen += valid.sum()
        if not fisheye and not valid.all():
            x, y = local[~valid, 0] / local[~valid, 2], local[~valid, 1] / local[~valid, 2]
            good = ~folded(k, x, y)
            # velo's region is the largest disc, not the largest star
            missed += (good & (np.hypot(x, y) < radius * 0.999)).sum()
            doubtful += good.sum()
    total = CAMERAS * POINTS
    print("%d points, %.1f %% valid, worst relative difference %.3g" % (total, 100 * seen / total, worst))
    print("not valid though not folded along the way: %d (%.2f %%), inside the disc: %d" %
          (doubtful, 100 * doubtful / total, missed))
    sys.exit(not (worst <= 1e-9 and seen > 0.7 * total and missed == 0 and doubtful < 0.02 * total))


main()
