/* base/machine.h: services of the operating system and the processor other than files, threads and allocation. */
#ifndef BASE_MACHINE_H
#define BASE_MACHINE_H

#include <stdbool.h>
#include <stddef.h>

/* Whether the process can reserve this many more bytes of address space. The test makes a reservation and releases it;
 * it takes no memory. True on systems where this cannot be tested. */
bool vl_machine_has_addresses(size_t bytes);

/* Returns free memory that the C library holds to the system, if the C library supports this. */
void vl_machine_return_memory(void);

/* Asks the system to use large pages for a new block of memory that will be read at random, if the system supports
 * this. Large pages cause fewer TLB misses. */
void vl_machine_large_pages(void *block, size_t size);

/* Makes this thread treat denormal floats as zero, as Embree recommends, if the processor supports this. Returns the
 * previous state for vl_machine_restore_denormals. */
unsigned vl_machine_flush_denormals(void);
void vl_machine_restore_denormals(unsigned state);
/* Ends that mode while the caller's own code runs. Returns the previous state, as vl_machine_flush_denormals. */
unsigned vl_machine_keep_denormals(void);

#endif
