/* api/check_coats.c: the last check of vl_scene_check: the light that rough coats lose, from
 * the tables that a world would have. */
#include <math.h>

#include "base/error.h"
#include "color/color.h"
#include "material/coat.h"
#include "math/ggx.h"
#include "scene/check.h"
#include "velo/material.h"

/* A coat's loss depends only on these numbers, so it is computed once for all coats that have
 * the same numbers. */
typedef struct Coat {
  float eta, tau, u, v; /* u, v: the alphas */
  double lost;
} Coat;
typedef VL_ARRAY(Coat) Coats;

/* A large limit on bounces: light that is lost because of a material's maxdepth does not count
 * as a loss of roughness. */
enum { ALL_BOUNCES = 1000 };

/* A loss below this fraction of the light gives no note. */
static const double min = 0.01;

static float alpha_of(const vlMaterialDef *m, float roughness) {
  return m->remap_roughness ? sqrtf(roughness > 0 ? roughness : 0) : roughness;
}

static bool index_of(const vlMaterialDef *m, float *eta) {
  float dense[VL_LAMBDA_COUNT];
  if (vl_spectrum_is_constant(&m->eta.value, eta))
    return true;
  if (vl_spectrum_dense(&m->eta.value, VL_ROLE_UNBOUNDED, dense, NULL) != VL_OK)
    return false;
  *eta = vl_dense_at(dense, 589.3f); /* the same wavelength (nm) as in material/compile.c */
  return true;
}

/* Sets coat->lost: 1 minus the albedo of the coat over a white base, divided by that of the
 * same coat with conserved energy. */
static vlResult measure(vlContext *context, Coat *coat) {
  vlCoatTable *table;
  double kept = 0, whole = 0;
  VL_TRY(vl_coat_build_anisotropic(context, coat->eta, coat->tau, ALL_BOUNCES, coat->u, coat->v,
                                   &table));
  vlResult r = vl_coat_white_albedo(context, table, &kept);
  if (r == VL_OK)
    r = vl_coat_conserve(context, table);
  if (r == VL_OK)
    r = vl_coat_white_albedo(context, table, &whole);
  vl_coat_free(context, table);
  coat->lost = whole > 0 ? 1 - kept / whole : 0;
  return r;
}

/* Returns the fraction of light that this material's coat loses. Returns 0 if it has no rough
 * coat or the loss cannot be computed. */
static double loss_of(vlCheck *check, const vlMaterialDef *m, Coats *coats) {
  Coat coat = {.tau = m->thickness.value,
               .u = alpha_of(m, m->u_roughness.value),
               .v = alpha_of(m, m->v_roughness.value)};
  if (m->kind != VL_MATERIAL_COATED_DIFFUSE || m->conserve_energy ||
      !vl_coat_in_closed_form(m) || m->u_roughness.texture.index ||
      m->v_roughness.texture.index || !(coat.u >= VL_GGX_SMOOTH || coat.v >= VL_GGX_SMOOTH) ||
      !index_of(m, &coat.eta) || coat.eta == 1.0f)
    return 0;
  VL_EACH_ITEM(const Coat, c, coats) {
    if (c->eta == coat.eta && c->tau == coat.tau && c->u == coat.u && c->v == coat.v)
      return c->lost;
  }
  vlResult r = measure(check->context, &coat);
  Coat *slot = r == VL_OK ? VL_PUSH(check->context, coats) : NULL;
  if (r == VL_ERROR_MEMORY || (r == VL_OK && !slot))
    check->no_memory = true;
  if (!slot)
    return 0; /* the numbers are invalid; vl_world_build reports them */
  *slot = coat;
  return coat.lost;
}

/* Adds one note for the whole scene. Its location is that of the coat with the largest loss. */
static void check_coats(vlCheck *check) {
  Coats coats = {0};
  const vlMaterialDef *worst = NULL;
  double max = 0, fewest = 1;
  uint32_t count = 0;
  for (size_t i = 0; i < check->scene->materials.count && !check->no_memory; i++) {
    const vlMaterialDef *m = &check->scene->materials.items[i];
    double lost = check->used[VL_SCENE_MATERIALS][i] ? loss_of(check, m, &coats) : 0;
    if (lost < min)
      continue;
    count++;
    if (lost > max) {
      worst = m;
      max = lost;
    }
    if (lost < fewest)
      fewest = lost;
  }
  VL_ARRAY_FREE(check->context, &coats);
  if (!worst)
    return;
  vlCheckName name = vl_check_material_name(worst);
  if (count == 1)
    vl_check_add(check, VL_FINDING_ROUGH_COAT, VL_SEVERITY_NOTE, worst->source,
                 "the rough coat of %s loses %.0f %% of the light over a white base, as "
                 "pbrt's does: \"bool conserveenergy\" true keeps it",
                 name.text, 100 * max);
  else
    vl_check_add(
        check, VL_FINDING_ROUGH_COAT, VL_SEVERITY_NOTE, worst->source,
        "%u rough coats lose %.0f to %.0f %% of the light over a white base, as pbrt's do, "
        "that of %s most: \"bool conserveenergy\" true keeps it",
        count, 100 * fewest, 100 * max, name.text);
}

vlResult vl_scene_check(const vlScene *scene, const vlCheckDef *def, vlCheck **check,
                        vlError *error) {
  return vl_check_make(scene, def, check_coats, check, error);
}
