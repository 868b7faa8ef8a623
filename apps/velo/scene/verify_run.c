/* scene/verify_run.c: renders the scene and its moved copies by each run's tracer, and takes
 * the means of the cells. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/vector.h"
#include "image/image.h"
#include "render/progress.h"
#include "scene/verify.h"
#include "velo/channels.h"
#include "velo/edit.h"
#include "velo/filter_kinds.h"
#include "velo/tracer.h"

enum { BLOCK = 8, MIN_PIXELS = 8, MAX_SPP = 4096, MIN_MET = 100 };

/* ---- poses ------------------------------------------------------------------------------- */

/* p' = scale * turn(p) + shift. turn: about the axis (1, 2, 3), by `angle`. */
static void make_similarity(double scale, double angle, const double shift[3], double m[16]) {
  const double n = sqrt(14.0), axis[3] = {1 / n, 2 / n, 3 / n}, c = cos(angle), s = sin(angle);
  memset(m, 0, 16 * sizeof *m);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const double cross = (j - i + 3) % 3 == 1   ? -axis[(i + 2) % 3]
                           : (j - i + 3) % 3 == 2 ? axis[(i + 1) % 3]
                                                  : 0;
      m[4 * i + j] = scale * ((1 - c) * axis[i] * axis[j] + (i == j ? c : 0) + s * cross);
    }
    m[4 * i + 3] = shift[i];
  }
  m[15] = 1;
}

static void invert_similarity(const double m[16], double inverse[16]) {
  double square = 0;
  for (int k = 0; k < 3; k++)
    square += m[4 * k] * m[4 * k];
  memset(inverse, 0, 16 * sizeof *inverse);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      inverse[4 * i + j] = m[4 * j + i] / square;
      inverse[4 * i + 3] -= inverse[4 * i + j] * m[4 * j + 3];
    }
  inverse[15] = 1;
}

/* centre, distance: of what the camera sees. A scene at the origin is moved away from it,
 * another one to it. The scale is small: an offset that does not follow it would be seen. */
static void choose_poses(Verify *v, const double centre[3], double distance) {
  const double none[3] = {0, 0, 0}, way[3] = {0.66, 0.53, -0.53};
  const bool near = hypot(centre[0], hypot(centre[1], centre[2])) < 3 * distance;
  double shift[3];
  for (int i = 0; i < 3; i++)
    shift[i] = near ? 5 * distance * way[i] : -centre[i];
  make_similarity(1, 0, none, v->matrix[VERIFY_AS_IT_IS]);
  make_similarity(1, 0, shift, v->matrix[VERIFY_SHIFTED]);
  make_similarity(1, 1, none, v->matrix[VERIFY_TURNED]);
  make_similarity(0.02, 0, none, v->matrix[VERIFY_SCALED]);
  matrix_multiply(v->matrix[VERIFY_SHIFTED], v->matrix[VERIFY_TURNED], v->matrix[VERIFY_MOVED]);
  matrix_multiply(v->matrix[VERIFY_SCALED], v->matrix[VERIFY_MOVED], v->matrix[VERIFY_MOVED]);
}

static vlResult move_scene(Verify *v, VerifyPose pose, vlError *error) {
  double back[16], change[16];
  if (pose == v->pose)
    return VL_OK;
  invert_similarity(v->matrix[v->pose], back);
  matrix_multiply(v->matrix[pose], back, change);
  v->pose = pose;
  return vl_scene_transform(v->in.scene, change, error);
}

static vlResult move_camera(const Verify *v, VerifyPose pose, vlCamera *camera,
                            vlError *error) {
  double open[16], close[16];
  *camera = v->camera;
  if (pose == VERIFY_AS_IT_IS)
    return VL_OK;
  matrix_multiply(v->matrix[pose], v->camera.world_from_camera, open);
  if (!v->camera.moves)
    return vl_camera_move(&v->camera, open, camera, error);
  matrix_multiply(v->matrix[pose], v->camera.world_from_camera_close, close);
  return vl_camera_travel(&v->camera, open, close, v->camera.pose_times, camera, error);
}

/* ---- lights ------------------------------------------------------------------------------ */

