/* scene/closed.c: see closed.h. */
#include "scene/closed.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"
#include "math/elementary.h"
#include "math/transform.h"
#include "scene/faces.h"
#include "scene/turned.h"
#include "velo/edit.h"
#include "velo/shape_kinds.h"

enum {
  OUTSIDE = 160, /* rays from the eye */
  POINTS = 7,    /* points near the middle */
  AROUND = 48,   /* rays from each of them */
  RAYS = OUTSIDE + POINTS * AROUND,
  MAX_FACES = 8000000, /* larger models are taken as open */
  MAX_PLACED = 20000,  /* instances of shapes that are looked at */
  CONVEX = 400,        /* faces and vertices that are compared */
  BLOCK = 32           /* faces in a row that have a box */
};

/* A mesh with its transform to the world. */
typedef struct Placed {
  const vlShapeDef *def;
  const vlExtent *blocks; /* the shape's */
  size_t shape;
  vlMat4 to_shape;
  bool flip, fixed; /* fixed: not an instance */
  double low[3], high[3];
} Placed;

typedef struct Seen {
  double t;
  const Placed *placed; /* null: nothing */
  bool back;
} Seen;

typedef struct Survey {
  Placed *placed;
  size_t count;
  vlExtent **blocks; /* of each shape: the box of each BLOCK of its faces; null where they are
                        not made */
  double o[RAYS][3], d[RAYS][3];
  Seen seen[RAYS];
} Survey;

static void corner(const vlShapeDef *d, size_t face, int k, double p[3]) {
  const float *v = d->positions + 3 * (size_t)d->indices[3 * face + (size_t)k];
  for (int i = 0; i < 3; i++)
    p[i] = v[i];
}

/* The normal as the order of the corners gives it; its length is twice the area. */
static void face_normal(const double p[3][3], double n[3]) {
  double a[3], b[3];
  for (int i = 0; i < 3; i++) {
    a[i] = p[1][i] - p[0][i];
    b[i] = p[2][i] - p[0][i];
  }
  vl_cross3(a, b, n);
}

/* ---- rays -------------------------------------------------------------------------------- */

