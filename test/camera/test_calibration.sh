#!/bin/bash
# OpenCV as an independent judge of rendered images: from views of a chessboard it must find a random distorted camera
# again. VELO_CALIBRATIONS=N: N random cameras of each kind (pinhole with 5 and 8 coefficients, fisheye) instead of one.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
python=/usr/bin/python3 # the one that Debian's packages belong to
if ! $python -c 'import cv2' 2>/dev/null; then
  skip "opencv calibrates" "python3-opencv is not installed"
  exit 77
fi
more=()
[ -n "$VELO_CALIBRATIONS" ] && more=(--seeds "$VELO_CALIBRATIONS" --kinds pinhole,rational,fisheye)
check "opencv calibrates" $python "$VELO_SOURCE_DIR/test/camera/calibrate_opencv.py" "$VELO" "$work" "${more[@]}"
printf '%s\n' "$out"
finish
