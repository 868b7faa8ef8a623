/* test/import/test_repair.c: permissive loading: what is repaired, and that it is counted. */
#include "import/load.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/shape.h"
#include "velo/texture.h"

#define W "Film \"rgb\" WorldBegin\n"

static const char *folder(const char *name) {
  static char path[300];
  static char made[200];
  if (!made[0]) {
    snprintf(made, sizeof made, "%s/velo_repair_XXXXXX",
             getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
    assert_non_null(mkdtemp(made));
  }
  snprintf(path, sizeof path, "%s/%s", made, name);
  return path;
}

static void write_file(const char *name, const char *text) {
  FILE *f = fopen(folder(name), "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

static void load_named(Loaded *l, const char *name, bool permissive, bool strict) {
  start_load(l);
  vlLoadDef def = vl_default_load_def();
  def.permissive = permissive;
  def.strict = strict;
  l->result = vl_scene_load(l->scene, folder(name), &def, &l->error);
}

#define PLY                                                                                    \
  "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "     \
  "float "                                                                                     \
  "z\n"                                                                                        \
  "property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float " \
  "v\n"                                                                                        \
  "element face 2\nproperty list uchar int vertex_indices\nend_header\n"                       \
  "0 0 0  nan 0 0  0 0\n1 0 0  0 0 0  nan 0\n1 1 0  0 0 -1  1 1\n0 1 0  0 0 -1  0 1\n3 0 1 "   \
  "2\n3 "                                                                                      \
  "0 2 3\n"

static void check_normals(const Loaded *l) {
  const vlShapeDef *shape = &l->scene->shapes.items[0];
  for (int i = 0; i < 4; i++) { /* on the side of the others, against the winding */
    assert_near(shape->normals[3 * i], 0, 1e-6);
    assert_near(shape->normals[3 * i + 1], 0, 1e-6);
    assert_near(shape->normals[3 * i + 2], -1, 1e-6);
  }
  assert_near(shape->uvs[2], 0, 0);
}

static void meshes(void **state) {
  (void)state;
  Loaded l;
  write_file("m.ply", PLY);
  write_file("m.pbrt", W "Shape \"plymesh\" \"string filename\" \"m.ply\"");
  const char *const files[] = {"m.pbrt", "m.ply"};
  for (int i = 0; i < 2; i++) {
    load_named(&l, files[i], false, false);
    assert_int_equal(l.result, VL_ERROR_SCENE);
    end_load(&l);
    load_named(&l, files[i], true, false);
    assert_int_equal(l.result, VL_OK);
    check_normals(&l);
    assert_non_null(strstr(l.log, "repaired (zero or not finite): 2 normals, 1 uv in 1 shape"));
    end_load(&l);
  }
  write_file("m.obj",
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn nan 0 0\nvn 0 0 0\nvn 0 0 -1\nvt 0 0\nvt "
             "-nan(ind) 0\n"
             "f 1/1/1 2/2/2 3/1/3\nf 1/1/1 3/1/3 4/1/3\n");
  load_named(&l, "m.obj", true, false);
  assert_int_equal(l.result, VL_OK);
  assert_non_null(strstr(l.log, "repaired (zero or not finite): 2 normals, 1 uv in 1 shape"));
  end_load(&l);
}

/* The faces of a vertex are weighted by area. A zero normal is a normal of the file unless
 * permissive. */
static void zero_normals(void **state) {
  (void)state;
  Loaded l;
  const char *text = W
      "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  2 0 0  0 1 0  0 0 1 ] "
      "\"integer indices\" [ 0 1 2  0 3 1 ]\n"
      "\"normal N\" [ 0 0 0  0 0 1  0 0 1  0 1 0 ]";
  load_text(&l, text, false);
  assert_int_equal(l.result, VL_OK);
  assert_near(l.scene->shapes.items[0].normals[2], 0, 0);
  end_load(&l);
  load_text(&l, text, true);
  assert_int_equal(l.result, VL_OK);
  assert_near(l.scene->shapes.items[0].normals[1], sqrt(0.5), 1e-6);
  assert_near(l.scene->shapes.items[0].normals[2], sqrt(0.5), 1e-6);
  assert_non_null(strstr(l.log, ": 1 normal, 0 uvs"));
  end_load(&l);
}

static void images(void **state) {
  (void)state;
  Loaded l;
  const char *text = W
      "LightSource \"infinite\" \"string filename\" \"sky.exr\"\n"
      "LightSource \"goniometric\" \"string filename\" \"lamp.exr\"\n"
      "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"\n"
      "Texture \"b\" \"float\" \"imagemap\" \"string filename\" \"b.png\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"a\" \"string normalmap\" \"n.png\"\n"
      "Shape \"sphere\" \"texture alpha\" \"b\"";
  load_text(&l, text, false);
  assert_int_equal(l.result, VL_ERROR_MISSING);
  end_load(&l);
  load_text(&l, text, true);
  assert_int_equal(l.result, VL_OK);
  assert_int_equal(l.scene->lights.count, 1); /* a white sky; the lamp is left out */
  assert_null(l.scene->lights.items[0].path);
  assert_int_equal(l.scene->textures.count, 2);
  assert_int_equal(l.scene->textures.items[0].kind, VL_TEXTURE_CONSTANT);
  assert_near(l.scene->textures.items[0].spectrum_a.value.value, 0.5, 0);
  assert_near(l.scene->textures.items[1].float_a.value, 1, 0);
  assert_non_null(strstr(l.log, "t.pbrt:4:35: no such file: a.png; done without"));
  assert_non_null(strstr(l.log, "5 images are missing: done without"));
  end_load(&l);
}

/* glTF and OBJ do without an image unless strict. */
static void other_formats(void **state) {
  (void)state;
  Loaded l;
  write_file(
      "t.gltf",
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":["
      "{\"mesh\":0}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
      "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
      "\"baseColorFactor\":[1,0.5,"
      "0.25,1]},\"occlusionTexture\":{\"index\":0},\"normalTexture\":{\"index\":1}}],"
      "\"textures\":[{\"source\":0},{\"source\":1}],\"images\":[{\"uri\":\"gone.png\"},{"
      "\"uri\":\"https://"
      "example.org/a.png\"}],"
      "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":"
      "\"VEC3\",\"min\":[0,0,0],"
      "\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
      "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}");
  load_named(&l, "t.gltf", false, false);
  if (l.result != VL_OK)
    print_message("%s\n", l.error.message);
  assert_int_equal(l.result, VL_OK);
  assert_non_null(strstr(l.log, "gone.png; done without"));
  assert_non_null(strstr(l.log, "2 images are missing"));
  assert_int_equal(l.scene->textures.count, 0);
  assert_near(l.scene->materials.items[0].reflectance.value.rgb[1], 0.5, 1e-6);
  end_load(&l);
  load_named(&l, "t.gltf", false, true);
  assert_int_equal(l.result, VL_ERROR_MISSING);
  end_load(&l);
  write_file("t.mtl", "newmtl a\nmap_Kd gone.png\n");
  write_file("t.obj", "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  load_named(&l, "t.obj", false, false);
  assert_int_equal(l.result, VL_OK);
  assert_non_null(strstr(l.log, "1 image is missing"));
  end_load(&l);
  load_named(&l, "t.obj", false, true);
  assert_int_equal(l.result, VL_ERROR_MISSING);
  end_load(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(meshes), cmocka_unit_test(zero_normals),
                                     cmocka_unit_test(images), cmocka_unit_test(other_formats)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
