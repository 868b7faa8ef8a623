/* trace/surface/subsurface.hot.c: subsurface scattering: light that enters a surface and leaves
 * it elsewhere, with the profiles of material/bssrdf.h and pbrt's estimator (pbrt book,
 * 3rd edition, 15.4). This stage processes the paths that have entered a subsurface material,
 * before volume.hot.c traces them further:
 *
 *   rays, those refracted -> probes: segments through the solid near the entry -> all surfaces
 *     of the material on them, one of each chosen -> exits: vlSurface, light samples, new
 *     directions -> rays, with the other paths
 *
 * Half of the probes are parallel to the normal; the others are parallel to one of two
 * tangents. The hero wavelength's profile samples a probe's distance from the entry point. The
 * density of an exit point is the sum over all three directions, and is computed for each
 * wavelength. */
#include "material/bssrdf.h"
#include "material/inputs.hot.h"
#include "math/fresnel.h"
#include "math/warp.h"
#include "trace/medium/volume.h"
#include "trace/surface/probes.h"
#include "tracer/record.h"

/* Largest number of crossings of one probe. */
enum { MAX_CROSSINGS = 1024 };

/* One entry. */
typedef struct Entry {
  const vlBssrdfTable *table;
  vlVec3 p, n;
  float sigma[4], albedo[4];
} Entry;

static Entry entry_of(const vlWorld *world, const vlEntries *x, uint32_t j) {
  Entry e = {world->materials.items[x->material[j]].subsurface->table,
             vl_row3(&x->p, j),
             vl_row3(&x->n, j),
             {0},
             {0}};
  for (int c = 0; c < 4; c++) {
    e.sigma[c] = x->sigma[c][j];
    e.albedo[c] = x->albedo[c][j];
  }
  return e;
}

/* Finds those of the n rays that entered a subsurface material; ray k comes from vertex
 * order[k]. alive: by ray, 1 for the others. Returns the number of entries. */
static uint32_t find_entries(const vlWorld *world, uint32_t n, const vlVertices *at,
                             const vlBsdfSamples *samples, const uint32_t *order, vlEntries *to,
                             uint8_t *alive) {
  const vlSurface *f = &at->surface;
  const vlShade *sh = &at->shade;
  uint32_t count = 0;
  for (uint32_t k = 0; k < n; k++) {
    uint32_t i = order[k], material = at->hits.material[i];
    bool in = world->materials.items[material].subsurface &&
              (samples->flags[i] & VL_SAMPLED_TRANSMISSION);
    alive[k] = !in;
    if (!in)
      continue;
    uint32_t j = count++;
    to->path[j] = k;
    to->material[j] = material;
    vl_set_row3(&to->p, j, vl_row3(&f->p, i));
    vl_set_row3(&to->n, j, vl_row3(&f->n, i));
    for (int c = 0; c < 4; c++) {
      to->sigma[c][j] = sh->own[VL_S_SIGMA + c][i];
      to->albedo[c][j] = sh->own[VL_S_ALBEDO + c][i];
    }
  }
  return count;
}

/* Starts the paths of n probes, which are those of the entries. rows has what the vertices have
 * in media, and gets the same of the probes. */
static void start_probes(uint32_t n, const vlPaths *rays, const vlVolumeRows *ray_rows,
                         const vlEntries *x, const vlBsdfSamples *samples,
                         const uint32_t *order, vlPaths *probes, vlVolumeRows *rows) {
  uint32_t outside[VL_ROW_SIZE]; /* the medium to which the path returns */
  for (uint32_t j = 0; j < n; j++)
    outside[j] = rows->medium[order[x->path[j]]];
  vl_permute_paths(rays, probes, x->path, n);
  vl_volume_permute(ray_rows, rows, x->path, n);
  for (uint32_t j = 0; j < n; j++) {
    rows->medium[j] = outside[j];
    probes->eta_scale[j] /= samples->eta_scale[order[x->path[j]]];
  }
}

/* Sets the segment of probe j, which extends `half` to either side of o. It is clipped to the
 * sphere around the world, so that ray origins are not needlessly far away. Returns its length.
 */
