/* test_self_shadow.c: a shape neither hides a point of itself from what is in front of that
 * point, nor catches a ray that leaves it. Checked without statistics: no ray of many may be
 * blocked. The shapes are convex, or plane, so that no blocked ray is right. They touch the
 * origin of the world with points far from their own centre, corners and transforms, where
 * numbers are large and their sums small. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "statistics.h"
#include "unit.h"

#include "shape/surface_point.h"
#include "trace/surface/points.h"
#include "trace/two_way/stages.h"
#include "velo/light.h"
#include "velo/shape_kinds.h"
#include "world/moving.h"

enum { RAYS = 4000, LIGHTS = 4 * VL_BATCH };

/* ---- shapes ------------------------------------------------------------------------------ */

typedef struct Kind {
  const char *name;
  vlShapeKind kind;
  float radius, inner, z_min, z_max, height, phi_max;
  const float *positions;
  uint32_t vertices, faces;
  bool flat, light; /* flat: rays leave on both sides; light: can emit */
  vlCurveKind curve;
  const float *normals; /* of the vertices of a triangle, or null */
} Kind;

#define TURN 6.2831853f
static const float triangle[9] = {-1, -0.7f, 0, 1.2f, -0.6f, 0, 0.1f, 1.1f, 0};
/* Their interpolation changes sides within the triangle. */
static const float normals[9] = {0.6f, 0, 0.8f, -0.48f, 0.6f, -0.64f, 0.36f, -0.48f, 0.8f};
static const float thin[9] = {-1, -0.01f, 0, 1, 0.01f, 0, 0.9f, 0.03f, 0};
static const float blunt[9] = {-1, 0, 0, 1, 0, 0, 0.1f, 0.01f, 0};
static const float square[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
static const float patch[12] = {-1, -1, 0, 1, -0.8f, 0, -0.7f, 1, 0, 1, 1.1f, 0};
static const float straight[12] = {-1, 0, 0, -0.3f, 0, 0, 0.3f, 0, 0, 1, 0, 0};

static const Kind kinds[] = {
    {"sphere", VL_SHAPE_SPHERE, 1, 0, -1, 1, 0, TURN, NULL, 0, 0, false, true, VL_CURVE_FLAT,
     NULL},
    {"zone of a sphere", VL_SHAPE_SPHERE, 1.5f, 0, -0.4f, 1.1f, 0, 4, NULL, 0, 0, false, true,
     VL_CURVE_FLAT, NULL},
    {"cylinder", VL_SHAPE_CYLINDER, 0.7f, 0, -1, 2, 0, TURN, NULL, 0, 0, false, true,
     VL_CURVE_FLAT, NULL},
    {"slice of a cylinder", VL_SHAPE_CYLINDER, 0.7f, 0, -1, 2, 0, 2.5f, NULL, 0, 0, false, true,
     VL_CURVE_FLAT, NULL},
    {"disk", VL_SHAPE_DISK, 1, 0, 0, 0, 0.3f, TURN, NULL, 0, 0, true, true, VL_CURVE_FLAT,
     NULL},
    {"slice of a ring", VL_SHAPE_DISK, 2, 0.8f, 0, 0, 0, 5, NULL, 0, 0, true, true,
     VL_CURVE_FLAT, NULL},
    {"triangle", VL_SHAPE_TRIANGLES, 0, 0, 0, 0, 0, 0, triangle, 3, 1, true, true,
     VL_CURVE_FLAT, NULL},
    {"thin triangle", VL_SHAPE_TRIANGLES, 0, 0, 0, 0, 0, 0, thin, 3, 1, true, true,
     VL_CURVE_FLAT, NULL},
    {"blunt triangle", VL_SHAPE_TRIANGLES, 0, 0, 0, 0, 0, 0, blunt, 3, 1, true, true,
     VL_CURVE_FLAT, NULL},
    {"square", VL_SHAPE_TRIANGLES, 0, 0, 0, 0, 0, 0, square, 4, 2, true, true, VL_CURVE_FLAT,
     NULL},
    {"bilinear patch", VL_SHAPE_BILINEAR, 0, 0, 0, 0, 0, 0, patch, 4, 1, true, true,
     VL_CURVE_FLAT, NULL},
    {"flat curve", VL_SHAPE_CURVES, 0, 0, 0, 0, 0, 0, straight, 4, 1, true, false,
     VL_CURVE_FLAT, NULL},
    {"cylindrical curve", VL_SHAPE_CURVES, 0, 0, 0, 0, 0, 0, straight, 4, 1, true, false,
     VL_CURVE_CYLINDER, NULL},
    {"ribbon", VL_SHAPE_CURVES, 0, 0, 0, 0, 0, 0, straight, 4, 1, true, false, VL_CURVE_RIBBON,
     NULL},
    {"triangle with normals", VL_SHAPE_TRIANGLES, 0, 0, 0, 0, 0, 0, triangle, 3, 1, true, false,
     VL_CURVE_FLAT, normals},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static vlShapeDef shape_of(const Kind *k) {
  static const uint32_t corners[6] = {0, 1, 2, 0, 2, 3}, patch_corners[4] = {0, 1, 2, 3};
  static const float widths[2] = {0.02f, 0.02f}, ribbon[6] = {0, 0, 1, 0, 0, 1};
  vlShapeDef def = vl_default_shape_def(k->kind);
  def.radius = k->radius;
  def.inner_radius = k->inner;
  def.z_min = k->z_min;
  def.z_max = k->z_max;
  def.height = k->height;
  def.phi_max = k->phi_max;
  def.positions = k->positions;
  def.vertices = k->vertices;
  def.faces = k->faces;
  def.indices = k->kind == VL_SHAPE_BILINEAR ? patch_corners : corners;
  def.normals = k->normals;
  if (k->kind == VL_SHAPE_CURVES) {
    def.widths = widths;
    def.curve = k->curve;
    def.normals = ribbon;
  }
  return def;
}

/* ---- transforms -------------------------------------------------------------------------- */

/* m = a b */
static void multiply(const double a[16], const double b[16], double m[16]) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      m[4 * i + j] = 0;
      for (int k = 0; k < 4; k++)
        m[4 * i + j] += a[4 * i + k] * b[4 * k + j];
    }
}

