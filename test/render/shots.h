/* test/render/shots.h: small images through the public API: a stage (context, scene, defs) that
 * a test fills; a call that builds, renders, develops, and destroys everything (all memory must
 * be freed); comparisons. */
#ifndef TEST_RENDER_SHOTS_H
#define TEST_RENDER_SHOTS_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"
#include "velo/filter_kinds.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/render.h"
#include "velo/shape_kinds.h"

#define UNUSED __attribute__((unused))

typedef struct Stage {
  vlContext *context;
  vlScene *scene;
  vlCameraDef camera;
  vlBuildDef build;
  vlFilmDef film;
  vlRenderDef render;
} Stage;

typedef struct Image {
  uint32_t width, height;
  float *rgba; /* 4 per pixel */
  vlRenderStats stats;
} Image;

/* Box filter, camera at the origin looking along -z, field of view of 90 degrees across the
 * smaller side. The stage takes the context; null: a new one with two threads. */
static UNUSED Stage stage_open_in(vlContext *context, uint32_t width, uint32_t height) {
  Stage s;
  memset(&s, 0, sizeof s);
  s.context = context;
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  if (!context)
    assert_int_equal(vl_context_create(&def, &s.context), VL_OK);
  assert_int_equal(vl_scene_create(s.context, &s.scene), VL_OK);
  s.camera = vl_default_camera_def(width, height);
  s.camera.eye[0] = s.camera.eye[1] = s.camera.eye[2] = 0;
  s.camera.lookat[0] = s.camera.lookat[1] = 0;
  s.camera.lookat[2] = -1;
  s.build = vl_default_build_def();
  s.film = vl_default_film_def(width, height);
  s.film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  s.render = vl_default_render_def();
  return s;
}
static UNUSED Stage stage_open(uint32_t width, uint32_t height) {
  return stage_open_in(NULL, width, height);
}

/* Builds and renders. Fails the test with the library's message on errors. */
static UNUSED Image stage_take(Stage *s) {
  vlError error;
  memset(&error, 0, sizeof error);
  vlWorld *world = NULL;
  if (vl_scene_result(s->scene, &error) != VL_OK)
    fail_msg("scene: %s", error.message);
  if (vl_world_build(s->scene, &s->build, &world, &error) != VL_OK)
    fail_msg("build: %s", error.message);
  vlCamera camera;
  if (vl_camera_make(&s->camera, &camera, NULL, &error) != VL_OK)
    fail_msg("camera: %s", error.message);
  vlFilm *film = NULL;
  assert_int_equal(vl_film_create(s->context, &s->film, &film), VL_OK);
  Image p;
  memset(&p, 0, sizeof p);
  if (vl_render(world, &camera, film, &s->render, &p.stats, &error) != VL_OK)
    fail_msg("render: %s", error.message);
  vlImage *image = NULL;
  vlDevelopDef develop = vl_default_develop_def();
  assert_int_equal(vl_film_develop(film, &develop, &image), VL_OK);
  p.width = vl_image_width(image);
  p.height = vl_image_height(image);
  p.rgba = malloc((size_t)p.width * p.height * 4 * sizeof(float));
  for (uint32_t y = 0; y < p.height; y++)
    for (uint32_t x = 0; x < p.width; x++)
      for (uint32_t c = 0; c < 4; c++)
        p.rgba[4 * ((size_t)y * p.width + x) + c] = vl_image_get(image, x, y, c);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  return p;
}

static UNUSED void stage_close(Stage *s) {
  vl_scene_destroy(s->scene);
  size_t held = vl_context_memory(s->context, NULL);
  assert_int_equal(held, 0);
  vl_context_destroy(s->context);
  memset(s, 0, sizeof *s);
}

static UNUSED Image stage_finish(Stage *s) {
  Image p = stage_take(s);
  stage_close(s);
  return p;
}

static UNUSED void image_free(Image *p) {
  free(p->rgba);
  memset(p, 0, sizeof *p);
}

/* Renders in that context and destroys it. */
typedef Image Rendering(vlContext *context, const void *what);

static UNUSED Image image_in(Rendering *render, const void *what, uint32_t threads, vlIsa isa) {
  vlContextDef def = vl_default_context_def();
  def.threads = threads;
  def.isa = isa;
  vlContext *context;
  if (vl_context_create(&def, &context) != VL_OK)
    return (Image){0}; /* the machine does not have that instruction set */
  return render(context, what);
}

/* Expects the same bits for 1, 1 + step, ... up to 3 threads on each instruction set. Returns
 * one of the images. */
