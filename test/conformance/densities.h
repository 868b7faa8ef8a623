/* conformance/densities.h: the extinction of media at points: that of the kind's formula, and
 * nowhere above its majorant. */
#ifndef TEST_CONFORMANCE_DENSITIES_H
#define TEST_CONFORMANCE_DENSITIES_H

#include "../world/plain_noise.h"
#include "conformance.h"
#include "medium/lookup.h"
#include "parameter_cases.h"
#include "transport.h"
#include "unit.h"

/* Points of the box whose x and y are inside of what the formulas describe (Roberts's sequence
 * R3). */
static void point_in_box(uint32_t i, double p[3]) {
  p[0] = 0.49 * (2 * fmod(0.5 + i * 0.8191725133961645, 1.0) - 1);
  p[1] = 0.49 * (2 * fmod(0.5 + i * 0.6710436067037893, 1.0) - 1);
  p[2] = 2 * fmod(0.5 + i * 0.5497004779019703, 1.0) - 1;
}

static vlMediumLight medium_at(const vlWorldMedium *m, const double p[3]) {
  const float lambda[4] = {450, 500, 550, 600};
  const vlMediumLight whole = vl_medium_coefficients(m, lambda);
  const vlVec3 at = vl_vec3((float)p[0], (float)p[1], (float)p[2]);
  return m->uniform ? whole : vl_medium_at(m, &whole, lambda, at, true);
}
static double extinction_at(const vlWorldMedium *m, const double p[3]) {
  const vlMediumLight here = medium_at(m, p);
  return (double)here.a[1] + (double)here.s[1];
}

/* The majorant of the cell around a point of a medium whose space is the world's. */
static double majorant_at(const vlWorldMedium *m, const double p[3]) {
  const float lambda[4] = {450, 500, 550, 600};
  const vlMediumLight whole = vl_medium_coefficients(m, lambda);
  size_t at = 0;
  for (int k = 2; k >= 0; k--) {
    const double low = (double)m->low[k];
    const double q = (p[k] - low) / ((double)m->high[k] - low) * m->cells[k];
    const uint32_t cell = q > 0 ? (uint32_t)q : 0;
    at = at * m->cells[k] + (cell < m->cells[k] ? cell : m->cells[k] - 1);
  }
  const double factor = m->own_sigma ? 1 : (double)whole.a[1] + (double)whole.s[1];
  return factor * (double)m->majorants[at];
}

/* Of how many points of its whole box the extinction is above the majorant. */
static uint32_t above_majorants(const vlWorldMedium *m, uint32_t points) {
  uint32_t above = 0;
  for (uint32_t i = 0; i < points && !m->uniform; i++) {
    double p[3];
    point_in_box(i, p);
    p[0] /= 0.49;
    p[1] /= 0.49;
    for (int k = 0; k < 3; k++)
      p[k] = (double)m->low[k] + ((double)m->high[k] - (double)m->low[k]) * 0.5 * (p[k] + 1);
    above += extinction_at(m, p) > majorant_at(m, p) * (1 + 1e-5);
  }
  return above;
}

/* The world of a box of the medium. */
static vlWorld *world_of_medium(const char *kind, const char *parameters, vlColorMode color) {
  static char text[TEXT];
  vlError error = {0};
  vlWorld *world;
  scene_text(text, medium_form, kind, parameters);
  vlScene *scene = need_scene(text);
  vlBuildDef def = vl_default_build_def();
  def.color = color;
  if (vl_world_build(scene, &def, &world, &error) != VL_OK)
    fail_msg("media %s: %s", kind, error.message);
  assert_int_equal(world->media.count, 1);
  vl_scene_destroy(scene);
  return world;
}

/* Two descriptions of one emission, in the middle of the box, where no grid fades. */
static void check_emission_of_heat(const char *kind, const MediumCase *c) {
  enum { POINTS = 500 };
  vlWorld *worlds[2] = {world_of_medium(kind, c->hot[0], VL_COLOR_SPECTRAL),
                        world_of_medium(kind, c->hot[1], VL_COLOR_SPECTRAL)};
  uint32_t wrong = 0;
  double sum = 0;
  for (uint32_t i = 0; i < POINTS; i++) {
    double p[3];
    point_in_box(i, p);
    p[2] *= 0.49;
    const double a = (double)medium_at(&worlds[0]->media.items[0], p).le[0];
    const double b = (double)medium_at(&worlds[1]->media.items[0], p).le[0];
    sum += a;
    wrong += fabs(a - b) > 1e-3 * b;
  }
  if (wrong || !(sum > 0))
    broken("media", kind, "%s: the emission of %u of %u points is not that of %s", c->hot[0],
           wrong, POINTS, c->hot[1]);
  vl_world_destroy(worlds[0]);
  vl_world_destroy(worlds[1]);
}