/* A rotation by a random angle about a random axis (Rodrigues' formula). */
static void rotation(statRng *rng, double m[16]) {
  double a[3], angle = 6.28 * stat_double(rng), s = sin(angle), c = cos(angle);
  stat_direction(rng, a);
  const double r[16] = {c + a[0] * a[0] * (1 - c),
                        a[0] * a[1] * (1 - c) - a[2] * s,
                        a[0] * a[2] * (1 - c) + a[1] * s,
                        0,
                        a[1] * a[0] * (1 - c) + a[2] * s,
                        c + a[1] * a[1] * (1 - c),
                        a[1] * a[2] * (1 - c) - a[0] * s,
                        0,
                        a[2] * a[0] * (1 - c) - a[1] * s,
                        a[2] * a[1] * (1 - c) + a[0] * s,
                        c + a[2] * a[2] * (1 - c),
                        0,
                        0,
                        0,
                        0,
                        1};
  memcpy(m, r, sizeof r);
}

typedef enum Map {
  SHIFT,
  TURNED,
  SMALL,
  LARGE,
  STRETCHED,
  SHEARED,
  MIRRORED,
  ALMOST_ROUND,
  MAPS
} Map;
static const char *const map_names[] = {"shifted",   "turned",  "small",    "large",
                                        "stretched", "sheared", "mirrored", "almost round"};

static void linear_map(Map map, statRng *rng, double m[16]) {
  double a[16], b[16], scale[16] = {0};
  for (int i = 0; i < 4; i++)
    scale[5 * i] = 1;
  if (map == SHIFT) {
    memcpy(m, scale, sizeof scale);
    return;
  }
  if (map == SMALL || map == LARGE)
    for (int i = 0; i < 3; i++)
      scale[5 * i] = map == SMALL ? 1e-3 : 1e3;
  if (map == STRETCHED) {
    scale[0] = 0.1;
    scale[5] = 3;
    scale[10] = 0.7;
  }
  if (map == MIRRORED)
    scale[0] = -1;
  if (map == SHEARED) {
    scale[1] = 2;
    scale[6] = -1;
  }
  if (map == ALMOST_ROUND) {
    scale[0] = 1.00003;
    scale[1] = 1e-5;
  }
  rotation(rng, a);
  rotation(rng, b);
  multiply(a, scale, m);
  if (map == STRETCHED || map == SHEARED) {
    double c[16];
    multiply(m, b, c);
    memcpy(m, c, sizeof c);
  }
}

