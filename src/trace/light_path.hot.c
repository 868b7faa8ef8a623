/* trace/light_path.hot.c: paths from the lights. At every vertex that scatters they leave a photon and look whether the
 * eye sees them; weights as two_way.h says. BSDFs carry radiance towards the eye, so the light's paths take them the
 * other way round (Veach 1997, 5.3): no squeezing by refraction, and a correction for shading normals. */
#include "math/warp.h"
#include "trace/two_way_stages.h"

/* Longer ones would hardly live, and need memory for what they leave. */
enum { LIGHT_BOUNCES = 255 };

void VL_HOT(vl_stage_reverse)(vlTracing *t, vlTwoWayRows *r, uint32_t n, const float wi[3][VL_ROW_SIZE]) {
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  const vlSurface *f = &s->surface;
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    float x = sh->wo[0][i], y = sh->wo[1][i], z = sh->wo[2][i];
    s->light.wx[i] = x * sh->tx[i] + y * sh->bx[i] + z * f->nx[i];
    s->light.wy[i] = x * sh->ty[i] + y * sh->by[i] + z * f->ny[i];
    s->light.wz[i] = x * sh->tz[i] + y * sh->bz[i] + z * f->nz[i];
    r->wo[0][i] = x, r->wo[1][i] = y, r->wo[2][i] = z;
    float a = wi[0][i], b = wi[1][i], c = wi[2][i];
    sh->wo[0][i] = a, sh->wo[1][i] = b, sh->wo[2][i] = c;
  }
  VL_HOT(vl_stage_light_bsdf)(t, n);
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    r->rev[i] = sh->pdf[i];
    for (int k = 0; k < 3; k++) sh->wo[k][i] = r->wo[k][i];
  }
}

/* ---- setting out ------------------------------------------------------------------------------------------------- */

/* Wavelengths of the batch's paths to rows 4..7, 1 / densities to rows 8..11. */
static void wavelengths(vlTracing *t, vlTwoWayRows *r, const vlLightBatch *b) {
  const vlTwoWay *way = t->def->two_way;
  float *u = t->s->shade.u0;
  float *const lambda[4] = {r->rows[4], r->rows[5], r->rows[6], r->rows[7]};
  float *const inv_pdf[4] = {r->rows[8], r->rows[9], r->rows[10], r->rows[11]};
  t->sampler->get_1d(t->def->sampler, b->n, b->px, b->py, b->index, VL_DIM_WAVELENGTH, u);
  for (uint32_t i = 0; way->shared >= 0.0f && i < VL_PAD(b->n); i++) u[i] = way->shared;
  vl_color_kernels(t->def->isa)->visible_wavelengths(b->n, u, lambda, inv_pdf);
}

static uint32_t set_out(vlTracing *t, vlTwoWayRows *r, const vlLightBatch *b) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  vlPaths *p = &s->a;
  uint32_t n = b->n, count = 0;
  bool rgb = world->def.color == VL_COLOR_RGB;
  if (!rgb) wavelengths(t, r, b);
  float *u = s->shade.u0, *u1 = s->shade.u1, *v1 = s->shade.u2, *u2 = s->rows[0], *v2 = s->rows[1];
  t->sampler->get_1d(t->def->sampler, n, b->px, b->py, b->index, VL_DIM_TIME, u);
  t->sampler->get_2d(t->def->sampler, n, b->px, b->py, b->index, VL_DIM_FILM, u1, v1);
  t->sampler->get_2d(t->def->sampler, n, b->px, b->py, b->index, VL_DIM_LENS, u2, v2);
  p->time = s->b.time = NULL;
  for (uint32_t i = 0; i < n; i++) {
    float lambda[4];
    for (int c = 0; c < 4; c++) lambda[c] = rgb ? 0.0f : r->rows[4 + c][i];
    vlEmission e = VL_HOT(vl_emission_sample)(world, t->def->two_way, lambda, u[i], u1[i], v1[i], u2[i], v2[i]);
    float most = vl_max(vl_max(e.flux[0], e.flux[1]), vl_max(e.flux[2], e.flux[3]));
    if (!e.valid || !(most > 0.0f) || !(most < VL_INFINITY)) continue;
    uint32_t k = count++;
    p->ox[k] = e.o.x, p->oy[k] = e.o.y, p->oz[k] = e.o.z;
    p->dx[k] = e.d.x, p->dy[k] = e.d.y, p->dz[k] = e.d.z;
    p->pdf[k] = 1.0f;
    p->from_nx[k] = p->from_ny[k] = p->from_nz[k] = 0.0f;
    p->eta_scale[k] = 1.0f;
    p->cone[k] = 0.0f;
    p->specular[k] = 1;
    p->px[k] = b->px[i], p->py[k] = b->py[i], p->index[k] = b->index[i];
    p->lane[k] = i;
    for (int c = 0; c < 4; c++) {
      p->beta[c][k] = 1.0f, p->lambda[c][k] = lambda[c];
      r->flux[c][i] = e.flux[c];
    }
    r->light[i] = e.light;
    r->density[i] = e.density;
    r->carry[i] = e.delta ? 0.0f : 1.0f; /* over density and cosine: arrive() divides */
    r->lx[i] = e.at.x, r->ly[i] = e.at.y, r->lz[i] = e.at.z;
    r->lnx[i] = e.n.x, r->lny[i] = e.n.y, r->lnz[i] = e.n.z;
  }
  return count;
}