static float cut_probe(const vlWorld *world, vlPaths *p, uint32_t j, vlVec3 o, vlVec3 along,
                       float half) {
  const float *c = world->center;
  float radius = 1.001f * world->radius;
  vlVec3 to = vl_sub(vl_load3(c), o);
  float middle = vl_dot(to, along),
        inside = radius * radius - vl_length2(vl_sub(to, vl_mul(along, middle)));
  float reach = inside > 0.0f ? __builtin_sqrtf(inside) : 0.0f;
  float start = vl_max(-half, middle - reach), end = vl_min(half, middle + reach);
  o = vl_add(o, vl_mul(along, start));
  vl_set_row3(&p->o, j, o);
  vl_set_row3(&p->d, j, along);
  return end > start ? end - start : 0.0f;
}

/* Samples the n probes: origins and directions of p, and lengths. */
static void aim_probes(const vlTracing *t, uint32_t n, uint32_t dimension, const vlEntries *x,
                       vlPaths *p, float *length) {
  vlNumbers u;
  vl_draw_1d(t, n, p, dimension + VL_DIM_PROBE_AXIS, u.u0);
  vl_draw_2d(t, n, p, dimension + VL_DIM_PROBE, u.u1, u.u2);
  for (uint32_t j = 0; j < n; j++) {
    Entry e = entry_of(t->world, x, j);
    int hero = vl_volume_hero(t, p, j);
    vlSpline albedo = vl_bssrdf_albedo(e.table, e.albedo[hero]);
    float near = vl_bssrdf_sample(e.table, &albedo, u.u1[j]),
          far = vl_bssrdf_sample(e.table, &albedo, 0.999f);
    length[j] = 0.0f;
    if (!(e.sigma[hero] > 0.0f) || !(near >= 0.0f) || !(near < far))
      continue;
    vlFrame f = vl_frame_from_z(e.n);
    vlVec3 along = u.u0[j] < 0.25f ? f.x : u.u0[j] < 0.5f ? f.y : f.z;
    vlVec3 side = u.u0[j] < 0.25f ? f.y : u.u0[j] < 0.5f ? f.z : f.x;
    vlVec3 other = u.u0[j] < 0.25f ? f.z : u.u0[j] < 0.5f ? f.x : f.y;
    vlSinCos turn = vl_sincos_turn(u.u2[j]);
    float inv = 1.0f / e.sigma[hero], half = __builtin_sqrtf((far - near) * (far + near)) * inv;
    vlVec3 o =
        vl_add(vl_mul(side, near * inv * turn.cos), vl_mul(other, near * inv * turn.sin));
    if (near * inv < 4.0f * t->world->radius)
      length[j] = cut_probe(t->world, p, j, vl_add(e.p, o), along, half);
  }
}

/* Where a probe from o goes on behind a crossing: behind every distance that Embree may compute
 * for it, so that it is counted once. The plane through the point gives the distance. The point
 * itself is less exact: that of a small triangle far from o has a large error within the
 * triangle's plane. The margin holds the error along the normal, which is at->offset and 32
 * roundings of the distance: of the corners relative to o, of the normal's products, of the
 * quotient. (vl_past_crossing allows for less.) */
static float past_on_probe(const vlPoint *at, vlVec3 o, vlVec3 d, float t_min) {
  const float min = 0.01f; /* of the cosine: a bound of the margin */
  float cosine = vl_dot(at->g, d), steep = vl_abs(cosine);
  float t = steep > min ? vl_dot(vl_sub(at->p, o), at->g) / cosine : at->t;
  return vl_past(t, (2.0f * at->offset + 0x1p-19f * vl_abs(at->t)) / vl_max(steep, min), t_min);
}

