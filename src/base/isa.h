/* base/isa.h: instruction sets. Hot files are compiled once per set (v2, v3 and v4 on x86-64,
 * base elsewhere); their functions are reached through one constant table per room and set. */
#ifndef BASE_ISA_H
#define BASE_ISA_H

#include "base/attributes.h"
#include "velo/base.h"

/* Chooses an instruction set. AUTO: the set that the environment variable VELO_ISA names, else
 * the widest set that the machine has. BASE: the lowest set of the library, V2 on x86-64.
 * Error: UNSUPPORTED if the machine does not have the set. */
vlResult vl_isa_choose(vlIsa wish, vlIsa *isa);
vlIsa vl_isa_best(void);

/* Declares the kernel tables of hot files. PREFIX_kernel_table is the name within the hot file
 * that defines the table. All other files use PREFIX_kernels(isa), which returns the table of
 * an instruction set. The build links the hot files of a set into one object in which only
 * these tables are global (CMakeLists.txt has their list). With VL_LOWEST_SET_ONLY the tables
 * of v2 are used for every set. */
#if defined(__x86_64__) && defined(VL_LOWEST_SET_ONLY)
#define VL_KERNEL_TABLE(type, prefix)                                \
  extern const type prefix##_kernel_table, prefix##_kernel_table_v2; \
  static inline const type *prefix##_kernels(vlIsa isa) {            \
    (void)isa;                                                       \
    return &prefix##_kernel_table_v2;                                \
  }
#elif defined(__x86_64__)
#define VL_KERNEL_TABLE(type, prefix)                                                          \
  extern const type prefix##_kernel_table, prefix##_kernel_table_v2, prefix##_kernel_table_v3, \
      prefix##_kernel_table_v4;                                                                \
  static inline const type *prefix##_kernels(vlIsa isa) {                                      \
    return isa == VL_ISA_V4   ? &prefix##_kernel_table_v4                                      \
           : isa == VL_ISA_V3 ? &prefix##_kernel_table_v3                                      \
                              : &prefix##_kernel_table_v2;                                     \
  }
#else
#define VL_KERNEL_TABLE(type, prefix)                                  \
  extern const type prefix##_kernel_table, prefix##_kernel_table_base; \
  static inline const type *prefix##_kernels(vlIsa isa) {              \
    (void)isa;                                                         \
    return &prefix##_kernel_table_base;                                \
  }
#endif

/* Batches are padded to VL_LANES elements, so that vector loops have no remainder. VL_SIMD
 * before a loop over a batch states that its iterations are independent. With VL_SCALAR, for
 * benchmarks, batches are not padded. */
enum { VL_LANES = 16 };
#ifndef VL_SCALAR
#define VL_PAD(n) (((n) + 15u) & ~15u)
#define VL_SIMD _Pragma("omp simd")
#else
#define VL_PAD(n) (n)
#define VL_SIMD
#endif

#endif
