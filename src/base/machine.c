/* base/machine.c: see machine.h. */
#include "base/machine.h"

#include <locale.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/sysinfo.h>
#endif

#include "velo/base.h"

#if defined(__GLIBC__)
#include <malloc.h>
#endif
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#ifndef MAP_NORESERVE /* older Linux and BSD headers; on other systems PROT_NONE reserves no \
                         memory either */
#define MAP_NORESERVE 0
#endif

bool vl_machine_has_addresses(size_t bytes) {
  void *block =
      mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (block == MAP_FAILED)
    return false;
  munmap(block, bytes);
  return true;
}

/* The memory of the machine, and of the control group where it is less. */
static uint64_t machine_memory(void) {
  uint64_t max = UINT64_MAX;
#if defined(__linux__)
  struct sysinfo info;
  if (sysinfo(&info) == 0)
    max = ((uint64_t)info.totalram + info.totalswap) * info.mem_unit;
  FILE *file = fopen("/sys/fs/cgroup/memory.max", "r");
  unsigned long long limit;
  if (file && fscanf(file, "%llu", &limit) == 1 && limit < max)
    max = limit;
  if (file)
    fclose(file);
#endif
  return max;
}

/* Bytes of address space without memory: stacks, code, reservations. */
static uint64_t empty_addresses(void) {
  unsigned long long pages[2] = {0, 0};
  FILE *file = fopen("/proc/self/statm", "r");
  if (file && fscanf(file, "%llu %llu", &pages[0], &pages[1]) != 2)
    pages[0] = pages[1] = 0;
  if (file)
    fclose(file);
  return pages[0] > pages[1] ? (pages[0] - pages[1]) * (uint64_t)sysconf(_SC_PAGESIZE) : 0;
}

uint64_t vl_memory_limit(const char **who) {
  uint64_t max = machine_memory(), own = UINT64_MAX;
  struct rlimit limit;
  if (getrlimit(RLIMIT_DATA, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    own = limit.rlim_cur;
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    uint64_t empty = empty_addresses(),
             left = limit.rlim_cur > empty ? limit.rlim_cur - empty : 0;
    if (left < own)
      own = left;
  }
  if (who)
    *who = own < max ? "the process may have" : "the machine has";
  return own < max ? own : max;
}

void vl_machine_return_memory(void) {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

void vl_machine_large_pages(void *block, size_t size) {
#if defined(MADV_HUGEPAGE)
  const uintptr_t page = (uintptr_t)2 << 20;
  uintptr_t from = ((uintptr_t)block + page - 1) & ~(page - 1),
            to = ((uintptr_t)block + size) & ~(page - 1);
  if (to > from)
    /* only advice: if it fails, nothing changes but the speed */
    madvise((void *)from, to - from, MADV_HUGEPAGE);
#else
  (void)block;
  (void)size;
#endif
}

unsigned vl_machine_set_floats(void) {
#if defined(__SSE__)
  unsigned state = _mm_getcsr();
  _mm_setcsr(0x1f80u); /* no traps, rounding to nearest, neither FTZ nor DAZ */
  return state;
#elif defined(__aarch64__)
  uint64_t state;
  __asm__ volatile("mrs %0, fpcr" : "=r"(state));
  __asm__ volatile("msr fpcr, %0" ::"r"(UINT64_C(0))); /* the same */
  return (unsigned)state; /* the upper half of the register is reserved */
#else
  return 0;
#endif
}

void vl_machine_restore_floats(unsigned state) {
#if defined(__SSE__)
  _mm_setcsr(state);
#elif defined(__aarch64__)
  __asm__ volatile("msr fpcr, %0" ::"r"((uint64_t)state));
#else
  (void)state;
#endif
}

void *vl_machine_set_numerals(void) {
  locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  return plain ? (void *)uselocale(plain) : NULL;
}

void vl_machine_restore_numerals(void *before) {
  if (before)
    freelocale(uselocale((locale_t)before));
}
