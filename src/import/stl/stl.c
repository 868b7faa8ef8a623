/* import/stl/stl.c: STL files, text and binary: triangles without anything else. The normals in
 * the file are not read: the order of the corners gives them. Format: 3D Systems,
 * "StereoLithography Interface Specification", 1988. */
#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/bytes.h"
#include "base/text.h"
#include "import/far.h"
#include "import/import.h"
#include "import/pbrt/decimal.h"
#include "import/plain.h"

enum { HEADER = 84, FACET = 50 };

typedef struct Stl {
  vlScene *scene;
  const char *path, *at, *end;
  uint32_t line;
  vlMesh mesh;
  VL_ARRAY(float) positions; /* about the mesh's origin */
} Stl;

static bool fail(Stl *s, const char *what, const char *word) {
  return vl_import_plain_fail(s->scene, VL_ERROR_SCENE, s->path, s->line, what, word);
}

static bool fail_memory(Stl *s) {
  return vl_import_plain_fail(s->scene, VL_ERROR_MEMORY, s->path, s->line, "STL: out of memory",
                              NULL);
}

/* ---- binary ------------------------------------------------------------------------------ */

static bool read_binary(Stl *s, uint64_t count) {
  if (count > 0x2aaaaaaa)
    return fail(s, "STL: too many facets", NULL);
  if (!VL_RESERVE(s->scene->context, &s->positions, 9 * count))
    return fail_memory(s);
  for (uint64_t i = 0; i < count; i++)
    for (int k = 0; k < 9; k++) {
      uint32_t bits = vl_little32(s->at + HEADER + FACET * i + 12 + 4 * k);
      float v;
      memcpy(&v, &bits, sizeof v);
      if (!isfinite(v))
        return fail(s, "STL: a vertex is not finite", NULL);
      s->positions.items[s->positions.count++] = v;
    }
  return true;
}

/* ---- text -------------------------------------------------------------------------------- */

/* The next word; its length is 0 at the end. */
static const char *next_word(Stl *s, size_t *length) {
  while (s->at < s->end && vl_is_blank(*s->at))
    s->line += *s->at++ == '\n';
  const char *start = s->at;
  while (s->at < s->end && !vl_is_blank(*s->at))
    s->at++;
  *length = (size_t)(s->at - start);
  return start;
}

static bool is(const char *word, size_t length, const char *wanted) {
  if (length != strlen(wanted))
    return false;
  for (size_t i = 0; i < length; i++)
    if ((word[i] >= 'A' && word[i] <= 'Z' ? word[i] + 32 : word[i]) != wanted[i])
      return false;
  return true;
}

static bool read_vertex(Stl *s) {
  if (!VL_RESERVE(s->scene->context, &s->positions, 3))
    return fail_memory(s);
  for (int k = 0; k < 3; k++) {
    size_t length;
    const char *word = next_word(s, &length), *p = word;
    double value;
    if (!vl_number_scan(&p, s->end, &value) || p != s->at || !isfinite((float)value))
      return fail(s, "STL: expected a coordinate, found", vl_short_text_of(word, length).text);
    s->positions.items[s->positions.count++] = (float)(value - s->mesh.origin[k]);
  }
  return true;
}

/* Words other than "vertex" and "endloop" do not matter. A name after "solid" may be any text
 * up to the line's end. */
static bool read_text(Stl *s) {
  s->line = 1;
  size_t length, first = 0;
  const char *word;
  while (word = next_word(s, &length), length) {
    if (is(word, length, "solid") || is(word, length, "endsolid"))
      while (s->at < s->end && *s->at != '\n')
        s->at++;
    if (is(word, length, "vertex") && !read_vertex(s))
      return false;
    if (!is(word, length, "endloop") && !is(word, length, "endsolid"))
      continue;
    if (is(word, length, "endloop") && s->positions.count != first + 9)
      return fail(s, "STL: a facet must have 3 vertices", NULL);
    first = s->positions.count;
  }
  if (s->positions.count % 9)
    return fail(s, "STL: the file ends too early", NULL);
  return s->positions.count / 9 <= 0x2aaaaaaa || fail(s, "STL: too many facets", NULL);
}

/* Reads the text, and once more about the origin if it lies far from that. */
static bool read_near_text(Stl *s) {
  const char *start = s->at;
  if (!read_text(s))
    return false;
  if (!vl_far_vertices(s->positions.items, s->positions.count / 3, s->mesh.origin))
    return true;
  s->at = start;
  s->positions.count = 0;
  return read_text(s);
}

/* Binary files may begin with "solid", too: their length tells. */
static bool read(Stl *s) {
  size_t size = (size_t)(s->end - s->at);
  uint64_t count = size >= HEADER ? vl_little32(s->at + HEADER - 4) : 0;
  if (size >= HEADER && size == HEADER + FACET * count)
    return read_binary(s, count);
  const char *p = s->at;
  while (p < s->end && vl_is_blank(*p))
    p++;
  if (s->end - p >= 5 && is(p, 5, "solid"))
    return read_near_text(s);
  if (size < HEADER)
    return fail(s, "STL: neither a text that begins with \"solid\" nor a binary file", NULL);
  if ((size - HEADER) / FACET < count)
    return fail(s, "STL: the file ends too early", NULL);
  return read_binary(s, count); /* with something after the facets */
}

/* Each triangle has vertices of its own. */
static bool number_vertices(Stl *s) {
  const size_t count = s->positions.count / 3;
  s->mesh.indices = vl_alloc_array(s->scene->context, count + 1, sizeof *s->mesh.indices);
  if (!s->mesh.indices)
    return fail_memory(s);
  for (size_t i = 0; i < count; i++)
    s->mesh.indices[i] = (uint32_t)i;
  s->mesh.vertices = count;
  s->mesh.triangles = count / 3;
  return true;
}

vlResult vl_import_stl(vlScene *scene, const char *path, const vlLoadDef *load,
                       vlError *error) {
  Stl s = {.scene = scene, .path = path};
  char *data = NULL;
  if (vl_import_plain_read(scene, path, &data, &s.at, &s.end) && read(&s))
    number_vertices(&s); /* else the scene has an error */
  vl_free(scene->context, data);
  s.mesh.positions = s.positions.items;
  return vl_import_plain_mesh(scene, path, load, &s.mesh, error);
}
