/* trace/cast/rays.hot.c: the caller's own rays: read from the caller's arrays, checked, and
 * made ready for the accelerator. */
#include "trace/cast/rays.h"

#include "trace/stages.h"

/* ---- reading ----------------------------------------------------------------------------- */

/* Numbers in the caller's memory, which need not be aligned. */
typedef float LooseFloat __attribute__((aligned(1), may_alias));
typedef double LooseDouble __attribute__((aligned(1), may_alias));

static inline const char *row_of(const vlRayArray *a, uint64_t first) {
  return (const char *)a->data + (int64_t)first * a->step;
}

void vl_cast_read_numbers(const vlRayArray *a, uint64_t first, uint32_t n, double other,
                          double *to) {
  if (!a->data) {
    for (uint32_t i = 0; i < n; i++)
      to[i] = other;
    return;
  }
  const char *from = row_of(a, first);
  for (uint32_t i = 0; i < n && a->doubles; i++, from += a->step)
    to[i] = *(const LooseDouble *)from;
  for (uint32_t i = 0; i < n && !a->doubles; i++, from += a->step)
    to[i] = (double)*(const LooseFloat *)from;
}

/* Rows of three without gaps. */
static void read_floats(const char *from, uint32_t n, double to[3][VL_ROW_SIZE]) {
  const LooseFloat *x = (const LooseFloat *)from;
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < n; i++) {
    to[0][i] = (double)x[3 * (size_t)i];
    to[1][i] = (double)x[3 * (size_t)i + 1];
    to[2][i] = (double)x[3 * (size_t)i + 2];
  }
}

void vl_cast_prefetch(const vlRayArray *a, uint64_t first, uint32_t n) {
  enum { LINE = 64 };
  if (a->step <= 0 || a->step > LINE)
    return;
  const char *from = row_of(a, first);
  for (int64_t i = 0; i < (int64_t)n * a->step; i += LINE)
    __builtin_prefetch(from + i);
}

void vl_cast_read_vectors(const vlRayArray *a, uint64_t first, uint32_t n,
                          double to[3][VL_ROW_SIZE]) {
  const char *from = row_of(a, first);
  if (!a->doubles && a->step == 3 * sizeof(float)) {
    read_floats(from, n, to);
    return;
  }
  for (uint32_t i = 0; i < n && a->doubles; i++, from += a->step)
    for (int k = 0; k < 3; k++)
      to[k][i] = ((const LooseDouble *)from)[k];
  for (uint32_t i = 0; i < n && !a->doubles; i++, from += a->step)
    for (int k = 0; k < 3; k++)
      to[k][i] = (double)((const LooseFloat *)from)[k];
}

/* ---- checks ------------------------------------------------------------------------------ */

static inline double largest(double a, double b, double c) {
  a = __builtin_fabs(a);
  b = __builtin_fabs(b);
  c = __builtin_fabs(c);
  a = a > b ? a : b;
  return a > c ? a : c;
}

bool vl_cast_check(vlCastBatch *b) {
  uint32_t wrong = 0;
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < b->n; i++)
    b->start[i] = b->start[i] < 0.0 ? 0.0 : b->start[i];
  for (uint32_t i = 0; i < b->n; i++) {
    double length = largest(b->d[0][i], b->d[1][i], b->d[2][i]);
    double reach = largest(b->o[0][i], b->o[1][i], b->o[2][i]);
    double sum = (b->d[0][i] - b->d[0][i]) + (b->d[1][i] - b->d[1][i]) +
                 (b->d[2][i] - b->d[2][i]) + (b->o[0][i] - b->o[0][i]) +
                 (b->o[1][i] - b->o[1][i]) + (b->o[2][i] - b->o[2][i]);
    uint32_t fine = (sum == 0.0) & (length > 0.0) & (length <= VL_MAX_CAST_LENGTH) &
                    (reach < VL_CAST_FAR) & (b->end[i] > b->start[i]) &
                    (b->start[i] < (double)VL_INFINITY);
    wrong |= !fine;
  }
  return !wrong;
}

/* Makes directions unit, and distances of t. The largest component is taken out first, since
 * squares may leave the range of double. */
static void normalize(vlCastBatch *b, uint32_t first, uint32_t last) {
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = first; i < last; i++) {
    double max = largest(b->d[0][i], b->d[1][i], b->d[2][i]);
    double scale = 1.0 / max;
    double x = b->d[0][i] * scale, y = b->d[1][i] * scale, z = b->d[2][i] * scale;
    double l = __builtin_sqrt(x * x + y * y + z * z), unit = 1.0 / l;
    b->d[0][i] = x * unit;
    b->d[1][i] = y * unit;
    b->d[2][i] = z * unit;
    b->length[i] = max * l;
    b->start[i] = b->start[i] * b->length[i];
    b->end[i] = b->end[i] * b->length[i];
  }
}

/* The part of a ray in float that holds all of the exact one: distances are compared with its
 * end in double afterwards (drop_beyond). */
static const double WIDER = 1.0 + 0x1p-18;

static void round_rays(vlCastBatch *b, vlPaths *p, uint32_t first, uint32_t last) {
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = first; i < last; i++) {
    p->o.x[i] = (float)b->o[0][i];
    p->o.y[i] = (float)b->o[1][i];
    p->o.z[i] = (float)b->o[2][i];
    p->d.x[i] = (float)b->d[0][i];
    p->d.y[i] = (float)b->d[1][i];
    p->d.z[i] = (float)b->d[2][i];
    b->t_min[i] = (float)b->start[i];
    b->t_max[i] = (float)(b->end[i] * WIDER);
  }
}

/* Whether most neighbours start close to each other, as the world is large, in directions
 * within 8 degrees. 64 pairs or more are looked at, if there are so many. */
static bool are_coherent(const vlWorld *world, uint32_t n, const vlPaths *p) {
  const float close = 0.02f * world->radius, min_cosine = 0.99f;
  uint32_t similar = 0, pairs = 0, step = n < 64 ? 1 : n / 64;
  for (uint32_t i = 1; i < n; i += step) {
    vlVec3 a = vl_row3(&p->d, i), b = vl_row3(&p->d, i - 1);
    vlVec3 apart = vl_sub(vl_row3(&p->o, i), vl_row3(&p->o, i - 1));
    similar += vl_dot(a, b) > min_cosine && vl_length2(apart) <= close * close;
    pairs++;
  }
  return 8 * similar >= 7 * pairs && pairs;
}

void vl_cast_prepare(const vlWorld *world, vlTraceScratch *s, vlCastBatch *b) {
  vlPaths *p = &s->rays;
  for (uint32_t i = b->n; i < VL_PAD(b->n); i++) {
    for (int k = 0; k < 3; k++) {
      b->o[k][i] = b->o[k][0];
      b->d[k][i] = b->d[k][0];
    }
    b->start[i] = b->start[0];
    b->end[i] = b->end[0];
  }
  uint32_t padded = VL_PAD(b->n);
  for (uint32_t first = 0; first < padded; first += VL_CAST_BLOCK) {
    uint32_t last = padded - first < VL_CAST_BLOCK ? padded : first + VL_CAST_BLOCK;
    normalize(b, first, last);
    round_rays(b, p, first, last);
  }
  b->coherent = are_coherent(world, b->n, p);
  uint32_t finite = 0;
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++)
    finite |= b->end[i] < (double)VL_INFINITY;
  b->finite_ends = finite;
}
