/* scene/closed.c: see closed.h. */
#include "scene/closed.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"
#include "math/transform.h"
#include "scene/faces.h"
#include "scene/probe.h"
#include "scene/turned.h"
#include "velo/edit.h"
#include "velo/shape_kinds.h"

enum { CONVEX = 400 }; /* faces and vertices that are compared */

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
    double c[3][3], n[3], low = 0, high = 0;
    vl_mesh_face(d, NULL, face, c, n);
    for (size_t i = 0; i < d->vertices; i += vertex_step) {
      double q[3] = {(double)d->positions[3 * i] - c[0][0],
                     (double)d->positions[3 * i + 1] - c[0][1],
                     (double)d->positions[3 * i + 2] - c[0][2]};
      double away = vl_dot3(n, q);
      low = away < low ? away : low;
      high = away > high ? away : high;
    }
    if (fmin(-low, high) > 0.02 * (high - low))
      return false;
  }
  return true;
}

/* Whether vertex normals look against the order of the corners: the object is whole, its
 * winding is wrong. */
static bool normals_disagree(const vlProbeMesh *p) {
  const vlShapeDef *d = p->def;
  size_t against = 0, count = 0;
  if (!d->normals)
    return false;
  for (size_t face = 0; face < d->faces; face += d->faces / CONVEX + 1) {
    double c[3][3], n[3];
    vl_mesh_face(d, NULL, face, c, n);
    const float *own = d->normals + 3 * (size_t)d->indices[3 * face];
    const double v[3] = {own[0], own[1], own[2]};
    against += vl_dot3(n, v) < 0;
    count++;
  }
  return 2 * against > count;
}

/* The share of rays from the best point near the middle that meet something, and meet its
 * front. */
static int best_point(const vlProbe *s, double *covered, double *front) {
  int best = 0;
  *covered = *front = -1;
  for (int point = 0; point < VL_PROBE_POINTS; point++) {
    double met = 0, faces = 0;
    for (int i = 0; i < VL_PROBE_AROUND; i++) {
      const vlSeen *seen = &s->seen[VL_PROBE_OUTSIDE + point * VL_PROBE_AROUND + i];
      met += seen->placed != NULL;
      faces += seen->placed && !seen->back;
    }
    if (faces > VL_PROBE_AROUND * *front ||
        (faces == VL_PROBE_AROUND * *front && met > VL_PROBE_AROUND * *covered)) {
      best = point;
      *covered = met / VL_PROBE_AROUND;
      *front = faces / VL_PROBE_AROUND;
    }
  }
  return best;
}

/* Whether there is anything within the limits but the shell. */
static bool has_contents(const vlScene *scene, const vlExtent *boxes, const bool *shell) {
  vlExtent inner = vl_extent_nothing;
  vl_extent_visit(scene, boxes, shell, vl_extent_grow, &inner);
  return !vl_extent_is_empty(&inner);
}

/* What rays from the eye say of the faces that show it their backs. */
typedef struct Backs {
  int met, count; /* rays that meet something; its back */
  int one_sided;  /* of these, by surfaces that are seen from one side, or emit */
  int against;    /* by meshes whose vertex normals look the other way */
  int whole;      /* by these, or by instances */
} Backs;

