/* test/trace/test_texture_node.c: textures at one point: the single query gives the batch
 * evaluator's bits for every kind of float texture (on the lowest instruction set; test_bits.c
 * compares the sets); alpha, lights and mixed materials use the point's normal, uv set and
 * vertex colours. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "statistics.h"
#include "unit.h"

#include "texture/run.hot.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

enum { KINDS = VL_TEXTURE_VERTEX_COLOR + 1 };

typedef struct Fixture {
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlTraceScratch *scratch;
} Fixture;

static Fixture begin(void) {
  Fixture f;
  assert_int_equal(vl_context_create(NULL, &f.context), VL_OK);
  assert_int_equal(vl_scene_create(f.context, &f.scene), VL_OK);
  f.scratch = aligned_alloc(64, sizeof *f.scratch);
  memset(f.scratch, 0, sizeof *f.scratch);
  return f;
}

static void build(Fixture *f) {
  vlBuildDef def = vl_default_build_def();
  def.color = VL_COLOR_RGB;
  vlError error;
  if (vl_world_build(f->scene, &def, &f->world, &error) != VL_OK)
    fail_msg("%s", error.message);
}

static void end(Fixture *f) {
  vl_world_destroy(f->world);
  vl_scene_destroy(f->scene);
  assert_int_equal(vl_context_memory(f->context, NULL), 0);
  vl_context_destroy(f->context);
  free(f->scratch);
}

/* The triangle (0,0,0) (1,0,0) (0,1,0): positions are weights without rounding. */
static vlShapeDef triangle(void) {
  static const float p[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  static const uint32_t indices[3] = {0, 1, 2};
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = 3;
  def.faces = 1;
  def.positions = p;
  def.indices = indices;
  return def;
}

/* ---- both evaluators --------------------------------------------------------------------- */

/* least 1: white. */
static vlImage *image_of(Fixture *f, statRng *rng, float min) {
  vlImageDef def = vl_default_image_def(8, 4, 3);
  def.type = VL_PIXEL_F32;
  vlImage *image;
  assert_int_equal(vl_image_create(f->context, &def, &image), VL_OK);
  float *pixels = vl_image_pixels(image);
  for (int i = 0; i < 8 * 4 * 3; i++)
    pixels[i] = min + (1 - min) * stat_float(rng);
  return image;
}

/* A shape for each kind of float texture, as its alpha; inputs are textures themselves. */
static void add_kinds(Fixture *f, statRng *rng) {
  static float colors[12], uvs[6];
  for (int i = 0; i < 12; i++)
    colors[i] = stat_float(rng);
  for (int i = 0; i < 6; i++)
    uvs[i] = stat_float(rng);
  vlTextureDef noise = vl_default_texture_def(VL_TEXTURE_FBM, false);
  vlTextureId input = vl_scene_add_texture(f->scene, &noise);
  vlImage *image = image_of(f, rng, 0);
  for (int kind = 0; kind < KINDS; kind++) {
    if (kind == VL_TEXTURE_MARBLE)
      continue; /* a colour */
    vlTextureDef def = vl_default_texture_def((vlTextureKind)kind, false);
    def.float_a.texture = def.float_d.texture = def.amount.texture = input;
    def.float_b.value = 0.3f;
    def.float_c.value = 0.6f;
    if (kind == VL_TEXTURE_CONSTANT)
      def.float_a = vl_float_input(0.7f);
    if (kind == VL_TEXTURE_IMAGE)
      def.image = image;
    def.su = 7;
    def.sv = 5;
    def.du = 0.3f;
    def.uv_set = kind == VL_TEXTURE_IMAGE ? 1 : 0;
    def.channel = kind == VL_TEXTURE_VERTEX_COLOR ? 2 : -1;
    for (int i = 0; i < 3; i++)
      def.direction[i] = 0.57735f;
    vlShapeDef shape = triangle();
    shape.colors = colors;
    shape.more_uvs[0] = uvs;
    shape.alpha.texture = vl_scene_add_texture(f->scene, &def);
    vl_scene_add_shape(f->scene, &shape);
  }
  vl_image_destroy(image);
}

static vlTextureRun fill_lanes(Fixture *f, uint32_t shape, statRng *rng,
                               vlTextureQuery *queries, vlTextureCorner *corners) {
  vlTraceScratch *s = f->scratch;
  vlSurface *at = &s->at.surface;
  for (uint32_t i = 0; i < VL_BATCH; i++) {
    float x = stat_float(rng), y = (1 - x) * stat_float(rng);
    vlVec3 n =
        vl_vec3(2 * stat_float(rng) - 1, 2 * stat_float(rng) - 1, 2 * stat_float(rng) - 1);
    corners[i] = (vlTextureCorner){&f->world->shapes.items[shape], 0, {1 - x - y, x, y}};
    queries[i] = (vlTextureQuery){3 * x, y, vl_vec3(x, y, 0), n, &corners[i]};
    vlVec3 unit = vl_normalize(n);
    at->u[i] = 3 * x;
    at->v[i] = y;
    at->p.x[i] = x;
    at->p.y[i] = y;
    at->p.z[i] = 0;
    at->g.x[i] = unit.x;
    at->g.y[i] = unit.y;
    at->g.z[i] = unit.z;
    s->at.paths.d.z[i] = -1;
    s->at.hits.shape[i] = shape;
    s->at.hits.prim[i] = 0;
    for (int k = 0; k < 9; k++)
      s->corners.p[k][i] = k == 3 || k == 7 ? 1.0f : 0.0f;
  }
  return (vlTextureRun){.world = f->world, .at = &s->at, .s = s};
}

static void same_bits(void **state) {
  (void)state;
  statRng rng = stat_rng(11);
  Fixture f = begin();
  add_kinds(&f, &rng);
  build(&f);
  static vlTextureQuery queries[VL_BATCH];
  static vlTextureCorner corners[VL_BATCH];
  static float out[VL_ROW_SIZE];
  assert_int_equal(f.world->shapes.count, KINDS - 1);
  for (uint32_t k = 0; k < f.world->shapes.count; k++) {
    int32_t node = f.world->shapes.items[k].alpha;
    assert_true(node >= 0);
    vlTextureRun run = fill_lanes(&f, k, &rng, queries, corners);
    for (run.last = 0; run.last < VL_BATCH;) {
      run.first = run.last;
      run.last =
          run.first + VL_MATERIAL_LANES < VL_BATCH ? run.first + VL_MATERIAL_LANES : VL_BATCH;
      vl_texture_float(&run, node, out);
      assert_int_equal(run.top, 0);
    }
    float min = INFINITY, max = -INFINITY;
    for (uint32_t i = 0; i < VL_BATCH; i++) {
      float one = vl_texture_float_at(f.world, node, &queries[i]);
      if (memcmp(&one, &out[i], sizeof one))
        fail_msg("node kind %d: %.9g alone, %.9g in a batch",
                 (int)f.world->nodes.items[node].kind, (double)one, (double)out[i]);
      min = fminf(min, one);
      max = fmaxf(max, one);
    }
    bool constant = f.world->nodes.items[node].kind == VL_TEXTURE_CONSTANT;
    assert_true(constant ? max == min : max > min);
  }
  end(&f);
}

/* ---- who asks for single points ---------------------------------------------------------- */

/* Number of shapes hit: 0 or 1. */
static int hits(const Fixture *f, float ox, float oy, float oz, float dx, float dy, float dz) {
  vlRays ray = {&ox, &oy, &oz, &dx, &dy, &dz, NULL, NULL, NULL, NULL};
  uint32_t shape, prim, instance;
  float t;
  vl_accel_closest(f->world, 1, &ray, false, &shape, &prim, &instance, &t);
  return shape != VL_NONE;
}

static vlFloatInput direction_mix(Fixture *f, int axis, float a, float b) {
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_DIRECTION_MIX, false);
  def.float_a.value = a;
  def.float_b.value = b;
  for (int i = 0; i < 3; i++)
    def.direction[i] = i == axis;
  vlFloatInput input = {.texture = vl_scene_add_texture(f->scene, &def)};
  return input;
}

