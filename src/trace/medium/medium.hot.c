/* trace/medium/medium.hot.c: flights in media, for a block of lanes (trace/medium/medium.h).
 * Uniform media have closed forms, which are computed for all lanes in the same medium at once;
 * other media track their lanes one by one (delta_tracking.hot.c). Absorption without
 * scattering is deterministic. */
#include "trace/medium/medium.h"

/* ---- absorption by channel --------------------------------------------------------------- */

/* Applies absorption by channel of linear sRGB over a length to lane i. The transmittance of a
 * wavelength over the whole path so far is T = sum_i share_i(lambda) passed_i. Each call
 * multiplies by the ratio of the new T to the old T, so the product over parts of a path is the
 * T of the whole. */
static void absorb_by_channel(const vlWorldMedium *m, float length, vlFlights *f, uint32_t i) {
  float passed[3], left[3];
  for (int k = 0; k < 3; k++) {
    passed[k] = f->passed[k][i];
    left[k] = passed[k] * vl_exp(-m->sigma_rgb[k] * length);
  }
  for (int c = 0; c < 4; c++) {
    float before = vl_channels_at(passed, f->lambda[c][i]),
          after = vl_channels_at(left, f->lambda[c][i]);
    f->beta[c][i] *= before > 0.0f ? after / before : 0.0f;
  }
  for (int k = 0; k < 3; k++)
    f->passed[k][i] = left[k];
}

/* ---- uniform media ----------------------------------------------------------------------- */

/* The lanes of a block that fly through one uniform medium. */
typedef struct Segments {
  const vlWorldMedium *medium;
  uint32_t padded;                                 /* lanes */
  VL_ROW uint32_t flies[VL_FLIGHTS];               /* 1: the lane flies through this medium */
  VL_ROW float length[VL_FLIGHTS];                 /* of the segment */
  VL_ROW float a[4][VL_FLIGHTS], s[4][VL_FLIGHTS]; /* coefficients */
  VL_ROW float hero[VL_FLIGHTS];                   /* sum of the coefficients of the hero */
  VL_ROW uint32_t scatters[VL_FLIGHTS];            /* 1: the flight scatters, */
  VL_ROW float distance[VL_FLIGHTS];               /* at this distance; otherwise the length */
} Segments;

static void spectrum_row(const vlSpectral *s, int channel, uint32_t n, const float *lambda,
                         float *value) {
  if (s->kind == VL_SPECTRAL_SIGMOID) {
    float scale = s->scale;
    vlSigmoid sigmoid = s->sigmoid;
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < n; i++) {
      value[i] = scale * vl_sigmoid(sigmoid, lambda[i]);
    }
  } else if (s->kind == VL_SPECTRAL_DENSE) {
    for (uint32_t i = 0; i < n; i++)
      value[i] = s->scale * vl_dense_at(s->dense, lambda[i]);
  } else {
    float constant = vl_spectral_at(s, channel, 0.0f);
    for (uint32_t i = 0; i < n; i++)
      value[i] = constant;
  }
}

/* Takes the lanes in this medium; afterwards they are in none (f->medium). */
static void find_segments(const vlWorld *world, uint32_t medium, vlFlights *f, Segments *k) {
  const uint32_t padded = VL_PAD(f->n);
  k->padded = padded;
  k->medium = &world->media.items[medium];
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    uint32_t here = f->medium[i] == medium;
    k->flies[i] = here & (f->to[i] > f->from[i]);
    k->length[i] = vl_min(f->to[i] - f->from[i], 1e30f);
    f->medium[i] = here ? VL_NONE : f->medium[i];
  }
  for (int c = 0; c < 4; c++) {
    spectrum_row(&k->medium->sigma_a, c, padded, f->lambda[c], k->a[c]);
    spectrum_row(&k->medium->sigma_s, c, padded, f->lambda[c], k->s[c]);
  }
}

/* An exponentially distributed number of mean 1. */
static inline float exponential(float u) {
  return -vl_ln(1.0f - u);
}

/* The sum of the coefficients of each lane's hero channel. */
static void find_heroes(const vlTracing *t, const vlFlights *f, Segments *k) {
  bool first = !vl_volume_rgb(t) && !t->light; /* the hero of every path is channel 0 */
  for (uint32_t i = 0; i < k->padded; i++) {
    int h = first || i >= f->n ? 0 : vl_volume_hero(t, f->paths, f->path[i]);
    k->hero[i] = k->a[h][i] + k->s[h][i];
  }
}

/* Adds the emission of the whole segments, whether or not the flights scatter before their
 * ends. */
