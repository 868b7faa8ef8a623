/* import/pbrt/material_subsurface.c: Material "subsurface". What the body is made of is said in one of four ways, as
 * pbrt's: a measured one's name; absorption and scattering; the reflectance of a thick piece (and the mean free path);
 * nothing, which means whole milk. */
#include "import/pbrt/builder.h"

static bool refuse(vlDict *dict, const char *what) {
  return vl_import_fail(dict->import, VL_ERROR_SCENE, dict->place, "%s: %s", dict->what, what);
}

bool vl_import_subsurface(vlDict *dict, vlMaterialDef *def) {
  vlSubsurfaceDef *d = &def->subsurface;
  bool named, a, s, reflectance, mfp, has_g;
  vlSpectrum preset_a, preset_s;
  float g = 0.0f, eta = 1.33f;
  if (!vl_import_scattering_preset(dict, "name", &preset_a, &preset_s, &named) ||
      !vl_import_spectrum_input(dict, "sigma_a", &d->sigma_a, false, &a) ||
      !vl_import_spectrum_input(dict, "sigma_s", &d->sigma_s, false, &s) ||
      !vl_import_spectrum_input(dict, "reflectance", &def->reflectance, true, &reflectance) ||
      !vl_import_spectrum_input(dict, "mfp", &d->mfp, false, &mfp))
    return false;
  if (named + (a || s) + (reflectance || mfp) > 1)
    return refuse(
        dict, "give only one of \"name\", \"sigma_a\" and \"sigma_s\", \"reflectance\" (and \"mfp\"): each says all");
  if (a != s)
    return refuse(dict, a ? "\"sigma_s\" is missing beside \"sigma_a\"" : "\"sigma_a\" is missing beside \"sigma_s\"");
  if (mfp && !reflectance) return refuse(dict, "\"reflectance\" is missing beside \"mfp\"");
  vl_dict_float(dict, "scale", &def->scale);
  vl_dict_float(dict, "eta", &eta);
  has_g = vl_dict_float(dict, "g", &g);
  if (named && has_g && g != 0.0f) {
    vl_import_warn(dict->import, VL_LOG_WARNING, dict->place,
                   "%s: \"g\" is ignored beside \"name\": measured scattering is that of g = 0", dict->what);
    g = 0.0f;
  }
  if (named) d->sigma_a = vl_spectrum_input(preset_a), d->sigma_s = vl_spectrum_input(preset_s);
  d->from_reflectance = reflectance;
  def->g = vl_float_input(g);
  def->eta = vl_spectrum_input(vl_spectrum_constant(eta));
  return dict->import->scene->error.code == VL_OK;
}
