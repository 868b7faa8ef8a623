# Embree 3.13 (Debian 12) or 4 (Debian 13): the newest that has both header and library. Gives Embree::Embree, which
# defines VELO_EMBREE_MAJOR, and EMBREE_LIBRARY. Only a file of src/world/accel includes its header.
if(NOT EMBREE_MAJOR)
  foreach(major 4 3)
    find_path(EMBREE_INCLUDE_DIR_${major} embree${major}/rtcore.h)
    find_library(EMBREE_LIBRARY_${major} NAMES embree${major})
    mark_as_advanced(EMBREE_INCLUDE_DIR_${major} EMBREE_LIBRARY_${major})
    if(EMBREE_INCLUDE_DIR_${major} AND EMBREE_LIBRARY_${major})
      set(EMBREE_MAJOR ${major})
      break()
    endif()
  endforeach()
endif()
if(EMBREE_MAJOR)
  set(EMBREE_INCLUDE_DIR ${EMBREE_INCLUDE_DIR_${EMBREE_MAJOR}})
  set(EMBREE_LIBRARY ${EMBREE_LIBRARY_${EMBREE_MAJOR}})
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Embree REQUIRED_VARS EMBREE_LIBRARY EMBREE_INCLUDE_DIR)

if(Embree_FOUND AND NOT TARGET Embree::Embree)
  add_library(Embree::Embree UNKNOWN IMPORTED)
  set_target_properties(Embree::Embree PROPERTIES IMPORTED_LOCATION ${EMBREE_LIBRARY}
                                                  INTERFACE_INCLUDE_DIRECTORIES ${EMBREE_INCLUDE_DIR}
                                                  INTERFACE_COMPILE_DEFINITIONS VELO_EMBREE_MAJOR=${EMBREE_MAJOR})
endif()
