/* trace/two_way/splat.hot.c: connections of light paths to the camera: the film point of each
 * vertex, the radiance that arrives there, and its weight against the other strategies
 * (two_way.h). */
#include "light/spread.h"
#include "math/warp.h"
#include "trace/two_way/stages.h"

/* In place of the number of bounces, for the random numbers of media: differs from that of any
 * vertex. */
enum { LIGHT_ITSELF = 1 << 16 };

/* The sample of a point by a perspective camera. */
static vlCameraSample sample_camera(const vlCameraView *eye, vlVec3 p, float u, float v) {
  vlCameraSample r;
  __builtin_memset(&r, 0, sizeof r);
  r.from = eye->position;
  float lx = 0.0f, ly = 0.0f;
  if (eye->lens_radius > 0.0f) {
    vlDiskPoint lens = vl_warp_disk(u, v);
    lx = eye->lens_radius * lens.x;
    ly = eye->lens_radius * lens.y;
    r.from = vl_add(r.from, vl_add(vl_mul(eye->right, lx), vl_mul(eye->down, ly)));
  }
  vlVec3 to = vl_sub(p, r.from);
  float x = vl_dot(to, eye->right), y = vl_dot(to, eye->down), z = vl_dot(to, eye->ahead);
  if (!(z > 0.0f) || z < eye->near_plane || z > eye->far_plane)
    return r;
  float d2 = vl_length2(to), d = __builtin_sqrtf(d2), c = z / d;
  float inv = 1.0f / z, bend = eye->lens_radius > 0.0f ? 1.0f / eye->focus : 0.0f;
  r.x = eye->cx + eye->fx * (x * inv + lx * bend);
  r.y = eye->cy + eye->fy * (y * inv + ly * bend);
  r.seen = r.x > eye->low_x && r.x < eye->high_x && r.y > eye->low_y && r.y < eye->high_y;
  r.w = vl_mul(to, -1.0f / d);
  r.per_square = 1.0f / (vl_camera_view_pixel_area(eye, c) * d2);
  r.end = 1.0f - eye->near_plane * inv;
  r.weight = 1.0f;
  return r;
}

void vl_look_from(const vlTracing *t, uint32_t n, const vlPaths *p, uint32_t dimension,
                  const vlVec3Row *at, vlCameraSample *views) {
  const vlCameraView *eye = &t->def->two_way->eye;
  vlNumbers u;
  bool lens = eye->lens_radius > 0.0f;
  if (eye->look) {
    eye->look(eye, n, at->x, at->y, at->z, views);
    return;
  }
  if (lens)
    vl_draw_2d(t, n, p, dimension + VL_DIM_LIGHT_UV, u.u1, u.u2);
  for (uint32_t i = 0; i < n; i++)
    views[i] = sample_camera(vl_eye_of(t, p->lane[i]), vl_row3(at, i), lens ? u.u1[i] : 0.0f,
                             lens ? u.u2[i] : 0.0f);
}

/* A point of each camera ray is looked at from the camera. Where that gives the sample's own
 * pixel and ray again, light paths are connected there by the same functions, so both sides
 * know the same density. Elsewhere they are not: `pixels` may leave out what `rays` sees. */
void vl_measure_camera_rays(const vlTracing *t, vlCameraSample *views) {
  const vlCameraView *eye = &t->def->two_way->eye;
  const vlTraceBatch *b = t->batch;
  vlVec3Row at;
  if (!eye->look)
    return;
  for (uint32_t i = 0; i < b->n; i++) {
    vlVec3 o = vl_ray_origin(&b->rays, i);
    float far = 1.0f + vl_length(o); /* rounding of the point is small against the distance */
    vl_set_row3(&at, i, vl_add(o, vl_mul(vl_ray_direction(&b->rays, i), far)));
  }
  eye->look(eye, b->n, at.x, at.y, at.z, views);
  for (uint32_t i = 0; i < b->n; i++) {
    const vlCameraSample *v = &views[i];
    vlVec3 o = vl_ray_origin(&b->rays, i), d = vl_ray_direction(&b->rays, i);
    bool same = v->seen && vl_abs(v->x - (float)b->px[i] - 0.5f) <= eye->reach_x &&
                vl_abs(v->y - (float)b->py[i] - 0.5f) <= eye->reach_y &&
                vl_length2(vl_add(v->w, d)) < 1e-6f &&
                vl_length(vl_sub(v->from, o)) <= 1e-5f * (1.0f + vl_length(o));
    for (int k = 0; k < 3; k++)
      t->lanes->area[k][i] = same ? v->area[k] : 0.0f;
  }
}

