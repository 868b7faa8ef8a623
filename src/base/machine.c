/* base/machine.c: see machine.h. */
#include "base/machine.h"

#include <stdint.h>
#include <sys/mman.h>

#if defined(__GLIBC__)
#include <malloc.h>
#endif
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#ifndef MAP_NORESERVE /* older Linux and BSD headers; on other systems PROT_NONE reserves no memory either */
#define MAP_NORESERVE 0
#endif

bool vl_machine_has_addresses(size_t bytes) {
  void *block = mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (block == MAP_FAILED) return false;
  munmap(block, bytes);
  return true;
}

void vl_machine_return_memory(void) {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

void vl_machine_large_pages(void *block, size_t size) {
#if defined(MADV_HUGEPAGE)
  const uintptr_t page = (uintptr_t)2 << 20;
  uintptr_t from = ((uintptr_t)block + page - 1) & ~(page - 1), to = ((uintptr_t)block + size) & ~(page - 1);
  if (to > from)
    madvise((void *)from, to - from, MADV_HUGEPAGE); /* only advice: if it fails, nothing changes but the speed */
#else
  (void)block, (void)size;
#endif
}

unsigned vl_machine_flush_denormals(void) {
#if defined(__SSE__)
  unsigned state = _mm_getcsr();
  _mm_setcsr(state | 0x8040u); /* bits FTZ (results) and DAZ (inputs): denormals become 0 */
  return state;
#elif defined(__aarch64__)
  uint64_t state;
  __asm__ volatile("mrs %0, fpcr" : "=r"(state));
  __asm__ volatile("msr fpcr, %0" ::"r"(state | UINT64_C(1) << 24)); /* bit FZ: denormal inputs and results become 0 */
  return (unsigned)state;                                            /* the upper half of the register is reserved */
#else
  return 0;
#endif
}

void vl_machine_restore_denormals(unsigned state) {
#if defined(__SSE__)
  _mm_setcsr(state);
#elif defined(__aarch64__)
  __asm__ volatile("msr fpcr, %0" ::"r"((uint64_t)state));
#else
  (void)state;
#endif
}
