/* test_mirrors.c: the side of a shape's normal under mirroring transforms, by pbrt-v4's rule:
 * the normal of dpdu x dpdv in shape space (meshes: of the transformed vertices), flipped if
 * ReverseOrientation differs from "the shape's own transform swaps handedness", then
 * transformed by the inverse transpose of instance and motion transforms. Vertex normals take
 * precedence; only ReverseOrientation flips them.
 *
 * The rule is computed here independently from the file's numbers. The renderer shows it by
 * one-sided area lights (hit by rays, and sampled) and by media interfaces. All shapes x
 * transforms x ReverseOrientation x placements, from both sides. */
#include <unistd.h>

#include "render/shots.h"
#include "velo/load.h"

typedef enum Family { QUADRIC, MESH, NORMALS, CURVE } Family;

typedef struct Kind {
  const char *shape;
  Family family;
  double p[3], n[3]; /* a point; dpdu x dpdv there (meshes with vertex normals: these) */
  double outward;    /* of closed shapes: 1 where n points out, -1 in; 0: open */
} Kind;

#define SQUARE "\"point3 P\" [-1 -1 .1 1 -1 .1 -1 1 .1 1 1 .1]"
#define DOWN "\"normal N\" [0 0 -1 0 0 -1 0 0 -1 0 0 -1]"
static const Kind kinds[] = {
    {"\"sphere\"", QUADRIC, {.6, 0, .8}, {.6, 0, .8}, 1},
    {"\"disk\" \"float height\" .2", QUADRIC, {.3, .2, .2}, {0, 0, 1}, 0},
    {"\"cylinder\"", QUADRIC, {.6, .8, .1}, {.6, .8, 0}, 1},
    {"\"trianglemesh\" " SQUARE " \"integer indices\" [0 1 3 0 3 2]",
     MESH,
     {.1, .2, .1},
     {0, 0, 1},
     0},
    {"\"trianglemesh\" " SQUARE DOWN " \"integer indices\" [0 1 3 0 3 2]",
     NORMALS,
     {.1, .2, .1},
     {0, 0, -1},
     0},
    {"\"bilinearmesh\" " SQUARE, MESH, {.1, .2, .1}, {0, 0, 1}, 0},
    {"\"bilinearmesh\" " SQUARE DOWN, NORMALS, {.1, .2, .1}, {0, 0, -1}, 0},
    /* Corner 0's ring in pbrt's order: +x -y -x +y, so S = 2x, T = -2y, and S x T points
     * down. */
    {"\"loopsubdiv\" \"integer levels\" 3 "
     "\"point3 P\" [0 0 1 1 0 0 0 1 0 -1 0 0 0 -1 0 0 0 -1] "
     "\"integer indices\" [0 1 2 0 2 3 0 3 4 0 4 1 5 2 1 5 3 2 5 4 3 5 1 4]",
     NORMALS,
     {0, 0, .5},
     {0, 0, -1},
     -1},
    {"\"curve\" \"string type\" \"ribbon\" \"point3 P\" [-1 0 0 -.3 0 0 .3 0 0 1 0 0] "
     "\"normal N\" [0 0 1 0 0 1] \"float width\" 1",
     QUADRIC,
     {.1, .1, 0},
     {0, 0, 1},
     0},
    /* Their normal depends on the ray: dpdu x dpdv points along it. */
    {"\"curve\" \"point3 P\" [-1 0 0 -.3 0 0 .3 0 0 1 0 0] \"float width\" 1",
     CURVE,
     {.1, .1, 0},
     {0, 0, 1},
     0},
    {"\"curve\" \"string type\" \"cylinder\" \"point3 P\" [-1 0 0 -.3 0 0 .3 0 0 1 0 0] "
     "\"float width\" .5",
     CURVE,
     {.1, 0, 0},
     {0, 0, 1},
     0},
};
enum { KINDS = sizeof kinds / sizeof kinds[0], LIGHTS = 8 };

static const double maps[][9] = {
    {1, 0, 0, 0, 1, 0, 0, 0, 1},                   /* as it is */
    {-1, 0, 0, 0, 1, 0, 0, 0, 1},                  /* x to -x */
    {1, 0, 0, 0, -1, 0, 0, 0, 1},                  /* y to -y */
    {1, 0, 0, 0, 1, 0, 0, 0, -1},                  /* z to -z */
    {-1, 0, 0, 0, -1, 0, 0, 0, 1},                 /* two: a half turn */
    {-1, 0, 0, 0, -1, 0, 0, 0, -1},                /* all three */
    {0.7, 0.1, 0.3, 0.2, -1.1, 0, 0.1, 0.3, 0.9},  /* mirrored, sheared */
    {0.6, -0.5, 0, 0.5, 0.6, 0.3, 0.1, -0.3, 1.1}, /* turned, sheared */
};
enum { MAPS = sizeof maps / sizeof maps[0] };

/* own: of the shape; outer: of an instance or a motion. */
typedef enum Place { OWN, INSTANCE, OWN_IN_INSTANCE, MOVING, OWN_IN_MOVING, PLACES } Place;

