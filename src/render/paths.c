/* render/paths.c: vl_trace_paths: traces the samples of one pixel again, by the code of
 * vl_render, and records them. */
#include "velo/paths.h"

#include <math.h>
#include <string.h>

#include "base/cancel.h"
#include "base/context.h"
#include "base/error.h"
#include "base/free.h"
#include "film/expose.h"
#include "render/block.h"
#include "tracer/record.h"
#include "velo/focus.h"
#include "velo/trace.h"
#include "velo/tracer.h"

enum { MAX_PATHS = 1 << 20 };

/* The state of one call. */
typedef struct Call {
  vlContext *context;
  vlRenderRun run;
  vlRenderWorker worker;
  vlFilm *film, *unlimited; /* of one pixel; the second without max_component */
  vlPathRecorder recorder;
  uint32_t x, y, lanes; /* lanes: number of paths per batch */
  uint32_t pixels; /* the samples are taken in this many pixels: (x, y), and its border if it
                      shares */
  /* the result so far */
  vlPath *paths;
  size_t path_count, path_room;
  vlPathVertex *vertices;
  vlPathContribution *contributions;
  size_t vertex_count, vertex_room, contribution_count, contribution_room;
} Call;

/* ---- memory ------------------------------------------------------------------------------ */

static vlResult make_memory(Call *c, vlError *error) {
  uint32_t depth = c->run.def->max_depth + 1;
  uint32_t skies = (uint32_t)c->run.world->infinite_lights.count;
  c->lanes = 1u << 14;
  c->lanes = c->lanes / depth < 1 ? 1 : c->lanes / depth > 256 ? 256 : c->lanes / depth;
  vlPathRecorder *r = &c->recorder;
  r->max_vertices = 2 * depth;
  r->max_contributions = depth * (4 + skies);
  r->paths = vl_alloc_zero(c->context, c->lanes, sizeof *r->paths);
  r->vertices =
      vl_alloc_array(c->context, (size_t)c->lanes * r->max_vertices, sizeof *r->vertices);
  r->contributions = vl_alloc_array(c->context, (size_t)c->lanes * r->max_contributions,
                                    sizeof *r->contributions);
  c->worker.scratch =
      vl_alloc_zero(c->context, 1, vl_whole_lines(vl_trace_scratch_size(c->run.world)));
  c->worker.rows =
      vl_alloc_zero(c->context, (size_t)VL_RENDER_ROWS * VL_ROW_SIZE, sizeof(float));
  c->worker.recorder = r;
  bool all = r->paths && r->vertices && r->contributions && c->worker.scratch && c->worker.rows;
  if (!all)
    return vl_fail_memory(error);
  vl_trace_scratch_begin(c->worker.scratch, c->run.world);
  return VL_OK;
}

static void free_memory(Call *c) {
  VL_FREE(c->context, c->recorder.paths, c->recorder.vertices, c->recorder.contributions,
          c->worker.scratch, c->worker.rows, c->paths, c->vertices, c->contributions);
  vl_film_destroy(c->film);
  vl_film_destroy(c->unlimited);
}

/* Makes room for `more` items of a list. */
static void *grow(vlContext *context, void *items, size_t size, size_t count, size_t *room,
                  size_t more) {
  if (count + more <= *room)
    return items;
  size_t next = *room ? *room : 64;
  while (next < count + more)
    next *= 2;
  void *larger = vl_realloc_array(context, items, next, size);
  if (larger)
    *room = next;
  return larger;
}

/* ---- one batch --------------------------------------------------------------------------- */

static const float *row(const Call *c, int r) {
  return c->worker.rows + (size_t)r * VL_ROW_SIZE;
}

/* Lists n samples, after `done` others. */
static void list_samples(const Call *c, uint32_t first, uint32_t done, uint32_t n) {
  vlFilmRayRows rows = vl_film_ray_rows(c->worker.rows);
  const uint32_t *border = c->run.reconstruction.border;
  uint32_t width = 2 * border[0] + 1;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t k = done + i, pixel = k % c->pixels, own = c->pixels / 2;
    pixel = pixel == 0     ? own
            : pixel <= own ? pixel - 1
                           : pixel; /* the pixel's own sample comes first */
    rows.px[i] = (int32_t)(c->x + pixel % width) - (int32_t)border[0];
    rows.py[i] = (int32_t)(c->y + pixel / width) - (int32_t)border[1];
    rows.index[i] = first + k / c->pixels;
  }
}

