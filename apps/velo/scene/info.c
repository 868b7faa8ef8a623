/* scene/info.c: `velo scene info`: the content of a scene: counts, extent, memory, camera,
 * film, lights, unused definitions. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/crop.h"
#include "cli/kinds.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "render/progress.h"
#include "render/scene_options.h"
#include "scene/scene.h"
#include "velo/check.h"

enum { INFO_JSON, INFO_PERMISSIVE, INFO_SEARCH, INFO_SANDBOX };
enum { LIGHTS = 20, LIGHTS_JSON = 1000 }; /* most lights listed */

typedef struct Facts {
  const char *path;
  vlScene *scene;
  vlSceneInfo info;
  size_t bytes;
  double low[3], high[3], seconds;
  vlCheck *check; /* for the unused definitions */
} Facts;

static void count(const char *name, uint64_t n) {
  printf("%-12s%llu\n", name, (unsigned long long)n);
}

static void eye_of(const vlCameraDef *d, double eye[3]) {
  for (int k = 0; k < 3; k++)
    eye[k] = d->has_matrix ? d->world_from_camera[4 * k + 3] : d->eye[k];
}

static void print_lights(const Facts *f) {
  uint32_t n = vl_scene_light_count(f->scene);
  printf("lights      %u\n", n);
  for (uint32_t i = 0; i < n && i < LIGHTS; i++) {
    vlLightInfo l;
    if (vl_scene_light_info(f->scene, i, &l) != VL_OK)
      continue;
    printf("  %-9s ", l.kind);
    if (isfinite(l.power))
      printf("power %-10.5g", l.power);
    else
      printf("%-16s", "of an image");
    if (l.faces > 1)
      printf(" %llu faces", (unsigned long long)l.faces);
    if (l.source.file) {
      printf("  ");
      text_print_plain(l.source.file);
      if (l.source.line)
        printf(":%u", l.source.line);
    }
    putchar('\n');
  }
  if (n > LIGHTS)
    printf("  and %u more\n", n - LIGHTS);
}

/* Returns the name in scene files, or the constant's name if files have none. */
static const char *name_of(const vlKindFamily *family, uint32_t kind) {
  return family->rows[kind]->name ? family->rows[kind]->name : family->words[kind];
}

/* "12: 5 diffuse, 7 conductor", by the family's rows. */
static void count_kinds(const Facts *f, const char *name, uint64_t all) {
  const vlKindFamily *family = vl_kind_family_find(name);
  const char *before = ": ";
  printf("%-12s%llu", name, (unsigned long long)all);
  for (uint32_t i = 0; all && i < family->kind_count; i++) {
    uint64_t n = vl_scene_kind_count(f->scene, name, i);
    if (!n)
      continue;
    printf("%s%llu %s", before, (unsigned long long)n, name_of(family, i));
    before = ", ";
  }
  putchar('\n');
}

/* A parameter's value as files write it; false: it is not a number, a bool or a name. */
static bool value_of(const vlParameter *p, const void *def, char text[32]) {
  const void *at = (const char *)def + p->offset;
  const double scale = p->factor != 0 ? 1 / p->factor : 1;
  if (!p->name || !p->size)
    return false;
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      snprintf(text, 32, "%s", *(const bool *)at ? "true" : "false");
      return true;
    case VL_PARAMETER_COUNT:
      snprintf(text, 32, "%u", *(const uint32_t *)at);
      return true;
    case VL_PARAMETER_FLOAT:
      snprintf(text, 32, "%.6g", scale * (double)*(const float *)at);
      return true;
    case VL_PARAMETER_DOUBLE:
      snprintf(text, 32, "%.6g", scale * *(const double *)at);
      return *(const double *)at == *(const double *)at;
    case VL_PARAMETER_CHOICE:
      snprintf(text, 32, "%s", p->choices[*(const int *)at]);
      return true;
    case VL_PARAMETER_FLOAT3:
    case VL_PARAMETER_DOUBLE3:
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
    case VL_PARAMETER_SPECTRUM:
    case VL_PARAMETER_FLOAT_INPUT:
    case VL_PARAMETER_SPECTRUM_INPUT:
    case VL_PARAMETER_EITHER_INPUT:
    case VL_PARAMETER_TEXTURE:
    case VL_PARAMETER_BLOCK:
      return false;
  }
  return false;
}

/* What the scene's file chose: a kind of each of these families, with the parameters of its
 * row. */
typedef struct Chosen {
  const char *key, *family;
  int kind;
  const void *def;
} Chosen;
enum { CHOSEN = 3 };

static void chosen(const vlSceneDefs *defs, Chosen list[CHOSEN]) {
  list[0] = (Chosen){"sampler", "samplers", (int)defs->render.sampler, defs};
  list[1] = (Chosen){"filter", "filters", (int)defs->film.filter.kind, &defs->film.filter};
  list[2] = (Chosen){"tracer", "tracers", (int)defs->render.tracer, defs};
}