/* The luminance of the emission at a point: the integral over wavelengths of the observer's y.
 */
static double luminance_at(const vlWorldMedium *m, bool rgb, const double p[3]) {
  const vlVec3 at = vl_vec3((float)p[0], (float)p[1], (float)p[2]);
  const float *y = vl_cie_y();
  double sum = 0;
  for (int i = 0; i + 3 < VL_LAMBDA_COUNT; i += 4) {
    const int k = VL_LAMBDA_MIN + i;
    const float lambda[4] = {(float)k, (float)(k + 1), (float)(k + 2), (float)(k + 3)};
    const vlMediumLight all = vl_medium_coefficients(m, lambda);
    const vlMediumLight here = vl_medium_at(m, &all, lambda, at, true);
    if (rgb)
      return 0.212639 * (double)here.le[0] + 0.715169 * (double)here.le[1] +
             0.072192 * (double)here.le[2];
    for (int c = 0; c < 4; c++)
      sum += (double)y[i + c] * (double)here.le[c];
  }
  return sum;
}

/* Heat that one sees has the luminance in RGB that it has in wavelengths. (What glows less is
 * redder than RGB can say.) */
static void check_heat_in_rgb(const char *kind, const MediumCase *c) {
  enum { POINTS = 200 };
  vlWorld *rgb = world_of_medium(kind, c->hot[0], VL_COLOR_RGB);
  vlWorld *spectral = world_of_medium(kind, c->hot[0], VL_COLOR_SPECTRAL);
  uint32_t seen = 0;
  double worst = 0;
  for (uint32_t i = 0; i < POINTS; i++) {
    double p[3];
    point_in_box(i, p);
    p[2] *= 0.49;
    const double known = luminance_at(&spectral->media.items[0], false, p);
    if (known < 1)
      continue;
    seen++;
    worst = fmax(worst, fabs(luminance_at(&rgb->media.items[0], true, p) / known - 1));
  }
  if (!(worst < 0.02) || seen < POINTS / 4)
    broken("media", kind, "%s: in RGB the luminance of its emission is %.4f off", c->hot[0],
           worst);
  vl_world_destroy(rgb);
  vl_world_destroy(spectral);
}

/* The colour of the extinction at a point, seen under the white of sRGB. */
static void color_at(const vlWorldMedium *m, const double p[3], double rgb[3]) {
  const vlVec3 at = vl_vec3((float)p[0], (float)p[1], (float)p[2]);
  const float *const observer[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()};
  const float *white = vl_space_illuminant(VL_SPACE_SRGB);
  float matrix[9];
  double xyz[3] = {0};
  double whole = 0;
  vl_rgb_from_xyz(VL_SPACE_SRGB, matrix);
  for (int i = 0; i + 3 < VL_LAMBDA_COUNT; i += 4) {
    const int k = VL_LAMBDA_MIN + i;
    const float lambda[4] = {(float)k, (float)(k + 1), (float)(k + 2), (float)(k + 3)};
    const vlMediumLight all = vl_medium_coefficients(m, lambda);
    const vlMediumLight here = vl_medium_at(m, &all, lambda, at, false);
    for (int c = 0; c < 4; c++) {
      whole += (double)(observer[1][i + c] * white[i + c]);
      for (int j = 0; j < 3; j++)
        xyz[j] += (double)(observer[j][i + c] * white[i + c] * (here.a[c] + here.s[c]));
    }
  }
  for (int c = 0; c < 3; c++)
    rgb[c] = ((double)matrix[3 * c] * xyz[0] + (double)matrix[3 * c + 1] * xyz[1] +
              (double)matrix[3 * c + 2] * xyz[2]) /
             whole;
}

/* The extinction in wavelengths has the colour that it has in RGB. */
static void check_color_in_wavelengths(const char *kind, const char *parameters) {
  enum { POINTS = 40 };
  vlWorld *rgb = world_of_medium(kind, parameters, VL_COLOR_RGB);
  vlWorld *spectral = world_of_medium(kind, parameters, VL_COLOR_SPECTRAL);
  double worst = 0;
  for (uint32_t i = 0; i < POINTS; i++) {
    double p[3];
    double found[3];
    point_in_box(i, p);
    const vlMediumLight known = medium_at(&rgb->media.items[0], p);
    color_at(&spectral->media.items[0], p, found);
    for (int c = 0; c < 3; c++)
      worst = fmax(worst, fabs(found[c] - (double)(known.a[c] + known.s[c])));
  }
  if (!(worst < 0.01))
    broken("media", kind, "%s: in wavelengths the colour of its extinction is %.4f off",
           parameters, worst);
  vl_world_destroy(rgb);
  vl_world_destroy(spectral);
}

