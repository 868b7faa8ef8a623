/* test/import/test_obj.c: OBJ with its MTL libraries, and PLY as a scene: accepted and rejected
 * content. */
#include "import/load.h"

#include "failing_allocator.h"
#include "math/hash.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/shape.h"
#include "velo/texture.h"

static char folder[64];

static int make_folder(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/velo_obj_XXXXXX");
  return mkdtemp(folder) == NULL;
}

static int remove_folder(void **state) {
  (void)state;
  char command[100];
  snprintf(command, sizeof command, "rm -rf %s", folder);
  return system(command) != 0;
}

static void write_bytes(const char *name, const void *data, size_t size) {
  char path[200];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(data, 1, size, f), size);
  fclose(f);
}

static void write_text(const char *name, const char *text) {
  write_bytes(name, text, strlen(text));
}

static void load(Loaded *l, const char *name) {
  char path[200];
  start_load(l);
  snprintf(path, sizeof path, "%s/%s", folder, name);
  l->result = vl_scene_load(l->scene, path, NULL, &l->error);
}

static void load_obj(Loaded *l, const char *text) {
  write_text("t.obj", text);
  load(l, "t.obj");
}

static void wrong(const char *text, uint32_t line, uint32_t column, const char *part) {
  Loaded l;
  load_obj(&l, text);
  assert_int_equal(l.result, VL_ERROR_SCENE);
  if (!strstr(l.error.message, part))
    fail_msg("\"%s\" does not say \"%s\"", l.error.message, part);
  assert_int_equal(l.error.line, line);
  assert_int_equal(l.error.column, column);
  end_load(&l);
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void corners(void **state) {
  (void)state;
  static const char *const faces[] = {"f 1 2 3 4\n",
                                      "f -4 -3 -2 -1\n",
                                      "f 1/ 2/ 3/ 4/\n",
                                      "f 1 2 \\\n 3 4\n",
                                      "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\n",
                                      "f 1 2 3 4 # all\r\n"};
  for (size_t i = 0; i < sizeof faces / sizeof *faces; i++) {
    char text[200];
    snprintf(text, sizeof text, SQUARE "%s", faces[i]);
    Loaded l;
    load_obj(&l, text);
    assert_int_equal(l.result, VL_OK);
    assert_int_equal(l.scene->shapes.count, 1);
    const vlShapeDef *d = &l.scene->shapes.items[0];
    assert_int_equal(d->faces, 2);
    assert_int_equal(d->vertices, 4);
    assert_int_equal(d->normals != NULL, i == 4);
    assert_true(vl_scene_defs(l.scene)->camera_missing &&
                vl_scene_defs(l.scene)->light_missing);
    end_load(&l);
  }
}

/* Twice the area of all triangles seen along z, and the smallest one. */
static double area(const vlShapeDef *d, double *min) {
  double sum = 0;
  *min = 1e9;
  for (uint32_t f = 0; f < d->faces; f++) {
    const float *p[3];
    for (int k = 0; k < 3; k++)
      p[k] = d->positions + 3 * (size_t)d->indices[3 * f + (uint32_t)k];
    double a = ((double)p[1][0] - p[0][0]) * ((double)p[2][1] - p[0][1]) -
               ((double)p[1][1] - p[0][1]) * ((double)p[2][0] - p[0][0]);
    sum += a;
    *min = a < *min ? a : *min;
  }
  return sum;
}

/* Polygons that are not convex: no triangle may lie outside, which would turn the other way. */
static void polygons(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double twice;
  } cases[] = {{"v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nf 1 2 3 4\n", 3.0},
               {"v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6\n", 10.0}};
  for (size_t i = 0; i < 2; i++) {
    Loaded l;
    double min;
    load_obj(&l, cases[i].text);
    assert_int_equal(l.result, VL_OK);
    assert_float_equal(area(&l.scene->shapes.items[0], &min), cases[i].twice, 1e-6);
    assert_true(min > 0);
    end_load(&l);
  }
}

