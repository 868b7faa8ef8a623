/* world.h: the lecture's world: surfaces, materials, lights and media, made from the scene of a file. It is constant
 * while the image is taken. */
#ifndef REFERENCE_WORLD_H
#define REFERENCE_WORLD_H

#include <velo/velo.h>

#include "color.h"
#include "image_map.h"
#include "vector.h"

/* A ray: the points origin + t direction for t between t_min and t_max. */
typedef struct ray {
  vector origin, direction;
  double t_min, t_max;
} ray;

/* A shape of the scene at one place: in the world itself, or in one instance of its group. */
typedef struct placement {
  const vlShapeDef *def;
  matrix world_from_shape, shape_from_world;
  bool mesh_mirrored; /* the cross product of a triangle's edges in the world points to its inside */
  bool flip;          /* normals of quadrics point to the inside */
} placement;

/* What rays are tested against: a triangle, or a sphere, disk or cylinder. */
typedef struct primitive {
  uint32_t placement; /* in the world's list */
  uint32_t face;      /* of a mesh */
  int32_t light;      /* in the world's list of lights; -1: it emits none */
  vector corner[3];   /* of a triangle, in the world */
} primitive;

/* The lecture's shade record: all that is known of the point where a ray meets a surface. */
typedef struct shade_record {
  double t;
  vector point;
  vector normal;         /* of the surface itself, on its outside */
  vector shading_normal; /* interpolated between the vertices, on the same side */
  vector tangent;        /* along u */
  double u, v;
  double area_density; /* of a point that sample_surface draws, 1 / area */
  const primitive *what;
  const placement *where;
} shade_record;

typedef struct node node; /* of the accelerator */

/* A spectrum-valued or a number-valued input of a material, its spectrum read. */
typedef struct material material;
typedef struct light light;
typedef struct medium medium;

typedef struct world {
  vlContext *context;
  vlScene *scene;
  bool rgb;              /* red, green and blue instead of wavelengths */
  bool media_are_absent; /* the tracer "path" looks past media */
  placement *placements;
  primitive *primitives;
  uint32_t placement_count, primitive_count;
  node *nodes;
  uint32_t *order; /* primitives in the order of the accelerator's leaves */
  material *materials;
  medium *media;
  color *texture_colors; /* per texture: its four spectrum inputs */
  image_map *images;     /* per texture; empty for kinds without an image */
  uint32_t material_count, medium_count, texture_count;
  light *lights;
  uint32_t light_count;
  vector low, high; /* bounding box of all surfaces */
  double radius;    /* of a sphere around it */
} world;

/* Makes the world of a scene, which must outlive it. False, with an error that names what the reference renderer cannot
 * do. */
bool make_world(vlContext *context, vlScene *scene, world *w, vlError *error);
void free_world(world *w);

/* accelerator.c: a tree of boxes over the primitives. */
bool make_accelerator(world *w);
/* The nearest surface along the ray, or false. Surfaces that are partly transparent (alpha) count with that
 * probability. */
bool find_hit(const world *w, ray r, sampler *s, shade_record *hit);

/* triangle.c and quadric.c: one primitive. `t` is set to the distance of a hit within the ray. */
bool meet_triangle(const primitive *p, ray r, double *t);
bool meet_quadric(const world *w, const primitive *p, ray r, double *t);
void triangle_surface(const world *w, const primitive *p, vector point, shade_record *record);
void quadric_surface(const world *w, const primitive *p, vector point, shade_record *record);
/* A point of a primitive that emits light, with its density in record->area_density. */
void sample_triangle(const world *w, const primitive *p, sampler *s, shade_record *record);
void sample_quadric(const world *w, const primitive *p, sampler *s, shade_record *record);
/* The box around a primitive. */
void bound_quadric(const world *w, const primitive *p, vector *low, vector *high);

static inline bool is_triangle(const primitive *p, const world *w) {
  return w->placements[p->placement].def->kind == VL_SHAPE_TRIANGLES;
}

/* The distance below which a new ray does not count hits: it begins on a surface, and rounding must not let it meet
 * that surface again. Double precision leaves 1e-15 of the largest coordinate. */
static inline double surface_distance(const world *w, vector p) {
  return 1e-11 * (w->radius + fabs(p.x) + fabs(p.y) + fabs(p.z));
}

#endif
