/* import/pbrt/sampling.c: Sampler, PixelFilter, Integrator and Accelerator to the scene's settings. Defaults are
 * pbrt-v4's.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/pbrt/builder.h"

/* ---- sampler ---------------------------------------------------------------------------------------------------- */

typedef struct SamplerName {
  const char *name;
  vlSamplerKind kind;
  bool grid;           /* xsamples, ysamples; else pixelsamples */
  uint32_t spp;        /* default */
  const char *instead; /* told as a note: what is taken for it */
} SamplerName;

static const SamplerName samplers[] = {
    {"independent", VL_SAMPLER_INDEPENDENT, false, 4, NULL},
    {"random", VL_SAMPLER_INDEPENDENT, false, 4, NULL},
    {"regular", VL_SAMPLER_REGULAR, false, 16, NULL},
    {"stratified", VL_SAMPLER_STRATIFIED, true, 16, NULL},
    {"jittered", VL_SAMPLER_STRATIFIED, true, 16, NULL},
    {"nrooks", VL_SAMPLER_NROOKS, false, 16, NULL},
    {"multijittered", VL_SAMPLER_MULTI_JITTERED, false, 16, NULL},
    {"hammersley", VL_SAMPLER_HAMMERSLEY, false, 16, NULL},
    {"halton", VL_SAMPLER_HALTON, false, 16, NULL},
    {"sobol", VL_SAMPLER_SOBOL, false, 16, NULL},
    {"paddedsobol", VL_SAMPLER_SOBOL, false, 16, "sobol"},
    {"zsobol", VL_SAMPLER_ZSOBOL, false, 16, NULL},
    {"pmj02bn", VL_SAMPLER_ZSOBOL, false, 16, "zsobol"},
};
enum { SAMPLERS = sizeof samplers / sizeof *samplers };

static bool read_grid(vlDict *dict, vlSceneSettings *s) {
  uint32_t x = 4, y = 4;
  bool jitter = true;
  bool given = vl_dict_count(dict, "xsamples", 1, &x);
  given = vl_dict_count(dict, "ysamples", 1, &y) || given;
  vl_dict_bool(dict, "jitter", &jitter);
  if ((uint64_t)x * y > 0x7fffffff)
    return vl_import_fail(dict->import, VL_ERROR_SCENE, dict->place, "%s: too many samples", dict->what);
  if (!jitter) s->sampler = VL_SAMPLER_REGULAR;
  /* Not pbrt's, but the same word for all samplers. */
  if (!vl_dict_count(dict, "pixelsamples", 1, &s->spp) || given) s->spp = x * y;
  return true;
}

static bool read_sampler(vlImport *import, vlSceneSettings *s) {
  const vlChoice *choice = &import->sampler;
  s->sampler = VL_SAMPLER_ZSOBOL;
  s->spp = 16;
  if (!choice->given) return true;
  char what[96];
  snprintf(what, sizeof what, "Sampler \"%.60s\"", choice->kind);
  vlDict dict = vl_import_dict(import, what, choice->place, choice->space, &choice->params, NULL);
  const SamplerName *sampler = NULL;
  const char *names[SAMPLERS];
  for (int i = 0; i < SAMPLERS; i++) {
    names[i] = samplers[i].name;
    if (strcmp(choice->kind, names[i]) == 0) sampler = &samplers[i];
  }
  if (!sampler) return vl_import_unknown(import, choice->place, "sampler", choice->kind, names, SAMPLERS, NULL, 0);
  s->sampler = sampler->kind;
  s->spp = sampler->spp;
  if (sampler->instead)
    vl_import_warn(import, VL_LOG_INFO, choice->place, "sampler \"%s\": \"%s\" is taken in its place", sampler->name,
                   sampler->instead);
  int32_t seed;
  if (vl_dict_integer(&dict, "seed", &seed)) s->sampler_seed = (uint32_t)seed;
  if (sampler->grid && !read_grid(&dict, s)) return false;
  if (!sampler->grid) vl_dict_count(&dict, "pixelsamples", 1, &s->spp);
  static const char *const randomizations[] = {"none", "permutedigits", "fastowen", "owen"};
  int randomization = 2;
  bool scrambled =
      sampler->kind == VL_SAMPLER_HALTON || sampler->kind == VL_SAMPLER_SOBOL || sampler->kind == VL_SAMPLER_ZSOBOL;
  if (scrambled && vl_dict_choice(&dict, "randomization", randomizations, 4, &randomization) && randomization == 0)
    vl_import_warn(import, VL_LOG_INFO, vl_dict_find(&dict, "randomization", 1u << VL_PARAM_STRING)->place,
                   "%s: randomization \"none\": samples are scrambled all the same", what);
  return vl_dict_done(&dict);
}

