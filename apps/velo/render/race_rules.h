/* render/race_rules.h: when there is a race of tracers, what its result changes, and the line
 * that tells it: the same for `velo render` and `velo view`. */
#ifndef APP_RENDER_RACE_RULES_H
#define APP_RENDER_RACE_RULES_H

#include "render/job.h"
#include "velo/choose.h"

/* By default there is a race from this number of samples per pixel on. */
enum { RACE_LEAST_SAMPLES = 32 };

/* Returns whether --tracer auto is given. */
bool race_is_asked(const Arguments *arguments);
/* Checks the options that --tracer auto excludes. Returns -1, or the exit code after reporting
 * the error. */
int race_check_options(const Arguments *arguments);
/* The race of an image: if it is asked for, or by default. defs: of the whole image, with its
 * number of samples. */
RaceKind race_kind(const vlSceneDefs *defs, const Arguments *arguments);
/* The number of samples per pixel for which the race is planned, for vl_choose_tracer. */
uint32_t race_samples(const vlSceneDefs *defs);
/* Sets the tracer and the number of light paths. */
void race_take(vlRenderDef *def, RaceKind kind, const vlTracerChoice *choice);
/* Writes the line "auto: bidirectional (error x rays: volpath 1, bidirectional 0.31, ...)", or
 * which tracer --tracer auto takes where there was no race. */
void race_line(RaceKind kind, const vlTracerChoice *choice, char *text, size_t size);

#endif
