/* import/pbrt/upgrade/settings.c: camera, film, sampler, filter, integrator, accelerator,
 * media, WorldBegin. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

#define BOUNDS \
  { "pixelbounds", VL_OLD_LOSE, "give the film's \"pixelbounds\"" }

/* ---- camera ------------------------------------------------------------------------------ */

#define SHUTTER \
  { "shutteropen shutterclose frameaspectratio screenwindow" }
static const vlOldRow perspective[] = {{"fov lensradius focaldistance"}, SHUTTER, {0}};
static const vlOldRow environment[] = {
    SHUTTER,
    {"mapping", VL_OLD_DEFAULT, "\"string mapping\" \"equirectangular\""},
    {"fov", VL_OLD_DROP},
    {0}};
static const vlOldRow realistic[] = {{"lensfile aperturediameter focusdistance aperture"},
                                     {"simpleweighting", VL_OLD_DROP},
                                     SHUTTER,
                                     {0}};

static bool half_fov(vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "halffov");
  char text[32];
  if (!p || p->count < 1)
    return true;
  if (vl_old_find(s, "fov")) {
    vl_old_drop(s, vl_old_find(s, "fov"));
    return true;
  }
  p->new_name = "fov";
  vl_old_value(p, "%s", vl_old_text(2 * p->number[0], text));
  return true;
}

static bool lens_file(vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "lensfile");
  char name[4096];
  if (!p || !p->strings)
    return true;
  if (!vl_old_file_name(s, p->text[0], name, sizeof name))
    return false;
  return vl_text_is(name, p->text[0]) || vl_old_edit(s, p->span[0], "\"%s\"", name);
}

static const vlOldKind cameras[] = {{"perspective", NULL, perspective, half_fov},
                                    {"orthographic", NULL, perspective},
                                    {"environment", "spherical", environment},
                                    {"realistic", NULL, realistic, lens_file},
                                    {0}};

/* Replaces kind and parameters by the table. Unknown kinds become `otherwise`. */
static bool rewrite(vlOldStatement *s, const vlOldKind *kinds, const char *otherwise) {
  const vlOldKind *kind = vl_old_kind(kinds, s->name[0]);
  if (!kind) {
    vl_old_lose(s, "%s \"%s\" has no counterpart: \"%s\" is written", s->directive, s->name[0],
                otherwise);
    for (size_t i = 0; i < s->params.count; i++)
      s->params.items[i].dropped = true;
    return vl_old_rename(s, 0, otherwise);
  }
  return vl_old_become(s, kind);
}

/* In pbrt-v4 the image is as much brighter as the shutter is open longer. */
bool vl_old_camera(vlOldStatement *s) {
  double open = vl_old_number(s, "shutteropen", 0), close = vl_old_number(s, "shutterclose", 1);
  if (close > open)
    s->u->exposure = 1 / (close - open);
  return rewrite(s, cameras, "perspective");
}

/* ---- film -------------------------------------------------------------------------------- */

static const vlOldRow film[] = {{"xresolution yresolution"},
                                {"xresolution", VL_OLD_DEFAULT, "\"integer xresolution\" 640"},
                                {"yresolution", VL_OLD_DEFAULT, "\"integer yresolution\" 480"},
                                {"cropwindow diagonal filename"},
                                {"maxsampleluminance", VL_OLD_RENAME, "maxcomponentvalue"},
                                {"display", VL_OLD_DROP},
                                {0}};
static const vlOldKind films[] = {{"image", "rgb", film}, {0}};

bool vl_old_film(vlOldStatement *s) {
  if (vl_has_word("rgb gbuffer spectral", s->name[0]))
    return true;
  vlOldParam *scale = vl_old_find(s, "scale");
  vlUpgrade *u = s->u;
  if (scale && scale->count == 1)
    u->iso = 100 * scale->number[0];
  vl_old_drop(s, scale);
  u->film_file = s->file;
  u->film_end = s->whole.end;
  return rewrite(s, films, "rgb");
}

/* ---- sampler, filter, accelerator -------------------------------------------------------- */

