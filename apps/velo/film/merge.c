/* film/merge.c: `velo film merge`: merges the films of a render's parts into one film. */
#include <limits.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "render/output_names.h"
#include "velo/film.h"

enum { MERGE_OUTPUT, MERGE_OVERWRITE };

static int run_merge(const Arguments *arguments, vlContext *context) {
  const OptionValue *output = &arguments->values[MERGE_OUTPUT];
  if (!output->given)
    return report_usage("film merge: give the name of the result with -o");
  vlError error = {0};
  TRY(output_check(NULL, output->text, VL_OUTPUT_FILM));
  vl_remove_leftovers(output_opened(output->text));
  vlFilmMergeDef def = vl_default_film_merge_def();
  def.overwrite = arguments->values[MERGE_OVERWRITE].given;
  return report_finish(
      &error,
      vl_film_merge(context, arguments->all_operands, (uint32_t)arguments->operand_count, &def,
                    output_opened(output->text), &error),
      NULL);
}

static Option merge_options[] = {
    {MERGE_OUTPUT, "output", "film file to write; may be one of the parts", OPTION_TEXT, "FILE",
     .letter = 'o'},
    {MERGE_OVERWRITE, "overwrite",
     "replace an earlier film even if it is of another render or has samples that the result "
     "lacks"},
    {0}};

const Command film_merge_command = {
    .name = "film merge",
    .usage = "FILE... -o FILE",
    .summary = "merge the parts of a render into one film",
    .text =
        "Merges film files of one render that have different samples or pixels. The order of "
        "the files does\n"
        "not matter, and a file that is given twice counts once: the result has the bytes of "
        "a single render.",
    .examples =
        "velo film merge part-*.film -o room.film\n"
        "velo film merge room.film late.film -o room.film",
    .options = merge_options,
    .operands = 1,
    .optional_operands = INT_MAX - 1,
    .context = CONTEXT_ONE,
    .run = run_merge,
};
