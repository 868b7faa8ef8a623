/* schema/settings.c: rows of the settings that are no parameters of a kind: of renders, loads,
 * completed scenes, ground truth, image files, contexts, and of the program alone. Those of
 * cameras are in cameras.c, those of sensors in sensors.c. Also the defaults of the defs that
 * hold an image's settings. */
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "base/text.h"
#include "base/unset.h"
#include "color/color.h"
#include "schema/schema.h"
#include "velo/channels.h"
#include "velo/filter_kinds.h"
#include "velo/image.h"
#include "velo/load.h"
#include "velo/render.h"
#include "velo/sampler.h"
#include "velo/setting.h"
#include "velo/tracer.h"

#define DEGREES 0.017453292519943295
#define WITHIN(min, max) .low = (min), .high = (max)
#define ABOVE(min) VL_FROM(min), .flags = VL_PARAMETER_ABOVE_LOW
#define UNSET .flags = VL_PARAMETER_UNSET
#define NAME(kind, name) #name,
/* A member that no type of parameters has: an int that is never negative. */
#define WHOLE(Def, path, line, ...)                                             \
  {                                                                             \
    .type = VL_PARAMETER_COUNT, .member = #path, .offset = offsetof(Def, path), \
    .size = sizeof(((const Def *)NULL)->path), .description = line, __VA_ARGS__ \
  }
#define MAX_SPP 16777216
#define MAX_SIDE 65536

/* ---- renders ----------------------------------------------------------------------------- */

static const char *const tracers[] = {VL_TRACER_KINDS(NAME) NULL};
static const char *const samplers[] = {VL_SAMPLER_KINDS(NAME) NULL};
static const char *const filters[] = {VL_PIXEL_FILTER_KINDS(NAME) NULL};
static const char *const spaces[] = {"srgb", "dci_p3", "rec2020", "aces2065_1", NULL};
static const char *const views[] = {"standard", "khronos_neutral", "agx", "raw", NULL};
static const char *const colors[] = {"spectral", "rgb", NULL};
static const char *const light_samplers[] = {"bvh", "power", "uniform", NULL};
static const char *const bits[] = {"portable", "fast", NULL};
static const char *const accelerators[] = {"auto", "embree", "bvh", NULL};

