/* import/pbrt/material_hair.c: Material "hair". Its colour is given in one of three ways; as pbrt's, the first of
 * sigma_a, reflectance (also "color") and the melanins counts. */
#include "import/pbrt/builder.h"

bool vl_import_hair(vlDict *dict, vlMaterialDef *def) {
  vlHairDef *h = &def->hair;
  bool sigma, reflectance, color, eu, pheo;
  vlFloatInput eumelanin = vl_float_input(0.0f);
  vlSpectrumInput old = def->reflectance;
  if (!vl_import_spectrum_input(dict, "sigma_a", &h->sigma_a, false, &sigma) ||
      !vl_import_spectrum_input(dict, "reflectance", &def->reflectance, true, &reflectance) ||
      !vl_import_spectrum_input(dict, "color", &old, true, &color) ||
      !vl_import_float_input(dict, "eumelanin", &eumelanin, &eu) ||
      !vl_import_float_input(dict, "pheomelanin", &h->pheomelanin, &pheo) ||
      !vl_import_float_input(dict, "eta", &h->eta, NULL) || !vl_import_float_input(dict, "beta_m", &h->beta_m, NULL) ||
      !vl_import_float_input(dict, "beta_n", &h->beta_n, NULL) ||
      !vl_import_float_input(dict, "alpha", &h->alpha, NULL))
    return false;
  if (color && !reflectance) def->reflectance = old, reflectance = true;
  if (eu || pheo) h->eumelanin = eumelanin;
  h->color = sigma ? VL_HAIR_SIGMA_A : reflectance ? VL_HAIR_REFLECTANCE : VL_HAIR_MELANIN;
  if ((sigma && (reflectance || eu || pheo)) || (reflectance && (eu || pheo)))
    vl_import_warn(dict->import, VL_LOG_WARNING, dict->place,
                   "%s: its colour is given in several ways; sigma_a comes before reflectance, that before melanin",
                   dict->what);
  return true;
}
