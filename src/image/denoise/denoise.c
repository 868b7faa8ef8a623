/* image/denoise/denoise.c: vl_denoise: copies an image's channels to planes, fits all tiles,
 * and makes the result an image. docs/denoising.md describes the method. */
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/cancel.h"
#include "base/cookie.h"
#include "base/error.h"
#include "base/file.h"
#include "image/denoise/denoise.h"
#include "math/approx.h"

enum {
  LEVELS = 2,
  COLOR = 3,
  PLANES = 4 * COLOR + VL_DENOISE_FEATURES + 1,
  SLOPES = COLOR * (VL_DENOISE_FEATURES + 2)
};

typedef struct Denoise {
  const vlImage *image;
  const vlCancel *cancel;
  vlContext *context;
  vlDenoiseChannels channels;
  /* The image, then lattices of every VL_DENOISE_STEPth pixel of every VL_DENOISE_STEPth row of
   * the planes before. */
  vlDenoisePlanes planes[LEVELS];
  float *memory[LEVELS]; /* the blocks that hold the planes */
  int level;             /* of the planes that the workers fit */
  float nearest;         /* largest disparity in the image */
  vlDenoiseScratch *scratch;
  const vlDenoiseKernels *kernels;
  atomic_uint_fast64_t not_finite;
} Denoise;

vlDenoiseDef vl_default_denoise_def(void) {
  return (vlDenoiseDef){.cookie = VL_COOKIE_DENOISE};
}

/* ---- channels ---------------------------------------------------------------------------- */

static vlResult find_channels(const vlImage *image, bool errors, vlDenoiseChannels *to,
                              vlError *error) {
  static const char *const colors[COLOR] = {"R", "G", "B"}, *const sigmas[COLOR] = {"error.R",
                                                                                    "error.G",
                                                                                    "error.B"};
  static const char *const independent[COLOR] = {"feature.error.R", "feature.error.G",
                                                 "feature.error.B"};
  static const char *const features[VL_DENOISE_FEATURES] = {
      "feature.albedo.R", "feature.albedo.G", "feature.albedo.B",   "feature.N.X",
      "feature.N.Y",      "feature.N.Z",      "feature.disparity.Y"};
  for (int c = 0; c < COLOR; c++) {
    to->color[c] = vl_image_find_channel(image, colors[c]);
    to->error[c] = vl_image_find_channel(image, independent[c]);
    if (to->error[c] < 0)
      to->error[c] = vl_image_find_channel(image, sigmas[c]);
    if (to->color[c] < 0)
      return vl_fail(error, VL_ERROR_SCENE, "denoise: the image has no channel %s", colors[c]);
    if (to->error[c] < 0 && errors)
      return vl_fail(error, VL_ERROR_SCENE,
                     "denoise: the image has no channel %s, its standard error (velo render "
                     "--channels error)",
                     sigmas[c]);
  }
  to->alpha = vl_image_find_channel(image, "A");
  to->features = true;
  for (int k = 0; k < VL_DENOISE_FEATURES; k++) {
    to->feature[k] = vl_image_find_channel(image, features[k]);
    to->features = to->features && to->feature[k] >= 0;
  }
  return VL_OK;
}

/* ---- planes ------------------------------------------------------------------------------ */

static uint32_t tiles_across(const vlDenoisePlanes *p) {
  return (p->width + VL_DENOISE_TILE_X - 1) / VL_DENOISE_TILE_X;
}
static uint32_t tiles_down(const vlDenoisePlanes *p) {
  return (p->height + VL_DENOISE_TILE_Y - 1) / VL_DENOISE_TILE_Y;
}

typedef struct Loop {
  Denoise *denoise;
  vlParallelFn *body;
} Loop;

static void run_unless_cancelled(void *user, uint32_t index, uint32_t worker) {
  const Loop *loop = user;
  if (!vl_is_cancelled(loop->denoise->cancel))
    loop->body(loop->denoise, index, worker);
}

/* Runs body for each of the rows or tiles, and for none from the moment when the call is
 * cancelled: then its result is not used. */
static void for_each(Denoise *d, uint32_t count, vlParallelFn *body) {
  Loop loop = {d, body};
  vl_parallel_for(d->context, count, run_unless_cancelled, &loop);
}

enum { CLEARED = 1 << 18 }; /* floats of a task */

