/* trace/surface/subsurface.hot.c: subsurface scattering: light that enters a surface and leaves
 * it elsewhere, with the profiles of world/material/bssrdf.h and pbrt's estimator (pbrt book,
 * 3rd edition, 15.4). This stage processes the paths that have entered a subsurface material,
 * before volume.hot.c traces them further:
 *
 *   rays, those refracted -> probes: segments through the solid near the entry -> all surfaces
 * of the material on them, one of each chosen -> exits: vlSurface, light samples, new
 * directions -> rays, with the other paths
 *
 * Half of the probes are parallel to the normal; the others are parallel to one of two
 * tangents. The hero wavelength's profile samples a probe's distance from the entry point. The
 * density of an exit point is the sum over all three directions, and is computed for each
 * wavelength. */
#include "math/fresnel.h"
#include "math/warp.h"
#include "trace/material/rows.h"
#include "trace/medium/volume.h"
#include "trace/tracer/record.h"
#include "world/material/bssrdf.h"

/* Largest number of crossings of one probe. */
enum { MOST_CROSSINGS = 1024 };

/* The entry point. */
typedef struct Entry {
  const vlBssrdfTable *table;
  vlVec3 p, n;
  float sigma[4], albedo[4];
} Entry;

static Entry entry_of(const vlTracing *t, uint32_t j) {
  const vlSubsurfaceScratch *x = t->s->subsurface;
  Entry e = {t->world->materials.items[x->material[j]].subsurface->table,
             vl_lane3(x->px, x->py, x->pz, j),
             vl_lane3(x->nx, x->ny, x->nz, j),
             {0},
             {0}};
  for (int c = 0; c < 4; c++) {
    e.sigma[c] = x->sigma[c][j];
    e.albedo[c] = x->albedo[c][j];
  }
  return e;
}

/* Copies the rays that entered a subsurface material to s->at.paths, as probes. Ray k comes
 * from vertex s->order[k]. Keeps a copy of all rays in the scratch memory. Returns the number
 * of probes.
 */
static uint32_t take_refracted(vlTracing *t, uint32_t n) {
  vlTraceScratch *s = t->s;
  vlSubsurfaceScratch *x = s->subsurface;
  const vlShade *sh = &s->at.shade;
  const vlBsdfSamples *samples = &s->samples;
  uint32_t count = 0;
  for (uint32_t k = 0; k < n; k++) {
    uint32_t i = s->order[k], material = s->at.hits.material[i];
    bool in = t->world->materials.items[material].subsurface &&
              (samples->flags[i] & VL_SAMPLED_TRANSMISSION);
    x->alive[k] = !in;
    if (!in)
      continue;
    uint32_t j = count++;
    x->place[j] = k;
    x->material[j] = material;
    x->px[j] = s->at.surface.px[i];
    x->py[j] = s->at.surface.py[i];
    x->pz[j] = s->at.surface.pz[i];
    x->nx[j] = s->at.surface.nx[i];
    x->ny[j] = s->at.surface.ny[i];
    x->nz[j] = s->at.surface.nz[i];
    for (int c = 0; c < 4; c++) {
      x->sigma[c][j] = sh->own[VL_S_SIGMA + c][i];
      x->albedo[c][j] = sh->own[VL_S_ALBEDO + c][i];
    }
    x->entry_eta_scale[j] = samples->eta_scale[i];
    x->medium[j] = s->volume->b.medium[i];
  }
  if (count == 0)
    return 0;
  x->paths = s->rays;
  x->rows = s->volume->a;
  vl_permute_paths(&x->paths, &s->at.paths, x->place, count);
  vl_volume_permute(&x->rows, &s->volume->b, x->place, count);
  for (uint32_t j = 0; j < count; j++) {
    s->volume->b.medium[j] = x->medium[j]; /* the medium outside, to which the path returns */
    s->at.paths.eta_scale[j] /= x->entry_eta_scale[j];
  }
  return count;
}

/* Sets probe j to a segment that extends `half` to either side of o. It is clipped to the
 * sphere around the world, so that ray origins are not needlessly far away. */
