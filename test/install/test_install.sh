# An installed velo serves a program from outside: examples/build_world.c is compiled against a temporary prefix by
# pkg-config and by CMake's find_package, shared and static, and its picture is looked at.
. "$VELO_SOURCE_DIR/test/harness.sh"
prefix=$work/prefix
example=$VELO_SOURCE_DIR/examples/build_world.c

check "cmake --install" cmake --install "$VELO_BINARY_DIR" --prefix "$prefix"
for file in bin/velo include/velo/velo.h lib/libvelo.a lib/libvelo.so lib/pkgconfig/velo.pc lib/cmake/velo/veloConfig.cmake; do
  check "installs $file" test -e "$prefix/$file"
done
check "the installed program runs" "$prefix/bin/velo" --version

# The prefix may be moved: nothing in it names where it was made.
mv "$prefix" "$work/moved"
prefix=$work/moved
check "no path of the build tree is installed" sh -c "! grep -rIl '$VELO_BINARY_DIR' '$prefix'"

export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
flags=$(pkg-config --cflags --libs velo)
# shellcheck disable=SC2086
check "compiles by pkg-config" gcc -std=c17 -Wall -Wextra -Werror "$example" $flags -Wl,-rpath,"$prefix/lib" -o "$work/by_pkg_config"
check "runs" "$work/by_pkg_config" "$work/a.png" "$work/a.exr"

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
check "links the shared library" sh -c "ldd '$work/outside/shared' | grep -q '$prefix/lib/libvelo.so.0'"
check "the same bytes from both" cmp "$work/a.exr" "$work/b.exr"

# The lecture's picture, roughly: not black, nothing out of the finite, a red sphere where (0, 0, -50) is seen.
cat >"$work/look.py" <<'END'
import sys
import numpy
import OpenImageIO
picture = OpenImageIO.ImageBuf(sys.argv[1]).get_pixels(OpenImageIO.FLOAT)[:, :, :3]
assert picture.shape == (300, 400, 3), picture.shape
assert numpy.isfinite(picture).all()
assert 0.02 < picture.mean() < 5, picture.mean()
red, green, blue = picture[140:160, 190:210].mean(axis=(0, 1))
assert red > 2 * green and red > 2 * blue, (red, green, blue)
END
check "the picture shows the world" /usr/bin/python3 "$work/look.py" "$work/a.exr"
check "so does the PNG" test -s "$work/a.png"
finish
