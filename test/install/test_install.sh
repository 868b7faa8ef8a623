# An installed velo serves a program from outside: examples/build_world.c is compiled against a temporary prefix by
# pkg-config and by CMake's find_package, shared and static, and its image is checked. The lines of docs/embedding.md run as
# written. What was installed is removed again, and nothing else.
. "$VELO_SOURCE_DIR/test/harness.sh"
prefix=$work/prefix
example=$VELO_SOURCE_DIR/examples/build_world.c

check "cmake --install" cmake --install "$VELO_BINARY_DIR" --prefix "$prefix"
for file in bin/velo include/velo/velo.h lib/libvelo.a lib/libvelo.so lib/pkgconfig/velo.pc lib/pkgconfig/velo-static.pc lib/cmake/velo/veloConfig.cmake; do
  check "installs $file" test -e "$prefix/$file"
done
# ---- versions: of the program, of the file names, of the ABI ----
define() { sed -n "s/^#define VL_VERSION_$1 //p" "$VELO_SOURCE_DIR/include/velo/base.h"; }
version=$(define MAJOR).$(define MINOR).$(define PATCH)
abi=$(define MAJOR)
[ "$abi" = 0 ] && abi=0.$(define MINOR)
expect_code 0 "the installed program runs" "$prefix/bin/velo" --version
expect_text "--version: the version" "velo $version"
expect_text "--version: the compiler" "compiler          "
expect_text "--version: instruction sets" "instruction sets  x86-64-v2, x86-64-v3, x86-64-v4; here x86-64-v"
lines=$out
embree=
if grep -q embree "$prefix/lib/pkgconfig/velo-static.pc"; then embree=Embree; fi
if [ -z "$embree" ]; then check "--version: no Embree" test "${lines#*Embree}" = "$lines"; fi
for library in $embree OpenEXR libpng libjpeg-turbo zlib jansson libyaml expat libwebp meshoptimizer; do
  check "--version: $library" sh -c "printf '%s' \"\$1\" | grep -qE '$library [0-9]+[.0-9]*'" sh "$lines"
done
if commit=$(git -C "$VELO_SOURCE_DIR" rev-parse --short=12 HEAD 2>/dev/null) &&
  [ -z "$(git -C "$VELO_SOURCE_DIR" rev-parse --show-cdup)" ]; then
  check "--version: a commit" sh -c "printf '%s' \"\$1\" | grep -qE '^commit            [0-9a-f]{7}|^commit            v?[0-9.]+'" sh "$lines"
