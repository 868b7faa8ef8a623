/* base/isa.c: detects the instruction sets of the processor by single features (clang 14 does
 * not know the level names). */
#include "base/isa.h"
#include "base/text.h"

#include <stdlib.h>

#if defined(__x86_64__)
static const vlIsa lowest = VL_ISA_V2;

vlIsa vl_isa_best(void) {
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi2") ||
      !__builtin_cpu_supports("fma"))
    return VL_ISA_V2;
  if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512bw") ||
      !__builtin_cpu_supports("avx512cd") || !__builtin_cpu_supports("avx512dq") ||
      !__builtin_cpu_supports("avx512vl"))
    return VL_ISA_V3;
  return VL_ISA_V4;
}
#else
static const vlIsa lowest = VL_ISA_BASE;

vlIsa vl_isa_best(void) {
  return VL_ISA_BASE;
}
#endif

vlResult vl_isa_choose(vlIsa wish, vlIsa *isa) {
  static const struct {
    const char *name;
    vlIsa isa;
  } names[] = {{"base", VL_ISA_BASE}, {"v2", VL_ISA_V2}, {"v3", VL_ISA_V3}, {"v4", VL_ISA_V4}};
  vlIsa best = vl_isa_best();
  const char *text = wish == VL_ISA_AUTO ? getenv("VELO_ISA") : NULL;
  if (text && *text) {
    for (size_t i = 0; i < VL_LENGTH(names); i++)
      if (vl_text_is(text, names[i].name))
        wish = names[i].isa;
    if (wish == VL_ISA_AUTO)
      return VL_ERROR_ARGUMENT;
  } else if (wish == VL_ISA_AUTO) {
    wish = best;
  }
  if (wish == VL_ISA_BASE)
    wish = lowest;
  if (wish != lowest && wish != VL_ISA_V2 && wish != VL_ISA_V3 && wish != VL_ISA_V4)
    return VL_ERROR_ARGUMENT;
  if (wish > best)
    return VL_ERROR_UNSUPPORTED;
  *isa = wish;
  return VL_OK;
}