/* ---- worlds ------------------------------------------------------------------------------ */

typedef enum Place { PLACED, INSTANCED, MOVING, PLACES } Place;
static const char *const place_names[] = {"", "instance of a ", "moving "};

typedef struct Scene {
  const Kind *kind;
  vlContext *context;
  vlWorld *world;
  double touch[3];  /* a point of the shape */
  double normal[3]; /* of a flat shape */
  double size;
  struct vlBruteForce *brute_force;
} Scene;

static vlWorld *build(vlContext *context, const Kind *kind, Place place, bool shines,
                      const double shape[16], const double poses[32]) {
  vlScene *scene;
  vlWorld *world;
  vlError error = {0};
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlShapeDef def = shape_of(kind);
  memcpy(def.group_from_shape, shape, sizeof def.group_from_shape);
  /* normals point outside */
  def.reverse_orientation = vl_determinant3(shape) < 0;
  if (place != PLACED)
    def.group = vl_scene_add_group(scene, NULL);
  if (shines) {
    vlEmissionDef emission = vl_default_emission_def();
    emission.radiance = vl_spectrum_rgb(1, 1, 1);
    def.emission = vl_scene_add_emission(scene, &emission);
  }
  assert_int_not_equal(vl_scene_add_shape(scene, &def).index, 0);
  const double times[2] = {0, 1};
  if (place == INSTANCED)
    vl_scene_add_instance(scene, def.group, poses, (vlSource){0});
  if (place == MOVING)
    vl_scene_add_moving_instance(scene, def.group, 2, times, poses, (vlSource){0});
  vlBuildDef build_def = vl_default_build_def();
  build_def.color = VL_COLOR_RGB;
  if (vl_world_build(scene, &build_def, &world, &error) != VL_OK)
    fail_msg("%s: %s", kind->name, error.message);
  vl_scene_destroy(scene);
  return world;
}

/* A point of the shape as its own group has it. */
static void point_of_shape(const vlWorld *world, statRng *rng, double p[3]) {
  const vlWorldShape *s = &world->shapes.items[0];
  if (s->kind == VL_SHAPE_TRIANGLES) {
    float u = stat_float(rng), v = stat_float(rng) * (1 - u);
    for (int i = 0; i < 3; i++)
      p[i] = (double)((1 - u - v) * s->positions[i] + u * s->positions[3 + i] +
                      v * s->positions[6 + i]);
    if (stat_float(rng) < 0.3f)
      for (int i = 0; i < 3; i++)
        p[i] = (double)s->positions[i];
    return;
  }
  /* in the box around the curve, so that rays meet its edges, too */
  if (s->kind == VL_SHAPE_CURVES) {
    double q[3] = {2 * stat_double(rng) - 1, 0.02 * (stat_double(rng) - 0.5),
                   0.02 * (stat_double(rng) - 0.5)};
    vl_map_point(s->from_shape, q, p);
    return;
  }
  vlSurfacePoint point;
  double pdf;
  vl_shape_sample(s, 0, stat_float(rng), stat_float(rng), &point, &pdf);
  memcpy(p, point.p, 3 * sizeof *p);
}

/* Turns the world's brute force off if Embree is to be tested. */
static void use_embree(Scene *s) {
  s->brute_force = s->world->accel.brute_force;
  s->world->accel.brute_force = NULL;
}

