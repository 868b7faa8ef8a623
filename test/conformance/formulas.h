/* conformance/formulas.h: the law of formulas: a material whose case has its BSDF as a formula
 * scatters by it into all directions. */
#ifndef TEST_CONFORMANCE_FORMULAS_H
#define TEST_CONFORMANCE_FORMULAS_H

#include "conformance.h"
#include "materials.h"
#include "shading.h"
#include "unit.h"

/* Kernels are in float: values are compared to 2 %, and to 1e-4 of the largest one. */
static void check_formula(const char *kind, const MaterialVariant *variant) {
  static char text[TEXT];
  static double known[VL_OWN_BATCH][3];
  /* the eye of scattering_of sees the square at y = .2, where v is .6 */
  MaterialAt at = {.across = 0.2};
  double max = 0;
  uint32_t wrong = 0;
  uint32_t last = 0;
  scene_text(text, material_form, kind, variant->parameters);
  Scattering *s = scattering_of(need_scene(text), text);
  eye_direction(0.6, at.out);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    even_direction(i, VL_OWN_BATCH, 0.1, at.in);
    variant->formula(&at, known[i]);
    for (int c = 0; c < 3; c++)
      max = fmax(max, known[i][c]);
  }
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    for (int c = 0; c < 3; c++) {
      const double off = fabs((double)s->value[c][i] - known[i][c]);
      if (off <= 0.02 * known[i][c] + 1e-4 * max)
        continue;
      wrong++;
      last = 3 * i + (uint32_t)c;
    }
  if (wrong)
    broken("materials", kind,
           "%s: %u of %u values are not the formula's, the last %.5g, not %.5g",
           variant->parameters, wrong, 3 * VL_OWN_BATCH, (double)s->value[last % 3][last / 3],
           known[last / 3][last % 3]);
  free_scattering(s);
}

static void formulas_of_materials(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("materials");
  int compared = 0;
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const MaterialVariant *variants = material_cases[k]->variants;
    for (int i = 0; i < MATERIAL_VARIANTS && variants[i].parameters; i++)
      if (variants[i].formula) {
        check_formula(family->rows[k]->name, &variants[i]);
        compared++;
      }
  }
  assert_true(compared > 4);
  expect_no_failures();
}

#endif
