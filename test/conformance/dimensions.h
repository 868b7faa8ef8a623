/* conformance/dimensions.h: the law of dimensions: no tracer uses a number of a sample twice. A
 * sampler of the test's own writes down which numbers it is asked for. */
#ifndef TEST_CONFORMANCE_DIMENSIONS_H
#define TEST_CONFORMANCE_DIMENSIONS_H

#include "conformance.h"
#include "unit.h"
#include "velo/own.h"

enum { TABLE_BITS = 20, TABLE_SIZE = 1 << TABLE_BITS };

/* What a render asked for: a hash table of pixel, sample and dimension, 0 where it is empty. */
typedef struct Numbers {
  uint64_t *asked;
  uint32_t count, twice, last_twice;
} Numbers;

static uint64_t mixed(uint64_t x) {
  x = (x ^ x >> 31) * 0x7fb5d329728ea185u;
  x = (x ^ x >> 27) * 0x81dadef4bc2dd44du;
  return x ^ x >> 33;
}

static void write_down(Numbers *n, uint64_t key, uint32_t dimension) {
  uint32_t at = (uint32_t)(mixed(key) >> (64 - TABLE_BITS));
  while (n->asked[at] && n->asked[at] != key)
    at = (at + 1) % TABLE_SIZE;
  if (n->asked[at]) {
    n->twice++;
    n->last_twice = dimension;
  } else {
    n->asked[at] = key;
    n->count++;
  }
  assert_true(n->count < TABLE_SIZE / 2);
}

static void numbers_written_down(void *user, const vlOwnSamples *s) {
  for (uint32_t k = 0; k < s->dimensions; k++) {
    const uint32_t dimension = s->dimension + k;
    float *out = k ? s->v : s->u;
    for (uint32_t i = 0; i < s->count; i++) {
      const uint64_t pixel = (uint64_t)(s->x[i] + 8) * 64 + (uint64_t)(s->y[i] + 8);
      const uint64_t key = ((pixel << 12) + s->index[i] + 1) << 32 | dimension;
      write_down(user, key, dimension);
      out[i] = (float)(mixed(key ^ s->seed) >> 40) * 0x1p-24f;
    }
  }
}

/* Paths of many bounces: on rough and smooth surfaces, through glass, a coat and fog, and of
 * tracers from the camera alone in bodies in which light scatters, from one to the next. */
static const char many_bounces[] = HEAD
    "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.1 .1 .1] "
    "\"rgb sigma_s\" [2 2 2] WorldBegin " LIGHTS
    "AttributeBegin Material \"%s\" "
    "Shape \"bilinearmesh\" \"point3 P\" [-3 -.6 3 3 -.6 3 -3 -.6 -3 3 -.6 -3] AttributeEnd\n"
    "AttributeBegin Material \"dielectric\" Translate -.5 0 0 Shape \"sphere\" "
    "\"float radius\" .4 AttributeEnd\n"
    "AttributeBegin Material \"%s\" Translate .5 0 0 Shape \"sphere\" "
    "\"float radius\" .4 AttributeEnd\n"
    "AttributeBegin Material \"coateddiffuse\" \"float roughness\" .3 Translate 0 0 -.6 "
    "Shape \"sphere\" \"float radius\" .5 AttributeEnd\n"
    "MediumInterface \"m\" \"\" Material \"interface\" Translate 0 .6 .5 Shape \"sphere\" "
    "\"float radius\" .5\n";

static void check_dimensions(vlTracer tracer, const char *name) {
  Numbers numbers = {.asked = calloc(TABLE_SIZE, sizeof *numbers.asked)};
  assert_non_null(numbers.asked);
  const vlOwnSampler sampler = {
      .name = "written down", .numbers = numbers_written_down, .user = &numbers};
  static char text[TEXT];
  const bool one_way = tracer == VL_TRACER_PATH || tracer == VL_TRACER_VOLPATH;
  const char *body = one_way ? "subsurface" : "diffuse";
  snprintf(text, sizeof text, many_bounces, body, body);
  vlScene *scene = need_scene(text);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->render.tracer = tracer;
  defs->render.spp = SAMPLES;
  defs->render.share_samples = false;
  defs->render.own_sampler = &sampler;
  vl_image_destroy(need_image(scene, text));
  if (numbers.twice)
    broken("tracers", name, "%u of %u numbers are used twice, the last of dimension %u",
           numbers.twice, numbers.count, numbers.last_twice);
  free(numbers.asked);
}

static void dimensions_of_tracers(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("tracers");
  for (uint32_t k = 0; k < family->kind_count; k++)
    check_dimensions((vlTracer)k, family->words[k]);
  expect_no_failures();
}

#endif
