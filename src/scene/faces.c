/* scene/faces.c: see faces.h. */
#include "scene/faces.h"

#include <math.h>

#include "math/double3.h"
#include "scene/extent.h"

/* sign: 1, or -1 where the outside is opposite to the side that the corners' order gives. */
static vlFace face_of(const vlShapeDef *shape, const vlMat4 *m, double sign, size_t index) {
  vlFace face = {.shape = shape};
  double n[3], (*p)[3] = face.corners;
  vl_mesh_face(shape, m, index, p, n);
  for (int i = 0; i < 3; i++) {
    face.area[i] = 0.5 * sign * n[i];
    face.middle[i] = (p[0][i] + p[1][i] + p[2][i]) / 3;
  }
  face.size = vl_norm3(face.area);
  return face;
}

void vl_faces_visit(const vlScene *scene, vlFaceVisit *visit, void *user) {
  VL_EACH_ITEM(const vlShapeDef, shape, &scene->shapes) {
    if (shape->kind != VL_SHAPE_TRIANGLES || shape->group.index)
      continue;
    const vlMat4 m = vl_mat4_load(shape->group_from_shape);
    /* it reverses the corners' order alone */
    const bool mirrored = vl_determinant3(m.m) < 0;
    const double sign = shape->reverse_orientation != mirrored ? -1 : 1;
    for (size_t i = 0; i < shape->faces; i++) {
      const vlFace face = face_of(shape, &m, sign, i);
      if (face.size > 0 && isfinite(face.size))
        visit(user, &face);
    }
  }
}

bool vl_faces_one_sided(const vlScene *scene) {
  VL_EACH_ITEM(const vlShapeDef, shape, &scene->shapes) {
    if (shape->one_sided)
      return true;
  }
  return false;
}
