/* test/schema/test_lights.c: rows of lights, shapes and media: each parameter's default is in
 * its range and agrees with vl_parameter_is_default; a number out of range is rejected with a
 * message that names it; members that a kind does not use are not kept. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/scene.h"
#include "schema/schema.h"
#include "unit.h"
#include "velo/light.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"

static vlContext *context;

static int begin(void **state) {
  (void)state;
  return vl_context_create(NULL, &context);
}
static int end(void **state) {
  (void)state;
  size_t left = vl_context_memory(context, NULL);
  vl_context_destroy(context);
  return left != 0;
}

/* ---- defs of any family ------------------------------------------------------------------ */

typedef union Def {
  vlLightDef light;
  vlShapeDef shape;
  vlMediumDef medium;
} Def;

typedef struct Family {
  const vlKindFamily *family;
  void (*make)(int kind, Def *def);
  uint32_t (*add)(vlScene *scene, const Def *def);
} Family;

static void make_light(int kind, Def *def) {
  def->light = vl_default_light_def((vlLightKind)kind);
  if (vl_light_family.rows[kind]->traits & VL_LIGHT_TRAIT_IMAGE)
    def->light.path = "a.exr";
}
static uint32_t add_light(vlScene *scene, const Def *def) {
  return vl_scene_add_light(scene, &def->light).index;
}

static const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, widths[2] = {1, 1};
static const uint32_t face[4] = {0, 1, 2, 3};

static void make_shape(int kind, Def *def) {
  def->shape = vl_default_shape_def((vlShapeKind)kind);
  def->shape.positions = corners;
  def->shape.indices = face;
  def->shape.widths = widths;
  def->shape.vertices = 4;
  def->shape.faces = 1;
}
static uint32_t add_shape(vlScene *scene, const Def *def) {
  return vl_scene_add_shape(scene, &def->shape).index;
}

static void make_medium(int kind, Def *def) {
  static const float cell[3] = {1, 1, 1};
  def->medium = vl_default_medium_def((vlMediumKind)kind);
  def->medium.density = def->medium.rgb_a = cell;
  if (kind == VL_MEDIUM_NANOVDB)
    def->medium.path = "a.nvdb";
}
static uint32_t add_medium(vlScene *scene, const Def *def) {
  return vl_scene_add_medium(scene, &def->medium).index;
}

static const Family families[] = {{&vl_light_family, make_light, add_light},
                                  {&vl_shape_family, make_shape, add_shape},
                                  {&vl_medium_family, make_medium, add_medium}};

static void each(void (*visit)(const Family *, int kind)) {
  for (size_t f = 0; f < sizeof families / sizeof *families; f++)
    for (uint32_t k = 0; k < families[f].family->kind_count; k++)
      visit(&families[f], (int)k);
}

/* ---- defaults ---------------------------------------------------------------------------- */

static void is_accepted(const Family *family, int kind) {
  Def def;
  vlScene *scene;
  vlError error;
  const vlKindRow *row = family->family->rows[kind];
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  family->make(kind, &def);
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    bool comparable = p->type != VL_PARAMETER_BLOCK && p->type != VL_PARAMETER_FILE;
    if (!comparable || (p->flags & VL_PARAMETER_SHORTHAND))
      continue;
    if (!vl_parameter_is_default(p, &def, true))
      fail_msg("%s: %s is not its default", row->name, p->member);
  }
  if (!family->add(scene, &def)) {
    vl_scene_result(scene, &error);
    fail_msg("%s: %s", row->name, error.message);
  }
  vl_scene_destroy(scene);
}
static void defaults(void **state) {
  (void)state;
  each(is_accepted);
}

/* ---- ranges ------------------------------------------------------------------------------ */

/* A number just outside of an end of the range; false: that end has none. */
static bool beyond(const vlParameter *p, bool high, double *x) {
  if ((p->low == 0 && p->high == 0) || (high && isinf(p->high)))
    return false;
  *x = high ? p->high : p->low;
  bool excluded = p->flags & (high ? VL_PARAMETER_BELOW_HIGH : VL_PARAMETER_ABOVE_LOW);
  double step = excluded ? 1e-6 * fabs(*x) : 1e-3 + fabs(*x); /* ends are no floats */
  *x += high ? step : -step;
  return true;
}

static bool set_number(const vlParameter *p, Def *def, double x) {
  void *at = (char *)def + p->offset;
  if (p->type == VL_PARAMETER_FLOAT) {
    *(float *)at = (float)x;
    return true;
  }
  if (p->type == VL_PARAMETER_COUNT && x >= 0) {
    *(uint32_t *)at = (uint32_t)x;
    return true;
  }
  return false;
}

static void refuses(const Family *family, int kind, const vlParameter *p, double x) {
  Def def;
  vlScene *scene;
  vlError error;
  char name[80];
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  family->make(kind, &def);
  if (set_number(p, &def, x)) {
    uint32_t id = family->add(scene, &def);
    vl_scene_result(scene, &error);
    snprintf(name, sizeof name, "parameter \"%s\"", p->name ? p->name : p->member);
    if (id || error.code != VL_ERROR_SCENE || !strstr(error.message, name))
      fail_msg("%s: %s = %g is not refused: %s", family->family->rows[kind]->name, p->member, x,
               error.message);
  }
  vl_scene_destroy(scene);
}

static void has_ranges(const Family *family, int kind) {
  const vlKindRow *row = family->family->rows[kind];
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    double x;
    if (p->flags & (VL_PARAMETER_SHORTHAND | VL_PARAMETER_CLAMPED))
      continue;
    for (int high = 0; high < 2; high++)
      if (beyond(p, high, &x))
        refuses(family, kind, p, x);
    if (p->type == VL_PARAMETER_FLOAT)
      refuses(family, kind, p, NAN);
  }
}
static void ranges(void **state) {
  (void)state;
  each(has_ranges);
}

/* ---- what a kind does not read ----------------------------------------------------------- */

static void dropped(void **state) {
  (void)state;
  vlScene *scene;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlLightDef light = vl_default_light_def(VL_LIGHT_POINT);
  light.path = "a.exr";
  light.fov = NAN;
  assert_int_not_equal(vl_scene_add_light(scene, &light).index, 0);
  assert_null(scene->lights.items[0].path);
  assert_true(scene->lights.items[0].fov == vl_default_light_def(VL_LIGHT_POINT).fov);
  vlMediumDef medium = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  medium.density = corners;
  medium.path = "a.nvdb";
  medium.frequency = -1;
  assert_int_not_equal(vl_scene_add_medium(scene, &medium).index, 0);
  assert_null(scene->media.items[0].density);
  assert_null(scene->media.items[0].path);
  vl_scene_destroy(scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(defaults), cmocka_unit_test(ranges),
                                     cmocka_unit_test(dropped)};
  return cmocka_run_group_tests(tests, begin, end);
}
