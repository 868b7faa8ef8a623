/* render/progress.c: see progress.h. */
#include "render/progress.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"

double monotonic_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

bool progress_until_signal(UNUSED void *user, UNUSED const vlProgress *now) {
  return !signals_pending();
}

NumberText format_count(double count) {
  static const char *const units[] = {"", " k", " M", " G", " T"};
  NumberText result;
  int unit = 0;
  while (count >= 999.5 && unit < 4) {
    count /= 1000;
    unit++;
  }
  const int digits = unit == 0 || count >= 99.95 ? 0 : count < 9.995 ? 2 : 1;
  text_set(result.text, "%.*f%s", digits, count, units[unit]);
  return result;
}

NumberText format_seconds(double seconds) {
  NumberText result = {"?"};
  const bool known = seconds >= 0 && seconds <= 1e9;
  const unsigned long s = known ? (unsigned long)(seconds + 0.5) : 0;
  if (known && seconds < 59.95)
    text_set(result.text, "%.*f s", seconds < 9.995 ? 2 : 1, seconds);
  else if (known && s < 3600)
    text_set(result.text, "%lu:%02lu", s / 60, s % 60);
  else if (known)
    text_set(result.text, "%lu:%02lu:%02lu", s / 3600, s / 60 % 60, s % 60);
  return result;
}

void progress_start(Progress *progress, double time_limit) {
  *progress = (Progress){.time_limit = time_limit, .last_shown = -1};
}

/* The finished share of the work and the remaining seconds, by samples or by the time limit,
 * whichever ends first. */
static void estimate(const Progress *progress, const vlProgress *now, double *fraction,
                     double *remaining) {
  *fraction = now->fraction > 0 ? now->fraction < 1 ? now->fraction : 1 : 0;
  *remaining = now->remaining;
  if (progress->time_limit > 0) {
    double by_time = now->elapsed / progress->time_limit,
           left = progress->time_limit - now->elapsed;
    if (by_time > *fraction)
      *fraction = by_time < 1 ? by_time : 1;
    if (!(*remaining >= 0) || left < *remaining)
      *remaining = left > 0 ? left : 0;
  }
}

/* The longest text that fits the line. The remaining time is dropped last. */
static void describe(const vlProgress *now, double remaining, double rate, int room, char *text,
                     size_t size) {
  char left[40] = "";
  const NumberText elapsed = format_seconds(now->elapsed);
  if (isfinite(remaining))
    text_set(left, "  %s left", format_seconds(remaining).text);
  int n = snprintf(text, size, "%u/%u spp  %s paths/s  %s elapsed%s", now->spp_done,
                   now->spp_total, format_count(rate).text, elapsed.text, left);
  if (n > room)
    n = snprintf(text, size, "%u/%u spp  %s elapsed%s", now->spp_done, now->spp_total,
                 elapsed.text, left);
  if (n > room)
    n = snprintf(text, size, "%u/%u spp%s", now->spp_done, now->spp_total, left);
  if (n > room)
    snprintf(text, size, "%s", *left ? left + 2 : "");
}

static void draw_bar(double fraction, const char *text) {
  char line[512], bar[64];
  int columns = report_terminal_columns();
  int room = columns - 1 - (int)strlen(text) - 10;
  int width = room > 40 ? 40 : room < 0 ? 0 : room;
  int full = (int)(fraction * width);
  for (int i = 0; i < width; i++)
    bar[i] = i < full ? '=' : i == full ? '>' : ' ';
  bar[width] = 0;
  int n = width >= 8 ? text_set(line, "[%s] %3.0f %%  %s", bar, 100 * fraction, text)
                     : text_set(line, "%3.0f %%  %s", 100 * fraction, text);
  if (n >= columns && columns > 1 && columns < (int)sizeof line)
    line[columns - 1] = 0;
  report_status_line(line);
}

static bool is_power_of_two(uint32_t n) {
  return n && !(n & (n - 1));
}

void progress_show(Progress *progress, const vlProgress *now) {
  bool last = now->pass_done && now->spp_done >= now->spp_total;
  double since = now->elapsed - progress->last_shown;
  bool first = progress->last_shown < 0;
  bool due;
  if (report_is_terminal())
    due = first || since >= 0.1;
  else
    due = (now->pass_done && now->spp_done != progress->last_spp &&
           (is_power_of_two(now->spp_done) || last)) ||
          since >= 5;
  if (!due || report_is_quiet())
    return;

  double fraction, remaining, rate = now->elapsed > 0 ? (double)now->paths / now->elapsed : 0;
  estimate(progress, now, &fraction, &remaining);
  progress->last_shown = now->elapsed;
  if (now->pass_done)
    progress->last_spp = now->spp_done;
  if (report_is_json()) {
    Json *json = report_json_begin("progress");
    json_put(json, "spp %u, spp_total %u, fraction %g, elapsed %g", now->spp_done,
             now->spp_total, fraction, now->elapsed);
    json_put(json, "remaining %g, paths %lld, rays %lld", remaining, (long long)now->paths,
             (long long)now->rays);
    report_json_end(json);
    return;
  }
  enum { PERCENT = 8 };
  char text[160];
  int room = report_is_terminal() ? report_terminal_columns() - PERCENT : (int)sizeof text;
  describe(now, remaining, rate, room, text, sizeof text);
  if (report_is_terminal())
    draw_bar(fraction, text);
  else
    report_note("%3.0f %%  %s", 100 * fraction, text);
}

/* ---- several images ---------------------------------------------------------------------- */

FrameProgress progress_frames(uint32_t count) {
  return (FrameProgress){.start = monotonic_seconds(), .count = count};
}

void progress_show_frames(FrameProgress *progress, uint32_t number, double part) {
  const double now = monotonic_seconds(), elapsed = now - progress->start,
               done = progress->done + part;
  if (report_is_quiet() || now - progress->last_shown < (report_is_terminal() ? 0.1 : 5.0))
    return;
  progress->last_shown = now;
  const double remaining = done > 0 ? elapsed / done * (progress->count - done) : INFINITY;
  if (report_is_json()) {
    Json *json = report_json_begin("progress");
    json_put(json, "frame %u, frames_done %u, frames %u, elapsed %g, remaining %g", number,
             progress->done, progress->count, elapsed, remaining);
    report_json_end(json);
    return;
  }
  char text[200];
  const bool narrow = report_is_terminal() && report_terminal_columns() < 60;
  int n = text_set(text, "frame %u: %u/%u", number, progress->done, progress->count);
  if (!narrow)
    n += snprintf(text + n, sizeof text - (size_t)n, " frames  %s elapsed",
                  format_seconds(elapsed).text);
  if (isfinite(remaining))
    snprintf(text + n, sizeof text - (size_t)n, "  %s left", format_seconds(remaining).text);
  if (report_is_terminal())
    draw_bar(done / progress->count, text);
  else if (progress->done)
    report_note("%3.0f %%  %s", 100 * done / progress->count, text);
}
