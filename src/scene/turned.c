/* scene/turned.c: see turned.h. */
#include "scene/turned.h"

#include "math/double3.h"
#include "scene/faces.h"
#include "scene/posture.h"

typedef struct Part {
  double volume; /* three times it; negative: the faces look inwards */
  double sum[3]; /* of the faces' areas, as vectors */
  double area;
} Part;

typedef struct Solids {
  const vlScene *scene;
  const bool *shell;
  double center[3];
  Part parts[2]; /* contents, shell */
} Solids;

static void add_face(void *user, const vlFace *face) {
  Solids *s = user;
  Part *part = &s->parts[s->shell[face->shape - s->scene->shapes.items]];
  for (int i = 0; i < 3; i++) {
    part->volume += face->area[i] * (face->middle[i] - s->center[i]);
    part->sum[i] += face->area[i];
  }
  part->area += face->size;
}

/* Whether three ends of the box are flat walls: floor, and walls on two sides. */
static bool has_walls(const vlPosture *p) {
  const double wall = 0.5;
  int walls = 0;
  for (int axis = 0; axis < 3; axis++)
    walls += (p->ends[axis][0] >= wall) + (p->ends[axis][1] >= wall);
  return walls >= 3;
}

/* Whether faces with this sum of areas are nearly closed. */
static bool is_closed(const double sum[3], double area) {
  return vl_norm3(sum) < 0.15 * area;
}

bool vl_turned_is(const vlScene *scene, const vlExtent *box, const bool *shell, bool contents,
                  bool surrounds) {
  Solids s = {.scene = scene, .shell = shell};
  vlPosture posture;
  vl_extent_middle(box, s.center);
  vl_faces_visit(scene, add_face, &s);
  const Part *inner = &s.parts[0], *outer = &s.parts[1];
  if (contents && !(inner->volume < 0 && is_closed(inner->sum, inner->area)))
    return false;
  if (!surrounds && !(outer->volume < 0 && is_closed(outer->sum, outer->area)))
    return false;
  return vl_posture_find(scene, box, &posture) && !has_walls(&posture);
}
