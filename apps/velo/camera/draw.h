/* camera/draw.h: the parts of `velo camera draw`: what a camera sees, a view of it from
 * outside, and the drawing over that view. */
#ifndef APP_CAMERA_DRAW_H
#define APP_CAMERA_DRAW_H

#include "image/overlay.h"
#include "velo/drawing.h"
#include "velo/render.h"

/* Points of the scene that a camera sees. */
typedef struct Seen {
  double *points; /* 3 each, world space; freed by the caller */
  /* along the view direction, or from the eye of a camera that sees backwards */
  double *depths;
  double *pixels; /* 2 each, as fractions of the image */
  uint32_t count;
  double near, middle, far; /* of the depths: 5th, 50th and 90th percentile */
} Seen;

/* Looks through a small image of the camera. A world without visible surfaces: count is 0. */
vlResult draw_look(const vlWorld *world, const vlCamera *camera, Seen *seen, vlError *error);
void draw_forget(Seen *seen);

/* A view from outside. */
typedef struct Outside {
  vlCamera camera;
  float *depth;          /* of each pixel, along the view direction; infinity: nothing. Freed by
                            draw_close */
  vlImage *image;        /* the rendered scene over white, linear */
  vlCamera inside;       /* the drawn camera at the size of its image */
  vlImage *inside_image; /* what it sees; null: not rendered */
} Outside;

/* Where the view comes from: degrees to the right of the camera's view direction, as seen from
 * its eye's top, and above the horizon; size in pixels; zoom: 1 fills the image. */
typedef struct OutsideDef {
  double azimuth, elevation, zoom;
  uint32_t width, height, spp;
  double exposure; /* stops; NaN: metered */
  bool scene;      /* the scene is rendered */
  bool own_image;  /* the camera's image is rendered */
} OutsideDef;

/* Chooses the outside camera so that the drawing and the seen points are in its image. */
vlResult draw_choose_view(const vlCamera *of, const vlDrawing *drawing, const Seen *seen,
                          const OutsideDef *def, Outside *outside, vlError *error);
/* Renders the scene, its depth, and the image of the drawn camera `of`. Without def->scene: a
 * white sheet. */
vlResult draw_render(vlContext *context, const vlWorld *world, const vlSceneDefs *defs,
                     const OutsideDef *def, const vlCamera *of, const vlDrawing *drawing,
                     Outside *outside, vlError *error);
void draw_close(Outside *outside);

/* Draws over the image: what the scene hides is faint and dashed. */
void draw_paint(Overlay *overlay, const Outside *outside, const vlDrawing *drawing);

#endif
