/* import/pbrt/upgrade/settings.c: camera, film, sampler, filter, integrator, accelerator, media, WorldBegin. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

#define END \
  { NULL, VL_OLD_KEEP, NULL }
#define KEEP(name) \
  { name, VL_OLD_KEEP, NULL }
#define DROP(name) \
  { name, VL_OLD_DROP, NULL }
#define BOUNDS \
  { "pixelbounds", VL_OLD_LOSE, "give the film's \"pixelbounds\"" }

/* ---- camera ------------------------------------------------------------------------------------------------------ */

#define SHUTTER KEEP("shutteropen"), KEEP("shutterclose"), KEEP("frameaspectratio"), KEEP("screenwindow")
static const vlOldRow perspective[] = {KEEP("fov"), KEEP("lensradius"), KEEP("focaldistance"), SHUTTER, END};
static const vlOldRow environment[] = {
    SHUTTER, {"mapping", VL_OLD_DEFAULT, "\"string mapping\" \"equirectangular\""}, DROP("fov"), END};
static const vlOldRow realistic[] = {KEEP("lensfile"),
                                     KEEP("aperturediameter"),
                                     KEEP("focusdistance"),
                                     KEEP("aperture"),
                                     DROP("simpleweighting"),
                                     SHUTTER,
                                     END};

static bool half_fov(vlOldFile *file, vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "halffov");
  char text[32];
  (void)file;
  if (!p || p->count < 1) return true;
  if (vl_old_find(s, "fov")) {
    vl_old_drop(s, vl_old_find(s, "fov"));
    return true;
  }
  p->new_name = "fov";
  snprintf(p->new_value, sizeof p->new_value, "%s", vl_old_text(2 * p->number[0], text));
  return true;
}

static bool lens_file(vlOldFile *file, vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "lensfile");
  char name[4096];
  if (!p || !p->strings) return true;
  if (!vl_old_file_name(file, s->line, p->text[0], name, sizeof name)) return false;
  return vl_text_is(name, p->text[0]) || vl_old_edit(file, p->span[0], "\"%s\"", name);
}

static const vlOldKind cameras[] = {{"perspective", "perspective", perspective, half_fov, NULL},
                                    {"orthographic", "orthographic", perspective, NULL, NULL},
                                    {"environment", "spherical", environment, NULL, NULL},
                                    {"realistic", "realistic", realistic, lens_file, NULL},
                                    {NULL, NULL, NULL, NULL, NULL}};

/* Replaces kind and parameters by the table. Unknown kinds become `otherwise`. */
static bool rewrite(vlOldFile *file, vlOldStatement *s, const vlOldKind *kinds, const char *otherwise) {
  const vlOldKind *kind = vl_old_kind(kinds, s->name[0]);
  if (!kind) {
    vl_old_lose(file, s->line, "%s \"%s\" has no counterpart: \"%s\" is written", s->word->name, s->name[0], otherwise);
    for (size_t i = 0; i < s->params.count; i++) s->params.items[i].dropped = true;
    return vl_old_rename(file, s, 0, otherwise);
  }
  if (kind->lost) vl_old_lose(file, s->line, "%s", kind->lost);
  return (!kind->rule || kind->rule(file, s)) && vl_old_rows(file, s, kind->rows, VL_OLD_LOSE) &&
         vl_old_rename(file, s, 0, kind->to);
}

/* In pbrt-v4 the image is as much brighter as the shutter is open longer. */
bool vl_old_camera(vlOldFile *file, vlOldStatement *s) {
  double open = vl_old_number(s, "shutteropen", 0), close = vl_old_number(s, "shutterclose", 1);
  if (close > open) file->u->exposure = 1 / (close - open);
  return rewrite(file, s, cameras, "perspective");
}

/* ---- film -------------------------------------------------------------------------------------------------------- */

