/* test/render/ground_truths.h: ground truth of a stage (shots.h): rendered, read by channel and
 * pixel, compared bit by bit. */
#ifndef TEST_RENDER_GROUND_TRUTHS_H
#define TEST_RENDER_GROUND_TRUTHS_H

#include "render/shots.h"

#include "failing_allocator.h"
#include "velo/channels.h"

typedef struct GroundTruth {
  vlWorld *world;
  vlCamera camera, other; /* other: the second camera of flow */
  vlFilm *film;
  vlImage *image, *floats, *ids;
} GroundTruth;

/* World and camera of the stage. */
static UNUSED GroundTruth ground_truth_begin(Stage *s) {
  GroundTruth t;
  memset(&t, 0, sizeof t);
  vlError error = {0};
  if (vl_world_build(s->scene, &s->build, &t.world, &error) != VL_OK)
    fail_msg("build: %s", error.message);
  if (vl_camera_make(&s->camera, &t.camera, NULL, &error) != VL_OK)
    fail_msg("camera: %s", error.message);
  return t;
}

static UNUSED void ground_truth_channels(GroundTruth *t, const vlChannelsDef *def) {
  vlError error = {0};
  if (vl_render_channels(t->world, &t->camera, def, &t->floats, &t->ids, &error) != VL_OK)
    fail_msg("channels: %s", error.message);
}

static UNUSED void ground_truth_free(GroundTruth *t) {
  vl_image_destroy(t->image);
  vl_image_destroy(t->floats);
  vl_image_destroy(t->ids);
  vl_film_destroy(t->film);
  vl_world_destroy(t->world);
}

static UNUSED const float *place(const GroundTruth *t, uint32_t x, uint32_t y,
                                 const char *name) {
  int channel = vl_image_find_channel(t->floats, name);
  assert_true(channel >= 0);
  return (const float *)vl_image_const_pixels(t->floats) +
         ((size_t)y * vl_image_width(t->floats) + x) * vl_image_channels(t->floats) + channel;
}
static UNUSED float number(const GroundTruth *t, uint32_t x, uint32_t y, const char *name) {
  return *place(t, x, y, name);
}
static UNUSED uint32_t id(const GroundTruth *t, uint32_t x, uint32_t y, const char *name) {
  int channel = vl_image_find_channel(t->ids, name);
  assert_true(channel >= 0);
  assert_int_equal(vl_image_type(t->ids), VL_PIXEL_U32);
  const uint32_t *pixels = vl_image_const_pixels(t->ids);
  return pixels[((size_t)y * vl_image_width(t->ids) + x) * vl_image_channels(t->ids) +
                (size_t)channel];
}

/* Expects b to equal a from pixel (dx, dy) on. */
static UNUSED void same_bits(const vlImage *a, const vlImage *b, uint32_t dx, uint32_t dy) {
  uint32_t step = vl_image_channels(a);
  assert_int_equal(step, vl_image_channels(b));
  const uint32_t *p = vl_image_const_pixels(a), *q = vl_image_const_pixels(b);
  for (uint32_t y = 0; y < vl_image_height(b); y++)
    for (uint32_t x = 0; x < vl_image_width(b); x++)
      assert_memory_equal(p + ((size_t)(y + dy) * vl_image_width(a) + x + dx) * step,
                          q + ((size_t)y * vl_image_width(b) + x) * step, step * sizeof *p);
}

/* An empty stage with the same defs on that instruction set and with other numbers of threads.
 * False: the machine does not have it. */
static UNUSED bool stage_like(const Stage *s, int isa, Stage *other) {
  *other = *s;
  vlContextDef def = vl_default_context_def();
  def.threads = isa == VL_ISA_BASE ? 1 : 3;
  def.isa = (vlIsa)isa;
  vlResult made = vl_context_create(&def, &other->context);
  if (made == VL_ERROR_UNSUPPORTED)
    return false;
  assert_int_equal(made, VL_OK);
  assert_int_equal(vl_scene_create(other->context, &other->scene), VL_OK);
  return true;
}

/* Fills and builds a 16 x 8 stage by `fill` and `begin`, then calls `take` while each
 * allocation in turn fails. It must report the failure and leak nothing. */
static UNUSED void ground_truth_out_of_memory(void (*fill)(Stage *s),
                                              GroundTruth (*begin)(Stage *s),
                                              vlResult (*take)(Stage *s, GroundTruth *t)) {
  bool done = false;
  for (long n = 1; !done; n++) {
    failAllocator allocator = {.fail_at = 0};
    vlContextDef def = vl_default_context_def();
    def.threads = 2;
    def.allocator = fail_allocator(&allocator);
    Stage s = stage_open(16, 8);
    vlContext *usual = s.context;
    vl_scene_destroy(s.scene);
    assert_int_equal(vl_context_create(&def, &s.context), VL_OK);
    assert_int_equal(vl_scene_create(s.context, &s.scene), VL_OK);
    fill(&s);
    GroundTruth t = begin(&s);
    allocator.fail_at = atomic_load(&allocator.calls) + n;
    vlResult result = take(&s, &t);
    done = !atomic_load(&allocator.refused);
    assert_int_equal(result, done ? VL_OK : VL_ERROR_MEMORY);
    ground_truth_free(&t);
    vl_scene_destroy(s.scene);
    vl_context_destroy(s.context);
    assert_int_equal(atomic_load(&allocator.blocks), 0);
    vl_context_destroy(usual);
    assert_true(n < 1000);
  }
}

#endif
