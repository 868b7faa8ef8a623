# Toolchain of script/cross-aarch64: Debian's cross compiler for 64-bit ARM and a folder VELO_SYSROOT into which Debian's
# arm64 packages are unpacked. VELO_HOST_TOOLS is the folder of color_tables and albedo_tables that run on this machine.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VELO_SYSROOT)

set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER CMAKE_CXX_COMPILER-NOTFOUND) # without Draco: this machine's own C++ compiler would be taken
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_SYSROOT ${VELO_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

set(ENV{PKG_CONFIG_SYSROOT_DIR} ${VELO_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${VELO_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${VELO_SYSROOT}/usr/share/pkgconfig)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L ${VELO_SYSROOT})