static vlResult choose_lights(Verify *v, VerifyLights lights, vlError *error) {
  vlResult result = VL_OK;
  if (lights == v->lights)
    return VL_OK;
  v->lights = lights;
  for (uint32_t i = 1; result == VL_OK && i <= v->light_count; i++) {
    const vlLightDef *light = vl_scene_light(v->in.scene, (vlLightId){i});
    result = vl_scene_show_light(v->in.scene, (vlLightId){i}, verify_has_light(lights, light),
                                 error);
  }
  for (uint32_t i = 0; result == VL_OK && i < v->shapes; i++) {
    const vlEmissionId own = v->emissions[i], none = {0};
    if (!own.index)
      continue;
    result = vl_scene_set_shape_emission(v->in.scene, (vlShapeId){i + 1},
                                         verify_has_surfaces(lights) ? own : none, error);
  }
  return result;
}

/* ---- worlds ------------------------------------------------------------------------------ */

typedef struct Set {
  vlWorld *world;
  vlCamera camera;
  VerifyPose pose;
  VerifyLights lights;
  bool evenly;
} Set;

/* Builds the world of a run, if *set is of another pose or of other lights. */
static vlResult build_set(Verify *v, const VerifyRun *run, Set *set, vlError *error) {
  const bool same =
      run->pose == set->pose && run->lights == set->lights && run->evenly == set->evenly;
  if (set->world && same)
    return VL_OK;
  vlBuildDef build = v->in.job.defs->build;
  if (run->evenly)
    build.light_sampler = VL_LIGHT_SAMPLER_UNIFORM;
  build.regularize = false; /* it changes the materials, and not all tracers know it */
  vl_world_destroy(set->world);
  *set = (Set){.pose = run->pose, .lights = run->lights, .evenly = run->evenly};
  TRY_RESULT(move_scene(v, run->pose, error));
  TRY_RESULT(choose_lights(v, run->lights, error));
  TRY_RESULT(move_camera(v, run->pose, &set->camera, error));
  return vl_world_build(v->in.scene, &build, &set->world, error);
}

/* ---- cells ------------------------------------------------------------------------------- */

static void make_blocks(Verify *v) {
  for (uint32_t y = 0; y < v->height; y++)
    for (uint32_t x = 0; x < v->width; x++) {
      const uint32_t column = x * v->columns / v->width, row = y * v->rows / v->height;
      const uint32_t cell = 1 + column + v->columns * row;
      v->cells[cell].pixels++;
      v->block_of[x + v->width * y] = cell;
    }
}

/* The materials with the most pixels get a cell each. */
static void make_materials(Verify *v, const vlImage *ids, uint32_t *pixels_of,
                           uint32_t materials) {
  const size_t pixels = (size_t)v->width * v->height, step = vl_image_channels(ids);
  const uint32_t *id = vl_image_const_pixels(ids);
  for (size_t i = 0; i < pixels; i++)
    pixels_of[id[i * step]]++;
  for (uint32_t k = 0; k < VERIFY_MAX_MATERIALS; k++) {
    uint32_t largest = 0;
    for (uint32_t m = 0; m <= materials; m++)
      if (pixels_of[m] > pixels_of[largest])
        largest = m;
    if (pixels_of[largest] < MIN_PIXELS)
      break;
    const uint32_t cell = v->cell_count++;
    v->cells[cell] =
        (VerifyCell){.family = VERIFY_MATERIAL, .pixels = pixels_of[largest], .index = largest};
    pixels_of[largest] = 0;
    for (size_t i = 0; i < pixels; i++)
      if (id[i * step] == largest)
        v->material_of[i] = cell;
  }
}

