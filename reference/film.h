/* film.h: the lecture's view plane: pixels that add up what their samples bring, and the image in the end. */
#pragma once
#include "world.h"

typedef struct pixel {
  double sum[3], squares[3]; /* of the samples and of their squares */
  double covered;            /* samples that met a surface */
} pixel;

typedef struct view_plane {
  uint32_t width, height;
  uint32_t samples; /* per pixel */
  vlPixelFilter filter;
  observer eye;
  double exposure;
  pixel *pixels;
} view_plane;

view_plane make_view_plane(const vlSceneDefs *defs, uint32_t samples);
/* A point around the middle of a pixel, in pixels. */
square_point sample_filter(const view_plane *v, sampler *s);
/* The lecture's display_pixel, for one sample of the pixel. */
void add_sample(view_plane *v, uint32_t column, uint32_t row, spectrum radiance, const wavelengths *lambda,
                bool covered);
/* The image: R G B A, and error.R error.G error.B, the standard errors of the means. */
bool make_image(const view_plane *v, vlContext *context, vlImage **image);