static bool is_repeated(const vlKindRow *row, uint32_t i) {
  for (uint32_t k = 0; k < i; k++)
    if (row->parameters[k].name && row->parameters[k].offset == row->parameters[i].offset)
      return true;
  return false;
}

static void print_chosen(const vlSceneDefs *defs) {
  Chosen list[CHOSEN];
  chosen(defs, list);
  for (int k = 0; k < CHOSEN; k++) {
    const vlKindRow *row = vl_kind_family_find(list[k].family)->rows[list[k].kind];
    const char *before = ": ";
    printf("%-12s%s", list[k].key, row->name);
    for (uint32_t i = 0; i < row->parameter_count; i++) {
      char text[32];
      if (is_repeated(row, i) || !value_of(&row->parameters[i], list[k].def, text))
        continue;
      printf("%s%s %s", before, row->parameters[i].name, text);
      before = ", ";
    }
    putchar('\n');
  }
}

static void print_text(const Facts *f) {
  const vlSceneDefs *defs = vl_scene_defs(f->scene);
  const uint32_t *c = defs->film.crop;
  double eye[3];
  printf("file        %s\n", f->path);
  count_kinds(f, "shapes", f->info.shapes);
  count("triangles", f->info.triangles);
  count("vertices", f->info.vertices);
  count("objects", f->info.groups);
  count("instances", f->info.instances);
  count_kinds(f, "textures", f->info.textures);
  count_kinds(f, "materials", f->info.materials);
  count_kinds(f, "media", f->info.media);
  printf("memory      %.1f MB for the description, read in %.2f s\n", (double)f->bytes / 1e6,
         f->seconds);
  if (f->low[0] <= f->high[0])
    printf("bounds      (%.5g, %.5g, %.5g) to (%.5g, %.5g, %.5g)\n", f->low[0], f->low[1],
           f->low[2], f->high[0], f->high[1], f->high[2]);
  eye_of(&defs->camera, eye);
  if (defs->camera_missing)
    printf("camera      none: velo render makes one\n");
  else
    printf("camera      %s at (%.5g, %.5g, %.5g)\n",
           vl_projection_name(defs->camera.projection), eye[0], eye[1], eye[2]);
  printf("film        %u x %u", defs->film.width, defs->film.height);
  if (!crop_is_whole(c, defs->film.width, defs->film.height))
    printf(", of it %u,%u to %u,%u", c[0], c[1], c[2], c[3]);
  putchar('\n');
  print_chosen(defs);
  info_print_choices(f->scene);
  print_lights(f);
  info_print_names(f->scene);
  uint32_t unused = 0;
  for (uint32_t i = 0; i < vl_check_count(f->check); i++) {
    const vlFinding *u = vl_check_finding(f->check, i);
    if (u->kind != VL_FINDING_UNUSED)
      continue;
    if (!unused++)
      printf("unused\n");
    printf("  ");
    text_print_plain(u->message);
    if (u->source.line)
      printf(" (line %u)", u->source.line);
    putchar('\n');
  }
}

static void put_source(Json *json, const vlSource *source) {
  json_location(json, source->file, source->line, source->line ? source->column : 0);
}

/* Things of each kind: {"materials": {"diffuse": 5}, ...}. */
static void json_kinds(Json *json, const Facts *f) {
  static const char *const families[] = {"shapes", "textures", "materials", "media"};
  json_begin(json, "kinds", '{');
  for (size_t k = 0; k < LENGTH(families); k++) {
    const vlKindFamily *family = vl_kind_family_find(families[k]);
    json_begin(json, families[k], '{');
    for (uint32_t i = 0; i < family->kind_count; i++) {
      uint64_t n = vl_scene_kind_count(f->scene, families[k], i);
      if (n)
        json_integer(json, name_of(family, i), (int64_t)n);
    }
    json_end(json, '}');
  }
  json_end(json, '}');
}

static void json_chosen(Json *json, const vlSceneDefs *defs) {
  Chosen list[CHOSEN];
  chosen(defs, list);
  for (int k = 0; k < CHOSEN; k++) {
    const vlKindRow *row = vl_kind_family_find(list[k].family)->rows[list[k].kind];
    json_begin(json, list[k].key, '{');
    json_text(json, "kind", row->name);
    for (uint32_t i = 0; i < row->parameter_count; i++) {
      const vlParameter *p = &row->parameters[i];
      char text[32];
      if (is_repeated(row, i) || !value_of(p, list[k].def, text))
        continue;
      if (p->type == VL_PARAMETER_CHOICE)
        json_text(json, p->name, text);
      else if (p->type == VL_PARAMETER_BOOL)
        json_bool(json, p->name, text[0] == 't');
      else
        json_number(json, p->name, strtod(text, NULL));
    }
    json_end(json, '}');
  }
}

