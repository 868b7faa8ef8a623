/* render/outline.c: the box of one object or instance in space, and the box of its projection.
 *
 * The box of a projection is that of the projected corners: exact for triangles and bilinear
 * patches where straight lines stay straight (a linear function on a bilinear patch is largest
 * at a corner). Round shapes use points of their rims and of a fine grid. */
#include <math.h>
#include <string.h>

#include "camera/moments.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "render/boxes.h"
#include "velo/schema.h"
#include "velo/shape_kinds.h"
#include "world/moving.h"

enum { CHUNK = 256, AROUND = 256, RINGS = 64 };

/* Points to be added to the boxes, a chunk at a time. */
typedef struct Points {
  const vlCamera *camera;
  const float *transform; /* the instance's transform: 3x4, or null */
  vlIdBox *box;
  bool space, outline, whole;      /* requested boxes; whole: all points so far projected */
  const vlBoxRows *rows;           /* of a rolling shutter; null: all is seen at one time */
  const vlWorldInstance *instance; /* with rows: as it moves; null: none */
  uint32_t count;
  double own[3 * CHUNK], world[3 * CHUNK];
  const vlWorldShape *shape[CHUNK]; /* with rows: the mesh of a vertex; null: another point */
  uint32_t vertex[CHUNK];
} Points;

/* A point of the chunk. */
typedef struct Moving {
  const Points *points;
  uint32_t index;
} Moving;

/* A vlSeenFn: where the camera sees a point, both at a time. */
static bool seen_at(void *user, double seconds, double film[2]) {
  const Moving *m = user;
  const Points *p = m->points;
  float time = vl_world_time(p->rows->world, seconds), room[3];
  double own[3], at[3];
  memcpy(own, p->own + 3 * m->index, sizeof own);
  if (p->shape[m->index]) {
    const float *x = vl_vertex_at(p->shape[m->index], p->vertex[m->index], time, room);
    for (int k = 0; k < 3; k++)
      own[k] = (double)x[k];
  }
  memcpy(at, own, sizeof at);
  vlWorldInstance held;
  if (p->instance)
    vl_float_map_point(vl_instance_at(p->instance, time, &held)->from_group, own, at);
  return vl_camera_film_at(p->rows->camera, seconds, at, film);
}

/* The film points of the chunk, each at the time of the row that sees it. */
static void project_rows(const Points *p, double *pixels, uint8_t *valid) {
  for (uint32_t i = 0; i < p->count; i++) {
    Moving m = {p, i};
    double seconds;
    valid[i] = vl_camera_find_time(p->rows->camera, seen_at, &m, &seconds, pixels + 2 * i);
    if (!valid[i])
      pixels[2 * i] = pixels[2 * i + 1] = 0.0;
  }
}

static void flush(Points *p) {
  double pixels[2 * CHUNK];
  uint8_t valid[CHUNK];
  vlIdBox *b = p->box;
  if (p->count == 0)
    return;
  for (uint32_t i = 0; i < p->count && p->space; i++)
    for (int k = 0; k < 3; k++) {
      b->low[k] = fmin(b->low[k], p->own[3 * i + (uint32_t)k]);
      b->high[k] = fmax(b->high[k], p->own[3 * i + (uint32_t)k]);
    }
  if (p->outline && p->rows)
    project_rows(p, pixels, valid);
  else if (p->outline)
    vl_camera_project_batch(p->camera, p->count, p->world, pixels, NULL, valid);
  for (uint32_t i = 0; i < p->count && p->outline; i++) {
    p->whole = p->whole && valid[i];
    for (int k = 0; k < 2; k++) {
      b->outline[k] = fmin(b->outline[k], pixels[2 * i + (uint32_t)k]);
      b->outline[2 + k] = fmax(b->outline[2 + k], pixels[2 * i + (uint32_t)k]);
    }
  }
  p->count = 0;
}

/* Adds a point in the space of the shape's group; shape: the mesh of which it is a vertex, or
 * null. */
static void add_of(Points *p, double x, double y, double z, const vlWorldShape *shape,
                   uint32_t vertex) {
  double *own = p->own + 3 * p->count, *world = p->world + 3 * p->count;
  own[0] = x;
  own[1] = y;
  own[2] = z;
  memcpy(world, own, 3 * sizeof *own);
  if (p->transform)
    vl_float_map_point(p->transform, own, world);
  p->shape[p->count] = shape;
  p->vertex[p->count] = vertex;
  if (++p->count == CHUNK)
    flush(p);
}

static void add(Points *p, double x, double y, double z) {
  add_of(p, x, y, z, NULL, 0);
}

static void add_vertices(Points *p, const vlWorldShape *s, float time) {
  float room[3];
  for (uint32_t i = 0; i < s->vertices; i++) {
    const float *x = vl_vertex_at(s, i, time, room);
    add_of(p, (double)x[0], (double)x[1], (double)x[2], s, i);
  }
}

/* Adds points of a circle of radius r at height z in object space, over the shape's phi
 * range. */
