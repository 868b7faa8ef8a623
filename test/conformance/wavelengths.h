/* conformance/wavelengths.h: the law of separate wavelengths. A parameter that is a spectrum of
 * two numbers, one in a band and one beside it, gives the light of the first number in the
 * band's light, and that of the second one in the rest. The band is so narrow that of the
 * wavelengths of a path at most one lies in it. */
#ifndef TEST_CONFORMANCE_WAVELENGTHS_H
#define TEST_CONFORMANCE_WAVELENGTHS_H

#include "parameters.h"
#include "transport.h"

enum { FIRST_OF_BAND = 540, LAST_OF_BAND = 590 };

/* The band's share of the luminance of white. Lights have the same luminance whatever their
 * spectrum, as in pbrt-v4. Spectra are tables of whole nanometres. */
static double share_of_band(void) {
  const float *y = vl_cie_y();
  double band = 0;
  double all = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    const int lambda = i + VL_LAMBDA_MIN;
    if (lambda >= FIRST_OF_BAND && lambda <= LAST_OF_BAND)
      band += (double)y[i];
    all += (double)y[i];
  }
  return band / all;
}

/* A spectrum: `in` in the band, `out` elsewhere. */
static const char *spectrum_of_band(char text[200], double in, double out) {
  snprintf(text, 200, "[360 %g %g %g %d %g %d %g %g %g 830 %g]", out, FIRST_OF_BAND - 0.1, out,
           FIRST_OF_BAND, in, LAST_OF_BAND, in, LAST_OF_BAND + 0.1, out, out);
  return text;
}

/* A scene in which one thing has a spectrum: where light comes from the spectrum of the light
 * is inserted twice, then comes the thing. */
typedef struct InBands {
  const char *family, *name; /* whose law it is */
  const char *form, *tracer;
  const char *kind, *base, *parameter; /* of the thing */
  const char *rest;                    /* of the scene, after the form */
  double is[2];                        /* what the parameter is in the band and beside it */
  double slack;                        /* shares of the band's light */
  double min;
  uint32_t spp;
} InBands;

#define BAND_VIEW \
  "LookAt 0 1.5 4 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 16\n" VIEW("12")
#define BAND_LIGHTS                                                 \
  "Integrator \"volpath\" \"integer maxdepth\" 4 WorldBegin\n"      \
  "LightSource \"infinite\" \"float scale\" .3 \"spectrum L\" %s\n" \
  "LightSource \"distant\" \"point3 from\" [2 3 1.5] \"spectrum L\" %s\n" NAMED

static const char *const material_in_bands = BAND_VIEW BAND_LIGHTS GROUND "Material %s ";
/* A floor beside a ball, seen alone: what it shows of the ball has passed two surfaces. */
static const char *const floor_in_bands =
    "LookAt 2.2 2 2 .75 -.6 .5 0 1 0 Camera \"perspective\" \"float fov\" 8\n" VIEW("12")
        BAND_LIGHTS
    "Material %s Shape \"bilinearmesh\" \"point3 P\" [-3 -.6 3 3 -.6 3 -3 -.6 -3 3 -.6 -3]\n";
/* In a world with a medium, light goes other ways through the program. */
#define MEDIUM_ELSEWHERE                                                              \
  "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" MediumInterface \"m\" \"\" " \
  "Material \"interface\" Translate 0 9 0 Shape \"sphere\" \"float radius\" .1\n"