/* A shape that touches the origin (or, `far` from it, another point). */
static Scene make(const Kind *kind, Place place, Map map, bool shines, bool far, bool embree,
                  statRng *rng) {
  Scene s = {.kind = kind};
  static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  double m[16], p[3], poses[32], shape[16];
  linear_map(map, rng, m);
  memcpy(shape, identity, sizeof shape);
  assert_int_equal(vl_context_create(NULL, &s.context), VL_OK);
  if (place == PLACED)
    memcpy(shape, m, sizeof shape);
  if (place != PLACED) {
    shape[3] = 3;
    shape[7] = -2;
    shape[11] = 7;
  } /* far from the origin of the group */
  memcpy(poses, place == PLACED ? identity : m, sizeof m);
  memcpy(poses + 16, poses, sizeof m);
  vlWorld *there = build(s.context, kind, PLACED, false, shape, poses);
  s.size = (double)there->radius * (place == PLACED ? 1 : cbrt(fabs(vl_determinant3(m))));
  point_of_shape(there, rng, p);
  vl_world_destroy(there);
  vlMat4 inverse;
  assert_true(vl_mat4_inverse(vl_mat4_load(m), &inverse));
  double length = sqrt(inverse.m[8] * inverse.m[8] + inverse.m[9] * inverse.m[9] +
                       inverse.m[10] * inverse.m[10]);
  for (int i = 0; i < 3; i++)
    s.normal[i] = inverse.m[8 + i] / length;
  double *moved = place == PLACED ? shape : poses;
  for (int i = 0; i < 3; i++) {
    double at = 0;
    for (int j = 0; j < 3; j++)
      at += place == PLACED ? (i == j) * p[j] : m[4 * i + j] * p[j];
    s.touch[i] = far ? s.size * (i + 1) * 100 : 0;
    moved[4 * i + 3] += s.touch[i] - at;
  }
  if (place == MOVING) {
    memcpy(poses + 16, poses, sizeof m);
    for (int i = 0; i < 3; i++) {
      poses[4 * i + 3] -= s.size * (i - 0.7);
      poses[16 + 4 * i + 3] += s.size * (i - 0.7);
    }
  }
  s.world = build(s.context, kind, place, shines, shape, poses);
  if (embree)
    use_embree(&s);
  return s;
}

static void destroy(Scene *s) {
  if (s->brute_force)
    s->world->accel.brute_force = s->brute_force;
  vl_world_destroy(s->world);
  assert_int_equal(vl_context_memory(s->context, NULL), 0);
  vl_context_destroy(s->context);
}

/* ---- rays that leave --------------------------------------------------------------------- */

/* 10^-k, k uniform in [0, most). */
static double small(statRng *rng, double max) {
  return pow(10, -max * stat_double(rng));
}

typedef struct Hit {
  uint32_t shape, prim, instance;
  float t;
} Hit;

static Hit trace(const vlWorld *world, vlVec3 o, vlVec3 d, float time) {
  Hit h;
  vlRays ray = {&o.x, &o.y, &o.z, &d.x, &d.y, &d.z, NULL, NULL, world->moves ? &time : NULL,
                NULL};
  vl_accel_closest(world, 1, &ray, false, &h.shape, &h.prim, &h.instance, &h.t);
  return h;
}

static vlVec3 to_float(const double p[3]) {
  return vl_vec3((float)p[0], (float)p[1], (float)p[2]);
}

/* A ray to a point of the shape, half of them near the touched one. */
static void aim(const Scene *s, float time, statRng *rng, vlVec3 *o, vlVec3 *d) {
  double from[3], to[3], way[3], p[3];
  stat_direction(rng, from);
  double distance = s->size * small(rng, 5) * 100,
         share = stat_double(rng) < 0.5 ? small(rng, 7) : 1;
  point_of_shape(s->world, rng, p);
  vlWorldInstance room;
  const vlWorldInstance *q =
      s->world->instances.count ? vl_instance_at(s->world->instances.items, time, &room) : NULL;
  for (int i = 0; i < 3; i++) {
    const float *m = q ? q->from_group + 4 * i : NULL;
    double at =
        q ? (double)m[0] * p[0] + (double)m[1] * p[1] + (double)m[2] * p[2] + (double)m[3]
          : p[i];
    to[i] = s->touch[i] + share * (at - s->touch[i]);
    from[i] = to[i] + distance * from[i];
    way[i] = to[i] - from[i];
  }
  *o = to_float(from);
  *d = vl_normalize(to_float(way));
}