/* The weight of sample i of the batch in the pixel. */
static float weight_of(const Call *c, uint32_t i) {
  vlFilmRayRows rows = vl_film_ray_rows(c->worker.rows);
  if (!c->run.shares)
    return rows.weight[i];
  return vl_shared_weight(&c->run.reconstruction, rows.film_x[i], rows.film_y[i],
                          (int32_t)c->x - rows.px[i], (int32_t)c->y - rows.py[i]);
}

/* Fills what the recorder does not know: the camera ray, the wavelengths, the sample. */
static void fill_path(const Call *c, uint32_t i, vlPath *path) {
  const vlRenderRun *r = &c->run;
  vlFilmRayRows rows = vl_film_ray_rows(c->worker.rows);
  const vlCameraRays *ray = &rows.rays;
  path->sample = rows.index[i];
  path->x = rows.px[i];
  path->y = rows.py[i];
  path->film[0] = (float)path->x + rows.film_x[i];
  path->film[1] = (float)path->y + rows.film_y[i];
  path->origin[0] = ray->ox[i];
  path->origin[1] = ray->oy[i];
  path->origin[2] = ray->oz[i];
  path->direction[0] = ray->dx[i];
  path->direction[1] = ray->dy[i];
  path->direction[2] = ray->dz[i];
  path->time = ray->time[i];
  path->filter_weight = weight_of(c, i);
  path->camera_weight = vl_camera_weighted(&r->film_rays.camera) ? ray->weight[i] : 1.0f;
  bool valid = r->film_rays.camera.plain || ray->valid[i] > 0.0f;
  bool removed = r->def->transparent && !(row(c, VL_ROW_RADIANCE + 4)[i] > 0.0f);
  if (!valid || removed)
    path->camera_weight = 0.0f;
  if (!valid)
    path->vertex_count = path->contribution_count = 0;
  for (int k = 0; k < 4; k++) {
    path->lambda[k] = r->rgb_mode ? 0.0f : row(c, VL_ROW_LAMBDA + k)[i];
    path->inv_pdf[k] = r->rgb_mode ? 1.0f : row(c, VL_ROW_INV_PDF + k)[i];
    path->radiance[k] = row(c, VL_ROW_RADIANCE + k)[i];
  }
  for (int k = 0; k < 3; k++)
    path->rgb[k] = row(c, VL_ROW_RED + k)[i];
}

/* The colours of a path's contributions, without the film's limit. */
static void expose(const Call *c, const vlPath *path, vlPathContribution *list) {
  enum { BLOCK = 16 };
  for (uint32_t first = 0; first < path->contribution_count; first += BLOCK) {
    uint32_t n = path->contribution_count - first;
    if (n > BLOCK)
      n = BLOCK;
    VL_ROW float in[12][BLOCK], out[3][BLOCK];
    memset(in, 0, sizeof in);
    vlExposure e = {.n = n, .exposure = c->run.exposure_time};
    for (uint32_t k = 0; k < 4; k++) {
      e.radiance[k] = in[k];
      e.lambda[k] = c->run.rgb_mode ? NULL : in[4 + k];
      e.inv_pdf[k] = c->run.rgb_mode ? NULL : in[8 + k];
      for (uint32_t i = 0; i < BLOCK; i++) {
        if (i < n)
          in[k][i] = list[first + i].radiance[k] * path->camera_weight;
        in[4 + k][i] = path->lambda[k];
        in[8 + k][i] = path->inv_pdf[k];
      }
    }
    vl_film_expose(c->unlimited, c->run.trace.isa, &e, out[0], out[1], out[2]);
    for (uint32_t i = 0; i < n; i++)
      for (int k = 0; k < 3; k++)
        list[first + i].rgb[k] = out[k][i];
  }
}

/* Appends those of the n recorded paths that count in the pixel. Pointers into growing lists
 * are set at the end. */
