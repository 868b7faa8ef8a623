/* test/import/test_builder.c: statements for transforms, shapes, objects. */
#include "import/load.h"
#include "velo/shape_kinds.h"

#define W "WorldBegin\n"

static const double *shape_matrix(const Loaded *l, size_t i) {
  return l->scene->shapes.items[i].group_from_shape;
}

static void assert_matrix(const double *m, const double expected[16]) {
  for (int i = 0; i < 16; i++)
    assert_near(m[i], expected[i], 1e-12);
}

static void transforms(void **state) {
  (void)state;
  Loaded l;
  load_fine(
      &l, W
      "Translate 1 2 3 Shape \"sphere\"\n"
      "Scale 2 3 4 Shape \"sphere\"\n"
      "Identity Rotate 90 0 0 1 Shape \"sphere\"\n"
      "Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1 ] Shape \"sphere\"\n"
      "ConcatTransform [ 2 0 0 0  0 1 0 0  0 0 1 0  1 0 0 1 ] Shape \"sphere\"\n"
      "CoordinateSystem \"here\" Identity\n"
      "AttributeBegin Translate 9 9 9 Shape \"sphere\" AttributeEnd Shape \"sphere\"\n"
      "TransformBegin Translate 9 9 9 TransformEnd Shape \"sphere\"\n"
      "CoordSysTransform \"here\" Shape \"sphere\"\n"
      "CoordSysTransform \"world\" ActiveTransform StartTime Translate 1 0 0 ActiveTransform "
      "EndTime Translate 1 0 0\n"
      "ActiveTransform All TransformBegin TransformEnd Shape \"sphere\"\n");
  assert_matrix(shape_matrix(&l, 0),
                (double[]){1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1});
  assert_matrix(shape_matrix(&l, 1),
                (double[]){2, 0, 0, 1, 0, 3, 0, 2, 0, 0, 4, 3, 0, 0, 0, 1});
  assert_matrix(shape_matrix(&l, 2),
                (double[]){0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  assert_matrix(shape_matrix(&l, 3),
                (double[]){1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1});
  const double here[] = {2, 0, 0, 6, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1},
               one[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  assert_matrix(shape_matrix(&l, 4), here);
  assert_matrix(shape_matrix(&l, 5),
                (double[]){1, 0, 0, 9, 0, 1, 0, 9, 0, 0, 1, 9, 0, 0, 0, 1});
  assert_matrix(shape_matrix(&l, 6), one);
  assert_matrix(shape_matrix(&l, 7), one);
  assert_matrix(shape_matrix(&l, 8), here);
  assert_matrix(shape_matrix(&l, 9),
                (double[]){1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  end_load(&l);
}

static void shapes(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "Shape \"sphere\" \"float radius\" 2 \"float phimax\" 180\n"
            "Shape \"sphere\" \"float radius\" 2 \"float zmin\" -1 \"float zmax\" 1.5\n"
            "Shape \"disk\" \"float height\" 3 \"float innerradius\" .5\n"
            "Shape \"cylinder\" \"float zmin\" 4 \"float zmax\" -4\n"
            "ReverseOrientation\n"
            "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] "
            "\"integer indices\" [0 1 2 1 3 2]\n"
            "  \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1] \"vector3 S\" [1 0 0 1 0 0 1 0 0 1 0 0] "
            "\"point2 uv\" [0 0 1 0 0 1 1 1]\n"
            "  \"integer faceIndices\" [0 1]\n"
            "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0]\n"
            "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n"
            "Shape \"sphere\" \"float zmin\" 9 \"float zmax\" -.5\n");
  const vlShapeDef *s = l.scene->shapes.items;
  assert_near(s[0].z_min, -2, 0);
  assert_near(s[0].z_max, 2, 0);
  assert_near(s[0].phi_max, M_PI, 1e-6);
  assert_near(s[1].z_min, -1, 0);
  assert_near(s[1].z_max, 1.5, 0);
  assert_near(s[2].height, 3, 0);
  assert_near(s[2].inner_radius, .5, 0);
  assert_near(s[3].z_min, -4, 0);
  assert_false(s[3].reverse_orientation);
  assert_true(s[4].reverse_orientation);
  assert_int_equal(s[4].vertices, 4);
  assert_int_equal(s[4].faces, 2);
  assert_int_equal(s[4].indices[4], 3);
  assert_near(s[4].uvs[6], 1, 0);
  assert_near(s[4].normals[11], 1, 0);
  assert_near(s[4].tangents[9], 1, 0);
  assert_int_equal(s[5].faces, 1);
  assert_int_equal(s[5].indices[2], 2);
  assert_int_equal(s[6].kind, VL_SHAPE_BILINEAR);
  assert_int_equal(s[6].indices[3], 3);
  assert_near(s[7].z_min, -.5, 0); /* sorted and clamped, as in pbrt */
  assert_near(s[7].z_max, 1, 0);
  assert_int_equal(s[4].source.line, 7);
  end_load(&l);
}

static void objects(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "ObjectInstance \"late\"\n"
            "ObjectBegin \"thing\" Translate 1 0 0 Shape \"sphere\" Shape \"disk\" ObjectEnd\n"
            "Scale 2 2 2 ObjectInstance \"thing\" Shape \"sphere\"\n"
            "ObjectBegin \"late\" Shape \"sphere\" ObjectEnd\n");
  const vlScene *s = l.scene;
  assert_int_equal(s->groups.count, 2);
  assert_int_equal(s->instances.count, 2);
  assert_string_equal(s->groups.items[0].name, "late");
  assert_int_equal(s->groups.items[0].shape_count, 1);
  assert_int_equal(s->groups.items[1].shape_count, 2);
  assert_int_equal(s->shapes.items[0].group.index, 2);
  assert_near(s->shapes.items[0].group_from_shape[3], 1, 0);
  assert_near(s->instances.items[1].world_from_group[0], 2, 0);
  assert_near(s->instances.items[1].world_from_group[3], 0, 0);
  assert_int_equal(s->shapes.items[2].group.index, 0);
  end_load(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(transforms),
      cmocka_unit_test(shapes),
      cmocka_unit_test(objects),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