/* Whether a point is in the plane of a flat shape but for rounding: no side can be told. */
static bool in_plane(const Scene *s, vlVec3 p) {
  double q[3] = {(double)p.x, (double)p.y, (double)p.z}, height = 0, size = s->size;
  for (int i = 0; i < 3; i++) {
    height += s->normal[i] * (q[i] - s->touch[i]);
    size += fabs(s->touch[i]);
  }
  return s->kind->flat && fabs(height) < 4e-6 * size;
}

/* Rays from the touched point's neighbourhood to outside. Returns how many meet the shape
 * again. */
static uint32_t leaving(const Scene *s, statRng *rng, uint32_t *tried) {
  uint32_t caught = 0;
  for (int i = 0; i < RAYS; i++) {
    vlVec3 o, d;
    float time = s->world->moves ? 0.5f : 0;
    aim(s, time, rng, &o, &d);
    Hit h = trace(s->world, o, d, time);
    if (h.shape == VL_NONE)
      continue;
    vlPoint at = vl_point_at_time(s->world, time, o, d, h.shape, h.prim, h.instance, h.t);
    double w[3];
    stat_direction(rng, w);
    vlVec3 out = to_float(w);
    float cosine = vl_dot(out, at.g);
    if (cosine < 0 && !s->kind->flat)
      out = vl_neg(out);
    if (vl_abs(cosine) < 1e-4f)
      continue;
    ++*tried;
    caught += trace(s->world, vl_offset_origin(at.p, at.g, at.offset, out), out, time).shape !=
              VL_NONE;
  }
  return caught;
}

/* Rays that pass through the shape, as through an interface: the search for the next surface
 * starts just past each. An outside ray crosses a plane shape once, others at most twice. Rays
 * that graze a surface are not counted. */
static uint32_t passing(const Scene *s, statRng *rng, uint32_t *tried) {
  uint32_t twice = 0;
  for (int i = 0; i < RAYS; i++) {
    vlVec3 o, d;
    float time = s->world->moves ? 0.5f : 0, t_min = 0;
    aim(s, time, rng, &o, &d);
    if (in_plane(s, o))
      continue;
    int crossed = 0, max = s->kind->flat ? 1 : 2;
    for (; crossed <= max; crossed++) {
      Hit h;
      vlRays ray = {
          &o.x, &o.y, &o.z, &d.x, &d.y, &d.z, &t_min, NULL, s->world->moves ? &time : NULL,
          NULL};
      vl_accel_closest(s->world, 1, &ray, false, &h.shape, &h.prim, &h.instance, &h.t);
      if (h.shape == VL_NONE)
        break;
      vlPoint at = vl_point_at_time(s->world, time, o, d, h.shape, h.prim, h.instance, h.t);
      if (vl_abs(vl_dot(at.g, d)) < 0.02f)
        break;
      t_min = vl_past_surface(&at, d, t_min);
    }
    *tried += crossed > 0;
    twice += crossed > max;
  }
  return twice;
}

static const char *describe(const Scene *s, Place place, Map map, bool far, bool embree) {
  static char text[200];
  snprintf(text, sizeof text, "%s%s, %s, %s%s", place_names[place], s->kind->name,
           map_names[map], far ? "far from the origin" : "at the origin",
           embree ? ", Embree" : "");
  return text;
}

typedef uint32_t Check(const Scene *s, statRng *rng, uint32_t *tried);

/* All shapes under all maps, at the origin and far from it, at rest, instanced and moving, by
 * brute force and by Embree. */
