/* scene/add.c: textures, materials, emissions and lights come in: checked, then copied. Ids may only name what was
 * added before, so neither textures nor mixed materials can form a circle. */
#include <math.h>

#include "base/cookie.h"
#include "color/color.h"
#include "scene/scene.h"

enum { MAX_OBJECTS = 0x7fffffff };

static bool is_finite_matrix(const double m[16]) {
  for (int i = 0; i < 16; i++)
    if (!isfinite(m[i])) return false;
  return true;
}

/* Ready for one more? Says what stands in the way otherwise. */
static bool may_add(vlScene *scene, const void *def, bool cookie, size_t count, vlSource source, const char *what) {
  if (scene->error.code != VL_OK) return false;
  if (!def || !cookie) {
    vl_scene_fail(scene, VL_ERROR_ARGUMENT, source, "%s: the def does not come from vl_default_%s_def()", what, what);
    return false;
  }
  if (count >= MAX_OBJECTS) vl_scene_fail(scene, VL_ERROR_SCENE, source, "too many objects");
  return count < MAX_OBJECTS;
}

static bool bad(vlScene *scene, vlSource source, const char *what, const char *why) {
  vl_scene_fail(scene, VL_ERROR_SCENE, source, "%s: %s", what, why);
  return false;
}

static bool out_of_memory(vlScene *scene) {
  vl_scene_fail(scene, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
  return false;
}

static bool check_texture(vlScene *scene, vlTextureId id, bool spectrum, vlSource source, const char *what) {
  if (id.index == 0) return true;
  if (id.index > scene->textures.count) return bad(scene, source, what, "there is no such texture");
  if (scene->textures.items[id.index - 1].spectrum != spectrum)
    return bad(scene, source, what,
               spectrum ? "needs a spectrum texture, this is a float texture"
                        : "needs a float texture, this is a spectrum texture");
  return true;
}

static bool take_float(vlScene *scene, const vlFloatInput *input, vlSource source, const char *what) {
  if (!check_texture(scene, input->texture, false, source, what)) return false;
  return input->texture.index || isfinite(input->value) || bad(scene, source, what, "value is not finite");
}

static bool take_spectrum(vlScene *scene, vlSpectrumInput *input, vlSource source, const char *what) {
  if (!check_texture(scene, input->texture, true, source, what)) return false;
  if (input->texture.index) {
    input->value = vl_spectrum_constant(1.0f);
    return true;
  }
  return vl_scene_copy_spectrum(scene, &input->value, source, what);
}

/* ---- textures --------------------------------------------------------------------------------------------------- */

static bool check_texture_def(vlScene *scene, const vlTextureDef *d) {
  if ((unsigned)d->kind > VL_TEXTURE_VERTEX_COLOR) return bad(scene, d->source, "texture", "unknown kind");
  if (!is_finite_matrix(d->texture_from_world)) return bad(scene, d->source, "texture", "transform is not finite");
  const float numbers[] = {d->su,
                           d->sv,
                           d->du,
                           d->dv,
                           d->scale,
                           d->direction[0],
                           d->direction[1],
                           d->direction[2],
                           d->planar_v1[0],
                           d->planar_v1[1],
                           d->planar_v1[2],
                           d->planar_v2[0],
                           d->planar_v2[1],
                           d->planar_v2[2],
                           d->bias,
                           d->omega,
                           d->variation,
                           d->tint[0],
                           d->tint[1],
                           d->tint[2],
                           d->tint[3],
                           d->st_from_uv[0],
                           d->st_from_uv[1],
                           d->st_from_uv[2],
                           d->st_from_uv[3],
                           d->st_from_uv[4],
                           d->st_from_uv[5]};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    if (!isfinite(numbers[i])) return bad(scene, d->source, "texture", "a number is not finite");
  if (d->octaves > 64) return bad(scene, d->source, "texture", "noise has at most 64 octaves");
  bool noise = d->kind == VL_TEXTURE_FBM || d->kind == VL_TEXTURE_WRINKLED || d->kind == VL_TEXTURE_WINDY;
  if ((noise && d->spectrum) || (d->kind == VL_TEXTURE_MARBLE && !d->spectrum))
    return bad(scene, d->source, "texture", "noise is a float texture, marble a colour");
  if (d->kind == VL_TEXTURE_CHECKERBOARD && d->dimension != 2 && d->dimension != 3)
    return bad(scene, d->source, "checkerboard", "dimension must be 2 or 3");
  if (d->kind == VL_TEXTURE_IMAGE) {
    if (!!d->path + !!d->image + !!d->data != 1)
      return bad(scene, d->source, "image texture", "needs either a file name or an image");
    if (d->channel < -1 || d->channel > 3) return bad(scene, d->source, "image texture", "its channels are 0 to 3");
    if (d->uv_set > 3) return bad(scene, d->source, "image texture", "uv sets are 0 to 3");
    if (d->encoding_given && d->encoding == VL_ENCODING_GAMMA && !(d->gamma > 0.0f && isfinite(d->gamma)))
      return bad(scene, d->source, "image texture", "gamma must be above 0");
  }
  return true;
}

static vlTextureId add_texture(vlScene *scene, const vlTextureDef *def, bool adopt) {
  const vlTextureId none = {0};
  if (!may_add(scene, def, def && def->cookie == VL_COOKIE_TEXTURE, scene->textures.count, (vlSource){0}, "texture"))
    return none;
  vlTextureDef d = *def;
  if (!vl_scene_copy_source(scene, &d.source) || !check_texture_def(scene, &d)) return none;
  /* how many of the inputs a kind reads: constant and scale one, most two, bilerp four, an image none */
  int inputs = d.kind == VL_TEXTURE_BILERP                                   ? 4
               : d.kind == VL_TEXTURE_IMAGE                                  ? 0
               : d.kind == VL_TEXTURE_VERTEX_COLOR                           ? 0
               : d.kind >= VL_TEXTURE_FBM && d.kind <= VL_TEXTURE_MARBLE     ? 0
               : d.kind == VL_TEXTURE_CONSTANT || d.kind == VL_TEXTURE_SCALE ? 1
                                                                             : 2;
  vlFloatInput *floats[4] = {&d.float_a, &d.float_b, &d.float_c, &d.float_d};
  vlSpectrumInput *spectra[4] = {&d.spectrum_a, &d.spectrum_b, &d.spectrum_c, &d.spectrum_d};
  for (int i = 0; i < 4; i++) {
    bool used = i < inputs;
    if (used && !d.spectrum && !take_float(scene, floats[i], d.source, "texture input")) return none;
    if (used && d.spectrum && !take_spectrum(scene, spectra[i], d.source, "texture input")) return none;
    if (!used || d.spectrum) *floats[i] = vl_float_input(0.0f);
    if (!used || !d.spectrum) *spectra[i] = vl_spectrum_input(vl_spectrum_constant(0.0f));
  }
  bool uses_amount = d.kind == VL_TEXTURE_SCALE || d.kind == VL_TEXTURE_MIX;
  if (!uses_amount) d.amount = vl_float_input(0.0f);
  if (!take_float(scene, &d.amount, d.source, "amount")) return none;
  if (d.kind != VL_TEXTURE_IMAGE) d.path = NULL, d.image = NULL, d.data = NULL;
  if (!vl_scene_copy_string(scene, &d.name) || !vl_scene_copy_string(scene, &d.path)) return none;
  if (!adopt && (!vl_scene_copy_image(scene, &d.image) || !vl_scene_copy_block(scene, d.data, d.data_size, 1, &d.data)))
    return none;
  vlTextureDef *slot = VL_PUSH(scene->context, &scene->textures);
  if (!slot) return out_of_memory(scene), none;
  *slot = d;
  return (vlTextureId){(uint32_t)scene->textures.count};
}

vlTextureId vl_scene_add_texture(vlScene *scene, const vlTextureDef *def) {
  return add_texture(scene, def, false);
}

vlTextureId vl_scene_adopt_texture(vlScene *scene, const vlTextureDef *def) {
  return add_texture(scene, def, true);
}

/* ---- materials -------------------------------------------------------------------------------------------------- */

static bool take_mix(vlScene *scene, vlMaterialDef *d) {
  for (int i = 0; i < 2; i++) {
    uint32_t index = d->materials[i].index;
    if (index == 0) return bad(scene, d->source, "mix material", "needs two materials");
    if (index > scene->materials.count)
      return bad(scene, d->source, "mix material", "there is no such material (add its parts first)");
  }
  return true;
}

static bool take_normal_map(vlScene *scene, vlTextureId id, vlSource at) {
  if (id.index > scene->textures.count) return bad(scene, at, "normal map", "there is no such texture (add it first)");
  if (id.index && !scene->textures.items[id.index - 1].spectrum)
    return bad(scene, at, "normal map", "must be a colour texture");
  return true;
}

static bool take_principled(vlScene *scene, vlPrincipledDef *d, vlSource at) {
  if (!isfinite(d->dispersion) || d->dispersion < 0.0f || !(d->iridescence_ior >= 1.0f) ||
      !isfinite(d->iridescence_ior) || !isfinite(d->normal_scale) || !isfinite(d->clearcoat_normal_scale))
    return bad(scene, at, "principled material", "dispersion, a film's index or a normal map's scale makes no sense");
  return take_float(scene, &d->metallic, at, "metallic") && take_float(scene, &d->roughness, at, "roughness") &&
         take_float(scene, &d->anisotropy, at, "anisotropy") &&
         take_float(scene, &d->anisotropy_rotation, at, "anisotropy rotation") &&
         take_float(scene, &d->specular, at, "specular") &&
         take_spectrum(scene, &d->specular_color, at, "specular colour") &&
         take_float(scene, &d->transmission, at, "transmission") &&
         take_float(scene, &d->diffuse_transmission, at, "diffuse transmission") &&
         take_spectrum(scene, &d->diffuse_transmission_color, at, "diffuse transmission colour") &&
         take_float(scene, &d->clearcoat, at, "clear coat") &&
         take_float(scene, &d->clearcoat_roughness, at, "clear coat roughness") &&
         take_spectrum(scene, &d->sheen_color, at, "sheen colour") &&
         take_float(scene, &d->sheen_roughness, at, "sheen roughness") &&
         take_float(scene, &d->iridescence, at, "iridescence") &&
         take_float(scene, &d->iridescence_thickness, at, "iridescence thickness") &&
         take_normal_map(scene, d->normal, at) && take_normal_map(scene, d->clearcoat_normal, at);
}

static bool take_hair(vlScene *scene, vlHairDef *d, vlSource at) {
  if ((unsigned)d->color > VL_HAIR_MELANIN) return bad(scene, at, "hair material", "its colour is of no known kind");
  return take_spectrum(scene, &d->sigma_a, at, "sigma_a") && take_float(scene, &d->eumelanin, at, "eumelanin") &&
         take_float(scene, &d->pheomelanin, at, "pheomelanin") && take_float(scene, &d->eta, at, "eta") &&
         take_float(scene, &d->beta_m, at, "beta_m") && take_float(scene, &d->beta_n, at, "beta_n") &&
         take_float(scene, &d->alpha, at, "alpha");
}

static bool take_subsurface(vlScene *scene, vlMaterialDef *d, vlSource at) {
  const vlSpectrum *eta = &d->eta.value;
  float index = eta->value * eta->scale;
  if (d->kind == VL_MATERIAL_SUBSURFACE) {
    /* what the profile's polynomials are good for */
    if (d->eta.texture.index || eta->kind != VL_SPECTRUM_CONSTANT || !(index >= 0.5f && index <= 2.5f))
      return bad(scene, at, "eta", "the index of refraction of a body must be one number between 0.5 and 2.5");
    if (d->g.texture.index || !(d->g.value > -1.0f && d->g.value < 1.0f))
      return bad(scene, at, "g", "must be a number between -1 and 1");
  }
  return take_spectrum(scene, &d->subsurface.sigma_a, at, "sigma_a") &&
         take_spectrum(scene, &d->subsurface.sigma_s, at, "sigma_s") &&
         take_spectrum(scene, &d->subsurface.mfp, at, "mfp");
}

bool vl_coat_in_closed_form(const vlMaterialDef *def) {
  const vlSpectrum *a = &def->albedo.value;
  float grey = 0;
  bool black = (vl_spectrum_is_constant(a, &grey) && grey == 0) ||
               (a->kind == VL_SPECTRUM_RGB && a->rgb[0] == 0 && a->rgb[1] == 0 && a->rgb[2] == 0);
  return def->kind == VL_MATERIAL_COATED_DIFFUSE && !def->albedo.texture.index && black &&
         !def->thickness.texture.index;
}

vlMaterialId vl_scene_add_material(vlScene *scene, const vlMaterialDef *def) {
  const vlMaterialId none = {0};
  if (!may_add(scene, def, def && def->cookie == VL_COOKIE_MATERIAL, scene->materials.count, (vlSource){0}, "material"))
    return none;
  vlMaterialDef d = *def;
  vlSource at = d.source;
  if ((unsigned)d.kind > VL_MATERIAL_INTERFACE) return bad(scene, at, "material", "unknown kind"), none;
  if (d.kind == VL_MATERIAL_MIX && !take_mix(scene, &d)) return none;
  if (d.kind != VL_MATERIAL_MIX) d.materials[0].index = d.materials[1].index = 0;
  bool dielectric = d.kind == VL_MATERIAL_DIELECTRIC || d.kind == VL_MATERIAL_THIN_DIELECTRIC ||
                    d.kind == VL_MATERIAL_COATED_DIFFUSE || d.kind == VL_MATERIAL_PRINCIPLED;
  if (d.coat_eta.texture.index) return bad(scene, at, "coat's eta", "index of refraction cannot be textured"), none;
  if (dielectric && d.eta.texture.index) return bad(scene, at, "eta", "index of refraction cannot be textured"), none;
  bool coated = d.kind == VL_MATERIAL_COATED_DIFFUSE || d.kind == VL_MATERIAL_COATED_CONDUCTOR;
  if (coated && (d.max_depth == 0 || d.samples == 0))
    return bad(scene, at, "coated material", "max depth and samples must be at least 1"), none;
  if (coated && d.conserve_energy && !vl_coat_in_closed_form(&d))
    return bad(scene, at, "coated material",
               "energy is conserved over a diffuse base only, under a medium of albedo 0 and untextured thickness"),
           none;
  if (!isfinite(d.scale) || d.scale < 0.0f) return bad(scene, at, "material", "its scale makes no sense"), none;
  if (d.kind == VL_MATERIAL_MEASURED && !d.measured)
    return bad(scene, at, "measured material", "its file is not named"), none;
  if (d.kind != VL_MATERIAL_PRINCIPLED) d.principled = vl_default_material_def(VL_MATERIAL_DIFFUSE).principled;
  if (!take_principled(scene, &d.principled, at) || !take_hair(scene, &d.hair, at) || !take_subsurface(scene, &d, at))
    return none;
  if (!vl_scene_copy_source(scene, &d.source) || !take_spectrum(scene, &d.reflectance, at, "reflectance") ||
      !take_float(scene, &d.u_roughness, at, "u roughness") || !take_float(scene, &d.v_roughness, at, "v roughness") ||
      !take_spectrum(scene, &d.eta, at, "eta") || !take_spectrum(scene, &d.k, at, "k") ||
      !take_float(scene, &d.thickness, at, "thickness") || !take_float(scene, &d.g, at, "g") ||
      !take_spectrum(scene, &d.albedo, at, "albedo") || !take_float(scene, &d.amount, at, "amount") ||
      !take_float(scene, &d.displacement, at, "displacement") ||
      !take_spectrum(scene, &d.transmittance, at, "transmittance") ||
      !take_float(scene, &d.coat_u_roughness, at, "coat's u roughness") ||
      !take_float(scene, &d.coat_v_roughness, at, "coat's v roughness") ||
      !take_spectrum(scene, &d.coat_eta, at, "coat's eta") || !vl_scene_copy_string(scene, &d.name) ||
      !vl_scene_copy_string(scene, &d.normal_map) || !vl_scene_copy_string(scene, &d.measured))
    return none;
  vlMaterialDef *slot = VL_PUSH(scene->context, &scene->materials);
  if (!slot) return out_of_memory(scene), none;
  *slot = d;
  return (vlMaterialId){(uint32_t)scene->materials.count};
}

/* ---- light ------------------------------------------------------------------------------------------------------ */

static bool finite_or_unset(double x) {
  return isnan(x) || (isfinite(x) && x >= 0.0);
}

vlEmissionId vl_scene_add_emission(vlScene *scene, const vlEmissionDef *def) {
  const vlEmissionId none = {0};
  if (!may_add(scene, def, def && def->cookie == VL_COOKIE_EMISSION, scene->emissions.count, (vlSource){0}, "emission"))
    return none;
  vlEmissionDef d = *def;
  if (!isfinite(d.scale)) return bad(scene, d.source, "emission", "scale is not finite"), none;
  if (!finite_or_unset(d.power))
    return bad(scene, d.source, "emission", "power must not be negative or infinite"), none;
  if (!check_texture(scene, d.texture, true, d.source, "emission")) return none;
  if (d.texture.index && scene->textures.items[d.texture.index - 1].kind != VL_TEXTURE_IMAGE)
    return bad(scene, d.source, "emission", "its texture must be an image"), none;
  if (!vl_scene_copy_source(scene, &d.source) || !vl_scene_copy_spectrum(scene, &d.radiance, d.source, "radiance") ||
      !vl_scene_copy_string(scene, &d.image))
    return none;
  vlEmissionDef *slot = VL_PUSH(scene->context, &scene->emissions);
  if (!slot) return out_of_memory(scene), none;
  *slot = d;
  return (vlEmissionId){(uint32_t)scene->emissions.count};
}

/* A rectangle, and an image to be seen through it. Tolerances as pbrt's. */
static bool check_portal(vlScene *scene, const vlLightDef *d) {
  double sides[4][3], lengths[4];
  if (d->kind != VL_LIGHT_INFINITE || (!d->path && !d->image))
    return bad(scene, d->source, "light", "a portal is for an infinite light with an image");
  for (int k = 0; k < 4; k++) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
      if (!isfinite(d->portal[k][i])) return bad(scene, d->source, "light", "portal is not finite");
      sides[k][i] = (double)d->portal[(k + 1) % 4][i] - d->portal[k][i];
      sum += sides[k][i] * sides[k][i];
    }
    lengths[k] = sqrt(sum);
    if (!(sum > 0)) return bad(scene, d->source, "light", "two corners of its portal are the same");
  }
  for (int k = 0; k < 4; k++) {
    double across = 0, opposite = 0;
    for (int i = 0; i < 3; i++) {
      across += sides[k][i] * sides[(k + 1) % 4][i] / (lengths[k] * lengths[(k + 1) % 4]);
      opposite += sides[k][i] * sides[(k + 2) % 4][i] / (lengths[k] * lengths[(k + 2) % 4]);
    }
    if (fabs(across) > 1e-3 || fabs(opposite + 1) > 1e-3)
      return bad(scene, d->source, "light", "its portal is not a rectangle, corner after corner");
  }
  return true;
}

