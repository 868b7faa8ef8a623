#!/bin/bash
# OpenCV as an independent judge of the calibrated lenses: 1,000 random cameras, 1,000 points each, both of its models.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
python=/usr/bin/python3 # the one that Debian's packages belong to
if ! $python -c 'import cv2' 2>/dev/null; then
  skip "opencv agrees" "python3-opencv is not installed"
  exit 77
fi
check "opencv agrees" $python "$VELO_SOURCE_DIR/test/camera/compare_opencv.py" "$VELO_BINARY_DIR/bin/helper_project"
printf '%s\n' "$out"
finish
