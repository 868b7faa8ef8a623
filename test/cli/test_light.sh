#!/bin/bash
# velo light info: what it prints, its diagram, and its messages about wrong files.
. "$(dirname "$0")/../harness.sh"
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1
export VELO

# refused NAME CODE TEXT COMMAND...: that exit code, and one line with the text.
refused() {
  local name=$1 wanted=$2 text=$3
  shift 3
  expect_code "$wanted" "$name" "$@"
  expect_line "$name: message" "$text"
}

# An even lamp of 100 cd: 400 pi lumens.
printf 'IESNA:LM-63-2002\n[LUMINAIRE] Ball & <globe>\nTILT=NONE\n2 1000 100 2 1 1 2 0 0 0\n1 1 25\n0 180\n0\n1 1\n' >ball.ies

check "text" bash -c '"$VELO" light info ball.ies >text.txt'
for line in 'format          IES LM-63-2002, photometry of type C, 1 x 2 angles' 'luminaire       Ball & <globe>' \
  'flux            1256.64 lm' 'flux of lamps   2000 lm' 'ratio           62.83 %' 'power           25 W (50.27 lm/W)' \
  'beam angle      360.00 and 360.00 degrees' 'maximum         100 cd' '        90       100       100       100       100'; do
  check "text: $line" grep -qF "$line" text.txt
done
check "json" bash -c '"$VELO" light info --json ball.ies -o ball.svg >info.json'
check "json: numbers" python3 -c '
import json, math
info = json.load(open("info.json"))
assert abs(info["flux_lm"] - 400 * math.pi) < 1e-3 and info["lamps_flux_lm"] == 2000 and info["photometry"] == "C", info
assert abs(info["beam_angle_degrees"][0] - 360) < 1e-6 and abs(info["ratio"] - .2 * math.pi) < 1e-6, info'
check "svg: a whole document with a title" python3 -c '
import xml.dom.minidom
svg = xml.dom.minidom.parse("ball.svg")
assert svg.getElementsByTagName("title")[0].firstChild.data == "Ball & <globe>"
assert len(svg.getElementsByTagName("path")) == 2'
check "eulumdat" bash -c '"$VELO" light info "$0" | grep -q "format          EULUMDAT, photometry of type C, 3 x 3"' \
  "$VELO_SOURCE_DIR/test/fuzz/corpus/table/bracket.ldt"

refused "an angle that falls" 3 "bad.ies:6: lamp file: the vertical angle 0 follows 180" \
  bash -c 'sed "s/^0 180/180 0/" ball.ies >bad.ies; "$VELO" light info bad.ies'
refused "no lamp file" 3 "scene.txt:" bash -c 'printf "WorldBegin\n" >scene.txt; "$VELO" light info scene.txt'
refused "missing" 4 "none.ies" "$VELO" light info none.ies
refused "its own file" 2 "ball.ies" "$VELO" light info ball.ies -o ball.ies
refused "a file without a command" 2 'did you mean "velo light info ball.ies"?' "$VELO" ball.ies

printf 'WorldBegin\nLightSource "goniometric" "string filename" "bad.ies"\nShape "sphere"\n' >scene.pbrt
refused "in a scene" 3 "bad.ies:6: lamp file: the vertical angle 0 follows 180" "$VELO" render scene.pbrt -o a.pfm
sed 's/bad/ball/' scene.pbrt >good.pbrt
check "a scene converts to itself" bash -c '"$VELO" scene convert good.pbrt again.pbrt && grep -q "\.ies\"" again.pbrt && "$VELO" render again.pbrt --dry-run'
check "it is an input: not overwritten" bash -c '! "$VELO" render good.pbrt -o ball.ies.exr --film ball.ies 2>/dev/null'

# The luminance of a sky of 3 cd/m2.
printf 'Film "rgb" "integer xresolution" 8 "integer yresolution" 8 "float iso" 400\nWorldBegin\nLightSource "infinite" "float scale" 3\n' >sky.pbrt
check "luminance" "$VELO" render sky.pbrt --quiet --spp 64 --channels luminance -o sky.exr
check "luminance: a channel" bash -c '"$VELO" image info sky.exr | grep -q "R G B A luminance.Y"'
check "luminance: before exposure" bash -c '"$VELO" image convert sky.exr sky.pfm --channel luminance.Y && python3 -c "
import struct
data = open(\"sky.pfm\", \"rb\").read()
values = struct.unpack(\"<64f\", data[-256:])
assert abs(sum(values) / 64 - 3) < .03, values[:4]"'
# The light of a lamp in a room of centimetres: 40,000 times that of 1 unit = 2 m.
printf 'Camera "perspective"\nFilm "rgb" "integer xresolution" 8 "integer yresolution" 8\nSampler "independent" "integer pixelsamples" 4\nWorldBegin\nLightSource "point"\nTranslate 0 0 3\nShape "disk" "float radius" 9\n' >lamp.pbrt
mean() { "$VELO" image convert "$1" mean.pfm && python3 -c '
import struct
data = open("mean.pfm", "rb").read()
print(sum(struct.unpack("<192f", data[-768:])))'; }
for unit in cm 0.01 2; do "$VELO" render lamp.pbrt --quiet --scene-unit $unit -o lamp_$unit.exr; done
check "scene unit by name" "$VELO" image diff lamp_cm.exr lamp_0.01.exr
check "scene unit" python3 -c "assert abs($(mean lamp_cm.exr) / $(mean lamp_2.exr) / 40000 - 1) < 1e-4"
refused "no unit" 2 "--scene-unit (or m, cm, mm, km, in, ft)" "$VELO" render lamp.pbrt --scene-unit yard -o none.exr
refused "a unit of 0" 2 "--scene-unit" "$VELO" render lamp.pbrt --scene-unit 0 -o none.exr
"$VELO" render lamp.pbrt --quiet --scene-unit cm --film lamp.film
check "a film remembers its unit" "$VELO" render lamp.pbrt --quiet --scene-unit cm --film lamp.film
refused "a film of another unit" 2 "unit" "$VELO" render lamp.pbrt --quiet --spp 8 --film lamp.film

refused "luminance: no standard observer" 3 "--channels luminance needs the sensor cie1931" \
  "$VELO" render sky.pbrt --sensor canon_eos_5d --channels luminance -o none.exr

finish