bool vl_two_way_arrives(const vlTracing *t, uint32_t k, float passes[4], float *scale,
                        const vlTwoWayShadows *q) {
  const vlShadowFlights *f = q->flights;
  vlStrategies *r = q->strategies;
  float odds = 1.0f, mean = 1.0f;
  for (int c = 0; c < 4; c++)
    passes[c] = 1.0f;
  if (q->rays->occluded[k])
    return false;
  if (f) {
    float density[4];
    for (int c = 0; c < 4; c++) {
      passes[c] = f->beta[c][k];
      density[c] = f->density[c][k] * f->l[c][k];
    }
    odds = f->odds[k];
    mean = vl_flight_mean(density, vl_volume_rgb(t) ? 3 : 4);
    if (!(vl_largest_of4(passes) > 0.0f))
      return false;
  }
  r->others[k] *= odds;
  *scale = 1.0f / ((r->own[k] + r->others[k]) * mean);
  return true;
}

void vl_two_way_splats(vlTracing *t, const vlPaths *p, uint32_t count, uint32_t depth,
                       vlSplatRows *to, const vlTwoWayShadows *shadows) {
  vlLightBatch *b = t->light;
  vlShadowRays *q = shadows->rays;
  vlStrategies *r = shadows->strategies;
  const vlTwoWayLanes *lanes = t->lanes;
  vl_stage_occluded(t, count, p, q);
  b->shadow_rays += count;
  if (shadows->flights)
    vl_volume_pass_media(t, p, count, depth, q, shadows->flights);
  float *value[4], *lambda[4], *inv_pdf[4];
  for (int c = 0; c < 4; c++) {
    value[c] = to->value[c];
    lambda[c] = to->lambda[c];
    inv_pdf[c] = to->inv_pdf[c];
  }
  uint32_t visible = 0;
  for (uint32_t k = 0; k < count; k++) {
    float passes[4], scale;
    if (!vl_two_way_arrives(t, k, passes, &scale, shadows))
      continue;
    uint32_t lane = q->lane[k], m = visible++;
    to->x[m] = to->x[k];
    to->y[m] = to->y[k];
    r->others[m] = r->others[k] / r->own[k];
    for (int c = 0; c < 4; c++) {
      value[c][m] = q->radiance[c][k] * passes[c] * scale;
      lambda[c][m] = lanes->lambda[c][lane];
      inv_pdf[c][m] = lanes->inv_pdf[c][lane];
    }
  }
  if (visible)
    b->splat(b->user, visible, to->x, to->y, r->others, value, lambda, inv_pdf);
}

/* The way of shadow ray `count` of path i: from o to the part `end` of the way to `target`.
 * Returns its direction. */
static vlVec3 push(const vlPaths *p, uint32_t i, uint32_t count, vlVec3 o, vlVec3 target,
                   float end, const vlTwoWayShadows *shadows) {
  vlVec3 d = vl_sub(target, o);
  float t_max = vl_min(end, VL_ONE_MINUS_EPSILON);
  if (shadows->flights) { /* unit length: distances to interfaces on the way are needed */
    t_max = vl_min(end, VL_SHADOW_END) * vl_length(d);
    d = vl_normalize(d);
    shadows->flights->from[count] = i;
  }
  vl_shadow_way(p, i, o, d, t_max, count, shadows->rays);
  return d;
}

/* What the shadow ray of vertex i on a surface needs in media. d: its direction. */
static void start_in_media(const vlTracing *t, const vlTwoWayVertices *x, uint32_t i,
                           uint32_t count, vlVec3 d, float wi_z, vlShadowFlights *f) {
  const vlSurface *s = &x->at->surface;
  f->medium[count] = vl_medium_beyond(&t->world->shapes.items[x->at->hits.shape[i]],
                                      vl_row3(&s->g, i), d, x->rows->medium[i]);
  vl_shadow_from_surface(t, x->at, i, wi_z, count, f);
  for (int c = 0; c < 4; c++)
    f->density[c][count] = x->rows->u[c][i];
}

/* The views of n vertices, with the density of camera rays' first vertex there in per_square
 * (0: not seen), and their local directions. */
static void see(const vlTracing *t, uint32_t n, uint32_t dimension, const vlVertices *at,
                vlCameraSample *views, float wi[3][VL_ROW_SIZE]) {
  const vlSurface *f = &at->surface;
  vlVec3Row toward;
  vl_look_from(t, n, &at->paths, dimension, &f->p, views);
  for (uint32_t i = 0; i < n; i++) {
    vlCameraSample *view = &views[i];
    float cosine = vl_abs(vl_dot(view->w, vl_row3(&f->g, i)));
    view->per_square = view->seen ? cosine * view->per_square : 0.0f;
    vl_set_row3(&toward, i, view->w);
  }
  for (uint32_t i = n; i < VL_PAD(n); i++)
    vl_set_row3(&toward, i, views[n - 1].w);
  vl_stage_local(n, at, &toward, wi);
}

