/* import/pbrt/material_principled.c: Material "principled", velo's own word in pbrt's language: glTF's layered
 * material, with its parameters' names in small letters. */
#include "import/pbrt/builder.h"

bool vl_import_principled(vlDict *dict, vlMaterialDef *def) {
  vlPrincipledDef *p = &def->principled;
  const struct {
    const char *name;
    vlFloatInput *input;
  } floats[] = {{"metallic", &p->metallic},
                {"roughness", &p->roughness},
                {"anisotropy", &p->anisotropy},
                {"specular", &p->specular},
                {"transmission", &p->transmission},
                {"diffusetransmission", &p->diffuse_transmission},
                {"clearcoat", &p->clearcoat},
                {"clearcoatroughness", &p->clearcoat_roughness},
                {"sheenroughness", &p->sheen_roughness},
                {"iridescence", &p->iridescence},
                {"iridescencethickness", &p->iridescence_thickness}};
  const struct {
    const char *name;
    vlSpectrumInput *input;
  } spectra[] = {{"basecolor", &def->reflectance},
                 {"specularcolor", &p->specular_color},
                 {"diffusetransmissioncolor", &p->diffuse_transmission_color},
                 {"sheencolor", &p->sheen_color}};
  for (size_t i = 0; i < sizeof floats / sizeof *floats; i++)
    if (!vl_import_float_input(dict, floats[i].name, floats[i].input, NULL)) return false;
  for (size_t i = 0; i < sizeof spectra / sizeof *spectra; i++)
    if (!vl_import_spectrum_input(dict, spectra[i].name, spectra[i].input, true, NULL)) return false;
  float eta = 1.5f, degrees = 0.0f;
  vl_dict_float(dict, "eta", &eta);
  vl_dict_float(dict, "anisotropyrotation", &degrees);
  vl_dict_float(dict, "dispersion", &p->dispersion);
  vl_dict_float(dict, "iridescenceeta", &p->iridescence_ior);
  vl_dict_bool(dict, "thinwalled", &p->thin_walled);
  def->eta = vl_spectrum_input(vl_spectrum_constant(eta));
  p->anisotropy_rotation = vl_float_input(degrees * 0.017453292f);
  return dict->import->scene->error.code == VL_OK;
}
