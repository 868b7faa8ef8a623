/* world/moving.h: positions of moving objects at a time. A motion is compiled into keys
 * at equal steps of the world's time, dense enough that linear interpolation between them
 * follows the exact motion (moving.c gives the tolerance). Embree and the functions here
 * interpolate the same keys linearly, so that velo computes the primitive that Embree hit at
 * the same place, up to rounding.
 *
 * `time` is the world's time everywhere: 0 at world->time_open, 1 at world->time_close. */
#ifndef WORLD_MOVING_H
#define WORLD_MOVING_H

#include "world/world.h"

/* Converts seconds to the world's time, clamped to [0, 1]. */
float vl_world_time(const vlWorld *world, double seconds);

/* Compiles a motion of the scene: sets keys, path and the pose at time 0 of the instance.
 * `low`, `high`: bounding box of the moving group, in group space. */
struct vlSceneInstance;
vlResult vl_world_add_motion(vlWorld *world, const struct vlSceneInstance *source,
                             const float low[3], const float high[3], vlWorldInstance *instance,
                             vlError *error);
/* Sets world->moves, time_open, time_close from the scene. */
void vl_world_find_times(vlWorld *world, const struct vlScene *scene);
/* Smallest number of equal steps over the world's time for which `from` and `to` (seconds) fall
 * on keys; 0: there is none. */
uint32_t vl_world_time_steps(const vlWorld *world, double from, double to);

/* Sets *moved to an instance at rest with the pose that q has at that time. */
void vl_instance_move(const vlWorldInstance *q, float time, vlWorldInstance *moved);
static inline const vlWorldInstance *vl_instance_at(const vlWorldInstance *q, float time,
                                                    vlWorldInstance *moved) {
  if (q->keys == 0)
    return q;
  vl_instance_move(q, time, moved);
  return moved;
}

typedef struct vlTimeStep {
  uint32_t first; /* index of the key before the time */
  float part;     /* fraction of the step, 0 to 1 */
} vlTimeStep;
static inline vlTimeStep vl_time_step(float time, uint32_t keys) {
  float at = time * (float)(keys - 1);
  int32_t last = (int32_t)keys - 2, first = (int32_t)at;
  first = first > last ? last : first;
  first = first < 0 ? 0 : first;
  return (vlTimeStep){(uint32_t)first, at - (float)first};
}

/* Interpolates the position or the normal of a vertex at `time`, for a shape with several
 * steps. rows: s->positions or s->normals. */
static inline void vl_moving_vertex(const vlWorldShape *s, const float *rows, uint32_t vertex,
                                    float time, float out[3]) {
  vlTimeStep k = vl_time_step(time, s->steps);
  const float *a = rows + 3 * ((size_t)k.first * s->vertices + vertex),
              *b = a + 3 * (size_t)s->vertices;
  for (int i = 0; i < 3; i++)
    out[i] = a[i] * (1.0f - k.part) + b[i] * k.part;
}
/* Bound of the rounding error of the vertex's position, for velo's and Embree's computation
 * together. */
float vl_moving_vertex_error(const vlWorldShape *s, uint32_t vertex, float time);

/* A vertex's row of positions or normals. The result points to `room` if the vertex moves,
 * otherwise into the shape.
 */
static inline const float *vl_row_at(const vlWorldShape *s, const float *rows, uint32_t vertex,
                                     float time, float room[3]) {
  if (s->steps <= 1)
    return rows + 3 * (size_t)vertex;
  vl_moving_vertex(s, rows, vertex, time, room);
  return room;
}
static inline const float *vl_vertex_at(const vlWorldShape *s, uint32_t vertex, float time,
                                        float room[3]) {
  return vl_row_at(s, s->positions, vertex, time, room);
}
static inline const float *vl_normal_at(const vlWorldShape *s, uint32_t vertex, float time,
                                        float room[3]) {
  return vl_row_at(s, s->normals, vertex, time, room);
}

/* Gives the position at to_seconds of the surface point that is at `point` at from_seconds, in
 * world space. For optical flow. */
void vl_world_follow(const vlWorld *world, uint32_t shape, uint32_t prim, uint32_t instance,
                     double from_seconds, double to_seconds, const double point[3],
                     double moved[3]);
/* The velocity of the surface point that is at `point` at the world's time `time`: world space,
 * scene units per second. Between the keys of an instance it is interpolated, so that the error
 * falls with the square of their step, as that of the positions does; where the motion bends
 * sharply at a key, it is that of the step. At a key it is that of the step that follows. */
void vl_world_velocity(const vlWorld *world, uint32_t shape, uint32_t prim, uint32_t instance,
                       float time, const double point[3], double velocity[3]);

#endif
