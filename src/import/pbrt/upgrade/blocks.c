/* import/pbrt/upgrade/blocks.c: TransformBegin and TransformEnd. pbrt-v3's keep the transform
 * alone, those of pbrt-v4 all attributes: what a block sets beside the transform is repeated
 * after it. */

#include "base/context.h"
#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

/* Directives that set an attribute, by attribute. */
static const char *const setters[][2] = {
    {"Material", "NamedMaterial"}, {"AreaLightSource", NULL}, {"MediumInterface", NULL}};
enum { SETTERS = VL_LENGTH(setters) };
_Static_assert((int)SETTERS == (int)VL_OLD_ATTRIBUTES, "vlOldBlock has an entry for each");

static int attribute_of(const char *word) {
  for (int i = 0; i < SETTERS; i++)
    for (int k = 0; k < 2; k++)
      if (vl_text_is(setters[i][k], word))
        return i;
  return -1;
}

static bool push(const vlOldStatement *s, bool transform) {
  vlOldBlock *b = VL_PUSH(s->u->context, &s->file->blocks);
  if (!b)
    return vl_old_fail_memory(s->u);
  *b = (vlOldBlock){.transform = transform};
  return true;
}

/* The new statement without what was written before it: its last line that begins with the
 * directive. */
static const char *last_statement(const char *text) {
  const char *last = text;
  for (const char *line = text; line; line = strchr(line, '\n')) {
    line += *line == '\n';
    const char *word = line + strspn(line, " \t");
    for (int i = 0; i < SETTERS; i++)
      for (int k = 0; k < 2; k++)
        if (setters[i][k] && strncmp(word, setters[i][k], strlen(setters[i][k])) == 0)
          last = word;
    if (!strchr(line, '\n'))
      break;
  }
  return last;
}

static bool repeat(vlOldStatement *s, const vlOldBlock *block) {
  for (int i = 0; i < SETTERS; i++) {
    if (block->set[i].end == block->set[i].start)
      continue;
    char *text = vl_old_render(s->file, block->set[i]);
    bool fine = text ? vl_old_insert(s, VL_OLD_AFTER, "%s", last_statement(text))
                     : vl_old_fail_memory(s->u);
    vl_free(s->u->context, text);
    if (!fine)
      return false;
    vl_old_note(s, "%s of line %u again", setters[i][0], block->line[i]);
  }
  return true;
}

bool vl_old_block(vlOldStatement *s) {
  const char *word = s->directive;
  bool transform = strncmp(word, "Transform", 9) == 0, begin = word[strlen(word) - 1] == 'n';
  if (transform) {
    vl_old_note(s, "-> %s", begin ? "AttributeBegin" : "AttributeEnd");
    if (!vl_old_edit(s, s->keyword, begin ? "AttributeBegin" : "AttributeEnd"))
      return false;
  }
  if (begin)
    return push(s, transform);
  if (!s->file->blocks.count)
    return true;
  vlOldBlock block = s->file->blocks.items[--s->file->blocks.count];
  if (!block.transform)
    return true;
  /* an outer block of the same kind sets the attribute, too */
  vlOldBlock *outer =
      s->file->blocks.count ? &s->file->blocks.items[s->file->blocks.count - 1] : NULL;
  for (int i = 0; i < SETTERS && outer; i++)
    if (block.set[i].end > block.set[i].start) {
      outer->set[i] = block.set[i];
      outer->line[i] = block.line[i];
    }
  return repeat(s, &block);
}

void vl_old_block_sets(const vlOldStatement *s) {
  int i = attribute_of(s->directive);
  if (i < 0 || !s->file->blocks.count)
    return;
  vlOldBlock *block = &s->file->blocks.items[s->file->blocks.count - 1];
  block->set[i] = s->whole;
  block->line[i] = s->line;
}