#define RENDER(TYPE, ...) VL_PARAMETER(TYPE, vlSceneDefs, NULL, __VA_ARGS__)
static const vlParameter render_parameters[] = {
    RENDER(CHOICE, render.tracer, "light transport algorithm", .choices = tracers,
           VL_DEFAULT(VL_TRACER_VOLPATH)),
    RENDER(CHOICE, render.sampler, "generator of the sample points", .choices = samplers,
           VL_DEFAULT(VL_SAMPLER_ZSOBOL)),
    RENDER(COUNT, render.spp, "samples per pixel", WITHIN(1, MAX_SPP), VL_DEFAULT(16)),
    RENDER(COUNT, render.seed, "seed of the random numbers", .unit = NULL),
    RENDER(COUNT, render.sequence,
           "length of the sequence of samples; 0: chosen by the sampler", WITHIN(0, MAX_SPP)),
    RENDER(COUNT, render.first_sample, "index of the first sample", WITHIN(0, MAX_SPP)),
    RENDER(COUNT, render.max_depth, "largest number of bounces of a path", WITHIN(0, 4096),
           VL_DEFAULT(5)),
    RENDER(COUNT, render.max_diffuse_depth,
           "largest number of diffuse bounces of a path; 0: no such limit", WITHIN(0, 4096)),
    RENDER(COUNT, render.max_glossy_depth,
           "largest number of glossy or specular reflections of a path; 0: no such limit",
           WITHIN(0, 4096)),
    RENDER(COUNT, render.max_transmission_depth,
           "largest number of transmissions of a path; 0: no such limit", WITHIN(0, 4096)),
    RENDER(COUNT, render.max_volume_depth,
           "largest number of scatterings of a path in media; 0: no such limit",
           WITHIN(0, 4096)),
    RENDER(FLOAT, render.ao_distance, "ambient occlusion: length of its rays, scene units",
           VL_FROM(0), VL_DEFAULT(INFINITY),
           .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_INFINITE),
    RENDER(BOOL, render.ao_cosine, "ambient occlusion: cosine-weighted directions",
           VL_DEFAULT(1)),
    RENDER(BOOL, render.centred, "all samples at the centre of pixel, lens and exposure",
           .unit = NULL),
    RENDER(BOOL, render.same_wavelengths, "all paths have the same wavelengths", .unit = NULL),
    RENDER(BOOL, render.sharp_textures, "textures are not filtered", .unit = NULL),
    RENDER(BOOL, render.share_samples, "a pixel counts all samples that its filter covers",
           VL_DEFAULT(1)),
    RENDER(BOOL, render.transparent, "the background is transparent", .unit = NULL),
    RENDER(
        DOUBLE, render.merge_radius,
        "radius within which paths merge in the first pass, scene units; unset: the width of "
        "two pixels",
        WITHIN(1e-30, 1e30), UNSET),
    RENDER(COUNT, render.light_paths,
           "number of light paths per pass; 4294967295: one per pixel",
           VL_DEFAULT(VL_AS_MANY_AS_PIXELS)),
    RENDER(DOUBLE, render.time_limit, "limit of the time of a render; 0: none", VL_FROM(0),
           .unit = "s"),
    RENDER(DOUBLE, render.noise,
           "adaptive sampling: threshold of noise in display values; 0: none", WITHIN(0, 0.5)),
    RENDER(CHOICE, render.noise_view, "view transform that makes these display values",
           .choices = views),
    RENDER(FLOAT, render.noise_exposure, "exposure before this view", WITHIN(-100, 100),
           .unit = "stops"),
    RENDER(FLOAT, render.noise_scale, "factor before this view", ABOVE(0), VL_DEFAULT(1)),
    RENDER(COUNT, render.pass_rows, "rows of the image that a pass goes over; 0: all",
           .unit = "pixels"),
    WHOLE(vlSceneDefs, render.priority,
          "of several renders at once, the highest gets all threads", WITHIN(0, 1e6)),
    RENDER(CHOICE, film.filter.kind, "pixel filter", .choices = filters, .keyword = "filter",
           VL_DEFAULT(VL_PIXEL_FILTER_GAUSSIAN)),
    RENDER(FLOAT, film.filter.radius_x, "half of the filter's width",
           .keyword = "filter_radius_x", WITHIN(0, VL_MAX_FILTER_RADIUS),
           .flags = VL_PARAMETER_ABOVE_LOW, VL_DEFAULT(1.5), .unit = "pixels"),
    RENDER(FLOAT, film.filter.radius_y, "half of the filter's height",
           .keyword = "filter_radius_y", WITHIN(0, VL_MAX_FILTER_RADIUS),
           .flags = VL_PARAMETER_ABOVE_LOW, VL_DEFAULT(1.5), .unit = "pixels"),
    RENDER(FLOAT, film.filter.sigma, "gaussian: standard deviation", .keyword = "filter_sigma",
           WITHIN(0, 1e6), .flags = VL_PARAMETER_ABOVE_LOW, VL_DEFAULT(0.5), .unit = "pixels"),
    RENDER(FLOAT, film.filter.b, "mitchell: B", .keyword = "filter_b", WITHIN(-10, 3),
           .flags = VL_PARAMETER_BELOW_HIGH),
    RENDER(FLOAT, film.filter.c, "mitchell: C", .keyword = "filter_c", WITHIN(-10, 10)),
    RENDER(FLOAT, film.filter.tau, "lanczos: cycles of the sinc", .keyword = "filter_tau",
           WITHIN(0, 1e6), .flags = VL_PARAMETER_ABOVE_LOW),
    RENDER(CHOICE, film.space, "colour space of the image", .choices = spaces),
    RENDER(DOUBLE, film.white_balance,
           "colour temperature of the daylight that becomes white; 0: none", WITHIN(0, 100000),
           .unit = "K"),
    RENDER(STRING, film.sensor, "spectral response of the sensor", .text = NULL),
    RENDER(FLOAT, film.max_component, "samples with a larger component are scaled down to it",
           VL_FROM(0), VL_DEFAULT(INFINITY), .flags = VL_PARAMETER_INFINITE),
    RENDER(BOOL, film.errors, "keep what standard errors need", .unit = NULL),
    RENDER(COUNT, film.buckets, "intervals of wavelength of the spectrum; 0: no spectrum",
           WITHIN(0, 1000)),
    RENDER(DOUBLE, film.lambda_min, "where the spectrum starts", WITHIN(360, 830),
           VL_DEFAULT(360), .unit = "nm"),
    RENDER(DOUBLE, film.lambda_max, "where the spectrum ends", WITHIN(360, 830),
           VL_DEFAULT(830), .unit = "nm"),
    RENDER(CHOICE, build.color, "representation of colours during light transport",
           .choices = colors),
    RENDER(CHOICE, build.light_sampler, "method that chooses a light",
           .choices = light_samplers),
    RENDER(BOOL, build.imitate_pbrt, "reproduce a known error of pbrt-v4", .unit = NULL),
    RENDER(BOOL, build.regularize,
           "make surfaces rougher that a path hits after it has been scattered", .unit = NULL),
    RENDER(CHOICE, build.bits, "the same image on every machine, or less time",
           .choices = bits),
    RENDER(CHOICE, build.accelerator, "what finds the surfaces that rays meet",
           .choices = accelerators),
    RENDER(FLOAT, develop.exposure, "factor on the image", VL_DEFAULT(1)),
};
static const vlKindRow render_row = {VL_ROW_PARAMETERS(render_parameters), .name = "render",
                                     .description = "how an image is rendered"};