void vl_connect_to_camera(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                          const vlTwoWayVertices *x, vlBsdfValues *back, vlCameraSample *views,
                          vlSplatRows *splats, const vlTwoWayShadows *q) {
  const vlTwoWay *way = t->def->two_way;
  if (!way->eye.sees)
    return;
  if (way->alone && depth == 0)
    return; /* the camera sees a highlight: no random direction leads there */
  vlFloatRow wi[3];
  const vlSurface *f = &x->at->surface;
  const vlPaths *p = x->paths;
  const vlWays *ways = x->ways;
  vlStrategies *r = q->strategies;
  see(t, n, dimension, x->at, views, wi);
  vl_stage_reverse(t, n, x->at, (const float(*)[VL_ROW_SIZE])wi, back);
  const float(*value)[VL_ROW_SIZE] = (const float(*)[VL_ROW_SIZE])back->value;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    const vlCameraSample *view = &views[i];
    float sum = value[0][i] + value[1][i] + value[2][i] + value[3][i];
    if (!(view->per_square > 0.0f) || !(sum > 0.0f) || !(ways->cosine[i] > 0.0f))
      continue;
    vlVec3 at = vl_row3(&f->p, i);
    vlVec3 o = vl_surface_origin(f, i, vl_sub(view->from, at));
    vlVec3 d = push(p, i, count, o, view->from, view->end, q);
    if (q->flights)
      start_in_media(t, x, i, count, d, wi[2][i], q->flights);
    r->others[count] =
        way->light_only ? 0.0f : way->merged + ways->a[i] * back->pdf[i] + ways->b[i];
    r->own[count] = way->paths / view->per_square; /* S_1: density of this strategy, divided by
                                                      P_1 L_1 like the others */
    uint32_t lane = p->lane[i];
    float inv = 1.0f / ways->cosine[i];
    for (int c = 0; c < 4; c++)
      q->rays->radiance[c][count] =
          p->beta[c][i] * t->lanes->flux[c][lane] * value[c][i] * inv * view->weight;
    splats->x[count] = view->x;
    splats->y[count] = view->y;
    count++;
  }
  vl_two_way_splats(t, p, count, depth, splats, q);
}

void vl_show_lights(vlTracing *t, uint32_t n, const vlPaths *p, const vlLightStarts *starts,
                    vlCameraSample *views, vlSplatRows *splats, const vlTwoWayShadows *q) {
  const vlTwoWay *way = t->def->two_way;
  if (!way->eye.sees || way->light_only)
    return;
  const vlTwoWayLanes *r = t->lanes;
  vlVec3Row from = {{0}, {0}, {0}};
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++)
    vl_set_row3(&from, i, vl_row3(&r->l, p->lane[i]));
  vl_look_from(t, n, p, VL_DIM_BOUNCE, &from, views);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i], light = r->light[lane];
    if (!(starts->area_pdf[i] > 0.0f))
      continue;
    vlVec3 at = vl_row3(&r->l, lane);
    vlVec3 g = vl_row3(&r->ln, lane);
    const vlCameraSample *view = &views[i];
    float cosine = vl_dot(view->w, g);
    if (!view->seen || !(starts->side[i] * cosine >= 0.0f) || cosine == 0.0f)
      continue;
    float shown = vl_shown(way, light, starts->area_pdf[i], view->per_square, vl_abs(cosine));
    if (!(shown > 0.0f))
      continue;
    const vlWorldLight *lamp = &t->world->lights.items[light];
    const vlEmitted *emitted = &t->world->emitted.items[lamp->emitted];
    float towards = vl_spread_at(emitted, vl_abs(cosine)) / starts->share[i];
    vlVec3 o = vl_offset_origin(at, g, starts->offset[i], view->w);
    vlVec3 d = push(p, i, count, o, view->from, view->end, q);
    if (q->flights) {
      const vlWorldShape *shape = &t->world->shapes.items[lamp->shape];
      q->flights->medium[count] = vl_medium_beyond(shape, g, d, way->medium[light]);
      vl_shadow_from_medium(t, lane, count, q->flights);
      for (int c = 0; c < 4; c++)
        q->flights->density[c][count] = 1.0f;
    }
    q->strategies->own[count] = shown;
    q->strategies->others[count] = 1.0f;
    for (int c = 0; c < 4; c++)
      q->rays->radiance[c][count] =
          r->flux[c][lane] * r->density[lane] * towards * view->weight;
    splats->x[count] = view->x;
    splats->y[count] = view->y;
    count++;
  }
  vl_two_way_splats(t, p, count, LIGHT_ITSELF, splats, q);
}
