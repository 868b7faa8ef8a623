/* api/receipt_compare.c: describes the differences of two receipts in words. */
#include <stdarg.h>
#include <stdio.h>

#include "api/receipt.h"
#include "base/text.h"

typedef struct Comparison {
  vlReceiptFn *fn;
  void *user;
  uint32_t count;
  bool ended;
} Comparison;

static void differ(Comparison *c, const char *format, ...) VL_PRINTF(2, 3);
static void differ(Comparison *c, const char *format, ...) {
  char text[700];
  va_list list;
  if (c->ended)
    return;
  va_start(list, format);
  vsnprintf(text, sizeof text, format, list);
  va_end(list);
  for (char *at = text; *at; at++)
    if ((unsigned char)*at < 0x20 || *at == 0x7f)
      *at = ' '; /* keeps the text on one line, whatever the receipt holds */
  c->count++;
  if (c->fn && !c->fn(c->user, text))
    c->ended = true;
}

/* A buffer that drops text beyond `size`. used: the length of the whole text, including what
 * was dropped. */
typedef struct Sink {
  char *text;
  size_t size, used;
} Sink;

static int fill(const char *part, size_t length, void *user) {
  Sink *sink = user;
  size_t room = sink->used < sink->size ? sink->size - sink->used : 0;
  memcpy(sink->text + sink->size - room, part, length < room ? length : room);
  sink->used += length;
  return 0;
}

/* Returns a value as text: strings without quotes if they have any visible character, other
 * values as JSON, shortened if they are long. */
static const char *words_of(const json_t *value, char *text, size_t size) {
  if (!value || json_is_null(value))
    return "not given";
  if (json_is_string(value) &&
      json_string_value(value)[strspn(json_string_value(value), " \t\r\n")]) {
    snprintf(text, size, "%.*s", (int)size - 1, json_string_value(value));
    return text;
  }
  Sink sink = {text, size, 0};
  json_dump_callback(value, fill, &sink,
                     JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(10));
  text[sink.used < size ? sink.used : size - 1] = 0;
  if (sink.used >= size)
    snprintf(text + size - 4, 4, "...");
  return text;
}

/* Reports a changed value. Numbers have ten digits; if both texts are still equal, the message
 * only says that they differ. */
static void differ_value(Comparison *c, const char *thing, const char *name, const json_t *then,
                         const json_t *now) {
  char before[120], after[120];
  const char *was = words_of(then, before, sizeof before),
             *is = words_of(now, after, sizeof after);
  const char *start = thing ? thing : "", *between = thing ? " differs: " : "";
  if (vl_text_is(was, is))
    differ(c, "%s%s%.60s is another", start, between, name);
  else
    differ(c, "%s%s%.60s is %s, was %s", start, between, name, is, was);
}

/* The members of "render" that say when a block has enough samples, not which samples it
 * gets. */
static bool is_extent(const char *key) {
  return vl_text_is(key, "spp") || vl_text_is(key, "adaptive");
}

/* Compares the members of two objects, for which `extent` is null or equals is_extent(member).
 * thing: null for "NAME is A, was B". */
static void compare_objects(Comparison *c, const char *thing, const json_t *then,
                            const json_t *now, const bool *extent) {
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)(uintptr_t)now, key, value) {
    const json_t *old = json_object_get(then, key);
    if (!old && json_is_false(value))
      continue; /* a switch that earlier versions do not have; it is off */
    if ((!extent || is_extent(key) == *extent) && (!old || !json_equal(old, value)))
      differ_value(c, thing, key, old, value);
  }
  json_object_foreach((json_t *)(uintptr_t)then, key, value) {
    if ((!extent || is_extent(key) == *extent) && !json_object_get(now, key))
      differ_value(c, thing, key, value, NULL);
  }
}

static void compare_member(Comparison *c, const char *thing, const vlReceipt *then,
                           const vlReceipt *now, const char *name, const bool *extent) {
  const json_t *old = json_object_get(then->tree, name),
               *new = json_object_get(now->tree, name);
  if (json_is_object(old) && json_is_object(new))
    compare_objects(c, thing, old, new, extent);
  else if (!old != !new || (old && !json_equal(old, new)))
    differ_value(c, NULL, name, old, new);
}