static vlResult make_cells(Verify *v, const vlWorld *world, const vlImage *ids) {
  const size_t pixels = (size_t)v->width * v->height;
  const uint32_t blocks = v->columns * v->rows,
                 materials = vl_world_id_count(world, VL_ID_MATERIAL);
  uint32_t *pixels_of = calloc((size_t)materials + 1, sizeof *pixels_of);
  v->cells = calloc((size_t)1 + blocks + VERIFY_MAX_MATERIALS, sizeof *v->cells);
  v->block_of = calloc(pixels, sizeof *v->block_of);
  v->material_of = calloc(pixels, sizeof *v->material_of);
  if (pixels_of && v->cells && v->block_of && v->material_of) {
    v->cells[0] = (VerifyCell){.family = VERIFY_IMAGE, .pixels = (uint32_t)pixels};
    for (uint32_t i = 0; i < blocks; i++)
      v->cells[1 + i] = (VerifyCell){.family = VERIFY_BLOCK, .index = i};
    v->cell_count = 1 + blocks;
    make_blocks(v);
    make_materials(v, ids, pixels_of, materials);
  }
  free(pixels_of);
  return v->cell_count ? VL_OK : VL_ERROR_MEMORY;
}

/* The mean point that the camera sees, and the mean distance to it. */
static void find_centre(const vlImage *floats, const vlCamera *camera, double centre[3],
                        double *distance) {
  const size_t pixels = image_pixel_count(floats), step = vl_image_channels(floats);
  const float *value = vl_image_const_pixels(floats);
  double seen = 0, sum[4] = {0, 0, 0, 0};
  for (size_t i = 0; i < pixels; i++) {
    const float *at = value + i * step; /* distance, then the position */
    if (!isfinite(at[0]))
      continue;
    /* a few far points do not count much */
    const double weight = 1 / fmax(1e-30, (double)at[0]);
    seen += weight;
    sum[0] += weight * (double)at[0];
    for (int k = 0; k < 3; k++)
      sum[1 + k] += weight * (double)at[1 + k];
  }
  *distance = seen > 0 ? sum[0] / seen : 1;
  for (int k = 0; k < 3; k++)
    centre[k] = seen > 0 ? sum[1 + k] / seen : camera->world_from_camera[4 * k + 3];
}

/* Light paths from far away start on a disk as large as the world. A surface of the size of
 * pixel i, at the distance t_i, is met by a share p_i = t_i^2 / (fx fy) / (pi r^2) of them. The
 * image of n light paths, P pixels of equal radiance, has the relative variance (1/P^2) sum
 * 1/(n p_i): that of n P^2 / sum 1/p_i independent paths. */
static double share_of_light_paths(const vlImage *floats, const vlCamera *camera,
                                   const vlWorld *world) {
  const size_t pixels = image_pixel_count(floats), step = vl_image_channels(floats);
  const float *value = vl_image_const_pixels(floats);
  double seen = 0, sum = 0, square = 0;
  vlWorldInfo info;
  vl_world_info(world, &info);
  for (int k = 0; k < 3; k++)
    square += 0.25 * pow((double)info.bounds_max[k] - (double)info.bounds_min[k], 2);
  for (size_t i = 0; i < pixels; i++) {
    const double t = (double)value[i * step];
    if (!isfinite(t) || !(t > 0))
      continue;
    seen++;
    sum += camera->fx * camera->fy * 3.14159265358979 * square / (t * t);
  }
  return sum > 0 ? seen * seen / sum : 1;
}

vlResult verify_prepare(Verify *v, vlError *error) {
  vlWorld *world = NULL;
  vlImage *floats = NULL, *ids = NULL;
  double centre[3], distance;
  v->columns = (v->width + BLOCK / 2) / BLOCK;
  v->rows = (v->height + BLOCK / 2) / BLOCK;
  v->columns += v->columns == 0;
  v->rows += v->rows == 0;
  vlChannelsDef def = vl_default_channels_def(v->width, v->height);
  def.channels = VL_CHANNEL_DISTANCE | VL_CHANNEL_P | VL_CHANNEL_ID_MATERIAL;
  vlResult result = vl_world_build(v->in.scene, &v->in.job.defs->build, &world, error);
  if (result == VL_OK)
    result = vl_render_channels(world, &v->camera, &def, &floats, &ids, error);
  if (result == VL_OK)
    result = make_cells(v, world, ids);
  if (result == VL_OK) {
    find_centre(floats, &v->camera, centre, &distance);
    choose_poses(v, centre, distance);
    v->meets = share_of_light_paths(floats, &v->camera, world);
  }
  vl_image_destroy(floats);
  vl_image_destroy(ids);
  vl_world_destroy(world);
  return result;
}

