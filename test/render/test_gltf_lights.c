/* test_gltf_lights.c: glTF's lights on a white wall against values computed by hand (candela,
 * lux, cones), surfaces with an emissive image against the same emission without one, vertex
 * colours and coverage, uv sets of images. */
#include "render/gltf_shots.h"
#include "velo/load.h"

#define MATT "\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}"
#define PAPER                                                                           \
  "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1],\"metallicFactor\":0," \
  "\"roughnessFactor\":1}," MATT

/* The wall is the plane z = 0 and the camera is at z = 10. Computes the point that pixel (x, y)
 * shows. */
static void pixel_point(uint32_t x, uint32_t y, double p[2]) {
  p[0] = (x + 0.5) / 16 - 1;
  p[1] = 1 - (y + 0.5) / 16;
}

static Image lamp_image(const char *node, const char *light) {
  Gltf *g = calloc(1, sizeof *g);
  put_box(g, 0);
  char rest[2000];
  snprintf(rest, sizeof rest,
           "\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2]}],\"nodes\":[{\"mesh\":0},"
           "{\"camera\":0,\"translation\":[0,0,10]},"
           "{%s,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],"
           "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{%s}]}}," SHOT_CAMERA
           ",\"materials\":[{" PAPER
           "}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,"
           "\"material\":0}]}]",
           node, light);
  Shot shot = {.room = VL_ENVIRONMENT_NONE, .spp = 16};
  Image p = shoot(g, rest, &shot);
  free(g);
  return p;
}

/* ---- lamps ------------------------------------------------------------------------------- */

static void point_and_spot(void **state) {
  (void)state;
  /* the spot points 0.3 radians away from straight down, towards +x: its -z is rotated about
   * y */
  Image point = lamp_image("\"translation\":[0.3,-0.2,2],\"scale\":[3,3,3]",
                           "\"type\":\"point\",\"intensity\":4,\"color\":[1,0.5,0.25]");
  Image spot = lamp_image("\"translation\":[0,0,2],\"rotation\":[0,-0.149438,0,0.988771]",
                          "\"type\":\"spot\",\"intensity\":4,\"spot\":{\"innerConeAngle\":0.2,"
                          "\"outerConeAngle\":0.45}");
  int dark = 0, full = 0;
  for (uint32_t y = 0; y < 32; y++)
    for (uint32_t x = 0; x < 32; x++) {
      double at[2], color[3] = {1, 0.5, 0.25};
      pixel_point(x, y, at);
      double dx = at[0] - 0.3, dy = at[1] + 0.2, r2 = dx * dx + dy * dy + 4,
             e = 4 * 2 / (r2 * sqrt(r2));
      for (int c = 0; c < 3; c++)
        assert_ratio("point", image_at(&point, x, y, c), 0.5 / M_PI * color[c] * e, 0.005);
      r2 = at[0] * at[0] + at[1] * at[1] + 4;
      /* cosine to the spot's axis */
      double r = sqrt(r2), axis = (at[0] * sin(0.3) + 2 * cos(0.3)) / r;
      double t = (axis - cos(0.45)) / (cos(0.2) - cos(0.45));
      t = t < 0 ? 0 : t > 1 ? 1 : t;
      dark += t == 0;
      full += t == 1;
      assert_near("spot", image_at(&spot, x, y, 1), 0.5 / M_PI * 4 * 2 / (r2 * r) * t * t,
                  0.004);
    }
  assert_true(dark > 20 && full > 20);
  image_free(&point);
  image_free(&spot);
}

static void directional(void **state) {
  (void)state;
  /* 60 degrees from the wall's normal, then a scaled and mirrored node: only the direction
   * counts */
  static const char *const nodes[] = {
      "\"rotation\":[0.5,0,0,0.8660254]",
      "\"translation\":[7,8,9],\"rotation\":[0.5,0,0,0.8660254],\"scale\":[-2,1,0.1]"};
  for (int i = 0; i < 2; i++) {
    Image p = lamp_image(nodes[i], "\"type\":\"directional\",\"intensity\":3");
    assert_ratio("directional", image_mean(&p, 1), 0.5 / M_PI * 3 * 0.5, 0.002);
    image_free(&p);
  }
}

/* ---- surfaces that emit light ------------------------------------------------------------ */

static void write_image(vlContext *context, const char *path, uint32_t width,
                        const uint8_t *rgb) {
  vlImageDef def = vl_default_image_def(width, 1, 3);
  def.type = VL_PIXEL_U8;
  def.encoding = VL_ENCODING_SRGB;
  vlImage *image;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  memcpy(vl_image_pixels(image), rgb, 3 * width);
  assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
  vl_image_destroy(image);
}

