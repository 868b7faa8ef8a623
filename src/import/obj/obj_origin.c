/* import/obj/obj_origin.c: the point about which an OBJ file's vertices are stored, found
 * before they are: polygons are cut as soon as they are read. */
#include <string.h>

#include "import/far.h"
#include "import/obj/obj.h"
#include "import/pbrt/decimal.h"

static bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/* Reads "v X Y Z" at the start of a line. */
static bool read_vertex(const char *p, const char *end, double v[3]) {
  while (p < end && is_blank(*p))
    p++;
  if (end - p < 2 || *p != 'v' || !is_blank(p[1]))
    return false;
  p++;
  for (int i = 0; i < 3; i++) {
    while (p < end && is_blank(*p))
      p++;
    if (!vl_number_scan(&p, end, &v[i]))
      return false;
  }
  return true;
}

void vl_obj_find_origin(vlObj *obj) {
  vlExtent box = vl_extent_nothing;
  const char *next = obj->line_start;
  while (next && next < obj->data_end) {
    double v[3];
    const char *stop = memchr(next, '\n', (size_t)(obj->data_end - next));
    const char *end = stop ? stop : obj->data_end;
    if (read_vertex(next, end, v))
      vl_extent_grow(&box, v);
    next = stop ? stop + 1 : NULL;
  }
  vl_far_origin(&box, obj->origin);
}
