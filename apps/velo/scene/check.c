/* scene/check.c: `velo scene check`: reads a scene, continuing after errors, checks its
 * description, and prints all findings with their positions to stdout. */
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "scene/scene.h"
#include "velo/check.h"

enum { CHECK_JSON, CHECK_NO_IMAGES, CHECK_ALL, CHECK_PERMISSIVE, CHECK_SEARCH, CHECK_SANDBOX };
enum { SHOWN = 10 }; /* findings printed per kind without --all */

/* A copy of a finding, so that findings reported while loading are listed with the others. */
typedef struct Entry {
  vlFindingKind kind;
  vlSeverity severity;
  vlResult code;
  char file[512];
  uint32_t line, column;
  char message[512];
} Entry;

typedef struct List {
  Entry *items;
  size_t count, capacity;
} List;

static void add(List *list, vlFindingKind kind, vlSeverity severity, vlResult code,
                const char *file, uint32_t line, uint32_t column, const char *message) {
  if (list->count == list->capacity) {
    size_t wanted = list->capacity ? 2 * list->capacity : 64;
    Entry *grown = realloc(list->items, wanted * sizeof *grown);
    if (!grown)
      return; /* out of memory: the finding is lost */
    list->items = grown;
    list->capacity = wanted;
  }
  Entry *e = &list->items[list->count];
  list->count++;
  *e =
      (Entry){.kind = kind, .severity = severity, .code = code, .line = line, .column = column};
  text_set(e->file, "%s", file ? file : "");
  text_set(e->message, "%s", message);
}

static void report_message(void *user, const vlError *e) {
  vlFindingKind kind = VL_FINDING_WRONG;
  vlSeverity severity = VL_SEVERITY_ERROR;
  if (e->code == VL_OK) {
    kind = VL_FINDING_OVERWRITTEN;
    severity = VL_SEVERITY_WARNING;
  } else if (e->code == VL_ERROR_MISSING) {
    kind = VL_FINDING_MISSING_FILE;
  }
  add(user, kind, severity, e->code, e->file, e->line, e->column, e->message);
}

/* The importer's warnings become findings; its notes do not. Neither a missing file nor an
 * error in its log ends a render: what is missing or wrong is not used. */
static void logged(void *user, vlLogLevel level, const vlError *where, const char *message) {
  static const vlError nowhere;
  if (level > VL_LOG_WARNING)
    return;
  if (!where)
    where = &nowhere;
  vlFindingKind kind = VL_FINDING_REMARK;
  if (where->code == VL_ERROR_MISSING)
    kind = VL_FINDING_MISSING_FILE;
  else if (level == VL_LOG_ERROR)
    kind = VL_FINDING_WRONG;
  add(user, kind, kind == VL_FINDING_REMARK ? VL_SEVERITY_NOTE : VL_SEVERITY_WARNING, VL_OK,
      where->file, where->line, where->column, message);
}

/* Lists the findings of reading the scene and of checking it. Returns -1, or the exit code
 * after reporting that memory is lacking. */
static int look(vlContext *context, const Arguments *arguments, List *list) {
  vlScene *scene = NULL;
  vlCheck *check = NULL;
  vlError error = {0};
  vlLoadDef load = vl_default_load_def();
  options_put(arguments->command->options, arguments->values, VL_SETTING_LOAD, &load);
  vlResult r = vl_scene_create(context, &scene);
  if (r == VL_OK)
    r = vl_scene_diagnose(scene, arguments->operands[0], &load, report_message, list, &error);
  bool read = r == VL_OK;
  if (!read && r != VL_ERROR_MEMORY)
    report_message(list, &error);
  if (!read && r == VL_ERROR_SCENE)
    add(list, VL_FINDING_REMARK, VL_SEVERITY_NOTE, VL_OK, arguments->operands[0], 0, 0,
        "nothing after this line was looked at");
  vlCheckDef def = vl_default_check_def();
  def.images = !arguments->values[CHECK_NO_IMAGES].given;
  if (read)
    r = vl_scene_check(scene, &def, &check, &error);
  for (uint32_t i = 0; r == VL_OK && i < vl_check_count(check); i++) {
    const vlFinding *f = vl_check_finding(check, i);
    add(list, f->kind, f->severity, f->code, f->source.file, f->source.line, f->source.column,
        f->message);
  }
  vl_check_destroy(check);
  vl_scene_destroy(scene);
  if (r == VL_ERROR_MEMORY)
    return report_error(&error, r, NULL);
  return -1;
}

static const char *const severities[] = {"error", "warning", "note"};