/* ---- files ------------------------------------------------------------------------------- */

/* Both lists are sorted by path, so one walk along both finds all differences. */
static void compare_files(Comparison *c, const vlReceipt *then, const vlReceipt *now) {
  vlFileRecord old = {0}, new = {0};
  uint32_t i = 0, j = 0;
  while (!c->ended) {
    bool any_old = vl_receipt_file(then, i, &old) != NULL,
         any_new = vl_receipt_file(now, j, &new) != NULL;
    if (!any_old && !any_new)
      return;
    int order = !any_old ? 1 : !any_new ? -1 : strcmp(old.path, new.path);
    if (order == 0 &&
        (old.size != new.size || memcmp(old.digest, new.digest, sizeof old.digest) != 0))
      differ(c, "the file %.400s changed", new.path);
    if (order < 0)
      differ(c, "the file %.400s is no longer read", old.path);
    if (order > 0)
      differ(c, "the file %.400s is read in addition", new.path);
    i += order <= 0;
    j += order >= 0;
  }
}

/* ---- all --------------------------------------------------------------------------------- */

static void compare_velo(Comparison *c, const vlReceipt *then, const vlReceipt *now,
                         uint32_t parts) {
  const json_t *old = json_object_get(then->tree, "velo"),
               *new = json_object_get(now->tree, "velo");
  static const struct {
    uint32_t part;
    const char *key, *name;
  } members[] = {{VL_RECEIPT_SEQUENCE, "sequence", "velo's sample sequence"},
                 {VL_RECEIPT_VERSION, "version", "velo's version"},
                 {VL_RECEIPT_VERSION, "commit", "velo's commit"}};
  for (size_t i = 0; i < VL_LENGTH(members); i++) {
    const json_t *before = json_object_get(old, members[i].key),
                 *after = json_object_get(new, members[i].key);
    if (parts & members[i].part && (before || after) && !json_equal(before, after))
      differ_value(c, NULL, members[i].name, before, after);
  }
}

uint32_t vl_receipt_compare(const vlReceipt *then, const vlReceipt *now, uint32_t parts,
                            vlReceiptFn *fn, void *user) {
  Comparison c = {.fn = fn, .user = user};
  compare_velo(&c, then, now, parts);
  if (parts & VL_RECEIPT_FILES)
    compare_files(&c, then, now);
  if (parts & VL_RECEIPT_CAMERA)
    compare_member(&c, "camera", then, now, "camera", NULL);
  if (parts & VL_RECEIPT_SETTINGS) {
    compare_member(&c, "load", then, now, "load", NULL);
    /* earlier receipts do not have it */
    if (json_object_get(then->tree, "completed") && json_object_get(now->tree, "completed"))
      compare_member(&c, "completed", then, now, "completed", NULL);
    compare_member(&c, "film", then, now, "film", NULL);
    compare_member(&c, "build", then, now, "build", NULL);
    compare_member(&c, "render", then, now, "render", &(const bool){false});
  }
  if (parts & VL_RECEIPT_SAMPLES) {
    const json_t *old = json_object_get(then->tree, "render"),
                 *new = json_object_get(now->tree, "render");
    if (old && new)
      compare_objects(&c, NULL, old, new, &(const bool){true});
    compare_member(&c, NULL, then, now, "samples", NULL);
  }
  if (parts & VL_RECEIPT_DEVELOP)
    compare_member(&c, "develop", then, now, "develop", NULL);
  if (parts & VL_RECEIPT_COMMAND) {
    compare_member(&c, NULL, then, now, "scene", NULL);
    compare_member(&c, NULL, then, now, "command", NULL);
  }
  if (parts & VL_RECEIPT_OUTPUTS)
    compare_member(&c, NULL, then, now, "outputs", NULL);
  return c.count;
}
