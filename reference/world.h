/* world.h: the lecture's world: surfaces, materials, lights and media, made from the scene of a file. It is constant
 * while the image is taken. */
#pragma once
#include <velo/velo.h>

#include "color.h"
#include "image_map.h"
#include "vector.h"

/* A ray: the points origin + t direction for t between t_min and t_max; the direction has length 1. */
typedef struct ray {
  vector origin, direction;
  double t_min, t_max;
  double time; /* for what moves, see more/ */
} ray;

/* A shape of the scene at one place: in the world itself, or in one instance of its group. */
typedef struct placement {
  const vlShapeDef *def;
  matrix world_from_shape, shape_from_world;
  bool mesh_mirrored; /* the cross product of a triangle's edges in the world points to its inside */
  bool flip;          /* normals of quadrics point to the inside */
} placement;

/* What rays are tested against: a triangle, or a whole quadric. */
typedef struct primitive {
  uint32_t placement; /* in the world's list */
  uint32_t face;      /* of a mesh */
  int32_t light;      /* in the world's list of lights; -1: it emits none */
  vector corner[4];   /* of a face, in the world */
  vector low, high;   /* its box */
} primitive;

/* The lecture's shade record: all that is known of the point where a ray meets a surface. */
typedef struct shade_record {
  double t;
  vector point;
  vector normal;         /* of the surface itself, on its outside */
  vector shading_normal; /* interpolated between the vertices, on the same side */
  vector tangent;        /* along u */
  double u, v;
  double area_density; /* with which sample_shape draws this point, per area */
  vector arrival;      /* direction of the ray that met the point */
  double thickness;    /* of a curve, else 0: how far off the surface a new ray starts */
  const primitive *what;
  const placement *where; /* null: not on a surface, but inside a medium */
} shade_record;

typedef struct node node; /* of the accelerator */
typedef struct light light;

typedef struct world {
  vlContext *context;
  vlScene *scene;
  bool rgb;              /* red, green and blue instead of wavelengths */
  bool media_are_absent; /* the tracer "path" looks past media */
  placement *placements;
  primitive *primitives;
  node *nodes;
  light *lights;
  image_map *images; /* per texture; empty for kinds without an image */
  color_table *colors;
  vlMaterialDef standard_material; /* of shapes without one */
  uint32_t placement_count, primitive_count, light_count;
  double radius; /* of a sphere around all surfaces */
} world;

/* Makes the world of a scene, which must outlive it. False, with an error, where an image cannot be read. */
bool make_world(vlContext *context, vlScene *scene, world *w, vlError *error);

/* accelerator.c: a tree of boxes over the primitives. */
void make_accelerator(world *w);
/* The nearest surface along the ray, or false. Surfaces that are partly transparent (alpha) count with that
 * probability. */
bool find_hit(const world *w, ray r, sampler *s, shade_record *hit);

/* Where a ray meets a primitive: the distance, and the point in the primitive's own two coordinates. */
typedef struct meeting {
  double t;
  double a, b;
} meeting;

/* shape.c: a primitive of any kind. Each kind is a map from two coordinates, 0 to 1, to points in the world. */
bool meet_shape(const world *w, const primitive *p, ray r, meeting *m);
void shape_surface(const world *w, const primitive *p, double a, double b, shade_record *record);
/* A point of a primitive that emits light, drawn with the density record->area_density. */
void sample_shape(const world *w, const primitive *p, sampler *s, shade_record *record);
/* Makes the box of a primitive; makes it contain a point. */
void bound_shape(const world *w, primitive *p);
void include_point(primitive *p, vector point);

/* triangle.c, quadric.c: the kinds. */
bool meet_triangle(const primitive *p, ray r, meeting *m);
void triangle_surface(const world *w, const primitive *p, double b1, double b2, shade_record *record);
bool meet_quadric(const world *w, const primitive *p, ray r, meeting *m);
void quadric_surface(const world *w, const primitive *p, double u, double v, shade_record *record);

/* What meshes share: the normal by the rules for sides, and the vertex normals' blend. */
typedef struct mesh_corner {
  uint32_t vertex;
  double weight;
} mesh_corner;
void mesh_normals(const placement *where, const mesh_corner *corners, int count, vector by_edges, shade_record *record);

/* The distance below which a new ray does not count hits: it begins on a surface, and rounding must not let it meet
 * that surface again. Double precision leaves 1e-15 of the largest coordinate. */
static inline double surface_distance(const world *w, vector p) {
  return 1e-11 * (w->radius + fabs(p.x) + fabs(p.y) + fabs(p.z));
}
