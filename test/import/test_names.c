/* test/import/test_names.c: names of files reach shapes, materials and instances: glTF, OBJ,
 * PLY. */
#include "import/gltf_load.h"
#include "velo/check.h"
#include "velo/shape.h"

static void is_label(const vlLabel *l, const char *name, const char *path, const char *place) {
  assert_string_equal(l->name, name);
  if (path)
    assert_string_equal(l->path, path);
  if (place)
    assert_string_equal(l->place, place);
}

#define PRIMITIVE "{\"attributes\":{\"POSITION\":0},\"indices\":1"

/* Nodes of the same name get their parents; a mesh without primitives' names gets its
 * materials. */
static void gltf_nodes(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  fine(&l, g,
       "\"scenes\":[{\"nodes\":[0,3,6,7,8,9]}],"
       "\"nodes\":[{\"name\":\"Hall\",\"children\":[1,2]},{\"name\":\"Chair\",\"mesh\":0},"
       "{\"name\":\"Table\",\"mesh\":1},{\"name\":\"Kitchen\",\"children\":[4,5]},"
       "{\"name\":\"Chair\",\"mesh\":2},{\"mesh\":3},{\"name\":\"Lamp\",\"mesh\":4},"
       "{\"name\":\"Lamp\",\"mesh\":5},{\"mesh\":6},{\"name\":\"Lamp#7\",\"mesh\":7}],"
       "\"meshes\":[{\"primitives\":[" PRIMITIVE
       "}]},"
       "{\"name\":\"Top\",\"primitives\":[" PRIMITIVE ",\"material\":0}," PRIMITIVE
       ",\"material\":1}," PRIMITIVE
       ",\"material\":1}]},"
       "{\"primitives\":[" PRIMITIVE
       ",\"material\":2}]},{\"name\":\"Sink\",\"primitives\":[" PRIMITIVE
       "}]},"
       "{\"primitives\":[" PRIMITIVE "}]},{\"primitives\":[" PRIMITIVE
       "}]},{\"primitives\":[" PRIMITIVE
       "}]},"
       "{\"primitives\":[" PRIMITIVE
       "}]}],"
       "\"materials\":[{\"name\":\"Wood\"},{\"name\":\"Steel\"},{\"name\":\"Wood\"},{}]");
  is_label(&shape(&l, 0)->label, "Hall/Chair", "Hall/Chair",
           "nodes[1].meshes[0].primitives[0]");
  is_label(&shape(&l, 1)->label, "Table/Wood", "Hall/Table/Top/Wood",
           "nodes[2].meshes[1].primitives[0]");
  is_label(&shape(&l, 2)->label, "Table/1", "Hall/Table/Top/Steel",
           "nodes[2].meshes[1].primitives[1]");
  is_label(&shape(&l, 3)->label, "Table/2", NULL, NULL);
  is_label(&shape(&l, 4)->label, "Kitchen/Chair", "Kitchen/Chair/Wood", NULL);
  is_label(&shape(&l, 5)->label, "Sink", "Kitchen/Sink", "nodes[5].meshes[3].primitives[0]");
  is_label(&shape(&l, 6)->label, "Lamp", NULL, NULL);
  is_label(&shape(&l, 7)->label, "Lamp#7", NULL, NULL);
  is_label(&shape(&l, 8)->label, "nodes[8]", NULL, NULL);
  is_label(&shape(&l, 9)->label, "Lamp#7#9", NULL, NULL);
  vlIdInfo info;
  assert_int_equal(vl_scene_id_count(l.scene, VL_ID_OBJECT), 10);
  assert_int_equal(vl_scene_id_info(l.scene, VL_ID_OBJECT, 5, &info), VL_OK);
  assert_string_equal(info.name, "Kitchen/Chair");
  assert_int_equal(vl_scene_id_info(l.scene, VL_ID_MATERIAL, info.material, &info), VL_OK);
  assert_string_equal(info.name, "Wood#2");
  assert_string_equal(info.place, "materials[2]");
  assert_int_equal(vl_scene_id_info(l.scene, VL_ID_OBJECT, 11, &info), VL_ERROR_ARGUMENT);
  end_load(&l);
  free(g);
}