static const vlOldRow sampler[] = {{"pixelsamples xsamples ysamples jitter"},
                                   {"dimensions", VL_OLD_DROP},
                                   {"samplepixelcenter", VL_OLD_DROP},
                                   {"seed"},
                                   {0}};
static const vlOldRow adaptive[] = {{"maxsamples", VL_OLD_RENAME, "pixelsamples"},
                                    {"minsamples", VL_OLD_DROP},
                                    {"method", VL_OLD_DROP},
                                    {"pixelsamples"},
                                    {0}};
static const vlOldKind samplers[] = {
    {"halton sobol stratified independent zsobol paddedsobol pmj02bn", NULL, sampler},
    {"random", "independent", sampler},
    {"lowdiscrepancy 02sequence zerotwosequence", "paddedsobol", sampler},
    {"maxmindist", "pmj02bn", sampler},
    {"bestcandidate", "sobol", sampler},
    {"adaptive", "sobol", adaptive},
    {0}};

bool vl_old_sampler(vlOldStatement *s) {
  return rewrite(s, samplers, "zsobol");
}

#define RADIUS                                                                  \
  {"xwidth", VL_OLD_RENAME, "xradius"}, {"ywidth", VL_OLD_RENAME, "yradius"}, { \
    "xradius yradius"                                                           \
  }
static const vlOldRow plain_filter[] = {RADIUS, {0}};
static const vlOldRow gaussian[] = {RADIUS,
                                    {"xradius", VL_OLD_DEFAULT, "\"float xradius\" 2"},
                                    {"yradius", VL_OLD_DEFAULT, "\"float yradius\" 2"},
                                    {"sigma"},
                                    {0}};
static const vlOldRow mitchell[] = {RADIUS, {"B C"}, {0}};
static const vlOldRow sinc[] = {RADIUS, {"tau"}, {0}};

/* exp(-alpha x^2) is a Gaussian of the variance 1 / (2 alpha). */
static bool gaussian_rule(vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "alpha");
  char text[32];
  if (!p || p->count != 1 || !(p->number[0] > 0))
    return true;
  p->new_name = "sigma";
  vl_old_value(p, "%s", vl_old_text(sqrt(0.5 / p->number[0]), text));
  return true;
}

static const vlOldKind filters[] = {{"box triangle", NULL, plain_filter},
                                    {"gaussian", NULL, gaussian, gaussian_rule},
                                    {"mitchell", NULL, mitchell},
                                    {"sinc", NULL, sinc},
                                    {0}};

bool vl_old_filter(vlOldStatement *s) {
  s->u->filter_given = true;
  return rewrite(s, filters, "gaussian");
}

static const vlOldRow bvh[] = {{"maxnodeprims splitmethod"}, {0}};
static const vlOldRow kdtree[] = {{"intersectcost traversalcost emptybonus maxprims maxdepth"},
                                  {0}};
static const vlOldKind accelerators[] = {
    {"bvh", NULL, bvh}, {"kdtree", NULL, kdtree}, {"none", "bvh"}, {0}};

bool vl_old_accelerator(vlOldStatement *s) {
  return rewrite(s, accelerators, "bvh");
}

/* ---- integrator -------------------------------------------------------------------------- */

#define LIGHTS                                              \
  {"lightsamplestrategy", VL_OLD_RENAME, "lightsampler"}, { \
    "lightsampler"                                          \
  }
static const vlOldRow path[] = {
    {"maxdepth"}, {"rrthreshold", VL_OLD_DROP}, LIGHTS, BOUNDS, {"regularize"}, {0}};
static const vlOldRow bdpt[] = {{"maxdepth"},
                                {"lightsamplestrategy", VL_OLD_DROP},
                                BOUNDS,
                                {"visualizestrategies visualizeweights regularize"},
                                {0}};
static const vlOldRow mlt[] = {
    {"maxdepth bootstrapsamples chains mutationsperpixel largestepprobability sigma regularize"},
    {0}};
static const vlOldRow sppm[] = {
    {"maxdepth"},
    {"numiterations", VL_OLD_LOSE, "give the sampler's \"pixelsamples\""},
    {"iterations", VL_OLD_LOSE, "give the sampler's \"pixelsamples\""},
    {"photonsperiteration"},
    {"imagewritefrequency", VL_OLD_DROP},
    {"radius"},
    {0}};
