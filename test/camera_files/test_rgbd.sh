#!/bin/bash
# RGB-D sequences, there and back: velo's depths and poses, read by numpy, give a mesh that velo sees alike.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
python=/usr/bin/python3 # the one that Debian's packages belong to
if ! $python -c 'import cv2, OpenImageIO' 2>/dev/null; then
  skip "rgbd" "python3-opencv or python3-openimageio is not installed"
  exit 77
fi
check "rgbd" $python "$VELO_SOURCE_DIR/test/camera_files/rgbd.py" "$VELO" "$work"
printf '%s\n' "$out"
finish