/* ---- scenes ------------------------------------------------------------------------------ */

#define LOAD(TYPE, ...) VL_PARAMETER(TYPE, vlLoadDef, NULL, __VA_ARGS__)
static const vlParameter load_parameters[] = {
    LOAD(BOOL, permissive, "warn about what is not supported, and repair normals",
         .unit = NULL),
    LOAD(DOUBLE, time, "glTF: time of the animations", WITHIN(-1e6, 1e6), UNSET, .unit = "s"),
    LOAD(DOUBLE, time_close, "glTF: time when the shutter closes", WITHIN(-1e6, 1e6), UNSET,
         .unit = "s"),
    LOAD(STRING, scene, "glTF: the scene, by name or number", .text = NULL),
    LOAD(STRING, animation, "glTF: the animation, by name or number", .text = NULL),
    LOAD(STRING, variant, "glTF: the material variant", .text = NULL),
    LOAD(STRING, camera, "glTF: the camera, by name or number", .text = NULL),
    LOAD(BOOL, strict, "glTF, OBJ: a missing image is an error", .unit = NULL),
    LOAD(STRING, search_path, "further folders of files, separated by colons", .text = NULL),
    LOAD(DOUBLE, unit, "length of the file's unit, for candela and lumens", WITHIN(1e-9, 1e9),
         UNSET, .unit = "m", .keyword = "scene_unit"),
};
static const vlKindRow load_row = {VL_ROW_PARAMETERS(load_parameters), .name = "load",
                                   .description = "how a file of a scene is read"};

static const char *const environments[] = {"auto", "none",  "studio", "sky",     "white",
                                           "file", "lamps", "window", "evening", NULL};
static const char *const framings[] = {"auto", "corner", "front", NULL};
#define COMPLETE(TYPE, ...) VL_PARAMETER(TYPE, vlCompleteDef, NULL, __VA_ARGS__)
static const vlParameter complete_parameters[] = {
    COMPLETE(COUNT, width, "width of the image; 0: the film's", WITHIN(0, MAX_SIDE),
             .unit = "pixels"),
    COMPLETE(COUNT, height, "height of the image; 0: the film's", WITHIN(0, MAX_SIDE),
             .unit = "pixels"),
    COMPLETE(CHOICE, environment, "light from all directions", .choices = environments),
    COMPLETE(FILE, path, "image of the environment", .text = NULL),
    COMPLETE(DOUBLE, rotation,
             "rotation of the environment about the vertical axis; unset: a studio's main "
             "light is on the camera's left",
             WITHIN(-1e6 * DEGREES, 1e6 * DEGREES), UNSET, .unit = "degrees", .factor = DEGREES,
             .alias = "environment_rotation"),
    COMPLETE(FLOAT, strength, "factor on the radiance of the environment", WITHIN(0, 1e6),
             VL_DEFAULT(1), .alias = "environment_strength"),
    COMPLETE(DOUBLE3, up, "the direction upwards", VL_DEFAULT(0, 1, 0),
             .flags = VL_PARAMETER_VECTOR),
    COMPLETE(DOUBLE3, front, "the direction to the front", VL_DEFAULT(0, 0, 1),
             .flags = VL_PARAMETER_VECTOR),
    COMPLETE(BOOL, find_up, "y or z is upwards: the one with which the model stands",
             .unit = NULL),
    COMPLETE(BOOL, ground, "add a wide grey disk as ground", .unit = NULL),
    COMPLETE(BOOL, reframe, "replace the file's camera", .unit = NULL),
    COMPLETE(CHOICE, framing, "where the added camera stands", .choices = framings),
    COMPLETE(DOUBLE, azimuth,
             "where the added camera stands: angle from the front to the right; unset: as "
             "framing says",
             WITHIN(-1e6 * DEGREES, 1e6 * DEGREES), UNSET, .unit = "degrees",
             .factor = DEGREES),
    COMPLETE(DOUBLE, elevation, "its angle above the horizon",
             WITHIN(-89 * DEGREES, 89 * DEGREES), UNSET, .unit = "degrees", .factor = DEGREES),
    COMPLETE(BOOL, backdrop, "with a studio: add a ground of its colour", .unit = NULL),
    COMPLETE(DOUBLE3, ground_middle, "middle of the ground; unset: under the model",
             .flags = VL_PARAMETER_VECTOR | VL_PARAMETER_UNSET),
    COMPLETE(DOUBLE, ground_radius, "radius of the ground; unset: by the size of the model",
             WITHIN(0, 1e30), .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_UNSET),
    COMPLETE(BOOL, open_walls, "leave out walls between the added camera and the middle",
             .unit = NULL),
    COMPLETE(DOUBLE3, walls_from,
             "the point that stands for the camera when walls are left out; unset: where the "
             "added camera stands",
             .flags = VL_PARAMETER_VECTOR | VL_PARAMETER_UNSET),
    COMPLETE(BOOL, both_sides, "one-sided faces are seen from both sides", .unit = NULL),
};
static const vlKindRow complete_row = {
    VL_ROW_PARAMETERS(complete_parameters), .name = "complete",
    .description = "what a scene gets that lacks camera, light or ground"};