static void check_all(Check *check, uint64_t seed) {
  uint32_t wrong = 0;
  for (int k = 0; k < KINDS; k++)
    for (Place place = 0; place < PLACES; place++)
      for (Map map = 0; map < MAPS; map++)
        for (int j = 0; j < 4; j++) {
          bool far = j & 1, embree = j & 2;
          if (embree && place != PLACED)
            continue;
          statRng rng =
              stat_rng(seed + 1000 * (uint64_t)k + 100 * place + 10 * map + (uint64_t)j);
          Scene s = make(&kinds[k], place, map, false, far, embree, &rng);
          uint32_t tried = 0, caught = check(&s, &rng, &tried);
          if (tried < RAYS / 100)
            print_error("%s: only %u rays\n", describe(&s, place, map, far, embree), tried);
          if (caught)
            print_error("%s: %u of %u rays\n", describe(&s, place, map, far, embree), caught,
                        tried);
          wrong += caught;
          destroy(&s);
        }
  assert_int_equal(wrong, 0);
}

static void rays_leave(void **state) {
  (void)state;
  check_all(leaving, 0);
}

static void interfaces_are_passed_once(void **state) {
  (void)state;
  check_all(passing, 500000);
}

/* ---- three ways to one point ------------------------------------------------------------- */

/* The bound that the instance gives for the corners of its triangle (world.h), along g. */
static float bound_of_corners(const vlWorld *world, const Hit *h, vlVec3 g) {
  const vlWorldShape *s = &world->shapes.items[h->shape];
  if (!s->triangles || h->instance == VL_NONE || world->moves)
    return 0;
  const float *error = world->instances.items[h->instance].error;
  float max = 0;
  for (int k = 0; k < 3; k++) {
    const float *x = s->positions + 3 * (size_t)s->indices[3 * (size_t)h->prim + (size_t)k];
    max = fmaxf(max, error[0] * fabsf(x[0]) + error[1] * fabsf(x[1]) + error[2] * fabsf(x[2]) +
                         error[3]);
  }
  return max * (fabsf(g.x) + fabsf(g.y) + fabsf(g.z));
}

/* The points of a batch, those that media ask for, and single points have the same distances,
 * normals and bounds, and the bounds are twice those of the corners at least. Returns how many
 * differ. */
static uint32_t differing(const Scene *s, vlTraceScratch *t, statRng *rng, uint32_t *tried) {
  const vlWorld *world = s->world;
  uint32_t n = 0, wrong = 0;
  uint32_t lanes[VL_CROSSINGS];
  float times[VL_CROSSINGS];
  static vlCrossings x;
  vlPaths *p = &t->at.paths;
  vlHits *hits = &t->at.hits;
  const vlSurface *f = &t->at.surface;
  for (int i = 0; i < 2 * VL_CROSSINGS && n < VL_CROSSINGS; i++) {
    vlVec3 o, d;
    aim(s, 0.5f, rng, &o, &d);
    times[n] = 0.5f;
    Hit h = trace(world, o, d, times[n]);
    if (h.shape == VL_NONE)
      continue;
    vl_set_row3(&p->o, n, o);
    vl_set_row3(&p->d, n, d);
    p->lane[n] = lanes[n] = n;
    hits->shape[n] = h.shape;
    hits->prim[n] = h.prim;
    hits->instance[n] = h.instance;
    hits->t[n++] = h.t;
  }
  p->time = world->moves ? times : NULL;
  vl_stage_surface(world, n, p, hits, &t->corners, &t->at.surface);
  x.shape = hits->shape;
  x.prim = hits->prim;
  x.instance = hits->instance;
  x.hit = hits->t;
  vlRays rays = {p->o.x, p->o.y, p->o.z, p->d.x, p->d.y, p->d.z, NULL, NULL, p->time, NULL};
  vl_stage_crossings(world, n, &rays, lanes, n, &x);
  for (uint32_t i = 0; i < n; i++) {
    Hit h = {hits->shape[i], hits->prim[i], hits->instance[i], hits->t[i]};
    vlPoint at = vl_point_at_time(world, world->moves ? times[i] : 0, vl_row3(&p->o, i),
                                  vl_row3(&p->d, i), h.shape, h.prim, h.instance, h.t);
    bool same = f->offset[i] == at.offset && f->t[i] == at.t && f->g.x[i] == at.g.x &&
                x.offset[i] == at.offset && x.t[i] == at.t && x.gx[i] == at.g.x;
    wrong += !same || at.offset < 1.999f * bound_of_corners(world, &h, at.g);
  }
  p->time = NULL;
  *tried += n;
  return wrong;
}

