/* test/film/test_film_header.c: the header of a film file has every parameter of every pixel
 * filter: what is written is read, and films that differ in one parameter are not of one
 * render. Each parameter is a setting, too. */
#include <stdio.h>
#include <string.h>

#include "film/file.h"
#include "schema/schema.h"
#include "unit.h"
#include "velo/filter_kinds.h"
#include "velo/schema.h"
#include "velo/setting.h"

static vlContext *context;

static int begin(void **state) {
  (void)state;
  return vl_context_create(NULL, &context) != VL_OK;
}

static int end(void **state) {
  (void)state;
  vl_context_destroy(context);
  return 0;
}

static vlFilmShape shape_of(uint32_t kind) {
  vlFilmShape shape = {.def = vl_default_film_def(8, 6), .sequence = 4};
  shape.def.filter = vl_default_pixel_filter((vlPixelFilterKind)kind);
  shape.def.crop[2] = 8;
  shape.def.crop[3] = 6;
  return shape;
}

/* Writes and reads a header. skip: the name of a member that is left out; may be null. */
static vlResult through_header(const vlFilmShape *shape, const char *skip, vlFilmShape *read) {
  vlFilmTexts texts = {NULL, NULL};
  vlError error = {0};
  char *text = vl_film_header_make(context, shape, &texts);
  assert_non_null(text);
  char *line = skip ? strstr(text, skip) : NULL;
  if (line)
    memcpy(line, "other", strlen("other"));
  vlResult result =
      vl_film_header_read(context, "a.film", text, strlen(text), read, &texts, &error);
  vl_free(context, text);
  return result;
}

static void every_parameter_of_filters(void **state) {
  (void)state;
  const vlKindFamily *filters = vl_kind_family_find("filters");
  for (uint32_t kind = 0; kind < filters->kind_count; kind++)
    for (uint32_t i = 0; i < filters->rows[kind]->parameter_count; i++) {
      const vlParameter *p = &filters->rows[kind]->parameters[i];
      const vlMemberType *type = &vl_member_types[p->type];
      vlFilmShape plain = shape_of(kind), other = plain, read;
      char *at = (char *)&other.def.filter + p->offset;
      type->put(at, 0, 0.75 * vl_member_number(type, at, 0) + 0.0625);
      assert_false(vl_film_same_shape(&plain, &other));
      assert_int_equal(through_header(&other, NULL, &read), VL_OK);
      if (!vl_film_same_shape(&read, &other) || vl_film_same_shape(&read, &plain))
        fail_msg("%s of %s is not read as it was written", p->name, filters->rows[kind]->name);
      char name[64];
      snprintf(name, sizeof name, "filter_%s", p->member);
      assert_int_equal(through_header(&other, name, &read), VL_ERROR_SCENE);
    }
}

/* What only other filters have may be missing: a film of before there was such a filter. */
static void parameters_of_other_filters(void **state) {
  (void)state;
  vlFilmShape plain = shape_of(VL_PIXEL_FILTER_BOX), read;
  assert_int_equal(through_header(&plain, "filter_tau", &read), VL_OK);
  assert_true(vl_film_same_shape(&plain, &read));
}

static void every_parameter_is_a_setting(void **state) {
  (void)state;
  const vlKindFamily *filters = vl_kind_family_find("filters");
  for (uint32_t kind = 0; kind < filters->kind_count; kind++)
    for (uint32_t i = 0; i < filters->rows[kind]->parameter_count; i++) {
      char name[64];
      snprintf(name, sizeof name, "filter_%s", filters->rows[kind]->parameters[i].member);
      if (!vl_setting(VL_SETTING_RENDER, name))
        fail_msg("schema/settings.c has no row %s", name);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_parameter_of_filters),
                                     cmocka_unit_test(parameters_of_other_filters),
                                     cmocka_unit_test(every_parameter_is_a_setting)};
  return cmocka_run_group_tests(tests, begin, end);
}
