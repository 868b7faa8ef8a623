/* trace/two_way/splat.hot.c: connections of light paths to the camera: the film point of each
 * vertex, the radiance that arrives there, and its weight against the other strategies
 * (two_way.h).
 */
#include "math/warp.h"
#include "trace/two_way/stages.h"

/* In place of the number of bounces, for the random numbers of media: differs from that of any
 * vertex. */
enum { LIGHT_ITSELF = 1 << 16 };

vlCameraSample vl_sample_camera(const vlCameraView *eye, vlVec3 p, float u, float v) {
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

void vl_look_from(const vlTracing *t, vlTwoWayRows *rows, uint32_t n, const float *x,
                  const float *y, const float *z) {
  const vlCameraView *eye = &t->def->two_way->eye;
  if (eye->look)
    eye->look(eye, n, x, y, z, rows->views);
}

/* A point of each camera ray is looked at from the camera. Where that gives the sample's own
 * pixel and ray again, light paths are connected there by the same functions, so both sides
 * know the same density. Elsewhere they are not: `pixels` may leave out what `rays` sees. */
void vl_measure_camera_rays(const vlTracing *t) {
  const vlCameraView *eye = &t->def->two_way->eye;
  const vlTraceBatch *b = t->batch;
  vlTwoWayRows *r = b->two_way;
  if (!eye->look)
    return;
  float *x = r->rows[0], *y = r->rows[1], *z = r->rows[2];
  for (uint32_t i = 0; i < b->n; i++) {
    vlVec3 o = vl_lane3(b->ox, b->oy, b->oz, i);
    float far = 1.0f + vl_length(o); /* rounding of the point is small against the distance */
    vl_set_lane3(x, y, z, i, vl_add(o, vl_mul(vl_lane3(b->dx, b->dy, b->dz, i), far)));
  }
  vl_look_from(t, r, b->n, x, y, z);
  for (uint32_t i = 0; i < b->n; i++) {
    const vlCameraSample *v = &r->views[i];
    vlVec3 o = vl_lane3(b->ox, b->oy, b->oz, i), d = vl_lane3(b->dx, b->dy, b->dz, i);
    bool same = v->seen && vl_abs(v->x - (float)b->px[i] - 0.5f) <= eye->reach_x &&
                vl_abs(v->y - (float)b->py[i] - 0.5f) <= eye->reach_y &&
                vl_length2(vl_add(v->w, d)) < 1e-6f &&
                vl_length(vl_sub(v->from, o)) <= 1e-5f * (1.0f + vl_length(o));
    for (int k = 0; k < 3; k++)
      r->area[k][i] = same ? v->area[k] : 0.0f;
  }
}

bool vl_two_way_arrives(const vlTracing *t, vlTwoWayRows *r, uint32_t k, float passes[4],
                        float *scale) {
  vlTraceScratch *s = t->s;
  float odds = 1.0f, mean = 1.0f;
  for (int c = 0; c < 4; c++)
    passes[c] = 1.0f;
  if (s->shadow.occluded[k])
    return false;
  if (vl_has_media(t)) {
    const vlVolumeScratch *v = s->volume;
    float density[4];
    for (int c = 0; c < 4; c++) {
      passes[c] = v->shadow_beta[c][k];
      density[c] = v->density[c][k] * v->shadow_l[c][k];
    }
    odds = v->shadow_odds[k];
    mean = vl_flight_mean(density, vl_volume_rgb(t) ? 3 : 4);
    if (!(vl_max(vl_max(passes[0], passes[1]), vl_max(passes[2], passes[3])) > 0.0f))
      return false;
  }
  r->others[k] *= odds;
  *scale = 1.0f / ((r->own[k] + r->others[k]) * mean);
  return true;
}

void vl_two_way_splats(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, const vlPaths *p,
                       uint32_t count, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlShadowRays *q = &s->shadow;
  vl_stage_occluded(t, count, p, q);
  b->shadow_rays += count;
  if (vl_has_media(t))
    vl_volume_pass_media(t, p, count, depth);
  float *value[4], *lambda[4], *inv_pdf[4];
  for (int c = 0; c < 4; c++) {
    value[c] = r->rows[c];
    lambda[c] = r->splat_lambda[c];
    inv_pdf[c] = r->splat_inv_pdf[c];
  }
  uint32_t visible = 0;
  for (uint32_t k = 0; k < count; k++) {
    float passes[4], scale;
    if (!vl_two_way_arrives(t, r, k, passes, &scale))
      continue;
    uint32_t lane = q->lane[k], m = visible++;
    r->x[m] = r->x[k];
    r->y[m] = r->y[k];
    r->others[m] = r->others[k] / r->own[k];
    for (int c = 0; c < 4; c++) {
      value[c][m] = q->radiance[c][k] * passes[c] * scale;
      lambda[c][m] = r->rows[4 + c][lane];
      inv_pdf[c][m] = r->rows[8 + c][lane];
    }
  }
  if (visible)
    b->splat(b->user, visible, r->x, r->y, r->others, value, lambda, inv_pdf);
}

/* Adds shadow ray `count` of surface lane i, to the point `target` on the lens. */
static void push(vlTracing *t, uint32_t i, uint32_t count, vlVec3 target, float end,
                 float wi_z) {
  vlTraceScratch *s = t->s;
  const vlSurface *f = &s->at.surface;
  vlShadowRays *q = &s->shadow;
  vlVec3 at = vl_lane3(f->px, f->py, f->pz, i), g = vl_lane3(f->gx, f->gy, f->gz, i);
  vlVec3 o = vl_offset_origin(at, g, f->offset[i], vl_sub(target, at));
  vlVec3 d = vl_sub(target, o);
  vl_set_lane3(q->ox, q->oy, q->oz, count, o);
  q->t_max[count] = vl_min(end, VL_ONE_MINUS_EPSILON);
  if (vl_has_media(t)) { /* unit length: distances to interfaces on the way are needed */
    vlVolumeScratch *v = s->volume;
    q->t_max[count] = vl_min(end, 1.0f - 0x1p-21f) * vl_length(d);
    d = vl_normalize(d);
    v->shadow_medium[count] =
        vl_medium_beyond(&t->world->shapes.items[s->at.hits.shape[i]], g, d, v->b.medium[i]);
    v->from[count] = i;
    vl_shadow_from_surface(t, count, i, wi_z);
    for (int c = 0; c < 4; c++)
      v->density[c][count] = v->b.u[c][i];
  }
  vl_set_lane3(q->dx, q->dy, q->dz, count, d);
  q->time[count] = vl_path_time(&s->at.paths, i);
  q->lane[count] = s->at.paths.lane[i];
}

void vl_connect_to_camera(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, uint32_t n,
                          uint32_t depth, uint32_t dimension) {
  const vlTwoWay *way = t->def->two_way;
  if (!way->eye.sees)
    return;
  if (way->alone && depth == 0)
    return; /* the camera sees a highlight: no random direction leads there */
  vlTraceScratch *s = t->s;
  const vlShade *sh = &s->at.shade;
  vlNumbers *u = &s->numbers;
  const vlSurface *f = &s->at.surface;
  const vlPaths *p = &s->at.paths;
  vlShadowRays *q = &s->shadow;
  if (way->eye.lens_radius > 0.0f)
    t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_LIGHT_UV,
                       u->u1, u->u2);
  vl_look_from(t, r, n, f->px, f->py, f->pz);
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    uint32_t k = i < n ? i : n - 1, lane = p->lane[k];
    vlCameraSample view =
        vl_view_of(t, r, k, lane, vl_lane3(f->px, f->py, f->pz, i), u->u1[i], u->u2[i]);
    vlVec3 w = view.w;
    r->wi[0][i] = w.x * sh->tx[i] + w.y * sh->ty[i] + w.z * sh->tz[i];
    r->wi[1][i] = w.x * sh->bx[i] + w.y * sh->by[i] + w.z * sh->bz[i];
    r->wi[2][i] = vl_dot(w, vl_lane3(f->nx, f->ny, f->nz, i));
    float cosine = vl_abs(vl_dot(w, vl_lane3(f->gx, f->gy, f->gz, i)));
    r->per_square[i] = view.seen ? cosine * view.per_square
                                 : 0.0f; /* density of the camera path's first vertex here */
    r->end[i] = view.end;
    r->weight[i] = view.weight;
    r->x[i] = view.x;
    r->y[i] = view.y;
    vl_set_lane3(r->eye[0], r->eye[1], r->eye[2], i, view.from);
  }
  vl_stage_reverse(t, n, &s->at, (const float(*)[VL_ROW_SIZE])r->wi, &r->back);
  const float(*value)[VL_ROW_SIZE] = (const float(*)[VL_ROW_SIZE])r->back.value;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    float sum = value[0][i] + value[1][i] + value[2][i] + value[3][i];
    if (!(r->per_square[i] > 0.0f) || !(sum > 0.0f) || !(r->cosine[i] > 0.0f))
      continue;
    push(t, i, count, vl_lane3(r->eye[0], r->eye[1], r->eye[2], i), r->end[i], r->wi[2][i]);
    r->others[count] =
        way->light_only ? 0.0f : way->merged + r->a[i] * r->back.pdf[i] + r->b[i];
    r->own[count] = way->paths / r->per_square[i]; /* S_1: density of this strategy, divided by
                                                      P_1 L_1 like the others */
    uint32_t lane = p->lane[i];
    float inv = 1.0f / r->cosine[i];
    for (int c = 0; c < 4; c++)
      q->radiance[c][count] =
          p->beta[c][i] * r->flux[c][lane] * value[c][i] * inv * r->weight[i];
    r->x[count] = r->x[i];
    r->y[count] = r->y[i];
    count++;
  }
  vl_two_way_splats(t, r, b, p, count, depth);
}

