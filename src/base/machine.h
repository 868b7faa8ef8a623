/* base/machine.h: services of the operating system and the processor other than files, threads
 * and allocation. */
#ifndef BASE_MACHINE_H
#define BASE_MACHINE_H

#include <stdbool.h>
#include <stddef.h>

/* Whether the process can reserve this many more bytes of address space. The test makes a
 * reservation and releases it; it takes no memory. True on systems where this cannot be
 * tested. */
bool vl_machine_has_addresses(size_t bytes);

/* Returns free memory that the C library holds to the system, if the C library supports
 * this. */
void vl_machine_return_memory(void);

/* Asks the system to use large pages for a new block of memory that will be read at random, if
 * the system supports this. Large pages cause fewer TLB misses. */
void vl_machine_large_pages(void *block, size_t size);

/* Gives this thread the floating-point state in which velo traces, if the processor has one:
 * rounding to nearest, denormal numbers kept (docs/decisions/0024-denormal-numbers.md). A
 * library that was compiled with -ffast-math may have left another one, which new threads
 * inherit. Returns the state before, for vl_machine_restore_floats. */
unsigned vl_machine_set_floats(void);
void vl_machine_restore_floats(unsigned state);

/* Gives this thread the locale "C", in which numbers of texts have a decimal point: a program
 * may have chosen one with a comma, which strtod and printf would follow. Returns the locale
 * before, for vl_machine_restore_numerals; null if nothing was changed. */
void *vl_machine_set_numerals(void);
void vl_machine_restore_numerals(void *before);

#endif