/* ---- renders ----------------------------------------------------------------------------- */

/* A box filter and pixels with samples of their own: so that each sample counts in one pixel
 * with the weight 1, and a replicate's mean is unbiased for any number of samples. */
static vlFilmDef film_of(const Verify *v) {
  const vlFilmDef *own = &v->in.job.defs->film;
  vlFilmDef film = vl_default_film_def(v->width, v->height);
  film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  film.space = own->space;
  film.white_balance = own->white_balance;
  film.sensor = own->sensor;
  return film;
}

static vlRenderDef render_of(const Verify *v, const VerifyRun *run, uint32_t spp,
                             uint32_t seed) {
  vlRenderDef def = vl_default_render_def();
  def.tracer = run->tracer;
  def.spp = spp;
  def.seed = seed;
  def.max_depth = v->in.job.defs->render.max_depth;
  def.share_samples = false;
  def.sharp_textures = run->sharp;
  def.progress = progress_until_signal;
  return def;
}

void verify_take_means(const Verify *v, const vlImage *image, double *row) {
  const size_t pixels = (size_t)v->width * v->height, step = vl_image_channels(image);
  const float *value = vl_image_const_pixels(image);
  memset(row, 0, v->cell_count * VERIFY_CHANNELS * sizeof *row);
  for (size_t i = 0; i < pixels; i++) {
    const uint32_t cells[3] = {0, v->block_of[i], v->material_of[i]};
    const int count = v->material_of[i] ? 3 : 2;
    for (int k = 0; k < count; k++)
      for (int c = 0; c < VERIFY_CHANNELS; c++)
        row[VERIFY_CHANNELS * cells[k] + (uint32_t)c] += (double)value[i * step + (size_t)c];
  }
  for (uint32_t k = 0; k < v->cell_count; k++)
    for (int c = 0; c < VERIFY_CHANNELS; c++)
      row[VERIFY_CHANNELS * k + (uint32_t)c] /= v->cells[k].pixels;
}

/* Renders one replicate into a film. row, stats: may be null. */
static vlResult shoot(const Verify *v, const VerifyRun *run, const Set *set, vlFilm *film,
                      uint32_t spp, uint32_t seed, double *row, vlRenderStats *stats,
                      vlError *error) {
  const vlRenderDef def = render_of(v, run, spp, seed);
  vlImage *image = NULL;
  vl_film_clear(film);
  TRY_RESULT(vl_render(set->world, &set->camera, film, &def, stats, error));
  if (!row)
    return VL_OK;
  TRY_RESULT(vl_film_develop(film, NULL, &image));
  verify_take_means(v, image, row);
  vl_image_destroy(image);
  return VL_OK;
}

uint32_t verify_seed(const Verify *v, int look, uint32_t replicate) {
  return v->seed * 4096 + (uint32_t)look * 1024 + replicate;
}

static vlResult render_run(Verify *v, VerifyRun *run, const Set *set, vlFilm *film, int look,
                           vlError *error) {
  const size_t row = (size_t)v->cell_count * VERIFY_CHANNELS;
  for (uint32_t r = 0; r < VERIFY_REPLICATES; r++) {
    vlRenderStats stats;
    TRY_RESULT(shoot(v, run, set, film, run->spp[look], verify_seed(v, look, r),
                     run->values[look] + r * row, &stats, error));
    run->dropped += stats.not_finite;
  }
  return VL_OK;
}

/* Counts the rays of one sample per pixel. */
static vlResult count_rays(Verify *v, VerifyRun *run, const Set *set, vlFilm *film,
                           vlError *error) {
  vlRenderStats stats;
  const vlFilmDef def = film_of(v);
  const char *lack = vl_tracer_lacks(set->world, &set->camera, &def, run->tracer);
  if (lack) {
    run->left_out = true;
    verify_note(v, "%s is not compared: it does not support %s", run->name, lack);
    return VL_OK;
  }
  vlResult result =
      shoot(v, run, set, film, 1, verify_seed(v, VERIFY_TRIAL, 0), NULL, &stats, error);
  run->rays = (double)(stats.camera_rays + stats.bounce_rays + stats.shadow_rays);
  return result;
}

