/* _velo/rows.c: rows of the defs that velo/schema.h has none for. Their names are the members' names. */
#include <stddef.h>

#include "module.h"

#define ROW(TYPE, Def, path, ...) \
  { .type = VL_PARAMETER_##TYPE, .member = #path, .offset = offsetof(Def, path), __VA_ARGS__ }
#define CHOICE(Def, path, list) ROW(CHOICE, Def, path, .choices = list)
#define ROWS(array) \
  { array, sizeof(array) / sizeof *(array) }
#define KIND(NAME, name) #name,

static const char *const tracers[] = {VL_TRACER_KINDS(KIND) NULL};
static const char *const samplers[] = {VL_SAMPLER_KINDS(KIND) NULL};
static const char *const filters[] = {VL_PIXEL_FILTER_KINDS(KIND) NULL};
static const char *const projections[] = {VL_PROJECTION_KINDS(KIND) NULL};
static const char *const spaces[] = {"srgb", "dci_p3", "rec2020", "aces2065_1", NULL};
static const char *const views[] = {"standard", "khronos_neutral", "agx", "raw", NULL};
static const char *const colors[] = {"spectral", "rgb", NULL};
static const char *const light_samplers[] = {"bvh", "power", "uniform", NULL};
static const char *const bits[] = {"portable", "fast", NULL};
static const char *const environments[] = {"auto", "none", "studio", "sky", "white", "file", NULL};
static const char *const framings[] = {"auto", "corner", "front", NULL};
static const char *const modes[] = {"centre", "nearest", "coverage", NULL};
static const char *const distortions[] = {"none", "opencv", "radial", "thin_prism", NULL};
static const char *const axes[] = {"vertical", "horizontal", "diagonal", "smaller", "larger", NULL};
static const char *const stereo_modes[] = {"none", "parallel", "off_axis", "toe_in", "omnidirectional", NULL};
static const char *const eyes[] = {"both", "left", "right", NULL};
static const char *const readouts[] = {"down", "up", "right", "left", NULL};

#define SCENE(TYPE, path) ROW(TYPE, vlSceneDefs, path)
static const vlParameter scene_array[] = {
    CHOICE(vlSceneDefs, render.tracer, tracers),
    CHOICE(vlSceneDefs, render.sampler, samplers),
    SCENE(COUNT, render.spp),
    SCENE(COUNT, render.seed),
    SCENE(COUNT, render.sequence),
    SCENE(COUNT, render.first_sample),
    SCENE(COUNT, render.max_depth),
    SCENE(FLOAT, render.ao_distance),
    SCENE(BOOL, render.ao_cosine),
    SCENE(BOOL, render.centred),
    SCENE(BOOL, render.same_wavelengths),
    SCENE(BOOL, render.sharp_textures),
    SCENE(BOOL, render.share_samples),
    SCENE(BOOL, render.transparent),
    SCENE(DOUBLE, render.merge_radius),
    SCENE(COUNT, render.light_paths),
    SCENE(DOUBLE, render.time_limit),
    SCENE(DOUBLE, render.noise),
    CHOICE(vlSceneDefs, render.noise_view, views),
    SCENE(FLOAT, render.noise_exposure),
    SCENE(FLOAT, render.noise_scale),
    SCENE(COUNT, render.priority),
    ROW(CHOICE, vlSceneDefs, film.filter.kind, .name = "filter", .choices = filters),
    ROW(FLOAT, vlSceneDefs, film.filter.radius_x, .name = "filter_radius_x"),
    ROW(FLOAT, vlSceneDefs, film.filter.radius_y, .name = "filter_radius_y"),
    ROW(FLOAT, vlSceneDefs, film.filter.sigma, .name = "filter_sigma"),
    ROW(FLOAT, vlSceneDefs, film.filter.b, .name = "filter_b"),
    ROW(FLOAT, vlSceneDefs, film.filter.c, .name = "filter_c"),
    ROW(FLOAT, vlSceneDefs, film.filter.tau, .name = "filter_tau"),
    CHOICE(vlSceneDefs, film.space, spaces),
    SCENE(DOUBLE, film.white_balance),
    SCENE(STRING, film.sensor),
    SCENE(FLOAT, film.max_component),
    SCENE(BOOL, film.errors),
    SCENE(COUNT, film.buckets),
    SCENE(DOUBLE, film.lambda_min),
    SCENE(DOUBLE, film.lambda_max),
    CHOICE(vlSceneDefs, build.color, colors),
    CHOICE(vlSceneDefs, build.light_sampler, light_samplers),
    SCENE(BOOL, build.imitate_pbrt),
    SCENE(BOOL, build.regularize),
    CHOICE(vlSceneDefs, build.bits, bits),
    SCENE(FLOAT, develop.exposure),
};
const Rows scene_rows = ROWS(scene_array);

#define LOAD(TYPE, path) ROW(TYPE, vlLoadDef, path)
static const vlParameter load_array[] = {
    LOAD(BOOL, permissive),  LOAD(BOOL, strict),       LOAD(STRING, search_path),
    LOAD(DOUBLE, time),      LOAD(DOUBLE, time_close), LOAD(STRING, scene),
    LOAD(STRING, animation), LOAD(STRING, variant),    LOAD(STRING, camera),
};
const Rows load_rows = ROWS(load_array);

#define COMPLETE(TYPE, path) ROW(TYPE, vlCompleteDef, path)
static const vlParameter complete_array[] = {
    COMPLETE(COUNT, width),
    COMPLETE(COUNT, height),
    CHOICE(vlCompleteDef, environment, environments),
    COMPLETE(FILE, path),
    COMPLETE(DOUBLE, rotation),
    COMPLETE(FLOAT, strength),
    COMPLETE(DOUBLE3, up),
    COMPLETE(DOUBLE3, front),
    COMPLETE(BOOL, ground),
    COMPLETE(BOOL, reframe),
    CHOICE(vlCompleteDef, framing, framings),
    COMPLETE(BOOL, backdrop),
    COMPLETE(BOOL, open_walls),
};
const Rows complete_rows = ROWS(complete_array);

#define CAMERA(TYPE, path) ROW(TYPE, vlCameraDef, path)
static const vlParameter camera_array[] = {
    CHOICE(vlCameraDef, projection, projections),
    CAMERA(COUNT, width),
    CAMERA(COUNT, height),
    CAMERA(DOUBLE, fov),
    CHOICE(vlCameraDef, fov_axis, axes),
    CAMERA(DOUBLE, view_distance),
    CAMERA(DOUBLE, zoom),
    CAMERA(DOUBLE, pixel_size),
    CAMERA(DOUBLE, focal_mm),
    CAMERA(DOUBLE, sensor_width_mm),
    CAMERA(DOUBLE, fx),
    CAMERA(DOUBLE, fy),
    CAMERA(DOUBLE, skew),
    CAMERA(DOUBLE, cx),
    CAMERA(DOUBLE, cy),
    CAMERA(DOUBLE, screen_min_x),
    CAMERA(DOUBLE, screen_max_x),
    CAMERA(DOUBLE, screen_min_y),
    CAMERA(DOUBLE, screen_max_y),
    CAMERA(DOUBLE3, eye),
    CAMERA(DOUBLE3, lookat),
    CAMERA(DOUBLE3, up),
    CAMERA(DOUBLE, roll),
    CAMERA(DOUBLE, lens_radius),
    CAMERA(DOUBLE, focus_distance),
    CAMERA(DOUBLE, lens.f_number),
    CAMERA(DOUBLE, lens.unit_mm),
    CAMERA(DOUBLE3, lens.focus_point),
    CAMERA(COUNT, lens.blades),
    CAMERA(DOUBLE, lens.rotation),
    CAMERA(DOUBLE, lens.ratio),
    CAMERA(DOUBLE, lens.tilt_x),
    CAMERA(DOUBLE, lens.tilt_y),
    CAMERA(DOUBLE, lens.lens_tilt_x),
    CAMERA(DOUBLE, lens.lens_tilt_y),
    CAMERA(BOOL, lens.vignetting),
    CAMERA(DOUBLE, shutter_open),
    CAMERA(DOUBLE, shutter_close),
    CAMERA(DOUBLE, readout),
    CHOICE(vlCameraDef, readout_direction, readouts),
    CAMERA(DOUBLE3, eye_close),
    CAMERA(DOUBLE3, lookat_close),
    CAMERA(DOUBLE3, up_close),
    CAMERA(DOUBLE, roll_close),
    CAMERA(DOUBLE, exposure_time),
    CAMERA(DOUBLE, near_plane),
    CAMERA(DOUBLE, far_plane),
    CAMERA(DOUBLE, max_angle),
    CHOICE(vlCameraDef, distortion, distortions),
    ROW(CHOICE, vlCameraDef, stereo.mode, .name = "stereo_mode", .choices = stereo_modes),
    CAMERA(DOUBLE, stereo.interocular),
    CAMERA(DOUBLE, stereo.convergence),
    CHOICE(vlCameraDef, stereo_eye, eyes),
};
const Rows camera_rows = ROWS(camera_array);

static const vlParameter channels_array[] = {
    CHOICE(vlChannelsDef, mode, modes),
    ROW(COUNT, vlChannelsDef, ranks),
    ROW(DOUBLE, vlChannelsDef, time),
};
const Rows channels_rows = ROWS(channels_array);

static const vlParameter write_array[] = {
    ROW(BOOL, vlWriteDef, half),
    ROW(COUNT, vlWriteDef, compression),
    ROW(COUNT, vlWriteDef, quality),
};
const Rows write_rows = ROWS(write_array);
