/* image/check.h: `velo image check` in parts: what is known of the file, and the rules with their worst errors. */
#ifndef APP_IMAGE_CHECK_H
#define APP_IMAGE_CHECK_H

#include "velo/velo.h"

/* What is checked; errors are relative. */
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
  RULES
};
typedef struct Rule {
  const char *name, *text;
  double limit; /* accepted whatever the threshold */
  bool checked;
  double worst;
  uint32_t x, y; /* of the worst */
} Rule;

/* One Cryptomatte of the file. */
typedef struct Matte {
  uint32_t ranks;
  int id[32], coverage[32]; /* channels of each rank */
  uint32_t *known;          /* bits that the manifest lists, sorted */
  size_t known_count;
} Matte;

typedef struct Check {
  const vlImage *image;
  const char *path;
  const float *pixel; /* the one that is looked at */
  vlCamera camera;
  uint32_t x0, y0, x, y; /* corner of the data window, and place in the whole image */
  /* channels; -1: not in the file */
  int z, distance, p, n, ng, ray, object, material, primitive, instance, uv, albedo, film, samples, error, alpha;
  int flow[2], hidden[2];
  double point[2];     /* of the film: where the pixel's ray goes through */
  double reach[2];     /* how far from its centre that may be; 0: nowhere else */
  double spp;          /* of the header; 0: it does not say */
  bool matte_is_alpha; /* coverages add up to the image's alpha */
  Matte mattes[3];
  uint32_t *material_of; /* by object: as met first */
  uint64_t hits, misses;
  double pixel_error; /* largest, in pixels */

  const vlImage *other; /* what flow leads to; null: not given */
  vlCamera other_camera;
  vlOptics *optics, *other_optics; /* that the cameras have; null: none */
  uint32_t other_x0, other_y0;
  int other_distance, which; /* channel; 0 forward, 1 backward */
  uint64_t flow_seen, flow_wrong;

  Rule rules[RULES];
} Check;

enum { CHECK_OBJECTS = 1 << 20 }; /* those above are not remembered */

void check_note(Check *c, int rule, double error);
void check_load3(const Check *c, int channel, double v[3]);
double check_length3(const double v[3]);
/* Anything that tells whether the pixel met a surface; without such a channel it is taken to. */
bool check_is_hit(const Check *c);
/* image_check_pixel.c */
void check_pixel(Check *c);
/* image_check_matte.c: -1 or the exit code. */
int check_find_mattes(Check *c);
void check_free_mattes(Check *c);
void check_mattes(Check *c);
/* image_check_flow.c */
void check_flow(Check *c);
void check_finish_flow(Check *c);

#endif
