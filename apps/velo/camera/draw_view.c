/* camera/draw_view.c: see draw.h: what a camera sees, and the view of it from outside. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "camera/draw.h"
#include "cli/macros.h"
#include "cli/vector.h"
#include "image/image.h"
#include "render/denoised.h"
#include "render/exposure.h"
#include "velo/channels.h"

static const double degree = M_PI / 180.0;

/* ---- what the camera sees ---------------------------------------------------------------- */

/* Collects the points that the pixels show, and the quantiles of their depths. flat: depth is
 * along the axis; else along the ray. */
static vlResult collect(const vlImage *image, bool flat, Seen *seen) {
  uint32_t w = vl_image_width(image), h = vl_image_height(image);
  seen->points = malloc(3 * (size_t)w * h * sizeof *seen->points);
  seen->depths = malloc(2 * (size_t)w * h * sizeof *seen->depths);
  seen->pixels = malloc(2 * (size_t)w * h * sizeof *seen->pixels);
  if (!seen->points || !seen->depths || !seen->pixels)
    return VL_ERROR_MEMORY;
  for (uint32_t y = 0; y < h; y++)
    for (uint32_t x = 0; x < w; x++) { /* the channels are Z, distance, P */
      double depth = (double)vl_image_get(image, x, y, flat ? 0 : 1);
      if (!(depth < 1e30) || !(depth > 0))
        continue;
      uint32_t i = seen->count++;
      for (uint32_t k = 0; k < 3; k++)
        seen->points[3 * i + k] = (double)vl_image_get(image, x, y, 2 + k);
      seen->depths[i] = depth;
      seen->pixels[2 * i] = (x + 0.5) / w;
      seen->pixels[2 * i + 1] = (y + 0.5) / h;
    }
  if (!seen->count)
    return VL_OK;
  double *sorted = seen->depths + seen->count;
  memcpy(sorted, seen->depths, seen->count * sizeof *sorted);
  qsort(sorted, seen->count, sizeof *sorted, by_value);
  seen->near = sorted[seen->count / 20];
  seen->middle = sorted[seen->count / 2];
  seen->far = sorted[(uint32_t)(0.9 * seen->count)];
  return VL_OK;
}

vlResult draw_look(const vlWorld *world, const vlCamera *camera, Seen *seen, vlError *error) {
  enum { SIDE = 64 };
  vlCamera small;
  memset(seen, 0, sizeof *seen);
  uint32_t w = camera->width, h = camera->height, max = w > h ? w : h;
  w = w * SIDE / max ? w * SIDE / max : 1;
  h = h * SIDE / max ? h * SIDE / max : 1;
  TRY_RESULT(vl_camera_resize(camera, w, h, &small));
  vlChannelsDef def = vl_default_channels_def(w, h);
  def.channels = VL_CHANNEL_Z | VL_CHANNEL_DISTANCE | VL_CHANNEL_P;
  vlImage *floats = NULL;
  vlResult result = vl_render_channels(world, &small, &def, &floats, NULL, error);
  bool flat = camera->projection == VL_PROJECTION_PERSPECTIVE ||
              camera->projection == VL_PROJECTION_ORTHOGRAPHIC;
  if (result == VL_OK)
    result = collect(floats, flat, seen);
  vl_image_destroy(floats);
  return result;
}

void draw_forget(Seen *seen) {
  free(seen->points);
  free(seen->depths);
  free(seen->pixels);
  memset(seen, 0, sizeof *seen);
}

/* ---- the outside camera ------------------------------------------------------------------ */

/* The axis of the world that is nearest to the camera's up, as a level horizon needs it. */
static void choose_up(const vlCamera *of, double up[3]) {
  int best = 0;
  double v[3];
  for (int i = 0; i < 3; i++)
    v[i] = -of->world_from_camera[4 * i + 1];
  for (int i = 1; i < 3; i++)
    if (fabs(v[i]) > fabs(v[best]))
      best = i;
  for (int i = 0; i < 3; i++)
    up[i] = i == best ? copysign(1, v[best]) : 0;
}

/* The unit direction from the middle towards the outside eye. */
static void choose_direction(const vlCamera *of, const double up[3], const OutsideDef *def,
                             double d[3]) {
  double level[3], right[3];
  const double *m = of->world_from_camera;
  /* the level part of the view direction or, of a camera that looks straight up or down, of its
   * image's up */
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < 3; i++)
      level[i] = k ? -m[4 * i + 1] : m[4 * i + 2];
    vector_along(level, -vector_dot(level, up), up, level);
    if (vector_dot(level, level) > 1e-4 * (m[2] * m[2] + m[6] * m[6] + m[10] * m[10]))
      break;
  }
  vector_normalize(level);
  vector_cross(level, up, right);
  double a = def->azimuth * degree, e = def->elevation * degree;
  for (int i = 0; i < 3; i++)
    d[i] = cos(e) * (cos(a) * level[i] + sin(a) * right[i]) + sin(e) * up[i];
}

/* The bounds of all projected points on the image, as factors of the half field of view. */
typedef struct Bounds {
  double low[2], high[2];
} Bounds;

