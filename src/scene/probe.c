/* scene/probe.c: see probe.h. */
#include "scene/probe.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"
#include "math/elementary.h"
#include "velo/edit.h"
#include "velo/shape_kinds.h"

enum {
  MAX_FACES = 8000000, /* larger models are not looked at */
  MAX_PLACED = 20000,  /* instances of shapes that are looked at */
  BLOCK = 32           /* faces in a row that have a box */
};

/* ---- rays -------------------------------------------------------------------------------- */

static bool meets_box(const vlExtent *box, const double o[3], const double d[3], double t_max) {
  double t0 = 0, t1 = t_max;
  for (int i = 0; i < 3; i++) {
    double inverse = 1 / d[i], a = (box->low[i] - o[i]) * inverse,
           b = (box->high[i] - o[i]) * inverse;
    if (a > b) {
      double c = a;
      a = b;
      b = c;
    }
    t0 = a > t0 ? a : t0;
    t1 = b < t1 ? b : t1; /* NaN: the plane of a face, which does not cut */
  }
  return t0 <= t1;
}

/* Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997. */
static void meet_block(const vlProbeMesh *p, size_t first, const double o[3], const double d[3],
                       vlSeen *seen) {
  size_t last = first + BLOCK < p->def->faces ? first + BLOCK : p->def->faces;
  for (size_t face = first; face < last; face++) {
    double c[3][3], n[3], q[3], r[3];
    vl_mesh_face(p->def, NULL, face, c, n);
    double along = vl_dot3(n, d);
    vl_sub3(o, c[0], q);
    double t = -vl_dot3(n, q) / along;
    if (!(t > 0 && t < seen->t))
      continue;
    vl_cross3(q, d, r);
    double u = 0, v = 0;
    for (int i = 0; i < 3; i++) {
      u -= (c[2][i] - c[0][i]) * r[i];
      v += (c[1][i] - c[0][i]) * r[i];
    }
    u /= along;
    v /= along;
    if (!(u >= 0 && v >= 0 && u + v <= 1))
      continue;
    *seen = (vlSeen){.t = t, .placed = p, .back = (along > 0) != p->flip};
  }
}

static void meet_faces(const vlProbeMesh *p, const double world_o[3], const double world_d[3],
                       vlSeen *seen) {
  double o[3], d[3];
  vl_mat4_point(&p->to_shape, world_o, o);
  vl_mat4_vector(&p->to_shape, world_d, d);
  for (size_t first = 0; first < p->def->faces; first += BLOCK) {
    const vlExtent *block = &p->blocks[first / BLOCK];
    if (meets_box(block, o, d, seen->t))
      meet_block(p, first, o, d, seen);
  }
}

static void cast(void *user, uint32_t ray, VL_UNUSED uint32_t worker) {
  vlProbe *s = user;
  vlSeen *seen = &s->seen[ray];
  *seen = (vlSeen){.t = INFINITY};
  for (size_t i = 0; i < s->count; i++) {
    const vlProbeMesh *p = &s->placed[i];
    if (meets_box(&p->box, s->o[ray], s->d[ray], seen->t))
      meet_faces(p, s->o[ray], s->d[ray], seen);
  }
}

static double radical_inverse(uint32_t i, uint32_t base) {
  double sum = 0, f = 1;
  for (; i; i /= base) {
    f /= base;
    sum += f * (i % base);
  }
  return sum;
}

void vl_probe_aim(vlProbe *s, const vlExtent *box, const double eye[3]) {
  double size[3], middle[3];
  vl_sub3(box->high, box->low, size);
  vl_extent_middle(box, middle);
  for (uint32_t k = 0; k < VL_PROBE_OUTSIDE; k++)
    for (int i = 0; i < 3; i++) {
      static const uint32_t bases[3] = {2, 3, 5};
      s->o[k][i] = eye[i];
      s->d[k][i] = box->low[i] + radical_inverse(k + 1, bases[i]) * size[i] - eye[i];
    }
  for (uint32_t k = VL_PROBE_OUTSIDE; k < VL_PROBE_RAYS; k++) {
    /* the middle, and points towards the faces of the box */
    uint32_t point = (k - VL_PROBE_OUTSIDE) / VL_PROBE_AROUND,
             i = (k - VL_PROBE_OUTSIDE) % VL_PROBE_AROUND;
    double z = 1 - (2 * i + 1) / (double)VL_PROBE_AROUND, r = sqrt(1 - z * z),
           turn = 2.399963229728653 * i + 0.3;
    memcpy(s->o[k], middle, sizeof middle);
    if (point)
      s->o[k][(point - 1) / 2] += (point & 1 ? 0.23 : -0.23) * size[(point - 1) / 2];
    s->d[k][0] = r * vl_precise_cos(turn);
    s->d[k][1] = z;
    s->d[k][2] = r * vl_precise_sin(turn);
  }
}

