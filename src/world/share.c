/* world/share.c: see share.h. A shape of the same scene is recognised by its index, if it was
 * not set since the previous world was built. Others, and displaced meshes, are compiled and
 * then compared number by number. */
#include "world/share.h"

#include <string.h>

#include "scene/scene.h"
#include "velo/shape_kinds.h"

/* ---- comparison -------------------------------------------------------------------------- */

enum { ARRAYS = 13 };

/* The arrays of a shape's geometry; null: it has none of that kind. */
typedef struct Arrays {
  void *item[ARRAYS];
  size_t bytes[ARRAYS];
  int count;
} Arrays;

static void list(Arrays *a, void *item, size_t count, size_t size) {
  a->item[a->count] = item;
  a->bytes[a->count++] = count * size;
}

static Arrays arrays_of(const vlWorldShape *s) {
  const size_t vertices = s->vertices;
  const size_t corners = s->kind == VL_SHAPE_BILINEAR ? 4 : 3;
  const size_t segments = s->faces >> s->split;
  const bool curves = s->kind == VL_SHAPE_CURVES;
  const size_t points = curves ? 4 * segments : vertices * s->steps;
  const size_t normals = curves ? 2 * segments : vertices * s->steps;
  Arrays a = {.count = 0};
  list(&a, s->positions, 3 * points, sizeof(float));
  list(&a, s->normals, 3 * normals, sizeof(float));
  list(&a, s->tangents, 3 * vertices, sizeof(float));
  list(&a, s->uvs, 2 * vertices, sizeof(float));
  list(&a, s->indices, corners * s->faces, sizeof(uint32_t));
  list(&a, s->tangent_signs, vertices, sizeof(float));
  for (int k = 0; k < 3; k++)
    list(&a, s->more_uvs[k], 2 * vertices, sizeof(float));
  list(&a, s->colors, 4 * vertices, sizeof(float));
  list(&a, s->widths, 2 * segments, sizeof(float));
  list(&a, s->centers, (size_t)3 * s->faces, sizeof(double));
  list(&a, s->radii, s->faces, sizeof(float));
  return a;
}

/* Clears the members that do not describe the geometry, and the addresses. */
static void clear_all_but_geometry(vlWorldShape *s) {
  s->material = s->first_light = s->inside = s->outside = 0;
  s->alpha = 0;
  s->pass_shadow = s->backdrop = s->hidden = false;
  s->positions = s->normals = s->tangents = s->uvs = s->tangent_signs = s->colors =
      s->emission_uvs = s->widths = NULL;
  s->radii = NULL;
  s->centers = NULL;
  s->indices = s->light_of = NULL;
  for (int k = 0; k < 3; k++)
    s->more_uvs[k] = NULL;
}

/* Whether all that describes the geometry, except for the arrays, is the same. */
static bool same_numbers(const vlWorldShape *a, const vlWorldShape *b) {
  vlWorldShape x, y;
  memcpy(&x, a, sizeof x); /* with the padding, which is 0 */
  memcpy(&y, b, sizeof y);
  clear_all_but_geometry(&x);
  clear_all_but_geometry(&y);
  return memcmp(&x, &y, sizeof x) == 0;
}

static bool same_arrays(const vlWorldShape *a, const vlWorldShape *b) {
  Arrays x = arrays_of(a), y = arrays_of(b);
  for (int k = 0; k < x.count; k++) {
    if (!x.item[k] != !y.item[k] || (x.item[k] && x.bytes[k] != y.bytes[k]))
      return false;
    if (x.item[k] && x.item[k] != y.item[k] && memcmp(x.item[k], y.item[k], x.bytes[k]) != 0)
      return false;
  }
  return true;
}

bool vl_shape_same(const vlWorld *world, size_t i, const vlWorld *previous, size_t j) {
  const vlWorldShape *a = &world->shapes.items[i], *b = &previous->shapes.items[j];
  if (a->kind != b->kind || world->shape_parts[i] != previous->shape_parts[j] ||
      a->pass_shadow != b->pass_shadow || (a->alpha < 0) != (b->alpha < 0) ||
      a->one_sided != b->one_sided)
    return false;
  return world->shape_parts[i] || same_numbers(a, b);
}

/* ---- reuse ------------------------------------------------------------------------------- */