/* Density with which next event would have asked for the light that the path came from. */
static float asked(const vlWorld *world, const vlTwoWayRows *r, uint32_t lane, vlVec3 p, vlVec3 n, vlVec3 w) {
  const vlWorldLight *light = &world->lights.items[r->light[lane]];
  float pmf = vl_light_pmf(&world->tree, p, n, r->light[lane]);
  if (light->kind == VL_WL_INFINITE) return pmf * VL_HOT(vl_infinite_pdf)(world, light, p, w);
  if (light->kind != VL_WL_AREA) return pmf;
  vlPoint at;
  __builtin_memset(&at, 0, sizeof at);
  at.p = vl_vec3(r->lx[lane], r->ly[lane], r->lz[lane]);
  at.g = at.n = vl_vec3(r->lnx[lane], r->lny[lane], r->lnz[lane]);
  return pmf * VL_HOT(vl_area_pdf)(world, light, p, &at);
}

/* The n shaded lanes: a, b of the ways that begin on the light's side. */
static void arrive(vlTracing *t, vlTwoWayRows *r, uint32_t n, uint32_t depth) {
  const vlSurface *f = &t->s->surface;
  const vlPaths *p = &t->s->b;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    vlVec3 w = vl_neg(vl_lane3(p->dx, p->dy, p->dz, i));
    float cosine = vl_abs(vl_dot(w, vl_lane3(f->gx, f->gy, f->gz, i)));
    float inv = cosine > 0.0f ? 1.0f / cosine : 0.0f;
    r->cosine[i] = cosine;
    r->b[i] = 0.0f;
    if (depth == 0) {
      vlWorldLightKind kind = t->world->lights.items[r->light[lane]].kind;
      float density = r->density[lane], d = f->t[i];
      if (kind == VL_WL_POINT || kind == VL_WL_SPOT) density /= d * d;
      inv = density > 0.0f ? inv / density : 0.0f;
      r->b[i] = inv * asked(t->world, r, lane, vl_lane3(f->px, f->py, f->pz, i), vl_lane3(f->nx, f->ny, f->nz, i), w);
    }
    r->a[i] = r->carry[lane] * inv;
  }
}

/* ---- what they leave --------------------------------------------------------------------------------------------- */

static void leave_photons(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, uint32_t n, uint32_t depth) {
  const vlPaths *p = &t->s->b;
  const vlSurface *f = &t->s->surface;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (vl_all_specular(t->world, t->s, i) || !(r->cosine[i] > 0.0f)) continue;
    vlPhoton *x = &r->photons[count];
    uint32_t lane = p->lane[i];
    x->p[0] = f->px[i], x->p[1] = f->py[i], x->p[2] = f->pz[i];
    x->w[0] = -p->dx[i], x->w[1] = -p->dy[i], x->w[2] = -p->dz[i];
    float inv = 1.0f / r->cosine[i], sum = 0.0f;
    for (int c = 0; c < 4; c++) sum += x->power[c] = p->beta[c][i] * r->flux[c][lane] * inv;
    x->a = r->a[i], x->b = r->b[i];
    x->bounce = depth + 1;
    x->id = ((uint32_t)p->py[i] * b->width + (uint32_t)p->px[i]);
    x->alone = vl_hero_alone(p, i);
    x->unused = 0;
    count += sum > 0.0f && sum < VL_INFINITY;
  }
  if (count) b->store(b->user, count, r->photons);
}

/* Where the eye would see the point from a point on its lens. */
typedef struct Sight {
  bool seen;
  vlVec3 w;         /* towards it */
  vlVec3 from;      /* where on the lens */
  float x, y;       /* film */
  float end;        /* distance to the near plane's side of the ray */
  float per_square; /* 1 / (solid angle of a pixel * distance squared) */
} Sight;

