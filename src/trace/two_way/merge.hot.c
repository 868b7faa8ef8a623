/* trace/two_way/merge.hot.c: merging: adds the radiance of photons near the vertices of camera
 * paths. The flux of N light paths through a disk of radius r around the vertex estimates the
 * flux at the vertex (two_way.h). The estimate is biased if flux or surface change over the
 * disk. The bias vanishes as r shrinks from pass to pass.
 *
 * Photons on diffuse surfaces are the most frequent and are summed directly. For other BSDF
 * kinds, each lane lists its photons, and a batch evaluates the BSDFs for the next photon of
 * every lane. In media a ball of radius r replaces the disk. */
#include "trace/medium/phase.h"
#include "trace/two_way/stages.h"

enum { LISTED_WORK = 32 }; /* a photon with a BSDF takes as long as so many visited ones */

/* An iterator over the photons of one medium (vlPhoton.medium) within the radius around p. It
 * visits cell by cell; a cell is as wide as the ball. */
typedef struct Near {
  vlVec3 p;
  uint32_t medium, max; /* max: largest number of bounces of a photon */
  int32_t corner[3], cell[3];
  uint32_t next, end, seen; /* seen: photons of the visited cells */
  int visited;              /* of the 8 cells that the ball can meet */
} Near;

static Near near_start(const vlPhotonMap *map, vlVec3 p, uint32_t medium, uint32_t max) {
  float radius = __builtin_sqrtf(map->radius2);
  return (Near){.p = p,
                .medium = medium,
                .max = max,
                .corner = {vl_photon_cell(p.x - radius, map->inv_cell),
                           vl_photon_cell(p.y - radius, map->inv_cell),
                           vl_photon_cell(p.z - radius, map->inv_cell)}};
}

/* Whether the photon is in the ball, in the medium, and not of too long a path. */
static bool near_fits(const vlPhotonMap *map, const Near *near, const vlPhoton *x) {
  vlVec3 to = vl_vec3(x->p[0] - near->p.x, x->p[1] - near->p.y, x->p[2] - near->p.z);
  if (!(vl_length2(to) < map->radius2) || x->bounce > near->max || x->medium != near->medium)
    return false;
  for (int k = 0; k < 3; k++)
    if (vl_photon_cell(x->p[k], map->inv_cell) != near->cell[k])
      return false; /* a photon of another cell in the same bucket */
  return true;
}

/* Index of the next photon, or VL_NONE. */
static uint32_t near_next(const vlPhotonMap *map, Near *near) {
  for (;;) {
    while (near->next < near->end) {
      uint32_t j = near->next++;
      if (near_fits(map, near, &map->photons[j]))
        return j;
    }
    if (near->visited == 8)
      return VL_NONE;
    for (int i = 0; i < 3; i++)
      near->cell[i] = near->corner[i] + (near->visited >> i & 1);
    uint32_t bucket =
        vl_photon_bucket(near->cell[0], near->cell[1], near->cell[2], map->buckets);
    near->next = map->start[bucket];
    near->end = map->start[bucket + 1];
    near->seen += near->end - near->next;
    near->visited++;
  }
}

/* The weight of a photon at vertex i. If both paths have only the hero wavelength left, it
 * includes a factor 1/4, because each path carries the weight of all four wavelengths. */
static float pair_weight(const vlTwoWay *way, const vlTwoWayVertices *v, uint32_t i,
                         const vlPhoton *x, float forth, float back) {
  const vlWays *ways = v->ways;
  float others = ways->a[i] * back + ways->b[i] + x->a * forth + x->b;
  /* the weight H / (H + others), divided by H */
  float weight = 1.0f / ((x->medium ? way->merged_volume : way->merged) + others);
  return x->alone && vl_hero_only(v->paths, i) ? 0.25f * weight : weight;
}

/* The photon's power for the camera path of vertex i. With attenuation by RGB channel, the
 * transmittance of the whole path is not the product of those of its two parts, so it is
 * computed again. wi_z: cosine of the photon's direction to the normal; not read in media. */
static void joined_power(const vlTracing *t, const vlTwoWayVertices *v, uint32_t i,
                         const vlPhoton *x, float wi_z, float power[4]) {
  for (int c = 0; c < 4; c++)
    power[c] = x->power[c];
  if (!t->world->by_channel)
    return;
  const vlPaths *p = v->paths;
  uint32_t lane = p->lane[i];
  float light[3], eye[3] = {t->passed[0][lane], t->passed[1][lane], t->passed[2][lane]};
  if (v->at)
    vl_passed_on(t, v->at, i, wi_z, eye);
  vl_unpack_passed(x->passed, light);
  for (int c = 0; c < 4; c++)
    power[c] *= vl_joined_factor(light, eye, p->lambda[c][i]);
}

/* Adds the light of a photon that the diffuse surface at vertex i sends back, without the
 * camera path's throughput. */