/* ---- the meshes -------------------------------------------------------------------------- */

/* Makes the boxes of a shape's blocks, a little larger than their faces. False: memory is
 * exhausted. */
static bool make_blocks(vlContext *context, vlProbe *s, const vlShapeDef *d, size_t shape) {
  if (s->blocks[shape])
    return true;
  vlExtent *blocks = s->blocks[shape] =
      vl_alloc_array(context, d->faces / BLOCK + 1, sizeof *blocks);
  if (!blocks)
    return false;
  for (size_t first = 0; first < d->faces; first += BLOCK) {
    vlExtent *b = &blocks[first / BLOCK];
    *b = vl_extent_nothing;
    for (size_t face = first; face < d->faces && face < first + BLOCK; face++) {
      double c[3][3], n[3];
      vl_mesh_face(d, NULL, face, c, n);
      for (int k = 0; k < 3; k++)
        vl_extent_grow(b, c[k]);
    }
    double margin = 0;
    for (int i = 0; i < 3; i++)
      margin += 1e-6 * vl_extent_size(b, i);
    for (int i = 0; i < 3; i++) {
      b->low[i] -= margin;
      b->high[i] += margin;
    }
  }
  return true;
}

static bool survey_mesh(vlContext *context, vlProbe *s, const vlShapeDef *d, size_t shape,
                        const vlMat4 *world_from_group, bool fixed) {
  if (!make_blocks(context, s, d, shape))
    return false;
  vlMat4 m = vl_mat4_multiply(*world_from_group, vl_mat4_load(d->group_from_shape));
  vlProbeMesh *p = &s->placed[s->count];
  if (!vl_mat4_inverse(m, &p->to_shape))
    return true;
  p->def = d;
  p->blocks = s->blocks[shape];
  p->shape = shape;
  p->fixed = fixed;
  p->flip = d->reverse_orientation; /* mirroring keeps the side: rays are met in shape space */
  p->box = vl_extent_nothing;
  vl_extent_visit_shape(d, world_from_group, vl_extent_grow, &p->box);
  return ++s->count < MAX_PLACED;
}

bool vl_probe_make(const vlScene *scene, vlProbe *s) {
  uint64_t faces = 0, count = scene->shapes.count + scene->instances.count;
  for (size_t i = 0; i < scene->shapes.count; i++)
    faces += scene->shapes.items[i].faces;
  if (faces > MAX_FACES || count == 0)
    return false;
  s->placed = vl_alloc_array(scene->context, MAX_PLACED, sizeof *s->placed);
  s->blocks = vl_alloc_zero(scene->context, scene->shapes.count, sizeof *s->blocks);
  if (!s->placed || !s->blocks)
    return false;
  vlMat4 identity = vl_mat4_identity();
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *d = &scene->shapes.items[i];
    if (d->kind == VL_SHAPE_TRIANGLES && !d->group.index && d->faces &&
        !survey_mesh(scene->context, s, d, i, &identity, true))
      return false;
  }
  for (size_t k = 0; k < scene->instances.count; k++) {
    vlMat4 m = vl_mat4_load(scene->instances.items[k].world_from_group);
    for (size_t i = 0; i < scene->shapes.count; i++) {
      const vlShapeDef *d = &scene->shapes.items[i];
      bool member = d->group.index && d->group.index == scene->instances.items[k].group.index;
      if (member && d->kind == VL_SHAPE_TRIANGLES && d->faces &&
          !survey_mesh(scene->context, s, d, i, &m, false))
        return false;
    }
  }
  return s->count > 0;
}

void vl_probe_free(const vlScene *scene, vlProbe *s) {
  for (size_t i = 0; s && s->blocks && i < scene->shapes.count; i++)
    vl_free(scene->context, s->blocks[i]);
  if (s)
    vl_free(scene->context, s->blocks);
  if (s)
    vl_free(scene->context, s->placed);
  vl_free(scene->context, s);
}

void vl_probe_cast(const vlScene *scene, vlProbe *s, uint32_t count) {
  vl_parallel_for(scene->context, count, cast, s);
}
