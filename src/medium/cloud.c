/* medium/cloud.c: clouds of noise in a box. */
#include <string.h>

#include "base/error.h"
#include "math/vec.h"
#include "medium/compile.h"
#include "velo/medium.h"

vlCompileMedium vl_compile_medium_cloud;

/* Cloud density changes with height: one majorant per slab. The absolute value of noise is at
 * most 1.04, that of the sum of its five octaves at most 1.01. Above y = 1 the factor of the
 * noise is negative, and grows again. */
vlResult vl_compile_medium_cloud(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                                 vlError *error) {
  enum { SLABS = 16 };
  memcpy(m->low, def->low, sizeof m->low);
  memcpy(m->high, def->high, sizeof m->high);
  m->emits = false;
  m->own[0] = def->cloud_density;
  m->own[1] = def->wispiness;
  m->own[2] = def->frequency;
  float *majorants = vl_medium_majorants(world, m, 1, SLABS, 1);
  if (!majorants)
    return vl_fail_memory(error);
  for (int i = 0; i < SLABS; i++) {
    const float margin = 1e-5f; /* lookups round y */
    float y = m->low[1] + (m->high[1] - m->low[1]) * (float)i / SLABS - margin;
    float end = m->low[1] + (m->high[1] - m->low[1]) * (float)(i + 1) / SLABS + margin;
    float factor = vl_max(vl_abs(1 - y), vl_abs(1 - end));
    float d = vl_clamp(factor * 4.5f * m->own[0] * 1.01f, 0, 1) + 2 * vl_max(0, 0.5f - y);
    majorants[i] = vl_clamp(d, 0, 1);
  }
  return VL_OK;
}