static void emit(const vlTracing *t, vlFlights *f, const Segments *k) {
  const vlWorldMedium *m = k->medium;
  for (uint32_t i = 0; i < f->n; i++) {
    if (!k->flies[i])
      continue;
    const float u[4] = {f->u[0][i], f->u[1][i], f->u[2][i], f->u[3][i]};
    float inv = 1.0f / vl_flight_mean(u, vl_volume_rgb(t) ? 3 : 4);
    for (int c = 0; c < 4; c++) {
      float sigma = k->a[c][i] + k->s[c][i], passes = vl_exp(-sigma * k->length[i]);
      float le = vl_spectral_at(&m->emission, c, f->lambda[c][i]);
      if (sigma > 0.0f)
        f->given[c][i] += f->beta[c][i] * le * k->a[c][i] / sigma * (1.0f - passes) * inv;
    }
  }
}

/* A random number for each lane that flies, as vl_flight_random gives it. */
static void draw(const vlTracing *t, vlFlights *f, const Segments *k, float *random) {
  for (uint32_t i = 0; i < f->n; i++) {
    random[i] = f->first[i];
    if (!k->flies[i])
      continue;
    if (f->first[i] < 0.0f) {
      uint32_t key = vl_volume_key(t, f->paths, f->path[i], f->depth, f->purpose);
      random[i] = vl_unit_float(vl_hash2(key, f->count[i]++));
    }
    f->first[i] = -1.0f;
  }
}

/* Chooses the distances at which the flights scatter. */
static void sample_distances(const vlTracing *t, vlFlights *f, Segments *k) {
  VL_ROW float random[VL_FLIGHTS] = {0};
  draw(t, f, k, random);
  uint32_t padded = k->padded;
  float extinction = k->medium->extinction;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    float depth = exponential(random[i]), hero = k->hero[i], length = k->length[i];
    int scatters = depth < hero * length;
    float distance = scatters ? vl_min(depth / hero, length) : length;
    k->scatters[i] = scatters ? 1 : 0;
    k->distance[i] = distance;
    f->t[i] = k->flies[i] ? f->from[i] + distance : f->t[i];
    f->odds[i] *= k->flies[i] ? vl_exp(-extinction * distance) : 1.0f;
  }
}

/* Weighs channel c of the flights. exp(-(sigma - hero) distance) is the transmittance relative
 * to the hero. */
static void weigh_channel(vlFlights *f, const Segments *k, int c) {
  float *beta = f->beta[c], *u = f->u[c], *l = f->l[c];
  const float *a = k->a[c], *s = k->s[c];
  uint32_t padded = k->padded;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    float hero = k->hero[i], sigma = a[i] + s[i];
    float factor = vl_exp(-(sigma - hero) * k->distance[i]);
    /* light sampling uses the expected transmittance */
    float seen = vl_exp(-hero * k->length[i]);
    int flies = k->flies[i] != 0, scatters = k->scatters[i] != 0;
    float of_beta = scatters ? factor * s[i] / hero : factor;
    float of_u = scatters ? factor * sigma / hero : factor;
    beta[i] = flies ? beta[i] * of_beta : beta[i];
    u[i] = flies ? u[i] * of_u : u[i];
    l[i] = flies & !scatters ? l[i] / seen : l[i];
  }
}

/* Multiplies channel c by its transmittance. */
static void attenuate_channel(vlFlights *f, const Segments *k, int c) {
  float *beta = f->beta[c], *u = f->u[c];
  const float *a = k->a[c], *s = k->s[c];
  uint32_t padded = k->padded;
  uint32_t chosen = k->medium->scatters; /* whether flights pass by chance */
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    float passes = vl_exp(-(a[i] + s[i]) * k->length[i]);
    int flies = k->flies[i] != 0;
    beta[i] = flies ? beta[i] * passes : beta[i];
    u[i] = flies & (chosen != 0) ? u[i] * passes : u[i];
  }
}

static void attenuate_uniform(vlFlights *f, Segments *k) {
  const vlWorldMedium *m = k->medium;
  for (int c = 0; c < 4; c++)
    attenuate_channel(f, k, c);
  for (uint32_t i = 0; m->by_channel && i < f->n; i++)
    if (k->flies[i])
      absorb_by_channel(m, k->length[i], f, i);
  if (!m->scatters)
    return;
  float extinction = m->extinction;
  uint32_t padded = k->padded;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    f->odds[i] *= k->flies[i] ? vl_exp(-extinction * k->length[i]) : 1.0f;
  }
}