static void add_diffuse(const vlTracing *t, const vlTwoWayVertices *v, uint32_t i,
                        const vlPhoton *x, float sum[4]) {
  const vlShade *sh = &v->at->shade;
  const vlSurface *f = &v->at->surface;
  float zo = sh->wo[2][i], zi = vl_dot(vl_load3(x->w), vl_row3(&f->n, i));
  if (!(zo * zi > 0.0f))
    return;
  float forth = vl_abs(zi) * VL_INV_PI, back = vl_abs(zo) * VL_INV_PI;
  float weight = pair_weight(t->def->two_way, v, i, x, forth, back) * forth;
  float power[4];
  joined_power(t, v, i, x, zi, power);
  for (int c = 0; c < 4; c++)
    sum[c] += sh->reflectance[c][i] * power[c] * weight;
}

/* Adds the listed photons of n vertices, one photon of every vertex at a time, and empties the
 * list. */
static void add_listed(vlTracing *t, uint32_t n, const vlTwoWayVertices *v, vlMergeList *list,
                       vlBsdfValues *there, vlBsdfValues *back) {
  vlVec3Row toward; /* where the photons came from */
  const vlPaths *p = v->paths;
  const vlSurface *f = &v->at->surface;
  const vlPhoton *photons = t->def->two_way->map.photons;
  uint32_t max = 0;
  for (uint32_t i = 0; i < n; i++)
    max = list->count[i] > max ? list->count[i] : max;
  for (uint32_t round = 0; round < max; round++) {
    for (uint32_t i = 0; i < n; i++) {
      bool has = round < list->count[i];
      const float *w = has ? photons[list->pair[list->first[i] + round]].w : NULL;
      vl_set_row3(&toward, i, has ? vl_load3(w) : vl_row3(&f->n, i));
    }
    vl_stage_there_and_back(t, n, v->at, &toward, there, back);
    for (uint32_t i = 0; i < n; i++) {
      if (round >= list->count[i])
        continue;
      const vlPhoton *x = &photons[list->pair[list->first[i] + round]];
      float weight = pair_weight(t->def->two_way, v, i, x, there->pdf[i], back->pdf[i]),
            power[4];
      joined_power(t, v, i, x, there->wi[2][i], power);
      for (int c = 0; c < 4; c++)
        t->batch->radiance[c][p->lane[i]] +=
            p->beta[c][i] * there->value[c][i] * power[c] * weight;
    }
  }
  for (uint32_t i = 0; i < n; i++)
    list->count[i] = 0;
}

/* How many bounces a photon may have so that the whole path has at most max_depth. depth:
 * bounces of the camera path. */
static uint32_t max_bounces(const vlTracing *t, uint32_t lane, uint32_t depth) {
  bool apart = t->def->two_way->apart;
  return t->def->max_depth - (depth - (apart ? t->lanes->smooth[lane] : 0));
}

void vl_stage_merge(vlTracing *t, uint32_t n, uint32_t depth, const vlTwoWayVertices *v,
                    vlBsdfValues *there, vlBsdfValues *back, vlMergeList *list) {
  const vlPhotonMap *map = &t->def->two_way->map;
  const vlVertices *at = v->at;
  const vlSurface *f = &at->surface;
  const vlPaths *p = v->paths;
  uint32_t listed = 0;
  if (!map->buckets)
    return;
  for (uint32_t i = 0; i < n; i++)
    list->count[i] = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (vl_all_specular(t->world, at, i))
      continue;
    bool diffuse = t->world->materials.items[at->hits.material[i]].diffuse;
    float sum[4] = {0, 0, 0, 0};
    Near near = near_start(map, vl_row3(&f->p, i), 0, max_bounces(t, p->lane[i], depth));
    list->first[i] = listed;
    for (uint32_t j; (j = near_next(map, &near)) != VL_NONE;) {
      if (diffuse) {
        add_diffuse(t, v, i, &map->photons[j], sum);
        continue;
      }
      if (listed == VL_MERGE_PAIRS) {
        add_listed(t, n, v, list, there, back);
        listed = list->first[i] = 0;
      }
      list->pair[listed++] = j;
      list->count[i]++;
      t->batch->merge_work += LISTED_WORK;
    }
    t->batch->merge_work += near.seen;
    vl_add_radiance(t, p, i, sum, 1.0f);
  }
  if (listed)
    add_listed(t, n, v, list, there, back);
}

void vl_stage_merge_media(vlTracing *t, uint32_t n, uint32_t depth, const vlTwoWayVertices *v) {
  const vlPhotonMap *map = &t->def->two_way->map;
  const vlPaths *p = v->paths;
  if (!map->buckets)
    return;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i], medium = v->rows->medium[i];
    float sum[4] = {0, 0, 0, 0}, g = t->world->media.items[medium].g;
    vlVec3 d = vl_row3(&p->d, i);
    Near near = near_start(map, vl_row3(&p->o, i), 1 + medium, max_bounces(t, lane, depth));
    for (uint32_t j; (j = near_next(map, &near)) != VL_NONE;) {
      const vlPhoton *x = &map->photons[j];
      float phase = vl_phase(g, vl_dot(d, vl_load3(x->w)));
      float weight = pair_weight(t->def->two_way, v, i, x, phase, phase) * phase, power[4];
      joined_power(t, v, i, x, 0.0f, power);
      for (int c = 0; c < 4; c++)
        sum[c] += power[c] * weight;
    }
    t->batch->merge_work += near.seen;
    vl_add_radiance(t, p, i, sum, 1.0f);
  }
}