static double spread(const Image *a, const Image *b) {
  double sum = 0;
  for (uint32_t y = 0; y < 32; y++)
    for (uint32_t x = 0; x < 32; x++)
      sum += pow(image_at(a, x, y, 1) - image_at(b, x, y, 1), 2);
  return sqrt(sum / 1024);
}

/* Makes a new PNG file of one row. path: a template for mkstemps, ending in XXXXXX.png. */
static void make_png(char *path, uint32_t width, const uint8_t *rgb) {
  int file = mkstemps(path, 4);
  assert_true(file >= 0);
  close(file);
  Stage s = stage_open(8, 8);
  write_image(s.context, path, width, rgb);
  stage_close(&s);
}

typedef struct Panel {
  float low, high; /* the part of the image, along u, that it shows */
  int strips;
  bool textured;
  uint32_t spp;
} Panel;

/* Strips along y, from -2 to 2, beside the wall; they face -x. */
static void put_panel(Gltf *g, const Panel *panel) {
  float corners[17 * 6], uv[17 * 4];
  uint16_t faces[16 * 6];
  for (int k = 0; k <= panel->strips; k++)
    for (int top = 0; top < 2; top++) {
      float u = panel->low + (panel->high - panel->low) * (float)k / (float)panel->strips;
      float *to = corners + 6 * k + 3 * top;
      to[0] = 2;
      to[1] = 4 * u - 2;
      to[2] = top ? 2.5f : 0.5f;
      uv[4 * k + 2 * top] = u;
      uv[4 * k + 2 * top + 1] = 0.5f;
    }
  static const uint16_t two[6] = {0, 1, 2, 2, 1, 3};
  for (int k = 0; k < panel->strips; k++)
    for (int i = 0; i < 6; i++)
      faces[6 * k + i] = (uint16_t)(2 * k + two[i]);
  size_t count = 2 * (size_t)panel->strips + 2;
  gltf_floats(g, corners, count, "VEC3", 3);
  gltf_floats(g, uv, count, "VEC2", 2);
  gltf_shorts(g, faces, 6 * (size_t)panel->strips);
}

/* A panel beside the wall emits in one sixteenth of its emission image. It lights the wall as a
 * panel of that sixteenth alone. As a mesh of strips only the emissive strips are sampled, so
 * the noise is hardly larger; a single quadrilateral is sampled uniformly. */
static void emissive_image(void **state) {
  (void)state;
  char path[] = "/tmp/velo-emission-XXXXXX.png";
  uint8_t rgb[48] = {0};
  rgb[15] = rgb[16] = rgb[17] = 255; /* the sixth of sixteen columns */
  make_png(path, 16, rgb);
  static const Panel panels[4] = {{0, 1, 1, true, 64},
                                  {0, 1, 16, true, 64},
                                  {5 / 16.0f, 6 / 16.0f, 1, false, 64},
                                  {5 / 16.0f, 6 / 16.0f, 1, false, 512}};
  Image p[4];
  for (int i = 0; i < 4; i++) {
    Gltf *g = calloc(1, sizeof *g);
    put_box(g, 0);
    put_panel(g, &panels[i]);
    char rest[2400];
    snprintf(
        rest, sizeof rest,
        "\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2]}],\"nodes\":[{\"mesh\":0},{\"camera\":0,"
        "\"translation\":[0,0,10]},"
        "{\"mesh\":1}]," SHOT_CAMERA
        ",\"images\":[{\"uri\":\"%s\"}],\"samplers\":[{\"magFilter\":9728}],"
        "\"textures\":[{\"source\":0,\"sampler\":0}],\"materials\":[{" PAPER
        "},{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1]},"
        "\"emissiveFactor\":[1,1,1],"
        "\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":50}}%s}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
        "\"indices\":1,\"material\":0}]},"
        "{\"primitives\":[{\"attributes\":{\"POSITION\":2,\"TEXCOORD_0\":3},"
        "\"indices\":4,\"material\":1}]}]",
        path + 5, panels[i].textured ? ",\"emissiveTexture\":{\"index\":0}" : "");
    Shot shot = {.room = VL_ENVIRONMENT_NONE, .spp = panels[i].spp};
    p[i] = shoot(g, rest, &shot);
    free(g);
  }
  unlink(path);
  double mean = image_mean(&p[3], 1);
  assert_true(mean > 0.1);
  assert_ratio("a panel in one piece", image_mean(&p[0], 1), mean, 0.03);
  assert_ratio("a panel in strips", image_mean(&p[1], 1), mean, 0.01);
  assert_ratio("a cut-out panel", image_mean(&p[2], 1), mean, 0.01);
  double piece = spread(&p[0], &p[3]), strips = spread(&p[1], &p[3]),
         cut = spread(&p[2], &p[3]);
  if (!(strips < 3 * cut + 0.002))
    fail_msg("noise of strips %g, of a cut-out panel %g", strips, cut);
  if (!(piece < 2 * mean * sqrt(15.0 / 64)))
    fail_msg("noise in one piece %g", piece);
  for (int i = 0; i < 4; i++)
    image_free(&p[i]);
}