/* A roof of two faces at right angles: smooth along the ridge in a group, flat without. */
static void smoothing(void **state) {
  (void)state;
  static const char *const roof = "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 1\nv 1 2 0\nv 0 2 0\n";
  char text[300];
  Loaded l;
  snprintf(text, sizeof text, "%ss 1\nf 1 2 3 4\nf 4 3 5 6\n", roof);
  load_obj(&l, text);
  const vlShapeDef *d = &l.scene->shapes.items[0];
  assert_non_null(d->normals);
  assert_int_equal(d->vertices, 6);
  int ridge = 0;
  for (uint32_t i = 0; i < d->vertices; i++)
    if (d->positions[3 * i + 1] == 1.0f) {
      assert_float_equal(d->normals[3 * i + 1], 0, 0.35); /* angles, not areas, weigh */
      ridge++;
    }
  assert_int_equal(ridge, 2);
  end_load(&l);
  snprintf(text, sizeof text, "%ss off\nf 1 2 3 4\nf 4 3 5 6\n", roof);
  load_obj(&l, text);
  assert_null(l.scene->shapes.items[0].normals);
  end_load(&l);
  /* the second one flat beside it */
  snprintf(text, sizeof text, "%ss 1\nf 1 2 3 4\ns 0\nf 4 3 5 6\n", roof);
  load_obj(&l, text);
  d = &l.scene->shapes.items[0];
  assert_int_equal(d->vertices, 10);
  end_load(&l);
}

static void colors(void **state) {
  (void)state;
  Loaded l;
  load_obj(&l, "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0\nf 1 2 3\n");
  const vlShapeDef *d = &l.scene->shapes.items[0];
  assert_non_null(d->colors);
  assert_float_equal(d->colors[0], 1, 0);
  assert_float_equal(d->colors[5], 0.21404, 1e-4); /* sRGB's 0.5 */
  assert_float_equal(d->colors[8], 1, 0);
  assert_int_not_equal(l.scene->materials.items[0].reflectance.texture.index, 0);
  end_load(&l);
  write_text("c.ply",
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
             "y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
             "property list uchar int vertex_indices\nend_header\n"
             "0 0 0 255 0 0\n1 0 0 0 128 0\n1 1 0 0 0 255\n0 1 0 255 255 255\n4 0 1 2 3\n");
  load(&l, "c.ply");
  assert_int_equal(l.result, VL_OK);
  d = &l.scene->shapes.items[0];
  assert_int_equal(d->faces, 2);
  assert_float_equal(d->colors[0], 1, 0);
  assert_float_equal(d->colors[5], 0.21586, 1e-4);
  assert_true(vl_scene_defs(l.scene)->camera_missing);
  end_load(&l);
}

static void materials(void **state) {
  (void)state;
  write_text("m.mtl",
             "newmtl plain\nKd 0.2 0.4 0.6\nKs 0.5 0.5 0.5\nNs 48\nillum 2\n"
             "newmtl matt\nKd 0.5 0.5 0.5\nillum 1\n"
             "newmtl gold\nKd 0 0 0\nKs 1 0.8 0.3\nNs 300\nillum 3\n"
             "newmtl glass\nKd 1 1 1\nNi 1.45\nillum 7\nTf 0.9 1 0.9\n"
             "newmtl lamp\nKe 2 4 6\n"
             "newmtl sheer\nTr 0.75\n"
             "newmtl pbr\nPr 0.3\nPm 0.9\nPc 0.5\nPcr 0.1\naniso 0.25\n");
  Loaded l;
  load_obj(&l, "mtllib m.mtl\n" SQUARE
               "usemtl plain\nf 1 2 3\nusemtl matt\nf 1 2 3\nusemtl gold\nf 1 2 3\nusemtl "
               "glass\nf 1 2 3\n"
               "usemtl lamp\nf 1 2 3\nusemtl sheer\nf 1 2 3\nusemtl pbr\nf 1 2 3\nusemtl "
               "plain\nf 1 2 3\n");
  assert_int_equal(l.result, VL_OK);
  assert_int_equal(l.scene->shapes.count, 8);
  assert_int_equal(l.scene->materials.count, 7);
  assert_string_equal(l.log, "");
  const vlMaterialDef *m = l.scene->materials.items;
  assert_float_equal(m[0].reflectance.value.rgb[1], 0.4, 1e-6);
  assert_float_equal(m[0].principled.roughness.value, pow(2.0 / 50, 0.25), 1e-6);
  assert_float_equal(m[0].principled.specular_color.value.rgb[0], 1, 1e-6);
  assert_float_equal(m[1].principled.specular.value, 0, 0);
  assert_float_equal(m[2].principled.metallic.value, 1, 0);
  assert_float_equal(m[2].reflectance.value.rgb[2], 0.3, 1e-6);
  assert_float_equal(m[3].principled.transmission.value, 1, 0);
  assert_false(m[3].principled.thin_walled);
  assert_float_equal(m[3].eta.value.value, 1.45, 1e-6);
  assert_float_equal(m[3].reflectance.value.rgb[0], 0.9, 1e-6);
  assert_int_equal(l.scene->emissions.count, 1);
  assert_float_equal(l.scene->emissions.items[0].radiance.rgb[2], 6, 0);
  assert_int_not_equal(l.scene->shapes.items[4].emission.index, 0);
  assert_float_equal(l.scene->shapes.items[5].alpha.value, 0.25, 1e-6);
  assert_float_equal(m[6].principled.metallic.value, 0.9, 1e-6);
  assert_float_equal(m[6].principled.clearcoat_roughness.value, 0.1, 1e-6);
  assert_int_equal(l.scene->shapes.items[0].material.index,
                   l.scene->shapes.items[7].material.index);
  end_load(&l);
}

