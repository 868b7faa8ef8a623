/* test/render/test_shapes.c: equivalent descriptions give the same image: instances and
 * transformed geometry, patches and triangles, spheres and their meshes, holes by alpha and
 * holes by geometry. */
#include "render/shots.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

static void stage_light(Stage *s) {
  add_sky(s, 0.5f);
  add_point(s, 3, 4, 2, 30);
  s->render.spp = 16;
  s->render.max_depth = 3;
  s->camera.fov = 0.8;
}

static void assert_same(const char *what, Image *a, Image *b, double share, double mean) {
  double differing = image_differing(a, b, 0.02);
  if (differing > share)
    fail_msg("%s: %.1f %% of the pixels differ", what, 100 * differing);
  for (int c = 0; c < 4; c++)
    assert_ratio(what, image_mean(b, c), image_mean(a, c), mean);
  assert_int_equal(a->stats.not_finite, 0);
  assert_int_equal(b->stats.not_finite, 0);
  image_free(a);
  image_free(b);
}

/* ---- instances --------------------------------------------------------------------------- */

enum { MESH, SMOOTH_MESH, SPHERE, PART_SPHERE, DISK, CYLINDER, PATCH, KINDS };
static const char *const kind_name[KINDS] = {
    "mesh", "smooth mesh", "sphere", "part of a sphere", "disk", "cylinder", "patch"};

static const float patch_corners[12] = {-1, -1, 0.3f, 1, -1, -0.4f, -1, 1, -0.3f, 1, 1, 0.5f};
static const uint32_t patch_index[4] = {0, 1, 2, 3};

static void add_kind(Stage *s, int kind, vlGroupId group, const double m[16],
                     vlMaterialId material, bool reverse) {
  float *block = NULL;
  vlShapeDef def;
  switch (kind) {
    case MESH:
      def = mesh_sphere(10, 1, false, &block);
      break;
    case SMOOTH_MESH:
      def = mesh_sphere(10, 1, true, &block);
      break;
    case SPHERE:
      def = vl_default_shape_def(VL_SHAPE_SPHERE);
      break;
    case PART_SPHERE:
      def = vl_default_shape_def(VL_SHAPE_SPHERE);
      def.z_min = -0.5f;
      def.z_max = 0.8f;
      def.phi_max = 4;
      break;
    case DISK:
      def = vl_default_shape_def(VL_SHAPE_DISK);
      def.inner_radius = 0.3f;
      def.height = 0.2f;
      def.phi_max = 5;
      break;
    case CYLINDER:
      def = vl_default_shape_def(VL_SHAPE_CYLINDER);
      def.z_min = -0.7f;
      def.z_max = 0.6f;
      def.radius = 0.8f;
      def.phi_max = 4.5f;
      break;
    default:
      def = vl_default_shape_def(VL_SHAPE_BILINEAR);
      def.vertices = 4;
      def.faces = 1;
      def.positions = patch_corners;
      def.indices = patch_index;
  }
  def.group = group;
  def.material = material;
  def.reverse_orientation = reverse;
  memcpy(def.group_from_shape, m, sizeof def.group_from_shape);
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
  free(block);
}

static void multiply(const double a[16], const double b[16], double r[16]) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      double sum = 0;
      for (int k = 0; k < 4; k++)
        sum += a[4 * i + k] * b[4 * k + j];
      r[4 * i + j] = sum;
    }
}

