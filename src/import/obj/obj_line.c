/* import/obj/obj_line.c: points (p) and lines (l) of OBJ files: balls and tubes. */
#include <stdlib.h>

#include "base/free.h"
#include "base/text.h"
#include "import/far.h"
#include "import/obj/obj.h"
#include "velo/shape_kinds.h"

/* Radius of balls and tubes over the diagonal of the vertices' box: about a pixel, as in glTF
 * without a camera. */
static const double THIN = 0.0015;

/* The vertex that a word "v" or "v/vt" names, from 1; 0 after an error. */
static uint32_t read_vertex(vlObj *obj, const char *word, size_t n) {
  const bool back = n && *word == '-';
  uint64_t v = 0;
  size_t i = back;
  for (; i < n && word[i] >= '0' && word[i] <= '9' && v < UINT32_MAX; i++)
    v = 10 * v + (uint64_t)(word[i] - '0');
  const uint64_t count = obj->positions.count / 3,
                 index = back ? count + 1 - (v <= count ? v : count + 1) : v;
  if (i > back && (i == n || word[i] == '/') && index >= 1 && index <= count)
    return (uint32_t)index;
  vl_obj_fail(obj, "\"%s\" is none of the %llu vertices so far", vl_short_text_of(word, n).text,
              (unsigned long long)count);
  return 0;
}

bool vl_obj_read_marks(vlObj *obj, bool lines) {
  const char *word;
  uint32_t before = 0;
  for (size_t n = vl_obj_word(obj, &word); n; n = vl_obj_word(obj, &word)) {
    const uint32_t v = read_vertex(obj, word, n);
    if (!v)
      return false;
    if (!lines || before) {
      vlObjMark *mark = VL_PUSH(obj->context, &obj->marks);
      if (!mark)
        return vl_obj_fail_memory(obj);
      *mark = (vlObjMark){v, lines ? before : 0, obj->material, obj->line};
    }
    before = v;
  }
  return true;
}

/* By material, points before lines. */
static int compare(const void *a, const void *b) {
  const vlObjMark *x = a, *y = b;
  if (x->material != y->material)
    return x->material < y->material ? -1 : 1;
  if (!x->from != !y->from)
    return x->from ? 1 : -1;
  if (x->v != y->v)
    return x->v < y->v ? -1 : 1;
  return (x->from > y->from) - (x->from < y->from);
}

/* Adds the shape of two arrays, which are freed; null: memory is exhausted. */
static bool add_shape(vlObj *obj, const vlShapeDef *def, void *a, void *b) {
  bool fine = a && b ? vl_scene_add_shape(obj->scene, def).index != 0 : vl_obj_fail_memory(obj);
  VL_FREE(obj->context, a, b);
  return fine;
}

static bool add_points(vlObj *obj, const vlObjMark *marks, size_t count, float radius,
                       vlShapeDef *def) {
  double *centers = vl_alloc_array(obj->context, count, 3 * sizeof *centers);
  float *radii = vl_alloc_array(obj->context, count, sizeof *radii);
  for (size_t i = 0; centers && radii && i < count; i++) {
    for (size_t k = 0; k < 3; k++)
      centers[3 * i + k] = (double)vl_obj_position(obj, marks[i].v)[k];
    radii[i] = radius;
  }
  vl_far_place(obj->origin, def);
  def->kind = VL_SHAPE_SPHERE;
  def->centers = centers;
  def->radii = radii;
  return add_shape(obj, def, centers, radii);
}

static bool add_lines(vlObj *obj, const vlObjMark *marks, size_t count, float radius,
                      vlShapeDef *def) {
  float *points = vl_alloc_array(obj->context, count, 12 * sizeof *points);
  float *widths = vl_alloc_array(obj->context, count, 2 * sizeof *widths);
  for (size_t i = 0; points && widths && i < count; i++) {
    const float *a = vl_obj_position(obj, marks[i].from);
    const float *b = vl_obj_position(obj, marks[i].v);
    for (size_t k = 0; k < 12; k++)
      points[12 * i + k] = a[k % 3] + (b[k % 3] - a[k % 3]) * (float)(k / 3) / 3;
    widths[2 * i] = widths[2 * i + 1] = 2 * radius;
  }
  vl_far_place(obj->origin, def);
  def->kind = VL_SHAPE_CURVES;
  def->curve = VL_CURVE_CYLINDER;
  def->vertices = (uint32_t)(4 * count);
  def->positions = points;
  def->widths = widths;
  return add_shape(obj, def, points, widths);
}

bool vl_obj_add_marks(vlObj *obj) {
  const double diagonal = vl_extent_diagonal(&obj->box);
  const float radius = diagonal > 0 ? (float)(THIN * diagonal) : 1;
  vlObjMark *marks = obj->marks.items;
  if (obj->marks.count > 0x1fffffff)
    return vl_obj_fail(obj, "too many points and lines");
  qsort(marks, obj->marks.count, sizeof *marks, compare);
  for (size_t i = 0, end; i < obj->marks.count; i = end) {
    for (end = i; end < obj->marks.count && marks[end].material == marks[i].material &&
                  !marks[end].from == !marks[i].from;)
      end++;
    vlObjMaterial *m = &obj->materials.items[marks[i].material];
    if (!vl_obj_make_material(obj, m))
      return false;
    vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
    def.source = (vlSource){obj->path, marks[i].line, 1};
    def.material = m->material;
    def.alpha = m->alpha;
    def.faces = (uint32_t)(end - i);
    if (!(marks[i].from ? add_lines : add_points)(obj, marks + i, end - i, radius, &def))
      return false;
  }
  vl_obj_warn(obj, VL_LOG_INFO, "its points and lines are balls and tubes of radius %.4g",
              (double)radius);
  return true;
}