static void scatter_uniform(const vlTracing *t, vlFlights *f, Segments *k) {
  const vlWorldMedium *m = k->medium;
  find_heroes(t, f, k);
  sample_distances(t, f, k);
  for (uint32_t i = 0; m->by_channel && i < f->n; i++)
    if (k->flies[i])
      absorb_by_channel(m, k->distance[i], f, i);
  for (int c = 0; c < 4; c++)
    weigh_channel(f, k, c);
}

static void fly_uniform(const vlTracing *t, uint32_t medium, vlFlights *f, bool emission) {
  Segments k;
  find_segments(t->world, medium, f, &k);
  const vlWorldMedium *m = k.medium;
  if (emission && m->emits)
    emit(t, f, &k);
  if (m->scatters)
    scatter_uniform(t, f, &k);
  else
    attenuate_uniform(f, &k);
  for (uint32_t i = 0; i < f->n; i++) {
    if (!k.flies[i])
      continue;
    float max = vl_largest4(f->beta[0][i], f->beta[1][i], f->beta[2][i], f->beta[3][i]);
    bool scattered = m->scatters && k.scatters[i];
    bool dark = (scattered || !m->scatters) && !(max > 0.0f);
    f->end[i] = scattered ? VL_FLIGHT_SCATTERED : VL_FLIGHT_PASSED;
    if (dark)
      f->end[i] = VL_FLIGHT_ENDED;
  }
}

/* ---- any medium -------------------------------------------------------------------------- */

/* The state of lane i's ray. */
static vlFlight take(const vlTracing *t, const vlFlights *f, uint32_t i) {
  vlFlight r = {.hero = vl_volume_hero(t, f->paths, f->path[i]),
                .channels = vl_volume_rgb(t) ? 3 : 4,
                .first = f->first[i],
                .key = vl_volume_key(t, f->paths, f->path[i], f->depth, f->purpose),
                .count = f->count[i],
                .odds = f->odds[i]};
  for (int c = 0; c < 4; c++) {
    r.lambda[c] = f->lambda[c][i];
    r.beta[c] = f->beta[c][i];
    r.u[c] = f->u[c][i];
    r.l[c] = f->l[c][i];
  }
  return r;
}

/* Writes a ray's state back to lane i. */
static void put(vlFlights *f, uint32_t i, const vlFlight *r) {
  f->first[i] = r->first;
  f->count[i] = r->count;
  f->odds[i] = r->odds;
  for (int c = 0; c < 4; c++) {
    f->beta[c][i] = r->beta[c];
    f->u[c][i] = r->u[c];
    f->l[c][i] = r->l[c];
  }
}

void vl_fly(const vlTracing *t, vlFlights *f, bool emission) {
  for (uint32_t i = 0; i < f->n; i++)
    f->end[i] = VL_FLIGHT_PASSED;
  for (uint32_t i = 0; i < f->n; i++) {
    uint32_t medium = f->medium[i];
    if (medium == VL_NONE)
      continue;
    const vlWorldMedium *m = &t->world->media.items[medium];
    if (m->uniform) { /* with all other lanes in it */
      fly_uniform(t, medium, f, emission);
      continue;
    }
    f->medium[i] = VL_NONE;
    if (!(f->to[i] > f->from[i]))
      continue;
    vlFlight one = take(t, f, i);
    float given[4] = {f->given[0][i], f->given[1][i], f->given[2][i], f->given[3][i]};
    f->end[i] = vl_track(m, vl_ray_origin(&f->rays, i), vl_ray_direction(&f->rays, i),
                         f->from[i], f->to[i], emission, &one, given, &f->t[i]);
    for (int c = 0; c < 4; c++)
      f->given[c][i] = given[c];
    put(f, i, &one);
  }
}

void vl_attenuate(const vlTracing *t, vlFlights *f) {
  for (uint32_t i = 0; i < f->n; i++) {
    uint32_t medium = f->medium[i];
    if (medium == VL_NONE)
      continue;
    const vlWorldMedium *m = &t->world->media.items[medium];
    if (m->uniform) {
      Segments k;
      find_segments(t->world, medium, f, &k);
      attenuate_uniform(f, &k);
      continue;
    }
    f->medium[i] = VL_NONE;
    if (!(f->to[i] > f->from[i]))
      continue;
    vlFlight one = take(t, f, i);
    vl_track_through(m, vl_ray_origin(&f->rays, i), vl_ray_direction(&f->rays, i), f->from[i],
                     f->to[i], &one);
    put(f, i, &one);
  }
}