static bool check_light(vlScene *scene, const vlLightDef *d) {
  if ((unsigned)d->kind > VL_LIGHT_PROJECTION) return bad(scene, d->source, "light", "unknown kind");
  if (!isfinite(d->scale)) return bad(scene, d->source, "light", "scale is not finite");
  if (d->medium.index > scene->media.count) return bad(scene, d->source, "light", "there is no such medium");
  if (!finite_or_unset(d->power)) return bad(scene, d->source, "light", "power must not be negative or infinite");
  if (!finite_or_unset(d->illuminance))
    return bad(scene, d->source, "light", "illuminance must not be negative or infinite");
  if (!is_finite_matrix(d->world_from_light)) return bad(scene, d->source, "light", "transform is not finite");
  for (int i = 0; i < 3; i++)
    if (!isfinite(d->from[i]) || !isfinite(d->to[i])) return bad(scene, d->source, "light", "from or to is not finite");
  bool aims = d->kind == VL_LIGHT_SPOT || d->kind == VL_LIGHT_DISTANT;
  if (aims && d->from[0] == d->to[0] && d->from[1] == d->to[1] && d->from[2] == d->to[2])
    return bad(scene, d->source, "light", "from and to are the same point: it has no direction");
  if (d->kind == VL_LIGHT_SPOT &&
      (!(d->cone_angle > 0.0f && d->cone_angle <= 3.1415928f) || !(d->cone_delta >= 0.0f) || !isfinite(d->cone_delta)))
    return bad(scene, d->source, "spot light",
               "cone angle must be above 0 and at most 180 degrees, its delta not negative");
  if (d->kind >= VL_LIGHT_GONIOMETRIC && !d->path && !d->image) return bad(scene, d->source, "light", "needs an image");
  if (d->kind == VL_LIGHT_PROJECTION && !(d->fov > 0.0f && d->fov < 3.1415f))
    return bad(scene, d->source, "projection light", "field of view must be above 0 and below 180 degrees");
  return !d->has_portal || check_portal(scene, d);
}

vlLightId vl_scene_add_light(vlScene *scene, const vlLightDef *def) {
  const vlLightId none = {0};
  if (!may_add(scene, def, def && def->cookie == VL_COOKIE_LIGHT, scene->lights.count, (vlSource){0}, "light"))
    return none;
  vlLightDef d = *def;
  if (!check_light(scene, &d)) return none;
  if (d.kind < VL_LIGHT_INFINITE) d.path = NULL, d.image = NULL;
  if (d.path && d.image) return bad(scene, d.source, "light", "has both a file name and an image"), none;
  if (!vl_scene_copy_source(scene, &d.source) || !vl_scene_copy_spectrum(scene, &d.color, d.source, "light colour") ||
      !vl_scene_copy_string(scene, &d.path) || !vl_scene_copy_image(scene, &d.image))
    return none;
  vlLightDef *slot = VL_PUSH(scene->context, &scene->lights);
  if (!slot) return out_of_memory(scene), none;
  *slot = d;
  return (vlLightId){(uint32_t)scene->lights.count};
}
