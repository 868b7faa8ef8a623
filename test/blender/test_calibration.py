#!/usr/bin/python3
"""A calibrated OpenCV camera in Blender, calibrated back by OpenCV from boards that velo renders there."""
import importlib.util
import sys

import run_inside

if importlib.util.find_spec("cv2") is None:
    print("skip test_calibration.py: python3-opencv is not installed (script/bootstrap judges)")
    sys.exit(0)
run_inside.main(__file__)
