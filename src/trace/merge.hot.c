/* trace/merge.hot.c: photons near the eye's vertices. The flux of N light paths through a disk of radius r round the
 * vertex stands for that at the vertex (two_way.h): biased by what changes over the disk, and less with each pass.
 *
 * Diffuse surfaces are the many and are added up at once; for the other kinds photons are listed, and each lane's next
 * one goes through the BSDFs with those of the other lanes. */
#include "trace/two_way_stages.h"

/* What this lane's photon brings: the weight, and the factor that the hero's being alone twice makes. */
static float pair_weight(const vlTracing *t, uint32_t i, const vlPhoton *x, float forth, float back) {
  const vlTwoWay *way = t->def->two_way;
  const vlTwoWayRows *r = t->batch->two_way;
  float others = r->a[i] * back + r->b[i] + x->a * forth + x->b;
  float weight = 1.0f / (way->merged + others); /* of H / (H + others), over H = N pi r^2 */
  return x->alone && vl_hero_alone(&t->s->b, i) ? 0.25f * weight : weight;
}

typedef struct Lane {
  uint32_t i, most; /* most: bounces that the photon may have */
  vlVec3 p;
  bool diffuse;
} Lane;

static void add_diffuse(vlTracing *t, const Lane *lane, const vlPhoton *x, float sum[4]) {
  const vlTraceScratch *s = t->s;
  const vlShade *sh = &s->shade;
  uint32_t i = lane->i;
  float zo = sh->wo[2][i], zi = x->w[0] * s->surface.nx[i] + x->w[1] * s->surface.ny[i] + x->w[2] * s->surface.nz[i];
  if (!(zo * zi > 0.0f)) return;
  float forth = vl_abs(zi) * VL_INV_PI, back = vl_abs(zo) * VL_INV_PI;
  float weight = pair_weight(t, i, x, forth, back) * forth;
  for (int c = 0; c < 4; c++) sum[c] += sh->reflectance[c][i] * x->power[c] * weight;
}

/* Each lane's listed photons, one of each lane at a time. */
static void add_listed(vlTracing *t, uint32_t n) {
  vlTwoWayRows *r = t->batch->two_way;
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  const vlPaths *p = &s->b;
  const vlPhoton *photons = t->def->two_way->map.photons;
  float(*wi)[VL_ROW_SIZE] = s->rows, (*value)[VL_ROW_SIZE] = s->rows + 3, *forth = s->rows[7];
  uint32_t most = 0;
  for (uint32_t i = 0; i < n; i++) most = r->count[i] > most ? r->count[i] : most;
  for (uint32_t round = 0; round < most; round++) {
    for (uint32_t i = 0; i < n; i++) {
      bool has = round < r->count[i];
      const float *w = has ? photons[r->pair[r->first[i] + round]].w : NULL;
      s->light.wx[i] = has ? w[0] : s->surface.nx[i];
      s->light.wy[i] = has ? w[1] : s->surface.ny[i];
      s->light.wz[i] = has ? w[2] : s->surface.nz[i];
    }
    VL_HOT(vl_stage_light_bsdf)(t, n);
    for (uint32_t i = 0; i < VL_PAD(n); i++) {
      for (int k = 0; k < 3; k++) wi[k][i] = sh->wi[k][i];
      for (int c = 0; c < 4; c++) value[c][i] = sh->value[c][i];
      forth[i] = sh->pdf[i];
    }
    VL_HOT(vl_stage_reverse)(t, r, n, (const float(*)[VL_ROW_SIZE])wi);
    for (uint32_t i = 0; i < n; i++) {
      if (round >= r->count[i]) continue;
      const vlPhoton *x = &photons[r->pair[r->first[i] + round]];
      float weight = pair_weight(t, i, x, forth[i], r->rev[i]);
      for (int c = 0; c < 4; c++)
        t->batch->radiance[c][p->lane[i]] += p->beta[c][i] * value[c][i] * x->power[c] * weight;
    }
  }
  for (uint32_t i = 0; i < n; i++) r->count[i] = 0;
}

void VL_HOT(vl_stage_merge)(vlTracing *t, uint32_t n, uint32_t depth) {
  const vlTwoWay *way = t->def->two_way;
  const vlPhotonMap *map = &way->map;
  vlTraceScratch *s = t->s;
  const vlSurface *f = &s->surface;
  const vlPaths *p = &s->b;
  vlTwoWayRows *r = t->batch->two_way;
  uint32_t listed = 0;
  if (!map->buckets) return;
  for (uint32_t i = 0; i < n; i++) r->count[i] = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (vl_all_specular(t->world, s, i)) continue;
    Lane lane = {i, t->def->max_depth - (depth - (way->apart ? r->smooth[p->lane[i]] : 0)),
                 vl_lane3(f->px, f->py, f->pz, i),
                 t->world->materials.items[s->hits_b.material[i]].kind == VL_MATERIAL_DIFFUSE};
    float sum[4] = {0, 0, 0, 0};
    int32_t corner[3] = {vl_photon_cell(lane.p.x - __builtin_sqrtf(map->radius2), map->inv_cell),
                         vl_photon_cell(lane.p.y - __builtin_sqrtf(map->radius2), map->inv_cell),
                         vl_photon_cell(lane.p.z - __builtin_sqrtf(map->radius2), map->inv_cell)};
    r->first[i] = listed;
    for (int k = 0; k < 8; k++) { /* cells are as wide as the ball */
      int32_t c[3] = {corner[0] + (k & 1), corner[1] + (k >> 1 & 1), corner[2] + (k >> 2)};
      uint32_t bucket = vl_photon_bucket(c[0], c[1], c[2], map->buckets);
      for (uint32_t j = map->start[bucket]; j < map->start[bucket + 1]; j++) {
        const vlPhoton *x = &map->photons[j];
        vlVec3 to = vl_vec3(x->p[0] - lane.p.x, x->p[1] - lane.p.y, x->p[2] - lane.p.z);
        if (!(vl_length2(to) < map->radius2) || x->bounce > lane.most) continue;
        if (vl_photon_cell(x->p[0], map->inv_cell) != c[0] || vl_photon_cell(x->p[1], map->inv_cell) != c[1] ||
            vl_photon_cell(x->p[2], map->inv_cell) != c[2])
          continue; /* another cell of the bucket */
        if (lane.diffuse) {
          add_diffuse(t, &lane, x, sum);
          continue;
        }
        if (listed == VL_MERGE_PAIRS) {
          add_listed(t, n);
          listed = r->first[i] = 0;
        }
        r->pair[listed++] = j;
        r->count[i]++;
      }
    }
    for (int c = 0; c < 4; c++) t->batch->radiance[c][p->lane[i]] += p->beta[c][i] * sum[c];
  }
  if (listed) add_listed(t, n);
}