/* A floor below the medium, seen from the side. Light comes through another medium, too. */
static const char *const medium_in_bands =
    "LookAt 0 -1.2 3 0 -2 0 0 1 0 Camera \"orthographic\" "
    "\"float screenwindow\" [-.2 .2 -.2 .2]\n" VIEW("12")
    "Integrator \"volpath\" \"integer maxdepth\" 3 WorldBegin\n"
    "LightSource \"distant\" \"point3 from\" [.05 1 0] \"point3 to\" [0 0 0] \"float scale\" .5 \"spectrum L\" %s\n"
    "LightSource \"distant\" \"point3 from\" [0 1 .05] \"point3 to\" [0 0 0] \"float scale\" .5 \"spectrum L\" %s\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -2 1 1 -2 1 -1 -2 -1 1 -2 -1]\n"
    "AttributeBegin Material \"interface\" MakeNamedMedium \"grey\" \"string type\" \"homogeneous\" "
    "\"rgb sigma_a\" [.4 .4 .4] \"rgb sigma_s\" [0 0 0] MediumInterface \"grey\" \"\" "
    "Translate 0 2.2 0 " BOX_FROM("-1", "1") "AttributeEnd\n"
    "AttributeBegin MakeNamedMedium \"m\" \"string type\" %s AttributeEnd\n"
    "MediumInterface \"m\" \"\" Material \"interface\"\n";

/* The image by light that is `lit[0]` in the band and `lit[1]` beside it, of a thing whose
 * parameter is `is[0]` in the band and `is[1]` beside it. */
static vlImage *image_in_bands(const InBands *x, const double lit[2], const double is[2]) {
  static char text[TEXT];
  char light[200];
  char value[200];
  char thing[2000];
  spectrum_of_band(light, lit[0], lit[1]);
  spectrum_of_band(value, is[0], is[1]);
  snprintf(thing, sizeof thing, "\"%s\" %s \"spectrum %s\" %s", x->kind, x->base, x->parameter,
           value);
  snprintf(text, sizeof text, x->form, light, light, thing);
  strcat(text, x->rest);
  return image_in(VL_COLOR_SPECTRAL, text, x->tracer, VL_PIXEL_FILTER_BOX, x->spp);
}

static void check_bands(const InBands *x) {
  static const double white[2] = {1, 1};
  static const double only[2][2] = {{1, 0}, {0, 1}};
  const double shares[2] = {share_of_band(), 1 - share_of_band()};
  vlImage *all = image_in_bands(x, white, x->is);
  vlImage *parts[2];
  for (int i = 0; i < 2; i++) {
    const double plain[2] = {x->is[i], x->is[i]};
    parts[i] = image_in_bands(x, only[i], plain);
  }
  Mean off = {0};
  for (uint32_t i = 0; i < WIDTH * WIDTH; i++) {
    double sum = 0;
    for (int k = 0; k < 2; k++)
      sum += shares[k] * (double)vl_image_get(parts[k], i % WIDTH, i / WIDTH, 1);
    mean_add(&off, (double)vl_image_get(all, i % WIDTH, i / WIDTH, 1) - sum);
  }
  const double whole = shares[0] * mean_of_green(parts[0]);
  char what[200];
  snprintf(what, sizeof what, "\"%s\" of %s in a band, by %s: off %.4f", x->parameter, x->kind,
           x->tracer, whole);
  check_mean(x->family, x->name, what, &off, 0, (Sight){x->slack * whole, x->min * whole});
  vl_image_destroy(all);
  vl_image_destroy(parts[0]);
  vl_image_destroy(parts[1]);
}

static bool is_spectrum(const vlParameter *p) {
  return p->name &&
         (p->type == VL_PARAMETER_SPECTRUM || p->type == VL_PARAMETER_SPECTRUM_INPUT) &&
         !(p->flags & (VL_PARAMETER_ONE_NUMBER | VL_PARAMETER_NUMBER));
}

/* What a spectrum is in the band and beside it: colours and what is absorbed are nothing in one
 * of them, so that three of four wavelengths carry no light; indices stay possible ones. */
static void numbers_of(const char *parameter, double is[2]) {
  const bool index = strstr(parameter, "eta") || strcmp(parameter, "k") == 0 ||
                     strstr(parameter, ".k") || strcmp(parameter, "mfp") == 0;
  is[0] = index ? 1.3 : 0.7;
  is[1] = index ? 1.7 : 0;
}