void vl_show_lights(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, uint32_t n) {
  const vlTwoWay *way = t->def->two_way;
  if (!way->eye.sees || way->light_only)
    return;
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  vlNumbers *u = &s->numbers;
  const vlPaths *p = &s->rays;
  vlShadowRays *q = &s->shadow;
  if (way->eye.lens_radius > 0.0f)
    t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index,
                       VL_DIM_BOUNCE + VL_DIM_LIGHT_UV, u->u1, u->u2);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    vl_set_lane3(r->rows[0], r->rows[1], r->rows[2], i, vl_lane3(r->lx, r->ly, r->lz, lane));
  }
  vl_look_from(t, r, n, r->rows[0], r->rows[1], r->rows[2]);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    uint32_t light = r->light[lane];
    if (!(r->a[i] > 0.0f))
      continue;
    vlVec3 at = vl_lane3(r->lx, r->ly, r->lz, lane);
    vlVec3 g = vl_lane3(r->lnx, r->lny, r->lnz, lane);
    vlCameraSample view = vl_view_of(t, r, i, lane, at, u->u1[i], u->u2[i]);
    float cosine = vl_dot(view.w, g);
    if (!view.seen || !(r->cosine[i] * cosine >= 0.0f) || cosine == 0.0f)
      continue;
    float shown = vl_shown(way, light, r->a[i], view.per_square, vl_abs(cosine));
    if (!(shown > 0.0f))
      continue;
    vlVec3 o = vl_offset_origin(at, g, r->b[i], view.w);
    vlVec3 d = vl_sub(view.from, o);
    q->t_max[count] = vl_min(view.end, VL_ONE_MINUS_EPSILON);
    if (vl_has_media(t)) {
      const vlWorldShape *shape = &t->world->shapes.items[t->world->lights.items[light].shape];
      q->t_max[count] = vl_min(view.end, VL_SHADOW_END) * vl_length(d);
      d = vl_normalize(d);
      v->shadow_medium[count] = vl_medium_beyond(shape, g, d, way->medium[light]);
      v->from[count] = i;
      vl_shadow_from_medium(t, count, lane);
      for (int c = 0; c < 4; c++)
        v->density[c][count] = 1.0f;
    }
    vl_set_lane3(q->ox, q->oy, q->oz, count, o);
    vl_set_lane3(q->dx, q->dy, q->dz, count, d);
    q->time[count] = vl_path_time(p, i);
    q->lane[count] = lane;
    r->own[count] = shown;
    r->others[count] = 1.0f;
    for (int c = 0; c < 4; c++)
      q->radiance[c][count] = r->flux[c][lane] * r->density[lane] * view.weight;
    r->x[count] = view.x;
    r->y[count] = view.y;
    count++;
  }
  vl_two_way_splats(t, r, b, p, count, LIGHT_ITSELF);
}
