# Toolchain of the preset `static-aarch64` and of `script/static_libraries aarch64-linux-musl`: Debian's cross compilers for 64-bit
# ARM, with musl as script/static_libraries unpacks it. There is no C++ library: C++ compiles only where it needs none.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
get_filename_component(libraries ${CMAKE_CURRENT_LIST_DIR}/../build/libraries ABSOLUTE)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_C_FLAGS_INIT "-specs ${libraries}/aarch64-linux-musl/musl/specs")
set(CMAKE_CXX_FLAGS_INIT "${CMAKE_C_FLAGS_INIT} -fno-exceptions -fno-rtti -fno-threadsafe-statics")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_SYSTEM_PREFIX_PATH /nowhere) # nothing of this machine's own
