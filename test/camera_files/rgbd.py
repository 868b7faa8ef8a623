"""rgbd.py VELO FOLDER: an RGB-D sequence as TUM and ICL-NUIM keep theirs (a calibration with the first pixel's centre in
the origin, groundtruth.txt, 16-bit depth PNGs) is made of a scene by velo, turned back into space by numpy from nothing but
those files, and the mesh of its first frame seen again by velo from the next poses. ICL-NUIM's calibration has a negative
fy. The numbers are pixels and millimetres."""
import os
import subprocess
import sys

import cv2
import numpy as np
import OpenImageIO

SCENE = """Film "rgb" "integer xresolution" 64 "integer yresolution" 48
Camera "perspective"
Integrator "path" "integer maxdepth" 0
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -4 -3 5  4 -3 5  -4 3 4  4 3 6 ]
Shape "bilinearmesh" "point3 P" [ -4 1.5 0  4 1.5 0  -4 1.5 8  4 1.5 8 ]
Translate 0.4 0.6 3
Shape "sphere" "float radius" [ 0.7 ]
"""
WIDTH, HEIGHT = 640, 480
failures = []


def quaternion(axis, angle):
    axis = np.array(axis, float) / np.linalg.norm(axis)
    return np.append(axis * np.sin(angle / 2), np.cos(angle / 2))


def rotation(q):
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def channels(path, *names):
    image = OpenImageIO.ImageInput.open(path)
    spec = image.spec()
    pixels = image.read_image(OpenImageIO.FLOAT)
    image.close()
    return np.stack([pixels[:, :, spec.channelnames.index(n)] for n in names], -1).astype(float)


def back_project(depth, k, pose):
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH].astype(float)
    camera = np.stack([(u - k[2]) / k[0] * depth, (v - k[3]) / k[1] * depth, depth], -1)
    return camera @ pose[0].T + pose[1]


def project(points, k, pose):
    camera = (points - pose[1]) @ pose[0]
    with np.errstate(all="ignore"):
        return camera[..., 0] / camera[..., 2] * k[0] + k[2], camera[..., 1] / camera[..., 2] * k[1] + k[3], camera[..., 2]


