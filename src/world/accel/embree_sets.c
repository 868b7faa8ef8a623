/* world/accel/embree_sets.c: which instruction set Embree uses
 * (docs/decisions/0013-the-bits-of-embree.md). */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/isa.h"
#include "world/accel/embree.h"

#if defined(__x86_64__)
/* Embree's instruction sets. fused: uses fused multiply-add; its hits at edges differ from
 * those of the other sets. */
typedef struct EmbreeSet {
  const char *name;
  bool there, fused;
} EmbreeSet;

enum { SETS = 4 };
static void list_sets(EmbreeSet sets[SETS]) {
  __builtin_cpu_init();
  sets[0] = (EmbreeSet){"sse4.2", true, false};
  sets[1] = (EmbreeSet){"avx", __builtin_cpu_supports("avx"), false};
  sets[2] = (EmbreeSet){"avx2", vl_isa_best() >= VL_ISA_V3, true};
  sets[3] = (EmbreeSet){"avx512", vl_isa_best() >= VL_ISA_V4, true};
}

vlResult vl_embree_choose_set(vlBits bits, const char **name, vlError *error) {
  EmbreeSet sets[SETS];
  list_sets(sets);
  const char *wish = getenv("VELO_EMBREE");
  *name = NULL;
  if (!wish || !*wish) {
    if (bits == VL_BITS_PORTABLE)
      *name = sets[sets[1].there ? 1 : 0].name;
    return VL_OK;
  }
  for (size_t k = 0; k < SETS; k++) {
    if (strcmp(wish, sets[k].name) != 0)
      continue;
    if (!sets[k].there)
      return vl_fail(error, VL_ERROR_UNSUPPORTED,
                     "VELO_EMBREE=%s: this machine does not have it", wish);
    if (sets[k].fused && bits == VL_BITS_PORTABLE)
      return vl_fail(error, VL_ERROR_UNSUPPORTED,
                     "VELO_EMBREE=%s: portable bits need sse4.2 or avx", wish);
    *name = sets[k].name;
    return VL_OK;
  }
  return vl_fail_argument(error, "VELO_EMBREE=%s: not one of sse4.2, avx, avx2, avx512", wish);
}

const char *vl_embree_fast_set(void) {
  const char *wish = getenv("VELO_EMBREE"), *widest = NULL;
  EmbreeSet sets[SETS];
  list_sets(sets);
  for (size_t k = 0; k < SETS; k++) {
    if (wish && strcmp(wish, sets[k].name) == 0)
      return sets[k].name;
    if (sets[k].there)
      widest = sets[k].name;
  }
  return widest;
}
#else
vlResult vl_embree_choose_set(VL_UNUSED vlBits bits, const char **name,
                              VL_UNUSED vlError *error) {
  *name = NULL;
  return VL_OK;
}

const char *vl_embree_fast_set(void) {
  return "neon";
}
#endif
