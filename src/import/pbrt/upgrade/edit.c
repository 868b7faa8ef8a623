/* import/pbrt/upgrade/edit.c: edits of the text, and reports. */
#include <stdarg.h>
#include <stdlib.h>

#include "base/context.h"
#include "base/error.h"
#include "base/free.h"
#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

/* ---- errors and reports ------------------------------------------------------------------ */

bool vl_old_fail(vlOldFile *file, vlResult code, uint32_t line, uint32_t column,
                 const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  vlUpgrade *u = file->u;
  if (u->result == VL_OK)
    u->result = vl_fail_at(&u->error, code, file->path, line, column, "%s", text);
  return false;
}

bool vl_old_wrong(const vlOldStatement *s, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  return vl_old_fail(s->file, VL_ERROR_SCENE, s->line, s->column, "%s", text);
}

bool vl_old_fail_memory(vlUpgrade *u) {
  if (u->result == VL_OK)
    u->result = vl_fail_memory(&u->error);
  return false;
}

static void report(const vlOldStatement *s, vlUpgradeNote note, const char *text) {
  const vlUpgradeDef *def = s->u->def;
  vlError where = {0};
  if (s->u->quiet || !def->report)
    return;
  vl_fail_at(&where, VL_OK, s->file->path, s->line, 0, "%s", "");
  def->report(def->report_user, note, &where, text);
}

void vl_old_lose(const vlOldStatement *s, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  if (!s->u->quiet)
    s->u->lost++;
  report(s, VL_UPGRADE_LOST, text);
}

void vl_old_note(vlOldStatement *s, const char *format, ...) {
  size_t n = strlen(s->changes);
  if (n + 3 >= sizeof s->changes)
    return;
  if (n)
    n += (size_t)snprintf(s->changes + n, sizeof s->changes - n, ", ");
  va_list args;
  va_start(args, format);
  vsnprintf(s->changes + n, sizeof s->changes - n, format, args);
  va_end(args);
}

/* Bit of the order of statements that follow: parameters that are added later still stand
 * before them. */
static const uint32_t AFTER = 0x80000000u;

/* ---- edits ------------------------------------------------------------------------------- */

/* An edit of prefix, text of any length, and suffix. */
static bool edit_parts(const vlOldStatement *s, vlOldSpan span, const char *prefix,
                       int prefix_length, const char *suffix, int suffix_length,
                       const char *format, va_list args) {
  vlContext *context = s->u->context;
  va_list again;
  va_copy(again, args);
  const int length = vsnprintf(NULL, 0, format, again);
  va_end(again);
  const size_t size = (size_t)length + (size_t)prefix_length + (size_t)suffix_length + 1;
  char *whole = length < 0 ? NULL : vl_alloc(context, size);
  if (!whole)
    return vl_old_fail_memory(s->u);
  memcpy(whole, prefix, (size_t)prefix_length);
  vsnprintf(whole + prefix_length, size - (size_t)prefix_length, format, args);
  memcpy(whole + prefix_length + length, suffix, (size_t)suffix_length);
  whole[size - 1] = 0;
  uint32_t order = (uint32_t)s->file->edits.count;
  vlOldEdit *edit = VL_PUSH(context, &s->file->edits);
  if (!edit) {
    vl_free(context, whole);
    return vl_old_fail_memory(s->u);
  }
  *edit = (vlOldEdit){span, whole, order};
  return true;
}

bool vl_old_edit(const vlOldStatement *s, vlOldSpan span, const char *format, ...) {
  va_list args;
  va_start(args, format);
  const bool fine = edit_parts(s, span, "", 0, "", 0, format, args);
  va_end(args);
  return fine;
}

/* Start of the line of an offset, and the length of its indentation. */
static size_t line_start(const vlOldFile *file, size_t at, int *indent) {
  size_t start = at;
  while (start > 0 && file->text[start - 1] != '\n')
    start--;
  *indent = 0;
  while (file->text[start + (size_t)*indent] == ' ' ||
         file->text[start + (size_t)*indent] == '\t')
    ++*indent;
  return start;
}

bool vl_old_remove(vlOldStatement *s) {
  int indent;
  size_t line = line_start(s->file, s->whole.start, &indent), end = s->whole.end;
  while (end < s->file->size && (s->file->text[end] == ' ' || s->file->text[end] == '\t' ||
                                 s->file->text[end] == '\r'))
    end++;
  bool alone = line + (size_t)indent == s->whole.start &&
               (end >= s->file->size || s->file->text[end] == '\n');
  vlOldSpan span = alone ? (vlOldSpan){line, end < s->file->size ? end + 1 : end} : s->whole;
  for (size_t i = 0; i < s->params.count; i++)
    s->params.items[i].dropped = true;
  s->whole.end = s->whole.start;
  return vl_old_edit(s, span, "%s", "");
}

typedef struct LineBegin {
  char text[200];
  int length;
} LineBegin;

/* A line break, and the indentation of the statement's line. */
static LineBegin line_of(const vlOldStatement *s) {
  LineBegin result;
  int indent;
  size_t line = line_start(s->file, s->keyword.start, &indent);
  snprintf(result.text, sizeof result.text, "\n%.*s", indent, s->file->text + line);
  result.length = (int)strlen(result.text);
  return result;
}

bool vl_old_insert(const vlOldStatement *s, vlOldSide side, const char *format, ...) {
  const bool after = side == VL_OLD_AFTER;
  const LineBegin line = line_of(s);
  const size_t at = after ? s->whole.end : s->keyword.start;
  va_list args;
  va_start(args, format);
  const bool fine = edit_parts(s, (vlOldSpan){at, at}, line.text, after ? line.length : 0,
                               line.text, after ? 0 : line.length, format, args);
  va_end(args);
  if (fine && after)
    s->file->edits.items[s->file->edits.count - 1].order |= AFTER;
  return fine;
}