/* ---- all runs ---------------------------------------------------------------------------- */

/* Moved copies have as many rays as the scene in its own pose. */
static bool takes_part(const VerifyRun *run, int look) {
  if (run->left_out)
    return false;
  return look == VERIFY_TRIAL ? run->pose == VERIFY_AS_IT_IS : look == 0 || run->again;
}

static vlResult go(Verify *v, VerifyRun *run, Set *set, vlFilm *film, int look,
                   vlError *error) {
  const size_t size =
      VERIFY_REPLICATES * (size_t)v->cell_count * VERIFY_CHANNELS * sizeof(double);
  if (look != VERIFY_TRIAL && !run->values[look])
    run->values[look] = malloc(size);
  if (look != VERIFY_TRIAL && !run->values[look])
    return VL_ERROR_MEMORY;
  if (run->reference)
    return look == VERIFY_TRIAL ? verify_reference_try(v, run, error)
                                : verify_reference(v, run, look, error);
  TRY_RESULT(build_set(v, run, set, error));
  return look == VERIFY_TRIAL ? count_rays(v, run, set, film, error)
                              : render_run(v, run, set, film, look, error);
}

vlResult verify_render(Verify *v, int look, vlError *error) {
  Set set = {0};
  vlFilm *film = NULL;
  const vlFilmDef def = film_of(v);
  vlResult result = vl_film_create(v->context, &def, &film);
  v->drowned = true;
  for (int i = 0; i < v->run_count && result == VL_OK; i++)
    if (takes_part(&v->runs[i], look))
      result = go(v, &v->runs[i], &set, film, look, error);
  v->drowned = false;
  vl_world_destroy(set.world);
  vl_film_destroy(film);
  return result;
}

/* Each tracer gets the same share of the budget; its runs have the same samples, so that they
 * can be compared by pairs. Powers of two suit the sampler. */
static void share_budget(Verify *v) {
  double shares = 0;
  for (int i = 0; i < v->run_count; i++)
    if (!v->runs[i].left_out)
      shares += v->runs[i].reference ? VERIFY_REFERENCE_SHARES : 1;
  for (int i = 0; i < v->run_count; i++) {
    VerifyRun *run = &v->runs[i];
    double max = 1, spp = 1;
    for (int k = 0; k < v->run_count; k++)
      if (v->runs[k].tracer == run->tracer && v->runs[k].reference == run->reference)
        max = fmax(max, v->runs[k].rays);
    const double own = run->reference ? VERIFY_REFERENCE_SHARES : 1;
    const double share = own * v->budget / (shares * VERIFY_REPLICATES * max);
    while (2 * spp <= share && spp < MAX_SPP)
      spp *= 2;
    run->spp[0] = (uint32_t)spp;
    run->spp[1] = (uint32_t)spp * VERIFY_SECOND;
  }
}

/* Few light paths from far away meet what the camera sees of a large world: their mean has a
 * heavy tail, and many looks would miss most of the light. */
static void leave_out_rare(Verify *v) {
  for (int i = 0; i < v->run_count; i++) {
    VerifyRun *run = &v->runs[i];
    const double paths = (double)v->width * v->height * run->spp[0] * VERIFY_REPLICATES;
    if (run->left_out || run->tracer != VL_TRACER_LIGHT_PATH || !v->far_light ||
        paths * v->meets >= MIN_MET)
      continue;
    run->left_out = true;
    verify_note(
        v,
        "%s is not compared: of its %.3g light paths from far away about %.2g meet what "
        "the camera sees",
        run->name, paths, paths * v->meets);
  }
}

vlResult verify_measure(Verify *v, vlError *error) {
  const vlResult result = verify_render(v, VERIFY_TRIAL, error);
  for (int i = 0; i < v->run_count; i++)
    if (v->runs[i].against >= 0 && v->runs[v->runs[i].against].left_out)
      v->runs[i].left_out = true;
  if (result == VL_OK)
    share_budget(v);
  if (result == VL_OK)
    leave_out_rare(v);
  return result;
}
