/* scene/posture.c: see posture.h. The surface is counted at points on it, of which each face
 * has as many as its share of the whole. They are spread by the additive recurrence of Roberts,
 * "The Unreasonable Effectiveness of Quasirandom Sequences", 2018. */
#include "scene/posture.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"
#include "scene/faces.h"
#include "scene/things.h"

enum {
  CELLS = 16,         /* per axis of the grid that counts the surface */
  LOWEST = CELLS / 3, /* layers of it that count as the lowest part */
  SAMPLES = 65536     /* points on all faces together */
};

typedef struct Survey {
  vlExtent box;
  double size[3];
  double whole;   /* surface of all faces */
  double sum;     /* of the weights that were counted */
  uint64_t index; /* of the next sample */
  float cells[CELLS][CELLS][CELLS];
  vlPosture *posture;
} Survey;

/* n: the unit normal; null: a point has none. */
static void add_sample(Survey *s, const double p[3], const double *n, double weight) {
  const double along = 0.98;     /* cosine with an axis above which a face is flat */
  const double outermost = 0.03; /* share of the box's size in which its ends lie */
  vlPosture *posture = s->posture;
  double at[3];
  int cell[3];
  for (int i = 0; i < 3; i++) {
    at[i] = (p[i] - s->box.low[i]) / s->size[i];
    if (!(at[i] >= 0 && at[i] <= 1))
      return; /* a stray part */
    cell[i] = (int)(at[i] * CELLS);
    cell[i] = cell[i] < CELLS ? cell[i] : CELLS - 1;
  }
  s->cells[cell[0]][cell[1]][cell[2]] += (float)weight;
  s->sum += weight;
  for (int i = 0; i < 3; i++) {
    posture->middle[i] += weight * at[i];
    if (!n)
      continue;
    const bool flat = fabs(n[i]) > along;
    posture->normal[i] += weight * n[i];
    posture->facing[i] += weight * fabs(n[i]);
    posture->flat[i] += flat ? weight : 0;
    if (flat && at[i] < outermost)
      posture->ends[i][0] += weight;
    if (flat && at[i] > 1 - outermost)
      posture->ends[i][1] += weight;
  }
}

static void add_surface(void *user, const vlFace *face) {
  Survey *s = user;
  s->whole += face->size;
}

static void add_face(void *user, const vlFace *face) {
  Survey *s = user;
  const double area = face->size;
  const double n[3] = {face->area[0] / area, face->area[1] / area, face->area[2] / area};
  const uint32_t count = 1 + (uint32_t)(SAMPLES * (area / s->whole));
  for (uint32_t k = 0; k < count; k++) {
    const double index = (double)(s->index++ % 1048576);
    /* Roberts' constants of two dimensions: 1 / x and 1 / x^2, where x^3 = x + 1 */
    double u = index * 0.7548776662466927, v = index * 0.5698402909980532;
    double p[3];
    u -= floor(u);
    v -= floor(v);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    for (int i = 0; i < 3; i++)
      p[i] = face->corners[0][i] + u * (face->corners[1][i] - face->corners[0][i]) +
             v * (face->corners[2][i] - face->corners[0][i]);
    add_sample(s, p, n, area / count);
  }
}

static void add_points(Survey *s, const vlScene *scene) {
  for (size_t k = 0; k < scene->shapes.count; k++) {
    const vlShapeDef *shape = &scene->shapes.items[k];
    if (!shape->centers || shape->group.index)
      continue;
    const vlMat4 m = vl_mat4_load(shape->group_from_shape);
    for (size_t i = 0; i < shape->faces; i++) {
      double p[3];
      vl_mat4_point(&m, shape->centers + 3 * i, p);
      add_sample(s, p, NULL, 1);
    }
  }
}

/* The weight of the cell at `at`. */
static double cell_at(const Survey *s, const int at[3]) {
  return (double)s->cells[at[0]][at[1]][at[2]];
}

/* Finds what the cells tell of an axis: symmetry, how much they cover, the fullest low layer.
 */
static void compare_cells(Survey *s, int axis) {
  vlPosture *posture = s->posture;
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  double differs = 0, layers[CELLS] = {0};
  int covered = 0, at[3], mirrored[3];
  for (at[i] = 0; at[i] < CELLS; at[i]++)
    for (at[j] = 0; at[j] < CELLS; at[j]++) {
      double column = 0;
      for (at[axis] = 0; at[axis] < CELLS; at[axis]++) {
        memcpy(mirrored, at, sizeof mirrored);
        mirrored[axis] = CELLS - 1 - at[axis];
        const double weight = cell_at(s, at);
        differs += fabs(weight - cell_at(s, mirrored));
        layers[at[axis]] += weight;
        column += weight;
      }
      covered += column > 0;
    }
  posture->symmetry[axis] = 1 - 0.5 * differs / s->sum;
  posture->covered[axis] = covered / (double)(CELLS * CELLS);
  for (int k = 0; k < LOWEST; k++)
    posture->lowest[axis] = fmax(posture->lowest[axis], layers[k] / s->sum);
}

/* Sums become means and shares. */
static void finish(Survey *s) {
  vlPosture *posture = s->posture;
  for (int axis = 0; axis < 3; axis++) {
    const double seen = s->size[(axis + 1) % 3] * s->size[(axis + 2) % 3];
    posture->silhouette[axis] = posture->facing[axis] / seen;
    posture->flat[axis] /= seen;
    posture->ends[axis][0] /= seen;
    posture->ends[axis][1] /= seen;
    posture->normal[axis] /= s->sum;
    posture->facing[axis] /= s->sum;
    posture->middle[axis] /= s->sum;
    compare_cells(s, axis);
  }
}

/* Whether the mesh consists of octahedra of their own six corners: the balls that importers
 * make of the points of a file. */
static bool is_octahedra(const vlShapeDef *shape) {
  enum { FACES = 8, CORNERS = 6 };
  if (shape->faces == 0 || shape->faces % FACES ||
      shape->vertices != shape->faces / FACES * CORNERS)
    return false;
  bool same = true;
  for (size_t i = 0; i < 3 * (size_t)shape->faces && same; i++)
    same = shape->indices[i] / CORNERS == i / (3 * FACES);
  return same;
}

/* Whether all meshes are such balls. */
static bool has_only_balls(const vlScene *scene) {
  bool only = true;
  for (size_t k = 0; k < scene->shapes.count && only; k++) {
    const vlShapeDef *shape = &scene->shapes.items[k];
    if (shape->kind == VL_SHAPE_TRIANGLES && !shape->group.index)
      only = is_octahedra(shape);
  }
  return only;
}

bool vl_posture_find(const vlScene *scene, const vlExtent *box, vlPosture *posture) {
  *posture = (vlPosture){.points = false};
  if (!vl_things_are_few(scene))
    return false;
  for (int i = 0; i < 3; i++)
    if (!(box->high[i] > box->low[i]) || !isfinite(vl_extent_size(box, i)))
      return false;
  Survey *s = vl_alloc_zero(scene->context, 1, sizeof *s);
  if (!s)
    return false; /* a guess that is not made */
  s->box = *box;
  s->posture = posture;
  vl_sub3(box->high, box->low, s->size);
  vl_faces_visit(scene, add_surface, s);
  posture->points = !(s->whole > 0);
  if (posture->points)
    add_points(s, scene);
  else
    vl_faces_visit(scene, add_face, s);
  const bool some = s->sum > 0 && isfinite(s->sum);
  if (some)
    finish(s);
  posture->points = posture->points || has_only_balls(scene);
  vl_free(scene->context, s);
  return some;
}