static void instances_are_baked_geometry(void **state) {
  (void)state;
  double identity[16], inner[16], outer[4][16];
  set_matrix(identity, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
  set_matrix(inner, 0.9, 0.2, 0, 0.1, -0.2, 0.9, 0.1, 0, 0, -0.1, 0.9, 0.2);
  set_matrix(outer[0], 1, 0, 0, 0.2, 0, 1, 0, -0.1, 0, 0, 1, -4);
  /* turned, stretched */
  set_matrix(outer[1], 0.6, -0.5, 0, 0, 0.5, 0.6, 0.3, 0.2, 0, -0.3, 1.4, -4);
  set_matrix(outer[2], -1, 0, 0, 0, 0, 0.8, 0.4, 0, 0, -0.4, 0.8, -4); /* mirrored */
  /* mirrored, sheared */
  set_matrix(outer[3], 0.7, 0.1, 0.3, 0, 0.2, -1.2, 0, 0, 0.1, 0.3, 0.9, -5);
  for (int kind = 0; kind < KINDS; kind++)
    for (int m = 0; m < 4; m++) {
      /* Glass shows which side is which; only closed shapes have an inside. */
      bool glass = kind <= SPHERE && m != 1, reverse = m == 3;
      Image p[2];
      for (int way = 0; way < 2; way++) {
        Stage s = stage_open(48, 36);
        stage_light(&s);
        vlMaterialDef def =
            vl_default_material_def(glass ? VL_MATERIAL_DIELECTRIC : VL_MATERIAL_DIFFUSE);
        vlMaterialId material = vl_scene_add_material(s.scene, &def);
        double baked[16];
        multiply(outer[m], inner, baked);
        if (way == 0) { /* a shape's own mirror turns the normals of quadrics, an instance's
                           does not */
          bool quadric =
              kind == SPHERE || kind == PART_SPHERE || kind == DISK || kind == CYLINDER;
          add_kind(&s, kind, (vlGroupId){0}, baked, material, reverse != (quadric && m > 1));
        } else {
          vlGroupId group = vl_scene_add_group(s.scene, "group");
          add_kind(&s, kind, group, inner, material, reverse);
          vl_scene_add_instance(s.scene, group, outer[m], (vlSource){0});
        }
        p[way] = stage_finish(&s);
      }
      char what[64];
      snprintf(what, sizeof what, "%s, transform %d", kind_name[kind], m);
      /* Glass and the sphere's silhouette multiply rounding: a few pixels may take other
       * paths. */
      assert_same(what, &p[0], &p[1], glass ? 0.04 : 0.02, 2e-3);
    }
}

static void one_group_many_places(void **state) {
  (void)state;
  Image p[2];
  for (int way = 0; way < 2; way++) {
    Stage s = stage_open(48, 36);
    stage_light(&s);
    vlMaterialId red = add_diffuse(&s, 0.8f, 0.2f, 0.1f),
                 grey = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
    vlGroupId group = way ? vl_scene_add_group(s.scene, "pair") : (vlGroupId){0};
    for (int k = 0; k < 3; k++) {
      double place[16], a[16], b[16], first[16], second[16];
      set_matrix(place, 0.4, 0, 0, k - 1, 0, 0.4, 0, 0.2 * k, 0, 0, 0.4, -3.5 - 0.3 * k);
      set_matrix(a, 1, 0, 0, -0.6, 0, 1, 0, 0, 0, 0, 1, 0);
      set_matrix(b, 0.5, 0, 0, 0.8, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0.4);
      if (way) {
        if (k == 0) {
          add_kind(&s, SPHERE, group, a, red, false);
          add_kind(&s, CYLINDER, group, b, grey, false);
        }
        vl_scene_add_instance(s.scene, group, place, (vlSource){0});
      } else {
        multiply(place, a, first);
        multiply(place, b, second);
        add_kind(&s, SPHERE, group, first, red, false);
        add_kind(&s, CYLINDER, group, second, grey, false);
      }
    }
    p[way] = stage_finish(&s);
  }
  assert_same("three places", &p[0], &p[1], 0.02, 2e-3);
}

/* ---- shapes that are other shapes -------------------------------------------------------- */

static void fine_mesh_is_the_sphere(void **state) {
  (void)state;
  for (int emissive = 0; emissive < 2; emissive++) {
    Image p[2];
    for (int way = 0; way < 2; way++) {
      Stage s = stage_open(48, 36);
      if (!emissive)
        stage_light(&s);
      s.camera.fov = 0.8;
      s.render.spp = 64;
      float *block = NULL;
      vlShapeDef def =
          way ? mesh_sphere(64, 1, true, &block) : vl_default_shape_def(VL_SHAPE_SPHERE);
      set_matrix(def.group_from_shape, 0.6, 0, 0, 0.3, 0, 0.6, 0, 0.3, 0, 0, 0.6, -4);
      if (emissive)
        def.emission = add_emission(&s, 2, false);
      vl_scene_add_shape(s.scene, &def);
      free(block);
      Quad floor = quad_at(0, -0.6f, -4, 3, 0, 0, 0, 0, -3);
      floor.material = add_diffuse(&s, 0.6f, 0.6f, 0.6f);
      add_quad(&s, &floor);
      p[way] = stage_finish(&s);
    }
    assert_ratio("mesh of a sphere", image_mean(&p[1], 1), image_mean(&p[0], 1), 0.004);
    double differing = image_differing(&p[0], &p[1], 0.1);
    if (differing > 0.06)
      fail_msg("mesh of a sphere: %.1f %% of the pixels differ", 100 * differing);
    image_free(&p[0]);
    image_free(&p[1]);
  }
}

/* The near plane cuts off the front of a sphere, so the inside of its back is visible, as
 * through a partial sphere. */
static void near_plane_opens_a_sphere(void **state) {
  (void)state;
  Image p[2];
  for (int way = 0; way < 2; way++) {
    Stage s = stage_open(48, 36);
    add_point(&s, 0, 0, -4, 1);
    s.camera.fov = 0.5;
    s.render.max_depth = 1;
    s.camera.near_plane = way ? 0 : 4;
    vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
    set_matrix(def.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -4);
    if (way)
      def.z_max = 0;
    vl_scene_add_shape(s.scene, &def);
    p[way] = stage_finish(&s);
  }
  assert_true(image_mean(&p[0], 1) > 0.05);
  assert_same("opened sphere", &p[0], &p[1], 0.02, 2e-3);
}

/* A flat patch and its two triangles: as a surface, with a texture, and as a light. */
static void flat_patch_is_two_triangles(void **state) {
  (void)state;
  for (int emissive = 0; emissive < 2; emissive++) {
    Image p[2];
    for (int way = 0; way < 2; way++) {
      Stage s = stage_open(48, 36);
      if (!emissive)
        stage_light(&s);
      s.render.spp = emissive ? 64 : 16;
      s.camera.fov = 0.8;
      vlTextureDef checks = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, true);
      checks.su = 4;
      checks.sv = 3;
      checks.spectrum_b = vl_spectrum_input(vl_spectrum_constant(0.2f));
      Quad q = quad_at(0.2f, 0.3f, -4, 1, 0.2f, 0.3f, -0.1f, 0.8f, 0.2f);
      q.patch = way;
      q.material = add_textured(&s, vl_scene_add_texture(s.scene, &checks));
      if (emissive)
        q.emission = add_emission(&s, 1, false);
      add_quad(&s, &q);
      Quad floor = quad_at(0, -1, -3.5f, 3, 0, 0, 0, 0, -3);
      floor.material = add_diffuse(&s, 0.6f, 0.6f, 0.6f);
      add_quad(&s, &floor);
      p[way] = stage_finish(&s);
    }
    if (!emissive) {
      assert_same("flat patch", &p[0], &p[1], 0.01, 2e-3);
      continue;
    }
    for (uint32_t y = 0; y < 36; y += 12) /* by blocks: the two are sampled in different ways */
      for (uint32_t x = 0; x < 48; x += 12) {
        double a = image_region(&p[0], x, y, x + 12, y + 12, 1),
               b = image_region(&p[1], x, y, x + 12, y + 12, 1);
        assert_near("light of a flat patch", b, a, 0.01 * a + 2e-3);
      }
    image_free(&p[0]);
    image_free(&p[1]);
  }
}