/* ---- colours, coverage, uv sets ---------------------------------------------------------- */

/* Materials of a wall, and what is seen of its left and right half. */
#define METAL_0 "\"pbrMetallicRoughness\":{\"metallicFactor\":0,"

static const struct {
  const char *material, *attributes;
  float left[3], right[3]; /* the image of a white room */
} walls[] = {
    {METAL_0 "\"baseColorFactor\":[0.8,0.8,0.8,1]}," MATT,
     ",\"COLOR_0\":3",
     {0.4f, 0.2f, 0.8f},
     {0.4f, 0.2f, 0.8f}},
    {"\"alphaMode\":\"BLEND\"," METAL_0 "\"baseColorFactor\":[0,0,0,0.8]}," MATT,
     ",\"COLOR_0\":3",
     {0.6f, 0.6f, 0.6f},
     {0.6f, 0.6f, 0.6f}},
    {"\"alphaMode\":\"MASK\"," METAL_0 "\"baseColorFactor\":[0,0,0,0.8]}," MATT,
     ",\"COLOR_0\":3",
     {1, 1, 1},
     {1, 1, 1}},
    {METAL_0 "\"baseColorTexture\":{\"index\":0}}," MATT, "", {1, 0, 0}, {1, 0, 0}},
    {METAL_0 "\"baseColorTexture\":{\"index\":0,\"texCoord\":1}}," MATT,
     "",
     {1, 0, 0},
     {0, 1, 0}},
    {METAL_0 "\"baseColorTexture\":{\"index\":0,\"texCoord\":0,\"extensions\":{"
             "\"KHR_texture_transform\":{\"texCoord\":1,\"offset\":[0.5,0]}}}}," MATT,
     "",
     {0, 1, 0},
     {1, 0, 0}},
};

static void painted_walls(void **state) {
  (void)state;
  char path[] = "/tmp/velo-tint-XXXXXX.png";
  static const uint8_t rgb[6] = {255, 0, 0, 0, 255, 0};
  make_png(path, 2, rgb);
  static const float corners[12] = {-2, -2, 0, 2, -2, 0, -2, 2, 0, 2, 2, 0};
  /* all red */
  static const float here[8] = {0.25f, 0.5f, 0.25f, 0.5f, 0.25f, 0.5f, 0.25f, 0.5f};
  static const float across[8] = {0, 0, 1, 0, 0, 1, 1, 1};
  static const float tints[16] = {0.5f, 0.25f, 1, 0.5f, 0.5f, 0.25f, 1, 0.5f,
                                  0.5f, 0.25f, 1, 0.5f, 0.5f, 0.25f, 1, 0.5f};
  static const uint16_t faces[6] = {0, 1, 2, 2, 1, 3};
  for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
    Gltf *g = calloc(1, sizeof *g);
    gltf_floats(g, corners, 4, "VEC3", 3);
    gltf_floats(g, here, 4, "VEC2", 2);
    gltf_floats(g, across, 4, "VEC2", 2);
    gltf_floats(g, tints, 4, "VEC4", 4);
    gltf_shorts(g, faces, 6);
    char rest[2400];
    snprintf(
        rest, sizeof rest,
        "\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},"
        "{\"camera\":0,\"translation\":[0,0,10]}]," SHOT_CAMERA
        ",\"images\":[{\"uri\":\"%s\"}],\"samplers\":[{\"magFilter\":9728,\"minFilter\":9728}],"
        "\"textures\":[{\"source\":0,\"sampler\":0}],\"materials\":[{%s}],\"meshes\":[{"
        "\"primitives\":[{"
        "\"attributes\":{"
        "\"POSITION\":0,\"TEXCOORD_0\":1,\"TEXCOORD_1\":2%s},\"indices\":4,\"material\":0}]}]",
        path + 5, walls[i].material, walls[i].attributes);
    Shot shot = {.spp = 64};
    Image p = shoot(g, rest, &shot);
    free(g);
    for (int c = 0; c < 3; c++) {
      assert_near(walls[i].material, image_region(&p, 2, 4, 14, 28, c),
                  (double)walls[i].left[c], 0.01);
      assert_near(walls[i].material, image_region(&p, 18, 4, 30, 28, c),
                  (double)walls[i].right[c], 0.01);
    }
    image_free(&p);
  }
  unlink(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(point_and_spot), cmocka_unit_test(directional),
      cmocka_unit_test(emissive_image), cmocka_unit_test(painted_walls)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