typedef struct Clearing {
  const vlCancel *cancel;
  float *memory;
  size_t floats;
} Clearing;

static void clear_part(void *user, uint32_t index, VL_UNUSED uint32_t worker) {
  const Clearing *clearing = user;
  size_t first = (size_t)index * CLEARED, left = clearing->floats - first;
  if (!vl_is_cancelled(clearing->cancel))
    memset(clearing->memory + first, 0, (left < CLEARED ? left : CLEARED) * sizeof(float));
}

/* Memory of zeros, unless the call is cancelled: at 1280 x 720 it takes longer than one may
 * wait for that. Null: out of memory. */
static float *make_zeros(Denoise *d, size_t floats) {
  Clearing clearing = {d->cancel, vl_alloc_array(d->context, floats, sizeof(float)), floats};
  if (clearing.memory)
    vl_parallel_for(d->context, (uint32_t)((floats + CLEARED - 1) / CLEARED), clear_part,
                    &clearing);
  return clearing.memory;
}

/* Allocates planes of the given size in one block. */
static float *make_planes(Denoise *d, vlDenoisePlanes *p, uint32_t width, uint32_t height,
                          bool slopes) {
  p->width = width;
  p->height = height;
  p->bandwidth2 = slopes ? 1.0f : 0.36f;
  size_t stride = (size_t)tiles_across(p) * VL_DENOISE_TILE_X + 2 * VL_DENOISE_BORDER;
  size_t size = stride * ((size_t)tiles_down(p) * VL_DENOISE_TILE_Y + 2 * VL_DENOISE_BORDER);
  p->stride = (ptrdiff_t)stride;
  float *memory = make_zeros(d, size * (slopes ? PLANES + SLOPES : PLANES));
  if (!memory)
    return NULL;
  float *at = memory + VL_DENOISE_BORDER * stride + VL_DENOISE_BORDER;
  for (int c = 0; c < COLOR; c++) {
    p->color[c] = at;
    at += size;
    p->variance[c] = at;
    at += size;
    p->result[c] = at;
    at += size;
    p->noise[c] = at;
    at += size;
  }
  for (int k = 0; k < VL_DENOISE_FEATURES; k++) {
    p->feature[k] = at;
    at += size;
  }
  p->valid = at;
  for (int c = 0; c < COLOR && slopes; c++)
    for (int k = 0; k < VL_DENOISE_FEATURES + 2; k++) {
      at += size;
      p->slope[c][k] = at;
    }
  return memory;
}

static inline float get(const Denoise *d, uint32_t x, uint32_t y, int channel) {
  const vlImage *i = d->image;
  if (i->type == VL_PIXEL_F32)
    return (
        (const float *)i->pixels)[((size_t)y * i->width + x) * i->channels + (size_t)channel];
  return vl_image_get(i, x, y, (uint32_t)channel);
}

static ptrdiff_t index_of(const vlDenoisePlanes *p, uint32_t x, uint32_t y) {
  return (ptrdiff_t)y * p->stride + (ptrdiff_t)x;
}

/* The largest disparity in the image; 1 without features. read_row raises disparities below a
 * thousandth of it to that value, also the 0 of pixels that hit nothing. */
static float find_nearest(const Denoise *d) {
  float max = 0.0f;
  for (uint32_t y = 0; y < d->planes[0].height && d->channels.features; y++)
    for (uint32_t x = 0; x < d->planes[0].width; x++) {
      float v = get(d, x, y, d->channels.feature[VL_DENOISE_FEATURES - 1]);
      if (isfinite(v) && v > max)
        max = v;
    }
  return max > 0.0f ? max : 1.0f;
}

/* Reads a row. Leaves the means of R, G and B in the plane result[1], for the search of
 * outliers; 0 for a pixel that is not valid. */
