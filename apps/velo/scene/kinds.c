/* scene/kinds.c: `velo scene kinds`: the kinds of materials, textures and so on with their
 * parameters, from the rows of velo/schema.h: as Markdown tables for the documentation, or as a
 * dictionary for a fuzzer. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "velo/setting.h"

enum { KINDS_DICTIONARY };

static const char *type_name(const vlParameter *p) {
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      return "bool";
    case VL_PARAMETER_COUNT:
      return "integer";
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_DOUBLE:
      return "float";
    case VL_PARAMETER_FLOAT3:
      return "vector3";
    case VL_PARAMETER_DOUBLE3:
      return p->flags & VL_PARAMETER_VECTOR ? "vector3" : "point3";
    case VL_PARAMETER_CHOICE:
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
      return "string";
    case VL_PARAMETER_BLOCK:
      return p->text ? p->text : "string";
    case VL_PARAMETER_SPECTRUM:
      return "spectrum";
    case VL_PARAMETER_FLOAT_INPUT:
      return p->flags & (VL_PARAMETER_NO_TEXTURE | VL_PARAMETER_FILE_NUMBER) ? "float"
                                                                             : "float, texture";
    case VL_PARAMETER_SPECTRUM_INPUT:
      if (p->flags & VL_PARAMETER_ONE_NUMBER)
        return "float";
      if (p->flags & VL_PARAMETER_NUMBER)
        return "float, spectrum";
      return p->flags & VL_PARAMETER_NO_TEXTURE ? "spectrum" : "spectrum, texture";
    case VL_PARAMETER_EITHER_INPUT:
      return "the texture's, texture";
    case VL_PARAMETER_TEXTURE:
      return "texture";
  }
  return "";
}

/* Whole numbers without an exponent. */
static void print_number(double number) {
  printf(fabs(number) < 1e15 && number == floor(number) ? "%.0f" : "%g", number);
}

static void print_default(const vlParameter *p) {
  const double k = p->factor != 0 ? 1 / p->factor : 1;
  if (p->flags & VL_PARAMETER_REQUIRED) {
    printf("required");
  } else if ((p->flags & VL_PARAMETER_SHORTHAND && p->value[0] == 0) ||
             p->flags & VL_PARAMETER_UNSET || p->type == VL_PARAMETER_BLOCK ||
             p->type == VL_PARAMETER_TEXTURE) {
    printf("–");
  } else if (p->type == VL_PARAMETER_BOOL) {
    printf("%s", p->value[0] != 0 ? "true" : "false");
  } else if (p->type == VL_PARAMETER_CHOICE) {
    printf("%s", p->choices[(int)p->value[0]]);
  } else if (p->text) {
    printf("%s", p->text);
  } else if (p->type == VL_PARAMETER_STRING || p->type == VL_PARAMETER_FILE) {
    printf("–");
  } else if (p->type == VL_PARAMETER_FLOAT3 || p->type == VL_PARAMETER_DOUBLE3 ||
             p->flags & VL_PARAMETER_RGB) {
    printf("%g %g %g", p->value[0], p->value[1], p->value[2]);
  } else {
    print_number(k * p->value[0]);
  }
}

static void print_range(const vlParameter *p) {
  const double k = p->factor != 0 ? 1 / p->factor : 1;
  if (p->type == VL_PARAMETER_CHOICE) {
    for (int i = 0; p->choices[i]; i++)
      printf("%s%s", i ? ", " : "", p->choices[i]);
  } else if (p->low != 0 || p->high != 0) {
    bool whole = p->type == VL_PARAMETER_COUNT && p->high >= 4294967295.0;
    bool open = isinf(p->high) || whole;
    bool above = p->flags & VL_PARAMETER_ABOVE_LOW;
    printf("%s", above ? "> " : open ? "≥ " : "");
    print_number(k * p->low);
    if (!open) {
      printf(" to ");
      print_number(k * p->high);
      if (p->flags & VL_PARAMETER_BELOW_HIGH)
        printf(", excluded");
    }
    if (p->flags & VL_PARAMETER_CLAMPED)
      printf(", clamped");
  }
}

static bool same_text(const char *a, const char *b) {
  return a && b ? strcmp(a, b) == 0 : a == b;
}

static bool same_parameter(const vlParameter *a, const vlParameter *b) {
  return same_text(a->name, b->name) && same_text(a->alias, b->alias) &&
         same_text(a->description, b->description) && same_text(a->unit, b->unit) &&
         same_text(a->text, b->text) && a->type == b->type && a->flags == b->flags &&
         memcmp(a->value, b->value, sizeof a->value) == 0 && a->low == b->low &&
         a->high == b->high;
}

enum { SHARED = 6 }; /* smaller numbers of common parameters are listed again for each kind */

