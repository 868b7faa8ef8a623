# Toolchain of the preset `wasm` and of `script/static_libraries wasm`: Debian's emscripten. Its own toolchain file does most.
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY BOTH)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE BOTH)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY) # linking each test takes seconds
set(ENV{NODE_PATH} /usr/share/nodejs)             # where Debian's emscripten has its modules
set(EMSCRIPTEN_SYSTEM_PROCESSOR wasm32)
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
set(CMAKE_SYSTEM_PREFIX_PATH /nowhere) # nothing of this machine's own

# The compiler itself with the options that emcc gives it: emcc's start takes longer than a small file.
if(NOT VELO_EMCC_FLAGS)
  execute_process(COMMAND emcc --cflags OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(VELO_EMCC_FLAGS "${flags}" CACHE INTERNAL "what emcc gives the compiler")
endif()
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VELO_EMCC_FLAGS)
set(CMAKE_C_COMPILE_OBJECT "/usr/bin/clang-14 ${VELO_EMCC_FLAGS} <DEFINES> <INCLUDES> <FLAGS> -o <OBJECT> -c <SOURCE>")
