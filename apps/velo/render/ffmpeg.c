/* render/ffmpeg.c: see ffmpeg.h. A .gif has one palette for all frames, so it takes two runs:
 * the first reads the frames and finds the palette, the second reads them again. */
#include "render/ffmpeg.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/child.h"

enum { PATH_SIZE = 4096 };

/* One run of ffmpeg. */
typedef struct Run {
  const VideoSource *source;
  char *wrong;
  size_t size;
  Child child;
  bool runs; /* the child is there */
  uint32_t width, height;
} Run;

static bool fail(Run *run, const char *path, const char *what) {
  snprintf(run->wrong, run->size, "%s%s%s", path, *path ? ": " : "", what);
  return false;
}

/* ---- the process ------------------------------------------------------------------------- */

/* Waits for the end of ffmpeg. fed: it got all frames. */
static bool finish(Run *run, bool fed) {
  char line[300], ended[100];
  const bool wrong = run->wrong[0] != 0; /* a frame is */
  const int status =
      child_finish(&run->child, !fed && wrong, CHILD_FIRST_LINE, line, sizeof line);
  run->runs = false;
  if (wrong || signals_pending())
    return false;
  if (fed && WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return true;
  child_end_text(status, ended, sizeof ended);
  if (WIFEXITED(status) && !fed)
    strcat(ended, " before it had all frames");
  const char *end = line[0] == '[' ? strstr(line, "] ") : NULL; /* "[mp4 @ 0x5581] " */
  return fail(run, "ffmpeg", end ? end + 2 : line[0] ? line : ended);
}

/* ---- its input --------------------------------------------------------------------------- */

static char *read_file(const char *path, size_t *size) {
  FILE *file = fopen(path, "rb");
  struct stat info;
  char *data = NULL;
  if (file && fstat(fileno(file), &info) == 0 && S_ISREG(info.st_mode)) {
    *size = (size_t)info.st_size;
    data = malloc(*size + 1);
    if (data && fread(data, 1, *size, file) != *size) {
      free(data);
      data = NULL;
      errno = EIO;
    }
  }
  if (file)
    fclose(file);
  return data;
}

static uint32_t big_endian(const char *at) {
  uint32_t value = 0;
  for (int i = 0; i < 4; i++)
    value = value << 8 | (unsigned char)at[i];
  return value;
}

/* The size of a .png is in its first chunk. All frames must have the first one's. */
static bool check_size(Run *run, const char *path, const char *data, size_t size) {
  enum { WIDTH = 16, HEIGHT = 20, HEADER = 24 };
  if (size < HEADER || memcmp(data + 1, "PNG", 3) != 0)
    return fail(run, path, "is no .png file");
  const uint32_t width = big_endian(data + WIDTH), height = big_endian(data + HEIGHT);
  if (!run->width) {
    run->width = width;
    run->height = height;
  }
  if (width == run->width && height == run->height)
    return true;
  char text[120];
  text_set(text, "has %u x %u pixels, the first frame %u x %u", width, height, run->width,
           run->height);
  return fail(run, path, text);
}

static bool feed_frame(Run *run, uint32_t i) {
  char path[PATH_SIZE];
  size_t size = 0;
  if (!run->source->frame(run->source->user, i, path, sizeof path))
    return fail(run, "", "a frame's name is too long");
  errno = 0;
  char *data = read_file(path, &size);
  if (!data)
    return fail(run, path, errno ? strerror(errno) : "is no file");
  const bool ok =
      check_size(run, path, data, size) && (!run->runs || child_write(&run->child, data, size));
  free(data);
  return ok;
}

static bool feed(Run *run) {
  const uint32_t count = run->source->count;
  for (uint32_t i = 0; i < count; i++) {
    char text[200];
    text_set(text, "%.120s: frame %u of %u", run->source->name, i + 1, count);
    if (report_is_terminal() && !report_is_quiet())
      report_status_line(text);
    if (!feed_frame(run, i))
      return false;
  }
  return true;
}

static bool run_ffmpeg(Run *run, const char *const *words, int output, int further) {
  const int code = child_start(&run->child, run->source->program, words, output, further);
  if (code != 0)
    return fail(run, "", strerror(code));
  run->runs = true;
  const bool done = finish(run, feed(run));
  report_status_line(NULL);
  return done;
}

/* ---- the videos -------------------------------------------------------------------------- */

/* What all runs begin with: errors alone, the first one ends it; .png files from the pipe. */
#define BEGIN(fps)                                                                   \
  "ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error", "-xerror", "-y", "-f", \
      "image2pipe", "-framerate", fps, "-c:v", "png", "-i", "pipe:0"

/* H.264 with 4:2:0 needs even sizes: the last row and column are repeated. The colours are
 * sRGB, and the file says so. */
static bool make_mp4(Run *run, const char *fps, const char *to) {
  char filter[200];
  const uint32_t right = run->width % 2, below = run->height % 2;
  text_set(filter,
           "format=gbrp,pad=iw+%u:ih+%u,fillborders=right=%u:bottom=%u:mode=smear,"
           "scale=out_color_matrix=bt709:out_range=limited:flags=accurate_rnd+full_chroma_int,"
           "format=yuv420p",
           right, below, right, below);
  const char *const words[] = {BEGIN(fps),
                               "-vf",
                               filter,
                               "-c:v",
                               "libx264",
                               "-preset",
                               "medium",
                               "-crf",
                               "18",
                               "-colorspace",
                               "bt709",
                               "-color_primaries",
                               "bt709",
                               "-color_trc",
                               "iec61966-2-1",
                               "-color_range",
                               "tv",
                               "-movflags",
                               "+faststart",
                               "-f",
                               "mp4",
                               to,
                               NULL};
  return run_ffmpeg(run, words, -1, -1);
}

static bool make_gif(Run *run, const char *fps, const char *to) {
  FILE *palette = tmpfile();
  if (!palette)
    return fail(run, "", strerror(errno));
  const char *const first[] = {BEGIN(fps), "-vf",        "palettegen=stats_mode=full",
                               "-f",       "image2pipe", "-c:v",
                               "png",      "pipe:1",     NULL};
  const char *const second[] = {BEGIN(fps),
                                "-f",
                                "png_pipe",
                                "-i",
                                "pipe:3",
                                "-lavfi",
                                "paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle",
                                "-loop",
                                "0",
                                "-f",
                                "gif",
                                to,
                                NULL};
  bool done = run_ffmpeg(run, first, fileno(palette), -1);
  done = done && lseek(fileno(palette), 0, SEEK_SET) == 0;
  done = done && run_ffmpeg(run, second, -1, fileno(palette));
  fclose(palette);
  return done;
}

bool ffmpeg_make(const VideoSource *source, VideoKind kind, const char *to, uint32_t *width,
                 uint32_t *height, char *wrong, size_t size) {
  char fps[40], output[PATH_SIZE + 100];
  Run run = {.source = source, .wrong = wrong, .size = size};
  wrong[0] = 0;
  text_set(fps, "%.10g", source->fps);
  text_set(output, "file:%s", to);
  if (!feed_frame(&run, 0)) /* no process runs yet: it sets the size */
    return false;
  bool done = kind == VIDEO_MP4 ? make_mp4(&run, fps, output) : make_gif(&run, fps, output);
  struct stat info;
  if (done && (stat(to, &info) != 0 || info.st_size == 0))
    done = fail(&run, "ffmpeg", "it wrote nothing");
  *width = run.width;
  *height = run.height;
  return done;
}
