/* render/gbuffer.c: see gbuffer.h. Its values are ground truth at pixel centres, whereas pbrt
 * averages over the samples of a pixel. */
#include "render/gbuffer.h"

#include <math.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/signals.h"
#include "cli/vector.h"
#include "image/image.h"
#include "velo/channels.h"

static const char *const names[] = {"Albedo.R",
                                    "Albedo.G",
                                    "Albedo.B",
                                    "P.X",
                                    "P.Y",
                                    "P.Z",
                                    "dzdx",
                                    "dzdy",
                                    "N.X",
                                    "N.Y",
                                    "N.Z",
                                    "Ns.X",
                                    "Ns.Y",
                                    "Ns.Z",
                                    "u",
                                    "v",
                                    "Variance.R",
                                    "Variance.G",
                                    "Variance.B",
                                    "RelativeVariance.R",
                                    "RelativeVariance.G",
                                    "RelativeVariance.B"};
enum {
  ALBEDO = 0,
  P = 3,
  DZ = 6,
  N = 8,
  NS = 11,
  UV = 14,
  VARIANCE = 16,
  RELATIVE = 19,
  COUNT = 22
};
_Static_assert(LENGTH(names) == COUNT, "a name for each");

/* The images that the values come from, and the indices of their channels. */
typedef struct Source {
  const vlImage *rendered;
  const float *values, *errors; /* errors: of independent samples, 3 floats of each pixel */
  uint32_t width, height, channels;
  int p, n, ng, uv, albedo, ray, distance;
  bool world;
  const vlCamera *camera;
  double seconds; /* VL_UNSET: of each row */
  double m[16];   /* camera_from_world, of the current pixel */
  double shrink, samples;
} Source;

static const float *at(const Source *s, uint32_t x, uint32_t y, int channel) {
  return s->values + ((size_t)y * s->width + x) * s->channels + channel;
}

/* Transforms a point (w 1) or vector (w 0) from world space to the output's space: pbrt's
 * camera space (x right, y up, z forward), or world space if s->world. */
static void turn(const Source *s, const double v[3], double w, double out[3]) {
  for (int i = 0; i < 3; i++) {
    double sum = vector_dot(s->m + 4 * i, v) + s->m[4 * i + 3] * w;
    out[i] = s->world ? v[i] : i == 1 ? -sum : sum;
  }
}
/* Writes a transformed point (w 1) or unit vector (w 0). */
static void put(const Source *s, const double v[3], double w, float *out) {
  double turned[3], l = 1;
  turn(s, v, w, turned);
  if (w == 0.0)
    l = vector_length(turned);
  for (int i = 0; i < 3; i++)
    out[i] = l > 0 ? (float)(turned[i] / l) : 0.0f;
}

/* The absolute change of z from pixel (x, y) to its neighbour (nx, ny) on the tangent plane of
 * the surface at p with normal n, times s->shrink. 0 if it is not finite. */
static double slope(const Source *s, uint32_t x, uint32_t y, uint32_t nx, uint32_t ny,
                    const double p[3], const double n[3]) {
  const float *ray = at(s, nx, ny, s->ray), *met = at(s, nx, ny, s->p),
              *own = at(s, x, y, s->ray);
  double far = (double)*at(s, nx, ny, s->distance),
         distance = (double)*at(s, x, y, s->distance);
  double d[3], o[3], way[3], turned[3];
  for (int i = 0; i < 3; i++) {
    d[i] = (double)ray[i];
    o[i] = far < 1e30 ? (double)met[i] - far * d[i] : p[i] - distance * (double)own[i];
    way[i] = p[i] - o[i];
  }
  double across = vector_dot(n, d), t = across != 0.0 ? vector_dot(n, way) / across : 0.0;
  for (int i = 0; i < 3; i++)
    way[i] = across != 0.0 ? o[i] + t * d[i] - p[i] : 0.0;
  turn(s, way, 0, turned);
  return fabs(turned[2]) < 1e30 ? fabs(turned[2]) * s->shrink : 0.0;
}