/* Counts the crossing `met` of probe j, and may choose it. Returns where the probe goes on. */
static float note_crossing(const vlTracing *t, uint32_t j, uint32_t depth, const vlEntries *x,
                           const vlPaths *p, const vlHits *met, float t_min, vlProbes *to) {
  vlVec3 o = vl_row3(&p->o, j), d = vl_row3(&p->d, j);
  vlPoint at = vl_hit_point(t->world, p, met, j);
  if (vl_hit_material(t->world, p, met, j) == x->material[j]) {
    uint32_t count = ++to->found[j];
    float u = vl_unit_float(vl_hash2(vl_volume_key(t, p, j, depth, VL_KEY_PROBE), count));
    /* reservoir sampling: each crossing is kept with the same probability */
    if (u * (float)count < 1.0f)
      vl_hit_copy(met, j, &to->chosen, j);
  }
  return past_on_probe(&at, o, d, t_min);
}

/* Finds all crossings of the n probes. Each batch of rays finds one crossing per probe. q,
 * hits, met: memory for the rays and what they hit, by ray and by probe. */
static void follow_probes(vlTracing *t, uint32_t n, uint32_t depth, const vlEntries *x,
                          const vlPaths *p, vlProbes *to, vlShadowRays *q, vlHits *hits,
                          vlHits *met) {
  vlFloatRow from, t_min;
  uint32_t under_way[VL_BATCH], active = 0;
  for (uint32_t j = 0; j < n; j++) {
    t_min[j] = 0.0f;
    to->found[j] = 0;
    if (to->length[j] > 0.0f)
      under_way[active++] = j;
  }
  for (int step = 0; active > 0 && step < MAX_CROSSINGS; step++) {
    for (uint32_t k = 0; k < active; k++) {
      uint32_t j = under_way[k];
      vl_set_row3(&q->o, k, vl_row3(&p->o, j));
      vl_set_row3(&q->d, k, vl_row3(&p->d, j));
      from[k] = t_min[j];
      q->t_max[k] = to->length[j];
      q->time[k] = vl_path_time(p, j);
    }
    vlRays rays = vl_rays_of(&q->o, &q->d, 0, from, q->t_max, p->time ? q->time : NULL);
    vl_accel_closest(t->world, active, &rays, false, hits->shape, hits->prim, hits->instance,
                     hits->t);
    t->batch->bounce_rays += active;
    uint32_t left = 0;
    for (uint32_t k = 0; k < active; k++) {
      uint32_t j = under_way[k];
      if (hits->shape[k] == VL_NONE)
        continue;
      vl_hit_copy(hits, k, met, j);
      t_min[j] = note_crossing(t, j, depth, x, p, met, t_min[j], to);
      if (t_min[j] < to->length[j])
        under_way[left++] = j;
    }
    active = left;
  }
}

/* ---- exits ------------------------------------------------------------------------------- */

/* Copies the probes with a crossing to the paths of exits, and computes their surfaces. probe:
 * by exit, its probe. Returns their number. */
static uint32_t gather_exits(const vlWorld *world, uint32_t n, const vlEntries *x,
                             const vlProbes *probes, const vlPaths *from,
                             const vlVolumeRows *from_rows, uint32_t *probe, vlPaths *exits,
                             vlVolumeRows *rows, vlHits *hits, vlCorners *corners,
                             vlSurface *surface) {
  const vlHits *chosen = &probes->chosen;
  uint32_t count = 0;
  for (uint32_t j = 0; j < n; j++)
    if (probes->found[j])
      probe[count++] = j;
  vl_permute_paths(from, exits, probe, count);
  vl_volume_permute(from_rows, rows, probe, count);
  for (uint32_t i = 0; i < count; i++) {
    uint32_t j = probe[i];
    vl_hit_copy(chosen, j, hits, i);
    hits->material[i] = x->material[j];
  }
  if (count)
    vl_stage_surface(world, count, exits, hits, corners, surface);
  return count;
}

/* Applies the weight of exit i, whose probe has `found` crossings: the profile over the density
 * of sampling the point. The hero's weight goes to beta, the weights of the other wavelengths
 * to u. A path with density 0 carries no radiance. Lengths are in mean free paths of the hero
 * wavelength. */
