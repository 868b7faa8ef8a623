/* import/off/off.c: OFF files (text): vertices, with normals (N) and colours (C), and polygons,
 * with colours. Format: the manual of Geomview, "OFF Files". Comments begin with #. */
#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/text.h"
#include "image/pixel.h"
#include "import/far.h"
#include "import/import.h"
#include "import/pbrt/decimal.h"
#include "import/plain.h"

typedef struct Off {
  vlScene *scene;
  const char *path, *at, *end;
  uint32_t line;
  bool normals, colors, uvs;
  bool integers; /* the last row of numbers had integers only */
  vlMesh mesh;
  VL_ARRAY(uint32_t) corners;
} Off;

/* word: what was found, at the end of the message, or null. */
static bool fail(Off *s, const char *what, const char *word) {
  return vl_import_plain_fail(s->scene, VL_ERROR_SCENE, s->path, s->line, what, word);
}

static bool fail_memory(Off *s) {
  return vl_import_plain_fail(s->scene, VL_ERROR_MEMORY, s->path, 0, "out of memory", NULL);
}

/* ---- words ------------------------------------------------------------------------------- */

static bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/* Passes blanks and comments, with `lines` also ends of lines. False: nothing is left. */
static bool skip_blanks(Off *s, bool lines) {
  while (s->at < s->end) {
    if (*s->at == '#')
      while (s->at < s->end && *s->at != '\n')
        s->at++;
    else if (*s->at == '\n' && !lines)
      return false;
    else if (*s->at != '\n' && !is_blank(*s->at))
      return true;
    else
      s->line += *s->at++ == '\n';
  }
  return false;
}

static bool number(Off *s, double *value) {
  if (!skip_blanks(s, true))
    return fail(s, "OFF: the file ends too early", NULL);
  const char *start = s->at, *p = start;
  while (s->at < s->end && !is_blank(*s->at) && *s->at != '\n' && *s->at != '#')
    s->at++;
  if (!vl_number_scan(&p, s->end, value) || p != s->at || !isfinite((float)*value))
    return fail(s, "OFF: expected a number, found",
                vl_short_text_of(start, (size_t)(s->at - start)).text);
  for (p = start; p < s->at; p++)
    s->integers = s->integers && *p != '.' && *p != 'e' && *p != 'E';
  return true;
}

/* Three 32-bit indices of each face, and numbers of each vertex, must fit into 31 bits. */
enum { MAX_COUNT = 0x2aaaaaaa };

/* Reads how many there are of something that has at least so many bytes in the file. */
static bool count(Off *s, uint64_t bytes, size_t *n) {
  double value = 0;
  if (!number(s, &value))
    return false;
  if (!(value >= 0 && value < MAX_COUNT) || value != floor(value))
    return fail(s, "OFF: a count makes no sense", NULL);
  if (value * (double)bytes > (double)(s->end - s->at) + 1)
    return fail(s, "OFF: the file is too short for its counts", NULL);
  *n = (size_t)value;
  return true;
}

/* A colour, sRGB, in linear light. integers: its numbers are 0 to 255; else 0 to 1. */
static void to_linear(double color[4], bool integers, float linear[4]) {
  for (int k = 0; k < 4; k++) {
    double x = integers ? color[k] / 255 : color[k];
    x = fmin(fmax(x, 0), 1);
    linear[k] = (float)(k == 3 ? x : vl_srgb_to_linear(x));
  }
}

/* The numbers up to the end of the line, at most 8. */
static bool rest_of_line(Off *s, double values[8], int *n) {
  *n = 0;
  s->integers = true;
  while (skip_blanks(s, false)) {
    double value;
    if (!number(s, &value))
      return false;
    if (*n < 8)
      values[(*n)++] = value;
  }
  return true;
}

/* ---- the parts --------------------------------------------------------------------------- */

static bool read_header(Off *s) {
  s->line = 1;
  if (!skip_blanks(s, true))
    return fail(s, "OFF: the file is empty", NULL);
  const char *start = s->at;
  while (s->at < s->end && !is_blank(*s->at) && *s->at != '\n' && *s->at != '#')
    s->at++;
  size_t length = (size_t)(s->at - start);
  vlShortText word = vl_short_text_of(start, length);
  if (length >= 2 && memcmp(start, "ST", 2) == 0) {
    s->uvs = true;
    start += 2;
    length -= 2;
  }
  if (length >= 1 && *start == 'C') {
    s->colors = true;
    start++;
    length--;
  }
  if (length >= 1 && *start == 'N') {
    s->normals = true;
    start++;
    length--;
  }
  if (length != 3 || memcmp(start, "OFF", 3) != 0)
    return fail(s, "OFF: the file must begin with OFF, COFF, NOFF, CNOFF or STOFF, not",
                word.text);
  const char *before = s->at;
  if (skip_blanks(s, false) && s->end - s->at >= 6 && memcmp(s->at, "BINARY", 6) == 0)
    return fail(s, "OFF: binary files are not read, only text", NULL);
  s->at = before;
  return true;
}

