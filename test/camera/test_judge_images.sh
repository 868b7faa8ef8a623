#!/bin/bash
# Images of a toe-in pair, of a tilted lens and of a lens of many elements, measured: OpenCV finds the pair's angle and base
# line again; spots are where, and as wide as, the laws of optics put them.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
python=/usr/bin/python3 # the one that Debian's packages belong to
if ! $python -c 'import cv2' 2>/dev/null; then
  skip "images are judged" "python3-opencv is not installed"
  exit 77
fi
export PYTHONDONTWRITEBYTECODE=1
check "images are judged" $python "$VELO_SOURCE_DIR/test/camera/judge_images.py" "$VELO" "$work"
printf '%s\n' "$out"
check "blur is judged" $python "$VELO_SOURCE_DIR/test/camera/judge_blur.py" "$VELO" "$work"
printf '%s\n' "$out"
finish