static void weigh_exit(const vlTracing *t, uint32_t i, const Entry *entry, uint32_t found,
                       const vlSurface *f, vlPaths *p, vlVolumeRows *rows) {
  const Entry e = *entry;
  int hero = vl_volume_hero(t, p, i);
  vlFrame frame = vl_frame_from_z(e.n);
  vlVec3 d = vl_sub(vl_row3(&f->p, i), e.p), g = vl_row3(&f->g, i);
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
  float inv = density[hero] > 0.0f ? (float)found / density[hero] : 0.0f;
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

static const vlBssrdfTable *table_at(const vlWorld *world, const vlHits *hits, uint32_t i) {
  return world->materials.items[hits->material[i]].subsurface->table;
}

static bool carries(const vlPaths *p, uint32_t i) {
  return vl_largest4(p->beta[0][i], p->beta[1][i], p->beta[2][i], p->beta[3][i]) > 0.0f;
}

/* Takes light samples at n exits, and adds the radiance of those that arrive. light, q,
 * flights: memory for what is between. */
static void light_exits(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                        const vlPaths *p, const vlVolumeRows *rows, const vlHits *hits,
                        const vlSurface *f, vlLightSamples *light, vlShadowRays *q,
                        vlShadowFlights *flights) {
  if (t->world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, p, f, dimension, light);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    vlVec3 w = vl_row3(&light->w, i), g = vl_row3(&f->g, i);
    float cosine = vl_dot(w, vl_row3(&f->n, i));
    if (!(light->pdf[i] > 0.0f) || !(cosine > 0.0f) || !carries(p, i))
      continue;
    float v = exit_value(table_at(t->world, hits, i), cosine) * cosine;
    const vlWorldShape *shape = &t->world->shapes.items[hits->shape[i]];
    vlShadowStart start = {vl_surface_origin(f, i, w),
                           {v, v, v, v},
                           cosine * VL_INV_PI,
                           vl_medium_beyond(shape, g, w, rows->medium[i])};
    vl_volume_push_shadow(t, p, rows, light, i, &start, count++, q, flights);
  }
  vl_volume_shadows(t, p, light, count, depth, q, flights);
}

/* Samples the next rays of n exits, in place. alive: by exit, 1 for those that go on. */
static void leave(vlTracing *t, uint32_t n, uint32_t dimension, const vlHits *hits,
                  const vlSurface *f, vlPaths *p, vlVolumeRows *rows, uint8_t *alive) {
  vlNumbers u;
  vl_draw_2d(t, n, p, dimension + VL_DIM_EXIT_UV, u.u1, u.u2);
  for (uint32_t i = 0; i < n; i++) {
    vl_note_unsound(t, p, i);
    vlVec3 local = vl_warp_cosine_hemisphere(u.u1[i], u.u2[i]);
    alive[i] = carries(p, i) && local.z > 0.0f;
    if (!alive[i])
      continue;
    vlVec3 nn = vl_row3(&f->n, i), g = vl_row3(&f->g, i);
    vlVec3 w = vl_normalize(vl_from_local(vl_frame_from_z(nn), local));
    vlVec3 o = vl_surface_origin(f, i, w);
    float weight = exit_value(table_at(t->world, hits, i), local.z) * VL_PI,
          pdf = local.z * VL_INV_PI;
    vl_set_row3(&p->o, i, o);
    vl_set_row3(&p->d, i, w);
    p->pdf[i] = pdf;
    p->specular[i] = 0;
    p->cone[i] = vl_abs(p->cone[i]);
    p->spread[i] = t->def->pixel_spread;
    vl_note_scattered(t, p->lane[i]);
    vl_set_row3(&p->from_n, i, nn);
    p->from_side[i] = f->side[i];
    for (int c = 0; c < 4; c++) {
      p->beta[c][i] *= weight;
      rows->l[c][i] = rows->u[c][i] / pdf;
    }
    rows->medium[i] =
        vl_medium_beyond(&t->world->shapes.items[hits->shape[i]], g, w, rows->medium[i]);
  }
}

/* The exits of the probes: their paths go on in s->subsurface->paths, at the indices of the
 * paths that have entered. */