/* Glass that is partly transparent has the colour Kd, unless that is black: then it has Tf. */
static void partly_glass(void **state) {
  (void)state;
  write_text("g.mtl",
             "newmtl black\nKd 0 0 0\nd 0.1\nillum 7\nTf 0.7 0.8 0.9\n"
             "newmtl grey\nKd 0.2 0.2 0.2\nd 0.1\nillum 7\nTf 0.7 0.8 0.9\n");
  Loaded l;
  load_obj(&l, "mtllib g.mtl\n" SQUARE "usemtl black\nf 1 2 3\nusemtl grey\nf 1 2 3\n");
  assert_int_equal(l.result, VL_OK);
  const vlMaterialDef *m = l.scene->materials.items;
  for (int i = 0; i < 2; i++) {
    assert_float_equal(m[i].principled.transmission.value, 0.9, 1e-6);
    assert_float_equal(m[i].reflectance.value.rgb[0], i ? 0.2 : 0.7, 1e-6);
  }
  end_load(&l);
}

/* Images of each kind, with the options before their names. */
static void maps(void **state) {
  (void)state;
  write_text("i.ppm", "P3 2 1 255 255 0 0 0 255 0\n");
  write_text("wall_normal.ppm", "P3 1 1 255 128 128 255\n");
  write_text("i.xcf", "gimp");
  write_text(
      "i.mtl",
      "newmtl all\nKd 0 0 0\nmap_Kd -clamp on -o 0.5 0.25 -s 2 3 1 -mm 0.1 0.7 i.ppm\n"
      "Pm 0.5\nmap_Pm -imfchan r i.ppm\nmap_Pr -mm 0.25 0.5 -imfchan g -type sphere i.ppm\n"
      "map_d -blendu off -texres 8 -t 1 i.ppm\nmap_Ke i.ppm\nmap_Bump -bm 0.5 i.ppm\nPs 0.25\n"
      "newmtl named\nbump -bm 2 wall_normal.ppm\nmap_Kd i.xcf\nKe xyz 1 1 1\nKs spectral a.rfl "
      "1\n"
      "newmtl normal\nnorm -bm 3 i.ppm\nKd 0.5\nKe 1\nmap_Ke i.ppm\n"
      "newmtl solid\nKd 0 0 0\nNi 1.3\nillum 6\nd 0.4\nmap_d i.ppm\n");
  Loaded l;
  load_obj(&l, "mtllib i.mtl\n" SQUARE
               "usemtl all\nf 1 2 3\nusemtl named\nf 1 2 3\nusemtl normal\nf 1 2 3\n"
               "usemtl solid\nf 1 2 3\n");
  assert_int_equal(l.result, VL_OK);
  assert_non_null(strstr(l.log, "i.xcf\": velo does not read images of this kind"));
  assert_non_null(strstr(l.log, "Ks spectral: velo does not read .rfl files"));
  const vlMaterialDef *m = l.scene->materials.items;
  const vlTextureDef *t = l.scene->textures.items;
  const vlTextureDef *kd = &t[m[0].reflectance.texture.index - 1];
  assert_non_null(strstr(kd->path, "i.ppm"));
  assert_int_equal(kd->wrap, VL_WRAP_CLAMP);
  assert_float_equal(kd->du, 0.5, 0);
  assert_float_equal(kd->dv, 0.25, 0);
  assert_float_equal(kd->su, 2, 0);
  assert_float_equal(kd->sv, 3, 0);
  assert_float_equal(kd->scale, 0.7, 1e-6);
  assert_float_equal(kd->tint[1], 1, 0); /* Kd is black: the image alone gives the colour */
  const vlTextureDef *metal = &t[m[0].principled.metallic.texture.index - 1];
  assert_int_equal(metal->channel, 0);
  assert_float_equal(metal->scale, 0.5, 0);
  const vlTextureDef *rough = &t[m[0].principled.roughness.texture.index - 1];
  assert_int_equal(rough->channel, 1);
  assert_float_equal(rough->bias, 0.25, 0);
  assert_float_equal(rough->scale, 0.5, 0);
  assert_int_not_equal(l.scene->shapes.items[0].alpha.texture.index, 0);
  assert_float_equal(m[0].principled.sheen_color.value.rgb[0], 0.25, 0);
  assert_float_equal(t[m[0].displacement.texture.index - 1].scale, 0.002 * sqrt(2) * 0.5, 1e-7);
  assert_non_null(strstr(t[m[1].principled.normal.index - 1].path, "wall_normal.ppm"));
  assert_float_equal(m[1].principled.normal_scale, 2, 0);
  assert_float_equal(m[2].principled.normal_scale, 3, 0);
  assert_int_equal(l.scene->emissions.count, 3);
  assert_int_not_equal(l.scene->emissions.items[0].texture.index, 0);
  assert_float_equal(l.scene->emissions.items[1].radiance.rgb[0], 1.2048, 1e-3); /* xyz 1 1 1 */
  assert_float_equal(m[3].principled.transmission.value, 0.6, 1e-6);
  assert_float_equal(m[3].reflectance.value.rgb[2], 1, 0);
  assert_int_equal(l.scene->shapes.items[3].alpha.texture.index, 0);
  end_load(&l);
  static const char *const broken[][2] = {
      {"map_Kd -bm i.ppm", "-bm: 0 numbers, 1 are needed"},
      {"map_Kd -clamp", "-clamp: its value is missing"},
      {"map_Kd -imfchan", "-imfchan: its value is missing"},
      {"map_Kd -mm 1 i.ppm", "-mm: 1 numbers, 2 are needed"},
      {"map_Kd -s i.ppm", "0 numbers, 1 are needed"},
      {"map_Kd -cc on", "the name of an image is missing"},
      {"Ns fast", "Ns"},
      {"Tr", "Tr needs a number"}};
  for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
    char text[100];
    snprintf(text, sizeof text, "newmtl a\n%s\n", broken[i][0]);
    write_text("b.mtl", text);
    load_obj(&l, "mtllib b.mtl\n");
    assert_int_equal(l.result, VL_ERROR_SCENE);
    if (!strstr(l.error.message, broken[i][1]))
      fail_msg("%s: %s", broken[i][0], l.error.message);
    assert_int_equal(l.error.line, 2);
    end_load(&l);
  }
}

