/* world/medium/cloud.c: clouds of noise in a box. */
#include <string.h>

#include "base/error.h"
#include "math/vec.h"
#include "world/medium/kinds.h"

/* Cloud density decreases with height: one majorant per slab. Noise is at most 1.04, the sum of its five octaves at
 * most 1.01. */
vlResult vl_compile_medium_cloud(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  enum { SLABS = 16 };
  memcpy(m->low, def->low, sizeof m->low);
  memcpy(m->high, def->high, sizeof m->high);
  m->emits = false;
  m->own[0] = def->cloud_density;
  m->own[1] = def->wispiness;
  m->own[2] = def->frequency;
  float *majorants = vl_medium_majorants(world, m, 1, SLABS, 1);
  if (!majorants) return vl_fail_memory(error);
  for (int i = 0; i < SLABS; i++) {
    float y = m->low[1] + (m->high[1] - m->low[1]) * (float)i / SLABS - 1e-5f; /* margin: lookups round y */
    float d = vl_clamp((1 - y) * 4.5f * m->own[0] * 1.01f, 0, 1) + 2 * vl_max(0, 0.5f - y);
    majorants[i] = vl_clamp(d, 0, 1);
  }
  return VL_OK;
}