/* Of the medium that a scene describes; density: null: not known. */
static void check_densities(const char *kind, const char *parameters,
                            double (*density)(const double p[3], PlainNoise *noise)) {
  enum { POINTS = 2000 };
  uint32_t wrong = 0;
  double is = 0;
  double known = 0;
  vlWorld *world = world_of_medium(kind, parameters, VL_COLOR_RGB);
  const vlWorldMedium *m = &world->media.items[0];
  for (uint32_t i = 0; i < POINTS; i++) {
    double p[3];
    point_in_box(i, p);
    const double here = extinction_at(m, p);
    if (!density || fabs(density(p, plain_noise) - here) <= 0.01 * here + 2e-3)
      continue;
    wrong++;
    is = here;
    known = density(p, plain_noise);
  }
  if (wrong > POINTS / 25)
    broken("media", kind, "%s: the extinction of %u of %u points, such as %.4f, not %.4f",
           parameters, wrong, POINTS, is, known);
  const uint32_t above = above_majorants(m, POINTS);
  if (above)
    broken("media", kind, "%s: above its majorant at %u of %u points", parameters, above,
           POINTS);
  vl_world_destroy(world);
}

/* Majorants of grids in which one cell is much denser than all others, each cell in turn. */
static void check_dense_cells(const char *kind, const char *values, uint32_t channels,
                              vlColorMode color) {
  enum { CELLS_ALONG_X = 3, ALL_CELLS = 24, POINTS_OF_GRID = 400 };
  for (uint32_t dense = 0; dense < ALL_CELLS; dense++) {
    char all[1500];
    int n = snprintf(all, sizeof all,
                     "\"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] \"integer nx\" %d "
                     "\"integer ny\" 2 \"integer nz\" 4 %s [",
                     CELLS_ALONG_X, values);
    for (uint32_t i = 0; i < ALL_CELLS * channels; i++)
      n += snprintf(all + n, sizeof all - (size_t)n, "%s ",
                    i == dense * channels + dense % channels ? "9" : ".1");
    snprintf(all + n, sizeof all - (size_t)n, "]");
    vlWorld *world = world_of_medium(kind, all, color);
    const uint32_t above = above_majorants(&world->media.items[0], POINTS_OF_GRID);
    vl_world_destroy(world);
    if (above)
      broken("media", kind, "cell %u alone is dense: above its majorant at %u of %d points",
             dense, above, POINTS_OF_GRID);
  }
}

/* What is hotter than the hottest colour of RGB's table has that colour. */
static void check_hottest(void) {
  vlWorld *worlds[2];
  static const char *const temperatures[] = {"102500", "1e6"};
  double seen[2];
  for (int i = 0; i < 2; i++) {
    static const double middle[3] = {0, 0, 0};
    char all[300];
    snprintf(all, sizeof all,
             "\"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] \"integer nx\" 1 "
             "\"integer ny\" 1 \"integer nz\" 1 \"float density\" [1] "
             "\"float temperature\" [%s]",
             temperatures[i]);
    worlds[i] = world_of_medium("uniformgrid", all, VL_COLOR_RGB);
    seen[i] = luminance_at(&worlds[i]->media.items[0], true, middle);
    vl_world_destroy(worlds[i]);
  }
  if (!(seen[0] > 0 && seen[0] == seen[1]))
    broken("media", "uniformgrid", "the hottest colour: %g, and %g beyond it", seen[0],
           seen[1]);
}

static void laws_of_densities(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("media");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const MediumCase *c = medium_cases[k];
    const char *const forms[] = {c->absorbs, c->scatters, c->layers};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
      char all[2000];
      if (!forms[i])
        continue;
      snprintf(all, sizeof all, "%s%s", forms[i] == c->layers ? "" : c->shape, forms[i]);
      check_densities(family->rows[k]->name, all, i == 0 ? c->density : NULL);
      if (forms[i] == c->scatters)
        check_color_in_wavelengths(family->rows[k]->name, all);
    }
    if (c->hot[0])
      check_emission_of_heat(family->rows[k]->name, c);
    if (c->hot[0])
      check_heat_in_rgb(family->rows[k]->name, c);
    if (c->tall)
      check_densities(family->rows[k]->name, c->tall, NULL);
    if (c->blocks)
      check_densities(family->rows[k]->name, c->blocks, c->density_of_blocks);
  }
  check_dense_cells("uniformgrid", "\"float density\"", 1, VL_COLOR_RGB);
  check_dense_cells("rgbgrid", "\"rgb sigma_s\"", 3, VL_COLOR_RGB);
  check_dense_cells("rgbgrid", "\"rgb sigma_a\"", 3, VL_COLOR_SPECTRAL);
  check_hottest();
  expect_no_failures();
}

#endif