/* What leaves a solid comes from other points each time, and of dark hair little comes. */
static uint32_t samples_of(const char *material, const char *parameter) {
  const bool solid = strcmp(material, "subsurface") == 0;
  if (solid && strcmp(parameter, "reflectance") == 0)
    return 640;
  if (solid)
    return 128;
  return strcmp(material, "hair") == 0 ? 192 : 48;
}

static void check_material_bands(const vlKindRow *row) {
  InBands x = {.family = "materials", .name = row->name, .form = material_in_bands};
  x.tracer = "volpath";
  x.kind = row->name;
  x.rest = BALL;
  x.slack = 0.03;
  x.min = 0.2;
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    if (!is_spectrum(p))
      continue;
    const ParameterCase *c = find_case("materials", row->name, p->name);
    if (!c)
      c = find_case("materials", row->name, NULL);
    char base[TEXT] = "";
    append_base(base, c ? c->base : NULL, p->name);
    x.base = base;
    x.parameter = p->name;
    x.spp = samples_of(row->name, p->name);
    numbers_of(p->name, x.is);
    check_bands(&x);
  }
}

/* Light of a thing that a floor of the band's colour reflects to the eye. */
static void check_beside_floor(const char *family, const char *name, const char *tracer,
                               const char *rest) {
  InBands x = {.family = family, .name = name, .form = floor_in_bands, .tracer = tracer};
  x.kind = "diffuse";
  x.base = "";
  x.parameter = "reflectance";
  x.rest = rest;
  x.is[0] = 0.7;
  x.slack = 0.002;
  x.min = 0.03;
  x.spp = 64;
  check_bands(&x);
}

static void check_material_beside_floor(const vlKindRow *row) {
  const ParameterCase *c = find_case("materials", row->name, NULL);
  char base[TEXT] = "";
  char rest[TEXT];
  append_base(base, c ? c->base : NULL, NULL);
  snprintf(rest, sizeof rest, "Material \"%.40s\" %.2000s %s", row->name, base, BALL);
  check_beside_floor("materials", row->name, "volpath", rest);
}

static void check_medium_bands(const vlKindRow *row, const MediumCase *c) {
  static const char *const sigmas[2] = {"sigma_a", "sigma_s"};
  InBands x = {.family = "media", .name = row->name, .form = medium_in_bands};
  x.tracer = "volpath";
  x.kind = row->name;
  x.rest = BOX_FROM("-1", "1");
  x.spp = 96;
  x.is[1] = 50;
  x.slack = 0.03;
  x.min = 0.2;
  for (int i = 0; i < 2; i++) {
    char base[TEXT];
    bool there = false;
    for (uint32_t k = 0; k < row->parameter_count; k++)
      there |=
          is_spectrum(&row->parameters[k]) && strcmp(row->parameters[k].name, sigmas[i]) == 0;
    if (!there)
      continue;
    /* of a parameter that is given twice the last value counts */
    snprintf(base, sizeof base, "%s %s \"spectrum %s\" [360 0 830 0]", c->shape, c->absorbs,
             sigmas[1 - i]);
    x.base = base;
    x.parameter = sigmas[i];
    check_bands(&x);
  }
}

static void laws_of_wavelengths(void **state) {
  (void)state;
  const vlKindFamily *materials = vl_kind_family_find("materials");
  const vlKindFamily *media = vl_kind_family_find("media");
  const vlKindFamily *tracers = vl_kind_family_find("tracers");
  for (uint32_t k = 0; k < materials->kind_count; k++) {
    check_material_bands(materials->rows[k]);
    check_material_beside_floor(materials->rows[k]);
  }
  for (uint32_t k = 0; k < media->kind_count; k++)
    check_medium_bands(media->rows[k], medium_cases[k]);
  for (uint32_t k = 0; k < tracers->kind_count; k++) {
    const char *name = tracers->rows[k]->name;
    if (!tracer_cases[k]->room_spp)
      continue;
    check_beside_floor("tracers", name, name, "Material \"diffuse\" " BALL);
    check_beside_floor("tracers", name, name, "Material \"diffuse\" " BALL MEDIUM_ELSEWHERE);
  }
  expect_no_failures();
}

#endif