static double det(const double *m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}
static void apply(const double *m, double v[3]) {
  double r[3];
  for (int i = 0; i < 3; i++)
    r[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
  memcpy(v, r, sizeof r);
}
/* By the cofactors: det times the inverse transpose. */
static void apply_cofactors(const double *m, double v[3]) {
  double r[3];
  for (int i = 0; i < 3; i++) {
    const double *a = m + 3 * ((i + 1) % 3), *b = m + 3 * ((i + 2) % 3);
    r[i] = (a[1] * b[2] - a[2] * b[1]) * v[0] + (a[2] * b[0] - a[0] * b[2]) * v[1] +
           (a[0] * b[1] - a[1] * b[0]) * v[2];
  }
  memcpy(v, r, sizeof r);
}
static void apply_normal(const double *m, double v[3]) {
  apply_cofactors(m, v);
  for (int i = 0; i < 3; i++)
    v[i] /= det(m);
}

typedef struct Scene {
  const Kind *kind;
  const double *own, *outer;
  Place place;
  bool reverse;
  double p[3], n[3]; /* in the world; n as pbrt has it, of unit length */
  bool outward;      /* n points out of a closed shape */
  bool flip;
} Scene;

static const double shift[3] = {0.3, -0.2, -4};

static Scene make_scene(int kind, int map, Place place, bool reverse) {
  Scene s = {.kind = &kinds[kind],
             .own = maps[0],
             .outer = maps[0],
             .place = place,
             .reverse = reverse};
  if (place == OWN || place == OWN_IN_INSTANCE || place == OWN_IN_MOVING)
    s.own = maps[map];
  if (place == INSTANCE || place == MOVING)
    s.outer = maps[map];
  if (place == OWN_IN_INSTANCE || place == OWN_IN_MOVING)
    s.outer = maps[2];
  s.flip = reverse != (det(s.own) < 0);
  memcpy(s.p, s.kind->p, sizeof s.p);
  memcpy(s.n, s.kind->n, sizeof s.n);
  apply(s.own, s.p);
  apply(s.outer, s.p);
  double out[3] = {s.kind->n[0], s.kind->n[1], s.kind->n[2]}, side = s.flip ? -1 : 1;
  switch (s.kind->family) {
    case QUADRIC:
    case CURVE:
      apply_normal(s.own, s.n);
      break;
    case MESH:
      apply_cofactors(s.own, s.n);
      break; /* the cross product of moved edges */
    case NORMALS:
      apply_normal(s.own, s.n);
      side = reverse ? -1 : 1;
      break;
  }
  apply_normal(s.outer, s.n);
  apply_normal(s.own, out);
  apply_normal(s.outer, out);
  double length = sqrt(s.n[0] * s.n[0] + s.n[1] * s.n[1] + s.n[2] * s.n[2]);
  for (int i = 0; i < 3; i++) {
    s.n[i] *= side / length;
    s.p[i] += shift[i];
  }
  s.outward = s.kind->outward * (s.n[0] * out[0] + s.n[1] * out[1] + s.n[2] * out[2]) > 0;
  return s;
}

static void put_map(FILE *f, const double *m, const double *t) {
  fprintf(f, "ConcatTransform [");
  for (int j = 0; j < 3; j++)
    fprintf(f, "%.17g %.17g %.17g 0 ", m[j], m[3 + j], m[6 + j]);
  fprintf(f, "%.17g %.17g %.17g 1]\n", t ? t[0] : 0, t ? t[1] : 0, t ? t[2] : 0);
}

/* The point off the surface by h along the normal. */
static void off(const Scene *s, double h, double at[3]) {
  for (int i = 0; i < 3; i++)
    at[i] = s->p[i] + h * s->n[i];
}

/* extra: before the shape, of the world; attributes: of the shape. */
static void put_scene(FILE *f, const Scene *s, const double eye[3], const double to[3],
                      const char *extra, const char *attributes) {
  bool group = s->place == INSTANCE || s->place == OWN_IN_INSTANCE || s->place == OWN_IN_MOVING;
  fprintf(f,
          "LookAt %.9g %.9g %.9g %.9g %.9g %.9g .31 .82 .47\n"
          "Camera \"perspective\" \"float fov\" 2\n",
          eye[0], eye[1], eye[2], to[0], to[1], to[2]);
  fprintf(f,
          "WorldBegin\n"
          "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 1 1] "
          "\"rgb sigma_s\" [0 0 0]\n"
          "%s\n"
          "AttributeBegin\n"
          "%s\n"
          "%s",
          extra, attributes, s->reverse ? "ReverseOrientation\n" : "");
  if (group) {
    fprintf(f, "AttributeBegin\n");
    put_map(f, s->own, NULL);
    fprintf(f, "ObjectBegin \"o\"\nShape %s\nObjectEnd\nAttributeEnd\n", s->kind->shape);
  }
  if (s->place == MOVING || s->place == OWN_IN_MOVING)
    fprintf(f, "ActiveTransform EndTime Translate 1e-5 0 0 ActiveTransform All\n");
  put_map(f, s->outer, shift);
  if (!group && s->place == OWN)
    put_map(f, s->own, NULL);
  if (group)
    fprintf(f, "ObjectInstance \"o\"\n");
  else
    fprintf(f, "Shape %s\n", s->kind->shape);
  fprintf(f, "AttributeEnd\n");
}

static double shoot_file(const char *path, uint32_t spp, uint32_t depth) {
  Stage stage = stage_open(2, 2);
  vlError error;
  memset(&error, 0, sizeof error);
  if (vl_scene_load(stage.scene, path, NULL, &error) != VL_OK)
    fail_msg("%s: %s", path, error.message);
  stage.camera = vl_scene_defs(stage.scene)->camera;
  stage.camera.width = stage.camera.height = 2;
  stage.build.color = VL_COLOR_RGB;
  stage.render.tracer = vl_scene_defs(stage.scene)->render.tracer;
  stage.render.spp = spp;
  stage.render.max_depth = depth;
  Image q = stage_finish(&stage);
  double mean = image_mean(&q, 1);
  image_free(&q);
  return mean;
}

static FILE *open_file(char *path) {
  int file = mkstemps(path, 5);
  assert_true(file >= 0);
  return fdopen(file, "w");
}

static double shoot(const Scene *s, const double eye[3], const double to[3], const char *extra,
                    const char *attributes, uint32_t spp, uint32_t depth) {
  char path[] = "/tmp/velo-mirrors-XXXXXX.pbrt";
  FILE *f = open_file(path);
  put_scene(f, s, eye, to, extra, attributes);
  fclose(f);
  double mean = shoot_file(path, spp, depth);
  unlink(path);
  return mean;
}

static void name_scene(const Scene *s, int map, double side, const char *what, char name[160]) {
  snprintf(name, 160, "%s: %.24s, map %d, place %d%s, side %g", what, s->kind->shape, map,
           (int)s->place, s->reverse ? ", reversed" : "", side);
}

/* Run into, and found by sampling: a bead over the surface takes all that the same light with
 * two sides would send. */
static void lights_shine_to_the_side_of_the_normal(void **state) {
  (void)state;
  static const char one[] = "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]",
                    two[] =
                        "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true";
  for (int kind = 0; kind < LIGHTS; kind++)
    for (int map = 0; map < MAPS; map++)
      for (int k = 0; k < 4; k++) {
        Scene s = make_scene(kind, map, OWN, k & 1);
        double side = k & 2 ? -1 : 1, eye[3], at[3];
        char name[160], bead[200];
        off(&s, 0.15 * side, eye);
        off(&s, 0.3 * side, at);
        name_scene(&s, map, side, "seen", name);
        assert_near(name, shoot(&s, eye, s.p, "", one, 1, 0), side > 0, 1e-3);
        snprintf(bead, sizeof bead,
                 "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [.8 .8 .8] Translate "
                 "%.9g %.9g %.9g Shape "
                 "\"sphere\" \"float radius\" .03 AttributeEnd",
                 at[0], at[1], at[2]);
        name_scene(&s, map, side, "sampled", name);
        double both = shoot(&s, eye, at, bead, two, 32, 1);
        assert_true(both > 0.08);
        assert_near(name, shoot(&s, eye, at, bead, one, 32, 1), side > 0 ? both : 0,
                    0.1 * both);
      }
}

/* Towards the side of the normal is outside: nothing; the other way the ray comes into a medium
 * that absorbs, and leaves it again only where it meets a closed shape from its outside. */
static void media_lie_behind_the_normal(void **state) {
  (void)state;
  static const char sky[] = "LightSource \"infinite\" \"rgb L\" [1 1 1]",
                    bounds[] = "Material \"interface\" MediumInterface \"m\" \"\"";
  for (int kind = 0; kind < KINDS; kind++)
    for (int map = 0; map < MAPS; map++)
      for (int k = 0; k < 4 * PLACES; k++) {
        Scene s = make_scene(kind, map, (Place)(k / 4), k & 1);
        double side = k & 2 ? -1 : 1, eye[3], low, high;
        char name[160];
        off(&s, 0.15 * side, eye);
        double value = shoot(&s, eye, s.p, sky, bounds, 1, 100);
        name_scene(&s, map, side, "medium", name);
        if (s.kind->family == CURVE) {
          low = high = !s.flip;
        } else if (s.kind->outward == 0) {
          low = high = side < 0;
        } else if (side > 0) {
          low = s.outward ? 0.01 : 0;
          high = s.outward ? 0.9 : 0;
        } else {
          low = high = s.outward;
        }
        if (!(value >= low - 1e-3 && value <= high + 1e-3))
          fail_msg("%s: %g, expected %g to %g", name, value, low, high);
      }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lights_shine_to_the_side_of_the_normal),
      cmocka_unit_test(media_lie_behind_the_normal),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
