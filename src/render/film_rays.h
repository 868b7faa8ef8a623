/* render/film_rays.h: film samples to camera rays. The image and the ground truth that uses the
 * image's samples share this code, so that their rays are bitwise equal. */
#ifndef RENDER_FILM_RAYS_H
#define RENDER_FILM_RAYS_H

#include "camera/rays.h"
#include "film/film.h"
#include "sampler/sampler.h"
#include "world/accel/accel.h"

/* Everything that determines the ray of a film sample. */
typedef struct vlFilmRays {
  vlCameraCompiled camera;
  vlSampler sampler;
  const vlFilterTable *filter;
  const vlCameraKernels *camera_kernels;
  const vlSamplerKernels *sampler_kernels;
  const vlFilterKernels *filter_kernels;
  bool lens;    /* lens points are sampled; false: all are the centre of the lens */
  bool centred; /* centre of the pixel and of the lens, middle of the shutter's time */
  float shared; /* at least 0: the number that samples the time of all rays; below 0: each ray
                   has its own */
  uint32_t groups; /* at least 1: the rays have the times of so many groups of light paths
                      (trace/two_way/two_way.h); 0: each ray has its own */
  /* with groups: random number in [0, 1) of the pass, for the times of all groups */
  float turn;
  float spread; /* film samples are drawn from this part of the pixel's filter around its
                   centre; 1: from all of it */
  bool uniform; /* film points are uniform in the pixel (reconstruct.h), not drawn from its
                   filter */
  bool middle;  /* all times are the middle of the shutter's time */
  bool moves;   /* true: the world has moving shapes, and ray times are world times, 0 to 1;
                   false: seconds */
} vlFilmRays;

/* Camera rays as rays of the world; they have times only if it moves. */
static inline vlRays vl_film_world_rays(const vlFilmRays *f, const vlCameraRays *r) {
  return (vlRays){
      r->ox, r->oy, r->oz, r->dx, r->dy, r->dz, r->t_min, r->t_max, f->moves ? r->time : NULL,
      NULL};
}

/* One element per sample; memory for VL_PAD(n) of them. In: the pixel and the sample's index in
 * it, n of each; the rest is output, and the padding repeats the last sample. film_x, film_y:
 * pixels from the pixel's top left corner; weight: the sample's weight by the pixel filter. */
typedef struct vlFilmRayRows {
  int32_t *px, *py;
  uint32_t *index;
  float *film_u, *film_v, *film_x, *film_y, *weight, *time, *lens_u, *lens_v;
  vlCameraRays rays;
} vlFilmRayRows;

/* Offsets of those arrays in a worker's rows of VL_ROW_SIZE numbers each; a caller's own rows
 * begin at VL_FILM_ROWS. */
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

void vl_film_rays_init(vlFilmRays *f, const vlCamera *camera, const vlFilterTable *filter,
                       const vlSampler *sampler, vlIsa isa);
/* The number in [0, 1) that samples the time of a group. For random turns it is uniform and
 * independent of the group. */
float vl_film_rays_group_time(const vlFilmRays *f, uint32_t group);
/* Makes rays have world times (0 to 1) if the world has moving shapes. */
void vl_film_rays_clock(vlFilmRays *f, const struct vlWorld *world);
/* The film points alone: film_x, film_y and the weights. n: at least 1. */
void vl_film_rays_points(const vlFilmRays *f, uint32_t n, const vlFilmRayRows *rows);
/* n: at least 1. */
void vl_film_rays_make(const vlFilmRays *f, uint32_t n, const vlFilmRayRows *rows);

#endif
