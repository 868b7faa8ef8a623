/* import/pbrt/sampling.c: converts the directives Sampler, PixelFilter, Integrator and
 * Accelerator to the scene's defs. Defaults are pbrt-v4's. */

#include "base/text.h"
#include "import/pbrt/builder.h"
#include "velo/filter_kinds.h"
#include "velo/sampler.h"
#include "velo/tracer.h"

/* Checks the types of pbrt's parameters that have no meaning in velo. */
static void skip_ignored(vlDict *dict) {
  const vlKindRow *row = dict->row;
  bool yes;
  float number;
  VL_EACH_PARAMETER(p, row) {
    if (p->member[0])
      continue;
    if (p->type == VL_PARAMETER_BOOL)
      vl_dict_bool(dict, p->name, &yes);
    if (p->type == VL_PARAMETER_FLOAT)
      vl_dict_float(dict, p->name, &number);
    if (p->type == VL_PARAMETER_COUNT)
      vl_dict_find(dict, p->name, VL_BIT_INTEGER);
  }
}

/* ---- sampler ----------------------------------------------------------------------------- */

static bool read_grid(vlDict *dict, vlSceneDefs *s, bool spp_given) {
  uint32_t x = 4, y = 4;
  bool jitter = true;
  bool given = vl_dict_count(dict, "xsamples", 1, &x);
  given = vl_dict_count(dict, "ysamples", 1, &y) || given;
  vl_dict_bool(dict, "jitter", &jitter);
  if ((uint64_t)x * y > 0x7fffffff)
    return vl_dict_fail(dict, "too many samples");
  if (!jitter)
    s->render.sampler = VL_SAMPLER_REGULAR;
  if (given || !spp_given)
    /* pbrt's stratified sampler has no pixelsamples; velo accepts it for all samplers */
    s->render.spp = x * y;
  return true;
}

static void read_randomization(vlDict *dict) {
  int randomization = 2;
  if (vl_dict_row_choice(dict, "randomization", &randomization) && randomization == 0)
    vl_import_warn(
        dict->import, VL_LOG_INFO, vl_dict_find(dict, "randomization", VL_BIT_STRING)->source,
        "%s: randomization \"none\": samples are scrambled all the same", dict->what);
}

static bool read_sampler(vlImport *import, vlSceneDefs *s) {
  const vlChoice *choice = &import->sampler;
  s->render.sampler = VL_SAMPLER_ZSOBOL;
  s->render.spp = 16;
  if (!choice->given)
    return true;
  vlDict dict = vl_import_choice_dict(import, "Sampler", &vl_sampler_family, choice, NULL);
  const vlKindRow *row = dict.row;
  if (!row)
    return vl_import_unknown_kind(import, choice->source, &vl_sampler_family, choice->kind);
  s->render.sampler = (vlSamplerKind)dict.kind;
  vl_row_set_defaults(row, s);
  if (vl_text_is(row->alias, choice->kind) &&
      (dict.kind == VL_SAMPLER_SOBOL || dict.kind == VL_SAMPLER_ZSOBOL))
    vl_import_warn(import, VL_LOG_INFO, choice->source,
                   "sampler \"%s\": \"%s\" is taken in its place", row->alias, row->name);
  int32_t seed;
  if (vl_dict_integer(&dict, "seed", &seed))
    s->render.seed = (uint32_t)seed;
  if (!vl_import_parameters(&dict, s, false))
    return false;
  if (dict.kind == VL_SAMPLER_STRATIFIED &&
      !read_grid(&dict, s, vl_import_given(&dict, "pixelsamples")))
    return false;
  read_randomization(&dict);
  return vl_dict_done(&dict);
}

/* ---- pixel filter ------------------------------------------------------------------------ */

static bool read_filter(vlImport *import, vlSceneDefs *s) {
  const vlChoice *choice = &import->filter;
  s->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN);
  if (!choice->given)
    return true;
  vlDict dict =
      vl_import_choice_dict(import, "PixelFilter", &vl_pixel_filter_family, choice, NULL);
  if (!dict.row)
    return vl_import_unknown_kind(import, choice->source, &vl_pixel_filter_family,
                                  choice->kind);
  s->film.filter = vl_default_pixel_filter((vlPixelFilterKind)dict.kind);
  return vl_import_parameters(&dict, &s->film.filter, false) && vl_dict_done(&dict);
}

/* ---- integrator -------------------------------------------------------------------------- */

/* Reads the maximal path length and limits it to MAX_DEPTH. Longer paths do not contribute
 * visibly. */