static void fill(const Source *s, uint32_t x, uint32_t y, float out[COUNT]) {
  const float *errors = s->errors + 3 * ((size_t)y * s->width + x);
  for (int c = 0; c < 3; c++) { /* the variance of samples is the squared error of independent
                                   ones times their number */
    float error = errors[c], mean = vl_image_get(s->rendered, x, y, (uint32_t)c);
    out[VARIANCE + c] =
        error < 1e18f ? (float)((double)error * (double)error * s->samples) : 0.0f;
    out[RELATIVE + c] = mean != 0.0f ? out[VARIANCE + c] / mean : 0.0f;
  }
  if (!(*at(s, x, y, s->distance) < 1e30f))
    return;
  double p[3], n[3], ns[3], ray[3];
  for (int i = 0; i < 3; i++) {
    p[i] = (double)at(s, x, y, s->p)[i];
    n[i] = (double)at(s, x, y, s->ng)[i];
    ns[i] = (double)at(s, x, y, s->n)[i];
    ray[i] = (double)at(s, x, y, s->ray)[i];
    out[ALBEDO + i] = at(s, x, y, s->albedo)[i];
  }
  /* normals are flipped to face the camera */
  bool away[2] = {vector_dot(n, ray) > 0, vector_dot(ns, ray) > 0};
  for (int i = 0; i < 3; i++) {
    n[i] = away[0] ? -n[i] : n[i];
    ns[i] = away[1] ? -ns[i] : ns[i];
  }
  put(s, p, 1, out + P);
  put(s, n, 0, out + N);
  put(s, ns, 0, out + NS);
  for (int i = 0; i < 2; i++)
    out[UV + i] = at(s, x, y, s->uv)[i];
  out[DZ] = (float)slope(s, x, y, x + 1 < s->width ? x + 1 : x ? x - 1 : x, y, p, n);
  out[DZ + 1] = (float)slope(s, x, y, x, y + 1 < s->height ? y + 1 : y ? y - 1 : y, p, n);
}

/* Fills the image's COUNT floats per pixel. The camera is that of the pixel's time, which is
 * found anew where it changes: along rows, or along columns of a readout to the side. */
static void fill_all(Source *s, const uint32_t crop[4], float *out) {
  double before = VL_UNSET;
  for (uint32_t y = 0; y < s->height; y++)
    for (uint32_t x = 0; x < s->width; x++) {
      double seconds = s->seconds;
      if (isnan(seconds))
        seconds = vl_camera_time(s->camera, crop[0] + x + 0.5, crop[1] + y + 0.5, 0.5);
      vlCamera held;
      if (seconds != before && vl_camera_at(s->camera, seconds, &held) == VL_OK)
        memcpy(s->m, held.camera_from_world, sizeof s->m);
      before = seconds;
      fill(s, x, y, out + ((size_t)y * s->width + x) * COUNT);
    }
}

static vlResult ground_truth_of(const Job *job, const vlFilm *film, vlImage **geometry,
                                vlError *error) {
  int signals = signals_count();
  vlChannelsDef def = job_channels_def(job, film, &signals);
  def.channels = VL_CHANNEL_P | VL_CHANNEL_N | VL_CHANNEL_NG | VL_CHANNEL_UV |
                 VL_CHANNEL_ALBEDO | VL_CHANNEL_RAY | VL_CHANNEL_DISTANCE;
  return vl_render_channels(job->world, &job->camera, &def, geometry, NULL, error);
}

int gbuffer_render(const Job *job, const vlFilm *film, vlImage **image) {
  vlImage *geometry = NULL, *rendered = NULL, *errors = NULL;
  vlError error = {0};
  vlDevelopDef develop = job->defs->develop;
  develop.independent = true;
  vlResult result = ground_truth_of(job, film, &geometry, &error);
  if (result == VL_OK)
    result = vl_film_develop(film, &develop, &rendered);
  if (result == VL_OK)
    result = vl_film_errors(film, &develop, &errors);
  if (result == VL_OK)
    result = image_make_like(job->context, geometry, COUNT, names, image);
  if (result == VL_OK) {
    double spp = vl_film_spp(film);
    Source s = {
        .camera = &job->camera,
        .seconds = job_channels_time(job),
        .rendered = rendered,
        .values = vl_image_const_pixels(geometry),
        .errors = vl_image_const_pixels(errors),
        .width = vl_image_width(geometry),
        .height = vl_image_height(geometry),
        .channels = vl_image_channels(geometry),
        .p = vl_image_find_channel(geometry, "P.X"),
        .n = vl_image_find_channel(geometry, "N.X"),
        .ng = vl_image_find_channel(geometry, "Ng.X"),
        .uv = vl_image_find_channel(geometry, "uv.U"),
        .albedo = vl_image_find_channel(geometry, "albedo.R"),
        .ray = vl_image_find_channel(geometry, "ray.X"),
        .distance = vl_image_find_channel(geometry, "distance.Y"),
        .world = job->defs->gbuffer == VL_GBUFFER_WORLD,
        .shrink = fmax(
            0.125,
            1 / sqrt(spp)), /* pbrt's ray differentials shrink with the number of samples */
        .samples = spp};
    fill_all(&s, job->defs->film.crop, vl_image_pixels(*image));
  }
  vl_image_destroy(geometry);
  vl_image_destroy(rendered);
  vl_image_destroy(errors);
  return job_end_pass(job, result, &error);
}