static void go_through(vlTracing *t, uint32_t probes, uint32_t depth, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  vlSubsurfaceScratch *x = s->subsurface;
  vlHits *hits = &s->at.hits;
  vlSurface *surface = &s->at.surface;
  uint8_t alive[VL_ROW_SIZE];
  uint32_t n = gather_exits(t->world, probes, &x->entries, &x->probes, &s->at.paths, &v->at,
                            x->probe, &s->rays, &v->rays, hits, &s->corners, surface);
  for (uint32_t i = 0; i < n; i++) {
    Entry e = entry_of(t->world, &x->entries, x->probe[i]);
    weigh_exit(t, i, &e, x->probes.found[x->probe[i]], surface, &s->rays, &v->rays);
  }
  if (t->batch->recorder)
    vl_record_exits(t, n, &s->rays, hits, surface);
  if (n) {
    light_exits(t, n, depth, dimension, &s->rays, &v->rays, hits, surface, &s->light,
                &s->shadow, &v->shadow);
    leave(t, n, dimension, hits, surface, &s->rays, &v->rays, alive);
  }
  if (t->batch->recorder)
    vl_record_left(t, n, &s->rays, alive);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t path = x->entries.path[x->probe[i]];
    if (!alive[i])
      continue;
    vl_path_copy(&s->rays, i, &x->paths, path);
    vl_volume_copy(&v->rays, i, &x->rows, path);
    x->alive[path] = 1;
  }
}

uint32_t vl_stage_subsurface(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  vlSubsurfaceScratch *x = s->subsurface;
  uint32_t dimension = VL_DIM_SUBSURFACE + depth * VL_DIM_STRIDE;
  uint32_t probes =
      find_entries(t->world, n, &s->at, &s->samples, s->order, &x->entries, x->alive);
  if (probes == 0)
    return n;
  x->paths = s->rays;
  x->rows = v->rays;
  start_probes(probes, &x->paths, &x->rows, &x->entries, &s->samples, s->order, &s->at.paths,
               &v->at);
  aim_probes(t, probes, dimension, &x->entries, &s->at.paths, x->probes.length);
  follow_probes(t, probes, depth, &x->entries, &s->at.paths, &x->probes, &s->shadow, &s->hits,
                &s->at.hits);
  if (t->batch->recorder)
    vl_record_probes(t, probes, &s->at.paths, x->probes.found);
  go_through(t, probes, depth, dimension);
  uint32_t count = 0;
  for (uint32_t k = 0; k < n; k++) {
    s->order[count] = k;
    count += x->alive[k];
  }
  vl_permute_paths(&x->paths, &s->rays, s->order, count);
  vl_volume_permute(&x->rows, &v->rays, s->order, count);
  return count;
}

/* ---- the material ------------------------------------------------------------------------ */

/* Computes extinction and albedo for a run of lanes, either from absorption and scattering, or
 * from the reflectance of a thick solid and the mean free path. */
void vl_stage_subsurface_inputs(vlTextureRun *r, const vlWorldMaterial *m) {
  const vlWorldSubsurface *b = m->subsurface;
  vlShade *sh = &r->at->shade;
  float(*sigma)[VL_ROW_SIZE] = sh->own + VL_S_SIGMA,
  (*albedo)[VL_ROW_SIZE] = sh->own + VL_S_ALBEDO;
  const float max = 1e15f; /* per unit of length: its square is finite */
  if (b->mfp >= 0) {
    vl_texture_spectrum(r, b->mfp, sigma);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = r->first; i < r->last; i++) {
        float length = vl_max(m->scale * sigma[c][i], 1.0f / max);
        sigma[c][i] = 1.0f / length;
        albedo[c][i] = vl_bssrdf_invert(b->table, sh->reflectance[c][i]);
      }
    return;
  }
  vl_texture_spectrum(r, b->sigma_a, sigma);
  vl_texture_spectrum(r, b->sigma_s, albedo);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = r->first; i < r->last; i++) {
      float a = vl_clamp(m->scale * sigma[c][i], 0.0f, max),
            s = vl_clamp(m->scale * albedo[c][i], 0.0f, max);
      sigma[c][i] = a + s;
      albedo[c][i] = a + s > 0.0f ? vl_min(s / (a + s), 1.0f) : 0.0f;
    }
}
