/* light/portal.c: see portal.h. The weight of a cell is the light of the image's samples
 * in it, plus a small share of the mean, so that no direction has zero probability because it
 * falls between the samples. */
#include "light/portal.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/free.h"
#include "light/compile.h"
#include "math/elementary.h"
#include "math/octahedral.h"
#include "scene/scene.h"
#include "texture/lookup.h"
#include "velo/light.h"

enum { MAX_CELLS = 1024 };
static const double min_share = 0.02; /* share of the mean light that every cell gets */

static vlVec3 side(const float from[3], const float to[3], float *length) {
  vlVec3 d = vl_vec3(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
  *length = sqrtf(vl_length2(d));
  return vl_mul(d, 1.0f / *length);
}

/* pbrt's frame: x from the first corner to the last, y from the first to the second; light
 * arrives from x cross y. */
static void set_frame(const vlLightDef *def, vlPortal *portal) {
  vlVec3 x = side(def->portal[0], def->portal[3], &portal->width);
  vlVec3 y = side(def->portal[0], def->portal[1], &portal->height),
         z = vl_normalize(vl_cross(x, y));
  const vlVec3 rows[3] = {x, vl_cross(z, x), z};
  for (int i = 0; i < 3; i++) {
    portal->frame[3 * i] = rows[i].x;
    portal->frame[3 * i + 1] = rows[i].y;
    portal->frame[3 * i + 2] = rows[i].z;
    portal->corner[i] = def->portal[0][i];
  }
}

static float seen(const vlEnvironment *env, const vlMipmap *mip, vlVec3 d) {
  vlVec2 st = vl_environment_square(env, d);
  float y =
      vl_light_texel_luminance(vl_octahedral_texel(mip, st.x, st.y), mip->channels, env->space);
  return y > 0.0f ? y : 0.0f;
}

/* Smallest and largest number of sample points of a cell along each axis. */
enum { MIN_FINE = 2, MAX_FINE = 4 };

typedef struct Filling {
  const vlEnvironment *env;
  const vlMipmap *mip;
  vlPortal *portal;
  uint32_t fine;
  double *tangents; /* tangents of the sample points' angles, size * fine values */
  double *passes;   /* per row: light that passes through a unit of the portal's area */
} Filling;

/* The light of a row's cells, before summation. */
static void fill_row(void *user, uint32_t j, VL_UNUSED uint32_t worker) {
  const Filling *f = user;
  uint32_t n = f->portal->size, fine = f->fine;
  f->passes[j] = 0;
  for (uint32_t i = 0; i < n; i++) {
    double sum = 0;
    for (uint32_t k = 0; k < fine * fine; k++) {
      double tx = f->tangents[i * fine + k % fine], ty = f->tangents[j * fine + k / fine];
      vlVec3 w = vl_normalize(vl_vec3((float)tx, (float)ty, 1.0f));
      double part = vl_portal_solid_angle(tx, ty) / ((double)n * n * fine * fine);
      double light = part * (double)seen(f->env, f->mip, vl_portal_world(f->portal, w));
      sum += light;
      f->passes[j] += light * (double)w.z;
    }
    f->portal->sums[(size_t)(j + 1) * (n + 1) + i + 1] = sum;
  }
}

/* Fills all rows. *total: sum over all cells. */
static bool fill(vlContext *context, Filling *f, double *total, double *passes) {
  uint32_t n = f->portal->size, points = n * f->fine;
  f->tangents = vl_alloc_array(context, points, sizeof *f->tangents);
  f->passes = vl_alloc_array(context, n, sizeof *f->passes);
  bool fine = f->tangents && f->passes;
  for (uint32_t i = 0; fine && i < points; i++)
    f->tangents[i] = vl_precise_tan(M_PI * ((i + 0.5) / points - 0.5));
  if (fine)
    vl_parallel_for(context, n, fill_row, f);
  *total = *passes = 0;
  for (uint32_t j = 0; fine && j < n; j++) {
    *passes += f->passes[j];
    for (uint32_t i = 0; i < n; i++)
      *total += f->portal->sums[(size_t)(j + 1) * (n + 1) + i + 1];
  }
  VL_FREE(context, f->tangents, f->passes);
  return fine;
}

vlResult vl_world_add_portal(vlWorld *world, const vlLightDef *def, vlEnvironment *env,
                             double *power, vlError *error) {
  const vlMipmap *mip = world->images.items[env->image].mipmap;
  vlPortal *portal = vl_world_block(world, 1, sizeof *portal);
  if (!portal)
    return vl_fail_memory(error);
  uint32_t n = mip->levels[0].width < 64 ? 64 : mip->levels[0].width;
  n = n < MAX_CELLS ? n : MAX_CELLS;
  set_frame(def, portal);
  portal->size = n;
  portal->sums = vl_world_block(world, (size_t)(n + 1) * (n + 1), sizeof(double));
  if (!portal->sums)
    return vl_fail_memory(error);
  memset(portal->sums, 0, (size_t)(n + 1) * (n + 1) * sizeof(double));
  uint32_t fine = (mip->levels[0].width + n - 1) / n;
  Filling filling = {.env = env, .mip = mip, .portal = portal};
  filling.fine = fine < MIN_FINE ? MIN_FINE : fine < MAX_FINE ? fine : MAX_FINE;
  double total, passes;
  if (!fill(world->context, &filling, &total, &passes))
    return vl_fail_memory(error);
  double mean = total / (2 * M_PI);
  *power = passes * (double)portal->width * (double)portal->height;
  /* at the middles of columns, of rows */
  double *tangents = vl_alloc_array(world->context, n, sizeof *tangents);
  if (!tangents)
    return vl_fail_memory(error);
  for (uint32_t i = 0; i < n; i++)
    tangents[i] = vl_precise_tan(M_PI * ((i + 0.5) / n - 0.5));
  if (!(mean > 0))
    mean = 1; /* a black image: any distribution will do */
  for (uint32_t j = 0; j < n; j++) {
    double row = 0;
    for (uint32_t i = 0; i < n; i++) {
      double *at = portal->sums + (size_t)(j + 1) * (n + 1) + i + 1;
      row += *at + min_share * mean * vl_portal_solid_angle(tangents[i], tangents[j]) /
                       ((double)n * n);
      *at = row + at[-(ptrdiff_t)(n + 1)];
    }
  }
  vl_free(world->context, tangents);
  env->portal = portal;
  return VL_OK;
}