static void add_ring(Points *p, const vlWorldShape *s, double r, double z) {
  for (int i = 0; i <= AROUND; i++) {
    double phi = (double)s->phi_max * i / AROUND, q[3];
    const double at[3] = {r * vl_precise_cos(phi), r * vl_precise_sin(phi), z};
    vl_map_point(s->from_shape, at, q);
    add(p, q[0], q[1], q[2]);
  }
}

static void add_round(Points *p, const vlWorldShape *s) {
  double r = (double)s->radius;
  if (s->kind == VL_SHAPE_DISK) {
    add_ring(p, s, r, (double)s->height);
    add_ring(p, s, (double)s->inner_radius, (double)s->height);
    return;
  }
  if (s->kind == VL_SHAPE_CYLINDER) {
    add_ring(p, s, r, (double)s->z_min);
    add_ring(p, s, r, (double)s->z_max);
    return;
  }
  double from = vl_precise_acos(fmax(-1, fmin(1, (double)s->z_min / r))),
         to = vl_precise_acos(fmax(-1, fmin(1, (double)s->z_max / r)));
  for (int i = 0; i <= RINGS; i++) {
    double theta = from + (to - from) * i / RINGS;
    add_ring(p, s, r * vl_precise_sin(theta), r * vl_precise_cos(theta));
  }
}

/* Adds the corners of the boxes of faces: curve segments, many spheres. */
static void add_pieces(Points *p, const vlWorldShape *s) {
  for (uint32_t i = 0; i < s->faces; i++) {
    float low[3], high[3];
    vl_world_prim_bounds(s, i, low, high);
    for (int c = 0; c < 8; c++)
      add(p, (double)(c & 1 ? low : high)[0], (double)(c & 2 ? low : high)[1],
          (double)(c & 4 ? low : high)[2]);
  }
}

static void add_shape(Points *p, const vlWorldShape *s, float time) {
  if (s->centers) {
    add_pieces(p, s);
    return;
  }
  if (s->traits & VL_SHAPE_TRAIT_MESH)
    add_vertices(p, s, time);
  else if (s->traits & VL_SHAPE_TRAIT_QUADRIC)
    add_round(p, s);
  else
    add_pieces(p, s);
}

uint64_t vl_box_points(const vlWorldShape *s) {
  if (s->traits & VL_SHAPE_TRAIT_MESH)
    return s->vertices;
  bool rings = (s->traits & VL_SHAPE_TRAIT_QUADRIC) && !s->centers;
  return rings ? (uint64_t)RINGS * AROUND : 8 * (uint64_t)s->faces;
}

static Points begin(const vlCamera *camera, const vlBoxRows *rows, vlIdBox *box,
                    const float *transform) {
  for (int k = 0; k < 3; k++) {
    box->low[k] = INFINITY;
    box->high[k] = -INFINITY;
  }
  for (int k = 0; k < 2; k++) {
    box->outline[k] = INFINITY;
    box->outline[2 + k] = -INFINITY;
  }
  for (int i = 0; i < 16; i++)
    box->world_from_box[i] = i % 5 == 0;
  for (int i = 0; i < 12 && transform; i++)
    box->world_from_box[i] = (double)transform[i];
  return (Points){
      .camera = camera, .rows = rows, .transform = transform, .box = box, .whole = true};
}

static void end(Points *p) {
  flush(p);
  vlIdBox *b = p->box;
  b->has_space = b->low[0] <= b->high[0];
  b->has_outline = p->outline && p->whole && b->outline[0] <= b->outline[2];
  if (!b->has_outline)
    memset(b->outline, 0, sizeof b->outline);
  if (!b->has_space) {
    memset(b->low, 0, sizeof b->low);
    memset(b->high, 0, sizeof b->high);
  }
}

void vl_box_of_object(const vlWorld *world, const vlCamera *camera, const vlBoxRows *rows,
                      float time, uint32_t id, bool grouped, vlIdBox *box) {
  Points p = begin(camera, rows, box, NULL);
  p.space = true;
  p.outline = !grouped;
  box->grouped = grouped;
  add_shape(&p, &world->shapes.items[id - 1], time);
  end(&p);
}

void vl_box_of_instance(const vlWorld *world, const vlCamera *camera, const vlBoxRows *rows,
                        float time, uint32_t id, bool corners, vlIdBox *box) {
  vlWorldInstance room;
  const vlWorldInstance *q = vl_instance_at(&world->instances.items[id - 1], time, &room);
  const vlWorldGroup *group = &world->groups.items[q->group];
  Points p = begin(camera, rows, box, q->from_group);
  p.instance = &world->instances.items[id - 1];
  p.outline = true;
  for (int c = 0; c < 8 && corners; c++)
    add(&p, (double)(c & 1 ? group->low : group->high)[0],
        (double)(c & 2 ? group->low : group->high)[1],
        (double)(c & 4 ? group->low : group->high)[2]);
  for (uint32_t i = 0; i < group->count && !corners; i++)
    add_shape(&p, &world->shapes.items[group->shapes[i]], time);
  flush(&p);
  for (int k = 0; k < 3; k++) {
    box->low[k] = (double)group->low[k];
    box->high[k] = (double)group->high[k];
  }
  end(&p);
}