/* Missing files are reported as warnings, and the import continues without them. */
static void missing(void **state) {
  (void)state;
  Loaded l;
  load_obj(&l, "mtllib none.mtl\n" SQUARE "usemtl what\nf 1 2 3\nf 1 2 4\nl 1 2\ncurv 0 1\n");
  assert_int_equal(l.result, VL_OK);
  assert_non_null(strstr(l.log, "t.obj:1:1: mtllib: there is no file \"none.mtl\""));
  assert_non_null(strstr(l.log, "no library has a material \"what\""));
  assert_non_null(strstr(l.log, "points and lines are balls and tubes"));
  end_load(&l);
  write_text("p.mtl", "newmtl a\nmap_Kd -s 2 2 C:\\away\\a b.png\n");
  load_obj(&l, "mtllib p.mtl\n" SQUARE "usemtl a\nf 1 2 3\n");
  assert_int_equal(l.result, VL_OK);
  assert_non_null(strstr(l.log, "there is no image \"C:/away/a b.png\""));
  end_load(&l);
}

static void errors(void **state) {
  (void)state;
  wrong("v 0 0 x\n", 1, 7, "v: \"x\" is not a finite number");
  wrong("v 0 0 nan\n", 1, 7, "is not a finite number");
  wrong("v 0 0\n", 1, 6, "v: 2 numbers, 3 are needed");
  wrong("v 0 0 1e39\n", 1, 7, "is not a finite number");
  wrong(SQUARE "f 1 2 9\n", 5, 7, "f: names vertex 9, but there are 4 so far");
  wrong(SQUARE "f 1 2 -5\n", 5, 7, "f: names vertex -5, but there are 4 so far");
  wrong(SQUARE "f 1 2 0\n", 5, 7, "f: names vertex 0");
  wrong(SQUARE "f 1/2 2 3\n", 5, 5, "f: names uv 2, but there are 0");
  wrong(SQUARE "f 1 2\n", 5, 6, "f: 2 corners, a face needs 3");
  wrong(SQUARE "f 1 2 3a\n", 5, 7, "is no corner");
  wrong(SQUARE "f 1 \\\n2 9\n", 5, 9, "names vertex 9");
  wrong("\x7f\x45\x4c\x46\x02\x01\x01", 1, 8, "not an OBJ file");
  write_text("bad.mtl", "newmtl a\nKd 1 1\n");
  Loaded l;
  load_obj(&l, "mtllib bad.mtl\n");
  assert_int_equal(l.result, VL_ERROR_SCENE);
  assert_non_null(strstr(l.error.file, "bad.mtl"));
  assert_int_equal(l.error.line, 2);
  end_load(&l);
}