static void cut_probe(const vlTracing *t, uint32_t j, vlVec3 o, vlVec3 along, float half) {
  vlSubsurfaceScratch *x = t->s->subsurface;
  vlPaths *p = &t->s->at.paths;
  const float *c = t->world->center;
  float radius = 1.001f * t->world->radius;
  vlVec3 to = vl_sub(vl_vec3(c[0], c[1], c[2]), o);
  float middle = vl_dot(to, along),
        inside = radius * radius - vl_length2(vl_sub(to, vl_mul(along, middle)));
  float reach = inside > 0.0f ? __builtin_sqrtf(inside) : 0.0f;
  float start = vl_max(-half, middle - reach), end = vl_min(half, middle + reach);
  o = vl_add(o, vl_mul(along, start));
  vl_set_lane3(p->ox, p->oy, p->oz, j, o);
  vl_set_lane3(p->dx, p->dy, p->dz, j, along);
  x->length[j] = end > start ? end - start : 0.0f;
}

/* Samples the probes: origin and direction of s->at.paths, x->length (0: none). */
static void aim_probes(vlTracing *t, uint32_t n, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  vlSubsurfaceScratch *x = s->subsurface;
  vlPaths *p = &s->at.paths;
  vlNumbers *u = &s->numbers;
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_PROBE_AXIS,
                     u->u0);
  t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_PROBE,
                     u->u1, u->u2);
  for (uint32_t j = 0; j < n; j++) {
    Entry e = entry_of(t, j);
    int hero = vl_volume_hero(t, p, j);
    vlSpline albedo = vl_bssrdf_albedo(e.table, e.albedo[hero]);
    float near = vl_bssrdf_sample(e.table, &albedo, u->u1[j]),
          far = vl_bssrdf_sample(e.table, &albedo, 0.999f);
    x->length[j] = x->t_min[j] = 0.0f;
    x->found[j] = 0;
    if (!(e.sigma[hero] > 0.0f) || !(near >= 0.0f) || !(near < far))
      continue;
    vlFrame f = vl_frame_from_z(e.n);
    vlVec3 along = u->u0[j] < 0.25f ? f.x : u->u0[j] < 0.5f ? f.y : f.z;
    vlVec3 side = u->u0[j] < 0.25f ? f.y : u->u0[j] < 0.5f ? f.z : f.x;
    vlVec3 other = u->u0[j] < 0.25f ? f.z : u->u0[j] < 0.5f ? f.x : f.y;
    vlSinCos turn = vl_sincos_turn(u->u2[j]);
    float inv = 1.0f / e.sigma[hero], half = __builtin_sqrtf((far - near) * (far + near)) * inv;
    vlVec3 o =
        vl_add(vl_mul(side, near * inv * turn.cos), vl_mul(other, near * inv * turn.sin));
    if (near * inv < 4.0f * t->world->radius)
      cut_probe(t, j, vl_add(e.p, o), along, half);
  }
}

/* Where a probe from o goes on behind a crossing: behind every distance that Embree may compute
 * for it, so that it is counted once. The plane through the point gives the distance. The point
 * itself is less exact: that of a small triangle far from o has a large error within the
 * triangle's plane. The margin holds the error along the normal, which is at->offset and 32
 * roundings of the distance: of the corners relative to o, of the normal's products, of the
 * quotient. (vl_past_crossing allows for less.) */
static float past_on_probe(const vlPoint *at, vlVec3 o, vlVec3 d, float t_min) {
  const float least = 0.01f; /* of the cosine: a bound of the margin */
  float cosine = vl_dot(at->g, d), steep = vl_abs(cosine);
  float t = steep > least ? vl_dot(vl_sub(at->p, o), at->g) / cosine : at->t;
  return vl_past(t, (2.0f * at->offset + 0x1p-19f * vl_abs(at->t)) / vl_max(steep, least),
                 t_min);
}

/* Records one crossing of probe j, whose ids are in s->at.hits. Returns false if it was the
 * last crossing. */
static bool note_crossing(vlTracing *t, uint32_t j, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlSubsurfaceScratch *x = s->subsurface;
  vlHits *h = &s->at.hits;
  if (h->shape[j] == VL_NONE)
    return false;
  vlVec3 o = vl_lane3(s->at.paths.ox, s->at.paths.oy, s->at.paths.oz, j),
         d = vl_lane3(s->at.paths.dx, s->at.paths.dy, s->at.paths.dz, j);
  vlPoint at = vl_hit_point(t->world, &s->at.paths, h, j);
  if (vl_hit_material(t->world, &s->at.paths, h, j) == x->material[j]) {
    uint32_t count = ++x->found[j];
    float u =
        vl_unit_float(vl_hash2(vl_volume_key(t, &s->at.paths, j, depth, VL_KEY_PROBE), count));
    if (u * (float)count <
        1.0f) { /* reservoir sampling: each crossing is kept with the same probability */
      x->hits.shape[j] = h->shape[j];
      x->hits.prim[j] = h->prim[j];
      x->hits.instance[j] = h->instance[j];
      x->hits.t[j] = h->t[j];
    }
  }
  x->t_min[j] = past_on_probe(&at, o, d, x->t_min[j]);
  return x->t_min[j] < x->length[j];
}