static void bound(const vlCamera *c, const double point[3], Bounds *b) {
  const double *m = c->camera_from_world;
  double q[3];
  for (int i = 0; i < 3; i++)
    q[i] = vector_dot(m + 4 * i, point) + m[4 * i + 3];
  if (!(q[2] > 0))
    return;
  for (int k = 0; k < 2; k++) {
    double f = k ? c->fy : c->fx, t = f * q[k] / q[2];
    b->low[k] = fmin(b->low[k], t);
    b->high[k] = fmax(b->high[k], t);
  }
}

static Bounds bounds_of(const vlCamera *c, const vlDrawing *drawing, const Seen *seen) {
  Bounds b = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
  for (uint32_t i = 0; i < drawing->line_count; i++) {
    bound(c, drawing->lines[i].from, &b);
    bound(c, drawing->lines[i].to, &b);
  }
  for (uint32_t i = 0; i < seen->count; i++)
    if (seen->depths[i] <= seen->middle)
      bound(c, seen->points + 3 * (size_t)i, &b);
  return b;
}

vlResult draw_choose_view(const vlCamera *of, const vlDrawing *drawing, const Seen *seen,
                          const OutsideDef *def, Outside *outside, vlError *error) {
  const double margin = 0.9; /* share of the image's side that the bounds fill */
  double up[3], d[3], middle[3], distance = 0;
  choose_up(of, up);
  choose_direction(of, up, def, d);
  for (int i = 0; i < 3; i++) {
    middle[i] = 0.5 * (drawing->low[i] + drawing->high[i]);
    distance = hypot(distance, drawing->high[i] - drawing->low[i]);
  }
  distance = 4 * fmax(distance, 1e-9);
  vlCameraDef camera = vl_default_camera_def(def->width, def->height);
  camera.fov = 24 * degree;
  camera.fov_axis = VL_FOV_LARGER;
  for (int step = 0; step < 8; step++) { /* moves and scales until the bounds fill the image */
    memcpy(camera.lookat, middle, sizeof middle);
    memcpy(camera.up, up, sizeof up);
    vector_along(middle, distance, d, camera.eye);
    TRY_RESULT(vl_camera_make(&camera, &outside->camera, NULL, error));
    const vlCamera *c = &outside->camera;
    Bounds b = bounds_of(c, drawing, seen);
    double share =
        fmax((b.high[0] - b.low[0]) / def->width, (b.high[1] - b.low[1]) / def->height) /
        margin;
    for (int i = 0; i < 3; i++) {
      const double *m = c->world_from_camera + 4 * i;
      middle[i] += distance * (m[0] * 0.5 * (b.low[0] + b.high[0]) / c->fx +
                               m[1] * 0.5 * (b.low[1] + b.high[1]) / c->fy);
    }
    if (share > 0 && isfinite(share))
      distance *= share;
  }
  distance /= def->zoom;
  memcpy(camera.lookat, middle, sizeof middle);
  vector_along(middle, distance, d, camera.eye);
  return vl_camera_make(&camera, &outside->camera, NULL, error);
}

/* ---- the rendered scene ------------------------------------------------------------------ */

/* Exposes the image and puts it over white. pale: its opacity. */
static void put_on_paper(vlImage *image, double ev, double pale) {
  double scale = exp2(ev);
  float *p = vl_image_pixels(image);
  uint32_t channels = vl_image_channels(image);
  for (size_t i = 0; i < image_pixel_count(image); i++, p += channels) {
    double alpha = channels > 3 ? fmin(1.0, fmax(0.0, (double)p[3])) : 1.0;
    for (int k = 0; k < 3; k++) {
      double v = fmin(1.0, fmax(0.0, scale * (double)p[k]));
      p[k] = (float)(1.0 - pale * alpha + pale * fmin(v, alpha));
    }
  }
}

/* The film's image without noise. */
static vlResult clean_image(vlContext *context, const vlWorld *world, const vlCamera *camera,
                            const vlFilm *film, const vlRenderDef *render, vlImage **image,
                            vlError *error) {
  vlDevelopDef develop = vl_default_develop_def();
  vlChannelsDef channels = vl_default_channels_def(camera->width, camera->height);
  channels.channels = VL_CHANNEL_ERROR | VL_CHANNEL_FEATURES;
  channels.film = film;
  channels.render = render;
  vlImage *color = NULL, *floats = NULL, *joined = NULL;
  vlResult result = vl_film_develop(film, &develop, &color);
  if (result == VL_OK)
    result = vl_render_channels(world, camera, &channels, &floats, NULL, error);
  if (result == VL_OK)
    result = denoised_join(context, (const vlImage *const[]){color, floats}, 2, NULL, &joined);
  if (result == VL_OK)
    result = vl_denoise(joined, NULL, image, NULL, error);
  vl_image_destroy(color);
  vl_image_destroy(floats);
  vl_image_destroy(joined);
  return result;
}