static const vlOldRow film[] = {KEEP("xresolution"),
                                KEEP("yresolution"),
                                {"xresolution", VL_OLD_DEFAULT, "\"integer xresolution\" 640"},
                                {"yresolution", VL_OLD_DEFAULT, "\"integer yresolution\" 480"},
                                KEEP("cropwindow"),
                                KEEP("diagonal"),
                                KEEP("filename"),
                                {"maxsampleluminance", VL_OLD_RENAME, "maxcomponentvalue"},
                                DROP("display"),
                                END};
static const vlOldKind films[] = {{"image", "rgb", film, NULL, NULL}, {NULL, NULL, NULL, NULL, NULL}};

bool vl_old_film(vlOldFile *file, vlOldStatement *s) {
  static const char *const news[] = {"rgb", "gbuffer", "spectral"};
  for (int i = 0; i < 3; i++)
    if (vl_text_is(s->name[0], news[i])) return true;
  vlOldParam *scale = vl_old_find(s, "scale");
  vlUpgrade *u = file->u;
  if (scale && scale->count == 1) u->iso = 100 * scale->number[0];
  if (scale) vl_old_drop(s, scale);
  u->film_file = file;
  u->film_end = s->whole.end;
  u->film_line = s->line;
  return rewrite(file, s, films, "rgb");
}

/* ---- sampler, filter, accelerator -------------------------------------------------------------------------------- */

static const vlOldRow sampler[] = {KEEP("pixelsamples"), KEEP("xsamples"),          KEEP("ysamples"), KEEP("jitter"),
                                   DROP("dimensions"),   DROP("samplepixelcenter"), KEEP("seed"),     END};
static const vlOldRow adaptive[] = {
    {"maxsamples", VL_OLD_RENAME, "pixelsamples"}, DROP("minsamples"), DROP("method"), KEEP("pixelsamples"), END};
static const vlOldKind samplers[] = {{"halton", "halton", sampler, NULL, NULL},
                                     {"sobol", "sobol", sampler, NULL, NULL},
                                     {"stratified", "stratified", sampler, NULL, NULL},
                                     {"random", "independent", sampler, NULL, NULL},
                                     {"lowdiscrepancy", "paddedsobol", sampler, NULL, NULL},
                                     {"02sequence", "paddedsobol", sampler, NULL, NULL},
                                     {"zerotwosequence", "paddedsobol", sampler, NULL, NULL},
                                     {"maxmindist", "pmj02bn", sampler, NULL, NULL},
                                     {"bestcandidate", "sobol", sampler, NULL, NULL},
                                     {"adaptive", "sobol", adaptive, NULL, NULL},
                                     {"independent", "independent", sampler, NULL, NULL},
                                     {"zsobol", "zsobol", sampler, NULL, NULL},
                                     {"paddedsobol", "paddedsobol", sampler, NULL, NULL},
                                     {"pmj02bn", "pmj02bn", sampler, NULL, NULL},
                                     {NULL, NULL, NULL, NULL, NULL}};

bool vl_old_sampler(vlOldFile *file, vlOldStatement *s) {
  return rewrite(file, s, samplers, "zsobol");
}

#define RADIUS \
  {"xwidth", VL_OLD_RENAME, "xradius"}, {"ywidth", VL_OLD_RENAME, "yradius"}, KEEP("xradius"), KEEP("yradius")
static const vlOldRow plain_filter[] = {RADIUS, END};
static const vlOldRow gaussian[] = {RADIUS,
                                    {"xradius", VL_OLD_DEFAULT, "\"float xradius\" 2"},
                                    {"yradius", VL_OLD_DEFAULT, "\"float yradius\" 2"},
                                    KEEP("sigma"),
                                    END};
static const vlOldRow mitchell[] = {RADIUS, KEEP("B"), KEEP("C"), END};
static const vlOldRow sinc[] = {RADIUS, KEEP("tau"), END};

