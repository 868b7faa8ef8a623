/* scene/tray.c: see tray.h. */
#include "scene/tray.h"

#include <math.h>

#include "scene/faces.h"
#include "scene/posture.h"

bool vl_tray_is(const vlScene *scene, const vlExtent *box, int axis) {
  const double floor_least = 0.8, wall_least = 0.5, ceiling = 0.3, hollow = 3, sheet = 1.3,
               lower = 0.85;
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double height = vl_extent_size(box, axis);
  const double width = fmin(vl_extent_size(box, i), vl_extent_size(box, j));
  vlPosture p;
  if (!(height <= lower * width) || !vl_posture_find(scene, box, &p))
    return false;
  bool walls = true;
  for (int k = 0; k < 3; k++)
    walls = walls && (k == axis || (p.ends[k][0] >= wall_least && p.ends[k][1] >= wall_least));
  if (!walls || p.ends[axis][0] < floor_least || p.ends[axis][1] > ceiling)
    return false;
  /* a solid block with hills on it has walls with one side, and a top */
  return (p.silhouette[i] >= hollow && p.silhouette[j] >= hollow) ||
         (p.silhouette[axis] <= sheet && !vl_faces_one_sided(scene));
}
