/* render/film_rays.h: samples of the film to rays of the camera. The image's rays and those of the ground truth that
 * counts the image's own samples come from here: the same bits. */
#ifndef RENDER_FILM_RAYS_H
#define RENDER_FILM_RAYS_H

#include "camera/rays.h"
#include "film/film.h"
#include "trace/sampler/sampler.h"

/* What a sample of the film becomes depends on these alone. */
typedef struct vlFilmRays {
  vlCameraCompiled camera;
  vlSampler sampler;
  const vlFilterTable *filter;
  const vlCameraKernels *camera_kernels;
  const vlSamplerKernels *sampler_kernels;
  const vlFilterKernels *filter_kernels;
  bool lens;    /* points on the lens are drawn */
  bool centred; /* of pixel and lens, and in the middle of the shutter's time */
  float shared; /* from 0 on: the number that all times are drawn by */
  bool middle;  /* in the middle of the shutter's time, all of them */
  bool moves;   /* something in the world does: times of rays are the world's, 0 to 1; else seconds */
} vlFilmRays;

/* One element a sample, VL_PAD(n) of them: in are pixel and index of the sample in it; the rest comes out. film_x,
 * film_y: from the pixel's top left corner; weight: of the pixel filter. */
typedef struct vlFilmRayRows {
  int32_t *px, *py;
  uint32_t *index;
  float *film_u, *film_v, *film_x, *film_y, *weight, *time, *lens_u, *lens_v;
  vlCameraRays rays;
} vlFilmRayRows;

/* Where those arrays stand in a worker's rows of VL_ROW_SIZE numbers each; its own begin at VL_FILM_ROWS. */
enum {
  VL_FILM_U,
  VL_FILM_V,
  VL_FILM_X,
  VL_FILM_Y,
  VL_FILM_WEIGHT,
  VL_FILM_TIME,
  VL_FILM_LENS_U,
  VL_FILM_LENS_V,
  VL_FILM_RAY, /* ox, oy, oz, dx, dy, dz, t_min, t_max, time, valid, weight */
  VL_FILM_PIXEL_X = VL_FILM_RAY + 11,
  VL_FILM_PIXEL_Y,
  VL_FILM_INDEX,
  VL_FILM_ROWS
};
vlFilmRayRows vl_film_ray_rows(float *rows);

void vl_film_rays_init(vlFilmRays *f, const vlCamera *camera, const vlFilterTable *filter, const vlSampler *sampler,
                       vlIsa isa);
/* Rays come with the world's time. */
void vl_film_rays_clock(vlFilmRays *f, const struct vlWorld *world);
void vl_film_rays_make(const vlFilmRays *f, uint32_t n, const vlFilmRayRows *rows);

#endif