static void read_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  Denoise *d = user;
  const vlDenoisePlanes *p = &d->planes[0];
  const vlDenoiseChannels *from = &d->channels;
  float farthest = 1e-3f * d->nearest;
  for (uint32_t x = 0; x < p->width; x++) {
    ptrdiff_t at = index_of(p, x, y);
    for (int k = 0; k < VL_DENOISE_FEATURES && from->features; k++) {
      float v = get(d, x, y, from->feature[k]);
      if (!isfinite(v))
        v = 0.0f;
      p->feature[k][at] = k < VL_DENOISE_FEATURES - 1 ? v : vl_ln(v > farthest ? v : farthest);
    }
    bool valid = true;
    for (int c = 0; c < COLOR; c++) {
      float v = get(d, x, y, from->color[c]), e = get(d, x, y, from->error[c]);
      valid = valid && isfinite(v) && isfinite(e * e);
      p->color[c][at] = v;
      p->variance[c][at] = e * e;
    }
    p->valid[at] = valid ? 1.0f : 0.0f;
    for (int c = 0; c < COLOR && !valid; c++)
      p->color[c][at] = p->variance[c][at] = 0.0f;
    p->result[1][at] = (p->color[0][at] + p->color[1][at] + p->color[2][at]) * (1.0f / 3.0f);
    if (!valid)
      atomic_fetch_add_explicit(&d->not_finite, 1, memory_order_relaxed);
  }
}

/* Mean and variance of the valid pixels in the smallest square around `at` that contains a
 * valid pixel; 0 if the window contains none. */
static void nearest_valid(const vlDenoisePlanes *p, float *const plane[COLOR], ptrdiff_t at,
                          float mean[COLOR], float variance[COLOR]) {
  float sums[COLOR] = {0}, squares[COLOR] = {0}, count = 0.0f;
  for (int reach = 1; reach <= VL_DENOISE_RADIUS && count == 0.0f; reach++)
    for (int dy = -reach; dy <= reach; dy++)
      for (int dx = -reach; dx <= reach; dx++) {
        ptrdiff_t q = at + dy * p->stride + dx;
        count += p->valid[q];
        for (int c = 0; c < COLOR && p->valid[q] != 0.0f; c++) {
          sums[c] += plane[c][q];
          squares[c] += plane[c][q] * plane[c][q];
        }
      }
  for (int c = 0; c < COLOR; c++) {
    mean[c] = count > 0.0f ? sums[c] / count : 0.0f;
    float spread = count > 0.0f ? squares[c] / count - mean[c] * mean[c] : 0.0f;
    variance[c] = spread > 0.0f ? spread : 0.0f;
  }
}

/* Replaces the values of a pixel that is not finite, so that patches that contain it can be
 * compared. */
static void fill(const vlDenoisePlanes *p, ptrdiff_t at) {
  float mean[COLOR], variance[COLOR];
  nearest_valid(p, p->color, at, mean, variance);
  for (int c = 0; c < COLOR; c++) {
    p->color[c][at] = mean[c];
    p->variance[c][at] = variance[c];
  }
}

static void fill_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const Denoise *d = user;
  for (uint32_t x = 0; x < d->planes[0].width; x++)
    if (d->planes[0].valid[index_of(&d->planes[0], x, y)] == 0.0f)
      fill(&d->planes[0], index_of(&d->planes[0], x, y));
}

/* ---- outliers ---------------------------------------------------------------------------- */

static void cap_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const Denoise *d = user;
  d->kernels->cap(&d->planes[0], y);
}

static void scale_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const vlDenoisePlanes *p = &((const Denoise *)user)->planes[0];
  for (uint32_t x = 0; x < p->width; x++) {
    ptrdiff_t at = index_of(p, x, y);
    float factor = p->result[0][at];
    for (int c = 0; c < COLOR; c++) {
      p->color[c][at] *= factor;
      p->variance[c][at] *= factor * factor;
    }
  }
}

/* ---- the border -------------------------------------------------------------------------- */

static ptrdiff_t mirror(ptrdiff_t i, uint32_t size) {
  ptrdiff_t last = (ptrdiff_t)size - 1;
  i = i < 0 ? -1 - i : i > last ? 2 * last + 1 - i : i;
  return i < 0 ? 0 : i > last ? last : i;
}

/* Mirrors the image into the border, as far as patches in windows reach. Mirrored pixels are
 * used to compare patches. They are not valid and so have no weight in the fit. */
