#!/bin/bash
# OpenCV's Charuco detector on rendered boards of its own dictionary: every marker is read, and its calibration finds the
# camera again.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
python=/usr/bin/python3 # the one that Debian's packages belong to
if ! $python -c 'import cv2; cv2.aruco.CharucoBoard_create' 2>/dev/null; then
  skip "charuco calibrates" "python3-opencv 4.6 with its aruco module is not installed"
  exit 77
fi
check "charuco calibrates" $python "$VELO_SOURCE_DIR/test/camera/charuco_opencv.py" "$VELO" "$work"
printf '%s\n' "$out"
finish