static void alpha_by_direction(void **state) {
  (void)state;
  /* A triangle across z: the first input along its normal, the second across it. */
  for (int axis = 0; axis < 3; axis++)
    for (int second = 0; second < 2; second++) {
      Fixture f = begin();
      vlShapeDef def = triangle();
      def.alpha = direction_mix(&f, axis, second ? 0 : 1, second ? 1 : 0);
      vl_scene_add_shape(f.scene, &def);
      build(&f);
      int opaque = (axis == 2) != second;
      assert_int_equal(hits(&f, 0.2f, 0.3f, 5, 0, 0, -1), opaque);
      assert_int_equal(hits(&f, 0.2f, 0.3f, -5, 0, 0, 1), opaque);
      end(&f);
    }
  /* A sphere: its poles along x are there, the others are open on both sides. */
  Fixture f = begin();
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.alpha = direction_mix(&f, 0, 1, 0);
  vl_scene_add_shape(f.scene, &def);
  build(&f);
  assert_int_equal(hits(&f, 5, 0, 0, -1, 0, 0), 1);
  assert_int_equal(hits(&f, 0, 5, 0, 0, -1, 0), 0);
  assert_int_equal(hits(&f, 0, 0, 5, 0, 0, -1), 0);
  end(&f);
}

/* Radiance that light samples of the only light find, at (0.2, 0.2, 1) under it. */
static void assert_light(Fixture *f, float expected) {
  vlTraceScratch *s = f->scratch;
  statRng rng = stat_rng(5);
  vlNumbers u;
  for (uint32_t i = 0; i < VL_BATCH; i++) {
    s->at.surface.p.x[i] = s->at.surface.p.y[i] = 0.2f;
    s->at.surface.p.z[i] = 1;
    s->at.surface.n.x[i] = s->at.surface.n.y[i] = 0;
    s->at.surface.n.z[i] = -1;
    u.u0[i] = stat_float(&rng);
    u.u1[i] = stat_float(&rng);
    u.u2[i] = stat_float(&rng);
  }
  vl_stage_lights(f->world, VL_BATCH, &s->at.paths, &s->at.surface, u.u0, u.u1, u.u2,
                  &s->light);
  for (uint32_t i = 0; i < VL_BATCH; i++) {
    assert_true(s->light.pdf[i] > 0);
    float radiance = s->light.radiance[0][i] * s->light.pdf[i];
    if (!(fabsf(radiance - expected) <= 1e-5f))
      fail_msg("%g, not %g", (double)radiance, (double)expected);
  }
}

