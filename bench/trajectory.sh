#!/usr/bin/env bash
# What a frame costs: 1,000 frames of 64 x 64 pixels, 1 sample each, against the same samples in one image: of 64 x 64
# pixels with 1,000 samples, and of 2024 x 2024 with 1. Seconds of processor time and of the clock, the least of the
# runs, with files written as OpenEXR (packed) and as PFM (not packed: hardly more than the rendering).
# Usage: bench/trajectory.sh [VELO] [SCENE] [RUNS]
velo=${1:-$(dirname "$0")/../build/release/bin/velo}
scene=${2:-$(dirname "$0")/../../shared/scenes/pbrt/cornell-box/cornell-box.pbrt}
runs=${3:-5}
[ -e "$scene" ] || { echo "no such scene: $scene"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/frames"
python3 - "$work/poses.csv" <<'PYTHON'
import math, sys
with open(sys.argv[1], "w") as file:
    file.write("eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z\n")
    for i in range(1000):
        a = 2 * math.pi * i / 1000
        file.write(f"{0.3 * math.sin(a)},{1 + 0.3 * math.cos(a)},6.8,0,1,0\n")
PYTHON
python3 - "$velo" "$scene" "$work" "$runs" <<'PYTHON'
import os, subprocess, sys, time
velo, scene, work, runs = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4])
def measure(arguments):
    before, start = os.times(), time.monotonic()
    subprocess.run([velo, "render", scene, "--quiet", *arguments], check=True)
    after = os.times()
    cpu = after.children_user - before.children_user + after.children_system - before.children_system
    return cpu, time.monotonic() - start
for suffix in ("exr", "pfm"):
    jobs = {"1000 frames": ["--resolution", "64x64", "--spp", "1", "--trajectory", f"{work}/poses.csv", "-o",
                            f"{work}/frames/%04d.{suffix}"],
            "64 x 64 x 1000": ["--resolution", "64x64", "--spp", "1000", "-o", f"{work}/one.{suffix}"],
            "2024 x 2024 x 1": ["--resolution", "2024x2024", "--spp", "1", "-o", f"{work}/large.{suffix}"]}
    best = {name: [1e9, 1e9] for name in jobs}
    for _ in range(runs):  # one after the other, so that a busy machine is busy for all
        for name, arguments in jobs.items():
            best[name] = [min(a, b) for a, b in zip(best[name], measure(arguments))]
    for name, (cpu, wall) in best.items():
        frames = best["1000 frames"]
        print(f"{suffix}  {name:16s} {cpu:6.2f} s of processors, {wall:6.2f} s of the clock; "
              f"the frames cost {frames[0] / cpu:.2f} and {frames[1] / wall:.2f} times that")
PYTHON
