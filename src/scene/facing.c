/* scene/facing.c: see facing.h. */
#include "scene/facing.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"
#include "scene/faces.h"

/* ---- the mean normal --------------------------------------------------------------------- */

typedef struct Mean {
  bool one_sided;
  double sum[3];
  double area;
} Mean;

static void add_normal(void *user, const vlFace *face) {
  Mean *mean = user;
  const double counts = mean->one_sided && !face->shape->one_sided ? 0 : 1;
  vl_along3(mean->sum, counts, face->area, mean->sum);
  mean->area += face->size;
}

void vl_facing_mean_normal(const vlScene *scene, bool one_sided, double n[3]) {
  Mean mean = {.one_sided = one_sided};
  vl_faces_visit(scene, add_normal, &mean);
  for (int i = 0; i < 3; i++)
    n[i] = mean.area > 0 ? mean.sum[i] / mean.area : 0;
}

/* ---- the side with more detail ----------------------------------------------------------- */

typedef struct Detail {
  double front[3], center[3];
  double ahead, behind; /* triangles, weighted by the cosine */
  double volume; /* three times it, signed: negative if the triangles' fronts are inside */
  size_t faces;
} Detail;

static void add_detail(void *user, const vlFace *face) {
  Detail *d = user;
  const double cosine = vl_dot3(face->area, d->front) / face->size;
  d->ahead += fmax(cosine, 0);
  d->behind += fmax(-cosine, 0);
  for (int i = 0; i < 3; i++)
    d->volume += face->area[i] * (face->middle[i] - d->center[i]);
  d->faces++;
}

bool vl_facing_is_behind(const vlScene *scene, const vlExtent *box, const double front[3]) {
  /* Models whose front is known (31 of glTF) have .82 and more. */
  const double clearly = 0.75;
  const size_t few = 500;
  Detail d = {.faces = 0};
  memcpy(d.front, front, sizeof d.front);
  vl_extent_middle(box, d.center);
  vl_faces_visit(scene, add_detail, &d);
  if (d.faces < few || d.volume == 0 || !isfinite(d.volume))
    return false;
  return d.volume > 0 ? d.ahead < clearly * d.behind : d.behind < clearly * d.ahead;
}

/* ---- blocks ------------------------------------------------------------------------------ */

enum { LAYERS = 64 };

typedef struct Blocks {
  int axis;
  double low, size;
  double surface, flat, walls, layers[LAYERS];
} Blocks;

static void add_block(void *user, const vlFace *face) {
  const double along = 0.996, across = 0.087; /* within 5 degrees */
  Blocks *b = user;
  const double area = face->size, cosine = fabs(face->area[b->axis]);
  b->surface += area;
  if (cosine < across * area)
    b->walls += area;
  if (!(cosine > along * area))
    return;
  const double at = b->size > 0 ? (face->middle[b->axis] - b->low) / b->size : 0;
  const int layer = (int)(fmin(fmax(at, 0), 1) * (LAYERS - 1));
  b->layers[layer] += area;
  b->flat += area;
}

vlBlocks vl_facing_blocks(const vlScene *scene, const vlExtent *box, int axis) {
  Blocks b = {.axis = axis, .low = box->low[axis], .size = vl_extent_size(box, axis)};
  vlBlocks blocks = {.levels = 0};
  vl_faces_visit(scene, add_block, &b);
  if (!(b.surface > 0))
    return blocks;
  blocks.flat = b.flat / b.surface;
  blocks.walls = b.walls / b.surface;
  for (int i = 0; i < LAYERS; i++) {
    blocks.levels += b.layers[i] > 1e-3 * b.surface;
    blocks.lower += i < LAYERS / 2 ? b.layers[i] / b.surface : 0;
  }
  blocks.ends[0] = b.layers[0] / b.surface;
  blocks.ends[1] = b.layers[LAYERS - 1] / b.surface;
  return blocks;
}

bool vl_facing_raised_is_behind(const vlScene *scene, const vlExtent *box,
                                const double front[3]) {
  const double min = 0.1, max = 0.8;
  int axis = 0;
  while (axis < 2 && fabs(front[axis]) != 1)
    axis++;
  if (fabs(front[axis]) != 1)
    return false;
  const vlBlocks blocks = vl_facing_blocks(scene, box, axis);
  const double ahead = blocks.ends[front[axis] > 0], behind = blocks.ends[front[axis] < 0];
  return behind >= min * ahead && behind <= max * ahead;
}
