/* image/check.h: the parts of `velo image check`: the state of the file being checked, and the
 * rules with their worst errors. */
#ifndef APP_IMAGE_CHECK_H
#define APP_IMAGE_CHECK_H

#include "image/header.h"
#include "velo/camera.h"
#include "velo/image.h"

/* The rules; errors are relative. */
enum {
  RULE_POINT,
  RULE_DEPTH,
  RULE_PIXEL,
  RULE_RAY,
  RULE_UNIT_N,
  RULE_UNIT_NG,
  RULE_NOTHING,
  RULE_IDS,
  RULE_TYPES,
  RULE_FINITE,
  RULE_FILM,
  RULE_SAMPLES,
  RULE_MATTE_IDS,
  RULE_MATTE_SUM,
  RULE_FLOW,
  RULE_HIDDEN,
  RULE_SEEN,
  RULE_ROWS,
  RULES
};
/* A row of the table of rules ends with its last member that is not zero. */
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
typedef struct Rule {
  const char *name, *text;
  double limit; /* errors up to this limit are accepted at any threshold */
  bool checked;
  double worst;
  uint32_t x, y; /* pixel of the worst error */
} Rule;

/* One Cryptomatte of the file. */
typedef struct Matte {
  uint32_t ranks;
  int id[32], coverage[32]; /* channel indices of each rank */
  uint32_t *known;          /* bits of the manifest's hashes, sorted */
  size_t known_count;
} Matte;

typedef struct Check {
  const vlImage *image;
  const char *path;
  const float *pixel; /* the current pixel */
  vlCamera camera;    /* of the current pixel */
  /* EACH: the camera is that of each row's time; otherwise that of the header. UNKNOWN:
   * RULE_ROWS compares with the row's. */
  HeaderRows rows;
  vlCamera rolling; /* with rows: the moving camera */
  /* corner of the data window; position of the pixel in the whole image */
  uint32_t x0, y0, x, y;
  /* channel indices; -1: not in the file */
  int z, distance, p, n, ng, ray, object, material, primitive, instance, uv, albedo, film,
      samples, error, alpha;
  int flow[2], hidden[2];
  double point[2]; /* film point of the pixel's ray */
  double reach[2]; /* largest offset of the film point from the pixel's centre, in pixels; 0:
                      none */
  /* samples per pixel from the header, of adaptive renders the most; 0: not given */
  double spp;
  bool adaptive;       /* the header names a noise threshold */
  bool matte_is_alpha; /* the sum of coverages equals the image's alpha */
  Matte mattes[3];
  uint32_t *material_of; /* material id of each object id, from the first pixel that shows the
                            object */
  uint64_t hits, misses;
  double pixel_error; /* largest error in pixels */

  const vlImage *other; /* the image to which the flow leads; null: not given */
  vlCamera other_camera;
  vlOptics *optics, *other_optics; /* lenses of the cameras; null: none */
  uint32_t other_x0, other_y0;
  int other_distance, which; /* other_distance: channel index; which: 0 forward, 1 backward */
  uint64_t flow_seen, flow_wrong;
  /* Pixels whose flow leads elsewhere than in a world at rest, and those of them that lead to
   * the same object and instance: what moves does so. */
  uint64_t flow_elsewhere, flow_same;
  int other_object, other_instance; /* channel indices; -1: not in the other file */

  Rule rules[RULES];
} Check;

enum { CHECK_OBJECTS = 1 << 20 }; /* larger object ids are not recorded */

void check_note(Check *c, int rule, double error);
/* Notes no error, or an infinite one. */
void check_that(Check *c, int rule, bool good);
void check_load3(const Check *c, int channel, double v[3]);
/* Returns whether the pixel shows a surface, according to any channel that tells. Returns true
 * if no channel tells. */
bool check_is_hit(const Check *c);
/* check_pixel.c */
void check_pixel(Check *c);
/* check_matte.c; returns -1 or the exit code. */
int check_find_mattes(Check *c);
void check_free_mattes(Check *c);
void check_mattes(Check *c);
/* check_flow.c */
void check_flow(Check *c);
void check_finish_flow(Check *c);
/* Says which wrong flow may be that of what moves. threshold: of RULE_FLOW. */
void check_explain_flow(const Check *c, double threshold);

#endif
