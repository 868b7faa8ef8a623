/* image/overlay.c: see overlay.h. */
#include "image/overlay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint8_t encoded(double v) {
  v = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
  return (uint8_t)floor(255.0 * v + 0.5);
}

static double decoded(uint8_t byte) {
  double v = byte / 255.0;
  return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static float sample(const vlImage *image, uint32_t x, uint32_t y, int channel) {
  float v = (float)vl_image_get(image, x, y, (uint32_t)channel);
  return v > 0.0F ? v < 1.0F ? v : 1.0F : 0.0F; /* NaN becomes black */
}

bool overlay_begin(Overlay *o, const vlImage *image) {
  o->width = vl_image_width(image);
  o->height = vl_image_height(image);
  size_t pixels = (size_t)o->width * o->height;
  o->rgb = malloc(3 * pixels * sizeof *o->rgb);
  o->coverage = calloc(pixels, sizeof *o->coverage);
  if (!o->rgb || !o->coverage)
    return false;
  static const char *const names[3] = {"R", "G", "B"};
  for (int k = 0; k < 3; k++) {
    int channel = vl_image_find_channel(image, names[k]);
    if (channel < 0)
      channel = vl_image_find_channel(image, "Y");
    if (channel < 0)
      channel = 0;
    for (uint32_t y = 0; y < o->height; y++)
      for (uint32_t x = 0; x < o->width; x++)
        o->rgb[3 * ((size_t)y * o->width + x) + (size_t)k] = sample(image, x, y, channel);
  }
  return true;
}

void overlay_end(Overlay *o) {
  free(o->rgb);
  free(o->coverage);
  *o = (Overlay){0};
}

/* The segment that a pen draws, in pixels. */
typedef struct Stroke {
  double start[2], run[2]; /* run: from the start to the end */
  double width;
} Stroke;

/* Covers a pixel with a pen whose soft edge is one pixel wide. The coverage depends on the
 * distance between the pixel's centre and the segment. */
static void touch(Overlay *o, const Stroke *stroke, long x, long y) {
  if (x < 0 || y < 0 || x >= (long)o->width || y >= (long)o->height)
    return;
  const double *run = stroke->run;
  const double length2 = run[0] * run[0] + run[1] * run[1];
  const double px = (double)x + 0.5 - stroke->start[0];
  const double py = (double)y + 0.5 - stroke->start[1];
  double t = length2 > 0.0 ? (px * run[0] + py * run[1]) / length2 : 0.0;
  t = fmin(fmax(t, 0.0), 1.0);
  const double distance = hypot(px - t * run[0], py - t * run[1]);
  const double covered = fmin(0.5 * stroke->width + 0.5 - distance, 1.0);
  float *cover = &o->coverage[(size_t)y * o->width + (size_t)x];
  if (covered > *cover)
    *cover = (float)covered;
}

/* Clips a segment to a box (Liang and Barsky). Returns false if nothing remains. */
static bool clip(double p[4], double x0, double y0, double x1, double y1) {
  double t0 = 0.0, t1 = 1.0, dx = p[2] - p[0], dy = p[3] - p[1];
  const double run[4] = {-dx, dx, -dy, dy},
               room[4] = {p[0] - x0, x1 - p[0], p[1] - y0, y1 - p[1]};
  for (int i = 0; i < 4; i++) {
    if (run[i] == 0.0 && room[i] < 0.0)
      return false;
    if (run[i] < 0.0)
      t0 = fmax(t0, room[i] / run[i]);
    if (run[i] > 0.0)
      t1 = fmin(t1, room[i] / run[i]);
  }
  if (!(t0 <= t1))
    return false;
  const double q[4] = {p[0] + t0 * dx, p[1] + t0 * dy, p[0] + t1 * dx, p[1] + t1 * dy};
  memcpy(p, q, sizeof q);
  return true;
}

void overlay_line(Overlay *o, double x0, double y0, double x1, double y1, double width) {
  double p[4] = {x0, y0, x1, y1}, reach = 0.5 * width + 2.0;
  if (!isfinite(x0 + y0 + x1 + y1) ||
      !clip(p, -reach, -reach, o->width + reach, o->height + reach))
    return;
  const Stroke stroke = {{p[0], p[1]}, {p[2] - p[0], p[3] - p[1]}, width};
  /* One step per pixel of the longer axis; each step paints the pen's width along the other
   * axis. */
  const int longer = fabs(stroke.run[0]) >= fabs(stroke.run[1]) ? 0 : 1;
  const int other = 1 - longer;
  const double slope = stroke.run[longer] != 0.0 ? stroke.run[other] / stroke.run[longer] : 0.0;
  const double low = fmin(p[longer], p[longer + 2]);
  const double high = fmax(p[longer], p[longer + 2]);
  const double across = reach * sqrt(1.0 + slope * slope);
  for (long i = (long)floor(low - reach); i <= (long)ceil(high + reach); i++) {
    const double along = (double)i + 0.5 - stroke.start[longer];
    const double middle = stroke.start[other] + slope * along;
    for (long j = (long)floor(middle - across); j <= (long)ceil(middle + across); j++)
      touch(o, &stroke, longer == 0 ? i : j, longer == 0 ? j : i);
  }
}

void overlay_ring(Overlay *o, double x, double y, double radius, double width) {
  enum { SIDES = 48 };
  for (int i = 0; i < SIDES; i++) {
    double t0 = 2.0 * M_PI * i / SIDES, t1 = 2.0 * M_PI * (i + 1) / SIDES;
    overlay_line(o, x + radius * cos(t0), y + radius * sin(t0), x + radius * cos(t1),
                 y + radius * sin(t1), width);
  }
}

/* Whether a point is inside of a quadrilateral, which may be concave: the even-odd rule. */
static bool inside(const double q[4][2], double x, double y) {
  bool in = false;
  for (int i = 0; i < 4; i++) {
    const double *a = q[i], *b = q[(i + 1) % 4];
    if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
      in = !in;
  }
  return in;
}

void overlay_bounds(const double q[4][2], double low[2], double high[2]) {
  for (int k = 0; k < 2; k++) {
    low[k] = INFINITY;
    high[k] = -INFINITY;
    for (int i = 0; i < 4; i++) {
      low[k] = fmin(low[k], q[i][k]);
      high[k] = fmax(high[k], q[i][k]);
    }
  }
}

void overlay_quad(Overlay *o, const double q[4][2], OverlaySeen *seen, void *user) {
  enum { SIDE = 4 };
  double low[2], high[2];
  overlay_bounds(q, low, high);
  if (!isfinite(low[0] + low[1] + high[0] + high[1]))
    return;
  long x0 = (long)fmax(0, floor(low[0])), x1 = (long)fmin(o->width, ceil(high[0]));
  long y0 = (long)fmax(0, floor(low[1])), y1 = (long)fmin(o->height, ceil(high[1]));
  for (long y = y0; y < y1; y++)
    for (long x = x0; x < x1; x++) {
      int count = 0;
      for (int s = 0; s < SIDE * SIDE; s++)
        count +=
            inside(q, (double)x + (s % SIDE + 0.5) / SIDE, (double)y + (s / SIDE + 0.5) / SIDE);
      if (!count || (seen && !seen(user, (double)x + 0.5, (double)y + 0.5)))
        continue;
      float *cover = &o->coverage[(size_t)y * o->width + (size_t)x];
      /* neighbours share an edge */
      *cover = fminf(1.0F, *cover + (float)count / (SIDE * SIDE));
    }
}

void overlay_arc(Overlay *o, const vlCamera *camera, const double d[3], const double n[3],
                 double from, double to, double width) {
  enum { STEPS = 2048 };
  const double *m = camera->world_from_camera;
  double last[2] = {0, 0}, jump = 0.25 * (o->width + o->height);
  bool connected = false, straight = camera->projection == VL_PROJECTION_PERSPECTIVE &&
                                     camera->distortion.steps == 0;
  for (int i = 0; i <= STEPS; i++) {
    double t = from + (to - from) * i / STEPS, point[3], pixel[2];
    for (int k = 0; k < 3; k++)
      point[k] = m[4 * k + 3] + cos(t) * n[k] + sin(t) * d[k];
    bool seen = vl_camera_project(camera, point, pixel, NULL);
    /* panoramas that wrap around: the curve continues at the opposite edge */
    if (seen && connected && (straight || hypot(pixel[0] - last[0], pixel[1] - last[1]) < jump))
      overlay_line(o, last[0], last[1], pixel[0], pixel[1], width);
    connected = seen;
    if (seen)
      memcpy(last, pixel, sizeof last);
  }
}

void overlay_paint(Overlay *o, const uint8_t color[3], double opacity) {
  size_t pixels = (size_t)o->width * o->height;
  const float linear[3] = {(float)decoded(color[0]), (float)decoded(color[1]),
                           (float)decoded(color[2])};
  for (size_t i = 0; i < pixels; i++) {
    if (o->coverage[i] <= 0.0F)
      continue;
    float c = (float)opacity * o->coverage[i];
    for (size_t k = 0; k < 3; k++)
      o->rgb[3 * i + k] += c * (linear[k] - o->rgb[3 * i + k]);
    o->coverage[i] = 0.0F;
  }
}

vlResult overlay_write(const Overlay *o, vlContext *context, const char *path, vlError *error) {
  vlImageDef def = vl_default_image_def(o->width, o->height, 3);
  vlImage *image = NULL;
  def.type = VL_PIXEL_U8;
  def.encoding = VL_ENCODING_SRGB;
  vlResult result = vl_image_create(context, &def, &image);
  if (result == VL_OK) {
    uint8_t *to = vl_image_pixels(image);
    for (size_t i = 0; i < 3 * (size_t)o->width * o->height; i++)
      to[i] = encoded((double)o->rgb[i]);
    result = vl_image_write(image, path, NULL, error);
  }
  vl_image_destroy(image);
  return result;
}