static void read_depth(vlDict *dict, vlSceneDefs *s) {
  enum { MAX_DEPTH = 4096 };
  vl_dict_count(dict, "maxdepth", 0, &s->render.max_depth);
  if (s->render.max_depth <= MAX_DEPTH)
    return;
  vl_import_warn(
      dict->import, VL_LOG_INFO, vl_dict_find(dict, "maxdepth", VL_BIT_INTEGER)->source,
      "%s: \"maxdepth\" %u: %d is taken", dict->what, s->render.max_depth, MAX_DEPTH);
  s->render.max_depth = MAX_DEPTH;
}

static void read_light_sampler(vlDict *dict, vlSceneDefs *s) {
  int sampler = 0;
  if (!vl_dict_row_choice(dict, "lightsampler", &sampler))
    return;
  if (sampler == 3)
    vl_import_warn(
        dict->import, VL_LOG_INFO, vl_dict_find(dict, "lightsampler", VL_BIT_STRING)->source,
        "%s: light sampler \"exhaustive\": \"bvh\" is taken in its place", dict->what);
  s->build.light_sampler = sampler == 3 ? VL_LIGHT_SAMPLER_BVH : (vlLightSampler)sampler;
}

static void read_photons(vlDict *dict, vlSceneDefs *s) {
  int32_t photons = -1; /* -1: as many photons as pixels */
  if (vl_row_find(dict->row, "photonsperiteration") &&
      vl_dict_integer(dict, "photonsperiteration", &photons) && photons > 0)
    s->render.light_paths = photons < 1 << 24 ? (uint32_t)photons : 1u << 24;
}

/* Replaces the name of an integrator that velo lacks by that of a similar tracer. */
static const char *stand_in(const char *name) {
  return vl_text_is(name, "mlt") ? "bdpt" : name;
}

/* Reports that one of velo's tracers replaces pbrt's bidirectional integrator. Of pbrt's
 * parameters, radius and photons have an effect. */
static void remark_two_way(vlImport *import, const char *kind, vlTracer tracer) {
  bool pbrts = vl_text_is(kind, "bdpt") || vl_text_is(kind, "mlt") || vl_text_is(kind, "sppm");
  if (pbrts)
    vl_import_warn(import, VL_LOG_INFO, import->integrator.source,
                   "integrator \"%s\": rendered by velo's %s", vl_short_text(kind).text,
                   tracer == VL_TRACER_SPPM ? "merging tracer" : "bidirectional tracer");
}

/* Reports that the tracer does not regularize. */
static void remark_regularize(vlDict *dict, const vlSceneDefs *s) {
  bool asked = false;
  if (vl_dict_bool(dict, "regularize", &asked) && asked && !s->build.regularize)
    vl_import_warn(
        dict->import, VL_LOG_INFO, vl_dict_find(dict, "regularize", VL_BIT_BOOL)->source,
        "%s: \"regularize\" is ignored: only \"path\" and \"volpath\" have it", dict->what);
}

static bool read_integrator(vlImport *import, vlSceneDefs *s) {
  const vlChoice *choice = &import->integrator;
  s->render.tracer = VL_TRACER_VOLPATH;
  s->render.max_depth = 5;
  s->tracer_missing = !choice->given;
  if (!choice->given)
    return true;
  vlDict dict = vl_import_choice_dict(import, "Integrator", &vl_tracer_family, choice, NULL);
  vl_dict_set_kind(&dict, &vl_tracer_family,
                   vl_kind_find(&vl_tracer_family, stand_in(choice->kind)));
  if (!dict.row) { /* permissive: a path tracer of the same depth replaces it */
    const bool later = vl_text_is(choice->kind, "function");
    if (!(later ? vl_import_unsupported(import, choice->source,
                                        "integrator \"function\" is not understood yet")
                : vl_import_unknown_kind(import, choice->source, &vl_tracer_family,
                                         choice->kind)))
      return false;
    read_depth(&dict, s);
    return vl_import_fine(import);
  }
  s->render.tracer = (vlTracer)dict.kind;
  if (!vl_import_parameters(&dict, s, false))
    return false;
  if (vl_row_find(dict.row, "maxdepth"))
    read_depth(&dict, s);
  read_light_sampler(&dict, s);
  read_photons(&dict, s);
  skip_ignored(&dict);
  remark_regularize(&dict, s);
  remark_two_way(import, choice->kind, s->render.tracer);
  return vl_dict_done(&dict);
}

/* velo chooses its own accelerator; only the name is checked. */
static bool check_accelerator(vlImport *import) {
  static const char *const names[] = {"bvh", "kdtree"};
  const vlChoice *choice = &import->accelerator;
  if (!choice->given || vl_text_is(choice->kind, names[0]) ||
      vl_text_is(choice->kind, names[1]))
    return true;
  return vl_import_unknown(import, choice->source, "accelerator", choice->kind, names, 2);
}

bool vl_import_sampling(vlImport *import) {
  vlSceneDefs *s = vl_scene_defs(import->scene);
  return read_sampler(import, s) && read_filter(import, s) && read_integrator(import, s) &&
         check_accelerator(import);
}
