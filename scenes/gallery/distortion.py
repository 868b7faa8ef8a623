#!/usr/bin/python3
"""distortion.py FILE: the lecture's five pairs of distance and view plane (e, d) side by side. Needs the module velo (docs/python.md)."""
import os
import sys

import numpy
import velo

LECTURE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../lecture")
PAIRS = ("e2_d85", "e15_d875", "e2_5_d280", "e5_d750", "e10_d1687")

views = [velo.load(f"{LECTURE}/distortion_{pair}.pbrt").render(spp=256, resolution=(316, 316), denoise=True) for pair in PAIRS]
strip = numpy.ones((316, 1600, 3), numpy.float32)
for i, view in enumerate(views):
    strip[:, 321 * i:321 * i + 316] = numpy.asarray(view)[:, :, :3]
velo.Image(strip).write(sys.argv[1])
