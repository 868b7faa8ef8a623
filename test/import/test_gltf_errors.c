/* test/import/test_gltf_errors.c: errors in glTF files are reported with their place. */
#include "import/gltf_load.h"
#include "velo/render.h"

/* What lies beyond the reach of rays is an error, not a crash. */
static void too_far(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  fine(&l, g, SCENE "\"nodes\":[{\"mesh\":0,\"scale\":[1e29,1,1]}]," SQUARE_MESH);
  vlWorld *world;
  vlError error;
  assert_int_equal(vl_world_build(l.scene, NULL, &world, &error), VL_ERROR_SCENE);
  assert_string_equal(
      error.message, "the shape reaches from 0 to 1e+29: rays can be followed to 1e18 at most");
  end_load(&l);
  free(g);
}

static void errors(void **state) {
  (void)state;
  static const struct {
    const char *rest, *message;
  } cases[] = {
      {SCENE "\"nodes\":[{\"mesh\":1}]," SQUARE_MESH,
       "nodes[0].mesh: 1: there are only 1 (0 to 0)"},
      {SCENE "\"nodes\":[{\"mesh\":\"a\"}]," SQUARE_MESH,
       "nodes[0].mesh: must be a whole number, found a string"},
      {SCENE "\"nodes\":[{\"mesh\":0,\"scale\":[1,2]}]," SQUARE_MESH,
       "nodes[0].scale: must hold 3 numbers, found 2"},
      {SCENE "\"nodes\":[{\"children\":[1]},{\"children\":[0]}]," SQUARE_MESH,
       "nodes[0]: is among its own children"},
      {SCENE "\"nodes\":[{\"children\":[1,1]},{}]," SQUARE_MESH,
       "nodes[0].children[1]: node 1 is already a child of node 0"},
      {"\"scenes\":[{\"nodes\":[7]}],\"nodes\":[{}]," SQUARE_MESH,
       "scenes[0].nodes[0]: there is no such node"},
      {SCENE "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
             "\"POSITION\":1}}]}]",
       "meshes[0].primitives[0].attributes.POSITION: must be of type VEC3"},
      {SCENE "\"nodes\":[{\"mesh\":0}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":0}]}]",
       "meshes[0].primitives[0].indices: must be SCALAR of unsigned whole numbers"},
      {SCENE "\"nodes\":[{\"mesh\":0}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":9}]}]",
       "meshes[0].primitives[0].mode: 9 is not from 0 to 6"},
      {SCENE "\"nodes\":[{\"mesh\":0}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2}]}]",
       "accessors[2]: 100 elements of 2 bytes do not fit into bufferViews[1], which has 12 "
       "bytes"},
      {SCENE "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
             "\"POSITION\":3}}]}]",
       "accessors[3].count: 4000000000 zeros are out of proportion to the file"},
      {"\"extensionsRequired\":[\"KHR_materials_iridescense\"],\"nodes\":[]",
       "extensionsRequired[0]: velo does not read KHR_material… (it reads "
       "KHR_materials_iridescence)"},
      {"\"extensionsRequired\":[\"MPEG_media\"],\"nodes\":[]",
       "extensionsRequired[0]: velo does not read MPEG_media"},
      {SCENE "\"nodes\":[{\"mesh\":0}],\"materials\":[{\"alphaMode\":\"GLASS\"}],\"meshes\":[{"
             "\"primitives\":[{"
             "\"attributes\":{\"POSITION\":0},\"material\":0}]}]",
       "materials[0].alphaMode: unknown name \"GLASS\" (known: OPAQUE, MASK, BLEND)"},
      {SCENE "\"nodes\":[{\"mesh\":0}],\"textures\":[{\"extensions\":{\"KHR_texture_basisu\":{"
             "\"source\":0}}}],"
             "\"materials\":[{\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0}}],"
             "\"meshes\":[{"
             "\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}]",
       "textures[0]: its image is there by KHR_texture_basisu only, which velo does not read"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Gltf *g = new_square();
    gltf_accessor(g, 1, 5123, 100, "SCALAR", NULL);
    gltf_accessor(g, -1, 5126, 4000000000u, "VEC3", NULL);
    Loaded l;
    load(&l, g, cases[i].rest, NULL);
    assert_true(l.result == VL_ERROR_SCENE || l.result == VL_ERROR_UNSUPPORTED);
    assert_string_equal(l.error.message, cases[i].message);
    assert_string_equal(l.error.file, in_folder("t.gltf"));
    end_load(&l);
    free(g);
  }
  /* broken JSON: line and column */
  const char *text = "{\"asset\":{\"version\":\"2.0\"},\n \"nodes\":[}";
  gltf_file(in_folder("b.gltf"), text, strlen(text));
  Loaded l;
  start_load(&l);
  assert_int_equal(vl_scene_load(l.scene, in_folder("b.gltf"), NULL, &l.error), VL_ERROR_SCENE);
  assert_int_equal(l.error.line, 2);
  assert_int_equal(l.error.column, 11);
  end_load(&l);
}