/* exp(-alpha x^2) is a Gaussian of the variance 1 / (2 alpha). */
static bool gaussian_rule(vlOldFile *file, vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "alpha");
  char text[32];
  (void)file;
  if (!p || p->count != 1 || !(p->number[0] > 0)) return true;
  p->new_name = "sigma";
  snprintf(p->new_value, sizeof p->new_value, "%s", vl_old_text(sqrt(0.5 / p->number[0]), text));
  return true;
}

static const vlOldKind filters[] = {{"box", "box", plain_filter, NULL, NULL},
                                    {"triangle", "triangle", plain_filter, NULL, NULL},
                                    {"gaussian", "gaussian", gaussian, gaussian_rule, NULL},
                                    {"mitchell", "mitchell", mitchell, NULL, NULL},
                                    {"sinc", "sinc", sinc, NULL, NULL},
                                    {NULL, NULL, NULL, NULL, NULL}};

bool vl_old_filter(vlOldFile *file, vlOldStatement *s) {
  file->u->filter_given = true;
  return rewrite(file, s, filters, "gaussian");
}

static const vlOldRow bvh[] = {KEEP("maxnodeprims"), KEEP("splitmethod"), END};
static const vlOldRow kdtree[] = {KEEP("intersectcost"), KEEP("traversalcost"), KEEP("emptybonus"),
                                  KEEP("maxprims"),      KEEP("maxdepth"),      END};
static const vlOldKind accelerators[] = {{"bvh", "bvh", bvh, NULL, NULL},
                                         {"kdtree", "kdtree", kdtree, NULL, NULL},
                                         {"none", "bvh", NULL, NULL, NULL},
                                         {NULL, NULL, NULL, NULL, NULL}};

bool vl_old_accelerator(vlOldFile *file, vlOldStatement *s) {
  return rewrite(file, s, accelerators, "bvh");
}

/* ---- integrator -------------------------------------------------------------------------------------------------- */

#define LIGHTS {"lightsamplestrategy", VL_OLD_RENAME, "lightsampler"}, KEEP("lightsampler")
static const vlOldRow path[] = {KEEP("maxdepth"), DROP("rrthreshold"), LIGHTS, BOUNDS, KEEP("regularize"), END};
static const vlOldRow bdpt[] = {
    KEEP("maxdepth"), LIGHTS, BOUNDS, KEEP("visualizestrategies"), KEEP("visualizeweights"), KEEP("regularize"), END};
static const vlOldRow mlt[] = {KEEP("maxdepth"),
                               KEEP("bootstrapsamples"),
                               KEEP("chains"),
                               KEEP("mutationsperpixel"),
                               KEEP("largestepprobability"),
                               KEEP("sigma"),
                               KEEP("regularize"),
                               END};
static const vlOldRow sppm[] = {KEEP("maxdepth"),
                                {"numiterations", VL_OLD_LOSE, "give the sampler's \"pixelsamples\""},
                                {"iterations", VL_OLD_LOSE, "give the sampler's \"pixelsamples\""},
                                KEEP("photonsperiteration"),
                                DROP("imagewritefrequency"),
                                KEEP("radius"),
                                END};
static const vlOldRow ao[] = {KEEP("cossample"), DROP("nsamples"), BOUNDS, KEEP("maxdistance"), END};
static const vlOldRow direct[] = {KEEP("maxdepth"), DROP("strategy"), BOUNDS, END};

/* pbrt-v3's spatial sampler is nearest to that of the light tree. */
static bool light_sampler(vlOldFile *file, vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "lightsamplestrategy");
  if (!p || !p->strings || !vl_text_is(p->text[0], "spatial")) return true;
  vl_old_note(s, "spatial -> bvh");
  return vl_old_edit(file, p->span[0], "\"bvh\"");
}

static const char whole_path[] =
    "integrator of direct light has no counterpart: \"path\" is written, which adds "
    "indirect light";
