/* base/isa.c: detects the instruction sets of the processor by single features (clang 14 does not know the level
 * names). */
#include "base/isa.h"

#include <stdlib.h>
#include <string.h>

vlIsa vl_isa_best(void) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi2") || !__builtin_cpu_supports("fma"))
    return VL_ISA_V2;
  if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512bw") ||
      !__builtin_cpu_supports("avx512cd") || !__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512vl"))
    return VL_ISA_V3;
  return VL_ISA_V4;
#else
  return VL_ISA_V2;
#endif
}

vlResult vl_isa_choose(vlIsa wish, vlIsa *isa) {
  vlIsa best = vl_isa_best();
  if (wish == VL_ISA_AUTO) {
    const char *text = getenv("VELO_ISA");
    if (text && *text) {
      if (strcmp(text, "v2") == 0)
        wish = VL_ISA_V2;
      else if (strcmp(text, "v3") == 0)
        wish = VL_ISA_V3;
      else if (strcmp(text, "v4") == 0)
        wish = VL_ISA_V4;
      else
        return VL_ERROR_ARGUMENT;
    } else {
      wish = best;
    }
  }
  if (wish != VL_ISA_V2 && wish != VL_ISA_V3 && wish != VL_ISA_V4) return VL_ERROR_ARGUMENT;
  if (wish > best) return VL_ERROR_UNSUPPORTED;
  *isa = wish;
  return VL_OK;
}
