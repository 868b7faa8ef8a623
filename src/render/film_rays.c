/* render/film_rays.c: see film_rays.h. */
#include "render/film_rays.h"

#include <math.h>

#include "trace/trace.h"

static float *row(float *rows, int i) {
  return rows + (size_t)i * VL_ROW_SIZE;
}

vlFilmRayRows vl_film_ray_rows(float *rows) {
  float *ray[11];
  for (int i = 0; i < 11; i++)
    ray[i] = row(rows, VL_FILM_RAY + i);
  return (vlFilmRayRows){.px = (int32_t *)(void *)row(rows, VL_FILM_PIXEL_X),
                         .py = (int32_t *)(void *)row(rows, VL_FILM_PIXEL_Y),
                         .index = (uint32_t *)(void *)row(rows, VL_FILM_INDEX),
                         .film_u = row(rows, VL_FILM_U),
                         .film_v = row(rows, VL_FILM_V),
                         .film_x = row(rows, VL_FILM_X),
                         .film_y = row(rows, VL_FILM_Y),
                         .weight = row(rows, VL_FILM_WEIGHT),
                         .time = row(rows, VL_FILM_TIME),
                         .lens_u = row(rows, VL_FILM_LENS_U),
                         .lens_v = row(rows, VL_FILM_LENS_V),
                         .rays = {.ox = ray[0],
                                  .oy = ray[1],
                                  .oz = ray[2],
                                  .dx = ray[3],
                                  .dy = ray[4],
                                  .dz = ray[5],
                                  .t_min = ray[6],
                                  .t_max = ray[7],
                                  .time = ray[8],
                                  .valid = ray[9],
                                  .weight = ray[10]}};
}

void vl_film_rays_init(vlFilmRays *f, const vlCamera *camera, const vlFilterTable *filter,
                       const vlSampler *sampler, vlIsa isa) {
  vl_camera_compile(camera, &f->camera);
  f->sampler = *sampler;
  f->filter = filter;
  f->camera_kernels = vl_camera_kernels(isa);
  f->sampler_kernels = vl_sampler_kernels(isa);
  f->filter_kernels = vl_filter_kernels(isa);
  f->lens = camera->lens_radius > 0 || (camera->own && camera->own->lens);
  f->middle = f->moves = f->centred = f->uniform = false;
  f->shared = -1.0f;
  f->groups = 0;
  f->turn = 0.0f;
  f->spread = 1.0f;
}

void vl_film_rays_clock(vlFilmRays *f, const vlWorld *world) {
  f->moves = world->moves;
  if (f->moves)
    vl_camera_retime(&f->camera, world->time_open, 1 / (world->time_close - world->time_open));
}

void vl_film_rays_points(const vlFilmRays *f, uint32_t n, const vlFilmRayRows *r) {
  const vlSamplerKernels *k = f->sampler_kernels;
  for (uint32_t i = n; i < VL_PAD(n); i++) {
    r->px[i] = r->px[n - 1];
    r->py[i] = r->py[n - 1];
    r->index[i] = r->index[n - 1];
  }
  k->get_2d(&f->sampler, n, r->px, r->py, r->index, VL_DIM_FILM, r->film_u, r->film_v);
  if (f->uniform) {
    for (uint32_t i = 0; i < VL_PAD(n); i++) {
      r->film_x[i] = r->film_u[i];
      r->film_y[i] = r->film_v[i];
      r->weight[i] = 1.0f;
    }
  } else {
    f->filter_kernels->sample(f->filter, n, r->film_u, r->film_v, r->film_x, r->film_y,
                              r->weight);
    for (uint32_t i = 0; i < VL_PAD(n); i++) {
      r->film_x[i] = r->film_x[i] * f->spread + 0.5f;
      r->film_y[i] = r->film_y[i] * f->spread + 0.5f;
    }
  }
  for (uint32_t i = 0; f->centred && i < VL_PAD(n); i++) {
    r->film_x[i] = r->film_y[i] = 0.5f;
    r->weight[i] = 1.0f;
  }
}

/* Multiples of the golden ratio, modulo 1, are evenly distributed for any number of groups. */
float vl_film_rays_group_time(const vlFilmRays *f, uint32_t group) {
  float u = (float)group * 0.61803399f + f->turn;
  return fminf(u - floorf(u), VL_ONE_MINUS_EPSILON);
}

static void sample_times(const vlFilmRays *f, uint32_t n, const vlFilmRayRows *r) {
  const vlSamplerKernels *k = f->sampler_kernels;
  bool same = f->middle || f->centred || f->shared >= 0.0f;
  if (!same)
    k->get_1d(&f->sampler, n, r->px, r->py, r->index,
              f->groups ? VL_DIM_WAVELENGTH : VL_DIM_TIME, r->time);
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    if (same)
      r->time[i] = f->middle || f->centred ? 0.5f : f->shared;
    else if (f->groups)
      r->time[i] = vl_film_rays_group_time(f, (uint32_t)(r->time[i] * (float)f->groups));
  }
}

void vl_film_rays_make(const vlFilmRays *f, uint32_t n, const vlFilmRayRows *r) {
  const vlSamplerKernels *k = f->sampler_kernels;
  vl_film_rays_points(f, n, r);
  sample_times(f, n, r);
  if (f->lens && !f->centred)
    k->get_2d(&f->sampler, n, r->px, r->py, r->index, VL_DIM_LENS, r->lens_u, r->lens_v);
  else
    for (uint32_t i = 0; i < VL_PAD(n); i++)
      r->lens_u[i] = r->lens_v[i] = 0.5f;
  vlCameraSamples samples = {r->film_x, r->film_y, r->px, r->py, r->lens_u, r->lens_v, r->time};
  f->camera_kernels->rays(&f->camera, n, &samples, &r->rays);
  /* times outside [0, 1] are clamped: the world is at rest there */
  for (uint32_t i = 0; f->moves && i < VL_PAD(n); i++) {
    float t = r->rays.time[i] > 0.0f ? r->rays.time[i] : 0.0f;
    r->rays.time[i] = t < 1.0f ? t : 1.0f;
  }
}