/* ---- pixel filter ----------------------------------------------------------------------------------------------- */

static bool read_filter(vlImport *import, vlSceneSettings *s) {
  const vlChoice *choice = &import->filter;
  s->filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN);
  if (!choice->given) return true;
  char what[96];
  snprintf(what, sizeof what, "PixelFilter \"%.60s\"", choice->kind);
  vlDict dict = vl_import_dict(import, what, choice->place, choice->space, &choice->params, NULL);
  int kind = vl_kind_find(&vl_pixel_filter_family, choice->kind);
  if (kind < 0) return vl_import_unknown_kind(import, choice->place, &vl_pixel_filter_family, choice->kind);
  s->filter = vl_default_pixel_filter((vlPixelFilterKind)kind);
  const vlKindRow *row = vl_kind_row(&vl_pixel_filter_family, kind);
  return vl_import_parameters(&dict, row, &s->filter, false, NULL) && vl_dict_done(&dict);
}

/* ---- integrator ------------------------------------------------------------------------------------------------- */

/* Longer paths than vl_render follows carry nothing that shows. */
static void read_depth(vlDict *dict, vlSceneSettings *s) {
  enum { MOST = 4096 };
  vl_dict_count(dict, "maxdepth", 0, &s->max_depth);
  if (s->max_depth <= MOST) return;
  vl_import_warn(dict->import, VL_LOG_INFO, vl_dict_find(dict, "maxdepth", 1u << VL_PARAM_INTEGER)->place,
                 "%s: \"maxdepth\" %u: %d is taken", dict->what, s->max_depth, MOST);
  s->max_depth = MOST;
}

static bool read_path(vlDict *dict, vlSceneSettings *s) {
  static const char *const light_samplers[] = {"bvh", "power", "uniform", "exhaustive"};
  vlImport *import = dict->import;
  bool yes = true;
  int sampler = 0;
  read_depth(dict, s);
  if (vl_dict_choice(dict, "lightsampler", light_samplers, 4, &sampler)) {
    if (sampler == 3)
      vl_import_warn(import, VL_LOG_INFO, vl_dict_find(dict, "lightsampler", 1u << VL_PARAM_STRING)->place,
                     "%s: light sampler \"exhaustive\": \"bvh\" is taken in its place", dict->what);
    s->light_sampler = sampler == 3 ? VL_LIGHT_SAMPLER_BVH : (vlLightSampler)sampler;
  }
  vl_dict_bool(dict, "regularize", &s->regularize);
  if (strstr(dict->what, "simple")) { /* how a simple path samples does not change what it converges to */
    vl_dict_bool(dict, "samplelights", &yes);
    vl_dict_bool(dict, "samplebsdf", &yes);
  }
  return true;
}

/* Of sppm; of the others the words alone are looked at. */
static bool read_merging(vlDict *dict, vlSceneSettings *s) {
  float radius = 0;
  vlParam *given = vl_dict_find(dict, "radius", VL_BIT_FLOAT);
  if (given && vl_dict_float(dict, "radius", &radius)) {
    if (!(radius > 0.0f) || !(radius < __builtin_inff()))
      return vl_import_fail(dict->import, VL_ERROR_SCENE, given->place, "%s: \"radius\" must be above 0", dict->what);
    s->merge_radius = (double)radius;
  }
  int32_t photons = -1; /* as many as pixels */
  if (vl_dict_integer(dict, "photonsperiteration", &photons) && photons > 0)
    s->light_paths = photons < 1 << 24 ? (uint32_t)photons : 1u << 24;
  return true;
}