static Backs count_backs(const vlProbe *s, vlClosed *closed) {
  Backs backs = {.count = 0};
  for (int i = 0; i < VL_PROBE_OUTSIDE; i++) {
    const vlSeen *seen = &s->seen[i];
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
                        const vlProbe *s, bool objects, vlClosed *closed, double covered,
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
static bool find_outward(const vlScene *scene, const vlExtent *boxes, const vlProbe *s,
                         vlClosed *closed, double covered) {
  const vlProbeMesh *shell = NULL;
  for (int i = 0; i < VL_PROBE_OUTSIDE; i++) {
    const vlProbeMesh *p = s->seen[i].placed;
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

static void add_flatness(void *user, const vlFace *face) {
  const double along = 0.99;
  Flatness *f = user;
  if (face->shape != f->shape)
    return;
  const double max = fmax(fabs(face->area[0]), fmax(fabs(face->area[1]), fabs(face->area[2])));
  f->area += face->size;
  f->flat += max > along * face->size ? face->size : 0;
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
  const double room = 0.12; /* the contents of a room have more than this share of its size */
  const double share = vl_extent_diagonal(&inner) / vl_extent_diagonal(box);
  closed->kind = VL_CLOSED_EMPTY;
  if (share > 0) /* a round shell is the sky around a landscape */
    closed->kind =
        share > room && !is_round(scene, closed->shell) ? VL_CLOSED_ROOM : VL_CLOSED_DOME;
  /* A room in one mesh: its furniture is a part of the shell. Panoramas have few corners or are
   * convex. */
  for (size_t i = 0; i < scene->shapes.count && closed->kind == VL_CLOSED_EMPTY; i++)
    if (closed->shell[i] && (shells > 1 || !is_convex(&scene->shapes.items[i])))
      closed->kind = VL_CLOSED_ROOM;
}

/* A room with thick walls; its shell is every mesh that has a place of its own. */
static bool find_thick(const vlScene *scene, const vlProbe *s, const vlExtent *box,
                       vlClosed *closed) {
  if (!vl_thick_find(s, box, &closed->thick, closed->middle))
    return false;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *shape = &scene->shapes.items[i];
    closed->shell[i] = shape->kind == VL_SHAPE_TRIANGLES && !shape->group.index && shape->faces;
  }
  return true;
}

bool vl_closed_find(vlScene *scene, const vlExtent *box, const vlExtent *boxes,
                    const double eye[3], bool objects, vlClosed *closed) {
  *closed = (vlClosed){.kind = VL_CLOSED_NOT};
  vl_extent_middle(box, closed->middle);
  if (!(vl_extent_diagonal(box) > 0))
    return true;
  vlProbe *s = vl_alloc_zero(scene->context, 1, sizeof *s);
  closed->shell = vl_alloc_zero(scene->context, scene->shapes.count + 1, sizeof *closed->shell);
  bool ok = s && closed->shell, found = false;
  if (ok && vl_probe_make(scene, s)) {
    double covered, front;
    vl_probe_aim(s, box, eye);
    vl_probe_cast(scene, s, VL_PROBE_RAYS);
    int best = best_point(s, &covered, &front);
    found = closed->inward = find_inward(scene, box, boxes, s, objects, closed, covered, front);
    closed->walls = !found && find_thick(scene, s, box, closed);
    found = found || (!closed->walls && find_outward(scene, boxes, s, closed, covered));
    if (found)
      memcpy(closed->middle, s->o[VL_PROBE_OUTSIDE + best * VL_PROBE_AROUND],
             sizeof closed->middle);
  }
  vl_probe_free(scene, s);
  if (!ok)
    vl_scene_fail_memory(scene);
  if (found && closed->kind != VL_CLOSED_TURNED)
    classify(scene, box, boxes, closed);
  if (closed->walls)
    closed->kind = VL_CLOSED_ROOM;
  if (!found && !closed->walls) {
    vl_free(scene->context, closed->shell);
    closed->shell = NULL;
  }
  return ok;
}

bool vl_closed_reach(vlScene *scene, const double (*from)[3], const double (*toward)[3],
                     uint32_t count, double *reach) {
  vlProbe *s = vl_alloc_zero(scene->context, 1, sizeof *s);
  for (uint32_t k = 0; k < count; k++)
    reach[k] = INFINITY;
  if (s && vl_probe_make(scene, s))
    for (uint32_t first = 0; first < count; first += VL_PROBE_RAYS) {
      const uint32_t n = count - first < VL_PROBE_RAYS ? count - first : VL_PROBE_RAYS;
      memcpy(s->o, from + first, n * sizeof *s->o);
      memcpy(s->d, toward + first, n * sizeof *s->d);
      vl_probe_cast(scene, s, n);
      for (uint32_t k = 0; k < n; k++)
        reach[first + k] = s->seen[k].t;
    }
  vl_probe_free(scene, s);
  if (!s)
    vl_scene_fail_memory(scene);
  return s != NULL;
}

/* ---- the opening ------------------------------------------------------------------------- */

/* Whether the face's plane separates the eye from the middle. A face of an inward shell must
 * also show the eye its back: what stands in a room, and is a part of the same mesh, stays. */
static bool stands_between(const vlShapeDef *d, const vlMat4 *m, size_t face,
                           const vlClosed *closed, const double eye[3]) {
  double c[3][3], n[3], to_eye[3], to_middle[3];
  vl_mesh_face(d, m, face, c, n);
  if (closed->walls)
    return vl_thick_hides(&closed->thick, (const double(*)[3])c, eye);
  vl_sub3(eye, c[0], to_eye);
  vl_sub3(closed->middle, c[0], to_middle);
  double a = vl_dot3(n, to_eye), b = vl_dot3(n, to_middle);
  const bool mirrored = vl_determinant3(m->m) < 0; /* it reverses the order of the corners */
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
  if (n == d->faces) {
    vl_free(scene->context, kept);
    return true;
  }
  if (n == 0) { /* a shape has a face; this one has no area */
    kept[0] = kept[1] = kept[2] = d->indices[0];
    n = 1;
  }
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
