/* test/render/test_tight.c: no self-intersection and no leaks between faces, at any size, far
 * from the origin and inside distant instances. A closed emissive room shows both: a leak
 * darkens it (outside is black), self-intersection brightens or darkens it. */
#include "render/shots.h"
#include "velo/sampler.h"
#include "velo/shape_kinds.h"

typedef struct Room {
  double size;    /* radius */
  double offset;  /* of the middle, in sizes, along (1, 0.7, -0.4) */
  bool instanced; /* the offset is the instance's */
  int kind;       /* 0 mesh, 1 smooth mesh, 2 sphere, 3 box of triangles, 4 box of patches */
} Room;

static const char *const room_name[5] = {"mesh", "smooth mesh", "sphere", "box",
                                         "box of patches"};

static void add_box(Stage *s, const double m[16], vlMaterialId material, vlEmissionId emission,
                    vlGroupId group, bool patch, bool reverse) {
  static const float p[24] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1,
                              -1, -1, 1,  1, -1, 1,  -1, 1, 1,  1, 1, 1};
  static const uint32_t quads[24] = {0, 2, 1, 3, 4, 5, 6, 7, 0, 1, 4, 5,
                                     2, 6, 3, 7, 0, 4, 2, 6, 1, 3, 5, 7};
  uint32_t triangles[36];
  for (int i = 0; i < 6; i++) {
    const uint32_t *q = quads + 4 * i, f[6] = {q[0], q[1], q[3], q[0], q[3], q[2]};
    memcpy(triangles + 6 * i, f, sizeof f);
  }
  vlShapeDef def = vl_default_shape_def(patch ? VL_SHAPE_BILINEAR : VL_SHAPE_TRIANGLES);
  def.vertices = 8;
  def.faces = patch ? 6 : 12;
  def.positions = p;
  def.indices = patch ? quads : triangles;
  def.material = material;
  def.emission = emission;
  def.group = group;
  def.reverse_orientation = reverse;
  memcpy(def.group_from_shape, m, sizeof def.group_from_shape);
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

/* Mean over the image of a closed room whose walls, of reflectance 0.9, are lit by a point
 * light inside (instanced surfaces emit no light): expected value from the same room at size 1
 * around the origin. */
static double room_mean(Room r, bool sky) {
  Stage s = stage_open(24, 24);
  const double way[3] = {1, 0.7, -0.4};
  double place[16], at[3];
  for (int i = 0; i < 3; i++)
    at[i] = r.offset * r.size * way[i];
  s.render.spp = s.render.sequence = 8;
  s.render.max_depth = 20;
  for (int i = 0; i < 3; i++) {
    s.camera.eye[i] = at[i] + 0.2 * r.size * (i == 0);
    s.camera.lookat[i] = at[i] + r.size * (0.3 * i - 0.5);
  }
  vlMaterialId wall = add_diffuse(&s, 0.9f, 0.9f, 0.9f);
  vlGroupId group = r.instanced ? vl_scene_add_group(s.scene, "room") : (vlGroupId){0};
  double k = r.size,
         own[3] = {r.instanced ? 0 : at[0], r.instanced ? 0 : at[1], r.instanced ? 0 : at[2]};
  /* turned: no aligned walls */
  set_matrix(place, 0.8 * k, -0.6 * k, 0, own[0], 0.6 * k, 0.8 * k, 0, own[1], 0, 0, k, own[2]);
  float *block = NULL;
  if (r.kind < 3) {
    vlShapeDef def = r.kind < 2 ? mesh_sphere(12, 1, r.kind == 1, &block)
                                : vl_default_shape_def(VL_SHAPE_SPHERE);
    memcpy(def.group_from_shape, place, sizeof place);
    def.material = wall;
    def.group = group;
    def.reverse_orientation = true;
    vl_scene_add_shape(s.scene, &def);
  } else {
    add_box(&s, place, wall, (vlEmissionId){0}, group, r.kind == 4, true);
  }
  free(block);
  if (r.instanced) {
    double far[16];
    set_matrix(far, 1, 0, 0, at[0], 0, 1, 0, at[1], 0, 0, 1, at[2]);
    vl_scene_add_instance(s.scene, group, far, (vlSource){0});
  }
  if (sky)
    add_sky(&s, 1);
  else
    add_point(&s, (float)at[0], (float)(at[1] + 0.1 * k), (float)at[2], (float)(k * k));
  Image p = stage_finish(&s);
  double mean = image_mean(&p, 1);
  assert_int_equal(p.stats.not_finite, 0);
  image_free(&p);
  return mean;
}