static Sight look(const vlEyeView *eye, vlVec3 p, float u, float v) {
  Sight r;
  __builtin_memset(&r, 0, sizeof r);
  r.from = eye->position;
  float lx = 0.0f, ly = 0.0f;
  if (eye->lens_radius > 0.0f) {
    vlDiskPoint lens = vl_warp_disk(u, v);
    lx = eye->lens_radius * lens.x, ly = eye->lens_radius * lens.y;
    r.from = vl_add(r.from, vl_add(vl_mul(eye->right, lx), vl_mul(eye->down, ly)));
  }
  vlVec3 to = vl_sub(p, r.from);
  float x = vl_dot(to, eye->right), y = vl_dot(to, eye->down), z = vl_dot(to, eye->ahead);
  if (!(z > 0.0f) || z < eye->near_plane || z > eye->far_plane) return r;
  float d2 = vl_length2(to), d = __builtin_sqrtf(d2), c = z / d;
  float inv = 1.0f / z, bend = eye->lens_radius > 0.0f ? 1.0f / eye->focus : 0.0f;
  r.x = eye->cx + eye->fx * (x * inv + lx * bend);
  r.y = eye->cy + eye->fy * (y * inv + ly * bend);
  r.seen = r.x > eye->low_x && r.x < eye->high_x && r.y > eye->low_y && r.y < eye->high_y;
  r.w = vl_mul(to, -1.0f / d);
  r.per_square = 1.0f / (vl_eye_pixel(eye, c) * d2);
  r.end = 1.0f - eye->near_plane * inv;
  return r;
}

/* Those that the eye sees become splats. wi: rows for directions. */
static void show(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, uint32_t n, uint32_t dimension) {
  const vlTwoWay *way = t->def->two_way;
  const vlEyeView *eye = &way->eye;
  if (!eye->sees) return;
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  const vlSurface *f = &s->surface;
  const vlPaths *p = &s->b;
  vlShadowRays *q = &s->shadow;
  if (eye->lens_radius > 0.0f)
    t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_LIGHT_UV, sh->u1, sh->u2);
  float(*wi)[VL_ROW_SIZE] = s->rows; /* the textures' stack is free */
  float *per_square = s->rows[3], *end = s->rows[4];
  float *fx = s->rows[5], *fy = s->rows[6], *fz = s->rows[7];
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    Sight sight = look(eye, vl_lane3(f->px, f->py, f->pz, i), sh->u1[i], sh->u2[i]);
    vlVec3 w = sight.w;
    wi[0][i] = w.x * sh->tx[i] + w.y * sh->ty[i] + w.z * sh->tz[i];
    wi[1][i] = w.x * sh->bx[i] + w.y * sh->by[i] + w.z * sh->bz[i];
    wi[2][i] = vl_dot(w, vl_lane3(f->nx, f->ny, f->nz, i));
    float cosine = vl_abs(vl_dot(w, vl_lane3(f->gx, f->gy, f->gz, i)));
    per_square[i] = sight.seen ? cosine * sight.per_square : 0.0f; /* density of the eye's first vertex here */
    end[i] = sight.end;
    r->x[i] = sight.x, r->y[i] = sight.y;
    fx[i] = sight.from.x, fy[i] = sight.from.y, fz[i] = sight.from.z;
  }
  VL_HOT(vl_stage_reverse)(t, r, n, (const float(*)[VL_ROW_SIZE])wi);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    float sum = sh->value[0][i] + sh->value[1][i] + sh->value[2][i] + sh->value[3][i];
    if (!(per_square[i] > 0.0f) || !(sum > 0.0f) || !(r->cosine[i] > 0.0f)) continue;
    float others = way->light_only ? 0.0f : way->merged + r->a[i] * r->rev[i] + r->b[i];
    float own = way->paths / per_square[i]; /* S_1: this way, over P_1 L_1 as the others */
    float scale = 1.0f / (r->cosine[i] * (own + others));
    vlVec3 at = vl_lane3(f->px, f->py, f->pz, i), target = vl_vec3(fx[i], fy[i], fz[i]);
    vlVec3 o = vl_offset_origin(at, vl_lane3(f->gx, f->gy, f->gz, i), f->offset[i], vl_sub(target, at));
    q->ox[count] = o.x, q->oy[count] = o.y, q->oz[count] = o.z;
    q->dx[count] = target.x - o.x, q->dy[count] = target.y - o.y, q->dz[count] = target.z - o.z;
    q->t_max[count] = vl_min(end[i], VL_ONE_MINUS_EPSILON);
    uint32_t lane = p->lane[i];
    for (int c = 0; c < 4; c++) q->radiance[c][count] = p->beta[c][i] * r->flux[c][lane] * sh->value[c][i] * scale;
    r->x[count] = r->x[i], r->y[count] = r->y[i];
    q->lane[count++] = lane;
  }
  vlRays rays = {q->ox, q->oy, q->oz, q->dx, q->dy, q->dz, NULL, q->t_max, NULL};
  vl_accel_occluded(t->world, count, &rays, q->occluded);
  b->shadow_rays += count;
  float *value[4], *lambda[4], *inv_pdf[4];
  for (int c = 0; c < 4; c++) value[c] = r->rows[c], lambda[c] = s->rows[c], inv_pdf[c] = s->rows[4 + c];
  uint32_t visible = 0;
  for (uint32_t k = 0; k < count; k++) {
    if (q->occluded[k]) continue;
    uint32_t lane = q->lane[k], m = visible++;
    r->x[m] = r->x[k], r->y[m] = r->y[k];
    for (int c = 0; c < 4; c++) {
      value[c][m] = q->radiance[c][k];
      lambda[c][m] = r->rows[4 + c][lane], inv_pdf[c][m] = r->rows[8 + c][lane];
    }
  }
  if (visible) b->splat(b->user, visible, r->x, r->y, value, lambda, inv_pdf);
}

