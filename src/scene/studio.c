/* scene/studio.c: see studio.h. */
#include "scene/studio.h"

#include <math.h>

#include "math/approx.h"
#include "math/vec.h"

/* A direction as angles in degrees: from straight ahead to the right, above the horizon. */
typedef struct Angles {
  float azimuth, elevation;
} Angles;

static Angles angles_of(vlVec3 d) {
  const float degrees = 57.29578f;
  return (Angles){vl_atan2(d.x, d.y) * degrees,
                  90.0f - vl_acos(vl_clamp(d.z, -1, 1)) * degrees};
}

static float from_azimuth(Angles a, float at) {
  const float d = fabsf(a.azimuth - at);
  return d > 180 ? 360 - d : d;
}

/* 1 in a rectangle on the sphere, and 0 `edge` degrees outside of it. */
static float soft_box(Angles a, float at, float height, float half_width, float half_height,
                      float edge) {
  return vl_smooth_step(half_width - from_azimuth(a, at), 0, edge) *
         vl_smooth_step(half_height - fabsf(a.elevation - height), 0, edge);
}

/* 1 around a direction, and 0 from `radius` degrees on; the same in all directions. */
static float spot(vlVec3 d, float at, float height, float inner, float radius) {
  const float radians = 0.01745329f;
  const vlSinCos a = vl_sincos(at * radians), h = vl_sincos(height * radians);
  const float along = h.cos * (d.x * a.sin + d.y * a.cos) + h.sin * d.z;
  return vl_smooth_step(-vl_acos(vl_clamp(along, -1, 1)), -radius * radians, -inner * radians);
}

static void add(float rgb[3], float amount, float r, float g, float b) {
  rgb[0] += amount * r;
  rgb[1] += amount * g;
  rgb[2] += amount * b;
}

static void mix(float rgb[3], float amount, const float other[3]) {
  for (int c = 0; c < 3; c++)
    rgb[c] += amount * (other[c] - rgb[c]);
}

/* Soft boxes in a cool grey room without edges. The floor goes over into walls, which are
 * brightest behind the model. The lights: a key light over the viewer's left shoulder, a fill
 * light on the right, two rim lights behind the model, one above; each is brighter towards its
 * top. They are a little warm, so that a white surface is neutral before a cool room. */
static void soft_boxes(vlVec3 d, float rgb[3]) {
  const Angles a = angles_of(d);
  const float back = 0.5f + 0.5f * d.y, above = vl_smooth_step(a.elevation, 0, 90);
  const float floor = 0.16f + 0.05f * vl_smooth_step(a.elevation, -80, -20);
  const float wall = 0.18f + 0.12f * back + 0.2f * vl_smooth_step(a.elevation, 5, 90) +
                     0.16f * spot(d, 0, 14, 0, 50);
  add(rgb, floor + (wall - floor) * vl_smooth_step(a.elevation, -14, 20), 0.90f, 1.0f, 1.16f);
  float light = (3.1f + 3.1f * above) * soft_box(a, -135, 44, 32, 26, 12);
  light += (0.8f + 1.2f * above) * soft_box(a, 105, 24, 15, 34, 10);
  light += 2.9f * soft_box(a, 38, 40, 16, 16, 8);
  light += 2.0f * soft_box(a, -52, 42, 12, 24, 8);
  light += 1.2f * vl_smooth_step(a.elevation, 64, 80);
  add(rgb, light, 1.03f, 1.0f, 0.95f);
}

/* Daylight through a tall window on the left, of two by three panes, in a warm room; a pale
 * wall on the right gives some of it back. */
static void window(vlVec3 d, float rgb[3]) {
  enum { AT = -100, HEIGHT = 30, HALF_WIDTH = 40, HALF_HEIGHT = 34, BAR = 2 };
  const Angles a = angles_of(d);
  const float floor = 0.12f + 0.05f * vl_smooth_step(a.elevation, -80, -15);
  const float wall =
      0.16f + 0.14f * vl_smooth_step(a.elevation, 0, 80) + 0.12f * spot(d, 30, 10, 0, 70);
  add(rgb, floor + (wall - floor) * vl_smooth_step(a.elevation, -14, 12), 1.10f, 1.0f, 0.86f);
  add(rgb, 0.75f * soft_box(a, 100, 20, 55, 45, 30), 1.08f, 1.0f, 0.88f);
  const float x = a.azimuth - AT, y = a.elevation - HEIGHT;
  const float bars = vl_smooth_step(fabsf(x), BAR - 1, BAR + 1) *
                     vl_smooth_step(fabsf(fabsf(y) - HALF_HEIGHT / 3.0f), BAR - 1, BAR + 1);
  const float sky = 3.9f + 2.6f * vl_smooth_step(a.elevation, -10, 60);
  add(rgb, sky * bars * soft_box(a, AT, HEIGHT, HALF_WIDTH, HALF_HEIGHT, 3), 0.95f, 1.0f,
      1.08f);
  add(rgb, 0.5f * soft_box(a, 150, 50, 24, 20, 16), 1.04f, 1.0f, 0.94f);
}

/* A low sun on the left behind the viewer, large and soft through haze; an orange horizon
 * around it, blue above, dusk on the other side, and dark ground. */
static void evening(vlVec3 d, float rgb[3]) {
  enum { SUN = -128, SUN_HEIGHT = 24 };
  static const float blue[3] = {0.20f, 0.27f, 0.46f}, dusk[3] = {0.30f, 0.24f, 0.32f},
                     orange[3] = {0.95f, 0.50f, 0.24f}, ground[3] = {0.125f, 0.105f, 0.11f};
  const Angles a = angles_of(d);
  const float near_sun = vl_smooth_step(-from_azimuth(a, SUN), -150, -10);
  mix(rgb, 1, dusk);
  mix(rgb, near_sun, orange);
  mix(rgb, vl_smooth_step(a.elevation, 4, 60), blue);
  mix(rgb, vl_smooth_step(-a.elevation, -8, 12), ground);
  add(rgb, 1.6f * spot(d, SUN, SUN_HEIGHT, 0, 60), 1.0f, 0.62f, 0.30f);
  add(rgb, 34.0f * spot(d, SUN, SUN_HEIGHT, 9, 13), 1.0f, 0.80f, 0.56f);
  add(rgb, 1.3f * soft_box(a, 60, 30, 22, 26, 16), 0.80f, 0.92f, 1.25f);
}

const vlStudio *vl_studio(vlEnvironmentKind kind) {
  static const vlStudio studios[] = {
      {soft_boxes, {0.179f, 0.197f, 0.224f}},
      {window, {0.159f, 0.144f, 0.122f}},
      {evening, {0.119f, 0.121f, 0.136f}},
  };
  switch (kind) {
    case VL_ENVIRONMENT_STUDIO:
    case VL_ENVIRONMENT_LAMPS:
      return &studios[0];
    case VL_ENVIRONMENT_WINDOW:
      return &studios[1];
    case VL_ENVIRONMENT_EVENING:
      return &studios[2];
    case VL_ENVIRONMENT_AUTO:
    case VL_ENVIRONMENT_NONE:
    case VL_ENVIRONMENT_SKY:
    case VL_ENVIRONMENT_WHITE:
    case VL_ENVIRONMENT_FILE:
      break;
  }
  return NULL;
}

bool vl_environment_is_studio(vlEnvironmentKind kind) {
  return kind != VL_ENVIRONMENT_LAMPS && vl_studio(kind) != NULL;
}
