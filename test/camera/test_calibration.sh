#!/bin/bash
# OpenCV as an independent judge of rendered pictures: from views of a chessboard it must find random distorted cameras
# again. By hand, more of them: calibrate_opencv.py VELO FOLDER CAMERAS VIEWS.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
python=/usr/bin/python3 # the one that Debian's packages belong to
if ! $python -c 'import cv2' 2>/dev/null; then
  skip "opencv calibrates" "python3-opencv is not installed"
  exit 77
fi
check "opencv calibrates" $python "$VELO_SOURCE_DIR/test/camera/calibrate_opencv.py" "$VELO" "$work"
printf '%s\n' "$out"
finish