/* Renders what a camera sees; alpha 0 where it sees no surface. */
static vlResult render_view(vlContext *context, const vlWorld *world, const vlSceneDefs *defs,
                            const OutsideDef *def, const vlCamera *camera, vlImage **image,
                            vlError *error) {
  vlFilm *film = NULL;
  vlFilmDef film_def = vl_default_film_def(camera->width, camera->height);
  vlRenderDef render = vl_default_render_def();
  film_def.errors = true;
  render.spp = def->spp;
  render.transparent = true;
  render.max_depth = defs->render.max_depth;
  vlResult result = vl_film_create(context, &film_def, &film);
  if (result == VL_OK)
    result = vl_render(world, camera, film, &render, NULL, error);
  if (result == VL_OK)
    result = clean_image(context, world, camera, film, &render, image, error);
  vl_film_destroy(film);
  return result;
}

/* The scene from outside, and the camera's own image. */
static vlResult render_images(vlContext *context, const vlWorld *world, const vlSceneDefs *defs,
                              const OutsideDef *def, const vlCamera *of, Outside *outside,
                              vlError *error) {
  enum { SIDE = 320 };      /* of the camera's own image, pixels */
  const double pale = 0.82; /* opacity of the scene: lines must stand out */
  const double stops = 0.8; /* that it is brighter than the meter says */
  TRY_RESULT(render_view(context, world, defs, def, &outside->camera, &outside->image, error));
  double ev =
      isnan(def->exposure) ? stops + (double)exposure_meter(outside->image) : def->exposure;
  if (!isfinite(ev))
    ev = 0;
  put_on_paper(outside->image, ev, pale);
  if (!def->own_image)
    return VL_OK;
  double scale = fmin(1.0, (double)SIDE / fmax(of->width, of->height));
  TRY_RESULT(vl_camera_resize(of, (uint32_t)fmax(1, scale * of->width),
                              (uint32_t)fmax(1, scale * of->height), &outside->inside));
  TRY_RESULT(
      render_view(context, world, defs, def, &outside->inside, &outside->inside_image, error));
  put_on_paper(outside->inside_image, ev, 1.0);
  return VL_OK;
}

static vlResult render_depth(const vlWorld *world, const OutsideDef *def, Outside *outside,
                             vlError *error) {
  vlChannelsDef channels = vl_default_channels_def(def->width, def->height);
  channels.channels = VL_CHANNEL_Z;
  vlImage *floats = NULL;
  vlResult result =
      vl_render_channels(world, &outside->camera, &channels, &floats, NULL, error);
  for (size_t i = 0; result == VL_OK && i < (size_t)def->width * def->height; i++)
    outside->depth[i] = ((const float *)vl_image_const_pixels(floats))[i];
  vl_image_destroy(floats);
  return result;
}

/* Cuts away what stands before the drawing, such as the wall of a room, if it hides most of the
 * camera. */
static vlResult cut(const vlWorld *world, const OutsideDef *def, const vlDrawing *drawing,
                    Outside *outside, vlError *error) {
  uint32_t count = 0, hidden = 0;
  double near = INFINITY;
  for (uint32_t i = 0; i < drawing->line_count; i++) {
    const vlDrawingLine *l = &drawing->lines[i];
    double p[2], z;
    if (!vl_camera_project(&outside->camera, l->from, p, &z))
      continue;
    near = fmin(near, z);
    if (l->part != VL_DRAWING_WINDOW && l->part != VL_DRAWING_EYE && l->part != VL_DRAWING_GRID)
      continue;
    if (!(p[0] >= 0 && p[1] >= 0 && p[0] < def->width && p[1] < def->height))
      continue;
    count++;
    hidden += z > (double)outside->depth[(size_t)p[1] * def->width + (size_t)p[0]];
  }
  if (2 * hidden <= count || !(near < INFINITY))
    return VL_OK;
  outside->camera.near_plane = 0.97 * near;
  return render_depth(world, def, outside, error);
}

vlResult draw_render(vlContext *context, const vlWorld *world, const vlSceneDefs *defs,
                     const OutsideDef *def, const vlCamera *of, const vlDrawing *drawing,
                     Outside *outside, vlError *error) {
  size_t pixels = (size_t)def->width * def->height;
  outside->depth = malloc(pixels * sizeof *outside->depth);
  if (!outside->depth)
    return VL_ERROR_MEMORY;
  for (size_t i = 0; i < pixels; i++)
    outside->depth[i] = INFINITY;
  if (def->scene) {
    TRY_RESULT(render_depth(world, def, outside, error));
    TRY_RESULT(cut(world, def, drawing, outside, error));
    return render_images(context, world, defs, def, of, outside, error);
  }
  TRY_RESULT(image_make(context, def->width, def->height, 3, NULL, &outside->image));
  for (size_t i = 0; i < 3 * pixels; i++)
    ((float *)vl_image_pixels(outside->image))[i] = 1.0F;
  return VL_OK;
}

void draw_close(Outside *outside) {
  free(outside->depth);
  vl_image_destroy(outside->image);
  vl_image_destroy(outside->inside_image);
  memset(outside, 0, sizeof *outside);
}
