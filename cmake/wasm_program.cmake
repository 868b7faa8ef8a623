# What a build for WebAssembly does otherwise, used by CMakeLists.txt where EMSCRIPTEN is set (cmake/wasm.cmake).

add_compile_options(-msimd128 -mnontrapping-fptoint)
# One set of hot files has one set of kernel tables: no object has to be joined, and the tables keep their names.
function(velo_wasm_kernels)
  foreach(table ${VELO_KERNEL_TABLES})
    target_compile_definitions(velo_flags INTERFACE ${table}_kernel_table_base=${table}_kernel_table)
  endforeach()
endfunction()

# The RGB tables (11 MB) are files beside the program; web/engine/rgb_tables.c asks JavaScript for those that a scene needs.
macro(velo_wasm_tables)
  list(FILTER VELO_SOURCES EXCLUDE REGEX "/color/rgb_data\\.c$")
  list(APPEND VELO_SOURCES ${CMAKE_SOURCE_DIR}/web/engine/rgb_tables.c)
  add_custom_target(velo_rgb_tables ALL DEPENDS ${VELO_TABLES})
endmacro()

# velo.js and velo.wasm, which web/engine/velo.js starts: a module that is instantiated for each command, with a file system
# in memory, in node also with the machine's. Debian's terser fails on what -O2 makes of JavaScript: -g1 leaves it as it is.
function(velo_wasm_program target)
  add_dependencies(${target} velo_rgb_tables)
  target_link_options(
    ${target} PRIVATE -O2 -g1 -sMODULARIZE -sEXPORT_NAME=createVelo -sINVOKE_RUN=0 -sEXIT_RUNTIME=1 -sALLOW_MEMORY_GROWTH
    -sMAXIMUM_MEMORY=4GB -sINITIAL_MEMORY=64MB -sTOTAL_STACK=4MB -sIMPORTED_MEMORY -sFORCE_FILESYSTEM -lnodefs.js
    -sEXPORTED_RUNTIME_METHODS=FS,NODEFS,callMain,ENV -sENVIRONMENT=web,worker,node -sNODEJS_CATCH_EXIT=0
    -sNODEJS_CATCH_REJECTION=0 "SHELL:--js-library ${CMAKE_SOURCE_DIR}/web/engine/rgb_tables.js"
    "SHELL:--js-library ${CMAKE_SOURCE_DIR}/web/engine/page_calls.js"
    --extern-post-js ${CMAKE_SOURCE_DIR}/web/engine/program_end.js -sABORTING_MALLOC=0)
  set_property(TARGET ${target} PROPERTY RULE_LAUNCH_LINK "env NODE_PATH=/usr/share/nodejs") # Debian's place of its modules
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${CMAKE_SOURCE_DIR}/web/engine/rgb_tables.js
                                                 ${CMAKE_SOURCE_DIR}/web/engine/page_calls.js)
endfunction()