/* A great ball that touches the origin, along each axis: its points are less certain than their
 * own small coordinates. In an object that is not moved they are no more certain. */
static void objects_keep_uncertainty(void **state) {
  (void)state;
  static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const float radius = 1e6f;
  Kind ball = kinds[0];
  ball.radius = radius;
  ball.z_min = -radius;
  ball.z_max = radius;
  double poses[32];
  memcpy(poses, identity, sizeof identity);
  memcpy(poses + 16, identity, sizeof identity);
  for (int axis = 0; axis < 3; axis++) {
    float offset[2];
    for (Place place = PLACED; place <= INSTANCED; place++) {
      vlContext *context;
      assert_int_equal(vl_context_create(NULL, &context), VL_OK);
      double shape[16];
      memcpy(shape, identity, sizeof identity);
      shape[4 * axis + 3] = -(double)radius;
      vlWorld *world = build(context, &ball, place, false, shape, poses);
      float o[3] = {0, 0, 0}, d[3] = {0, 0, 0};
      o[axis] = 1;
      d[axis] = -1;
      Hit h = trace(world, vl_load3(o), vl_load3(d), 0);
      assert_int_equal(h.shape, 0);
      offset[place] =
          vl_point_at_time(world, 0, vl_load3(o), vl_load3(d), h.shape, h.prim, h.instance, h.t)
              .offset;
      vl_world_destroy(world);
      vl_context_destroy(context);
    }
    if (!(offset[INSTANCED] >= 0.99f * offset[PLACED]))
      fail_msg("axis %d: rays start %g off, in an object %g", axis, (double)offset[PLACED],
               (double)offset[INSTANCED]);
  }
}

static void three_ways_agree(void **state) {
  (void)state;
  vlTraceScratch *t = aligned_alloc(64, sizeof *t);
  memset(t, 0, sizeof *t);
  uint32_t wrong = 0;
  for (int k = 0; k < KINDS; k++)
    for (Place place = 0; place < PLACES; place++)
      for (Map map = 0; map < MAPS; map++) {
        statRng rng = stat_rng(30000 + 1000 * (uint64_t)k + 100 * place + 10 * map);
        Scene s = make(&kinds[k], place, map, false, false, false, &rng);
        uint32_t tried = 0, differ = differing(&s, t, &rng, &tried);
        if (tried < 4)
          print_error("%s: only %u rays\n", describe(&s, place, map, false, false), tried);
        if (differ)
          print_error("%s: %u of %u points differ\n", describe(&s, place, map, false, false),
                      differ, tried);
        wrong += differ;
        destroy(&s);
      }
  free(t);
  assert_int_equal(wrong, 0);
}

/* ---- rays that arrive at lights ---------------------------------------------------------- */

/* Shadow rays to light samples, from points at all distances outside. media: as tracers of
 * media cast them. */
static uint32_t arriving(const Scene *s, vlTraceScratch *t, bool media, statRng *rng,
                         uint32_t *tried) {
  uint32_t blocked = 0;
  for (int n = 0; n < LIGHTS; n += VL_BATCH) {
    vlNumbers u;
    for (uint32_t i = 0; i < VL_BATCH; i++) {
      double away[3], distance = s->size * small(rng, 6) * 1000;
      stat_direction(rng, away);
      vlVec3 p = to_float((double[3]){s->touch[0] + distance * away[0],
                                      s->touch[1] + distance * away[1],
                                      s->touch[2] + distance * away[2]});
      t->at.surface.p.x[i] = p.x;
      t->at.surface.p.y[i] = p.y;
      t->at.surface.p.z[i] = p.z;
      t->at.surface.no_cosine[i] = 1;
      t->at.surface.n.x[i] = 0;
      t->at.surface.n.y[i] = 0;
      t->at.surface.n.z[i] = 1;
      u.u0[i] = stat_float(rng);
      u.u1[i] = stat_float(rng);
      u.u2[i] = stat_float(rng);
    }
    vl_stage_lights(s->world, VL_BATCH, &t->at.paths, &t->at.surface, u.u1, u.u2, u.u0,
                    &t->light);
    for (uint32_t i = 0; i < VL_BATCH; i++) {
      const vlLightSamples *l = &t->light;
      if (!(l->pdf[i] > 0))
        continue;
      vlVec3 o = vl_row3(&t->at.surface.p, i);
      if (in_plane(s, o))
        continue;
      vlVec3 d = vl_sub(vl_row3(&l->target, i), o);
      float end = media ? vl_length(d) * VL_SHADOW_END : VL_ONE_MINUS_EPSILON;
      if (media)
        d = vl_normalize(d);
      uint8_t occluded;
      vlRays ray = {&o.x, &o.y, &o.z, &d.x, &d.y, &d.z, NULL, &end, NULL, NULL};
      vl_accel_occluded(s->world, 1, &ray, NULL, &occluded);
      ++*tried;
      blocked += occluded;
    }
  }
  return blocked;
}

