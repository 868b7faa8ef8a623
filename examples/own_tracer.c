/* own_tracer: a tracer of one's own: light that reaches the camera straight from lamps, or by at most two surfaces
 * (docs/own-code.md).
 *
 *   own_tracer SCENE IMAGE
 *   build/release/bin/example_own_tracer examples/corner.pbrt examples/own_tracer.jpg
 */
#include "example.h"

static void radiance_of(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  (void)user;
  vlTraceHits hits;
  vlTraceLights lights;
  vlTraceBounce next = {.rays = *paths->rays};
  uint8_t occluded[VL_OWN_BATCH];
  float bsdf[4][VL_OWN_BATCH], beta[4][VL_OWN_BATCH];
  for (uint32_t bounce = 0; bounce < 2; bounce++) {
    vl_world_trace(trace, &next.rays, &hits);
    vl_trace_lights(trace, bounce, &lights);
    vl_world_occluded(trace, &lights.rays, occluded);
    vl_trace_bsdf(trace, lights.direction, bsdf, NULL);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = 0; i < paths->count; i++) {
        beta[c][i] = bounce ? beta[c][i] * next.weight[c][i] : 1;
        if (bounce == 0 || next.specular[i]) paths->radiance[c][i] += beta[c][i] * hits.emission[c][i];
        if (!occluded[i]) paths->radiance[c][i] += beta[c][i] * bsdf[c][i] * lights.radiance[c][i];
      }
    vl_trace_bounce(trace, bounce, &next);
  }
}

int main(int count, char **arguments) {
  static const vlOwnTracer two_surfaces = {.name = "two surfaces", .radiance = radiance_of};
  Example e = example_open(count, arguments, NULL);
  e.defs->render.own_tracer = &two_surfaces;
  example_render(&e);
  example_write(&e, arguments[2]);
  return example_close(&e);
}