/* The blanks before the last parameter, which separate an added one, too. */
static int separator(const vlOldStatement *s, const char **text) {
  *text = " ";
  if (s->params.count < 2)
    return 1;
  size_t end = s->params.items[s->params.count - 1].decl.start, start = end;
  while (start > 0 && strchr(" \t\r\n", s->file->text[start - 1]))
    start--;
  if (start == end || end - start > 100)
    return 1;
  *text = s->file->text + start;
  return (int)(end - start);
}

bool vl_old_add(const vlOldStatement *s, const char *format, ...) {
  const char *blank;
  int n = separator(s, &blank);
  va_list args;
  va_start(args, format);
  const bool fine =
      edit_parts(s, (vlOldSpan){s->whole.end, s->whole.end}, blank, n, "", 0, format, args);
  va_end(args);
  return fine;
}

bool vl_old_rename(vlOldStatement *s, size_t i, const char *name) {
  if (!name || vl_text_is(s->name[i], name))
    return true;
  vl_old_note(s, "\"%s\" -> \"%s\"", s->name[i], name);
  s->name[i] = name;
  return vl_old_edit(s, s->names[i], "\"%s\"", name);
}

/* ---- a finished statement ---------------------------------------------------------------- */

/* Removes a parameter with the blanks before it. */
static bool cut_param(const vlOldStatement *s, const vlOldParam *p) {
  size_t start = p->decl.start;
  while (start > 0 && strchr(" \t\r\n", s->file->text[start - 1]))
    start--;
  /* a comment before it ends with its line */
  size_t line = start;
  while (line > 0 && s->file->text[line - 1] != '\n')
    line--;
  if (memchr(s->file->text + line, '#', start - line))
    start = p->decl.start;
  return vl_old_edit(s, (vlOldSpan){start, p->value.end}, "%s", "");
}

bool vl_old_finish(vlOldStatement *s) {
  if (s->finished)
    return true;
  s->finished = true;
  for (size_t i = 0; i < s->name_count; i++)
    if (s->renamed >> i & 1 && !vl_old_edit(s, s->names[i], "\"%s\"", s->name[i]))
      return false;
  VL_EACH_ITEM(vlOldParam, p, &s->params) {
    if (p->dropped && s->whole.end == s->whole.start)
      continue; /* the whole statement is removed */
    if (p->dropped && !cut_param(s, p))
      return false;
    if (p->dropped)
      continue;
    bool named = vl_text_is(p->name, p->new_name), typed = vl_text_is(p->type, p->new_type);
    if (!named)
      vl_old_note(s, "%s -> %s", p->name, p->new_name);
    if (named && !typed)
      vl_old_note(s, "%s %s -> %s", p->type, p->name, p->new_type);
    if ((!named || !typed) && !vl_old_edit(s, p->decl, "\"%s %s\"", p->new_type, p->new_name))
      return false;
    if (p->new_value[0] && !vl_old_edit(s, p->value, "%s", p->new_value))
      return false;
  }
  if (!s->changes[0])
    return true;
  char text[520];
  bool of_kind = s->name_count > 0 && s->word->form == VL_OLD_PARAMS;
  snprintf(text, sizeof text, "%s%s%s", s->directive, of_kind ? ": " : " ", s->changes);
  report(s, VL_UPGRADE_CHANGED, text);
  return true;
}

static int by_offset(const void *a, const void *b) {
  const vlOldEdit *x = a, *y = b;
  bool x_adds = x->span.start == x->span.end, y_adds = y->span.start == y->span.end;
  if (x->span.start != y->span.start)
    return x->span.start < y->span.start ? -1 : 1;
  if (x_adds != y_adds)
    return x_adds ? -1 : 1;
  return x->order < y->order ? -1 : x->order > y->order;
}

uint32_t vl_old_line(const vlOldFile *file, size_t offset) {
  size_t old = 0, new = 0;
  VL_EACH_ITEM(const vlOldEdit, e, &file->edits) {
    if (e->span.start < old)
      continue; /* inside of a larger edit */
    const size_t kept = e->span.start - old, added = strlen(e->text);
    if (new + kept > offset)
      break;
    new += kept;
    old = e->span.start;
    if (new + added > offset) {
      offset = new;
      break;
    }
    new += added;
    old = e->span.end;
  }
  uint32_t line = 1;
  for (size_t i = 0; i < old + offset - new &&i < file->size; i++)
    line += file->text[i] == '\n';
  return line;
}

char *vl_old_render(vlOldFile *file, vlOldSpan span) {
  size_t size = span.end - span.start + 1;
  if (file->edits.count)
    qsort(file->edits.items, file->edits.count, sizeof *file->edits.items, by_offset);
  for (size_t i = 0; i < file->edits.count; i++)
    size += strlen(file->edits.items[i].text);
  char *out = vl_alloc(file->u->context, size), *to = out;
  if (!out)
    return NULL;
  size_t at = span.start;
  VL_EACH_ITEM(const vlOldEdit, e, &file->edits) {
    if (e->span.start < at || e->span.end > span.end)
      continue; /* outside, or inside of a larger edit */
    memcpy(to, file->text + at, e->span.start - at);
    to += e->span.start - at;
    memcpy(to, e->text, strlen(e->text));
    to += strlen(e->text);
    at = e->span.end;
  }
  memcpy(to, file->text + at, span.end - at);
  to += span.end - at;
  *to = 0;
  return out;
}