static void mirror_plane(const vlDenoisePlanes *p, float *plane) {
  const ptrdiff_t reach = VL_DENOISE_RADIUS + VL_DENOISE_PATCH, width = p->width,
                  height = p->height;
  for (ptrdiff_t y = 0; y < height; y++) {
    float *row = plane + y * p->stride;
    for (ptrdiff_t k = 1; k <= reach; k++) {
      row[-k] = row[mirror(-k, p->width)];
      row[width - 1 + k] = row[mirror(width - 1 + k, p->width)];
    }
  }
  size_t bytes = (size_t)(width + 2 * reach) * sizeof(float);
  for (ptrdiff_t k = 1; k <= reach; k++) {
    memcpy(plane - k * p->stride - reach, plane + mirror(-k, p->height) * p->stride - reach,
           bytes);
    ptrdiff_t below = height - 1 + k;
    memcpy(plane + below * p->stride - reach,
           plane + mirror(below, p->height) * p->stride - reach, bytes);
  }
}

/* ---- variances --------------------------------------------------------------------------- */

static void raise_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const Denoise *d = user;
  d->kernels->raise(&d->planes[0], y);
}

/* Raises variances that seem too small. */
static void raise_variances(Denoise *d) {
  vlDenoisePlanes *p = &d->planes[0];
  for (int c = 0; c < COLOR; c++)
    mirror_plane(p, p->variance[c]);
  for_each(d, p->height, raise_row);
  for (int c = 0; c < COLOR; c++) {
    float *raised = p->result[c];
    p->result[c] = p->variance[c];
    p->variance[c] = raised;
  }
}

/* ---- the fit ----------------------------------------------------------------------------- */

static void fit_tile(void *user, uint32_t index, uint32_t worker) {
  const Denoise *d = user;
  const vlDenoisePlanes *p = &d->planes[d->level];
  uint32_t across = tiles_across(p);
  d->kernels->tile(p, &d->scratch[worker], index % across * VL_DENOISE_TILE_X,
                   index / across * VL_DENOISE_TILE_Y);
}

static void fit(Denoise *d) {
  const vlDenoisePlanes *p = &d->planes[d->level];
  for_each(d, tiles_across(p) * tiles_down(p), fit_tile);
}

/* ---- wide windows ------------------------------------------------------------------------ */

/* The lattice's points are the pixels STEP i + STEP / 2 of the rows STEP j + STEP / 2. Their
 * values are the results of the fits, their variances those of the results' noise. */
static void lattice_row(void *user, uint32_t j, VL_UNUSED uint32_t worker) {
  const Denoise *d = user;
  const vlDenoisePlanes *p = &d->planes[d->level - 1], *to = &d->planes[d->level];
  for (uint32_t i = 0; i < to->width; i++) {
    ptrdiff_t from = index_of(p, VL_DENOISE_STEP * i + VL_DENOISE_STEP / 2,
                              VL_DENOISE_STEP * j + VL_DENOISE_STEP / 2),
              at = index_of(to, i, j);
    for (int c = 0; c < COLOR; c++) {
      to->color[c][at] = p->result[c][from];
      to->variance[c][at] = p->noise[c][from] * VL_DENOISE_CORRELATION;
    }
    for (int k = 0; k < VL_DENOISE_FEATURES; k++)
      to->feature[k][at] = p->feature[k][from];
    to->valid[at] = p->valid[from];
  }
}

/* Turns the fits of a row of the lattice into functions of the features' values instead of
 * their differences. noise[0] becomes the share of the noise that a fit has removed. */
static void finish_lattice_row(void *user, uint32_t j, VL_UNUSED uint32_t worker) {
  const Denoise *d = user;
  const vlDenoisePlanes *p = &d->planes[d->level];
  ptrdiff_t at = index_of(p, 0, j), width = p->width;
  for (int c = 0; c < COLOR; c++)
    for (int k = 0; k < VL_DENOISE_FEATURES; k++) {
      float *restrict to = p->result[c] + at;
      const float *slope = p->slope[c][k] + at, *feature = p->feature[k] + at;
      for (ptrdiff_t i = 0; i < width; i++)
        to[i] -= slope[i] * feature[i];
    }
  for (ptrdiff_t i = at; i < at + width; i++) {
    float gain = 0.0f;
    for (int c = 0; c < COLOR; c++) {
      float before = p->variance[c][i], after = p->noise[c][i];
      if (after > 0.0f && after < before)
        gain += (1.0f - after / before) * (1.0f / COLOR);
    }
    p->noise[0][i] = gain;
  }
}

/* Copies the fit at index `from` to a neighbour outside of the lattice, (dx, dy) points away.
 */
