/* test/render/test_footprints.c: surface derivatives, seen in images: bump maps against normals
 * of surfaces displaced by a formula; image textures at grazing angles: detail finer than a
 * pixel becomes grey, coarser detail keeps its contrast. */
#include "render/shots.h"
#include "velo/channels.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "velo/tracer.h"

/* ---- bump maps --------------------------------------------------------------------------- */

enum { SIZE = 80 };

/* Height over (u, v), as the bilinear texture has it. */
static const double heights[4] = {0.5, 1.5, 0.8, 1.9}; /* at (0, 0), (0, 1), (1, 0), (1, 1) */
static double height(double u, double v) {
  return (1 - u) * (1 - v) * heights[0] + (1 - u) * v * heights[1] + u * (1 - v) * heights[2] +
         u * v * heights[3];
}

typedef void Base(double u, double v, double p[3]);

static void on_sphere(double u, double v, double p[3]) {
  double theta = M_PI * (1 - v), phi = 2 * M_PI * u;
  p[0] = sin(theta) * cos(phi);
  p[1] = sin(theta) * sin(phi);
  p[2] = cos(theta);
}
/* of a sphere: z from -0.5 to 0.8, three quarters round */
static void on_part(double u, double v, double p[3]) {
  double low = acos(-0.5), high = acos(0.8), theta = low + v * (high - low),
         phi = 1.5 * M_PI * u;
  p[0] = sin(theta) * cos(phi);
  p[1] = sin(theta) * sin(phi);
  p[2] = cos(theta);
}
static void on_cylinder(double u, double v, double p[3]) {
  p[0] = cos(2 * M_PI * u);
  p[1] = sin(2 * M_PI * u);
  p[2] = -1 + 2 * v;
}
static void on_disk(double u, double v, double p[3]) {
  double r = 1 - 0.8 * v;
  p[0] = r * cos(2 * M_PI * u);
  p[1] = r * sin(2 * M_PI * u);
  p[2] = 0;
}
static const float patch_corners[12] = {-1, -1, 0.4f, 1, -1, -0.5f, -1, 1, -0.4f, 1, 1, 0.6f};
/* u = b, v = 1 - a of the patch's own a, b */
static const float patch_uvs[8] = {0, 1, 0, 0, 1, 1, 1, 0};
static void on_patch(double u, double v, double p[3]) {
  double a = 1 - v, b = u;
  for (int i = 0; i < 3; i++)
    p[i] = (1 - a) * ((1 - b) * (double)patch_corners[i] + b * (double)patch_corners[6 + i]) +
           a * ((1 - b) * (double)patch_corners[3 + i] + b * (double)patch_corners[9 + i]);
}

static void slopes(Base *base, double u, double v, const double side[3], bool displaced,
                   double n[3]);
/* The point displaced by the height along the normal on the given side. */
static void put_off(Base *base, double u, double v, const double side[3], bool displaced,
                    double p[3]) {
  double n[3];
  base(u, v, p);
  if (!displaced)
    return;
  slopes(base, u, v, side, false, n);
  for (int i = 0; i < 3; i++)
    p[i] += height(u, v) * n[i];
}
static void slopes(Base *base, double u, double v, const double side[3], bool displaced,
                   double n[3]) {
  const double e = 1e-4;
  double a[3], b[3], c[3], d[3];
  put_off(base, u - e, v, side, displaced, a);
  put_off(base, u + e, v, side, displaced, b);
  put_off(base, u, v - e, side, displaced, c);
  put_off(base, u, v + e, side, displaced, d);
  for (int i = 0; i < 3; i++) {
    a[i] = b[i] - a[i];
    c[i] = d[i] - c[i];
  }
  n[0] = a[1] * c[2] - a[2] * c[1];
  n[1] = a[2] * c[0] - a[0] * c[2];
  n[2] = a[0] * c[1] - a[1] * c[0];
  double l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  double facing = n[0] * side[0] + n[1] * side[1] + n[2] * side[2] < 0 ? -1 : 1;
  for (int i = 0; i < 3; i++)
    n[i] *= facing / l;
}

