/* base/attributes.h: what a compiler shall know of functions. */
#ifndef BASE_ATTRIBUTES_H
#define BASE_ATTRIBUTES_H

/* Inlined wherever it is called, where the compiler would not do so by itself, too. */
#define VL_INLINE static inline __attribute__((always_inline))
/* Never inlined. */
#define VL_NOINLINE static __attribute__((noinline))
/* An argument that a function of a common type does not need. */
#define VL_UNUSED __attribute__((unused))
/* Takes a format as printf does, and its values: their numbers among the arguments, from 1. */
#define VL_PRINTF(text, values) __attribute__((format(printf, text, values)))

#endif