/* A mesh that several nodes place is called by the mesh; its instances by the nodes. */
static void gltf_instances(void **state) {
  (void)state;
  Gltf *g = new_square();
  const float places[] = {0, 0, 0, 1, 0, 0};
  gltf_floats(g, places, 2, "VEC3", 3);
  Loaded l;
  fine(&l, g,
       "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"name\":\"A\",\"mesh\":0},{\"name\":\"B\","
       "\"mesh\":0,"
       "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":2}}}}],"
       "\"meshes\":[{\"name\":\"Pawn\",\"primitives\":[" PRIMITIVE "}]}]");
  assert_int_equal(l.scene->shapes.count, 1);
  is_label(&shape(&l, 0)->label, "Pawn", "Pawn", "meshes[0].primitives[0]");
  assert_int_equal(l.scene->instances.count, 3);
  is_label(&l.scene->instances.items[0].label, "A", "A", "nodes[0]");
  is_label(&l.scene->instances.items[1].label, "B/0", "B/0", "nodes[1].copies[0]");
  is_label(&l.scene->instances.items[2].label, "B/1", "B/1", "nodes[1].copies[1]");
  vlIdInfo info;
  assert_int_equal(vl_scene_id_info(l.scene, VL_ID_INSTANCE, 3, &info), VL_OK);
  assert_string_equal(info.name, "B/1");
  assert_false(info.shared_name);
  end_load(&l);
  free(g);
}

static void choices(void **state) {
  (void)state;
  Gltf *g = new_square();
  const float times[] = {0, 4}, places[] = {0, 0, 0, 8, 0, 0};
  gltf_accessor(g, gltf_view(g, times, sizeof times, 0), 5126, 2, "SCALAR",
                ",\"min\":[0],\"max\":[4]");
  gltf_floats(g, places, 2, "VEC3", 3);
  Loaded l;
  fine(&l, g,
       SCENE
       "\"nodes\":[{\"mesh\":0,\"children\":[1]},{\"name\":\"Front\",\"camera\":0}],"
       "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":0.1}}],"
       "\"animations\":[{\"name\":\"Walk\",\"samplers\":[{\"input\":2,\"output\":3}],"
       "\"channels\":[]}],\"extensionsUsed\":[\"KHR_materials_variants\"],"
       "\"extensions\":{\"KHR_materials_variants\":{\"variants\":[{\"name\":\"red\"},"
       "{\"name\":\"blue\"}]}}," SQUARE_MESH);
  vlChoiceInfo info;
  assert_int_equal(vl_scene_choice_count(l.scene, VL_CHOICE_VARIANT), 2);
  assert_int_equal(vl_scene_choice_info(l.scene, VL_CHOICE_VARIANT, 1, &info), VL_OK);
  assert_string_equal(info.name, "blue");
  assert_int_equal(vl_scene_choice_info(l.scene, VL_CHOICE_ANIMATION, 0, &info), VL_OK);
  assert_string_equal(info.name, "Walk");
  assert_true(info.seconds == 4);
  assert_int_equal(vl_scene_choice_info(l.scene, VL_CHOICE_CAMERA, 0, &info), VL_OK);
  assert_string_equal(info.name, "Front");
  assert_int_equal(vl_scene_choice_info(l.scene, VL_CHOICE_CAMERA, 1, &info),
                   VL_ERROR_ARGUMENT);
  end_load(&l);
  free(g);
}

static void load_file(Loaded *l, const char *name, const char *text) {
  FILE *f = fopen(in_folder(name), "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
  start_load(l);
  l->result = vl_scene_load(l->scene, in_folder(name), NULL, &l->error);
  assert_int_equal(l->result, VL_OK);
}

static void obj(void **state) {
  (void)state;
  Loaded l;
  load_file(
      &l, "room.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\no Chair\nusemtl wood\nf 1 2 3\nusemtl steel\nf 1 "
      "2 3\ng seat\nf 1 2 3\n"
      "o Lamp\nf 1 2 3\no Lamp\nf 1 2 3\n");
  is_label(&shape(&l, 0)->label, "room", NULL, NULL);
  is_label(&shape(&l, 1)->label, "Chair/wood", "Chair/wood", NULL);
  is_label(&shape(&l, 2)->label, "Chair/steel", "Chair/steel", NULL);
  is_label(&shape(&l, 3)->label, "Chair/seat", "Chair/seat/steel", NULL);
  is_label(&shape(&l, 4)->label, "Lamp", NULL, NULL);
  is_label(&shape(&l, 5)->label, "Lamp#15", NULL, NULL);
  assert_int_equal(shape(&l, 3)->source.line, 11);
  end_load(&l);
}

static void ply(void **state) {
  (void)state;
  Loaded l;
  load_file(
      &l, "bunny.v2.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 "
      "0\n3 0 1 2\n");
  is_label(&shape(&l, 0)->label, "bunny.v2", NULL, NULL);
  end_load(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gltf_nodes), cmocka_unit_test(gltf_instances),
      cmocka_unit_test(choices),    cmocka_unit_test(obj),
      cmocka_unit_test(ply),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