static void rooms_are_tight(void **state) {
  (void)state;
  const double sizes[3] = {1e-3, 1, 1e4}, offsets[4] = {0, 1, 30, 1000};
  /* not the smooth one: with shading normals light leaks, as in pbrt */
  for (int kind = 0; kind < 5; kind += kind ? 1 : 2)
    for (int instanced = 0; instanced < 2; instanced++)
      for (int o = 0; o < 4; o++)
        for (int k = 0; k < 3; k++) {
          if (o > 1 && k != 1 && kind != 0)
            continue; /* meshes alone cover the sizes */
          Room r = {sizes[k], offsets[o], instanced, kind};
          double mean = room_mean(r, true);
          /* Near a box's edges, far from the origin, the error of a point exceeds its distance
           * to the other wall (measured share of light: 1e-5 at 100 sizes, 2e-4 at 1000, 2e-3
           * at 10000). */
          if (!(mean <= (o == 3 && kind > 2 ? 2e-3 : 0)))
            fail_msg("%s of size %g, %g sizes away%s: the sky leaks in (%.3g)", room_name[kind],
                     r.size, r.offset, instanced ? ", instanced" : "", mean);
        }
}

static void rooms_keep_their_light(void **state) {
  (void)state;
  const double sizes[3] = {1e-3, 1, 1e4}, offsets[4] = {0, 1, 30, 1000};
  for (int kind = 0; kind < 5; kind++) {
    double expected = room_mean((Room){1, 0, false, kind}, false);
    assert_true(expected > 0.5);
    for (int instanced = 0; instanced < 2; instanced++)
      for (int o = 0; o < 4; o++)
        for (int k = 0; k < 3; k++) {
          if (o > 1 && k != 1 && kind != 0)
            continue;
          Room r = {sizes[k], offsets[o], instanced, kind};
          double mean = room_mean(r, false), tolerance = o < 3 ? 3e-3 : 6e-3;
          if (!(fabs(mean / expected - 1) < tolerance))
            fail_msg("%s of size %g, %g sizes away%s: %.5f instead of %.5f", room_name[kind],
                     r.size, r.offset, instanced ? ", instanced" : "", mean, expected);
        }
  }
}

/* No speckles: a flat floor under a single point light is as smooth as the inverse-square law
 * predicts, near the origin and far away, seen and lit at grazing angles. */
static void no_acne(void **state) {
  (void)state;
  for (int instanced = 0; instanced < 2; instanced++)
    for (int o = 0; o < 3; o++) {
      double off = (double[3]){0, 30, 1000}[o];
      Stage s = stage_open(48, 36);
      s.build.color = VL_COLOR_RGB;
      s.render.sampler = VL_SAMPLER_REGULAR;
      s.render.spp = 1;
      s.render.max_depth = 1;
      Quad q = quad_at(0, 0, 0, 1.2f, 0.1f, 0.3f, -0.3f, 0.2f, 1.13333333f); /* leans */
      q.patch = o == 1;
      if (instanced)
        q.group = vl_scene_add_group(s.scene, "floor");
      for (int k = 0; k < 12 && !instanced; k++)
        q.p[k] += (float)off;
      add_quad(&s, &q);
      double far[16];
      set_matrix(far, 1, 0, 0, off, 0, 1, 0, off, 0, 0, 1, off);
      if (instanced)
        vl_scene_add_instance(s.scene, q.group, far, (vlSource){0});
      /* a low light, a low eye */
      const double eye[3] = {-1.2, 0.25, -0.9}, lamp[3] = {0.9, 0.35, 0.6};
      for (int i = 0; i < 3; i++) {
        s.camera.eye[i] = eye[i] + off;
        s.camera.lookat[i] = off;
      }
      s.camera.fov = 0.5;
      add_point(&s, (float)(lamp[0] + off), (float)(lamp[1] + off), (float)(lamp[2] + off), 1);
      vlCamera camera;
      assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, NULL), VL_OK);
      Image p = stage_finish(&s);
      /* The law: where the ray of the pixel's centre meets the plane, 1/2 / pi cos / d^2. */
      const double u[3] = {1.2f, 0.1f, 0.3f}, v[3] = {-0.3f, 0.2f, 1.13333333f};
      double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                     u[0] * v[1] - u[1] * v[0]};
      double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      int bad = 0, lit = 0;
      for (uint32_t y = 0; y < 36; y++)
        for (uint32_t x = 0; x < 48; x++) {
          if (!(image_at(&p, x, y, 3) > 0))
            continue;
          double eye_at[3], d[3], on = 0, dn = 0, d2 = 0, ln = 0;
          vl_camera_unproject(&camera, x + 0.5, y + 0.5, eye_at, d);
          for (int i = 0; i < 3; i++) {
            on += (eye_at[i] - off) * n[i];
            dn += d[i] * n[i];
          }
          for (int i = 0; i < 3; i++) {
            double to = lamp[i] - (eye_at[i] - off - on / dn * d[i]);
            d2 += to * to;
            ln += to * n[i] / length;
          }
          double expected = 0.5 / M_PI * fabs(ln) / (d2 * sqrt(d2));
          lit++;
          bad += !(fabs(image_at(&p, x, y, 1) - expected) <= 0.02 * expected);
        }
      image_free(&p);
      assert_true(lit > 300);
      if (bad)
        fail_msg("floor %g away%s: %d of %d pixels are not what they should be", off,
                 instanced ? ", instanced" : "", bad, lit);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(rooms_are_tight),
                                     cmocka_unit_test(rooms_keep_their_light),
                                     cmocka_unit_test(no_acne)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