static vlResult keep(Call *c, uint32_t n, vlError *error) {
  vlPathRecorder *r = &c->recorder;
  vlPath *room = grow(c->context, c->paths, sizeof *room, c->path_count, &c->path_room, n);
  if (!room)
    return vl_fail_memory(error);
  c->paths = room;
  for (uint32_t i = 0; i < n; i++) {
    if (c->run.shares && !(weight_of(c, i) > 0.0f))
      continue;
    vlPath *path = &c->paths[c->path_count];
    vlPathContribution *lights = r->contributions + (size_t)i * r->max_contributions;
    *path = r->paths[i];
    fill_path(c, i, path);
    expose(c, path, lights);
    vlPathVertex *vertices = grow(c->context, c->vertices, sizeof *vertices, c->vertex_count,
                                  &c->vertex_room, path->vertex_count + 1);
    if (vertices)
      c->vertices = vertices;
    vlPathContribution *all =
        grow(c->context, c->contributions, sizeof *all, c->contribution_count,
             &c->contribution_room, path->contribution_count + 1);
    if (all)
      c->contributions = all;
    if (!vertices || !all)
      return vl_fail_memory(error);
    memcpy(vertices + c->vertex_count, r->vertices + (size_t)i * r->max_vertices,
           path->vertex_count * sizeof *vertices);
    memcpy(all + c->contribution_count, lights, path->contribution_count * sizeof *all);
    c->vertex_count += path->vertex_count;
    c->contribution_count += path->contribution_count;
    c->path_count++;
  }
  return VL_OK;
}

static vlResult trace_all(Call *c, uint32_t first, uint32_t count, vlError *error) {
  vlResult result = VL_OK;
  uint32_t total = count * c->pixels;
  for (uint32_t done = 0; done < total && result == VL_OK;) {
    uint32_t n = total - done < c->lanes ? total - done : c->lanes;
    if (vl_is_cancelled(c->run.def->cancel))
      return vl_fail(error, VL_CANCELLED, "stopped");
    memset(c->recorder.paths, 0, c->lanes * sizeof *c->recorder.paths);
    list_samples(c, first, done, n);
    unsigned state = vl_accel_enter();
    vl_render_batch(&c->run, &c->worker, n);
    vl_accel_leave(state);
    if (c->recorder.lost)
      return vl_fail_argument(error, "paths: a path has more vertices than expected");
    result = keep(c, n, error);
    done += n;
  }
  return result;
}

/* ---- the result -------------------------------------------------------------------------- */

static bool is_finite(const vlPath *path) {
  const float max = 0x1p40f; /* as in film.h */
  for (int k = 0; k < 3; k++)
    if (!(fabsf(path->rgb[k]) <= max))
      return false;
  return true;
}

static void average(vlPixelPaths *all) {
  double sum[3] = {0, 0, 0}, weight = 0;
  for (uint32_t i = 0; i < all->count; i++) {
    const vlPath *path = &all->paths[i];
    if (!is_finite(path)) {
      all->dropped++;
      continue;
    }
    double w = (double)path->filter_weight;
    for (int k = 0; k < 3; k++)
      sum[k] += w * (double)path->rgb[k];
    weight += w;
  }
  for (int k = 0; k < 3 && weight != 0; k++)
    all->mean[k] = sum[k] / weight;
}

/* The result is one block of memory: the context, the head, paths, vertices, contributions. */
typedef struct Block {
  vlContext *context;
  vlPixelPaths head;
} Block;

static vlResult pack(const Call *c, uint32_t samples, vlPixelPaths **result, vlError *error) {
  uint32_t count = (uint32_t)c->path_count;
  size_t head = vl_whole_lines(sizeof(Block)), paths = vl_whole_lines(count * sizeof(vlPath));
  size_t vertices = vl_whole_lines(c->vertex_count * sizeof(vlPathVertex));
  size_t bytes = head + paths + vertices + c->contribution_count * sizeof(vlPathContribution);
  char *memory = vl_alloc(c->context, bytes);
  if (!memory)
    return vl_fail_memory(error);
  Block *block = (Block *)(void *)memory;
  vlPath *p = (vlPath *)(void *)(memory + head);
  vlPathVertex *v = (vlPathVertex *)(void *)(memory + head + paths);
  vlPathContribution *l = (vlPathContribution *)(void *)(memory + head + paths + vertices);
  if (count)
    memcpy(p, c->paths, count * sizeof *p);
  if (c->vertex_count)
    memcpy(v, c->vertices, c->vertex_count * sizeof *v);
  if (c->contribution_count)
    memcpy(l, c->contributions, c->contribution_count * sizeof *l);
  for (uint32_t i = 0; i < count; i++) {
    p[i].vertices = v;
    p[i].contributions = l;
    v += p[i].vertex_count;
    l += p[i].contribution_count;
  }
  *block = (Block){.context = c->context,
                   .head = {.x = c->x,
                            .y = c->y,
                            .tracer = c->run.trace.tracer,
                            .samples = samples,
                            .count = count,
                            .paths = p}};
  average(&block->head);
  *result = &block->head;
  return VL_OK;
}

