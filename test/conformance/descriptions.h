/* conformance/descriptions.h: the law of descriptions: two of one material scatter alike, such
 * as hair by its pigments and by what these absorb, a metal by its reflectance and by its
 * index, and a plane that is bumped and one that is tilted. */
#ifndef TEST_CONFORMANCE_DESCRIPTIONS_H
#define TEST_CONFORMANCE_DESCRIPTIONS_H

#include "conformance.h"
#include "shading.h"
#include "unit.h"

/* ---- parameters -------------------------------------------------------------------------- */

/* Of hair whose reflectance is given, absorption by Chiang et al. 2016, equation 9: of the
 * reflectance c and the roughness b,
 * (ln c / (5.969 - .215 b + 2.532 b^2 - 10.73 b^3 + 5.574 b^4 + .245 b^5))^2. Pigments: pbrt
 * book 9.9.7. A metal of the reflectance r has the index 1 and the absorption 2 sqrt(r / (1 -
 * r)). */
static const struct {
  const char *kind, *one, *other;
} described[] = {
    {"hair", "\"float eumelanin\" 1.3 \"float pheomelanin\" .7",
     "\"rgb sigma_a\" [.6756 1.1861 2.516]"},
    {"hair", "\"rgb reflectance\" [.5 .2 .05] \"float beta_n\" .9",
     "\"rgb sigma_a\" [.033167173 .17881584 .6195317] \"float beta_n\" .9"},
    {"hair", "\"rgb reflectance\" [.5 .2 .05] \"float beta_n\" .4",
     "\"rgb sigma_a\" [.014548844 .078437914 .27175877] \"float beta_n\" .4"},
    {"conductor", "\"rgb reflectance\" [.98 .98 .98] \"float roughness\" .3",
     "\"spectrum eta\" [300 1 900 1] \"spectrum k\" [300 14 900 14] \"float roughness\" .3"},
};

static Scattering *scattering_of_kind(const char *kind, const char *parameters) {
  static char text[TEXT];
  scene_text(text, material_form, kind, parameters);
  return scattering_of(need_scene(text), text);
}

/* Densities are left out: hair's are of all four channels, also of the one that RGB has not. */
static void check_descriptions(void) {
  for (size_t i = 0; i < sizeof described / sizeof *described; i++) {
    char what[200];
    snprintf(what, sizeof what, "%.80s, and %.100s", described[i].one, described[i].other);
    check_same_scattering(described[i].kind, what,
                          scattering_of_kind(described[i].kind, described[i].one),
                          scattering_of_kind(described[i].kind, described[i].other), false);
  }
}

/* ---- a bumped plane ---------------------------------------------------------------------- */

/* A brushed metal on a square whose corners lie at these heights, or whose bumps do. */
static Scattering *tilted_metal(bool bumped) {
  static char text[TEXT];
  static const char *const corners[2] = {"[-1 -1 -.7 1 -1 -.1 -1 1 .1 1 1 .7]",
                                         "[-1 -1 0 1 -1 0 -1 1 0 1 1 0]"};
  snprintf(text, sizeof text,
           HEAD
           "WorldBegin LightSource \"infinite\" Texture \"h\" \"float\" \"bilerp\" "
           "\"float v00\" 0 \"float v01\" .8 \"float v10\" .6 \"float v11\" 1.4\n"
           "Material \"conductor\" \"float uroughness\" .05 \"float vroughness\" .5 %s "
           "Shape \"bilinearmesh\" \"point3 P\" %s",
           bumped ? "\"texture displacement\" \"h\"" : "", corners[bumped]);
  return scattering_of(need_scene(text), text);
}

static void laws_of_descriptions(void **state) {
  (void)state;
  check_descriptions();
  check_same_scattering("conductor", "bumps that tilt a plane, and a tilted plane",
                        tilted_metal(true), tilted_metal(false), true);
  expect_no_failures();
}

#endif
