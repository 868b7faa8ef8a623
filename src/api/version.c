/* api/version.c: version and build configuration of the library. */
#include "velo/base.h"

#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)

/* generated/libraries.c, written by CMake */
extern const vlLibrary vl_libraries[];
extern const uint32_t vl_library_count;

static const char compiler[] =
#ifdef __clang__
    "clang " __clang_version__;
#else
    "gcc " __VERSION__;
#endif

const vlVersion *vl_version(void) {
  static const vlVersion version = {
    .major = VL_VERSION_MAJOR,
    .minor = VL_VERSION_MINOR,
    .patch = VL_VERSION_PATCH,
    .abi = VL_ABI_VERSION,
    .text = TEXT(VL_VERSION_MAJOR) "." TEXT(VL_VERSION_MINOR) "." TEXT(VL_VERSION_PATCH),
    .compiler = compiler,
#if defined(__x86_64__)
    .instruction_sets = "x86-64-v2, x86-64-v3, x86-64-v4",
#else
    .instruction_sets = "base",
#endif
  };
  return &version;
}

const vlLibrary *vl_version_library(uint32_t index) {
  return index < vl_library_count ? &vl_libraries[index] : NULL;
}