/* ---- images ------------------------------------------------------------------------------ */

static const char *const modes[] = {"centre", "nearest", "coverage", NULL};
static const vlParameter channels_parameters[] = {
    VL_PARAMETER(CHOICE, vlChannelsDef, NULL, mode, "point of a pixel of which ground truth is",
                 .choices = modes),
    VL_PARAMETER(COUNT, vlChannelsDef, NULL, ranks,
                 "ids per pixel of Cryptomatte, an even number", WITHIN(2, 32), VL_DEFAULT(6),
                 .alias = "crypto_ranks"),
    VL_PARAMETER(DOUBLE, vlChannelsDef, NULL, time,
                 "time for which ground truth is; unset: the exposure's middle", UNSET,
                 .unit = "s"),
};
static const vlKindRow channels_row = {VL_ROW_PARAMETERS(channels_parameters),
                                       .name = "channels",
                                       .description = "ground truth beside an image"};

static const vlParameter write_parameters[] = {
    VL_PARAMETER(BOOL, vlWriteDef, NULL, half, "EXR: 16-bit floats", .unit = NULL),
    WHOLE(vlWriteDef, compression, "EXR: 0 none, 1 ZIP", WITHIN(0, 1), VL_DEFAULT(1)),
    WHOLE(vlWriteDef, quality, "JPEG: quality", WITHIN(1, 100), VL_DEFAULT(95)),
};
static const vlKindRow write_row = {VL_ROW_PARAMETERS(write_parameters), .name = "write",
                                    .description = "how an image is written"};

/* ---- contexts, and the program ----------------------------------------------------------- */

static const vlParameter context_parameters[] = {
    VL_PARAMETER(COUNT, vlContextDef, NULL, threads, "number of worker threads",
                 WITHIN(1, 1024), VL_DEFAULT(1)),
};
static const vlKindRow context_row = {VL_ROW_PARAMETERS(context_parameters), .name = "context",
                                      .description = "threads"};

/* A setting that no def has. */
#define OWN(TYPE, word, line, ...)                                                \
  {                                                                               \
    .type = VL_PARAMETER_##TYPE, .member = word, .flags = VL_PARAMETER_SHORTHAND, \
    .description = line, __VA_ARGS__                                              \
  }
static const vlParameter program_parameters[] = {
    OWN(FLOAT, "exposure", "exposure of images for display: a factor of 2^exposure",
        WITHIN(-64, 64), .unit = "stops"),
    OWN(DOUBLE, "turn", "rotation of the camera about the vertical axis", WITHIN(-1e6, 1e6),
        .unit = "degrees"),
    OWN(DOUBLE, "shutter", "time for which the shutter is open", WITHIN(0, 1e6), .unit = "s"),
    OWN(COUNT, "width", "width of an image", WITHIN(1, MAX_SIDE), VL_DEFAULT(1280),
        .unit = "pixels"),
    OWN(COUNT, "height", "height of an image", WITHIN(1, MAX_SIDE), VL_DEFAULT(720),
        .unit = "pixels"),
    OWN(DOUBLE, "x", "column of a point of the image", WITHIN(-MAX_SIDE, MAX_SIDE),
        .unit = "pixels"),
    OWN(DOUBLE, "y", "row of a point of the image", WITHIN(-MAX_SIDE, MAX_SIDE),
        .unit = "pixels"),
    OWN(COUNT, "samples", "number of samples whose paths are shown; 0: the usual number",
        WITHIN(0, MAX_SIDE)),
    OWN(COUNT, "show", "number of paths that are shown one by one", WITHIN(0, 64)),
};
static const vlKindRow program_row = {VL_ROW_PARAMETERS(program_parameters), .name = "program",
                                      .description = "what is turned into other settings"};

