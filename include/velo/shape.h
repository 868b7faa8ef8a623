/** @file
 * velo/shape.h: shapes: the def with their parameters, groups and instances. */
#ifndef VELO_SHAPE_H
#define VELO_SHAPE_H

#include "velo/spectrum.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The cross-section of curves. */
typedef enum vlCurveKind {
  VL_CURVE_FLAT,     /**< a strip that faces every ray */
  VL_CURVE_CYLINDER, /**< a strip that faces every ray, shaded with the normals of a tube */
  VL_CURVE_RIBBON    /**< a strip oriented by its normals */
} vlCurveKind;

/** A shape: one or many primitives with a material. */
struct vlShapeDef {
  uint32_t cookie;
  vlSource source; /**< where the file describes it */
  vlLabel label;   /**< what the file calls it; copied */
  uint32_t kind;   /**< vlShapeKind (velo/shape_kinds.h): which fields below are read */
  vlGroupId group; /**< index 0: the shape is in the world; else it is part of this group, which
                      instances place */
  double group_from_shape[16]; /**< shape space to group (or world) space */
  /** The side of normals follows pbrt-v4's rule. The normal is dpdu x dpdv in shape space (of a
   * triangle: given by the order of its corners), transformed to group space by the inverse
   * transpose. There it is flipped if exactly one of these holds: reverse_orientation is set,
   * group_from_shape mirrors. So a mirrored mesh keeps its outside, but the normals of a
   * sphere, disk, cylinder or curve turn over under a mirroring group_from_shape. Instances
   * never flip normals. Vertex normals take precedence if they are given; only
   * reverse_orientation flips them. */
  bool reverse_orientation;
  vlMaterialId material; /**< index 0: a default diffuse material of reflectance 0.5 */
  vlFloatInput alpha;    /**< coverage, 0 to 1; 1: opaque */
  vlEmissionId emission; /**< index 0: emits no light */
  /** The media on both sides of the surface; its normal points to the outside. If both ids are
   * equal (also both 0), the shape does not separate media: the surrounding medium is on both
   * sides. */
  vlMediumId inside, outside;
  /** Numbers of vertices and of faces of a mesh. Curves: faces is the number of segments,
   * vertices is 4 times that number. */
  uint32_t vertices, faces;
  const float *positions;     /**< 3 per vertex, shape space */
  const float *normals;       /**< 3 per vertex, shape space; may be null */
  const float *tangents;      /**< 3 per vertex, shape space; pbrt's S; may be null */
  const float *uvs;           /**< 2 per vertex; may be null */
  const uint32_t *indices;    /**< triangles: 3 per face; bilinear: 4 per face (pbrt's order p00
                                 p10 p01 p11) */
  const float *tangent_signs; /**< triangles: 1 per vertex; the bitangent is sign * n x tangent;
                                 null: all 1 */
  const float *more_uvs[3];   /**< triangles: uv sets 1 to 3, 2 per vertex; may be null */
  const float *colors; /**< triangles: vertex colours, 4 per vertex: linear R G B and coverage;
                          may be null */
  bool one_sided;      /**< triangles: rays that meet a back face pass through it */
  /** The shape is a part of the background: it is rendered, but alpha is 0 where camera rays
   * meet it first. */
  bool backdrop;
  /** Camera rays pass through the shape, also behind interfaces and alpha; all other rays meet
   * it. Tracers with light paths lack this: volpath takes their place. */
  bool hidden_from_camera;
  /** Moving triangles: positions and normals at times[1]; `positions` and `normals` are those
   * at times[0]. Between these times they are interpolated linearly; before and after them the
   * mesh is at rest. May be null. A moving mesh cannot emit light. */
  const float *positions_close, *normals_close;
  double times[2]; /**< seconds; default 0, 1 */
  /** Triangles at rest: a float texture displaces the vertices along their normals, in units of
   * shape space (texture index 0: none). Before that the triangles are subdivided until no edge
   * is longer than edge_length. More than 2^24 triangles are an error of vl_world_build. */
  vlFloatInput displacement;
  float edge_length; /**< largest length of an edge, group space; default 1 */
  /** Sphere, disk, cylinder: pbrt's parameters (book 6.2-6.4). The shape's axis is z in shape
   * space; phi_max is in radians. */
  float radius, inner_radius, z_min, z_max, height, phi_max;
  /** `faces` whole spheres as one shape. It takes 28 bytes per sphere, where a separate shape
   * takes about 750. The parameters above are not read, and the spheres cannot emit light. Both
   * null: one sphere at the origin. */
  const double *centers; /**< 3 per sphere, shape space */
  const float *radii;    /**< 1 per sphere, above 0 */
  /** Curves: `positions` has the 4 Bezier control points of each segment. The parameter u runs
   * along a segment, v from one side to the other. Ribbons: `normals` has the normals at both
   * ends of each segment (6 numbers per segment). Curves cannot emit light. */
  vlCurveKind curve;
  /** curves: widths at both ends of each segment, 2 per segment, shape space */
  const float *widths;
  /** Curves: each segment is cut into 2^split_depth pieces for faster intersection, into fewer
   * if there are millions of segments; default 3. The image does not depend on it. */
  uint32_t split_depth;
};
/** Adds a shape. Returns index 0 on error, for example when an index is out of range, a
 * position or normal is not finite (the message names the vertex), or a radius is not above 0.
 */
VL_API vlShapeId vl_scene_add_shape(vlScene *scene, const vlShapeDef *def);

/** Adds an empty group; shapes join it by vlShapeDef.group. name may be null. Returns index 0
 * on error. */
VL_API vlGroupId vl_scene_add_group(vlScene *scene, const char *name);
/** Places a group in the world. Groups cannot be nested. Returns index 0 on error
 * (vl_scene_result). */
VL_API vlInstanceId vl_scene_add_instance(vlScene *scene, vlGroupId group,
                                          const double world_from_group[16], vlSource source);
/** Places a moving group in the world: `keys` poses (16 numbers each) at ascending times, in
 * seconds. Between two times translation, rotation and scale are interpolated separately
 * (formulas: src/math/motion.h); before the first and after the last time the group is at rest.
 * Errors (returned by vl_scene_result): a pose is singular, only one of two consecutive poses
 * mirrors, or the times do not ascend. */
VL_API vlInstanceId vl_scene_add_moving_instance(vlScene *scene, vlGroupId group, uint32_t keys,
                                                 const double *times,
                                                 const double *world_from_group,
                                                 vlSource source);

#ifdef __cplusplus
}
#endif
#endif