void vl_pixel_paths_destroy(vlPixelPaths *paths) {
  if (!paths)
    return;
  Block *block = (Block *)(void *)((char *)paths - offsetof(Block, head));
  vl_free(block->context, block);
}

/* ---- the call ---------------------------------------------------------------------------- */

static vlResult check(const vlFilmDef *film, const vlRenderDef *def, uint32_t x, uint32_t y,
                      uint32_t count, vlError *error) {
  if (def->own_tracer)
    return vl_fail_argument(error, "paths: those of the own tracer \"%s\" are not recorded",
                            vl_short_text(def->own_tracer->name).text);
  if (def->tracer != VL_TRACER_PATH && def->tracer != VL_TRACER_VOLPATH)
    return vl_fail_argument(error, "paths: only the tracers path and volpath are recorded");
  if (x < film->crop[0] || y < film->crop[1] || x >= film->crop[2] || y >= film->crop[3])
    return vl_fail_argument(error,
                            "paths: pixel (%u, %u) is outside the image's %u,%u to %u,%u", x, y,
                            film->crop[0], film->crop[1], film->crop[2] - 1, film->crop[3] - 1);
  if (count == 0 || count > MAX_PATHS)
    return vl_fail_argument(error, "paths: %u paths; 1 to %u are possible", count,
                            (unsigned)MAX_PATHS);
  return VL_OK;
}

static vlResult make_films(Call *c, const vlFilmDef *film, vlError *error) {
  vlFilmDef pixel = *film;
  pixel.errors = false;
  pixel.crop[0] = c->x;
  pixel.crop[1] = c->y;
  pixel.crop[2] = c->x + 1;
  pixel.crop[3] = c->y + 1;
  vlResult result = vl_film_create(c->context, &pixel, &c->film);
  pixel.max_component = INFINITY;
  if (result == VL_OK)
    result = vl_film_create(c->context, &pixel, &c->unlimited);
  return result == VL_OK ? VL_OK : vl_fail(error, result, "paths: the film's def is not valid");
}

vlResult vl_trace_paths(const vlWorld *world, const vlCamera *camera, const vlFilmDef *film,
                        const vlRenderDef *def, uint32_t x, uint32_t y, uint32_t first,
                        uint32_t count, vlPixelPaths **paths, vlError *error) {
  vl_error_clear(error);
  if (paths)
    *paths = NULL;
  if (!world || !camera || !film || !paths)
    return vl_fail_argument(error, "paths: an argument is null");
  vlRenderDef own = def ? *def : vl_default_render_def();
  own.first_sample = 0;
  own.noise = 0;
  own.time_limit = 0;
  own.progress = NULL;
  VL_TRY(check(film, &own, x, y, count, error));
  Call c;
  memset(&c, 0, sizeof c);
  c.context = world->context;
  c.x = x;
  c.y = y;
  c.run.world = world;
  c.run.def = &own;
  vlCamera focused = *camera;
  vlResult result = make_films(&c, film, error);
  if (result == VL_OK)
    result = vl_render_check(world, camera, c.film, &own, error);
  if (result == VL_OK)
    result = vl_camera_autofocus(world, &focused, error);
  if (result == VL_OK) {
    c.run.film = c.film;
    c.run.sequence.length =
        own.sequence ? own.sequence : vl_sampler_sequence(own.sampler, own.spp);
    vl_render_prepare(&c.run, &focused);
    c.run.workers = &c.worker;
    result = make_memory(&c, error);
    c.pixels = 1;
  }
  if (result == VL_OK && c.run.shares) {
    c.run.reconstruction = vl_reconstruction_of(vl_film_filter(c.film));
    const uint32_t *border = c.run.reconstruction.border;
    c.pixels = (2 * border[0] + 1) * (2 * border[1] + 1);
  }
  if (result == VL_OK)
    result = trace_all(&c, first, count, error);
  if (result == VL_OK)
    result = pack(&c, count, paths, error);
  free_memory(&c);
  return result;
}