/* ---- onwards ----------------------------------------------------------------------------------------------------- */

static uint32_t scatter(vlTracing *t, vlTwoWayRows *r, uint32_t n, uint32_t depth, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  const vlSurface *f = &s->surface;
  const vlPaths *p = &s->b;
  uint32_t count = VL_HOT(vl_stage_scatter)(t, n, depth + 1, dimension);
  float(*wi)[VL_ROW_SIZE] = s->rows + 1;
  float *ns = s->rows[4]; /* |wo . shading normal| over |wi . it| */
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    for (int k = 0; k < 3; k++) wi[k][i] = sh->wi[k][i];
    r->pdf[i] = sh->pdf[i];
    float z = vl_abs(sh->wi[2][i]);
    ns[i] = z > 0.0f ? vl_abs(sh->wo[2][i]) / z : 0.0f;
  }
  VL_HOT(vl_stage_reverse)(t, r, n, (const float(*)[VL_ROW_SIZE])wi);
  float merged = t->def->two_way->merged;
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = s->order[k], lane = s->a.lane[k];
    float cosine = vl_abs(vl_dot(vl_lane3(p->dx, p->dy, p->dz, i), vl_lane3(f->gx, f->gy, f->gz, i)));
    float pdf = r->pdf[i];
    r->carry[lane] = sh->flags[i] & VL_SAMPLED_SPECULAR
                         ? r->a[i] * cosine
                         : (pdf > 0.0f ? (r->a[i] * r->rev[i] + r->b[i] + merged) * cosine / pdf : 0.0f);
    float turn = r->cosine[i] > 0.0f ? ns[i] * cosine / r->cosine[i] * sh->eta_scale[i] : 0.0f;
    for (int c = 0; c < 4; c++) s->a.beta[c][k] *= turn;
    s->a.eta_scale[k] = 1.0f;
  }
  return count;
}

void VL_HOT(vl_light_tracer)(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch, vlTwoWayRows *r,
                             vlLightBatch *batch) {
  vlTraceDef own = *def;
  own.sampler = &def->two_way->sampler;
  own.pixel_spread = own.pixel_width = 0.0f; /* textures in full */
  vlTraceBatch rest;                         /* of the stages' own: light that interfaces give, counts */
  __builtin_memset(&rest, 0, sizeof rest);
  rest.n = batch->n;
  for (int c = 0; c < 4; c++) rest.radiance[c] = r->rows[c];
  vlTracing t = {world, &own, scratch, &rest, vl_sampler_kernels(def->isa), vl_bsdf_kernels(def->isa)};
  uint32_t n = set_out(&t, r, batch), most = def->max_depth < LIGHT_BOUNCES ? def->max_depth : LIGHT_BOUNCES;
  for (uint32_t depth = 0; n > 0 && depth < most; depth++) {
    VL_HOT(vl_stage_hits)(&t, n, false);
    n = VL_HOT(vl_stage_sort)(&t, n);
    if (n == 0) break;
    uint32_t dimension = VL_DIM_BOUNCE + depth * VL_DIM_STRIDE;
    VL_HOT(vl_stage_shade)(&t, n);
    arrive(&t, r, n, depth);
    if (def->two_way->merge) leave_photons(&t, r, batch, n, depth);
    show(&t, r, batch, n, dimension);
    if (depth + 1 == most) break;
    n = scatter(&t, r, n, depth, dimension);
  }
  batch->bounce_rays += rest.bounce_rays;
  batch->shadow_rays += rest.shadow_rays;
}
