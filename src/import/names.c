/* import/names.c: see names.h. Linear probing, at most half full. */
#include "import/names.h"

#include "base/text.h"

static uint32_t hash(const char *s) { /* FNV-1a */
  uint32_t h = 2166136261u;
  for (; *s; s++)
    h = (h ^ (unsigned char)*s) * 16777619u;
  return h;
}

static vlNamed *slot_of(const vlNameTable *t, const char *name) {
  uint32_t i = hash(name) & (t->capacity - 1);
  while (t->slots[i].name && !vl_text_is(t->slots[i].name, name))
    i = (i + 1) & (t->capacity - 1);
  return &t->slots[i];
}

/* Adds a name. An existing name gets the new index. */
bool vl_names_add(vlContext *context, vlNameTable *t, const char *name, uint32_t index) {
  if (2 * (t->count + 1) > t->capacity) {
    vlNameTable grown = {.capacity = t->capacity ? 2 * t->capacity : 16, .count = t->count};
    grown.slots = vl_alloc_zero(context, grown.capacity, sizeof *grown.slots);
    if (!grown.slots)
      return false;
    for (uint32_t i = 0; i < t->capacity; i++)
      if (t->slots[i].name)
        *slot_of(&grown, t->slots[i].name) = t->slots[i];
    vl_free(context, t->slots);
    *t = grown;
  }
  vlNamed *slot = slot_of(t, name);
  if (!slot->name)
    t->count++;
  *slot = (vlNamed){name, index};
  return true;
}

bool vl_names_find(const vlNameTable *t, const char *name, uint32_t *index) {
  if (!t->count)
    return false;
  const vlNamed *slot = slot_of(t, name);
  if (!slot->name)
    return false;
  *index = slot->index;
  return true;
}

/* Considers at most 1024 names: the result is only a hint in an error message. */
const char *vl_names_nearest(const vlNameTable *t, const char *name) {
  const char *names[1024];
  size_t count = 0;
  for (uint32_t i = 0; i < t->capacity && count < 1024; i++)
    if (t->slots[i].name)
      names[count++] = t->slots[i].name;
  return vl_nearest_name(name, names, count);
}

vlHint vl_hint(const char *near) {
  vlHint hint = {""};
  if (near)
    snprintf(hint.text, sizeof hint.text, " (did you mean \"%s\"?)", near);
  return hint;
}
