#!/usr/bin/env bash
# The sdist and the wheel of the Python module (python/build_backend.py): the same source gives the same bytes; the wheel's
# RECORD has the digests of its files; pip installs it without network.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
version=$(for part in MAJOR MINOR PATCH; do sed -n "s/^#define VL_VERSION_$part //p" "$VELO_SOURCE_DIR/include/velo/base.h"; done | paste -sd.)
python=/usr/bin/python3
"$python" -c 'import tomllib' 2>/dev/null || { skip wheel "needs Python 3.11"; exit 77; }
export PYTHONDONTWRITEBYTECODE=1 SOURCE_DATE_EPOCH=1767225600
backend() { (cd "$VELO_SOURCE_DIR/python" && "$python" -c "import build_backend; build_backend.$1"); }

mkdir "$work/a" "$work/b" "$work/c"
check "builds an sdist" backend "build_sdist('$work/a')"
sdist=$work/a/velo-$version.tar.gz
check "of the library's version" test -s "$sdist"
tar -C "$work/b" -xf "$sdist"
tree=$work/b/velo-$version
check "PKG-INFO has the version" grep -qx "Version: $version" "$tree/PKG-INFO"
for file in CMakeLists.txt include/velo/base.h python/build_backend.py debian/rules; do
  check "the sdist has $file" cmp "$VELO_SOURCE_DIR/$file" "$tree/$file"
done
check "scripts stay executable" test -x "$tree/script/build"
# The sdist of an unpacked sdist has the same bytes, in another folder and with other times and owners of the files.
find "$tree" -exec touch -d '2001-01-01' {} +
check "builds the sdist again from itself" sh -c "cd '$tree/python' && $python -c \"import build_backend; build_backend.build_sdist('$work/c')\""
check "the same bytes" cmp "$sdist" "$work/c/velo-$version.tar.gz"
SOURCE_DATE_EPOCH=1767225601 backend "build_sdist('$work/c')"
check "another time gives other bytes" sh -c "! cmp -s '$sdist' '$work/c/velo-$version.tar.gz'"

if [ -f "$VELO_BINARY_DIR/python/velo/_velo.abi3.so" ]; then
  settings="{'build-dir': '$VELO_BINARY_DIR'}"
  check "builds a wheel" backend "build_wheel('$work/a', $settings)"
  check "builds it again" backend "build_wheel('$work/c', $settings)"
  wheel=$(basename "$work"/a/*.whl)
  check "the same bytes of the wheel" cmp "$work/a/$wheel" "$work/c/$wheel"
  check "the wheel is for the stable ABI ($wheel)" sh -c "case $wheel in velo-$version-cp311-abi3-*.whl) ;; *) false ;; esac"
  mkdir "$work/lean"
  check "the wheel unpacks" "$python" -m zipfile -e "$work/a/$wheel" "$work/lean"
  check "without what only debuggers read" sh -c "! readelf -SW '$work/lean/velo/_velo.abi3.so' | grep -qE ' \.(symtab|debug)'"
  cat >"$work/record.py" <<'END'
import base64, csv, hashlib, io, sys, zipfile
wheel = zipfile.ZipFile(sys.argv[1])
name = next(n for n in wheel.namelist() if n.endswith(".dist-info/RECORD"))
rows = list(csv.reader(io.StringIO(wheel.read(name).decode())))
assert sorted(row[0] for row in rows) == sorted(wheel.namelist())
for path, digest, size in rows:
    if path != name:
        data = wheel.read(path)
        assert digest == "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode(), path
        assert int(size) == len(data), path
END
  check "RECORD has each file's digest and size" "$python" "$work/record.py" "$work/a/$wheel"
  if "$python" -m pip --version >/dev/null 2>&1; then
    check "pip installs it without network" "$python" -m pip install -q --no-index --no-deps --target "$work/site" "$work/a/$wheel"
    check "import velo" env PYTHONPATH="$work/site" "$python" -c "import velo; assert velo.__file__.startswith('$work/site')"
  else
    skip "pip installs it" "python3-pip is not installed"
  fi
  if command -v patchelf >/dev/null 2>&1 && [ "$(uname -m)" = x86_64 ]; then
    mkdir "$work/full"
    check "makes a wheel with the libraries inside" "$VELO_SOURCE_DIR/tools/bundle_wheel" "$work/a/$wheel" "$work/full"
    full=$(echo "$work"/full/velo-"$version"-cp311-abi3-manylinux_2_36_x86_64.whl)
    check "its RECORD is right" "$python" "$work/record.py" "$full"
    check "it unpacks" "$python" -m zipfile -e "$full" "$work/unpacked"
    cat >"$work/maps.py" <<'END'
import os, velo
paths = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
bundled = {os.path.basename(path).split("-")[0] for path in paths if "/velo.libs/" in path}
assert {"libpng16", "libOpenEXRCore", "libjansson"} <= bundled, paths
others = [path for path in paths if "/velo" not in path and os.path.basename(path).split("-")[0].split(".")[0] in bundled - {"libz", "libexpat", "liblzma"}]
assert not others, others
END
    check "all but Python's own libraries are those inside" env PYTHONPATH="$work/unpacked" "$python" "$work/maps.py"
  else
    skip "a wheel with the libraries inside" "patchelf is not installed"
  fi
else
  skip "wheel" "the Python module is not built"
fi
finish
