/* trace/two_way/photons.c: builds the photon map (a hashed grid) by a counting sort, and
 * computes the probabilities of the lights from which light paths start. */
#include <string.h>

#include "trace/two_way/stages.h"

size_t vl_two_way_rows_size(void) {
  return sizeof(struct vlTwoWayRows);
}

static uint32_t bucket_of(const vlPhotonMap *map, const vlPhoton *x) {
  return vl_photon_bucket(vl_photon_cell(x->p[0], map->inv_cell),
                          vl_photon_cell(x->p[1], map->inv_cell),
                          vl_photon_cell(x->p[2], map->inv_cell), map->buckets);
}

static bool comes_before(const vlPhoton *a, const vlPhoton *b) {
  return a->id != b->id ? a->id < b->id : a->bounce < b->bounce;
}

/* Heapsort. Most buckets are small, but a scene may put all photons into one. */
static void sink(vlPhoton *x, uint32_t root, uint32_t count) {
  vlPhoton moving = x[root];
  for (uint32_t child; (child = 2 * root + 1) < count; root = child) {
    if (child + 1 < count && comes_before(&x[child], &x[child + 1]))
      child++;
    if (!comes_before(&moving, &x[child]))
      break;
    x[root] = x[child];
  }
  x[root] = moving;
}
static void sort_bucket(vlPhoton *x, uint32_t count) {
  if (count < 16) {
    for (uint32_t i = 1; i < count; i++) {
      vlPhoton moving = x[i];
      uint32_t k = i;
      for (; k > 0 && comes_before(&moving, &x[k - 1]); k--)
        x[k] = x[k - 1];
      x[k] = moving;
    }
    return;
  }
  for (uint32_t i = count / 2; i-- > 0;)
    sink(x, i, count);
  for (uint32_t last = count; last-- > 1;) {
    vlPhoton largest = x[0];
    x[0] = x[last];
    x[last] = largest;
    sink(x, 0, last);
  }
}

void vl_photon_map_build(vlPhotonMap *map, const vlPhoton *photons, uint32_t count,
                         float radius, vlPhoton *sorted, uint32_t *start, uint32_t buckets) {
  *map = (vlPhotonMap){sorted, start, buckets, radius * radius, 0.5f / radius};
  memset(start, 0, ((size_t)buckets + 1) * sizeof *start);
  for (uint32_t i = 0; i < count; i++)
    start[bucket_of(map, &photons[i]) + 1]++;
  for (uint32_t b = 0; b < buckets; b++)
    start[b + 1] += start[b];
  /* start[b] is the index of the bucket's next photon; at the end it equals start[b + 1], so it
   * is shifted back by one. */
  for (uint32_t i = 0; i < count; i++)
    sorted[start[bucket_of(map, &photons[i])]++] = photons[i];
  memmove(start + 1, start, (size_t)buckets * sizeof *start);
  start[0] = 0;
  for (uint32_t b = 0; b < buckets; b++)
    sort_bucket(sorted + start[b], start[b + 1] - start[b]);
}

bool vl_two_way_choice(const vlWorld *world, float *choice) {
  double total = 0, sum = 0;
  for (int pass = 0; pass < 2; pass++)
    for (size_t i = 0; i < world->lights.count; i++) {
      const vlWorldLight *light = &world->lights.items[i];
      double power = light->power > 0.0f && light->power < 1e30f ? (double)light->power : 0.0;
      if (pass == 0) {
        total += power;
      } else {
        choice[i] = total > 0 ? (float)(sum / total) : 0.0f;
        sum += power;
      }
    }
  choice[world->lights.count] = total > 0 ? 1.0f : 0.0f;
  return total > 0;
}