/* Bytes changed at random: an error or a scene, never more, and no leak. */
static void damaged(void **state) {
  (void)state;
  static const char whole[] =
      "mtllib d.mtl\nv 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 2 1\nvt 0 0\nvt 1 "
      "0.5\nvn 0 0 1\no a\nusemtl a\n"
      "s 1\nf 1/1/1 2/2/1 3/1/1 4/2/1 5/1/1\nf -1 -2 -3\ng b\nusemtl b\nf 1//1 2//1 \\\n "
      "3//1\n";
  static const char library[] =
      "newmtl a\nKd 1 0 0\nmap_Kd -o 1 2 -s 3 none.png\nTr 0.2\nnewmtl b\nillum 7\nKe 1 1 1\n";
  for (uint32_t k = 0; k < 1500; k++) {
    char text[sizeof whole], mtl[sizeof library];
    memcpy(text, whole, sizeof whole);
    memcpy(mtl, library, sizeof library);
    for (uint32_t i = 0; i < 1 + k % 4; i++) {
      uint32_t h = vl_hash2(k, i);
      char *to = k & 1 ? text : mtl;
      to[(h >> 8) % (k & 1 ? sizeof text - 1 : sizeof mtl - 1)] =
          (h & 128 ? "0123456789-/ \n\\."[h & 15] : (char)(h & 127));
    }
    write_bytes("d.mtl", mtl, sizeof mtl - 1);
    write_bytes("d.obj", text, k % 7 ? sizeof text - 1 : vl_hash(k) % sizeof text);
    Loaded l;
    load(&l, "d.obj");
    assert_true(l.result == VL_OK || l.result == VL_ERROR_SCENE);
    end_load(&l);
  }
}

static vlResult load_again(vlContext *context, void *user) {
  (void)user;
  char path[200];
  vlScene *scene = NULL;
  vlError error = {0};
  snprintf(path, sizeof path, "%s/o.obj", folder);
  vlResult result = vl_scene_create(context, &scene);
  if (result == VL_OK)
    result = vl_scene_load(scene, path, NULL, &error);
  vl_scene_destroy(scene);
  return result;
}

static void memory(void **state) {
  (void)state;
  write_text("o.mtl", "newmtl a\nKd 1 0 0\nKe 1 1 1\nnewmtl b\nillum 7\n");
  write_text(
      "o.obj",
      "mtllib o.mtl\nv 0 0 0 1 1 1\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\nvt 0 0\ns 1\nusemtl a\n"
      "f 1/1 2/1 3/1 4/1\nusemtl b\nf 1 2 3 4 5\n");
  fail_everywhere(load_again, NULL, 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(corners), cmocka_unit_test(polygons),    cmocka_unit_test(smoothing),
      cmocka_unit_test(colors),  cmocka_unit_test(materials),   cmocka_unit_test(missing),
      cmocka_unit_test(errors),  cmocka_unit_test(damaged),     cmocka_unit_test(memory),
      cmocka_unit_test(maps),    cmocka_unit_test(partly_glass)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
