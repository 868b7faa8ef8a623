/* conformance/repeated.h: the law of repeated parameters: the last of several values counts, of
 * every parameter of every kind. */
#ifndef TEST_CONFORMANCE_REPEATED_H
#define TEST_CONFORMANCE_REPEATED_H

#include "conformance.h"
#include "parameters.h"
#include "unit.h"

/* The scene of a kind with these values of a parameter, as velo writes it. False: it cannot be
 * read. */
static bool write_values(const Family *family, const vlKindRow *row, const char *base,
                         const char *name, const char *values, Written *w) {
  static char parameters[TEXT];
  static char text[TEXT];
  vlError error = {0};
  parameters[0] = 0;
  append_base(parameters, base, name);
  strcat(parameters, values);
  scene_text(text, form_of(family, row), row->name, parameters);
  vlScene *scene = load_text(context, text, &error);
  if (!scene)
    return false;
  vl_scene_destroy(scene);
  return write_scene_of(text, "pbrt", w);
}

/* Whether two values could be compared. */
static bool check_repeated(const Family *family, const vlKindRow *row, const vlParameter *p) {
  static Written last, both;
  const ParameterCase *kind_case = find_case(family->name, row->name, NULL);
  const ParameterCase *c = find_case(family->name, row->name, p->name);
  const char *base = c && c->base ? c->base : kind_case ? kind_case->base : NULL;
  char values[3][TEXT] = {"", "", ""};
  const bool floats = is_float_texture(family, row);
  if ((c && c->value) || !append_value(values[0], p, floats, 0) ||
      !append_value(values[1], p, floats, 1))
    return false;
  snprintf(values[2], TEXT, "%.200s %.200s", values[0], values[1]);
  if (!write_values(family, row, base, p->name, values[1], &last) ||
      !write_values(family, row, base, p->name, values[2], &both))
    return false;
  if (both.size != last.size || memcmp(both.bytes, last.bytes, last.size) != 0)
    broken(family->name, row->name, "%s is not %s", values[2], values[1]);
  return strcmp(values[0], values[1]) != 0;
}

static void repeated_parameters(void **state) {
  (void)state;
  int compared = 0;
  for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
    const vlKindFamily *rows = vl_kind_family_find(families[f].name);
    for (uint32_t i = 0; i < rows->kind_count; i++) {
      const vlKindRow *row = rows->rows[i];
      for (uint32_t k = 0; row->name && k < row->parameter_count; k++)
        if (row->parameters[k].name)
          compared += check_repeated(&families[f], row, &row->parameters[k]);
    }
  }
  print_message("parameters given twice: %d\n", compared);
  assert_true(compared > 100);
  expect_no_failures();
}

#endif