/* Gives *s the geometry of another shape. */
static void take_geometry(const vlWorldShape *from, vlWorldShape *s) {
  vlWorldShape own = *s;
  memcpy(s, from, sizeof *s);
  s->material = own.material;
  s->alpha = own.alpha;
  s->pass_shadow = own.pass_shadow;
  s->backdrop = own.backdrop;
  s->hidden = own.hidden;
  s->first_light = VL_NONE;
  s->inside = s->outside = 0;
  s->light_of = NULL;
  s->emission_uvs = NULL;
}

static bool same_times(const vlWorld *a, const vlWorld *b) {
  return a->time_open == b->time_open && a->time_close == b->time_close;
}

bool vl_shape_reuse(vlWorld *world, const vlScene *scene, size_t index, vlWorldShape *s,
                    bool *done) {
  const vlWorld *previous = world->previous;
  *done = false;
  if (!previous || previous->scene_number != scene->number || index >= previous->shapes.count ||
      scene->shapes.items[index].displacement.texture.index ||
      vl_scene_mark(&scene->shape_marks, index).generation > previous->number)
    return true;
  const vlWorldShape *old = &previous->shapes.items[index];
  if (old->steps > 1 && !same_times(world, previous))
    return true;
  vlPart *part = previous->shape_parts[index];
  if (part && !vl_part_share(world, part))
    return false;
  take_geometry(old, s);
  world->shape_parts[index] = part;
  world->shape_from[index] = (uint32_t)index;
  *done = true;
  return true;
}

/* ---- search ------------------------------------------------------------------------------ */

/* A hash table of the previous world's shapes with parts. */
struct vlShapeSearch {
  uint32_t size, *first, *next; /* first: by hash; index + 1 of a shape, 0: none */
};

/* A hash of a few numbers of the geometry. */
static uint32_t fingerprint(const vlWorldShape *s) {
  uint32_t h = (uint32_t)s->kind * 31 + s->vertices * 2654435761u + s->faces * 40503u;
  Arrays a = arrays_of(s);
  for (int k = 0; k < a.count; k++) {
    size_t words = a.item[k] ? a.bytes[k] / 4 : 0;
    for (size_t i = 0; i < words; i += words / 8 + 1) {
      uint32_t word;
      memcpy(&word, (const char *)a.item[k] + 4 * i, 4);
      h = (h ^ word) * 16777619u + (uint32_t)k;
    }
  }
  return h;
}

static struct vlShapeSearch *make_search(vlWorld *world) {
  const vlWorld *previous = world->previous;
  uint32_t size = 16;
  while (size < previous->shapes.count)
    size *= 2;
  struct vlShapeSearch *t = vl_world_block(world, 1, sizeof *t);
  if (!t)
    return NULL;
  t->size = size;
  t->first = vl_world_block(world, size, sizeof *t->first);
  t->next = vl_world_block(world, previous->shapes.count + 1, sizeof *t->next);
  if (!t->first || !t->next)
    return NULL;
  memset(t->first, 0, size * sizeof *t->first);
  /* from the last to the first, so that of equal shapes the first is found first */
  for (uint32_t i = (uint32_t)previous->shapes.count; i-- > 0;) {
    if (!previous->shape_parts[i])
      continue;
    uint32_t *slot = &t->first[fingerprint(&previous->shapes.items[i]) & (size - 1)];
    t->next[i] = *slot;
    *slot = i + 1;
  }
  return t;
}

bool vl_shape_match(vlWorld *world, size_t index, vlWorldShape *s) {
  const vlWorld *previous = world->previous;
  if (!previous)
    return true;
  vlPart *current = world->part;
  world->part = NULL; /* the table belongs to the world */
  if (!world->shape_search)
    world->shape_search = make_search(world);
  world->part = current;
  const struct vlShapeSearch *t = world->shape_search;
  if (!t)
    return false;
  for (uint32_t i = t->first[fingerprint(s) & (t->size - 1)]; i; i = t->next[i - 1]) {
    const vlWorldShape *old = &previous->shapes.items[i - 1];
    if (!same_numbers(old, s) || !same_arrays(old, s))
      continue;
    vl_part_drop(world, world->shape_parts[index]);
    take_geometry(old, s);
    world->shape_parts[index] = previous->shape_parts[i - 1];
    world->shape_from[index] = i - 1;
    return vl_part_share(world, previous->shape_parts[i - 1]);
  }
  return true;
}