fi
soname=$(readelf -d "$prefix/lib/libvelo.so" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p')
check "the SONAME is of the ABI ($soname)" test "$soname" = "libvelo.so.$abi"
check "the file is of the version" test -f "$prefix/lib/libvelo.so.$version"
check "pkg-config has the version" test "$(PKG_CONFIG_PATH=$prefix/lib/pkgconfig pkg-config --modversion velo)" = "$version"
check "the changelog has the version" grep -q "^## $version" "$VELO_SOURCE_DIR/CHANGELOG.md"

# The prefix may be moved: nothing in it names where it was made.
mv "$prefix" "$work/moved"
prefix=$work/moved
check "no path of the build tree is installed" sh -c "! grep -rIl '$VELO_BINARY_DIR' '$prefix'"

export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
flags=$(pkg-config --cflags --libs velo)
# shellcheck disable=SC2086
check "compiles by pkg-config" gcc -std=c17 -Wall -Wextra -Werror "$example" $flags -Wl,-rpath,"$prefix/lib" -o "$work/by_pkg_config"
check "runs" "$work/by_pkg_config" "$work/a.png" "$work/a.exr"

# ---- the lines of docs/embedding.md, as written, from the tree's root; the prefix stands for one that the loader searches ----
readme() { grep -m1 "^cc .*$1" "$VELO_SOURCE_DIR/docs/embedding.md" | sed "s,-o build_world,-o '$work/readme',"; }
for kind in "libs velo)" "libs velo-static)"; do
  line=$(readme "$kind")
  check "docs/embedding.md: $kind has a line" test -n "$line"
  rm -f "$work/readme"
  check "docs/embedding.md: $line" sh -c "cd '$VELO_SOURCE_DIR' && $line"
  check "docs/embedding.md: $kind runs" env LD_LIBRARY_PATH="$prefix/lib" "$work/readme" "$work/readme.exr"
  check "docs/embedding.md: $kind has the same image" cmp "$work/a.exr" "$work/readme.exr"
done
check "the static program needs no libvelo.so" sh -c "! ldd '$work/readme' | grep -q libvelo"
# shellcheck disable=SC2046
check "--static with velo.pc links, too" gcc -std=c17 "$example" $(pkg-config --static --cflags --libs velo) -o "$work/both"

mkdir "$work/project"
cat >"$work/project/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.25)
project(outside C)
find_package(velo 0.1 REQUIRED COMPONENTS static)
add_executable(shared "$example")
target_link_libraries(shared PRIVATE velo::velo)
add_executable(static "$example")
target_link_libraries(static PRIVATE velo::velo_static)
END
check "configures by find_package" cmake -G Ninja -S "$work/project" -B "$work/outside" -DCMAKE_PREFIX_PATH="$prefix"
check "compiles by find_package" cmake --build "$work/outside"
check "runs with the static library" "$work/outside/static" "$work/b.exr"
check "links the shared library" sh -c "ldd '$work/outside/shared' | grep -q '$prefix/lib/libvelo.so.$abi'"
check "the same bytes from both" cmp "$work/a.exr" "$work/b.exr"

# The lecture's image, roughly: not black, nothing out of the finite, a red sphere where (0, 0, -50) is seen.
cat >"$work/look.py" <<'END'
import sys
import numpy
with open(sys.argv[1], "rb") as file: # a PFM: two lines of text and floats, the lowest row first
    assert file.readline() == b"PF\n"
    width, height = map(int, file.readline().split())
    order = "<f4" if float(file.readline()) < 0 else ">f4"
    image = numpy.frombuffer(file.read(), order).reshape(height, width, 3)[::-1]
assert image.shape == (300, 400, 3), image.shape
assert numpy.isfinite(image).all()
assert 0.02 < image.mean() < 5, image.mean()
red, green, blue = image[140:160, 190:210].mean(axis=(0, 1))
assert red > 2 * green and red > 2 * blue, (red, green, blue)
END
check "the image becomes a PFM" "$prefix/bin/velo" image convert "$work/a.exr" "$work/a.pfm"
check "the image shows the world" /usr/bin/python3 "$work/look.py" "$work/a.pfm"
check "so does the PNG" test -s "$work/a.png"

# ---- a program that was compiled with the headers of another ABI version is refused ----
cp -r "$prefix/include" "$work/newer"
sed -i 's/^#define VL_VERSION_MINOR .*/#define VL_VERSION_MINOR 99/' "$work/newer/velo/base.h"
check "compiles with other headers" gcc -std=c17 -I"$work/newer" "$example" -L"$prefix/lib" -lvelo -Wl,-rpath,"$prefix/lib" -o "$work/newer/program"
expect_code 1 "another ABI is refused" "$work/newer/program" "$work/c.png"
expect_text "another ABI: the context says so" "context"

# ---- uninstall: into a folder that holds other files ----
removed=$work/removed
mkdir -p "$removed/lib/pkgconfig" "$removed/bin"
touch "$removed/lib/pkgconfig/other.pc" "$removed/bin/other"
check "installs again" cmake --install "$VELO_BINARY_DIR" --prefix "$removed"
check "uninstall" cmake --build "$VELO_BINARY_DIR" --target uninstall
left=$(cd "$removed" && find . -type f -o -type l | sort | tr '\n' ' ')
check "leaves what was there ($left)" test "$left" = "./bin/other ./lib/pkgconfig/other.pc "
check "leaves no folder of velo's" sh -c "! find '$removed' -type d -name velo | grep -q ."
finish