static bool meets_box(const double low[3], const double high[3], const double o[3],
                      const double d[3], double t_max) {
  double t0 = 0, t1 = t_max;
  for (int i = 0; i < 3; i++) {
    double inverse = 1 / d[i], a = (low[i] - o[i]) * inverse, b = (high[i] - o[i]) * inverse;
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
static void meet_block(const Placed *p, size_t first, const double o[3], const double d[3],
                       Seen *seen) {
  size_t last = first + BLOCK < p->def->faces ? first + BLOCK : p->def->faces;
  for (size_t face = first; face < last; face++) {
    double c[3][3], n[3], q[3], r[3];
    for (int k = 0; k < 3; k++)
      corner(p->def, face, k, c[k]);
    face_normal((const double(*)[3])c, n);
    double along = vl_dot3(n, d);
    for (int i = 0; i < 3; i++)
      q[i] = o[i] - c[0][i];
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
    *seen = (Seen){.t = t, .placed = p, .back = (along > 0) != p->flip};
  }
}

static void meet_faces(const Placed *p, const double world_o[3], const double world_d[3],
                       Seen *seen) {
  double o[3], d[3];
  vl_mat4_point(&p->to_shape, world_o, o);
  vl_mat4_vector(&p->to_shape, world_d, d);
  for (size_t first = 0; first < p->def->faces; first += BLOCK) {
    const vlExtent *block = &p->blocks[first / BLOCK];
    if (meets_box(block->low, block->high, o, d, seen->t))
      meet_block(p, first, o, d, seen);
  }
}

static void cast(void *user, uint32_t ray, uint32_t worker) {
  (void)worker;
  Survey *s = user;
  Seen *seen = &s->seen[ray];
  *seen = (Seen){.t = INFINITY};
  for (size_t i = 0; i < s->count; i++) {
    const Placed *p = &s->placed[i];
    if (meets_box(p->low, p->high, s->o[ray], s->d[ray], seen->t))
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

static void aim(Survey *s, const vlExtent *box, const double eye[3]) {
  double size[3], middle[3];
  for (int i = 0; i < 3; i++) {
    size[i] = box->high[i] - box->low[i];
    middle[i] = 0.5 * (box->low[i] + box->high[i]);
  }
  for (uint32_t k = 0; k < OUTSIDE; k++)
    for (int i = 0; i < 3; i++) {
      static const uint32_t bases[3] = {2, 3, 5};
      s->o[k][i] = eye[i];
      s->d[k][i] = box->low[i] + radical_inverse(k + 1, bases[i]) * size[i] - eye[i];
    }
  for (uint32_t k = OUTSIDE; k < RAYS; k++) {
    /* the middle, and points towards the faces of the box */
    uint32_t point = (k - OUTSIDE) / AROUND, i = (k - OUTSIDE) % AROUND;
    double z = 1 - (2 * i + 1) / (double)AROUND, r = sqrt(1 - z * z),
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
static bool make_blocks(vlContext *context, Survey *s, const vlShapeDef *d, size_t shape) {
  if (s->blocks[shape])
    return true;
  vlExtent *blocks = s->blocks[shape] =
      vl_alloc_array(context, d->faces / BLOCK + 1, sizeof *blocks);
  if (!blocks)
    return false;
  for (size_t first = 0; first < d->faces; first += BLOCK) {
    vlExtent *b = &blocks[first / BLOCK];
    *b = vl_extent_nothing;
    for (size_t face = first; face < d->faces && face < first + BLOCK; face++)
      for (int k = 0; k < 3; k++) {
        double c[3];
        corner(d, face, k, c);
        vl_extent_grow(b, c);
      }
    double margin = 0;
    for (int i = 0; i < 3; i++)
      margin += 1e-6 * (b->high[i] - b->low[i]);
    for (int i = 0; i < 3; i++) {
      b->low[i] -= margin;
      b->high[i] += margin;
    }
  }
  return true;
}

static bool survey_mesh(vlContext *context, Survey *s, const vlShapeDef *d, size_t shape,
                        const vlMat4 *world_from_group, bool fixed) {
  if (!make_blocks(context, s, d, shape))
    return false;
  vlMat4 m = vl_mat4_multiply(*world_from_group, vl_mat4_load(d->group_from_shape));
  Placed *p = &s->placed[s->count];
  if (!vl_mat4_inverse(m, &p->to_shape))
    return true;
  p->def = d;
  p->blocks = s->blocks[shape];
  p->shape = shape;
  p->fixed = fixed;
  p->flip = d->reverse_orientation; /* mirroring keeps the side: rays are met in shape space */
  vlExtent box = vl_extent_nothing;
  for (size_t i = 0; i < d->vertices; i++) {
    double v[3] = {d->positions[3 * i], d->positions[3 * i + 1], d->positions[3 * i + 2]}, q[3];
    vl_mat4_point(&m, v, q);
    vl_extent_grow(&box, q);
  }
  memcpy(p->low, box.low, sizeof p->low);
  memcpy(p->high, box.high, sizeof p->high);
  return ++s->count < MAX_PLACED;
}

/* False: memory is exhausted, or the scene is too large. */
static bool survey_meshes(const vlScene *scene, Survey *s) {
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

/* ---- the shell --------------------------------------------------------------------------- */

static bool is_opaque(const vlScene *scene, const vlShapeDef *d) {
  if (d->alpha.texture.index || d->alpha.value < 1)
    return false;
  const vlMaterialDef *m = vl_scene_material(scene, d->material);
  return !m || !vl_principled_transmits(m);
}

/* Whether no vertex lies far outside of any face's plane, whichever way the faces look. */
static bool is_convex(const vlShapeDef *d) {
  size_t step = d->faces / CONVEX + 1, vertex_step = d->vertices / CONVEX + 1;
  for (size_t face = 0; face < d->faces; face += step) {
    double c[3][3], n[3], low = 0, high = 0, length = 0;
    for (int k = 0; k < 3; k++)
      corner(d, face, k, c[k]);
    face_normal((const double(*)[3])c, n);
    for (size_t i = 0; i < d->vertices; i += vertex_step) {
      double q[3] = {(double)d->positions[3 * i] - c[0][0],
                     (double)d->positions[3 * i + 1] - c[0][1],
                     (double)d->positions[3 * i + 2] - c[0][2]};
      double away = vl_dot3(n, q);
      low = away < low ? away : low;
      high = away > high ? away : high;
      length = high - low;
    }
    if (fmin(-low, high) > 0.02 * length)
      return false;
  }
  return true;
}

/* Whether vertex normals look against the order of the corners: the object is whole, its
 * winding is wrong. */
static bool normals_disagree(const Placed *p) {
  const vlShapeDef *d = p->def;
  size_t against = 0, count = 0;
  if (!d->normals)
    return false;
  for (size_t face = 0; face < d->faces; face += d->faces / CONVEX + 1) {
    double c[3][3], n[3];
    for (int k = 0; k < 3; k++)
      corner(d, face, k, c[k]);
    face_normal((const double(*)[3])c, n);
    const float *own = d->normals + 3 * (size_t)d->indices[3 * face];
    const double v[3] = {own[0], own[1], own[2]};
    against += vl_dot3(n, v) < 0;
    count++;
  }
  return 2 * against > count;
}

/* The share of rays from the best point near the middle that meet something, and meet its
 * front. */
static int best_point(const Survey *s, double *covered, double *front) {
  int best = 0;
  *covered = *front = -1;
  for (int point = 0; point < POINTS; point++) {
    double met = 0, faces = 0;
    for (int i = 0; i < AROUND; i++) {
      const Seen *seen = &s->seen[OUTSIDE + point * AROUND + i];
      met += seen->placed != NULL;
      faces += seen->placed && !seen->back;
    }
    if (faces > AROUND * *front || (faces == AROUND * *front && met > AROUND * *covered)) {
      best = point;
      *covered = met / AROUND;
      *front = faces / AROUND;
    }
  }
  return best;
}

/* Whether there is anything within the limits but the shell. */
static bool has_contents(const vlScene *scene, const vlExtent *boxes, const bool *shell) {
  vlExtent inner = vl_extent_nothing;
  vl_extent_visit(scene, boxes, shell, vl_extent_grow, &inner);
  return inner.low[0] <= inner.high[0];
}

/* What rays from the eye say of the faces that show it their backs. */
typedef struct Backs {
  int met, count; /* rays that meet something; its back */
  int one_sided;  /* of these, by surfaces that are seen from one side, or emit */
  int against;    /* by meshes whose vertex normals look the other way */
  int whole;      /* by these, or by instances */
} Backs;

static Backs count_backs(const Survey *s, vlClosed *closed) {
  Backs backs = {.count = 0};
  for (int i = 0; i < OUTSIDE; i++) {
    const Seen *seen = &s->seen[i];
    backs.met += seen->placed != NULL;
    if (!seen->placed || !seen->back)
      continue;
    const bool against = normals_disagree(seen->placed);
    backs.count++;
    backs.one_sided += seen->placed->def->one_sided || seen->placed->def->emission.index;
    backs.against += against;
    backs.whole += against || !seen->placed->fixed;
    closed->shell[seen->placed->shape] = true;
  }
  return backs;
}

/* The shell if it is one convex shape: a dome, a panorama; else null. */
static const vlShapeDef *convex_shell(const vlScene *scene, const bool *shell) {
  const vlShapeDef *found = NULL;
  size_t shapes = 0;
  for (size_t i = 0; i < scene->shapes.count && shapes < 2; i++) {
    shapes += shell[i];
    found = shell[i] ? &scene->shapes.items[i] : found;
  }
  return shapes == 1 && is_convex(found) ? found : NULL;
}

/* Whether there is something to see on a shape: a texture, colours, light. */
static bool shows_something(const vlShapeDef *shape) {
  return shape->uvs || shape->colors || shape->emission.index;
}

/* A shell whose faces look inwards: from outside one sees mostly backs, and from the middle
 * mostly fronts, of a room; or it is an object that is wound the wrong way. */
static bool find_inward(const vlScene *scene, const vlExtent *box, const vlExtent *boxes,
                        const Survey *s, bool objects, vlClosed *closed, double covered,
                        double front) {
  const Backs backs = count_backs(s, closed);
  if (!(backs.count * 10 > backs.met * 6))
    return false;
  const bool seen_through = 2 * backs.one_sided > backs.count;
  const bool whole = 2 * backs.whole > backs.count;
  const bool contents = has_contents(scene, boxes, closed->shell);
  const bool surrounds = covered > 0.8 && front > 0.6;
  bool turned = objects && whole && 2 * backs.against > backs.count;
  const vlShapeDef *convex = convex_shell(scene, closed->shell);
  if (objects && !whole)
    turned = convex ? !contents && !shows_something(convex)
                    : vl_turned_is(scene, box, closed->shell, contents, surrounds);
  if (turned && seen_through)
    closed->kind = VL_CLOSED_TURNED;
  if (turned || whole)
    return turned && seen_through;
  return surrounds && (seen_through || contents); /* else its winding may be wrong */
}

/* A convex shell of one shape that hides all others. */
static bool find_outward(const vlScene *scene, const vlExtent *boxes, const Survey *s,
                         vlClosed *closed, double covered) {
  const Placed *shell = NULL;
  for (int i = 0; i < OUTSIDE; i++) {
    const Placed *p = s->seen[i].placed;
    if (p && shell && p != shell)
      return false;
    if (p)
      shell = p;
  }
  if (!shell || s->count < 2 || !shell->fixed || covered < 0.98)
    return false;
  if (!is_opaque(scene, shell->def) || !is_convex(shell->def))
    return false;
  memset(closed->shell, 0, scene->shapes.count * sizeof *closed->shell);
  closed->shell[shell->shape] = true;
  return has_contents(scene, boxes, closed->shell);
}

/* How much of a shape's surface is at right angles to an axis. */
typedef struct Flatness {
  const vlShapeDef *shape;
  double area, flat;
} Flatness;

static void add_flatness(void *user, const vlShapeDef *shape, const vlFace *face) {
  const double along = 0.99;
  Flatness *f = user;
  const double area = vl_norm3(face->area);
  if (shape != f->shape || !(area > 0) || !isfinite(area))
    return;
  const double most = fmax(fabs(face->area[0]), fmax(fabs(face->area[1]), fabs(face->area[2])));
  f->area += area;
  f->flat += most > along * area ? area : 0;
}

/* Whether the shell is one convex shape without flat walls: a sphere, a dome on a disk. */
static bool is_round(const vlScene *scene, const bool *shell) {
  const double flat = 0.4;
  Flatness f = {.shape = convex_shell(scene, shell)};
  if (!f.shape)
    return false;
  vl_faces_visit(scene, add_flatness, &f);
  return f.flat < flat * f.area;
}

static void classify(const vlScene *scene, const vlExtent *box, const vlExtent *boxes,
                     vlClosed *closed) {
  vlExtent inner = vl_extent_nothing;
  vl_extent_visit(scene, boxes, closed->shell, vl_extent_grow, &inner);
  size_t shells = 0;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    shells += closed->shell[i];
    closed->emits =
        closed->emits || (closed->shell[i] && scene->shapes.items[i].emission.index);
  }
  double share = vl_extent_diagonal(&inner) / vl_extent_diagonal(box);
  if (share > 0 && is_round(scene, closed->shell))
    share = fmin(share, 0.12); /* the sky around a landscape */
  closed->kind = share > 0.12 ? VL_CLOSED_ROOM : share > 0 ? VL_CLOSED_DOME : VL_CLOSED_EMPTY;
  /* A room in one mesh: its furniture is a part of the shell. Panoramas have few corners or are
   * convex. */
  for (size_t i = 0; i < scene->shapes.count && closed->kind == VL_CLOSED_EMPTY; i++)
    if (closed->shell[i] && (shells > 1 || !is_convex(&scene->shapes.items[i])))
      closed->kind = VL_CLOSED_ROOM;
}

static void free_survey(vlScene *scene, Survey *s) {
  for (size_t i = 0; s && s->blocks && i < scene->shapes.count; i++)
    vl_free(scene->context, s->blocks[i]);
  if (s)
    vl_free(scene->context, s->blocks);
  if (s)
    vl_free(scene->context, s->placed);
  vl_free(scene->context, s);
}

bool vl_closed_find(vlScene *scene, const vlExtent *box, const vlExtent *boxes,
                    const double eye[3], bool objects, vlClosed *closed) {
  *closed = (vlClosed){.kind = VL_CLOSED_NOT};
  for (int i = 0; i < 3; i++)
    closed->middle[i] = 0.5 * (box->low[i] + box->high[i]);
  if (!(vl_extent_diagonal(box) > 0))
    return true;
  Survey *s = vl_alloc_zero(scene->context, 1, sizeof *s);
  closed->shell = vl_alloc_zero(scene->context, scene->shapes.count + 1, sizeof *closed->shell);
  bool ok = s && closed->shell, found = false;
  if (ok && survey_meshes(scene, s)) {
    double covered, front;
    aim(s, box, eye);
    vl_parallel_for(scene->context, RAYS, cast, s);
    int best = best_point(s, &covered, &front);
    found = closed->inward = find_inward(scene, box, boxes, s, objects, closed, covered, front);
    found = found || find_outward(scene, boxes, s, closed, covered);
    if (found)
      memcpy(closed->middle, s->o[OUTSIDE + best * AROUND], sizeof closed->middle);
  }
  free_survey(scene, s);
  if (!ok)
    vl_scene_fail_memory(scene);
  if (found && closed->kind != VL_CLOSED_TURNED)
    classify(scene, box, boxes, closed);
  if (!found) {
    vl_free(scene->context, closed->shell);
    closed->shell = NULL;
  }
  return ok;
}

bool vl_closed_reach(vlScene *scene, const double (*from)[3], const double (*toward)[3],
                     uint32_t count, double *reach) {
  Survey *s = vl_alloc_zero(scene->context, 1, sizeof *s);
  for (uint32_t k = 0; k < count; k++)
    reach[k] = INFINITY;
  if (s && survey_meshes(scene, s))
    for (uint32_t first = 0; first < count; first += RAYS) {
      const uint32_t n = count - first < RAYS ? count - first : RAYS;
      memcpy(s->o, from + first, n * sizeof *s->o);
      memcpy(s->d, toward + first, n * sizeof *s->d);
      vl_parallel_for(scene->context, n, cast, s);
      for (uint32_t k = 0; k < n; k++)
        reach[first + k] = s->seen[k].t;
    }
  free_survey(scene, s);
  if (!s)
    vl_scene_fail_memory(scene);
  return s != NULL;
}

/* ---- the opening ------------------------------------------------------------------------- */

/* Whether the face's plane separates the eye from the middle. A face of an inward shell must
 * also show the eye its back: what stands in a room, and is a part of the same mesh, stays. */
static bool stands_between(const vlShapeDef *d, const vlMat4 *m, size_t face,
                           const vlClosed *closed, const double eye[3]) {
  double c[3][3], n[3], p[3], to_eye[3], to_middle[3];
  for (int k = 0; k < 3; k++) {
    corner(d, face, k, p);
    vl_mat4_point(m, p, c[k]);
  }
  face_normal((const double(*)[3])c, n);
  for (int i = 0; i < 3; i++) {
    to_eye[i] = eye[i] - c[0][i];
    to_middle[i] = closed->middle[i] - c[0][i];
  }
  double a = vl_dot3(n, to_eye), b = vl_dot3(n, to_middle);
  const bool mirrored = vl_mat4_determinant3(*m) < 0; /* it reverses the order of the corners */
  if (closed->inward && (a < 0) == (d->reverse_orientation != mirrored))
    return false;
  return (a > 0 && b < 0) || (a < 0 && b > 0);
}

static bool open_shape(vlScene *scene, vlShapeDef *d, const vlClosed *closed,
                       const double eye[3], uint64_t *count) {
  vlMat4 m = vl_mat4_load(d->group_from_shape);
  uint32_t *kept = vl_alloc_array(scene->context, 3 * (size_t)d->faces, sizeof *kept), n = 0;
  if (!kept)
    return vl_scene_fail_memory(scene);
  for (size_t face = 0; face < d->faces; face++) {
    if (stands_between(d, &m, face, closed, eye))
      continue;
    memcpy(kept + 3 * (size_t)n++, d->indices + 3 * face, 3 * sizeof *kept);
  }
  *count += d->faces - n;
  if (n == 0) {
    kept[0] = kept[1] = kept[2] = d->indices[0];
    n = 1;
  } /* without area: a shape has a face */
  d->faces = n;
  d->indices = kept;
  return vl_scene_own(scene, kept);
}

bool vl_closed_open(vlScene *scene, const vlClosed *closed, const double eye[3],
                    uint64_t *count) {
  *count = 0;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    vlShapeDef *d = &scene->shapes.items[i];
    if (closed->shell[i] && !d->group.index && !open_shape(scene, d, closed, eye, count))
      return false;
  }
  return true;
}