/* Finds all crossings of the probes. Each batch of rays finds one crossing per probe. x->found
 * counts a probe's crossings; x->hits keeps one of them. */
static void follow_probes(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlSubsurfaceScratch *x = s->subsurface;
  const vlPaths *p = &s->at.paths;
  vlShadowRays *q = &s->shadow;
  vlHits *to = &s->hits;
  uint32_t under_way[VL_BATCH], active = 0;
  for (uint32_t j = 0; j < n; j++)
    if (x->length[j] > 0.0f)
      under_way[active++] = j;
  for (int step = 0; active > 0 && step < MOST_CROSSINGS; step++) {
    for (uint32_t k = 0; k < active; k++) {
      uint32_t j = under_way[k];
      q->ox[k] = p->ox[j];
      q->oy[k] = p->oy[j];
      q->oz[k] = p->oz[j];
      q->dx[k] = p->dx[j];
      q->dy[k] = p->dy[j];
      q->dz[k] = p->dz[j];
      x->from[k] = x->t_min[j];
      q->t_max[k] = x->length[j];
      q->time[k] = vl_path_time(p, j);
    }
    vlRays rays = {
        q->ox, q->oy, q->oz, q->dx, q->dy, q->dz, x->from, q->t_max, p->time ? q->time : NULL};
    vl_accel_closest(t->world, active, &rays, false, to->shape, to->prim, to->instance, to->t);
    t->batch->bounce_rays += active;
    uint32_t left = 0;
    for (uint32_t k = 0; k < active; k++) {
      uint32_t j = under_way[k];
      s->at.hits.shape[j] = to->shape[k];
      s->at.hits.prim[j] = to->prim[k];
      s->at.hits.instance[j] = to->instance[k];
      s->at.hits.t[j] = to->t[k];
      if (note_crossing(t, j, depth))
        under_way[left++] = j;
    }
    active = left;
  }
}

/* ---- exits
 * -------------------------------------------------------------------------------------------------------
 */

/* Copies the probes with a crossing to s->rays; x->entry has their probes. Returns their
 * number. */
static uint32_t gather_exits(vlTracing *t, uint32_t n) {
  vlTraceScratch *s = t->s;
  vlSubsurfaceScratch *x = s->subsurface;
  uint32_t count = 0;
  for (uint32_t j = 0; j < n; j++)
    if (x->found[j])
      x->entry[count++] = j;
  vl_permute_paths(&s->at.paths, &s->rays, x->entry, count);
  vl_volume_permute(&s->volume->b, &s->volume->a, x->entry, count);
  for (uint32_t i = 0; i < count; i++) {
    uint32_t j = x->entry[i];
    s->at.hits.shape[i] = x->hits.shape[j];
    s->at.hits.prim[i] = x->hits.prim[j];
    s->at.hits.instance[i] = x->hits.instance[j];
    s->at.hits.t[i] = x->hits.t[j];
    s->at.hits.material[i] = x->material[j];
  }
  if (count)
    vl_stage_surface(t->world, count, &s->rays, &s->at.hits, &s->corners, &s->at.surface);
  return count;
}

/* Computes the weight of exit i: the profile over the density of sampling the point. The hero's
 * weight goes to beta, the weights of the other wavelengths to u. A path with density 0 carries
 * no radiance. Lengths are in mean free paths of the hero wavelength. */
