/* test/render/gltf_shots.h: images of one glTF material in a white room with an orthographic
 * camera: a sphere (the mean over its disk is the directional albedo averaged over the
 * cosine-weighted hemisphere), a wall, a slab. */
#ifndef TEST_RENDER_GLTF_SHOTS_H
#define TEST_RENDER_GLTF_SHOTS_H

#include <unistd.h>

#include "import/gltf_writer.h"
#include "render/shots.h"
#include "velo/load.h"

typedef enum Body { BALL, WALL, SLAB } Body; /* the slab is 1 thick */

typedef struct Shot {
  Body body;
  const char *material;   /* the members of the glTF material */
  vlEnvironmentKind room; /* AUTO: white */
  bool spectral, from_behind;
  uint32_t spp, depth; /* samples per pixel, bounces; 0 means 64 */
} Shot;

static UNUSED void put_ball(Gltf *g) {
  enum { RINGS = 28, PARTS = 2 * RINGS, ROW = PARTS + 1, CORNERS = (RINGS + 1) * ROW };
  static float p[3 * CORNERS], uv[2 * CORNERS];
  static uint16_t f[6 * RINGS * PARTS];
  size_t n = 0;
  for (int i = 0, v = 0; i <= RINGS; i++)
    for (int j = 0; j <= PARTS; j++, v++) {
      double theta = M_PI * i / RINGS, phi = 2 * M_PI * j / PARTS;
      p[3 * v] = (float)(sin(theta) * cos(phi));
      p[3 * v + 1] = (float)cos(theta);
      p[3 * v + 2] = (float)(-sin(theta) * sin(phi));
      uv[2 * v] = (float)j / PARTS;
      uv[2 * v + 1] = (float)i / RINGS;
    }
  for (int i = 0; i < RINGS; i++)
    for (int j = 0; j < PARTS; j++) {
      uint16_t a = (uint16_t)(i * ROW + j), b = (uint16_t)(a + ROW);
      const uint16_t two[6] = {
          a, b, (uint16_t)(a + 1), (uint16_t)(a + 1), b, (uint16_t)(b + 1)};
      for (int k = 0; k < 6; k++)
        f[n++] = two[k]; /* some triangles at the poles have no area */
    }
  gltf_floats(g, p, CORNERS, "VEC3", 3);
  gltf_floats(g, uv, CORNERS, "VEC2", 2);
  gltf_shorts(g, f, n);
}

static UNUSED void put_box(Gltf *g, float thickness) {
  float p[24];
  for (int i = 0; i < 8; i++) {
    p[3 * i] = i & 1 ? 8.0f : -8.0f;
    p[3 * i + 1] = i & 2 ? 8.0f : -8.0f;
    p[3 * i + 2] = i & 4 ? 0.0f : -thickness;
  }
  static const uint16_t faces[36] = {4, 5, 7, 4, 7, 6, 1, 0, 2, 1, 2, 3, 5, 1, 3, 5, 3, 7,
                                     0, 4, 6, 0, 6, 2, 6, 7, 3, 6, 3, 2, 0, 1, 5, 0, 5, 4};
  gltf_floats(g, p, 8, "VEC3", 3);
  gltf_shorts(g, faces, thickness > 0 ? 36 : 6);
}

/* Writes a file of these arrays and members; 32 x 32 pixels by its own camera. */
static UNUSED Image shoot(const Gltf *g, const char *rest, const Shot *shot) {
  char path[] = "/tmp/velo-shot-XXXXXX.gltf";
  int file = mkstemps(path, 5);
  assert_true(file >= 0);
  close(file);
  gltf_write_text(g, path, rest);
  Stage s = stage_open(32, 32);
  vlError error;
  memset(&error, 0, sizeof error);
  if (vl_scene_load(s.scene, path, NULL, &error) != VL_OK)
    fail_msg("%s: %s", rest, error.message);
  vlCompleteDef complete = vl_default_complete_def();
  complete.environment = shot->room == VL_ENVIRONMENT_AUTO ? VL_ENVIRONMENT_WHITE : shot->room;
  if (vl_scene_complete(s.scene, &complete, &error) != VL_OK)
    fail_msg("%s", error.message);
  s.camera = vl_scene_defs(s.scene)->camera;
  s.camera.width = s.camera.height = 32;
  s.build.color = shot->spectral ? VL_COLOR_SPECTRAL : VL_COLOR_RGB;
  s.render.tracer = vl_scene_defs(s.scene)->render.tracer;
  s.render.spp = shot->spp ? shot->spp : 64;
  s.render.sequence = s.render.spp; /* the least noise for this number */
  s.render.max_depth = shot->depth ? shot->depth : 64;
  Image p = stage_finish(&s);
  unlink(path);
  assert_int_equal(p.stats.not_finite, 0);
  return p;
}

#define SHOT_CAMERA                                                                            \
  "\"cameras\":[{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,\"ymag\":1,\"znear\":" \
  "0."                                                                                         \
  "01,\"zfar\":100}}]"

/* Mean of each channel: over the ball's disk, over the middle of a wall or slab. */
static UNUSED void take_shot(const Shot *shot, double rgb[3]) {
  Gltf *g = calloc(1, sizeof *g);
  if (shot->body == BALL)
    put_ball(g);
  else
    put_box(g, shot->body == SLAB ? 1.0f : 0.0f);
  char rest[4096];
  snprintf(
      rest, sizeof rest,
      "\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"camera\":0,%s}]"
      "," SHOT_CAMERA
      ",\"materials\":[{%s}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0%s},"
      "\"indices\":%d,"
      "\"material\":0}]}]",
      shot->from_behind ? "\"translation\":[0,0,-10],\"rotation\":[0,1,0,0]"
                        : "\"translation\":[0,0,10]",
      shot->material, shot->body == BALL ? ",\"NORMAL\":0,\"TEXCOORD_0\":1" : "",
      g->accessor_count - 1);
  Image p = shoot(g, rest, shot);
  free(g);
  for (int c = 0; c < 3; c++)
    rgb[c] = shot->body != BALL ? image_region(&p, 8, 8, 24, 24, c)
                                : (image_mean(&p, c) - (1 - M_PI_4)) / M_PI_4;
  image_free(&p);
}

static UNUSED void expect_shot(const char *name, const Shot *shot, double r, double g, double b,
                               double tolerance) {
  double rgb[3];
  take_shot(shot, rgb);
  const double expected[3] = {r, g, b};
  for (int c = 0; c < 3; c++)
    if (!(fabs(rgb[c] - expected[c]) <= tolerance))
      fail_msg("%s: %.5f %.5f %.5f, expected %.5f %.5f %.5f within %g", name, rgb[0], rgb[1],
               rgb[2], r, g, b, tolerance);
}

#endif