static UNUSED Image assert_same_bits(Rendering *render, const void *what, uint32_t step) {
  Image a = image_in(render, what, 1, VL_ISA_BASE);
  assert_non_null(a.rgba);
  for (uint32_t threads = 1; threads <= 3; threads += step)
    for (int isa = VL_ISA_BASE; isa <= VL_ISA_V4; isa++) {
      if (isa == VL_ISA_V2)
        continue; /* BASE is V2 on x86-64 */
      Image b = image_in(render, what, threads, (vlIsa)isa);
      if (!b.rgba)
        continue;
      assert_memory_equal(a.rgba, b.rgba, (size_t)a.width * a.height * 4 * sizeof(float));
      image_free(&b);
    }
  return a;
}

static UNUSED float image_at(const Image *p, uint32_t x, uint32_t y, int c) {
  return p->rgba[4 * ((size_t)y * p->width + x) + (size_t)c];
}

/* Mean of one channel over the pixels [x0, x1) x [y0, y1). */
static UNUSED double image_region(const Image *p, uint32_t x0, uint32_t y0, uint32_t x1,
                                  uint32_t y1, int c) {
  double sum = 0;
  for (uint32_t y = y0; y < y1; y++)
    for (uint32_t x = x0; x < x1; x++)
      sum += image_at(p, x, y, c);
  return sum / ((double)(x1 - x0) * (y1 - y0));
}
static UNUSED double image_mean(const Image *p, int c) {
  return image_region(p, 0, 0, p->width, p->height, c);
}

/* Share of pixels whose green values differ by more than `tolerance` times the larger one (and
 * by more than 1e-4). */
static UNUSED double image_differing(const Image *a, const Image *b, double tolerance) {
  assert_int_equal(a->width, b->width);
  assert_int_equal(a->height, b->height);
  size_t n = (size_t)a->width * a->height, count = 0;
  for (size_t i = 0; i < n; i++) {
    double x = a->rgba[4 * i + 1], y = b->rgba[4 * i + 1];
    count += !(fabs(x - y) <= 1e-4 + tolerance * fmax(fabs(x), fabs(y)));
  }
  return (double)count / (double)n;
}

static UNUSED void assert_near(const char *what, double value, double expected,
                               double tolerance) {
  if (!(fabs(value - expected) <= tolerance))
    fail_msg("%s: %.7g, expected %.7g within %.2g", what, value, expected, tolerance);
}
static UNUSED void assert_ratio(const char *what, double value, double expected,
                                double tolerance) {
  assert_near(what, value, expected, tolerance * fabs(expected));
}

/* ---- things to put on the stage ---------------------------------------------------------- */

static UNUSED vlMaterialId add_diffuse(Stage *s, float r, float g, float b) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  def.reflectance =
      vl_spectrum_input(r == g && g == b ? vl_spectrum_constant(r) : vl_spectrum_rgb(r, g, b));
  return vl_scene_add_material(s->scene, &def);
}
static UNUSED vlMaterialId add_textured(Stage *s, vlTextureId texture) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  def.reflectance = (vlSpectrumInput){texture, vl_spectrum_constant(1)};
  return vl_scene_add_material(s->scene, &def);
}
static UNUSED vlEmissionId add_emission(Stage *s, float radiance, bool two_sided) {
  vlEmissionDef def = vl_default_emission_def();
  def.radiance = vl_spectrum_rgb(radiance, radiance, radiance);
  def.two_sided = two_sided;
  return vl_scene_add_emission(s->scene, &def);
}
static UNUSED void add_sky(Stage *s, float radiance) {
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  def.color = vl_spectrum_rgb(radiance, radiance, radiance);
  assert_int_not_equal(vl_scene_add_light(s->scene, &def).index, 0);
}
static UNUSED void add_point(Stage *s, float x, float y, float z, float intensity) {
  vlLightDef def = vl_default_light_def(VL_LIGHT_POINT);
  def.color = vl_spectrum_rgb(intensity, intensity, intensity);
  def.from[0] = x;
  def.from[1] = y;
  def.from[2] = z;
  assert_int_not_equal(vl_scene_add_light(s->scene, &def).index, 0);
}

/* A rectangle (bilinear order p00 p10 p01 p11) as two triangles or one patch; uv 0..1; normal
 * (p10-p00) x (p01-p00). */