static void weigh_exit(vlTracing *t, uint32_t i) {
  vlTraceScratch *s = t->s;
  vlPaths *p = &s->rays;
  vlVolumeRows *rows = &s->volume->a;
  const vlSurface *f = &s->at.surface;
  uint32_t j = s->subsurface->entry[i];
  Entry e = entry_of(t, j);
  int hero = vl_volume_hero(t, p, i);
  vlFrame frame = vl_frame_from_z(e.n);
  vlVec3 d = vl_sub(vl_lane3(f->px, f->py, f->pz, i), e.p),
         g = vl_lane3(f->gx, f->gy, f->gz, i);
  float x = vl_dot(d, frame.x), y = vl_dot(d, frame.y), z = vl_dot(d, frame.z);
  const float across[3] = {__builtin_sqrtf(y * y + z * z), __builtin_sqrtf(z * z + x * x),
                           __builtin_sqrtf(x * x + y * y)};
  const float facing[3] = {0.25f * vl_abs(vl_dot(g, frame.x)),
                           0.25f * vl_abs(vl_dot(g, frame.y)),
                           0.5f * vl_abs(vl_dot(g, frame.z))};
  float r = vl_length(d), arrives[4], density[4];
  for (int c = 0; c < 4; c++) {
    float ratio = e.sigma[c] / e.sigma[hero];
    vlSpline albedo = vl_bssrdf_albedo(e.table, e.albedo[c]);
    float area = ratio * ratio, whole = vl_bssrdf_effective(e.table, &albedo), sum = 0.0f;
    arrives[c] = density[c] = 0.0f;
    if (!(e.sigma[c] > 0.0f) || !(area < 1e30f) || !(whole > 0.0f))
      continue;
    for (int k = 0; k < 3; k++)
      sum += facing[k] * vl_bssrdf_at(e.table, &albedo, across[k] * e.sigma[c]);
    arrives[c] = area * vl_bssrdf_at(e.table, &albedo, r * e.sigma[c]);
    density[c] = area * sum / whole;
  }
  float inv = density[hero] > 0.0f ? (float)s->subsurface->found[j] / density[hero] : 0.0f;
  for (int c = 0; c < 4; c++) {
    p->beta[c][i] *= arrives[c] * inv;
    rows->u[c][i] *= density[hero] > 0.0f ? density[c] / density[hero] : 1.0f;
  }
  vl_volume_normalise(t, p, rows, i);
}

/* The exit's directional factor: radiance from below is diffuse, and the share that is not
 * reflected leaves. (The factor eta^2 cancels that of the refraction at the entry.) */
static float exit_value(const vlBssrdfTable *table, float cosine) {
  float passes = 1.0f - vl_fresnel_dielectric(cosine, table->eta).reflected;
  return table->eta * table->eta * passes * VL_INV_PI / table->leaves;
}

static const vlBssrdfTable *table_at(const vlTracing *t, uint32_t i) {
  return t->world->materials.items[t->s->at.hits.material[i]].subsurface->table;
}

static bool carries(const vlPaths *p, uint32_t i) {
  return vl_max(vl_max(p->beta[0][i], p->beta[1][i]), vl_max(p->beta[2][i], p->beta[3][i])) >
         0.0f;
}

static void light_exits(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  const vlPaths *p = &s->rays;
  const vlSurface *f = &s->at.surface;
  const vlLightSamples *l = &s->light;
  vlVolumeRows *rows = &s->volume->a;
  if (t->world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, p, f, dimension, &s->light);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    vlVec3 w = vl_lane3(l->wx, l->wy, l->wz, i), g = vl_lane3(f->gx, f->gy, f->gz, i);
    float cosine = vl_dot(w, vl_lane3(f->nx, f->ny, f->nz, i));
    if (!(l->pdf[i] > 0.0f) || !(cosine > 0.0f) || !carries(p, i))
      continue;
    float v = exit_value(table_at(t, i), cosine) * cosine;
    const float value[4] = {v, v, v, v};
    vlVec3 o = vl_offset_origin(vl_lane3(f->px, f->py, f->pz, i), g, f->offset[i], w);
    const vlWorldShape *shape = &t->world->shapes.items[s->at.hits.shape[i]];
    count = vl_volume_push_shadow(t, p, rows, i, o, value, cosine * VL_INV_PI,
                                  vl_medium_beyond(shape, g, w, rows->medium[i]), count);
  }
  vl_volume_shadows(t, p, count, depth);
}