static bool make_arrays(Off *s) {
  const uint32_t attributes = VL_MESH_POSITIONS | (s->normals ? VL_MESH_NORMALS : 0) |
                              (s->uvs ? VL_MESH_UVS : 0) | (s->colors ? VL_MESH_COLORS : 0);
  return vl_mesh_add_attributes(s->scene->context, &s->mesh, attributes) || fail_memory(s);
}

/* Reads all rows of vertices, about the mesh's origin. */
static bool read_rows(Off *s) {
  vlMesh *m = &s->mesh;
  for (size_t i = 0; i < m->vertices; i++) {
    double v[3], rest[8] = {0}, color[4] = {0, 0, 0, 0};
    int n;
    for (int k = 0; k < 3; k++) {
      if (!number(s, &v[k]))
        return false;
      m->positions[3 * i + (size_t)k] = (float)(v[k] - m->origin[k]);
    }
    for (int k = 0; s->normals && k < 3; k++) {
      if (!number(s, &v[k]))
        return false;
      m->normals[3 * i + (size_t)k] = (float)v[k];
    }
    if (!rest_of_line(s, rest, &n))
      return false;
    if (s->colors) {
      if (n < 3)
        return fail(s, "OFF: a vertex has no colour", NULL);
      bool alpha = n == 4 || n == 6; /* 6: texture coordinates follow */
      memcpy(color, rest, sizeof color);
      if (!alpha)
        color[3] = s->integers ? 255 : 1;
      to_linear(color, s->integers, m->colors + 4 * i);
    }
    for (int k = 0; s->uvs && k < 2; k++) {
      if (n < 2)
        return fail(s, "OFF: a vertex has no texture coordinates", NULL);
      m->uvs[0][2 * i + (size_t)k] = (float)rest[n - 2 + k];
    }
  }
  return true;
}

static bool read_vertices(Off *s) {
  const char *start = s->at;
  const uint32_t line = s->line;
  if (!make_arrays(s) || !read_rows(s))
    return false;
  if (!vl_far_vertices(s->mesh.positions, s->mesh.vertices, s->mesh.origin))
    return true;
  s->at = start; /* once more, about the origin */
  s->line = line;
  return read_rows(s);
}

/* Polygons become fans. *colored: the face has a colour. */
static bool read_face(Off *s, bool *colored) {
  vlContext *context = s->scene->context;
  vlMesh *m = &s->mesh;
  size_t n = 0;
  const size_t first = m->triangles;
  double rest[8] = {0}, value = 0;
  int more;
  if (!count(s, 2, &n))
    return false;
  if (!VL_RESERVE(context, &s->corners, n + 1))
    return fail_memory(s);
  for (size_t k = 0; k < n; k++) {
    if (!number(s, &value))
      return false;
    if (!(value >= 0 && value < (double)m->vertices))
      return fail(s, "OFF: a face names a vertex that is not there", NULL);
    s->corners.items[k] = (uint32_t)value;
  }
  if (!rest_of_line(s, rest, &more))
    return false;
  double color[4] = {rest[0], rest[1], rest[2], 1};
  float linear[4] = {0.6f, 0.6f, 0.6f, 1};
  if (more >= 3)
    to_linear(color, s->integers, linear);
  *colored = *colored || more >= 3;
  const uint32_t *v = s->corners.items;
  for (size_t k = 2; k < n; k++)
    if (!vl_mesh_add_triangle(context, m, v[0], v[k - 1], v[k]))
      return fail_memory(s);
  return vl_mesh_color_triangles(context, m, first, linear) || fail_memory(s);
}

static bool read(Off *s) {
  size_t faces = 0;
  bool colored = false;
  double rest[8];
  int n;
  if (!read_header(s) || !count(s, 6, &s->mesh.vertices) || !count(s, 2, &faces))
    return false;
  if (!rest_of_line(s, rest, &n) || !read_vertices(s))
    return false;
  for (size_t i = 0; i < faces; i++)
    if (!read_face(s, &colored))
      return false;
  if (s->mesh.triangles > MAX_COUNT)
    return fail(s, "OFF: too many faces", NULL);
  if (colored)
    return true;
  vl_free(s->scene->context, s->mesh.face_colors);
  s->mesh.face_colors = NULL;
  return true;
}

vlResult vl_import_off(vlScene *scene, const char *path, const vlLoadDef *load,
                       vlError *error) {
  Off s = {.scene = scene, .path = path};
  char *data = NULL;
  if (vl_import_plain_read(scene, path, &data, &s.at, &s.end))
    read(&s); /* else the scene has an error */
  vl_free(scene->context, data);
  VL_ARRAY_FREE(scene->context, &s.corners);
  return vl_import_plain_mesh(scene, path, load, &s.mesh, error);
}
