/* base/isa.h: instruction sets. Hot files are compiled once per set with VL_ISA_SUFFIX = v2, v3 or v4; their outside
 * functions are named VL_HOT(name) (name_v3, ...) and gathered in one constant table per room and set. */
#ifndef BASE_ISA_H
#define BASE_ISA_H

#include "velo/base.h"

/* The widest set this machine has, or the wish if the machine has it (else UNSUPPORTED). AUTO looks at the environment
 * variable VELO_ISA first. */
vlResult vl_isa_choose(vlIsa wish, vlIsa *isa);
vlIsa vl_isa_best(void);

#define VL_CONCAT2(a, b) a##_##b
#define VL_CONCAT(a, b) VL_CONCAT2(a, b)
#define VL_HOT(name) VL_CONCAT(name, VL_ISA_SUFFIX)

/* Batches are padded to this many elements, so that vector loops have no remainder. */
enum { VL_LANES = 16 };
#define VL_PAD(n) (((n) + 15u) & ~15u)

/* Put before a loop over a batch: the iterations do not depend on each other. */
#define VL_SIMD _Pragma("omp simd")

#endif
