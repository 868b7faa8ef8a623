/* import/obj/mtl.c: reads the material libraries of OBJ files into vlMtl. Statements that velo
 * does not use are ignored; broken ones are errors with their line. */
#include <math.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/text.h"
#include "import/find.h"
#include "import/obj/obj.h"
#include "math/double3.h"

vlMtl vl_mtl_default(void) {
  vlMtl m = {
      .kd = {0.8f, 0.8f, 0.8f}, .ks = {NAN, NAN, NAN}, .tf = {NAN, NAN, NAN}, .illum = -1};
  m.ns = m.ni = m.d = m.pr = m.pm = m.ps = m.pc = m.pcr = m.aniso = m.anisor = NAN;
  return m;
}

static bool is_word(const char *word, size_t n, const char *name) {
  return strlen(name) == n && strncasecmp(word, name, n) == 0;
}

/* ---- images ------------------------------------------------------------------------------ */

static bool exists(const char *path) {
  struct stat info;
  return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

static void use_slashes(char *name) {
  for (char *p = name; *p; p++)
    if (*p == '\\')
      *p = '/';
}

/* Finds a file at its path or, since paths are often those of another machine, a file of the
 * same name in the folder of the library or on the search path. */
static bool find_file(vlObj *obj, const char *name, char *path, size_t size) {
  const char *slash = strrchr(name, '/');
  for (int i = 0; i < (slash ? 2 : 1); i++) {
    vlFound found = vl_find_file(obj->context, obj->path, NULL, obj->search_path,
                                 i ? slash + 1 : name, path, size);
    if (found == VL_FOUND && exists(path))
      return true;
  }
  return false;
}

/* Reports a missing file: as an error if strict. */
static bool report_missing(vlObj *obj, const char *what, const char *name) {
  if (!obj->strict) {
    vl_obj_warn_missing(obj, "%s \"%.200s\"; done without", what, name);
    return true;
  }
  return vl_scene_fail(obj->scene, VL_ERROR_MISSING, (vlSource){obj->path, obj->line, 1},
                       "%s \"%.200s\"", what, name);
}

/* Finds an image. When there is none, the result is null and a warning is given. */
static bool find_image(vlObj *obj, char *name, const char **path) {
  static const char *const known[] = {".png", ".jpg", ".jpeg", ".tga", ".exr", ".hdr", ".pfm",
                                      ".bmp", ".gif", ".ppm",  ".pgm", ".qoi", ".pnm"};
  char whole[4096];
  *path = NULL;
  use_slashes(name);
  if (!find_file(obj, name, whole, sizeof whole)) {
    obj->repairs.images++;
    return report_missing(obj, "there is no image", name);
  }
  bool readable = false;
  for (size_t i = 0; i < VL_LENGTH(known); i++)
    readable |= vl_ends_with(whole, known[i]);
  if (!readable) {
    vl_obj_warn(obj, VL_LOG_WARNING,
                "\"%.200s\": velo does not read images of this kind; done without", name);
    return true;
  }
  *path = whole;
  return vl_scene_copy_string(obj->scene, path);
}

static bool option_numbers(vlObj *obj, const char *name, uint32_t min, uint32_t max,
                           double *values) {
  uint32_t count = 0;
  /* reads as many numbers as there are; a name or an option follows */
  for (; count < max; count++) {
    char *const at = obj->at;
    uint32_t one;
    if (!vl_obj_numbers(obj, 1, &values[count], &one) || !one) {
      obj->at = at;
      break;
    }
  }
  return count >= min || vl_obj_fail(obj, "%s: %u numbers, %u are needed", name, count, min);
}

static bool option_word(vlObj *obj, const char *name, const char **word, size_t *n) {
  return (*n = vl_obj_word(obj, word)) || vl_obj_fail(obj, "%s: its value is missing", name);
}

/* The options before an image's name. Those of `max` 0 are followed by a word, others by
 * numbers, of which the first are `standard` if there are fewer. */
typedef struct Option {
  const char *name, *label; /* label: in messages */
  uint32_t min, max;
  double standard;
} Option;

static const Option options[] = {
    {"-o", "-o, -s, -t", 1, 3, 0},     {"-s", "-o, -s, -t", 1, 3, 1},
    {"-t", "-o, -s, -t", 1, 3, 0},     {"-mm", "-mm", 2, 2, 0},
    {"-bm", "-bm", 1, 1, 0},           {"-boost", "-boost", 1, 1, 0},
    {"-texres", "-texres", 1, 1, 0},   {"-clamp", "-clamp", 0, 0, 0},
    {"-imfchan", "-imfchan", 0, 0, 0}, {"-blendu", "-blendu", 0, 0, 0},
    {"-blendv", "-blendv", 0, 0, 0},   {"-cc", "-cc", 0, 0, 0},
    {"-type", "-type", 0, 0, 0}};

static void set_numbers(vlMtlMap *map, const char *option, const double v[3]) {
  for (int i = 0; i < 2; i++) {
    if (vl_text_is(option, "-o"))
      map->offset[i] = (float)v[i];
    if (vl_text_is(option, "-s"))
      map->scale[i] = (float)v[i];
  }
  if (vl_text_is(option, "-mm")) {
    map->base = (float)v[0];
    map->gain = (float)v[1];
  }
  if (vl_text_is(option, "-bm"))
    map->bump = (float)v[0];
}

static void set_word(vlMtlMap *map, const char *option, const char *word, size_t n) {
  const char *channel = n == 1 ? strchr("rgbm", *word) : NULL;
  if (vl_text_is(option, "-clamp"))
    map->clamp = is_word(word, n, "on");
  if (vl_text_is(option, "-imfchan"))
    map->channel = channel ? (int)(channel - "rgbm") : -1;
}

/* Reads one option before an image's name. Returns false when there is none. *fine: it is not
 * broken. */
static bool read_option(vlObj *obj, vlMtlMap *map, bool *fine) {
  const char *word, *value;
  char *at = obj->at;
  size_t n = vl_obj_word(obj, &word);
  const Option *o = NULL;
  for (size_t i = 0; i < VL_LENGTH(options) && !o; i++)
    if (is_word(word, n, options[i].name))
      o = &options[i];
  *fine = true;
  if (!o) {
    obj->at = at;
    return false;
  }
  if (!o->max) {
    *fine = option_word(obj, o->label, &value, &n);
    if (*fine)
      set_word(map, o->name, value, n);
    return true;
  }
  double v[3] = {o->standard, o->standard, o->standard};
  *fine = option_numbers(obj, o->label, o->min, o->max, v);
  set_numbers(map, o->name, v);
  return true;
}

static bool read_map(vlObj *obj, vlMtl *m, vlMtlMapKind kind) {
  vlMtlMap map = {.scale = {1, 1}, .gain = 1, .bump = 1, .channel = -1};
  bool fine;
  while (read_option(obj, &map, &fine))
    if (!fine)
      return false;
  char *name = vl_obj_rest(obj);
  if (!*name)
    return vl_obj_fail(obj, "the name of an image is missing");
  if (!find_image(obj, name, &map.path))
    return false;
  if (map.path)
    m->maps[kind] = map;
  return true;
}

/* ---- numbers ----------------------------------------------------------------------------- */

static bool read_color(vlObj *obj, const char *name, float color[3]) {
  double v[3];
  uint32_t count;
  const char *word;
  char *at = obj->at;
  size_t n = vl_obj_word(obj, &word);
  if (is_word(word, n, "spectral")) {
    vl_obj_warn(obj, VL_LOG_WARNING, "%s spectral: velo does not read .rfl files", name);
    return true;
  }
  bool xyz = is_word(word, n, "xyz");
  if (!xyz)
    obj->at = at;
  if (!vl_obj_numbers(obj, 3, v, &count) || (count != 1 && count != 3))
    return vl_obj_fail(obj, "%s needs 1 or 3 numbers", name);
  if (count == 1)
    v[1] = v[2] = v[0];
  static const double rgb_from_xyz[9] = {3.2404542,  -1.5371385, -0.4985314,
                                         -0.9692660, 1.8760108,  0.0415560,
                                         0.0556434,  -0.2040259, 1.0572252};
  for (int i = 0; i < 3; i++) {
    double x = xyz ? vl_dot3(rgb_from_xyz + 3 * i, v) : v[i];
    color[i] = x > 0 ? (float)x : 0.0f;
  }
  return true;
}

static bool read_number(vlObj *obj, const char *name, float *value) {
  double v;
  uint32_t count;
  if (!vl_obj_numbers(obj, 1, &v, &count) || count != 1)
    return vl_obj_fail(obj, "%s needs a number", name);
  *value = (float)v;
  return true;
}

/* Reads the rest of newmtl NAME. */
static bool begin_material(vlObj *obj, uint32_t *current) {
  *current = vl_obj_material(obj, vl_obj_rest(obj));
  if (*current == UINT32_MAX)
    return false;
  vlObjMaterial *material = &obj->materials.items[*current];
  if (!material->defined)
    material->mtl = vl_mtl_default();
  material->defined = true;
  return true;
}

/* current: the index of the material that the last newmtl began; 0: none yet. */
static bool read_statement(vlObj *obj, uint32_t *current) {
  static const struct {
    const char *name;
    vlMtlMapKind kind;
  } maps[] = {{"map_Kd", VL_MTL_KD},      {"map_Ke", VL_MTL_KE},     {"map_Ks", VL_MTL_KS},
              {"map_d", VL_MTL_D},        {"map_opacity", VL_MTL_D}, {"map_Bump", VL_MTL_BUMP},
              {"bump", VL_MTL_BUMP},      {"norm", VL_MTL_NORMAL},   {"map_Kn", VL_MTL_NORMAL},
              {"map_Pr", VL_MTL_PR},      {"map_Pm", VL_MTL_PM},     {"map_Ps", VL_MTL_PS},
              {"map_emissive", VL_MTL_KE}};
  const char *word;
  size_t n = vl_obj_word(obj, &word);
  if (n == 0)
    return true;
  if (is_word(word, n, "newmtl"))
    return begin_material(obj, current);
  vlMtl *m = &obj->materials.items[*current].mtl, unused = vl_mtl_default();
  if (*current == 0)
    m = &unused; /* statements before the first newmtl have no effect */
  const struct {
    const char *name;
    float *to;
  } colors[] = {{"Kd", m->kd}, {"Ks", m->ks}, {"Ke", m->ke}, {"Tf", m->tf}},
    numbers[] = {{"Ns", &m->ns},       {"Ni", &m->ni},        {"d", &m->d},   {"Pr", &m->pr},
                 {"Pm", &m->pm},       {"Pc", &m->pc},        {"Ps", &m->ps}, {"Pcr", &m->pcr},
                 {"aniso", &m->aniso}, {"anisor", &m->anisor}};
  for (size_t i = 0; i < VL_LENGTH(colors); i++)
    if (is_word(word, n, colors[i].name))
      return read_color(obj, colors[i].name, colors[i].to);
  if (is_word(word, n, "d")) { /* also "d -halo 0.5" */
    const char *halo;
    size_t k = vl_obj_next_word(obj, &halo);
    if (is_word(halo, k, "-halo"))
      vl_obj_word(obj, &halo);
  }
  for (size_t i = 0; i < VL_LENGTH(numbers); i++)
    if (is_word(word, n, numbers[i].name))
      return read_number(obj, numbers[i].name, numbers[i].to);
  for (size_t i = 0; i < VL_LENGTH(maps); i++)
    if (is_word(word, n, maps[i].name))
      return read_map(obj, m, maps[i].kind);
  float value = 0;
  if (is_word(word, n, "Tr")) {
    if (!read_number(obj, "Tr", &value))
      return false;
    if (isnan(m->d))
      m->d = 1.0f - value;
    return true;
  }
  if (is_word(word, n, "illum")) {
    if (!read_number(obj, "illum", &value))
      return false;
    m->illum = value >= 0 && value <= 10 ? (int)value : 2;
    return true;
  }
  return true; /* Ka, map_Ka, decal, disp, refl, ...: not used */
}

/* ---- the file ---------------------------------------------------------------------------- */

static bool read_library(vlObj *obj, char *name) {
  char path[4096];
  for (size_t i = 0; i < obj->libraries.count; i++)
    if (vl_text_is(obj->libraries.items[i], name))
      return true;
  if (obj->libraries.count >= VL_OBJ_LIBRARIES)
    return vl_obj_fail(obj, "mtllib: more than %d libraries", VL_OBJ_LIBRARIES);
  use_slashes(name);
  const char *kept = name;
  const char **slot = VL_PUSH(obj->context, &obj->libraries);
  if (!slot)
    return vl_obj_fail_memory(obj);
  if (!vl_scene_copy_string(obj->scene, &kept))
    return false;
  *slot = kept;
  if (!find_file(obj, name, path, sizeof path))
    return report_missing(obj, "mtllib: there is no file", name);
  vlError error;
  vl_error_clear(&error);
  char *data;
  size_t size;
  vlResult r = vl_file_read(obj->context, path, true, &data, &size, &error);
  if (r != VL_OK)
    return vl_scene_fail(obj->scene, r, (vlSource){obj->path, obj->line, 1}, "%s",
                         error.message);
  /* Errors name the library's line; the OBJ file's own line is restored afterwards. */
  const char *own_path = obj->path;
  uint32_t own_line = obj->line, own_more = obj->more_lines, current = 0;
  obj->path = path;
  obj->line = obj->more_lines = 0;
  char *from = data;
  bool fine = true;
  while (fine && vl_obj_statement(obj, &from, data + size))
    fine = read_statement(obj, &current);
  vl_free(obj->context, data);
  obj->path = own_path;
  obj->line = own_line;
  obj->more_lines = own_more;
  return fine;
}

bool vl_obj_read_libraries(vlObj *obj) {
  char *line_start = obj->line_start, *at = obj->at, *end = obj->end, whole[4096];
  char *rest = vl_obj_rest(obj);
  bool fine = true;
  if (!*rest)
    return vl_obj_fail(obj, "mtllib: the name of a file is missing");
  /* the rest of the statement is one name with blanks */
  if (vl_path_join(obj->path, rest, whole, sizeof whole) && exists(whole)) {
    fine = read_library(obj, rest);
  } else {
    char *next = rest;
    while (fine && *next) {
      char *name = next;
      while (*next && *next != ' ' && *next != '\t')
        next++;
      if (*next)
        *next++ = 0;
      while (*next == ' ' || *next == '\t')
        next++;
      if (*name)
        fine = read_library(obj, name);
    }
  }
  obj->line_start = line_start;
  obj->at = at;
  obj->end = end;
  return fine;
}