/* pbrt's two-way integrators by velo's own: of what steers theirs, radius and photons do. */
static bool read_two_way(vlDict *dict, vlSceneSettings *s, const char *kind) {
  static const struct {
    const char *name;
    vlTracer tracer;
    const char *by;
  } kinds[] = {{"bdpt", VL_TRACER_BIDIRECTIONAL, "bidirectional tracer"},
               {"mlt", VL_TRACER_BIDIRECTIONAL, "bidirectional tracer"},
               {"sppm", VL_TRACER_SPPM, "merging tracer"},
               {"lightpath", VL_TRACER_LIGHT_PATH, NULL},
               {"randomwalk", VL_TRACER_RANDOM_WALK, NULL}};
  static const char *const bools[] = {"regularize", "visualizestrategies", "visualizeweights"};
  static const char *const numbers[] = {"bootstrapsamples", "chains", "mutationsperpixel", "seed", "iterations"};
  static const char *const floats[] = {"sigma", "largestepprobability"};
  vlImport *import = dict->import;
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    if (strcmp(kind, kinds[i].name) != 0) continue;
    s->tracer = kinds[i].tracer;
    read_depth(dict, s);
    if (!kinds[i].by) break;
    bool yes;
    float number;
    for (int k = 0; k < 3; k++) vl_dict_bool(dict, bools[k], &yes);
    for (int k = 0; k < 2; k++) vl_dict_float(dict, floats[k], &number);
    for (int k = 0; k < 5; k++) vl_dict_find(dict, numbers[k], 1u << VL_PARAM_INTEGER);
    if (!read_merging(dict, s)) return false;
    vl_import_warn(import, VL_LOG_INFO, import->integrator.place, "integrator \"%s\": rendered by velo's %s", kind,
                   kinds[i].by);
    break;
  }
  return vl_dict_done(dict);
}

static bool read_integrator(vlImport *import, vlSceneSettings *s) {
  static const char *const names[] = {"path", "simplepath", "volpath", "simplevolpath", "raycast",   "ambientocclusion",
                                      "bdpt", "mlt",        "sppm",    "lightpath",     "randomwalk"};
  enum { KINDS = sizeof names / sizeof *names };
  static const char *const later[] = {"function"};
  const vlChoice *choice = &import->integrator;
  s->tracer = VL_TRACER_VOLPATH;
  s->max_depth = 5;
  if (!choice->given) return true;
  char what[96];
  snprintf(what, sizeof what, "Integrator \"%.60s\"", choice->kind);
  vlDict dict = vl_import_dict(import, what, choice->place, choice->space, &choice->params, NULL);
  int kind = -1;
  for (int i = 0; i < KINDS; i++)
    if (strcmp(choice->kind, names[i]) == 0) kind = i;
  if (kind < 0) { /* permissive: a path tracer of that depth stands in */
    if (!vl_import_unknown(import, choice->place, "integrator", choice->kind, names, KINDS, later,
                           sizeof later / sizeof *later))
      return false;
    read_depth(&dict, s);
    return import->scene->error.code == VL_OK;
  }
  if (kind < 4) {
    s->tracer = kind < 2 ? VL_TRACER_PATH : VL_TRACER_VOLPATH;
    return read_path(&dict, s) && vl_dict_done(&dict);
  }
  if (kind > 5) return read_two_way(&dict, s, choice->kind);
  s->tracer = kind == 4 ? VL_TRACER_RAYCAST : VL_TRACER_AMBIENT_OCCLUSION;
  if (kind == 5) {
    vl_dict_bool(&dict, "cossample", &s->ao_cosine);
    vlParam *p = vl_dict_find(&dict, "maxdistance", VL_BIT_FLOAT);
    vl_dict_float(&dict, "maxdistance", &s->ao_distance);
    if (!(s->ao_distance > 0.0f))
      return vl_import_fail(import, VL_ERROR_SCENE, p->place, "%s: \"maxdistance\" must be above 0", what);
  }
  return vl_dict_done(&dict);
}

/* The accelerator is velo's own choice; only the words are checked. */
static bool check_accelerator(vlImport *import) {
  static const char *const names[] = {"bvh", "kdtree"};
  const vlChoice *choice = &import->accelerator;
  if (!choice->given || strcmp(choice->kind, names[0]) == 0 || strcmp(choice->kind, names[1]) == 0) return true;
  return vl_import_unknown(import, choice->place, "accelerator", choice->kind, names, 2, NULL, 0);
}

bool vl_import_sampling(vlImport *import) {
  vlSceneSettings *s = vl_scene_settings(import->scene);
  return read_sampler(import, s) && read_filter(import, s) && read_integrator(import, s) && check_accelerator(import);
}
