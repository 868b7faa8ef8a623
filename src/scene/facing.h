/* scene/facing.h: which side of a model is its front, as far as its triangles tell. Shapes in
 * groups are left out. */
#ifndef SCENE_FACING_H
#define SCENE_FACING_H

#include <stdbool.h>

#include "scene/extent.h"
#include "scene/scene.h"

/* Sum of the faces' normals, weighted by area, divided by the sum of the areas. Of a closed
 * surface it is zero but for rounding: then neither side is its front. one_sided: only faces
 * count that are not seen from behind. */
void vl_facing_mean_normal(const vlScene *scene, bool one_sided, double n[3]);

/* Whether the model has clearly more detail on the side away from `front` (a unit vector). Of a
 * closed surface both sides have the same projected area, however it is made: so of triangles
 * of one size they have the same number, weighted by the cosine between normal and direction.
 * People spend triangles on faces, hands and dials. box: of the whole scene. False also of
 * models of few triangles. */
bool vl_facing_is_behind(const vlScene *scene, const vlExtent *box, const double front[3]);

/* How far a model consists of blocks that stand on a plane. Shares of the area of the model's
 * surface; flat: with a normal along the axis, up to 5 degrees. */
typedef struct vlBlocks {
  double flat;
  double walls;   /* with a normal at right angles to the axis, up to 5 degrees */
  double lower;   /* flat, in the lower half of the box */
  double ends[2]; /* flat, in the first and the last of 64 layers along the axis */
  int levels;     /* number of these layers of which more than a thousandth is flat */
} vlBlocks;
/* box: of the whole scene; axis: 0 to 2. */
vlBlocks vl_facing_blocks(const vlScene *scene, const vlExtent *box, int axis);

/* Whether the model has raised parts on the side away from `front`, and a plane on its side:
 * flat parts at its outermost behind, of a tenth to four fifths of those in front. */
bool vl_facing_raised_is_behind(const vlScene *scene, const vlExtent *box,
                                const double front[3]);

#endif