/* ---- defaults ---------------------------------------------------------------------------- */

vlLoadDef vl_default_load_def(void) {
  return (vlLoadDef){
      .cookie = VL_COOKIE_LOAD, .time = VL_UNSET, .time_close = VL_UNSET, .unit = VL_UNSET};
}

vlBuildDef vl_default_build_def(void) {
  return (vlBuildDef){.cookie = VL_COOKIE_BUILD,
                      .color = VL_COLOR_SPECTRAL,
                      .light_sampler = VL_LIGHT_SAMPLER_BVH};
}

vlFilmDef vl_default_film_def(uint32_t width, uint32_t height) {
  return (vlFilmDef){.cookie = VL_COOKIE_FILM,
                     .width = width,
                     .height = height,
                     .crop = {0, 0, width, height},
                     .filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN),
                     .space = (vlColorSpace)0,
                     .max_component = INFINITY,
                     .lambda_min = VL_LAMBDA_MIN,
                     .lambda_max = VL_LAMBDA_MIN + VL_LAMBDA_COUNT - 1};
}

vlDevelopDef vl_default_develop_def(void) {
  return (vlDevelopDef){.cookie = VL_COOKIE_DEVELOP, .exposure = 1.0f};
}

vlRenderDef vl_default_render_def(void) {
  return (vlRenderDef){.cookie = VL_COOKIE_RENDER,
                       .tracer = VL_TRACER_VOLPATH,
                       .sampler = VL_SAMPLER_ZSOBOL,
                       .spp = 16,
                       .max_depth = 5,
                       .ao_distance = INFINITY,
                       .merge_radius = VL_UNSET,
                       .light_paths = VL_AS_MANY_AS_PIXELS,
                       .noise_scale = 1.0f,
                       .share_samples = true,
                       .ao_cosine = true};
}

/* ---- finding them ------------------------------------------------------------------------ */

/* The parameters of cameras are in cameras.c, those of sensors in sensors.c. */
#define GROUP_ROWS(X)                          \
  X(VL_SETTING_RENDER, render_row)             \
  X(VL_SETTING_CAMERA, vl_camera_settings_row) \
  X(VL_SETTING_LOAD, load_row)                 \
  X(VL_SETTING_COMPLETE, complete_row)         \
  X(VL_SETTING_CHANNELS, channels_row)         \
  X(VL_SETTING_WRITE, write_row)               \
  X(VL_SETTING_CONTEXT, context_row)           \
  X(VL_SETTING_PROGRAM, program_row)           \
  X(VL_SETTING_SENSOR, vl_sensor_settings_row) \
  X(VL_SETTING_EXPOSURE, vl_exposure_settings_row)
_Static_assert(0 GROUP_ROWS(VL_COUNT_KIND) == 0 VL_SETTING_GROUPS(VL_COUNT_KIND),
               "each group has a row");
const vlKindFamily vl_setting_family =
    VL_KIND_FAMILY(GROUP_ROWS(VL_LIST_ROW), VL_SETTING_GROUPS, "settings", "setting", NULL);

const vlKindRow *vl_settings(vlSettingGroup group) {
  return vl_kind_row(&vl_setting_family, (int)group);
}

const char *vl_setting_keyword(const vlParameter *row) {
  return row->keyword ? row->keyword : vl_last_part(row->member);
}

/* Whether the words are the same, with '_', '-' and '.' as one character. */
static bool same(const char *a, const char *b) {
  for (; *a && *b; a++, b++)
    if (*a != *b && !(strchr("_-.", *a) && strchr("_-.", *b)))
      return false;
  return *a == *b;
}

/* The first row with that keyword, or with that member. Those of cameras that files set by
 * rules are none. */
static const vlParameter *find(const vlKindRow *rows, const char *name, bool by_member) {
  VL_EACH_PARAMETER(row, rows) {
    if (row->flags & VL_PARAMETER_RULE)
      continue;
    if (same(by_member ? row->member : vl_setting_keyword(row), name))
      return row;
    if (row->alias && same(row->alias, name))
      return row;
  }
  return NULL;
}

const vlParameter *vl_setting(vlSettingGroup group, const char *name) {
  const vlKindRow *rows = vl_settings(group);
  const vlParameter *row = rows ? find(rows, name, false) : NULL;
  return row || !rows ? row : find(rows, name, true);
}