/* Returns an earlier kind whose parameters are all the first parameters of this kind. Of
 * several, returns the one with the most parameters; null if there is none. */
static const vlKindRow *base_of(const vlKindFamily *family, uint32_t kind) {
  const vlKindRow *row = family->rows[kind], *base = NULL;
  for (uint32_t i = 0; i < kind; i++) {
    const vlKindRow *other = family->rows[i];
    uint32_t n = other->parameter_count, k = 0;
    if (!other->name || n < SHARED || n > row->parameter_count ||
        (base && n <= base->parameter_count))
      continue;
    while (k < n && same_parameter(&other->parameters[k], &row->parameters[k]))
      k++;
    if (k == n)
      base = other;
  }
  return base;
}

/* settings: of velo/setting.h, which have keywords instead of names in files. */
static void print_row(const vlKindRow *row, const vlKindRow *base, bool settings) {
  uint32_t first = base ? base->parameter_count : 0;
  printf("**`%s`**%s%s%s: %s.", row->name, row->alias ? " (also `" : "",
         row->alias ? row->alias : "", row->alias ? "`)" : "", row->description);
  if (base)
    printf(" The parameters of `%s`%s", base->name,
           first < row->parameter_count ? " and these:" : ".");
  printf("\n\n");
  bool any = false;
  for (uint32_t i = first; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    const char *name = settings ? vl_setting_keyword(p) : p->name;
    if (!name || (settings && p->flags & VL_PARAMETER_RULE))
      continue;
    if (!any)
      printf("| parameter | type | default | range | |\n| --- | --- | --- | --- | --- |\n");
    any = true;
    printf("| `%s`", name);
    if (p->alias && !settings)
      printf(" (also `%s`)", p->alias);
    printf(" | %s | ", type_name(p));
    print_default(p);
    printf("%s%s | ", p->unit ? " " : "", p->unit ? p->unit : "");
    print_range(p);
    printf(" | %s |\n", p->description);
  }
  if (any)
    printf("\n");
}

static void print_tables(const vlKindFamily *family) {
  for (uint32_t i = 0; i < family->kind_count; i++)
    if (family->rows[i]->name)
      print_row(family->rows[i], base_of(family, i), !family->directive);
}

/* One token per line, quoted, including the quotes that scene files put around it. */
static void print_word(const char *type, const char *name) {
  if (name)
    printf("\"\\\"%s%s%s\\\"\"\n", type, type[0] ? " " : "", name);
}

static void print_words(const vlKindFamily *family) {
  if (!family->directive)
    return; /* settings are in no scene file */
  printf("# %s\n\"%s\"\n", family->name, family->directive);
  for (uint32_t i = 0; i < family->kind_count; i++) {
    const vlKindRow *row = family->rows[i];
    print_word("", row->name);
    print_word("", row->alias);
    for (uint32_t k = 0; k < row->parameter_count; k++) {
      const vlParameter *p = &row->parameters[k];
      char type[32];
      text_set(type, "%s", type_name(p));
      type[strcspn(type, ", ")] = 0;
      if (p->type == VL_PARAMETER_EITHER_INPUT)
        text_set(type, "float");
      print_word(type, p->name);
      print_word(type, p->alias);
      for (int c = 0; p->name && p->choices && p->choices[c]; c++)
        print_word("", p->choices[c]);
    }
  }
}

static int run(const Arguments *arguments, UNUSED vlContext *context) {
  const char *wanted = arguments->operand_count ? arguments->operands[0] : NULL;
  bool dictionary = arguments->values[KINDS_DICTIONARY].given, found = false;
  const vlKindFamily *family;
  for (uint32_t i = 0; (family = vl_kind_family(i)); i++) {
    if (wanted && strcmp(wanted, family->name) != 0)
      continue;
    found = true;
    if (dictionary)
      print_words(family);
    else if (wanted)
      print_tables(family);
    else
      printf("%s\n", family->name);
  }
  if (!found)
    return report_usage("there is no family of kinds \"%s\" (velo scene kinds lists them)",
                        wanted);
  return STATUS_OK;
}

static Option options[] = {{KINDS_DICTIONARY, "dictionary",
                            "print the names as a dictionary for a fuzzer, one per line"},
                           {0}};

const Command scene_kinds_command = {
    .name = "scene kinds",
    .usage = "[FAMILY] [options]",
    .summary = "list kinds of objects in pbrt files and their parameters",
    .text =
        "Without FAMILY, prints the names of the families. With FAMILY, prints a Markdown "
        "table of parameters for each kind of that family.",
    .examples = "velo scene kinds\nvelo scene kinds lights",
    .options = options,
    .optional_operands = 1,
    .run = run,
};
