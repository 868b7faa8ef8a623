#!/usr/bin/env bash
# velo trace: rays from .csv, .npy and stdin, hits as .csv and .npy, k hits, occlusion; rays that are none are reported; each
# wrong file is one line with its place.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
cat >scene.pbrt <<'SCENE'
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite"
Shape "sphere" "float radius" 1
Shape "trianglemesh" "point3 P" [-9 -9 -2  9 -9 -2  9 9 -2  -9 9 -2] "integer indices" [0 1 2 0 2 3]
SCENE

cat >rays.csv <<'RAYS'
# a comment
ox,oy,oz,dx,dy,dz,t_max

0,0,5,0,0,-1,inf
0, 0, 5, 0, 0, -2, 1.9
3,0,5,0,0,-1,inf
0,0,5,0,1,0,inf
RAYS
check nearest "$VELO" trace scene.pbrt rays.csv
header=ray,hit,valid,t,distance,x,y,z,normal_x,normal_y,normal_z,shading_x,shading_y,shading_z,u,v,velocity_x,velocity_y,velocity_z,object,instance,primitive,material
expect_text header "$header"
expect_text sphere "0,0,1,4,4,0,0,1,0,0,1,0,0,1,"
expect_text too_short "1,0,0,inf,inf,0,0,0,"
expect_text plane "2,0,1,7,7,3,0,-2,0,0,1,"
expect_text sky "3,0,0,inf,inf,"
check several "$VELO" trace scene.pbrt rays.csv --hits 5
expect_text second "0,1,1,6,6,0,0,-1,"
expect_text third "0,2,1,7,7,0,0,-2,"
check occlusion "$VELO" trace scene.pbrt rays.csv --occluded
expect_text blocked "0,1
1,0
2,1
3,0"
check file "$VELO" trace scene.pbrt rays.csv -o hits.csv
check from_stdin bash -c '"$VELO" trace scene.pbrt - <rays.csv | cmp - hits.csv'
printf 'dz,dy,dx,oz,oy,ox\n-1,0,0,5,0,0\n' >turned.csv
check columns_in_any_order "$VELO" trace scene.pbrt turned.csv
expect_text turned "0,0,1,4,4,0,0,1,"
printf '10.5,20.5\n400,300\n' >pixels.csv
check with_unproject bash -c '"$VELO" camera unproject --camera scene.pbrt pixels.csv | "$VELO" trace scene.pbrt -'
expect_text unprojected "1,0,1,"
: >empty.csv
printf '\xef\xbb\xbf"ox","oy",oz,"dx","dy","dz"\r\n0,0,5,0,0,-1\r\n' >sheet.csv
check of_a_spreadsheet "$VELO" trace scene.pbrt sheet.csv
expect_text sheet_hit "0,0,1,4,4,0,0,1,"
check no_rays "$VELO" trace scene.pbrt empty.csv
expect_text no_hits "$header"

# ---- arrays of NumPy
if python3 -c 'import numpy' 2>/dev/null || { PATH=/usr/bin:$PATH && python3 -c 'import numpy' 2>/dev/null; }; then
  python3 - <<'CODE'
import numpy
rays = numpy.array([[0, 0, 5, 0, 0, -1, numpy.inf], [0, 0, 5, 0, 0, -2, 1.9], [3, 0, 5, 0, 0, -1, 100]])
numpy.save("rays.npy", rays)
numpy.save("single.npy", rays.astype(numpy.float32))
numpy.save("columns.npy", numpy.asfortranarray(rays))
numpy.save("whole.npy", rays[:, :6].astype(numpy.int64))
numpy.save("five.npy", rays[:, :5])
numpy.save("line.npy", rays[0])
numpy.save("none.npy", rays[:0])
open("cut.npy", "wb").write(open("rays.npy", "rb").read()[:-8])
open("header.npy", "wb").write(open("rays.npy", "rb").read()[:40])
open("text.npy", "wb").write(b"0,0,5,0,0,-1\n")
CODE
  check array "$VELO" trace scene.pbrt rays.npy --hits 2 -o hits.npy
  check single "$VELO" trace scene.pbrt single.npy --occluded -o blocked.npy
  check no_array "$VELO" trace scene.pbrt none.npy -o none_hits.npy
  check archive "$VELO" trace scene.pbrt rays.npy --hits 2 -o hits.npz
  check archive_of_one "$VELO" trace scene.pbrt rays.npy -o one.npz
  check archive_occluded "$VELO" trace scene.pbrt single.npy --occluded -o blocked.npz
  check archive_of_none "$VELO" trace scene.pbrt none.npy -o none_hits.npz
  check read_archives python3 - <<'CODE'