def write_ply(path, points, depth):
    """A triangle's corners are neighbours of much the same depth."""
    index = np.arange(HEIGHT * WIDTH).reshape(HEIGHT, WIDTH)
    faces = np.concatenate([np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:]], -1).reshape(-1, 3),
                            np.stack([index[:-1, :-1], index[1:, 1:], index[1:, :-1]], -1).reshape(-1, 3)])
    d = depth.ravel()[faces]
    faces = faces[(d.min(1) > 0) & (d.max(1) - d.min(1) < 0.02 * d.min(1))]
    with open(path, "wb") as f:
        f.write(("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
                 "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (WIDTH * HEIGHT, len(faces))).encode())
        f.write(points.reshape(-1, 3).astype("<f4").tobytes())
        rows = np.zeros(len(faces), [("n", "u1"), ("i", "<i4", 3)])
        rows["n"], rows["i"] = 3, faces
        f.write(rows.tobytes())


def expect(what, value, limit, unit):
    print("  %-66s %.3g %s" % (what, value, unit))
    if not value <= limit:
        failures.append("%s: %g, above %g" % (what, value, limit))


def judge(velo, name, k, factor):
    def run(*arguments):
        subprocess.run([velo, *arguments], check=True, stderr=subprocess.DEVNULL if "convert" in arguments else None)
    print(name)
    with open("K.yaml", "w") as f:
        f.write("image_width: %d\nimage_height: %d\ncamera_matrix: [%g, 0, %g, 0, %g, %g, 0, 0, 1]\n"
                "distortion_coefficients: [0, 0, 0, 0]\n"
                % (WIDTH, HEIGHT, k[0], k[2], k[1], k[3]))
    turns = [quaternion([1, 2, 0.5], 0.05), quaternion([0.2, -1, 0.3], 0.12), quaternion([-1, 1, 2], 0.15)]
    places = [[0, 0, 0], [0.15, -0.05, 0.1], [-0.2, 0.1, 0.05]]
    with open("groundtruth.txt", "w") as f:
        f.write("# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n")
        for i in range(3):
            f.write("%.4f %r %r %r %.17g %.17g %.17g %.17g\n" % (1311868164.3632 + i / 30, *places[i], *turns[i]))
    poses = [(rotation(q), np.array(t, float)) for q, t in zip(turns, places)]
    run("render", "scene.pbrt", "--camera", "K.yaml", "--trajectory", "groundtruth.txt", "--channels", "Z,P", "--spp", "1",
        "--quiet", "-o", "frame_%04d.exr")
    exact, depth = [], []
    for i in range(3):
        run("image", "convert", "frame_%04d.exr" % i, "depth_%04d.png" % i, "--channel", "Z", "--scale", str(factor))
        png = cv2.imread("depth_%04d.png" % i, cv2.IMREAD_UNCHANGED)
        assert png.dtype == np.uint16 and png.shape == (HEIGHT, WIDTH), (png.dtype, png.shape)
        depth.append(png / factor)
        z = channels("frame_%04d.exr" % i, "Z")[:, :, 0]
        exact.append(np.where(np.isfinite(z), z, 0))
        if i == 0:
            met = exact[0] > 0
            print("  %.0f %% of the pixels have a depth" % (100 * met.mean()))
            expect("depth PNG against Z, at most", 1000 * np.abs(depth[0] - exact[0]).max(), 500.5 / factor, "mm")
            points = channels("frame_0000.exr", "P.X", "P.Y", "P.Z")
            expect("numpy's points against the channel P, at most",
                   1000 * np.abs(back_project(exact[0], k, poses[0]) - points)[met].max(), 0.002, "mm")
    met, points = exact[0] > 0, back_project(exact[0], k, poses[0])
    write_ply("mesh.ply", back_project(depth[0], k, poses[0]), depth[0])
    with open("rebuilt.pbrt", "w") as f:
        f.write(SCENE[:SCENE.index("Shape")] + 'Shape "plymesh" "string filename" "mesh.ply"\n')
    run("render", "rebuilt.pbrt", "--camera", "K.yaml", "--trajectory", "groundtruth.txt", "--channels", "Z", "--spp", "1", "--quiet",
        "-o", "rebuilt_%04d.exr")
    for i in range(3):
        again = channels("rebuilt_%04d.exr" % i, "Z")[:, :, 0]
        both = np.isfinite(again) & (exact[i] > 0)
        off = np.abs(again - exact[i])[both]
        share = 100 * both.mean()
        print("  frame %d: the rebuilt scene covers %.0f %%" % (i, share))
        expect("its depth against the sequence's, median", 1000 * np.median(off), 700 / factor, "mm")
        expect("95 of 100 pixels within", 1000 * np.quantile(off, 0.95), 2000 / factor, "mm")
        # how far points of the first frame land from where they do with exact depths
        u, v, z = project(points, k, poses[i])
        pu, pv, _ = project(back_project(depth[0], k, poses[0]), k, poses[i])
        inside = met & (z > 0.1) & (u > 0) & (u < WIDTH - 1) & (v > 0) & (v < HEIGHT - 1)
        expect("pixels of frame 0 seen from here, moved by the PNG's rounding", np.hypot(u - pu, v - pv)[inside].max(), 0.1, "px")
        # the pixel that velo says sees a point is the one that numpy finds
        seen = channels("frame_%04d.exr" % i, "P.X", "P.Y", "P.Z")
        hu, hv, _ = project(seen, k, poses[i])
        y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
        expect("channel P put through K and pose, off the pixel's centre", np.hypot(hu - x, hv - y)[exact[i] > 0].max(), 1e-3, "px")


def main():
    velo = sys.argv[1]
    os.chdir(sys.argv[2])
    with open("scene.pbrt", "w") as f:
        f.write(SCENE)
    judge(velo, "TUM: freiburg1's camera, 5000 a metre", (517.3, 516.5, 318.6, 255.3), 5000)
    judge(velo, "ICL-NUIM: fy below zero, 1000 a metre", (481.2, -480.0, 319.5, 239.5), 1000)
    for f in failures:
        print("not ok: " + f)
    sys.exit(bool(failures))


main()