static void extend(const vlDenoisePlanes *p, ptrdiff_t from, int dx, int dy) {
  ptrdiff_t to = from + dy * p->stride + dx;
  for (int c = 0; c < COLOR; c++) {
    for (int k = 0; k < VL_DENOISE_FEATURES + 2; k++)
      p->slope[c][k][to] = p->slope[c][k][from];
    p->result[c][to] =
        p->result[c][from] + (p->slope[c][VL_DENOISE_FEATURES][from] * (float)dx +
                              p->slope[c][VL_DENOISE_FEATURES + 1][from] * (float)dy) *
                                 (1.0f / VL_DENOISE_RADIUS);
  }
  p->noise[0][to] = p->noise[0][from];
}

static void extend_lattice(const vlDenoisePlanes *p) {
  for (uint32_t j = 0; j < p->height; j++) {
    extend(p, index_of(p, 0, j), -1, 0);
    extend(p, index_of(p, p->width - 1, j), 1, 0);
  }
  for (ptrdiff_t i = -1; i <= (ptrdiff_t)p->width; i++) {
    extend(p, i, 0, -1);
    extend(p, (ptrdiff_t)(p->height - 1) * p->stride + i, 0, 1);
  }
}

static void correct_rows(void *user, uint32_t index, VL_UNUSED uint32_t worker) {
  const Denoise *d = user;
  const vlDenoisePlanes *lattice = &d->planes[d->level];
  for (uint32_t i = 0; i <= lattice->width; i += VL_LANES)
    d->kernels->correct(lattice - 1, lattice, (int32_t)i - 1, (int32_t)index - 1);
}

static void mirror_planes(const vlDenoisePlanes *p) {
  for (int c = 0; c < COLOR; c++) {
    mirror_plane(p, p->color[c]);
    mirror_plane(p, p->variance[c]);
  }
  for (int k = 0; k < VL_DENOISE_FEATURES; k++)
    mirror_plane(p, p->feature[k]);
}

/* Corrects the low frequencies of the result of a level by fits of wide windows, which are
 * corrected by those of still wider ones. */
static vlResult correct_widely(Denoise *d) {
  int level = d->level + 1;
  const vlDenoisePlanes *p = &d->planes[d->level];
  uint32_t width = (p->width + VL_DENOISE_STEP / 2 - 1) / VL_DENOISE_STEP,
           height = (p->height + VL_DENOISE_STEP / 2 - 1) / VL_DENOISE_STEP;
  if (level == LEVELS || width == 0 || height == 0)
    return VL_OK;
  vlDenoisePlanes *lattice = &d->planes[level];
  d->memory[level] = make_planes(d, lattice, width, height, true);
  if (!d->memory[level])
    return VL_ERROR_MEMORY;
  d->level = level;
  for_each(d, height, lattice_row);
  mirror_planes(lattice);
  fit(d);
  VL_TRY(correct_widely(d));
  d->level = level;
  for_each(d, height, finish_lattice_row);
  extend_lattice(lattice);
  for_each(d, height + 1, correct_rows);
  return VL_OK;
}

/* ---- the result -------------------------------------------------------------------------- */

/* Writes a row of the result. A value is at least 0, or at least the input's value if that is
 * negative. A pixel that is not finite becomes the mean of the nearest denoised pixels. */
static void write_row(const Denoise *d, uint32_t y, vlImage *clean) {
  const vlDenoisePlanes *p = &d->planes[0];
  float *to = vl_image_row(clean, y), filled[COLOR], variance[COLOR];
  int error = vl_image_find_channel(clean, "error.R");
  for (uint32_t x = 0; x < p->width; x++, to += clean->channels) {
    ptrdiff_t at = index_of(p, x, y);
    bool valid = p->valid[at] != 0.0f;
    if (!valid)
      nearest_valid(p, p->result, at, filled, variance);
    for (int c = 0; c < COLOR; c++) {
      float own = p->color[c][at], min = own < 0.0f ? own : 0.0f,
            v = valid ? p->result[c][at] : filled[c];
      to[c] = v > min ? v : min;
      if (error >= 0)
        to[error + c] = valid ? sqrtf(VL_DENOISE_CORRELATION * p->noise[c][at]) : 0.0f;
    }
  }
}