typedef struct Quad {
  float p[12];
  vlMaterialId material;
  vlEmissionId emission;
  vlFloatInput alpha;
  bool patch, reverse, without_uv;
  const float *tangents; /* 12, or null */
  vlGroupId group;
} Quad;
static UNUSED Quad quad_at(float x, float y, float z, float ux, float uy, float uz, float vx,
                           float vy, float vz) {
  Quad q;
  memset(&q, 0, sizeof q);
  const float p[12] = {x - ux - vx, y - uy - vy, z - uz - vz, x + ux - vx,
                       y + uy - vy, z + uz - vz, x - ux + vx, y - uy + vy,
                       z - uz + vz, x + ux + vx, y + uy + vy, z + uz + vz};
  memcpy(q.p, p, sizeof p);
  q.alpha = vl_float_input(1);
  return q;
}
static UNUSED vlShapeId add_quad(Stage *s, const Quad *q) {
  static const float uv[8] = {0, 0, 1, 0, 0, 1, 1, 1};
  static const uint32_t triangles[6] = {0, 1, 3, 0, 3, 2}, patch[4] = {0, 1, 2, 3};
  vlShapeDef def = vl_default_shape_def(q->patch ? VL_SHAPE_BILINEAR : VL_SHAPE_TRIANGLES);
  def.vertices = 4;
  def.faces = q->patch ? 1 : 2;
  def.positions = q->p;
  def.uvs = q->without_uv ? NULL : uv;
  def.tangents = q->tangents;
  def.indices = q->patch ? patch : triangles;
  def.material = q->material;
  def.emission = q->emission;
  def.alpha = q->alpha;
  def.reverse_orientation = q->reverse;
  def.group = q->group;
  vlShapeId id = vl_scene_add_shape(s->scene, &def);
  assert_int_not_equal(id.index, 0);
  return id;
}

/* A sphere of triangles: n rings, 2n segments; the sphere's uvs; vertex normals if wanted. */
static UNUSED vlShapeDef mesh_sphere(int n, float radius, bool normals, float **block) {
  size_t vertices = (size_t)(n + 1) * (2 * (size_t)n + 1), faces = 4 * (size_t)n * (size_t)n;
  float *p = malloc(vertices * 8 * sizeof(float) + faces * 3 * sizeof(uint32_t));
  float *nn = p + 3 * vertices, *uv = nn + 3 * vertices;
  uint32_t *index = (uint32_t *)(void *)(uv + 2 * vertices);
  size_t v = 0, t = 0;
  for (int i = 0; i <= n; i++)
    for (int j = 0; j <= 2 * n; j++, v++) {
      double theta = M_PI * i / n, phi = M_PI * (j % (2 * n)) / n;
      double d[3] = {i == 0 || i == n ? 0 : sin(theta) * cos(phi),
                     i == 0 || i == n ? 0 : sin(theta) * sin(phi), cos(theta)};
      for (int k = 0; k < 3; k++) {
        nn[3 * v + (size_t)k] = (float)d[k];
        p[3 * v + (size_t)k] = radius * (float)d[k];
      }
      uv[2 * v] = (float)j / (float)(2 * n);
      uv[2 * v + 1] = 1 - (float)i / (float)n;
    }
  for (uint32_t i = 0; i < (uint32_t)n; i++)
    for (uint32_t j = 0; j < 2 * (uint32_t)n; j++) {
      uint32_t a = i * (2 * (uint32_t)n + 1) + j, c = a + 2 * (uint32_t)n + 1;
      uint32_t f[6] = {a, c, a + 1, a + 1, c, c + 1};
      memcpy(index + t, f, sizeof f);
      t += 6;
    }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = (uint32_t)vertices;
  def.faces = (uint32_t)faces;
  def.positions = p;
  def.normals = normals ? nn : NULL;
  def.uvs = uv;
  def.indices = index;
  *block = p;
  return def;
}

/* A float RGB image as a texture or sky: values by rows from the top. */
static UNUSED vlImage *make_image(Stage *s, uint32_t width, uint32_t height, const float *rgb) {
  vlImageDef def = vl_default_image_def(width, height, 3);
  def.type = VL_PIXEL_F32;
  vlImage *image = NULL;
  assert_int_equal(vl_image_create(s->context, &def, &image), VL_OK);
  memcpy(vl_image_pixels(image), rgb, (size_t)width * height * 3 * sizeof(float));
  return image;
}

/* Row-major affine maps. */
static UNUSED void set_matrix(double m[16], double a, double b, double c, double x, double d,
                              double e, double f, double y, double g, double h, double i,
                              double z) {
  const double r[16] = {a, b, c, x, d, e, f, y, g, h, i, z, 0, 0, 0, 1};
  memcpy(m, r, sizeof r);
}

#endif
