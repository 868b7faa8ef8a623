/* import/obj/obj_polygon.c: triangulation of polygons. Four corners are split along the
 * diagonal that lies inside. Larger polygons are cut by ear clipping (Meisters 1975) in the
 * coordinate plane nearest to the polygon's. Very large ones become fans. */
#include <math.h>

#include "import/obj/obj.h"

enum { MAX_EARS = 512 };

typedef struct Plane {
  const vlObj *obj;
  int x, y; /* the axes of the projection plane */
  double sign;
} Plane;

static const float *corner(const Plane *p, uint32_t i) {
  return vl_obj_position(p->obj, p->obj->polygon.items[i].v);
}

/* Twice the signed area; positive when a, b, c have the orientation of the polygon. */
static double turn(const Plane *p, uint32_t a, uint32_t b, uint32_t c) {
  const float *u = corner(p, a), *v = corner(p, b), *w = corner(p, c);
  return p->sign * (((double)v[p->x] - u[p->x]) * ((double)w[p->y] - u[p->y]) -
                    ((double)v[p->y] - u[p->y]) * ((double)w[p->x] - u[p->x]));
}

static Plane find_plane(const vlObj *obj) {
  double n[3] = {0, 0, 0};
  size_t count = obj->polygon.count;
  Plane p = {.obj = obj};
  for (size_t i = 0; i < count; i++) { /* Newell's normal */
    const float *a = corner(&p, (uint32_t)i), *b = corner(&p, (uint32_t)((i + 1) % count));
    for (int k = 0; k < 3; k++) {
      int u = (k + 1) % 3, v = (k + 2) % 3;
      n[k] += ((double)a[u] - b[u]) * ((double)a[v] + b[v]);
    }
  }
  int k = fabs(n[0]) > fabs(n[1]) ? 0 : 1;
  if (fabs(n[2]) > fabs(n[k]))
    k = 2;
  p.x = (k + 1) % 3;
  p.y = (k + 2) % 3;
  p.sign = n[k] < 0 ? -1 : 1;
  return p;
}

static bool is_ear(const Plane *p, const uint32_t *left, size_t n, size_t i) {
  uint32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
  if (!(turn(p, a, b, c) > 0))
    return false;
  for (size_t k = 0; k < n; k++) {
    uint32_t q = left[k];
    if (q == a || q == b || q == c)
      continue;
    if (turn(p, a, b, q) >= 0 && turn(p, b, c, q) >= 0 && turn(p, c, a, q) >= 0)
      return false;
  }
  return true;
}

static void put(vlObj *obj, uint32_t a, uint32_t b, uint32_t c) {
  const uint32_t three[3] = {a, b, c};
  for (int i = 0; i < 3; i++)
    obj->ears.items[obj->ears.count++] = three[i];
}

bool vl_obj_triangulate(vlObj *obj, uint32_t *triangles) {
  size_t n = obj->polygon.count;
  *triangles = (uint32_t)(n - 2);
  obj->ears.count = 0;
  if (!VL_RESERVE(obj->context, &obj->ears, 3 * n))
    return vl_obj_fail_memory(obj);
  if (n == 3) {
    put(obj, 0, 1, 2);
    return true;
  }
  Plane p = find_plane(obj);
  if (n == 4) {
    bool good = turn(&p, 0, 1, 2) > 0 && turn(&p, 0, 2, 3) > 0;
    bool other = turn(&p, 1, 2, 3) > 0 && turn(&p, 1, 3, 0) > 0;
    if (good || !other) {
      put(obj, 0, 1, 2);
      put(obj, 0, 2, 3);
    } else {
      put(obj, 1, 2, 3);
      put(obj, 1, 3, 0);
    }
    return true;
  }
  uint32_t left[MAX_EARS];
  size_t count = n <= MAX_EARS ? n : 0, stuck = 0, i = 0;
  if (!count) {
    for (uint32_t k = 2; k < n; k++)
      put(obj, 0, k - 1, k);
    return true;
  }
  for (uint32_t k = 0; k < count; k++)
    left[k] = k;
  while (count > 3) {
    /* stuck: the polygon crosses itself or has no area */
    if (is_ear(&p, left, count, i) || stuck >= count) {
      put(obj, left[(i + count - 1) % count], left[i], left[(i + 1) % count]);
      for (size_t k = i; k + 1 < count; k++)
        left[k] = left[k + 1];
      count--;
      stuck = 0;
      if (i >= count)
        i = 0;
    } else {
      i = (i + 1) % count;
      stuck++;
    }
  }
  put(obj, left[0], left[1], left[2]);
  return true;
}
