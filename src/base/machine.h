/* base/machine.h: what the operating system and the processor are asked for beside files, threads and memory. */
#ifndef BASE_MACHINE_H
#define BASE_MACHINE_H

#include <stdbool.h>
#include <stddef.h>

/* Whether the process may have so many bytes of addresses more. Takes and gives back a reservation, no memory. Machines
 * that cannot say have them. */
bool vl_machine_has_addresses(size_t bytes);

/* Gives memory that the C library holds free back to the system, where it can be asked to. */
void vl_machine_return_memory(void);

/* Tells the system that a new block of memory will be read at random, where it can be told: large blocks then get large
 * pages, which cost fewer misses of the processor's address tables. */
void vl_machine_large_pages(void *block, size_t size);

/* Makes this thread treat denormal floats as zero, as Embree wants it, where the processor can. Returns the state
 * before it, which the other function restores. */
unsigned vl_machine_flush_denormals(void);
void vl_machine_restore_denormals(unsigned state);

#endif
