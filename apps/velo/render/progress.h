/* render/progress.h: shows the progress of a render: as a bar on a terminal, else as lines of
 * text; as JSON with --log-json. */
#ifndef APP_RENDER_PROGRESS_H
#define APP_RENDER_PROGRESS_H

#include "velo/render.h"

typedef struct Progress {
  double time_limit; /* seconds; 0: none */
  double last_shown; /* elapsed seconds at the last line or redraw; -1: none yet */
  uint32_t last_spp;
} Progress;

void progress_start(Progress *progress, double time_limit);
void progress_show(Progress *progress, const vlProgress *now);

/* Formats a count: "1.27 M", "950", "3.4 G". */
void format_count(char *text, size_t size, double count);
/* Formats seconds: "4.2 s", "1:05", "2:03:20". */
void format_seconds(char *text, size_t size, double seconds);
/* Seconds of a clock that is never set back; its zero is arbitrary. */
double monotonic_seconds(void);

#endif