static const vlOldKind integrators[] = {{"path", "path", path, light_sampler, NULL},
                                        {"volpath", "volpath", path, light_sampler, NULL},
                                        {"bdpt", "bdpt", bdpt, light_sampler, NULL},
                                        {"mlt", "mlt", mlt, NULL, NULL},
                                        {"sppm", "sppm", sppm, NULL, NULL},
                                        {"photonmap", "sppm", sppm, NULL, NULL},
                                        {"directlighting", "path", direct, NULL, whole_path},
                                        {"whitted", "path", direct, NULL, whole_path},
                                        {"ao", "ambientocclusion", ao, NULL, NULL},
                                        {"ambientocclusion", "ambientocclusion", ao, NULL, NULL},
                                        {NULL, NULL, NULL, NULL, NULL}};

bool vl_old_integrator(vlOldFile *file, vlOldStatement *s) {
  bool older = vl_text_is(s->word->name, "SurfaceIntegrator");
  if (older) vl_old_note(s, "-> Integrator");
  if (older && !vl_old_edit(file, s->keyword, "Integrator")) return false;
  /* pbrt-v3's path renders subsurface scattering, pbrt-v4's does not */
  const vlOldKind *kind = vl_old_kind(integrators, s->name[0]);
  bool path_tracer = !kind || vl_text_is(kind->to, "path");
  if (path_tracer && file->u->subsurface) {
    vlOldKind through = kind ? *kind : integrators[0];
    through.to = "volpath";
    vlOldKind table[2] = {through, {NULL, NULL, NULL, NULL, NULL}};
    return rewrite(file, s, table, "volpath");
  }
  file->u->plain_path = path_tracer;
  return rewrite(file, s, integrators, "path");
}

/* ---- media ------------------------------------------------------------------------------------------------------- */

#define SUBSTANCE KEEP("preset"), KEEP("sigma_a"), KEEP("sigma_s"), KEEP("g"), KEEP("scale")
static const vlOldRow homogeneous[] = {SUBSTANCE, KEEP("Le"), END};
static const vlOldRow grid[] = {SUBSTANCE,  KEEP("density"), KEEP("nx"), KEEP("ny"),
                                KEEP("nz"), KEEP("p0"),      KEEP("p1"), END};
static const vlOldKind media[] = {{"homogeneous", "homogeneous", homogeneous, NULL, NULL},
                                  {"heterogeneous", "uniformgrid", grid, NULL, NULL},
                                  {NULL, NULL, NULL, NULL, NULL}};

bool vl_old_medium(vlOldFile *file, vlOldStatement *s) {
  vlOldParam *type = vl_old_find(s, "type");
  const vlOldKind *kind = type && type->strings ? vl_old_kind(media, type->text[0]) : NULL;
  if (!kind) return true; /* pbrt-v4's own */
  if (!vl_old_rows(file, s, kind->rows, VL_OLD_LOSE)) return false;
  if (vl_text_is(kind->from, kind->to)) return true;
  vl_old_note(s, "\"%s\" -> \"%s\"", kind->from, kind->to);
  return vl_old_edit(file, type->span[0], "\"%s\"", kind->to);
}

/* ---- WorldBegin -------------------------------------------------------------------------------------------------- */

bool vl_old_world(vlOldFile *file, vlOldStatement *s) {
  file->u->has_world = true;
  vlUpgrade *u = file->u;
  char text[32];
  double iso = u->iso * u->exposure;
  if (!u->filter_given && u->is_old) {
    vl_old_note(s, "PixelFilter \"box\", pbrt-v3's default, before it");
    if (!vl_old_before(file, s, "PixelFilter \"box\"")) return false;
  }
  if (iso == 100) return true;
  if (u->film_file != file) {
    vl_old_lose(file, s->line, "the film's \"iso\" must be %s, for its scale and the shutter's time",
                vl_old_text(iso, text));
    return true;
  }
  vl_old_note(s, "the film's iso is %s", vl_old_text(iso, text));
  return vl_old_edit(file, (vlOldSpan){u->film_end, u->film_end}, " \"float iso\" %s", vl_old_text(iso, text));
}