static const vlOldRow ao[] = {
    {"cossample"}, {"nsamples", VL_OLD_DROP}, BOUNDS, {"maxdistance"}, {0}};
static const vlOldRow direct[] = {{"maxdepth"}, {"strategy", VL_OLD_DROP}, BOUNDS, {0}};

/* pbrt-v3's spatial sampler is nearest to that of the light tree. */
static bool light_sampler(vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "lightsamplestrategy");
  if (!p || !p->strings || !vl_text_is(p->text[0], "spatial"))
    return true;
  vl_old_note(s, "spatial -> bvh");
  return vl_old_edit(s, p->span[0], "\"bvh\"");
}

static const char whole_path[] =
    "integrator of direct light has no counterpart: \"path\" is written, which adds "
    "indirect light";
static const vlOldKind integrators[] = {
    {"path", "path", path, light_sampler},
    {"volpath", NULL, path, light_sampler},
    {"bdpt", NULL, bdpt},
    {"mlt", NULL, mlt},
    {"sppm photonmap", "sppm", sppm},
    {"directlighting whitted", "path", direct, NULL, whole_path},
    {"ao ambientocclusion", "ambientocclusion", ao},
    {0}};

bool vl_old_integrator(vlOldStatement *s) {
  bool older = vl_text_is(s->directive, "SurfaceIntegrator");
  if (older)
    vl_old_note(s, "-> Integrator");
  if (older && !vl_old_edit(s, s->keyword, "Integrator"))
    return false;
  /* pbrt-v3's path renders subsurface scattering, pbrt-v4's does not */
  const vlOldKind *kind = vl_old_kind(integrators, s->name[0]);
  bool path_tracer = !kind || vl_text_is(kind->to, "path");
  if (path_tracer && s->u->subsurface) {
    vlOldKind through = kind ? *kind : integrators[0];
    through.to = "volpath";
    vlOldKind table[2] = {through, {0}};
    return rewrite(s, table, "volpath");
  }
  s->u->plain_path = path_tracer;
  return rewrite(s, integrators, "path");
}

/* ---- media ------------------------------------------------------------------------------- */

#define SUBSTANCE \
  { "preset sigma_a sigma_s g scale" }
static const vlOldRow homogeneous[] = {SUBSTANCE, {"Le"}, {0}};
static const vlOldRow grid[] = {SUBSTANCE, {"density nx ny nz p0 p1"}, {0}};
static const vlOldKind media[] = {
    {"homogeneous", NULL, homogeneous}, {"heterogeneous", "uniformgrid", grid}, {0}};

bool vl_old_medium(vlOldStatement *s) {
  vlOldParam *type = vl_old_find(s, "type");
  const vlOldKind *kind = type && type->strings ? vl_old_kind(media, type->text[0]) : NULL;
  if (!kind)
    return true; /* pbrt-v4's own */
  if (!vl_old_rows(s, kind->rows))
    return false;
  if (!kind->to)
    return true;
  vl_old_note(s, "\"%s\" -> \"%s\"", type->text[0], kind->to);
  return vl_old_edit(s, type->span[0], "\"%s\"", kind->to);
}

/* ---- WorldBegin -------------------------------------------------------------------------- */

bool vl_old_world(vlOldStatement *s) {
  s->u->has_world = true;
  vlUpgrade *u = s->u;
  char text[32];
  double iso = u->iso * u->exposure;
  if (!u->filter_given && u->is_old) {
    vl_old_note(s, "PixelFilter \"box\", pbrt-v3's default, before it");
    if (!vl_old_insert(s, VL_OLD_BEFORE, "PixelFilter \"box\""))
      return false;
  }
  if (iso == 100)
    return true;
  if (u->film_file != s->file) {
    vl_old_lose(s, "the film's \"iso\" must be %s, for its scale and the shutter's time",
                vl_old_text(iso, text));
    return true;
  }
  vl_old_note(s, "the film's iso is %s", vl_old_text(iso, text));
  return vl_old_edit(s, (vlOldSpan){u->film_end, u->film_end}, " \"float iso\" %s",
                     vl_old_text(iso, text));
}
