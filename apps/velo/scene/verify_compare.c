/* scene/verify_compare.c: compares the means of the runs, cell by cell. */
#include <math.h>
#include <stdlib.h>

#include "scene/verify.h"

/* Differences below this share of a cell's mean do not count: rounding, and the tables from
 * which spectra are read. A cell counts as at least DARK of the image's mean. */
#define MIN_SHARE 1e-3
#define DARK 0.05

/* Whether a run has a part of the lights. */
static bool is_part(const VerifyRun *run) {
  return run->lights != VERIFY_ALL && run->lights != VERIFY_NOT_SMALL;
}

bool verify_uses_cell(const Verify *v, const VerifyRun *run, uint32_t cell) {
  return cell == 0 || (!is_part(run) && cell < v->cell_count);
}

VerifyFamily verify_family(const VerifyRun *run, const VerifyCell *cell) {
  return is_part(run) ? VERIFY_LIGHT : cell->family;
}

/* The variance of a difference, per pixel, in a replicate: its mean over the blocks of the
 * image. */
static double variance_per_pixel(const Verify *v, const double *a, const double *b,
                                 uint32_t channel) {
  const size_t stride = (size_t)v->cell_count * VERIFY_CHANNELS;
  double sum = 0;
  uint32_t blocks = 0;
  for (uint32_t cell = 0; cell < v->cell_count; cell++) {
    const size_t at = (size_t)cell * VERIFY_CHANNELS + channel;
    if (v->cells[cell].family != VERIFY_BLOCK)
      continue;
    sum += v->cells[cell].pixels * verify_variance(a + at, b + at, VERIFY_REPLICATES, stride);
    blocks++;
  }
  return sum / blocks;
}

VerifyDifference verify_difference(const Verify *v, const VerifyRun *run, int look,
                                   uint32_t value) {
  const VerifyRun *other = &v->runs[run->against];
  const uint32_t cell = value / VERIFY_CHANNELS, channel = value % VERIFY_CHANNELS;
  const size_t stride = (size_t)v->cell_count * VERIFY_CHANNELS;
  const double *a = run->values[look], *b = other->values[look];
  double mean = 0, whole = 0;
  for (size_t r = 0; r < VERIFY_REPLICATES; r++) {
    mean += b[r * stride + value] / VERIFY_REPLICATES;
    whole += b[r * stride + channel] / VERIFY_REPLICATES;
  }
  const double min = MIN_SHARE * fmax(fabs(mean), DARK * fabs(whole));
  const double min_error = sqrt(variance_per_pixel(v, a, b, channel) /
                                ((double)VERIFY_REPLICATES * v->cells[cell].pixels));
  return verify_compare(a + value, b + value, VERIFY_REPLICATES, stride, min, min_error);
}

static bool is_compared(const VerifyRun *run) {
  return !run->left_out && !run->apart && run->against >= 0;
}

/* The number of values of each family in all comparisons. */
static void count_values(Verify *v, uint32_t of_family[VERIFY_FAMILIES]) {
  for (int i = 0; i < v->run_count; i++)
    for (uint32_t cell = 0; cell < v->cell_count && is_compared(&v->runs[i]); cell++)
      if (verify_uses_cell(v, &v->runs[i], cell))
        of_family[verify_family(&v->runs[i], &v->cells[cell])] += VERIFY_CHANNELS;
  v->families = 0;
  for (int f = 0; f < VERIFY_FAMILIES; f++) {
    v->families += of_family[f] > 0;
    v->compared += of_family[f];
  }
}

vlResult verify_first(Verify *v) {
  uint32_t of_family[VERIFY_FAMILIES] = {0};
  count_values(v, of_family);
  v->marks = calloc((size_t)v->compared + 1, sizeof *v->marks);
  if (!v->marks)
    return VL_ERROR_MEMORY;
  for (int i = 0; i < v->run_count; i++) {
    VerifyRun *run = &v->runs[i];
    for (uint32_t value = 0; value < v->cell_count * VERIFY_CHANNELS && is_compared(run);
         value++) {
      const uint32_t cell = value / VERIFY_CHANNELS;
      if (!verify_uses_cell(v, run, cell))
        continue;
      const VerifyDifference found = verify_difference(v, run, 0, value);
      if (!(found.p <
            verify_first_p(of_family[verify_family(run, &v->cells[cell])], v->families)))
        continue;
      v->marks[v->mark_count++] = (VerifyMark){.run = i, .value = value, .first = found};
      run->marked++;
      run->again = v->runs[run->against].again = true;
    }
  }
  return VL_OK;
}

void verify_second(Verify *v) {
  uint32_t judged = 0;
  for (uint32_t k = 0; k < v->mark_count; k++)
    judged += !v->runs[v->marks[k].run].left_out;
  for (uint32_t k = 0; k < v->mark_count; k++) {
    VerifyMark *mark = &v->marks[k];
    VerifyRun *run = &v->runs[mark->run];
    if (run->left_out)
      continue; /* its second look was not finished */
    mark->second = verify_difference(v, run, 1, mark->value);
    const bool same_side = (mark->second.z > 0) == (mark->first.z > 0);
    mark->differs = same_side && mark->second.p < verify_second_p(judged);
    run->differs += mark->differs;
  }
}