/* Samples the exits' next rays, and moves them to their paths' places. */
static void leave(vlTracing *t, uint32_t n, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  vlSubsurfaceScratch *x = s->subsurface;
  vlPaths *p = &s->rays;
  const vlSurface *f = &s->at.surface;
  vlVolumeRows *rows = &s->volume->a;
  vlNumbers *u = &s->numbers;
  t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_EXIT_UV,
                     u->u1, u->u2);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t place = x->place[x->entry[i]];
    float sum = p->beta[0][i] + p->beta[1][i] + p->beta[2][i] + p->beta[3][i];
    if (sum != sum)
      t->batch->radiance[0][p->lane[i]] = __builtin_nanf(""); /* the film drops and counts it */
    vlVec3 local = vl_warp_cosine_hemisphere(u->u1[i], u->u2[i]);
    if (!carries(p, i) || !(local.z > 0.0f))
      continue;
    vlVec3 nn = vl_lane3(f->nx, f->ny, f->nz, i), g = vl_lane3(f->gx, f->gy, f->gz, i);
    vlVec3 w = vl_normalize(vl_from_local(vl_frame_from_z(nn), local));
    vlVec3 o = vl_offset_origin(vl_lane3(f->px, f->py, f->pz, i), g, f->offset[i], w);
    float weight = exit_value(table_at(t, i), local.z) * VL_PI, pdf = local.z * VL_INV_PI;
    vl_set_lane3(p->ox, p->oy, p->oz, i, o);
    vl_set_lane3(p->dx, p->dy, p->dz, i, w);
    p->pdf[i] = pdf;
    p->specular[i] = 0;
    p->cone[i] = vl_abs(p->cone[i]);
    p->spread[i] = t->def->pixel_spread;
    vl_note_scattered(t, p->lane[i]);
    vl_set_lane3(p->from_nx, p->from_ny, p->from_nz, i, nn);
    p->from_side[i] = f->side[i];
    for (int c = 0; c < 4; c++) {
      p->beta[c][i] *= weight;
      rows->l[c][i] = rows->u[c][i] / pdf;
    }
    rows->medium[i] =
        vl_medium_beyond(&t->world->shapes.items[s->at.hits.shape[i]], g, w, rows->medium[i]);
    vl_path_copy(p, i, &x->paths, place);
    vl_volume_copy(rows, i, &x->rows, place);
    x->alive[place] = 1;
  }
}

uint32_t vl_stage_subsurface(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlSubsurfaceScratch *x = s->subsurface;
  uint32_t dimension = VL_DIM_SUBSURFACE + depth * VL_DIM_STRIDE;
  uint32_t probes = take_refracted(t, n);
  if (probes == 0)
    return n;
  aim_probes(t, probes, dimension);
  follow_probes(t, probes, depth);
  if (t->batch->recorder)
    vl_record_probes(t, probes);
  uint32_t exits = gather_exits(t, probes);
  for (uint32_t i = 0; i < exits; i++)
    weigh_exit(t, i);
  if (t->batch->recorder)
    vl_record_exits(t, exits);
  if (exits) {
    light_exits(t, exits, depth, dimension);
    leave(t, exits, dimension);
  }
  if (t->batch->recorder)
    vl_record_left(t, exits);
  uint32_t count = 0;
  for (uint32_t k = 0; k < n; k++) {
    s->order[count] = k;
    count += x->alive[k];
  }
  vl_permute_paths(&x->paths, &s->rays, s->order, count);
  vl_volume_permute(&x->rows, &s->volume->a, s->order, count);
  return count;
}

/* ---- the material
 * ------------------------------------------------------------------------------------------------
 */

/* Computes extinction and albedo for a run of lanes, either from absorption and scattering, or
 * from the reflectance of a thick solid and the mean free path. */
void vl_stage_subsurface_inputs(vlTextureRun *r, const vlWorldMaterial *m) {
  const vlWorldSubsurface *b = m->subsurface;
  vlShade *sh = &r->at->shade;
  float(*sigma)[VL_ROW_SIZE] = sh->own + VL_S_SIGMA,
  (*albedo)[VL_ROW_SIZE] = sh->own + VL_S_ALBEDO;
  const float most = 1e15f; /* per unit of length: its square is finite */
  if (b->mfp >= 0) {
    vl_rows_spectrum(r, b->mfp, sigma);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = r->first; i < r->last; i++) {
        float length = vl_max(m->scale * sigma[c][i], 1.0f / most);
        sigma[c][i] = 1.0f / length;
        albedo[c][i] = vl_bssrdf_invert(b->table, sh->reflectance[c][i]);
      }
    return;
  }
  vl_rows_spectrum(r, b->sigma_a, sigma);
  vl_rows_spectrum(r, b->sigma_s, albedo);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = r->first; i < r->last; i++) {
      float a = vl_clamp(m->scale * sigma[c][i], 0.0f, most),
            s = vl_clamp(m->scale * albedo[c][i], 0.0f, most);
      sigma[c][i] = a + s;
      albedo[c][i] = a + s > 0.0f ? vl_min(s / (a + s), 1.0f) : 0.0f;
    }
}