static void json_defs(Json *json, const vlSceneDefs *defs) {
  double eye[3];
  json_begin(json, "camera", '{');
  json_put(json, "missing %i, projection %s", defs->camera_missing,
           vl_projection_name(defs->camera.projection));
  eye_of(&defs->camera, eye);
  json_numbers(json, "eye", eye, 3);
  json_end(json, '}');
  json_begin(json, "film", '{');
  json_put(json, "width %u, height %u", defs->film.width, defs->film.height);
  json_integers(json, "crop", defs->film.crop, 4);
  json_put(json, "spp %u, tracer %s, max_depth %u", defs->render.spp,
           kind_name("tracers", (int)defs->render.tracer), defs->render.max_depth);
  json_end(json, '}');
}

static void json_lights(Json *json, const Facts *f) {
  uint32_t n = vl_scene_light_count(f->scene);
  json_integer(json, "light_count", n);
  json_begin(json, "lights", '[');
  for (uint32_t i = 0; i < n && i < LIGHTS_JSON; i++) {
    vlLightInfo l;
    if (vl_scene_light_info(f->scene, i, &l) != VL_OK)
      continue;
    json_begin(json, NULL, '{');
    json_put(json, "kind %s, power %g, image %i", l.kind, l.power, l.image);
    if (l.faces)
      json_integer(json, "faces", (int64_t)l.faces);
    put_source(json, &l.source);
    json_end(json, '}');
  }
  json_end(json, ']');
}

static void json_unused(Json *json, const Facts *f) {
  json_begin(json, "unused", '[');
  for (uint32_t i = 0; i < vl_check_count(f->check); i++) {
    const vlFinding *u = vl_check_finding(f->check, i);
    if (u->kind != VL_FINDING_UNUSED)
      continue;
    json_begin(json, NULL, '{');
    json_text(json, "message", u->message);
    put_source(json, &u->source);
    json_end(json, '}');
  }
  json_end(json, ']');
}

static void print_json(const Facts *f) {
  Json *json = json_open();
  const vlSceneDefs *defs = vl_scene_defs(f->scene);
  json_text(json, "file", f->path);
  const struct {
    const char *name;
    uint64_t n;
  } counts[] = {{"shapes", f->info.shapes},
                {"triangles", f->info.triangles},
                {"vertices", f->info.vertices},
                {"objects", f->info.groups},
                {"instances", f->info.instances},
                {"textures", f->info.textures},
                {"materials", f->info.materials},
                {"media", f->info.media},
                {"bytes", f->bytes}};
  for (size_t i = 0; i < LENGTH(counts); i++)
    json_integer(json, counts[i].name, (int64_t)counts[i].n);
  json_number(json, "seconds", f->seconds);
  json_begin(json, "bounds", '[');
  if (f->low[0] <= f->high[0]) {
    json_numbers(json, NULL, f->low, 3);
    json_numbers(json, NULL, f->high, 3);
  }
  json_end(json, ']');
  json_defs(json, defs);
  json_chosen(json, defs);
  json_kinds(json, f);
  info_json_choices(json, f->scene);
  info_json_names(json, f->scene);
  json_lights(json, f);
  json_unused(json, f);
  json_close(json);
}

static int run(const Arguments *arguments, vlContext *context) {
  Facts f = {.path = arguments->operands[0]};
  vlError error = {0};
  vlLoadDef load = vl_default_load_def();
  options_put(arguments->command->options, arguments->values, VL_SETTING_LOAD, &load);
  const double start = monotonic_seconds();
  vlResult r = scene_read(context, f.path, &load, &f.scene, &error);
  f.seconds = monotonic_seconds() - start;
  if (r == VL_OK) {
    f.bytes = vl_context_memory(context, NULL);
    vl_scene_info(f.scene, &f.info);
    vl_scene_bounds(f.scene, f.low, f.high);
    vlCheckDef def = vl_default_check_def();
    def.names_only = true;
    r = vl_scene_check(f.scene, &def, &f.check, &error);
  }
  int status = STATUS_OK;
  if (r != VL_OK)
    status = report_error(&error, r, f.path);
  else if (arguments->values[INFO_JSON].given)
    print_json(&f);
  else
    print_text(&f);
  vl_check_destroy(f.check);
  vl_scene_destroy(f.scene);
  return status;
}

static Option options[] = {
    JSON_OPTION(INFO_JSON),
    {INFO_PERMISSIVE, "permissive",
     "leave out parts of the scene that velo does not understand, instead of ending with an "
     "error"},
    SCENE_SEARCH_OPTION(INFO_SEARCH),
    SCENE_SANDBOX_OPTION(INFO_SANDBOX),
    {0}};

const Command scene_info_command = {
    .name = "scene info",
    .usage = "FILE [options]",
    .summary = "print what a scene contains: counts, bounds, camera, lights",
    .text =
        "Reads a scene and prints its contents, without building or rendering it. The power "
        "of a light is the\n"
        "luminance that it emits, integrated over area and solid angle; of distant and "
        "infinite lights, the\n"
        "part that enters a sphere around the scene.",
    .examples = "velo scene info room.pbrt\nvelo scene info --json model.glb",
    .options = options,
    .operands = 1,
    .context = CONTEXT_ALL,
    .run = run,
};