typedef struct Case {
  const char *name;
  vlShapeKind kind;
  Base *base;
  double tolerance;
  bool instance;
} Case;

static void bumps_are_displacements(void **state) {
  (void)state;
  static const Case cases[] = {
      {"sphere", VL_SHAPE_SPHERE, on_sphere, 2e-3, false},
      {"part of a sphere", VL_SHAPE_SPHERE, on_part, 2e-3, false},
      {"sphere of triangles", VL_SHAPE_TRIANGLES, on_sphere, 2e-2, false},
      {"the same, an instance", VL_SHAPE_TRIANGLES, on_sphere, 2e-2, true},
      {"cylinder", VL_SHAPE_CYLINDER, on_cylinder, 2e-3, false},
      {"cylinder, an instance", VL_SHAPE_CYLINDER, on_cylinder, 2e-3, true},
      {"disk", VL_SHAPE_DISK, on_disk, 2e-3, false},
      {"patch", VL_SHAPE_BILINEAR, on_patch, 2e-3, false}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const Case *q = &cases[k];
    Stage s = stage_open(SIZE, SIZE);
    vlTextureDef bilerp = vl_default_texture_def(VL_TEXTURE_BILERP, false);
    vlFloatInput *inputs[4] = {&bilerp.float_a, &bilerp.float_b, &bilerp.float_c,
                               &bilerp.float_d};
    for (int i = 0; i < 4; i++)
      *inputs[i] = vl_float_input((float)heights[i]);
    vlMaterialDef material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    material.displacement.texture = vl_scene_add_texture(s.scene, &bilerp);
    float *block = NULL;
    vlShapeDef shape = vl_default_shape_def(q->kind);
    if (q->kind == VL_SHAPE_TRIANGLES)
      shape = mesh_sphere(96, 1, true, &block);
    if (q->base == on_part) {
      shape.z_min = -0.5f;
      shape.z_max = 0.8f;
      shape.phi_max = (float)(1.5 * M_PI);
    }
    if (q->kind == VL_SHAPE_DISK)
      shape.inner_radius = 0.2f;
    static const uint32_t corners[4] = {0, 1, 2, 3};
    if (q->kind == VL_SHAPE_BILINEAR) {
      shape.vertices = 4;
      shape.faces = 1;
      shape.positions = patch_corners;
      shape.uvs = patch_uvs;
      shape.indices = corners;
    }
    shape.material = vl_scene_add_material(s.scene, &material);
    if (q->instance)
      shape.group = vl_scene_add_group(s.scene, "it");
    vl_scene_add_shape(s.scene, &shape);
    free(block);
    double unit[16];
    set_matrix(unit, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
    if (q->instance)
      vl_scene_add_instance(s.scene, shape.group, unit, (vlSource){0});
    s.camera.eye[0] = 1.7;
    s.camera.eye[1] = -1.2;
    s.camera.eye[2] = 2.1;
    s.camera.lookat[2] = 0;
    vlError error = {0};
    vlWorld *world;
    vlCamera camera;
    vlImage *image = NULL;
    if (vl_world_build(s.scene, &s.build, &world, &error) != VL_OK)
      fail_msg("%s", error.message);
    assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
    vlChannelsDef def = vl_default_channels_def(SIZE, SIZE);
    def.channels = VL_CHANNEL_N | VL_CHANNEL_NG | VL_CHANNEL_UV;
    assert_int_equal(vl_render_channels(world, &camera, &def, &image, NULL, &error), VL_OK);
    static const char *const names[8] = {"N.X",  "N.Y",  "N.Z",  "Ng.X",
                                         "Ng.Y", "Ng.Z", "uv.U", "uv.V"};
    int seen = 0;
    for (uint32_t y = 0; y < SIZE; y++)
      for (uint32_t x = 0; x < SIZE; x++) {
        double v[8], n[3], error2 = 0;
        for (int i = 0; i < 8; i++) {
          int channel = vl_image_find_channel(image, names[i]);
          if (channel < 0)
            fail_msg("no channel %s", names[i]);
          v[i] = vl_image_get(image, x, y, (uint32_t)channel);
        }
        if (v[3] == 0 && v[4] == 0 && v[5] == 0)
          continue;
        /* not at the seam or the poles, where differences of formulas and triangles are poor */
        if (v[6] < 0.02 || v[6] > 0.98 || v[7] < 0.1 || v[7] > 0.9)
          continue;
        slopes(q->base, v[6], v[7], v + 3, true, n);
        for (int i = 0; i < 3; i++)
          error2 += (n[i] - v[i]) * (n[i] - v[i]);
        if (!(sqrt(error2) < q->tolerance))
          fail_msg(
              "%s: pixel (%u, %u), uv %.3f %.3f: normal (%.4f %.4f %.4f), expected (%.4f %.4f "
              "%.4f)",
              q->name, x, y, v[6], v[7], v[0], v[1], v[2], n[0], n[1], n[2]);
        seen++;
      }
    assert_true(seen > 100);
    vl_image_destroy(image);
    vl_world_destroy(world);
    stage_close(&s);
  }
}

/* ---- images under grazing rays ----------------------------------------------------------- */

enum { TEXELS = 256, VIEW = 32 };

/* Stripes of two texels, along u or along v, on a quad that is seen at 1:12, so that a pixel is
 * 8 texels wide and, v being repeated 12 times, 96 long. */
static Image stripes(bool along_v, vlTextureFilter filter, vlMapping mapping, bool patch,
                     bool tangents, uint32_t spp) {
  /* For normal maps; of any length. */
  static const float along_u[12] = {1e-3f, 0, 0, 1e-3f, 0, 0, 1e-3f, 0, 0, 1e-3f, 0, 0};
  Stage s = stage_open(VIEW, VIEW);
  s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
  s.build.color = VL_COLOR_RGB;
  s.render.tracer = VL_TRACER_RAYCAST;
  s.render.spp = spp;
  float *texels = malloc(TEXELS * TEXELS * 3 * sizeof *texels);
  for (int y = 0; y < TEXELS; y++)
    for (int x = 0; x < TEXELS; x++)
      /* across the slope: stripes as wide as four pixels; along it: as two texels */
      for (int c = 0; c < 3; c++)
        texels[3 * (y * TEXELS + x) + c] = (along_v ? y / 2 : x / 32) & 1 ? 0.8f : 0.2f;
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  vlImage *image = make_image(&s, TEXELS, TEXELS, texels);
  def.image = image;
  free(texels);
  def.filter = filter;
  def.mapping = mapping;
  def.sv = 12;
  /* the same over the quad: s = (x + 1)/2, t = (y + 1) * 6 */
  if (mapping == VL_MAPPING_PLANAR) {
    def.planar_v1[0] = 0.5f;
    def.planar_v1[1] = def.planar_v1[2] = 0;
    def.du = 0.5f;
    def.planar_v2[1] = 6;
    def.planar_v2[0] = def.planar_v2[2] = 0;
    def.dv = 6;
  }
  vlTextureId id = vl_scene_add_texture(s.scene, &def);
  vl_image_destroy(image);
  Quad q = quad_at(0, 0, -40, 1, 0, 0, 0, 1, -12);
  q.material = add_textured(&s, id);
  q.patch = patch;
  q.tangents = tangents ? along_u : NULL;
  add_quad(&s, &q);
  return stage_finish(&s);
}

static void fine_stripes_are_grey_and_wide_ones_sharp(void **state) {
  (void)state;
  const double cosine = 1 / sqrt(145); /* which the raycast tracer shows, too */
  for (int i = 0; i < 9; i++) {
    vlTextureFilter filter = i % 3 == 2 ? VL_FILTER_BILINEAR : VL_FILTER_TRILINEAR;
    vlMapping mapping = i % 3 == 1 ? VL_MAPPING_PLANAR : VL_MAPPING_UV;
    bool patch = i / 3 == 1, tangents = i / 3 == 2;
    char what[64];
    snprintf(what, sizeof what, "case %d", i);
    Image fine = stripes(true, filter, mapping, patch, tangents, 1);
    Image wide = stripes(false, filter, mapping, patch, tangents, 64);
    double sum = 0, square = 0;
    for (uint32_t y = 2; y < VIEW - 2; y++)
      for (uint32_t x = 2; x < VIEW - 2; x++) {
        double f = image_at(&fine, x, y, 1) / cosine, w = image_at(&wide, x, y, 1) / cosine;
        sum += f;
        square += f * f;
        double expected = (x / 4) & 1 ? 0.8 : 0.2, off = fabs(w - expected);
        /* the footprint reaches over: by no more than a quarter of a pixel */
        bool edge = x % 4 == 0 || x % 4 == 3;
        if (!(off < (edge ? 0.6 * 0.15 : 1e-3)))
          fail_msg("%s: pixel (%u, %u) of the wide stripes is %.4f, expected %.1f", what, x, y,
                   w, expected);
      }
    double n = (VIEW - 4.0) * (VIEW - 4.0), mean = sum / n,
           deviation = sqrt(fmax(0, square / n - mean * mean));
    assert_near(what, mean, 0.5, 0.02);
    if (!(deviation < 0.08))
      fail_msg("%s: fine stripes vary by %.4f at one sample; 0.3 is unfiltered", what,
               deviation);
    image_free(&fine);
    image_free(&wide);
  }
}

/* ---- curved mirrors ---------------------------------------------------------------------- */

/* The side of a mirror ball, from above, shows a wall with stripes. A cone of rays that meets
 * it at a slant spreads less across the plane of incidence than in it (Coddington's equations:
 * by 2 k cos and by 2 k / cos, k the curvature): stripes along that plane, 5 times as wide as a
 * pixel's image across it, are still seen. */
static void a_ball_mirrors_stripes(void **state) {
  (void)state;
  const uint32_t stripe = 10; /* texels */
  Stage s = stage_open(VIEW, VIEW);
  s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC; /* sees 2 x 2 */
  s.build.color = VL_COLOR_RGB;
  s.render.spp = 1;
  vlMaterialDef mirror = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.radius = 50;
  ball.z_min = -50;
  ball.z_max = 50;
  ball.material = vl_scene_add_material(s.scene, &mirror);
  /* the ray in the middle meets it at a cosine of 0.312, and then the wall after 850 */
  ball.group_from_shape[3] = -47.5;
  ball.group_from_shape[11] = -100;
  assert_int_not_equal(vl_scene_add_shape(s.scene, &ball).index, 0);
  float *texels = malloc(TEXELS * TEXELS * 3 * sizeof *texels);
  for (uint32_t i = 0; i < TEXELS * TEXELS * 3; i++)
    texels[i] = i / 3 / TEXELS / stripe & 1 ? 0.8f : 0.2f;
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  vlImage *image = make_image(&s, TEXELS, TEXELS, texels);
  free(texels);
  def.image = image;
  def.filter = VL_FILTER_TRILINEAR;
  def.su = 50; /* across the stripes the image is as wide as they are long */
  vlTextureId id = vl_scene_add_texture(s.scene, &def);
  vl_image_destroy(image);
  Quad wall = quad_at(504, 0, -850, 0, 0, 500, 0, 50, 0);
  wall.material = add_textured(&s, id);
  add_quad(&s, &wall);
  vlLightDef sun = vl_default_light_def(VL_LIGHT_DISTANT);
  sun.from[0] = -1;
  sun.from[1] = sun.from[2] = sun.to[0] = sun.to[1] = sun.to[2] = 0;
  assert_int_not_equal(vl_scene_add_light(s.scene, &sun).index, 0);
  Image p = stage_finish(&s);
  double sum = 0, square = 0;
  for (uint32_t y = 0; y < VIEW; y++)
    for (uint32_t x = 0; x < VIEW; x++) {
      const double value = image_at(&p, x, y, 1);
      sum += value;
      square += value * value;
    }
  const double n = VIEW * VIEW, mean = sum / n;
  const double deviation = sqrt(square / n - mean * mean) / mean;
  image_free(&p);
  if (!(deviation > 0.5))
    fail_msg("stripes vary by %.3f of their mean; 0.6 is unfiltered", deviation);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bumps_are_displacements),
      cmocka_unit_test(fine_stripes_are_grey_and_wide_ones_sharp),
      cmocka_unit_test(a_ball_mirrors_stripes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
