/* test/import/test_upgrade.c: pbrt-v3 text becomes pbrt-v4 text: each kind of statement, files,
 * images of lights. */
#include <sys/stat.h>

#include "image/image.h"
#include "import/load.h"
#include "import/upgrade_statements.h"
#include "math/octahedral.h"
#include "velo/shape.h"
#include "velo/upgrade.h"

static char folder[200];

static const char *in_folder(const char *name) {
  static char paths[4][300];
  static int next;
  char *path = paths[next = (next + 1) % 4];
  if (!folder[0]) {
    snprintf(folder, sizeof folder, "%s/velo_upgrade_XXXXXX",
             getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
    assert_non_null(mkdtemp(folder));
    mkdir(in_folder("old"), 0700);
    mkdir(in_folder("old/parts"), 0700);
    mkdir(in_folder("new"), 0700);
  }
  snprintf(path, 300, "%s/%s", folder, name);
  return path;
}

static void write_file(const char *name, const char *text) {
  FILE *f = fopen(in_folder(name), "wb");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

static const char *read_file(const char *name) {
  static char text[65536];
  FILE *f = fopen(in_folder(name), "rb");
  text[0] = 0;
  if (!f)
    return "(no file)";
  text[fread(text, 1, sizeof text - 1, f)] = 0;
  fclose(f);
  return text;
}

typedef struct Notes {
  char text[8192];
  int changed, lost, wrote;
} Notes;

static void take(void *user, vlUpgradeNote note, const vlError *place, const char *message) {
  Notes *n = user;
  n->changed += note == VL_UPGRADE_CHANGED;
  n->lost += note == VL_UPGRADE_LOST;
  n->wrote += note == VL_UPGRADE_WROTE;
  size_t at = strlen(n->text);
  const char *slash = strrchr(place->file, '/');
  snprintf(n->text + at, sizeof n->text - at, "%s:%u: %s\n", slash ? slash + 1 : place->file,
           place->line, message);
}

static vlResult upgrade(const char *from, const char *to, bool strict, Notes *notes,
                        vlError *error) {
  vlContext *context;
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  memset(notes, 0, sizeof *notes);
  vlUpgradeDef how = vl_default_upgrade_def();
  how.strict = strict;
  how.report = take;
  how.report_user = notes;
  vlResult r = vl_scene_upgrade(context, in_folder(from), in_folder(to), &how, error);
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
  return r;
}

/* Two images that the statements name. */
static void write_images(void) {
  vlContext *context;
  vlImage *image;
  vlError error;
  vlContextDef cd = vl_default_context_def();
  assert_int_equal(vl_context_create(&cd, &context), VL_OK);
  vlImageDef def = vl_default_image_def(4, 2, 3);
  def.type = VL_PIXEL_F32;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  for (int i = 0; i < 24; i++)
    ((float *)vl_image_pixels(image))[i] = 0.5f;
  assert_int_equal(vl_image_write(image, in_folder("old/around.exr"), NULL, &error), VL_OK);
  assert_int_equal(vl_image_write(image, in_folder("old/a.png"), NULL, &error), VL_OK);
  vl_image_destroy(image);
  vl_context_destroy(context);
}

/* Each statement becomes the expected one, and the result is a scene that velo loads. */
static void statements(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  int wrong = 0;
  write_images();
  for (size_t i = 0; i < sizeof world / sizeof *world; i++) {
    char text[4096], wanted[4096];
    snprintf(text, sizeof text, "Film \"rgb\"\nPixelFilter \"box\"\nWorldBegin\n%sWorldEnd\n",
             world[i].from);
    snprintf(wanted, sizeof wanted, "Film \"rgb\"\nPixelFilter \"box\"\nWorldBegin\n%s",
             world[i].to);
    write_file("old/s.pbrt", text);
    /* of another scene: it would not be overwritten */
    unlink(in_folder("new/around-equiarea.exr"));
    vlResult r = upgrade("old/s.pbrt", "new/s.pbrt", false, &notes, &error);
    const char *got = r == VL_OK ? read_file("new/s.pbrt") : error.message;
    bool same = strcmp(got, wanted) == 0 && notes.lost == world[i].lost;
    if (!same)
      print_message("%s lost %d\n got: %s\n not: %s\n%s", world[i].from, notes.lost, got,
                    wanted, notes.text);
    wrong += !same;
    Loaded l;
    start_load(&l);
    l.result = vl_scene_load(l.scene, in_folder("new/s.pbrt"), NULL, &l.error);
    if (l.result != VL_OK) {
      print_message("%s\n%s\n", got, l.error.message);
      wrong++;
    }
    end_load(&l);
  }
  assert_int_equal(wrong, 0);
}

/* Camera, film and the rest, before WorldBegin. */
static void settings(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  write_file("old/s.pbrt",
             "# head\n"
             "LookAt 0 0 -5  0 0 0  0 1 0\n"
             "Camera \"perspective\" \"float halffov\" 30 \"float shutterclose\" .5\n"
             "Film \"image\" \"integer xresolution\" [ 64 ] \"integer yresolution\" 48\n"
             "     \"float scale\" 2 \"float maxsampleluminance\" 10 "
             "\"string filename\" \"a.exr\"\n"
             "Sampler \"02sequence\" \"integer pixelsamples\" 4\n"
             "PixelFilter \"gaussian\" \"float xwidth\" 1.5 \"float alpha\" 2\n"
             "Integrator \"directlighting\" \"integer maxdepth\" 3\n"
             "Accelerator \"kdtree\"\n"
             "WorldBegin\n"
             "WorldEnd\n");
  assert_int_equal(upgrade("old/s.pbrt", "new/s.pbrt", false, &notes, &error), VL_OK);
  assert_string_equal(
      read_file("new/s.pbrt"),
      "# head\n"
      "LookAt 0 0 -5  0 0 0  0 1 0\n"
      "Camera \"perspective\" \"float fov\" 60 \"float shutterclose\" .5\n"
      "Film \"rgb\" \"integer xresolution\" [ 64 ] \"integer yresolution\" 48 "
      "\"float maxcomponentvalue\" 10 \"string filename\" \"a.exr\" \"float iso\" 400\n"
      "Sampler \"paddedsobol\" \"integer pixelsamples\" 4\n"
      "PixelFilter \"gaussian\" \"float xradius\" 1.5 \"float sigma\" 0.5 "
      "\"float yradius\" 2\n"
      "Integrator \"path\" \"integer maxdepth\" 3\n"
      "Accelerator \"kdtree\"\n"
      "WorldBegin\n");
  assert_int_equal(notes.lost, 1);
  assert_non_null(
      strstr(notes.text,
             "s.pbrt:4: Film: without scale, \"image\" -> \"rgb\", maxsampleluminance "
             "-> maxcomponentvalue"));
  write_file("old/s.pbrt", "Camera \"environment\"\nWorldBegin\nShape \"sphere\"\nWorldEnd");
  assert_int_equal(upgrade("old/s.pbrt", "new/s.pbrt", true, &notes, &error), VL_OK);
  assert_string_equal(
      read_file("new/s.pbrt"),
      "Camera \"spherical\" \"string mapping\" \"equirectangular\"\nPixelFilter "
      "\"box\"\nWorldBegin\nShape \"sphere\"\n");
}

/* A scene of pbrt-v4 stays as it is. */
static void new_scene(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  const char *text =
      "Film \"rgb\" \"string sensor\" \"cie1931\"\n"
      "Sampler \"zsobol\"\n"
      "PixelFilter \"gaussian\"\n"
      "Integrator \"volpath\"\n"
      "WorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] \"float scale\" 2\n"
      "Material \"diffuse\" \"rgb reflectance\" [ .1 .1 .1 ]\n"
      "AttributeBegin\n"
      "Shape \"sphere\"\n"
      "AttributeEnd\n";
  write_file("old/s.pbrt", text);
  assert_int_equal(upgrade("old/s.pbrt", "new/s.pbrt", true, &notes, &error), VL_OK);
  assert_string_equal(read_file("new/s.pbrt"), text);
  assert_int_equal(notes.changed, 0);
}

/* Any damaged text is an error with its place, or is upgraded. */
static void damaged(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  const char *text =
      "Film \"image\" \"float scale\" [ 2 ] # a\n"
      "WorldBegin\n"
      "TransformBegin\n"
      "Material \"uber\" \"rgb opacity\" [ .5 .5 .5 ] \"texture Kd\" \"t\"\n"
      "TransformEnd\n"
      "LightSource \"point\" \"spectrum I\" [ 400 1 700 2 ]\n"
      "Shape \"heightfield\" \"integer nu\" 2 \"integer nv\" 2 \"float Pz\" [ 0 0 0 1 ]\n"
      "Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ]\n"
      "WorldEnd\n";
  char part[1000];
  size_t n = strlen(text);
  for (size_t i = 0; i < n; i++) {
    snprintf(part, sizeof part, "%.*s", (int)i, text);
    write_file("old/d.pbrt", part);
    vlResult r = upgrade("old/d.pbrt", "new/d.pbrt", false, &notes, &error);
    assert_true(r == VL_OK || (r == VL_ERROR_SCENE && error.line > 0));
    snprintf(part, sizeof part, "%.*s%s", (int)i, text, text + i + 1); /* without one byte */
    write_file("old/d.pbrt", part);
    r = upgrade("old/d.pbrt", "new/d.pbrt", false, &notes, &error);
    assert_true(r == VL_OK || r == VL_ERROR_SCENE);
  }
}

/* Included files are written beside the new scene where they change; names of other files lead
 * to the old folder. */
static void files(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  write_file("old/parts/plain.pbrt", "Shape \"sphere\"\n");
  write_file(
      "old/parts/m.pbrt",
      "Material \"matte\" # mine\nShape \"plymesh\" \"string filename\" \"parts/a.ply\"\n");
  write_file(
      "old/parts/a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
      "0\n0 1 0\n3 0 1 2\n");
  write_file("old/s.pbrt",
             "PixelFilter \"box\"\nWorldBegin\nInclude \"parts/m.pbrt\"\nInclude "
             "\"parts/plain.pbrt\"\n"
             "Include \"parts/m.pbrt\"\nWorldEnd\n");
  assert_int_equal(upgrade("old/s.pbrt", "new/t.pbrt", false, &notes, &error), VL_OK);
  assert_string_equal(read_file("new/t.pbrt"),
                      "PixelFilter \"box\"\nWorldBegin\nInclude \"parts/m.pbrt\"\nInclude "
                      "\"../old/parts/plain.pbrt\"\nInclude \"parts/m.pbrt\"\n");
  assert_string_equal(read_file("new/parts/m.pbrt"),
                      "Material \"diffuse\" # mine\n"
                      "Shape \"plymesh\" \"string filename\" \"../old/parts/a.ply\"\n");
  assert_int_equal(notes.wrote, 2);
  Loaded l;
  start_load(&l);
  l.result = vl_scene_load(l.scene, in_folder("new/t.pbrt"), NULL, &l.error);
  if (l.result != VL_OK)
    print_message("%s\n", l.error.message);
  assert_int_equal(l.result, VL_OK);
  assert_int_equal(l.scene->shapes.count, 3);
  end_load(&l);
  /* in the same folder nothing of the old scene is overwritten */
  assert_int_equal(upgrade("old/s.pbrt", "old/s4.pbrt", false, &notes, &error), VL_OK);
  assert_string_equal(read_file("old/s4.pbrt"),
                      "PixelFilter \"box\"\nWorldBegin\nInclude \"parts/m-v4.pbrt\"\nInclude "
                      "\"parts/plain.pbrt\"\nInclude \"parts/m-v4.pbrt\"\n");
  assert_string_equal(
      read_file("old/parts/m-v4.pbrt"),
      "Material \"diffuse\" # mine\nShape \"plymesh\" \"string filename\" \"parts/a.ply\"\n");
  assert_int_equal(upgrade("old/s.pbrt", "old/s.pbrt", false, &notes, &error),
                   VL_ERROR_ARGUMENT);
}

/* The direction of the brightest pixel stays. */
static void environment(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  vlContext *context;
  vlContextDef cd = vl_default_context_def();
  assert_int_equal(vl_context_create(&cd, &context), VL_OK);
  vlImageDef def = vl_default_image_def(64, 32, 3);
  def.type = VL_PIXEL_F32;
  vlImage *image;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  memset(vl_image_pixels(image), 0, 64 * 32 * 12);
  for (int y = 8; y < 10; y++)
    for (int x = 20; x < 22; x++)
      ((float *)vl_image_pixels(image))[3 * (64 * y + x) + 1] = 1;
  assert_int_equal(vl_image_write(image, in_folder("old/sky.exr"), NULL, &error), VL_OK);
  vl_image_destroy(image);
  write_file("old/s.pbrt",
             "PixelFilter \"box\"\n"
             "WorldBegin\n"
             "LightSource \"infinite\" \"string mapname\" \"sky.exr\" \"rgb L\" [ 1 3 1 ] "
             "\"rgb scale\" [ 2 2 2 ]\n"
             "WorldEnd\n");
  assert_int_equal(upgrade("old/s.pbrt", "new/s.pbrt", true, &notes, &error), VL_OK);
  assert_string_equal(read_file("new/s.pbrt"),
                      "PixelFilter \"box\"\n"
                      "WorldBegin\n"
                      "LightSource \"infinite\" \"string filename\" \"sky-equiarea.exr\" "
                      "\"float scale\" 2\n");
  assert_int_equal(vl_image_read(context, in_folder("new/sky-equiarea.exr"), &image, &error),
                   VL_OK);
  uint32_t channel[4], count = vl_image_color(image, channel), n = image->width;
  float *p;
  assert_int_equal(n, image->height);
  assert_int_equal(vl_image_to_float(image, channel, count, &p), VL_OK);
  double sum[3] = {0, 0, 0}, total = 0;
  for (uint32_t i = 0; i < n * n; i++) {
    double w = (double)p[count * i + 1];
    vlVec3 d = vl_octahedral_decode(((float)(i % n) + 0.5f) / (float)n,
                                    ((float)(i / n) + 0.5f) / (float)n);
    sum[0] += w * (double)d.x;
    sum[1] += w * (double)d.y;
    sum[2] += w * (double)d.z;
    total += w;
  }
  double theta = M_PI * 9 / 32, phi = 2 * M_PI * 21 / 64;
  assert_near(sum[0] / total, sin(theta) * cos(phi), 0.01);
  assert_near(sum[1] / total, sin(theta) * sin(phi), 0.01);
  assert_near(sum[2] / total, cos(theta), 0.01);
  /* light is kept: radiance 3 over four pixels' solid angle */
  double angle = 2 * (2 * M_PI / 64) * (cos(M_PI * 8 / 32) - cos(M_PI * 10 / 32));
  assert_near(total * 4 * M_PI / (n * n) / (3 * angle), 1, 0.03);
  vl_free(context, p);
  vl_image_destroy(image);
  vl_context_destroy(context);
}

/* pbrt-v3's black body has the largest value 1; pbrt-v4's the luminance 1. */
static void black_bodies(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  write_file("old/s.pbrt",
             "PixelFilter \"box\"\n"
             "WorldBegin\n"
             "LightSource \"point\" \"blackbody I\" [ 3000 2 ]\n"
             "WorldEnd\n");
  assert_int_equal(upgrade("old/s.pbrt", "new/s.pbrt", false, &notes, &error), VL_OK);
  const char *text = read_file("new/s.pbrt"), *scale = strstr(text, "\"float scale\" ");
  assert_non_null(strstr(text, "\"blackbody I\" 3000"));
  assert_non_null(scale);
  /* Planck's law over its largest value, at 966 nm, seen by the observer (Wyman et al. 2013) */
  double c2 = 0.01438777, peak = 2.8977721e-3 / 3000, sum = 0, all = 0;
  for (double l = 360; l < 830; l++) {
    double y = 0.821 * exp(-0.5 * pow((l - 568.8) / (l < 568.8 ? 46.9 : 40.5), 2)) +
               0.286 * exp(-0.5 * pow((l - 530.9) / (l < 530.9 ? 16.3 : 31.1), 2));
    all += y;
    sum += y * pow(peak / (l * 1e-9), 5) * (exp(c2 / (peak * 3000)) - 1) /
           (exp(c2 / (l * 1e-9 * 3000)) - 1);
  }
  assert_near(atof(scale + 14) / (2 * sum / all), 1, 0.005);
}

static void strict(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  write_file("old/s.pbrt", "WorldBegin\nShape \"nurbs\"\nWorldEnd\n");
  assert_int_equal(upgrade("old/s.pbrt", "new/none.pbrt", true, &notes, &error),
                   VL_ERROR_UNSUPPORTED);
  assert_string_equal(read_file("new/none.pbrt"), "(no file)");
  write_file("old/s.pbrt", "WorldBegin\nMaterial \"matte\" \"Kd\" 3\n");
  assert_int_equal(upgrade("old/s.pbrt", "new/none.pbrt", false, &notes, &error),
                   VL_ERROR_SCENE);
  assert_int_equal(error.line, 2);
  assert_int_equal(upgrade("old/gone.pbrt", "new/none.pbrt", false, &notes, &error),
                   VL_ERROR_MISSING);
}

/* Solids that pbrt-v4 does not have: their triangles lie on them. */
static void solids(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  Loaded l;
  write_file("old/s.pbrt",
             "WorldBegin\n"
             "Shape \"cone\" \"float radius\" 2 \"float height\" 3\n"
             "Shape \"heightfield\" \"integer nu\" 2 \"integer nv\" 3 "
             "\"float Pz\" [ 0 1 2 3 4 5 ]\n"
             "Shape \"paraboloid\"\n"
             "Shape \"hyperboloid\" \"point p1\" [ 1 0 0 ] \"point p2\" [ 0 1 1 ]\n");
  assert_int_equal(upgrade("old/s.pbrt", "new/s.pbrt", false, &notes, &error), VL_OK);
  start_load(&l);
  l.result = vl_scene_load(l.scene, in_folder("new/s.pbrt"), NULL, &l.error);
  if (l.result != VL_OK)
    print_message("%s\n", l.error.message);
  assert_int_equal(l.result, VL_OK);
  assert_int_equal(l.scene->shapes.count, 4);
  const vlShapeDef *cone = &l.scene->shapes.items[0], *field = &l.scene->shapes.items[1];
  for (uint32_t i = 0; i < cone->vertices; i++) {
    const float *p = cone->positions + 3 * i;
    assert_near(hypot((double)p[0], (double)p[1]), 2 * (1 - (double)p[2] / 3), 1e-5);
  }
  assert_int_equal(field->vertices, 6);
  assert_near(field->positions[3 * 3 + 2], 3, 0);
  assert_near(field->positions[3 * 3 + 1], 0.5, 0);
  end_load(&l);
}

/* Paraboloids are z = zmax (x^2 + y^2) / radius^2 between two heights in either order. */
static void paraboloids(void **state) {
  (void)state;
  Notes notes;
  vlError error;
  Loaded l;
  static const struct {
    const char *heights;
    double low, high;
  } cases[] = {{"\"float zmin\" 2 \"float zmax\" 1", 1, 2},
               {"\"float zmin\" -1 \"float zmax\" 1", 0, 1},
               {"\"float zmin\" -1 \"float zmax\" -3", -3, -1}};
  for (int i = 0; i < 3; i++) {
    char text[200];
    snprintf(text, sizeof text,
             "WorldBegin\nShape \"paraboloid\" \"float radius\" 2 \"float phimax\" 400 %s\n",
             cases[i].heights);
    write_file("old/p.pbrt", text);
    assert_int_equal(upgrade("old/p.pbrt", "new/p.pbrt", false, &notes, &error), VL_OK);
    start_load(&l);
    l.result = vl_scene_load(l.scene, in_folder("new/p.pbrt"), NULL, &l.error);
    assert_int_equal(l.result, VL_OK);
    const vlShapeDef *s = &l.scene->shapes.items[0];
    double low = INFINITY, high = -INFINITY;
    for (uint32_t k = 0; k < s->vertices; k++) {
      const float *p = s->positions + 3 * k;
      double rho = hypot((double)p[0], (double)p[1]);
      double zmax = cases[i].high;
      assert_near(zmax * rho * rho / 4, p[2], 1e-5);
      low = fmin(low, (double)p[2]);
      high = fmax(high, (double)p[2]);
    }
    assert_near(low, cases[i].low, 1e-6);
    assert_near(high, cases[i].high, 1e-6);
    end_load(&l);
  }
  write_file("old/p.pbrt", "WorldBegin\nShape \"paraboloid\" \"float zmax\" 0\n");
  assert_int_equal(upgrade("old/p.pbrt", "new/none.pbrt", false, &notes, &error),
                   VL_ERROR_SCENE);
  assert_string_equal(error.message, "paraboloid: the larger of zmin and zmax must not be 0");
}

/* Loading names the command. */
static void recognised(void **state) {
  (void)state;
  Loaded l;
  char wanted[700];
  static const struct {
    const char *text, *sign;
    int version, line, column;
  } cases[] = {
      {"Film \"image\"\nWorldBegin\nMaterial \"matte\"\nWorldEnd\n", "Film \"image\"", 3, 1, 1},
      {"WorldBegin\nShape \"sphere\"\n  WorldEnd\n", "WorldEnd", 3, 3, 3},
      {"Film \"image\"\nSurfaceIntegrator \"path\"\nWorldBegin\nWorldEnd\n",
       "SurfaceIntegrator", 2, 2, 1}};
  for (int i = 0; i < 3; i++) {
    write_file("old/r.pbrt", cases[i].text);
    start_load(&l);
    l.result = vl_scene_load(l.scene, in_folder("old/r.pbrt"), NULL, &l.error);
    assert_int_equal(l.result, VL_ERROR_SCENE);
    snprintf(wanted, sizeof wanted,
             "this is a pbrt-v%d scene (%s): velo scene upgrade %s NEW.pbrt makes a pbrt-v4 "
             "scene of it",
             cases[i].version, cases[i].sign, in_folder("old/r.pbrt"));
    assert_string_equal(l.error.message, wanted);
    assert_int_equal(l.error.line, cases[i].line);
    assert_int_equal(l.error.column, cases[i].column);
    end_load(&l);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(statements),  cmocka_unit_test(settings),     cmocka_unit_test(files),
      cmocka_unit_test(environment), cmocka_unit_test(black_bodies), cmocka_unit_test(strict),
      cmocka_unit_test(new_scene),   cmocka_unit_test(damaged),      cmocka_unit_test(solids),
      cmocka_unit_test(paraboloids), cmocka_unit_test(recognised)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