static void print_text(const List *list, const char *path, bool all) {
  size_t of_kind[3][VL_FINDING_KINDS] = {{0}}, total[3] = {0};
  for (int severity = VL_SEVERITY_ERROR; severity <= (int)VL_SEVERITY_NOTE; severity++)
    for (size_t i = 0; i < list->count; i++) {
      const Entry *e = &list->items[i];
      if ((int)e->severity != severity)
        continue;
      total[severity]++;
      if (of_kind[severity][e->kind]++ >= SHOWN && !all)
        continue;
      text_print_plain(e->file[0] ? e->file : path);
      if (e->line)
        printf(":%u", e->line);
      if (e->line && e->column)
        printf(":%u", e->column);
      printf(": %s: ", severities[severity]);
      text_print_plain(e->message);
      printf(" [%s]\n", vl_finding_kind_name(e->kind));
    }
  for (int severity = 0; severity < 3; severity++)
    for (int k = 0; k < (int)VL_FINDING_KINDS && !all; k++)
      if (of_kind[severity][k] > SHOWN)
        printf("%zu more %ss of this kind: %s (--all shows them)\n",
               of_kind[severity][k] - SHOWN, severities[severity],
               vl_finding_kind_name((vlFindingKind)k));
  if (list->count == 0)
    printf("nothing found\n");
  if (list->count)
    printf("%zu error%s, %zu warning%s, %zu note%s\n", total[0], total[0] == 1 ? "" : "s",
           total[1], total[1] == 1 ? "" : "s", total[2], total[2] == 1 ? "" : "s");
}

static void print_json(const List *list, const char *path, int status) {
  Json *json = json_open();
  size_t total[3] = {0};
  for (size_t i = 0; i < list->count; i++)
    total[list->items[i].severity]++;
  json_put(json, "file %s, status %d, errors %lld, warnings %lld, notes %lld", path, status,
           (long long)total[0], (long long)total[1], (long long)total[2]);
  json_begin(json, "findings", '[');
  for (int severity = 0; severity < 3; severity++)
    for (size_t i = 0; i < list->count; i++) {
      const Entry *e = &list->items[i];
      if ((int)e->severity != severity)
        continue;
      json_begin(json, NULL, '{');
      json_put(json, "kind %s, severity %s", vl_finding_kind_name(e->kind),
               severities[severity]);
      json_location(json, e->file[0] ? e->file : NULL, e->line, e->line ? e->column : 0);
      json_text(json, "message", e->message);
      json_end(json, '}');
    }
  json_end(json, ']');
  json_close(json);
}

static int status_of_error(vlResult code) {
  switch (code) {
    case VL_ERROR_MISSING:
      return STATUS_MISSING;
    case VL_ERROR_IO:
      return STATUS_IO;
    default:
      return STATUS_SCENE;
  }
}

/* The exit code of `velo render` for this scene, by its first error; 1 when it would render,
 * but probably not as intended. */
static int status_of(const List *list) {
  int status = STATUS_OK;
  for (size_t i = 0; i < list->count; i++) {
    const Entry *e = &list->items[i];
    if (e->severity == VL_SEVERITY_ERROR)
      return status_of_error(e->code);
    if (e->severity == VL_SEVERITY_WARNING)
      status = STATUS_OTHER;
  }
  return status;
}

static int run(const Arguments *arguments, UNUSED vlContext *unused) {
  vlContext *context = NULL;
  List list = {0};
  int status = context_open_for(arguments, logged, &list, &context);
  if (status < 0)
    status = look(context, arguments, &list);
  if (status < 0) {
    status = status_of(&list);
    if (arguments->values[CHECK_JSON].given)
      print_json(&list, arguments->operands[0], status);
    else
      print_text(&list, arguments->operands[0], arguments->values[CHECK_ALL].given);
  }
  free(list.items);
  context_close(context);
  return status;
}

static Option options[] = {
    JSON_OPTION(CHECK_JSON),
    {CHECK_ALL, "all", "print every finding; default: the first 10 of each kind",
     .letter = 'a'},
    {CHECK_NO_IMAGES, "no-images",
     "do not read texture images; missing ones are still reported"},
    {CHECK_PERMISSIVE, "permissive",
     "parts of the scene that velo does not understand are notes, not errors"},
    SCENE_SEARCH_OPTION(CHECK_SEARCH),
    SCENE_SANDBOX_OPTION(CHECK_SANDBOX),
    {0}};

const Command scene_check_command = {
    .name = "scene check",
    .usage = "FILE [options]",
    .summary = "find errors and likely mistakes in a scene",
    .text =
        "Reads a scene, continues after errors, and prints all findings, each with its kind "
        "and its location\n"
        "in the file: missing, damaged and invalid files; unused and overwritten names; "
        "solids of glass\n"
        "that are open or inside out; media that overlap; faces without area; textures over "
        "uv on a mesh\n"
        "without uv; surfaces that reflect more light than they receive; a camera inside a "
        "solid; lights\n"
        "of power 0. Renders nothing.\n"
        "\n"
        "exit codes: 0 only notes or no findings; 1 warnings; 3, 4, 5 an error that would end "
        "velo render",
    .examples = "velo scene check room.pbrt\nvelo scene check --json --no-images model.glb",
    .options = options,
    .operands = 1,
    .run = run,
};