static void in_log(const Loaded *l, const char *words) {
  if (!strstr(l->log, words))
    fail_msg("no \"%s\" in:\n%s", words, l->log);
}

/* What the format does not have is ignored, with a line for each name; factors beyond their
 * range are brought back into it. */
static void misspelt(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  fine(
      &l, g,
      SCENE
      "\"nodes\":[{\"mesh\":0,\"extras\":{\"trnaslation\":1}}],\"extensions\":{\"KHR_xmp\":{},\"MINE_x\":{"
      "\"scalle\":1}},"
      "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColourFactor\":[1,1,1,1],"
      "\"roughnessFactor\":-3,"
      "\"metallicFactor\":2},\"other_name\":1,\"\":1,\"extensions\":{\"KHR_materials_ior\":{\"ior\":2,"
      "\"indx\":2}}},{\"other_name\":1,\"alphaMod\":1},{\"other_name\":1,\"alphaMod\":1,\"doubleSidedd\":true}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{"
      "\"POSITION\":0,\"NROMAL\":0,\"TEXCOORD_9\":0,\"_MINE\":0},\"material\":0}]}]");
  in_log(&l,
         "materials[0].pbrMetallicRoughness: unknown name \"baseColourFa…\" is ignored "
         "(did you mean \"baseColorFactor\"?)");
  in_log(&l, "attributes: unknown name \"NROMAL\" is ignored (did you mean \"NORMAL\"?)");
  in_log(&l,
         "materials[0]: unknown name \"other_name\" is ignored, here and in 2 other places");
  in_log(&l,
         "materials[1]: unknown name \"alphaMod\" is ignored (did you mean \"alphaMode\"?), "
         "here and in 1 other place");
  in_log(&l, "materials[0].extensions.KHR_materials_ior: unknown name \"indx\" is ignored");
  in_log(&l, "materials[0]: unknown name \"\" is ignored");
  in_log(
      &l,
      "materials[2]: unknown name \"doubleSidedd\" is ignored (did you mean \"doubleSided\"?)");
  in_log(&l, "extensions: MINE_x is ignored: velo does not read it");
  assert_null(strstr(l.log, "KHR_xmp"));
  in_log(&l, "roughnessFactor: -3 does not lie between 0 and 1: 0 is taken");
  in_log(&l, "metallicFactor: 2 does not lie between 0 and 1: 1 is taken");
  size_t unknown = 0;
  for (const char *at = l.log; (at = strstr(at, "unknown name")); at++)
    unknown++;
  assert_int_equal(unknown, 7);
  end_load(&l);
  free(g);
  /* no glTF, by the name */
  gltf_file(in_folder("b.glb"), "gltf", 4);
  start_load(&l);
  assert_int_equal(vl_scene_load(l.scene, in_folder("b.glb"), NULL, &l.error), VL_ERROR_SCENE);
  assert_string_equal(l.error.message, "no .glb: it does not begin with \"glTF\"");
  end_load(&l);
}

/* A file full of names has a line for each of the first 24. */
static void many_names(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  char text[4096] = SCENE "\"nodes\":[{\"mesh\":0";
  for (int i = 0; i < 40; i++)
    sprintf(text + strlen(text), ",\"name%d\":0", 100 + i);
  strcat(text, "}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]");
  fine(&l, g, text);
  in_log(&l, "nodes[0]: unknown name \"name123\" is ignored");
  in_log(&l, "16 members of further unknown names are ignored");
  assert_null(strstr(l.log, "name124"));
  end_load(&l);
  free(g);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(too_far), cmocka_unit_test(errors),
                                     cmocka_unit_test(misspelt), cmocka_unit_test(many_names)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