/* ---- alpha ------------------------------------------------------------------------------- */

static vlTextureId checks(Stage *s, float su, float sv, float a, float b) {
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, false);
  def.float_a = vl_float_input(a);
  def.float_b = vl_float_input(b);
  def.su = su;
  def.sv = sv;
  return vl_scene_add_texture(s->scene, &def);
}

/* A black card of coverage 1/2 before a white sky, as each kind of shape. */
static void half_a_card_lets_half_through(void **state) {
  (void)state;
  for (int kind = 0; kind < 3; kind++) {
    Stage s = stage_open(48, 36);
    add_sky(&s, 1);
    s.render.spp = 64;
    Quad card = quad_at(0, 0, -1, 9, 0, 0, 0, 9, 0);
    card.material = add_diffuse(&s, 0, 0, 0);
    card.alpha = vl_float_input(0.3f);
    card.patch = kind == 1;
    if (kind < 2) {
      add_quad(&s, &card);
    } else {
      vlShapeDef disk = vl_default_shape_def(VL_SHAPE_DISK);
      disk.radius = 20;
      disk.height = -1;
      disk.material = card.material;
      disk.alpha = card.alpha;
      vl_scene_add_shape(s.scene, &disk);
    }
    Image p = stage_finish(&s);
    /* 48 * 36 * 64 coin throws: deviation 0.0014 */
    assert_near("light through a card of coverage 0.3", image_mean(&p, 1), 0.7, 0.006);
    assert_near("pixels met", image_mean(&p, 3), 0.3, 0.006);
    image_free(&p);
  }
}