static void lights_with_alpha(void **state) {
  (void)state;
  static const float colors[12] = {.25f, 1, 1, 1, .25f, 1, 1, 1, .25f, 1, 1, 1};
  static const float uvs[6] = {.25f, 0, .25f, 0, .25f, 0},
                     other_uvs[6] = {.75f, 0, .75f, 0, .75f, 0};
  Fixture f = begin(); /* by the red of its vertices */
  vlEmissionDef emission = vl_default_emission_def();
  emission.radiance = vl_spectrum_rgb(1, 1, 1);
  vlShapeDef def = triangle();
  def.emission = vl_scene_add_emission(f.scene, &emission);
  def.colors = colors;
  vlTextureDef red = vl_default_texture_def(VL_TEXTURE_VERTEX_COLOR, false);
  red.channel = 0;
  def.alpha.texture = vl_scene_add_texture(f.scene, &red);
  vl_scene_add_shape(f.scene, &def);
  build(&f);
  float full =
      f.world->emitted.items[0].spectrum.rgb[0] * f.world->emitted.items[0].spectrum.scale;
  assert_true(full > 0.5f);
  assert_light(&f, 0.25f * full);
  end(&f);
  f = begin(); /* by the first uv set, where the emission is an image on the second */
  statRng rng = stat_rng(1);
  vlImage *image = image_of(&f, &rng, 1);
  vlTextureDef map = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  map.image = image;
  map.uv_set = 1;
  emission.texture = vl_scene_add_texture(f.scene, &map);
  vlTextureDef u = vl_default_texture_def(VL_TEXTURE_BILERP, false);
  u.float_a.value = u.float_b.value = 0;
  u.float_c.value = u.float_d.value = 1;
  def = triangle();
  def.uvs = uvs;
  def.more_uvs[0] = other_uvs;
  def.emission = vl_scene_add_emission(f.scene, &emission);
  def.alpha.texture = vl_scene_add_texture(f.scene, &u);
  vl_scene_add_shape(f.scene, &def);
  vl_image_destroy(image);
  build(&f);
  float white[4], lambda[4] = {0};
  vl_emitted_at(f.world, &f.world->emitted.items[0], lambda, 0.5f, 0.5f, false, white);
  assert_true(white[0] > 0.5f);
  assert_light(&f, 0.25f * white[0]);
  end(&f);
}

/* Vertices' colours are the amount: one of the two materials everywhere. */
static void mix_by_vertex_color(void **state) {
  (void)state;
  for (int second = 0; second < 2; second++) {
    Fixture f = begin();
    float colors[12];
    for (int i = 0; i < 12; i++)
      colors[i] = (float)second;
    vlMaterialDef part = vl_default_material_def(VL_MATERIAL_DIFFUSE),
                  mix = vl_default_material_def(VL_MATERIAL_MIX);
    mix.materials[0] = vl_scene_add_material(f.scene, &part);
    part = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
    mix.materials[1] = vl_scene_add_material(f.scene, &part);
    vlTextureDef red = vl_default_texture_def(VL_TEXTURE_VERTEX_COLOR, false);
    red.channel = 0;
    mix.amount.texture = vl_scene_add_texture(f.scene, &red);
    vlShapeDef def = triangle();
    def.colors = colors;
    def.material = vl_scene_add_material(f.scene, &mix);
    vl_scene_add_shape(f.scene, &def);
    build(&f);
    vlTraceScratch *s = f.scratch;
    s->rays.o.x[0] = 0.2f;
    s->rays.o.y[0] = 0.3f;
    s->rays.o.z[0] = 5;
    s->rays.d.z[0] = -1;
    s->hits.shape[0] = s->hits.prim[0] = 0;
    s->hits.instance[0] = VL_NONE;
    uint32_t m = vl_hit_material(f.world, &s->rays, &s->hits, 0);
    assert_int_equal(f.world->materials.items[m].kind,
                     second ? VL_MATERIAL_CONDUCTOR : VL_MATERIAL_DIFFUSE);
    end(&f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(same_bits), cmocka_unit_test(alpha_by_direction),
      cmocka_unit_test(lights_with_alpha), cmocka_unit_test(mix_by_vertex_color)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