static void lights_are_seen(void **state) {
  (void)state;
  vlTraceScratch *t = aligned_alloc(64, sizeof *t);
  memset(t, 0, sizeof *t);
  uint32_t wrong = 0;
  for (int k = 0; k < KINDS; k++)
    for (Map map = 0; map < MAPS && kinds[k].light; map++)
      for (int j = 0; j < 4; j++) {
        bool far = j & 1, embree = j & 2;
        statRng rng = stat_rng(7000 + 1000 * (uint64_t)k + 10 * map + (uint64_t)j);
        Scene s = make(&kinds[k], PLACED, map, true, far, embree, &rng);
        for (int media = 0; media < 2; media++) {
          uint32_t tried = 0, blocked = arriving(&s, t, media, &rng, &tried);
          if (tried < LIGHTS / 10)
            print_error("%s: only %u rays\n", describe(&s, PLACED, map, far, embree), tried);
          if (blocked)
            print_error("%s%s: %u of %u rays\n", describe(&s, PLACED, map, far, embree),
                        media ? ", in media" : "", blocked, tried);
          wrong += blocked;
        }
        destroy(&s);
      }
  free(t);
  assert_int_equal(wrong, 0);
}

/* ---- light paths ------------------------------------------------------------------------- */

static void light_paths_leave(void **state) {
  (void)state;
  uint32_t wrong = 0;
  const float lambda[4] = {0, 0, 0, 0};
  for (int k = 0; k < KINDS; k++)
    for (Map map = 0; map < MAPS && kinds[k].light; map++)
      for (int j = 0; j < 4; j++) {
        bool far = j & 1, embree = j & 2;
        statRng rng = stat_rng(99000 + 1000 * (uint64_t)k + 10 * map + (uint64_t)j);
        Scene s = make(&kinds[k], PLACED, map, true, far, embree, &rng);
        float choice[8], u[5];
        assert_true(s.world->lights.count < 8 && vl_two_way_choice(s.world, choice));
        vlTwoWay way = {.choice = choice};
        uint32_t tried = 0, caught = 0;
        for (int i = 0; i < RAYS; i++) {
          for (int c = 0; c < 5; c++)
            u[c] = stat_float(&rng);
          vlEmission e =
              vl_emission_sample(s.world, &way, lambda, u[0], u[1], u[2], u[3], u[4]);
          if (!e.valid || vl_abs(vl_dot(e.d, e.n)) < 1e-4f)
            continue;
          tried++;
          caught += trace(s.world, e.o, e.d, 0).shape != VL_NONE;
        }
        if (tried < RAYS / 10)
          print_error("%s: only %u rays\n", describe(&s, PLACED, map, far, embree), tried);
        if (caught)
          print_error("%s: %u of %u rays\n", describe(&s, PLACED, map, far, embree), caught,
                      tried);
        wrong += caught;
        destroy(&s);
      }
  assert_int_equal(wrong, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rays_leave),
      cmocka_unit_test(interfaces_are_passed_once),
      cmocka_unit_test(objects_keep_uncertainty),
      cmocka_unit_test(three_ways_agree),
      cmocka_unit_test(lights_are_seen),
      cmocka_unit_test(light_paths_leave),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