/* A ray crosses a sphere twice, and a mesh's two instances: each crossing is decided for
 * itself. */
static void coverage_multiplies(void **state) {
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    Stage s = stage_open(48, 36);
    add_sky(&s, 1);
    s.render.spp = 64;
    s.camera.fov = 0.1;
    vlMaterialId black = add_diffuse(&s, 0, 0, 0);
    if (kind == 0) {
      vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
      set_matrix(def.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -4);
      def.material = black;
      def.alpha = vl_float_input(0.5f);
      vl_scene_add_shape(s.scene, &def);
    } else {
      Quad card = quad_at(0, 0, -4, 2, 0, 0, 0, 2, 0);
      card.material = black;
      card.alpha = vl_float_input(0.5f);
      card.group = vl_scene_add_group(s.scene, "card");
      add_quad(&s, &card);
      double a[16], b[16];
      set_matrix(a, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
      set_matrix(b, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1);
      vl_scene_add_instance(s.scene, card.group, a, (vlSource){0});
      vl_scene_add_instance(s.scene, card.group, b, (vlSource){0});
    }
    Image p = stage_finish(&s);
    assert_near(kind ? "two cards of coverage 1/2" : "sphere of coverage 1/2",
                image_mean(&p, 1), 0.25, 0.006);
    image_free(&p);
  }
}

static void half_a_card_casts_half_a_shadow(void **state) {
  (void)state;
  double value[3];
  for (int coverage = 0; coverage < 3; coverage++) {
    Stage s = stage_open(48, 36);
    s.render.spp = 64;
    vlLightDef sun = vl_default_light_def(VL_LIGHT_DISTANT);
    sun.from[1] = 1;
    sun.to[2] = 0;
    vl_scene_add_light(s.scene, &sun);
    Quad floor = quad_at(0, -1, 0, 50, 0, 0, 0, 0, -50),
         card = quad_at(0, 5, 0, 90, 0, 0, 0, 0, -90);
    floor.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
    card.material = add_diffuse(&s, 0, 0, 0);
    card.alpha = vl_float_input(0.5f * (float)coverage);
    add_quad(&s, &floor);
    add_quad(&s, &card);
    s.camera.lookat[1] = -2;
    Image p = stage_finish(&s);
    value[coverage] = image_mean(&p, 1);
    image_free(&p);
  }
  assert_ratio("no card", value[0], 0.5 / M_PI, 2e-3);
  assert_ratio("half a card", value[1], 0.25 / M_PI, 0.01);
  assert_near("a whole card", value[2], 0, 0);
}

