/* _velo/rows.c: rows of the defs that velo/schema.h has none for. Their names are the members' names; their ranges are
 * those of the program's options. */
#include <math.h>
#include <stddef.h>

#include "module.h"

#define ROW(TYPE, Def, path, ...) \
  { .type = VL_PARAMETER_##TYPE, .member = #path, .offset = offsetof(Def, path), __VA_ARGS__ }
#define CHOICE(Def, path, list) ROW(CHOICE, Def, path, .choices = list)
#define ROWS(array) \
  { array, sizeof(array) / sizeof *(array) }
#define FROM(least) .low = (least), .high = INFINITY
#define WITHIN(least, most) .low = (least), .high = (most)
#define ABOVE .flags = VL_PARAMETER_ABOVE_LOW
#define UNSET .flags = VL_PARAMETER_UNSET
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
static const char *const accelerators[] = {"auto", "embree", "bvh", NULL};
static const char *const environments[] = {"auto", "none", "studio", "sky", "white", "file", NULL};
static const char *const framings[] = {"auto", "corner", "front", NULL};
static const char *const modes[] = {"centre", "nearest", "coverage", NULL};
static const char *const distortions[] = {"none", "opencv", "radial", "thin_prism", NULL};
static const char *const axes[] = {"vertical", "horizontal", "diagonal", "smaller", "larger", NULL};
static const char *const stereo_modes[] = {"none", "parallel", "off_axis", "toe_in", "omnidirectional", NULL};
static const char *const eyes[] = {"both", "left", "right", NULL};
static const char *const readouts[] = {"down", "up", "right", "left", NULL};

enum { MOST_SAMPLES = 1 << 24 };

#define SCENE(TYPE, ...) ROW(TYPE, vlSceneDefs, __VA_ARGS__)
static const vlParameter scene_array[] = {
    CHOICE(vlSceneDefs, render.tracer, tracers),
    CHOICE(vlSceneDefs, render.sampler, samplers),
    SCENE(COUNT, render.spp, WITHIN(1, MOST_SAMPLES)),
    SCENE(COUNT, render.seed),
    SCENE(COUNT, render.sequence, WITHIN(0, MOST_SAMPLES)),
    SCENE(COUNT, render.first_sample, WITHIN(0, MOST_SAMPLES)),
    SCENE(COUNT, render.max_depth, WITHIN(0, 4096)),
    SCENE(FLOAT, render.ao_distance, FROM(0), .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_INFINITE),
    SCENE(BOOL, render.ao_cosine),
    SCENE(BOOL, render.centred),
    SCENE(BOOL, render.same_wavelengths),
    SCENE(BOOL, render.sharp_textures),
    SCENE(BOOL, render.share_samples),
    SCENE(BOOL, render.transparent),
    SCENE(DOUBLE, render.merge_radius, WITHIN(1e-30, 1e30), UNSET),
    SCENE(COUNT, render.light_paths),
    SCENE(DOUBLE, render.time_limit, FROM(0)),
    SCENE(DOUBLE, render.noise, WITHIN(0, 0.5)),
    CHOICE(vlSceneDefs, render.noise_view, views),
    SCENE(FLOAT, render.noise_exposure, WITHIN(-100, 100)),
    SCENE(FLOAT, render.noise_scale, FROM(0), ABOVE),
    SCENE(COUNT, render.priority, WITHIN(0, 1000000)),
    ROW(CHOICE, vlSceneDefs, film.filter.kind, .name = "filter", .choices = filters),
    ROW(FLOAT, vlSceneDefs, film.filter.radius_x, .name = "filter_radius_x", WITHIN(0, 64), ABOVE),
    ROW(FLOAT, vlSceneDefs, film.filter.radius_y, .name = "filter_radius_y", WITHIN(0, 64), ABOVE),
    ROW(FLOAT, vlSceneDefs, film.filter.sigma, .name = "filter_sigma", WITHIN(0, 1e6), ABOVE),
    ROW(FLOAT, vlSceneDefs, film.filter.b, .name = "filter_b", WITHIN(-10, 10)),
    ROW(FLOAT, vlSceneDefs, film.filter.c, .name = "filter_c", WITHIN(-10, 10)),
    ROW(FLOAT, vlSceneDefs, film.filter.tau, .name = "filter_tau", WITHIN(0, 1e6), ABOVE),
    CHOICE(vlSceneDefs, film.space, spaces),
    SCENE(DOUBLE, film.white_balance, WITHIN(0, 100000)),
    SCENE(STRING, film.sensor),
    SCENE(FLOAT, film.max_component, FROM(0), .flags = VL_PARAMETER_INFINITE),
    SCENE(BOOL, film.errors),
    SCENE(COUNT, film.buckets, WITHIN(0, 1000)),
    SCENE(DOUBLE, film.lambda_min, WITHIN(360, 830)),
    SCENE(DOUBLE, film.lambda_max, WITHIN(360, 830)),
    CHOICE(vlSceneDefs, build.color, colors),
    CHOICE(vlSceneDefs, build.light_sampler, light_samplers),
    SCENE(BOOL, build.imitate_pbrt),
    SCENE(BOOL, build.regularize),
    CHOICE(vlSceneDefs, build.bits, bits),
    CHOICE(vlSceneDefs, build.accelerator, accelerators),
    SCENE(FLOAT, develop.exposure),
};
const Rows scene_rows = ROWS(scene_array);

#define LOAD(TYPE, ...) ROW(TYPE, vlLoadDef, __VA_ARGS__)
static const vlParameter load_array[] = {
    LOAD(BOOL, permissive),
    LOAD(BOOL, strict),
    LOAD(STRING, search_path),
    LOAD(DOUBLE, time, WITHIN(-1e6, 1e6), UNSET),
    LOAD(DOUBLE, time_close, WITHIN(-1e6, 1e6), UNSET),
    LOAD(STRING, scene),
    LOAD(STRING, animation),
    LOAD(STRING, variant),
    LOAD(STRING, camera),
};
const Rows load_rows = ROWS(load_array);

#define COMPLETE(TYPE, ...) ROW(TYPE, vlCompleteDef, __VA_ARGS__)
static const vlParameter complete_array[] = {
    COMPLETE(COUNT, width, WITHIN(0, 65536)),
    COMPLETE(COUNT, height, WITHIN(0, 65536)),
    CHOICE(vlCompleteDef, environment, environments),
    COMPLETE(FILE, path),
    COMPLETE(DOUBLE, rotation, WITHIN(-1e6, 1e6)),
    COMPLETE(FLOAT, strength, WITHIN(0, 1e6)),
    COMPLETE(DOUBLE3, up),
    COMPLETE(DOUBLE3, front),
    COMPLETE(BOOL, ground),
    COMPLETE(BOOL, reframe),
    CHOICE(vlCompleteDef, framing, framings),
    COMPLETE(BOOL, backdrop),
    COMPLETE(BOOL, open_walls),
};
const Rows complete_rows = ROWS(complete_array);

#define CAMERA(TYPE, ...) ROW(TYPE, vlCameraDef, __VA_ARGS__)
static const vlParameter camera_array[] = {
    CHOICE(vlCameraDef, projection, projections),
    CAMERA(COUNT, width, WITHIN(1, MOST_PIXELS)),
    CAMERA(COUNT, height, WITHIN(1, MOST_PIXELS)),
    CAMERA(DOUBLE, fov, UNSET),
    CHOICE(vlCameraDef, fov_axis, axes),
    CAMERA(DOUBLE, view_distance, UNSET),
    CAMERA(DOUBLE, zoom, UNSET),
    CAMERA(DOUBLE, pixel_size, UNSET),
    CAMERA(DOUBLE, focal_mm, UNSET),
    CAMERA(DOUBLE, sensor_width_mm, UNSET),
    CAMERA(DOUBLE, fx, UNSET),
    CAMERA(DOUBLE, fy, UNSET),
    CAMERA(DOUBLE, skew, UNSET),
    CAMERA(DOUBLE, cx, UNSET),
    CAMERA(DOUBLE, cy, UNSET),
    CAMERA(DOUBLE, screen_min_x, UNSET),
    CAMERA(DOUBLE, screen_max_x, UNSET),
    CAMERA(DOUBLE, screen_min_y, UNSET),
    CAMERA(DOUBLE, screen_max_y, UNSET),
    CAMERA(DOUBLE3, eye),
    CAMERA(DOUBLE3, lookat),
    CAMERA(DOUBLE3, up),
    CAMERA(DOUBLE, roll),
    CAMERA(DOUBLE, lens_radius),
    CAMERA(DOUBLE, focus_distance, .flags = VL_PARAMETER_UNSET | VL_PARAMETER_INFINITE),
    CAMERA(DOUBLE, lens.f_number, UNSET),
    CAMERA(DOUBLE, lens.unit_mm),
    CAMERA(DOUBLE3, lens.focus_point),
    CAMERA(COUNT, lens.blades, WITHIN(0, 1000)),
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
    CAMERA(DOUBLE, roll_close, UNSET),
    CAMERA(DOUBLE, exposure_time),
    CAMERA(DOUBLE, near_plane),
    CAMERA(DOUBLE, far_plane, .flags = VL_PARAMETER_INFINITE),
    CAMERA(DOUBLE, max_angle, UNSET),
    CHOICE(vlCameraDef, distortion, distortions),
    ROW(CHOICE, vlCameraDef, stereo.mode, .name = "stereo_mode", .choices = stereo_modes),
    CAMERA(DOUBLE, stereo.interocular),
    CAMERA(DOUBLE, stereo.convergence, UNSET),
    CHOICE(vlCameraDef, stereo_eye, eyes),
};
const Rows camera_rows = ROWS(camera_array);

static const vlParameter channels_array[] = {
    CHOICE(vlChannelsDef, mode, modes),
    ROW(COUNT, vlChannelsDef, ranks, WITHIN(2, 32)),
    ROW(DOUBLE, vlChannelsDef, time, UNSET),
};
const Rows channels_rows = ROWS(channels_array);

static const vlParameter write_array[] = {
    ROW(BOOL, vlWriteDef, half),
    ROW(COUNT, vlWriteDef, compression, WITHIN(0, 1)),
    ROW(COUNT, vlWriteDef, quality, WITHIN(1, 100)),
};
const Rows write_rows = ROWS(write_array);