import numpy, zipfile
hits, several = numpy.load("hits.npy"), numpy.load("hits.npz")
assert zipfile.ZipFile("hits.npz").testzip() is None
assert several.files == list(hits.dtype.names), several.files
for name in several.files:
    numpy.testing.assert_array_equal(several[name], hits[name])
    assert several[name].dtype == hits[name].dtype
one, none = numpy.load("one.npz"), numpy.load("none_hits.npz")
assert one["position"].shape == (3, 3) and one["t"].tolist() == [4, numpy.inf, 7]
assert none["uv"].shape == (0, 2) and none["t"].shape == (0,)
assert numpy.load("blocked.npz")["occluded"].tolist() == [True, False, True]
CODE
  check read_back python3 - <<'CODE'
import numpy
hits, blocked = numpy.load("hits.npy"), numpy.load("blocked.npy")
assert hits.shape == (3, 2) and hits["t"].tolist() == [[4, 6], [numpy.inf] * 2, [7, numpy.inf]], hits["t"]
assert hits["position"].shape == (3, 2, 3) and hits["object_id"][2, 0] == 2 and hits["valid"].dtype == bool
assert blocked.dtype == bool and blocked.tolist() == [True, False, True]
assert numpy.load("none_hits.npy").shape == (0,)
CODE
  while read -r name text; do
    expect_code 3 "$name" "$VELO" trace scene.pbrt "$name.npy"
    expect_line "${name}_words" "$text"
  done <<'WRONG'
columns stored by columns
whole float32 or float64
five 5 numbers
line n x 6
cut shorter than its header
header header is not whole
text not an array of NumPy
WRONG
fi

# ---- rays that are none
printf '0,0,5,nan,0,1\n0,0,5,0,0,0\n1e30,0,5,0,0,1\n0,0,5,0,0,-1\n' >none.csv
check none "$VELO" trace scene.pbrt none.csv
expect_line none_counted "of 4 rays, 1 have a number that is not finite, 1 the direction 0 0 0, and 1 start beyond 1.8e18"
expect_text none_missed "1,0,0,inf,inf,"

# ---- wrong files: one line with the place
wrong() { # wrong NAME PLACE WORDS TEXT
  printf "$4" >"$1.csv"
  expect_code 3 "$1" "$VELO" trace scene.pbrt "$1.csv"
  expect_line "$1_words" "$1.csv:$2: $3"
}
wrong word 2:9 'this is no number' '0,0,5,0,0,-1\n0,0,5,0,x,0\n'
wrong missing 1:7 'a number is missing' '0,0,5,,0,-1\n'
wrong fewer 2:6 'there are fewer numbers' '0,0,5,0,0,-1\n0,0,5\n'
wrong more 2:14 'there are more numbers' '0,0,5,0,0,-1\n0,0,5,0,0,-1,3\n'
wrong blanks 1:1 'a ray has 6 to 9 numbers' '0 0 5 0 0 -1\n'
wrong rest 1:14 'this is no number' '0,0,5,0,0,-1 x\n'
wrong few 1:1 'a ray has 6 to 9 numbers' '0,0,5\n'
wrong unknown 1:19 'unknown column "tmax"; did you mean "t_max"' 'ox,oy,oz,dx,dy,dz,tmax\n'
wrong twice 1:4 'this column is there twice' 'ox,ox,oz,dx,dy,dz\n'
wrong lacking 1:1 'the column dz is missing' 'ox,oy,oz,dx,dy\n'
wrong zero 2:7 'this is no text' '0,0,5,0,0,-1\n0,0,5,\0000,0,-1\n'
wrong quoted 1:4 'the quotation mark at the end of the name is missing' '"ox\n'
wrong archive_in 1:1 'this is an archive' 'PK\003\004'
wrong array_in 1:1 'this is an array of NumPy; its file' '\x93NUMPY\001'
expect_code 4 no_file "$VELO" trace scene.pbrt nowhere.csv
expect_code 2 one_operand "$VELO" trace scene.pbrt
expect_code 2 suffix "$VELO" trace scene.pbrt rays.csv -o hits.json
expect_code 2 both "$VELO" trace scene.pbrt rays.csv --hits 2 --occluded
expect_code 2 too_many "$VELO" trace scene.pbrt rays.csv --hits 257
expect_code 5 no_folder "$VELO" trace scene.pbrt rays.csv -o nowhere/hits.csv
finish