/* Coverage by a chequered texture, and the checks as geometry; on the card stands shaded
 * surface, behind it another. */
static void alpha_holes_are_holes(void **state) {
  (void)state;
  for (int kind = 0; kind < 3; kind++) { /* triangles, patch, instanced triangles */
    Image p[2];
    for (int way = 0; way < 2; way++) {
      Stage s = stage_open(64, 48);
      stage_light(&s);
      vlMaterialId red = add_diffuse(&s, 0.7f, 0.2f, 0.2f),
                   grey = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
      Quad wall = quad_at(0, 0, -5, 4, 0, 0, 0, 4, 0);
      wall.material = grey;
      add_quad(&s, &wall);
      vlGroupId group = kind == 2 ? vl_scene_add_group(s.scene, "cards") : (vlGroupId){0};
      if (way == 0) {
        Quad card = quad_at(0, 0, -3, 1, 0, 0, 0, 1, 0);
        card.material = red;
        card.patch = kind == 1;
        card.group = group;
        card.alpha.texture = checks(&s, 4, 4, 1, 0);
        add_quad(&s, &card);
      }
      for (int i = 0; i < 16 && way == 1; i++)
        if (((i & 3) + (i >> 2)) % 2 == 0) {
          Quad cell = quad_at(-0.75f + 0.5f * (float)(i & 3), -0.75f + 0.5f * (float)(i >> 2),
                              -3, 0.25f, 0, 0, 0, 0.25f, 0);
          cell.material = red;
          cell.patch = kind == 1;
          cell.group = group;
          add_quad(&s, &cell);
        }
      double place[16];
      set_matrix(place, 0.9, -0.3, 0, 0.1, 0.3, 0.9, 0, 0, 0, 0, 1, 0.2);
      if (group.index)
        vl_scene_add_instance(s.scene, group, place, (vlSource){0});
      p[way] = stage_finish(&s);
    }
    assert_same("chequered card", &p[0], &p[1], 0.03, 2e-3);
  }
}

/* Half a sphere made by alpha equals the half sphere: the inside of the far half is visible
 * through the hole, not the near half. */
static void half_a_sphere_by_alpha(void **state) {
  (void)state;
  for (int instanced = 0; instanced < 2; instanced++) {
    Image p[2];
    for (int way = 0; way < 2; way++) {
      Stage s = stage_open(64, 48);
      stage_light(&s);
      add_point(&s, 0, 0, -2.5f, 0.3f);
      vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
      def.material = add_diffuse(&s, 0.7f, 0.5f, 0.3f);
      def.phi_max = way ? (float)M_PI : 2 * (float)M_PI;
      if (!way)
        def.alpha.texture = checks(&s, 2, 1, 1, 0);
      double place[16], identity[16];
      set_matrix(identity, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
      /* the half y > 0 of the shape is turned to -z */
      set_matrix(place, 1, 0, 0, 0, 0, 0, 1, 0.1, 0, -1, 0, -3);
      def.group = instanced ? vl_scene_add_group(s.scene, "ball") : (vlGroupId){0};
      if (!instanced)
        memcpy(def.group_from_shape, place, sizeof place);
      vl_scene_add_shape(s.scene, &def);
      if (instanced)
        vl_scene_add_instance(s.scene, def.group, place, (vlSource){0});
      p[way] = stage_finish(&s);
    }
    assert_same("half a sphere", &p[0], &p[1], 0.03, 3e-3);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(instances_are_baked_geometry),
      cmocka_unit_test(one_group_many_places),
      cmocka_unit_test(near_plane_opens_a_sphere),
      cmocka_unit_test(fine_mesh_is_the_sphere),
      cmocka_unit_test(flat_patch_is_two_triangles),
      cmocka_unit_test(half_a_card_lets_half_through),
      cmocka_unit_test(half_a_card_casts_half_a_shadow),
      cmocka_unit_test(coverage_multiplies),
      cmocka_unit_test(alpha_holes_are_holes),
      cmocka_unit_test(half_a_sphere_by_alpha),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
