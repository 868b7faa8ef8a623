#!/usr/bin/python3
"""How well images on surfaces are filtered: a checkerboard to the horizon, and seen in mirrors and through glass.

    bench/texture_filter.py VELO [FOLDER] [--image FILE]

Needs numpy and cv2 (Debian: python3-opencv). The reference is the same image 8 times as wide and high at 16 samples,
averaged: its footprints are an eighth. Printed for each part of the image: noise, as the mean square error over the
squared mean; contrast, the regression of the image on the reference (1: nothing is blurred). --image: 1 sample of
the procedural checkerboard (never filtered) above 1 and 16 samples of the image texture."""
import os
import subprocess
import sys

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2  # noqa: E402
import numpy as np  # noqa: E402

W, H = 320, 180
MIRRORS = """
Material "conductor" "spectrum reflectance" [300 0.95 900 0.95] "float roughness" 0
AttributeBegin
Translate 0 1 5
Shape "sphere" "float radius" 1
AttributeEnd
AttributeBegin
Translate 1.9 0.8 4
Rotate 20 0 1 0
Shape "trianglemesh" "point3 P" [-0.6 -0.8 0 0.6 -0.8 0 0.6 0.9 0 -0.6 0.9 0] "integer indices" [0 1 2 0 2 3]
AttributeEnd
Material "dielectric"
AttributeBegin
Translate -1.9 0.9 5
Shape "sphere" "float radius" 0.9
AttributeEnd
"""
PARTS = {"plane": {"far": (70, 92, 0, W), "middle": (92, 115, 0, W), "near": (115, 180, 0, W)},
         "mirrors": {"ball": (60, 130, 135, 185), "mirror": (60, 120, 50, 100), "glass": (60, 130, 230, 290)}}


def scene(folder, name, texture, things):
    path = os.path.join(folder, name + ".pbrt")
    with open(path, "w", encoding="ascii") as out:
        out.write(f"""LookAt 0 1 0  0 0.55 4  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" {W} "integer yresolution" {H}
PixelFilter "box"
Integrator "path" "integer maxdepth" 6
WorldBegin
LightSource "distant" "point3 from" [0.3 1 -0.2] "point3 to" [0 0 0] "spectrum L" [300 1 900 1]
Texture "c" "spectrum" {texture}
Material "diffuse" "texture reflectance" "c"
Shape "trianglemesh" "point3 P" [-500 0 -20  500 0 -20  500 0 980  -500 0 980] "integer indices" [0 1 2 0 2 3]
  "point2 uv" [-50 -2 50 -2 50 98 -50 98]
{things}""")
    return path


def render(velo, path, size, spp):
    out = path + ".exr"
    subprocess.run([velo, "render", path, "--resolution", f"{size[0]}x{size[1]}", "--spp", str(spp), "--quiet", "-o", out],
                   check=True)
    return cv2.imread(out, cv2.IMREAD_UNCHANGED)[..., 1].astype(np.float64)


def main():
    arguments = sys.argv[1:]
    picture = None
    if "--image" in arguments:
        at = arguments.index("--image")
        picture = arguments[at + 1]
        del arguments[at:at + 2]
    velo, folder = arguments[0], arguments[1] if len(arguments) > 1 else "/tmp"
    os.makedirs(folder, exist_ok=True)
    cell = np.arange(1024) // 8
    grey = np.where((cell[:, None] + cell[None, :]) & 1, 230, 12).astype(np.uint8)
    cv2.imwrite(os.path.join(folder, "checks.png"), cv2.merge([grey] * 3))
    texture = '"imagemap" "string filename" "checks.png" "string filter" "{}"'
    if picture:
        procedural = '"checkerboard" "float uscale" 128 "float vscale" 128 "rgb tex1" [0.003 0.003 0.003] "rgb tex2" [0.8 0.8 0.8]'
        bare = render(velo, scene(folder, "bare", procedural, MIRRORS), (480, 270), 1)
        path = scene(folder, "filtered", texture.format("trilinear"), MIRRORS)
        rows = [bare] + [render(velo, path, (480, 270), spp) for spp in (1, 16)]
        show = np.vstack([r[60:230] for r in rows])
        cv2.imwrite(picture, np.clip(show * 1.6, 0, 1) ** (1 / 2.2) * 255, [cv2.IMWRITE_JPEG_QUALITY, 80])
        return
    for name, things in (("plane", ""), ("mirrors", MIRRORS)):
        path = scene(folder, "reference", texture.format("bilinear"), things)
        reference = render(velo, path, (8 * W, 8 * H), 16).reshape(H, 8, W, 8).mean((1, 3))
        for kind in ("bilinear", "trilinear"):
            path = scene(folder, name, texture.format(kind), things)
            for spp in (1, 16, 256):
                got, cells = render(velo, path, (W, H), spp), []
                for part, (y0, y1, x0, x1) in PARTS[name].items():
                    a, r = got[y0:y1, x0:x1], reference[y0:y1, x0:x1]
                    d = r - r.mean()
                    cells.append(f"{part}: noise {((a - r) ** 2).mean() / r.mean() ** 2:.5f} "
                                 f"contrast {((a - a.mean()) * d).sum() / (d * d).sum():.3f}")
                print(f"{name} {kind:9} {spp:3} spp  " + "  ".join(cells), flush=True)


main()
