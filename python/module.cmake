# The Python module: the extension _velo and a copy of the package's Python files, in build/PRESET/python/velo.
file(GLOB VELO_PYTHON_SOURCES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/python/_velo/*.c)
set(VELO_PYTHON_DIR ${CMAKE_BINARY_DIR}/python)
add_library(velo_python MODULE ${VELO_PYTHON_SOURCES})
set_target_properties(velo_python PROPERTIES PREFIX "" OUTPUT_NAME _velo SUFFIX .abi3.so C_VISIBILITY_PRESET hidden
                                             LIBRARY_OUTPUT_DIRECTORY ${VELO_PYTHON_DIR}/velo)
target_include_directories(velo_python SYSTEM PRIVATE ${Python3_INCLUDE_DIRS})
target_include_directories(velo_python PRIVATE ${CMAKE_SOURCE_DIR}/include)
target_compile_definitions(velo_python PRIVATE _GNU_SOURCE Py_LIMITED_API=0x030A0000)
target_compile_options(velo_python PRIVATE -Wall -Wextra -Wshadow $<$<BOOL:${VELO_WERROR}>:-Werror>)
# The library's code is inside the module, hidden: no installed libvelo of another version can replace it.
target_link_libraries(velo_python PRIVATE velo)
target_link_options(velo_python PRIVATE -Wl,--exclude-libs,ALL -Wl,--no-undefined-version)

file(GLOB_RECURSE VELO_PYTHON_FILES RELATIVE ${CMAKE_SOURCE_DIR}/python CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/python/velo/*.py
     ${CMAKE_SOURCE_DIR}/python/velo/*.pyi ${CMAKE_SOURCE_DIR}/python/velo/py.typed)
set(copies)
foreach(file ${VELO_PYTHON_FILES})
  add_custom_command(
    OUTPUT ${VELO_PYTHON_DIR}/${file}
    COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_SOURCE_DIR}/python/${file} ${VELO_PYTHON_DIR}/${file}
    DEPENDS ${CMAKE_SOURCE_DIR}/python/${file}
    COMMENT "python/${file}" VERBATIM)
  list(APPEND copies ${VELO_PYTHON_DIR}/${file})
endforeach()
add_custom_target(velo_python_files ALL DEPENDS ${copies})
add_dependencies(velo_python velo_python_files)

# Where the module is installed: Debian's dist-packages, or VELO_PYTHON_INSTALL_DIR.
set(VELO_PYTHON_INSTALL_DIR "" CACHE PATH "folder for the Python package; empty: it is not installed")
if(VELO_PYTHON_INSTALL_DIR)
  install(TARGETS velo_python LIBRARY DESTINATION ${VELO_PYTHON_INSTALL_DIR}/velo)
  # velo's add-on for Blender, which uses the module (docs/blender.md).
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/blender/velo_blender DESTINATION ${CMAKE_INSTALL_DATADIR}/blender/scripts/addons
          FILES_MATCHING PATTERN "*.py")
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/python/velo DESTINATION ${VELO_PYTHON_INSTALL_DIR}
          FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed")
endif()
