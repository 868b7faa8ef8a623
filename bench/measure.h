/* bench/measure.h: what benchmarks measure with. */
#ifndef BENCH_MEASURE_H
#define BENCH_MEASURE_H

#include <stdlib.h>
#include <time.h>

/* CPU time of the process, seconds. */
static inline double processor_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline int compare_numbers(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}
/* The median of n numbers, which are sorted. */
static inline double median(double *x, int n) {
  qsort(x, (size_t)n, sizeof *x, compare_numbers);
  return x[n / 2];
}

#endif