static vlResult denoise(Denoise *d, vlImage *clean, vlError *error) {
  vlDenoisePlanes *p = &d->planes[0];
  vlContext *context = d->context;
  vlResult result = VL_OK;
  d->memory[0] = make_planes(d, p, d->image->width, d->image->height, false);
  d->scratch = vl_alloc_array(context, vl_context_threads(context), sizeof *d->scratch);
  if (d->memory[0] && d->scratch) {
    d->kernels = vl_denoise_kernels(vl_context_isa(context));
    d->nearest = find_nearest(d);
    for_each(d, p->height, read_row);
    if (vl_is_cancelled(d->cancel))
      result = vl_fail(error, VL_CANCELLED, "stopped");
    else if (d->not_finite == (uint64_t)p->width * p->height)
      result = vl_fail(error, VL_ERROR_SCENE,
                       "denoise: no pixel has a finite value and standard error; at least 2 "
                       "samples per pixel are needed");
  } else {
    result = vl_fail_memory(error);
  }
  if (result == VL_OK) {
    for_each(d, p->height, fill_row);
    for_each(d, p->height, cap_row);
    for_each(d, p->height, scale_row);
    raise_variances(d);
    mirror_planes(p);
    fit(d);
    result = correct_widely(d);
    if (result != VL_OK)
      vl_fail_memory(error);
    else if (vl_is_cancelled(d->cancel))
      result = vl_fail(error, VL_CANCELLED, "stopped");
  }
  for (uint32_t y = 0; y < p->height && result == VL_OK; y++)
    write_row(d, y, clean);
  for (int k = 0; k < LEVELS; k++)
    vl_free(context, d->memory[k]);
  vl_free(context, d->scratch);
  return result;
}

/* ---- the call ---------------------------------------------------------------------------- */

/* Makes the image for the result, with the alpha and the attributes of the input. errors: with
 * the channels of its standard error. */
static vlResult make_clean(const vlImage *image, int alpha, bool errors, vlImage **clean) {
  static const char *const names[] = {"R", "G", "B", "error.R", "error.G", "error.B"},
                           *const with_alpha[] = {"R",       "G",       "B",      "A",
                                                  "error.R", "error.G", "error.B"};
  uint32_t colors = alpha >= 0 ? 4 : 3;
  vlImageDef def =
      vl_default_image_def(image->width, image->height, errors ? colors + COLOR : colors);
  def.names = alpha >= 0 ? with_alpha : names;
  vlResult result = vl_image_create(image->context, &def, clean);
  float *to = result == VL_OK ? vl_image_pixels(*clean) : NULL;
  for (uint32_t y = 0; y < def.height && to && alpha >= 0; y++)
    for (uint32_t x = 0; x < def.width; x++, to += def.channels)
      to[3] = vl_image_get(image, x, y, (uint32_t)alpha);
  return result == VL_OK ? vl_image_add_attributes(*clean, image) : result;
}

vlResult vl_denoise(const vlImage *image, const vlDenoiseDef *def, vlImage **clean,
                    vlDenoiseStats *stats, vlError *error) {
  double start = vl_seconds();
  vl_error_clear(error);
  if (clean)
    *clean = NULL;
  vlDenoiseDef standard = vl_default_denoise_def();
  if (!def)
    def = &standard;
  if (!image || !clean || !image->pixels)
    return vl_fail_argument(error, "denoise: image, its pixels or clean is null");
  if (def->cookie != VL_COOKIE_DENOISE || (unsigned)def->denoiser > VL_DENOISER_OIDN)
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "denoise: def.cookie or def.denoiser is not that of a default def of this version");
  Denoise work = {.image = image, .context = image->context, .cancel = def->cancel};
  VL_TRY(find_channels(image, def->denoiser == VL_DENOISER_VELO, &work.channels, error));
  vlResult result = make_clean(image, work.channels.alpha,
                               def->errors && def->denoiser == VL_DENOISER_VELO, clean);
  if (result != VL_OK)
    vl_fail_memory(error);
  else if (def->denoiser == VL_DENOISER_OIDN)
    result = vl_denoise_oidn(image, &work.channels, def->library, *clean, error);
  else
    result = denoise(&work, *clean, error);
  if (stats)
    *stats = (vlDenoiseStats){work.not_finite, work.channels.features, vl_seconds() - start};
  if (result == VL_OK)
    return VL_OK;
  vl_image_destroy(*clean);
  *clean = NULL;
  return result;
}
