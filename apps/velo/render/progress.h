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

/* Progress of several images, of which `done` are complete. */
typedef struct FrameProgress {
  double start, last_shown; /* of monotonic_seconds */
  uint32_t done, count;
} FrameProgress;

void progress_start(Progress *progress, double time_limit);
void progress_show(Progress *progress, const vlProgress *now);

FrameProgress progress_frames(uint32_t count);
/* Shows at intervals how many frames are done. number: of the frame that is rendered; part: its
 * finished share. */
void progress_show_frames(FrameProgress *progress, uint32_t number, double part);

/* A number in few digits. */
typedef struct NumberText {
  char text[32];
} NumberText;
/* A count: "1.27 M", "950", "3.4 G". */
NumberText format_count(double count);
/* Seconds: "4.2 s", "1:05", "2:03:20". */
NumberText format_seconds(double seconds);
/* Seconds of a clock that is never set back; its zero is arbitrary. */
double monotonic_seconds(void);
/* A progress function of renders that show none: a signal stops them. */
bool progress_until_signal(void *user, const vlProgress *now);

#endif
