/* material/principled.c: compiles the inputs of the principled material into texture
 * nodes.
 */
#include "material/principled.h"

#include <math.h>

#include "base/text.h"
#include "material/compile.h"

/* Coefficients of Cauchy's n = a + b / lambda^2 (lambda in nm), such that n is n_d at the line
 * d, and the lines d, F and C give the Abbe number 20 / dispersion. */
static void cauchy(float n, float dispersion, vlWorldPrincipled *p) {
  const double d = 587.6, f = 486.1, c = 656.3;
  double abbe = 20.0 / (double)dispersion;
  double b = ((double)n - 1) / (abbe * (1 / (f * f) - 1 / (c * c)));
  p->cauchy_b = (float)b;
  p->cauchy_a = (float)((double)n - b / (d * d));
}

static vlResult normal_node(vlWorld *world, const vlScene *scene, vlTextureId id, int32_t *node,
                            vlError *error) {
  *node = -1;
  if (!id.index)
    return VL_OK;
  vlSpectrumInput input = vl_spectrum_input(vl_spectrum_constant(0.0f));
  input.texture = id;
  return vl_world_spectrum_node(world, scene, input, VL_ROLE_UNBOUNDED, node, error);
}

static bool is_one(vlFloatInput input) {
  return !input.texture.index && input.value == 1.0f;
}

static bool is_zero(vlFloatInput input) {
  return !input.texture.index && !(input.value > 0.0f);
}

/* An index this near to 1 reflects less than 3e-7 and bends nothing visibly: the surface is a
 * sheet. */
#define NO_REFRACTION 1e-3f

/* Whether white light that crosses n surfaces of base colour c leaves them as c^n per channel:
 * the RGB law of importers (MTL's Tf, glTF's base colour). A base colour that is a spectrum
 * acts per wavelength, and so does a base that also transmits diffuse light. */
static void choose_law(vlWorld *world, const vlPrincipledDef *d, const vlWorldMaterial *m,
                       vlWorldPrincipled *p) {
  p->by_channel = world->def.color == VL_COLOR_SPECTRAL && !is_zero(d->transmission) &&
                  !is_one(d->metallic) && !p->has_transmission &&
                  vl_node_has_rgb_colors(world, m->reflectance);
  world->by_channel |= p->by_channel;
}

static bool is_black(const vlSpectrum *s) {
  float grey;
  if (vl_spectrum_is_constant(s, &grey))
    return !(grey > 0.0f);
  return s->kind == VL_SPECTRUM_RGB && !(s->rgb[0] + s->rgb[1] + s->rgb[2] > 0.0f);
}

/* The index of refraction and what follows from it. */
static vlResult compile_index(const vlMaterialBuild *b, vlWorldPrincipled *p) {
  const vlPrincipledDef *d = &b->def->principled;
  vlWorldMaterial *m = b->m;
  float ior;
  if (!vl_spectrum_is_constant(&b->def->eta.value, &ior) || !(ior >= 0.0f) || !isfinite(ior))
    return vl_fail(b->error, VL_ERROR_SCENE,
                   "principled material: the index of refraction must be one number");
  /* An index of 0 stands for infinity. The layers do not model indices below 1 (a solid within
   * a denser medium). */
  float root = ior > 0.0f ? (ior - 1.0f) / (ior + 1.0f) : 1.0f;
  p->f0 = root * root;
  m->eta_s = ior > 0.0f ? ior : 1.5f;
  p->thin =
      d->thin_walled || fabsf(m->eta_s - 1.0f) < NO_REFRACTION || is_zero(d->transmission);
  m->dispersive = !p->thin && d->dispersion > 0.0f && b->world->def.color == VL_COLOR_SPECTRAL;
  if (m->dispersive)
    cauchy(m->eta_s, d->dispersion, p);
  return VL_OK;
}

vlResult vl_compile_principled_material(const vlMaterialBuild *b) {
  vlWorld *world = b->world;
  const vlScene *scene = b->scene;
  const vlMaterialDef *def = b->def;
  vlWorldMaterial *m = b->m;
  vlError *error = b->error;
  const vlPrincipledDef *d = &def->principled;
  vlWorldPrincipled *p = vl_world_block(world, 1, sizeof *p);
  if (!p)
    return vl_fail_memory(error);
  m->bsdf = VL_BSDF_PRINCIPLED;
  m->principled = p;
  p->film_index = d->iridescence_ior;
  p->normal_scale = d->normal_scale;
  p->coat_normal_scale = d->clearcoat_normal_scale;
  const vlMaterialFloat floats[] = {{d->metallic, &p->metallic},
                                    {d->roughness, &p->roughness},
                                    {d->anisotropy, &p->anisotropy},
                                    {d->anisotropy_rotation, &p->anisotropy_rotation},
                                    {d->specular, &p->specular},
                                    {d->transmission, &p->transmission},
                                    {d->diffuse_transmission, &p->diffuse_transmission},
                                    {d->clearcoat, &p->clearcoat},
                                    {d->clearcoat_roughness, &p->clearcoat_roughness},
                                    {d->sheen_roughness, &p->sheen_roughness},
                                    {d->iridescence, &p->iridescence},
                                    {d->iridescence_thickness, &p->iridescence_thickness}};
  VL_TRY(compile_index(b, p));
  VL_TRY(vl_material_spectrum(b, &def->reflectance, &m->reflectance));
  VL_TRY(vl_material_floats(b, floats, VL_LENGTH(floats)));
  VL_TRY(vl_material_spectrum(b, &d->specular_color, &p->specular_color));
  VL_TRY(vl_material_spectrum(b, &d->diffuse_transmission_color, &p->through));
  VL_TRY(vl_material_spectrum(b, &d->sheen_color, &p->sheen));
  VL_TRY(normal_node(world, scene, d->normal, &p->normal, error));
  VL_TRY(normal_node(world, scene, d->clearcoat_normal, &p->coat_normal, error));
  /* Lobes whose weight is always 0 need no lookups. */
  p->has_coat = !is_zero(d->clearcoat);
  p->has_film = !is_zero(d->iridescence);
  p->has_anisotropy = !is_zero(d->anisotropy);
  p->has_transmission = !is_zero(d->diffuse_transmission);
  b->m->one_sided = !p->has_transmission && is_zero(d->transmission);
  p->has_sheen = d->sheen_color.texture.index || !is_black(&d->sheen_color.value);
  choose_law(world, d, m, p);
  return VL_OK;
}
