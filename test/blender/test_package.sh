#!/usr/bin/env bash
# The files for Blender (tools/bundle_addon): the same bytes each time; with the Python module inside, Blender installs one by its own function,
# and renders where its Python has no velo.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
here=$VELO_SOURCE_DIR/test/blender
python=/usr/bin/python3
"$python" -c 'import tomllib' 2>/dev/null || { skip package "needs Python 3.11"; finish; }
export PYTHONDONTWRITEBYTECODE=1 SOURCE_DATE_EPOCH=1767225600
bundle=$VELO_SOURCE_DIR/tools/bundle_addon

expect_code 2 usage "$bundle"
check alone "$bundle" "$work/alone.zip"
check again "$bundle" "$work/again.zip"
check same_bytes cmp "$work/alone.zip" "$work/again.zip"
check all_files test "$("$python" -m zipfile -l "$work/alone.zip" | grep -c '\.py ')" = "$(ls "$VELO_SOURCE_DIR"/blender/velo_blender/*.py | wc -l)"
manifest() { # ZIP KEY
  "$python" -c 'import sys, tomllib, zipfile
text = zipfile.ZipFile(sys.argv[1]).read("velo_blender/blender_manifest.toml").decode()
print(tomllib.loads(text).get(sys.argv[2]))' "$work/$1" "$2"
}
check no_platform test "$(manifest alone.zip platforms)" = None
version=$(sed -n 's/^ *"version": (\(.*\)),/\1/p' "$VELO_SOURCE_DIR/blender/velo_blender/__init__.py" | sed 's/, /./g')
check version test "$(manifest alone.zip version)" = "$version"

reason=$(PYTHONPATH=$here "$python" -c 'import run_inside; print(run_inside.why_not() or "")')
if [ -n "$reason" ]; then
  skip installed "$reason"
  finish
fi
mkdir "$work/wheels"
check wheel sh -c "cd '$VELO_SOURCE_DIR/python' && '$python' -c \"import build_backend; build_backend.build_wheel('$work/wheels', {'build-dir': '$VELO_BINARY_DIR'})\""
check whole "$bundle" "$work/whole.zip" "$work"/wheels/*.whl
check platform test "$(manifest whole.zip platforms)" = "['linux-x64']"
cat >"$work/install.py" <<'END'
import sys
import bpy
bpy.ops.preferences.addon_install(filepath=sys.argv[-2])
bpy.ops.preferences.addon_enable(module="velo_blender")
import velo
print("module", velo.__file__)
scene = bpy.context.scene
scene.render.engine = "VELO"
scene.render.resolution_x, scene.render.resolution_y = 40, 30
scene.cycles.samples = 2
scene.render.filepath = sys.argv[-1]
bpy.ops.render.render(write_still=True)
END
install() { # ZIP IMAGE: its own folders, in which there is no velo
  env -u PYTHONPATH HOME="$work/home" BLENDER_USER_SCRIPTS="$work/user/$1" BLENDER_USER_CONFIG="$work/config" \
    blender -b --factory-startup -P "$work/install.py" -- "$work/$1" "$2" 2>&1
}
mkdir -p "$work/user/alone.zip" "$work/user/whole.zip" "$work/home"
install whole.zip "$work/image.png" >"$work/whole.log"
if env -u PYTHONPATH "$python" -c 'import velo' 2>/dev/null; then
  skip module "python3-velo is installed"
else
  check module grep -q "^module $work/user/whole.zip/addons/velo_blender/modules/velo/" "$work/whole.log"
  install alone.zip "$work/none.png" >"$work/alone.log"
  check says grep -q 'velo in Blender needs the Python module velo: install python3-velo' "$work/alone.log"
fi
run "$VELO" image info "$work/image.png"
expect_text rendered '40 x 30'
finish
