/* render/ffmpeg.c: see ffmpeg.h. A .gif has one palette for all frames, so it takes two runs:
 * the first reads the frames and finds the palette, the second reads them again. */
#include "render/ffmpeg.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/report.h"
#include "cli/signals.h"

extern char **environ;

enum { PATH_SIZE = 4096, WAIT = 50 /* milliseconds between two looks for a signal */ };

/* One run of ffmpeg. */
typedef struct Run {
  const VideoSource *source;
  char *wrong;
  size_t size;
  pid_t child;
  int input;      /* the pipe to its standard input; -1: closed */
  FILE *messages; /* its standard error; null: not kept */
  uint32_t width, height;
} Run;

bool ffmpeg_find(const char *folders, char *program, size_t size) {
  while (folders && *folders) {
    const size_t n = strcspn(folders, ":");
    struct stat info;
    if (folders[0] == '/' &&
        snprintf(program, size, "%.*s/ffmpeg", (int)n, folders) < (int)size &&
        access(program, X_OK) == 0 && stat(program, &info) == 0 && S_ISREG(info.st_mode))
      return true;
    folders += n + (folders[n] == ':');
  }
  return false;
}

static bool fail(Run *run, const char *path, const char *what) {
  snprintf(run->wrong, run->size, "%s%s%s", path, *path ? ": " : "", what);
  return false;
}

/* ---- the process ------------------------------------------------------------------------- */

/* Makes `from` descriptor `to` of the child; negative: /dev/null. */
static void give(posix_spawn_file_actions_t *actions, int from, int to) {
  if (from >= 0)
    posix_spawn_file_actions_adddup2(actions, from, to);
  else
    posix_spawn_file_actions_addopen(actions, to, "/dev/null", O_RDWR, 0);
}

/* Starts ffmpeg in a process group of its own, so that a Ctrl-C at the terminal reaches velo
 * alone. output, further: its descriptors 1 and 3; -1: none. */
static bool start(Run *run, char *const *words, int output, int further) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  sigset_t none, reset;
  int ends[2];
  if (pipe(ends) != 0)
    return fail(run, "", strerror(errno));
  fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  fcntl(ends[1], F_SETFD, FD_CLOEXEC);
  fcntl(ends[1], F_SETFL, O_NONBLOCK);
  run->messages = tmpfile();
  sigemptyset(&none);
  sigemptyset(&reset);
  sigaddset(&reset, SIGPIPE);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  posix_spawnattr_setsigdefault(&attributes, &reset);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawn_file_actions_init(&actions);
  give(&actions, ends[0], STDIN_FILENO);
  give(&actions, output, STDOUT_FILENO);
  give(&actions, run->messages ? fileno(run->messages) : -1, STDERR_FILENO);
  if (further >= 0)
    give(&actions, further, 3);
  const int code =
      posix_spawn(&run->child, run->source->program, &actions, &attributes, words, environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close(ends[0]);
  run->input = ends[1];
  if (code == 0)
    return true;
  close(ends[1]);
  if (run->messages)
    fclose(run->messages);
  return fail(run, "", strerror(code));
}

/* The first line that ffmpeg has written, without the "[mp4 @ 0x5581]" before it. */
static void read_message(const Run *run, char *line, size_t size) {
  line[0] = 0;
  if (!run->messages)
    return;
  rewind(run->messages);
  while (fgets(line, (int)size, run->messages) && line[0] == '\n')
    continue;
  line[strcspn(line, "\n")] = 0;
  const char *end = line[0] == '[' ? strstr(line, "] ") : NULL;
  if (end)
    memmove(line, end + 2, strlen(end + 2) + 1);
}

/* Waits for the end of ffmpeg. fed: it got all frames. */
static bool finish(Run *run, bool fed) {
  int status = 0;
  const struct timespec pause = {.tv_nsec = WAIT * 1000000L};
  close(run->input); /* the end of its input */
  run->input = -1;
  if (!fed && run->wrong[0])
    kill(run->child, SIGKILL); /* a frame is wrong */
  for (;;) {
    if (signals_pending())
      kill(run->child, SIGKILL);
    const pid_t ended = waitpid(run->child, &status, WNOHANG);
    if (ended == run->child || (ended < 0 && errno != EINTR))
      break;
    nanosleep(&pause, NULL);
  }
  char line[300];
  read_message(run, line, sizeof line);
  if (run->messages)
    fclose(run->messages);
  if (run->wrong[0] || signals_pending())
    return false;
  if (fed && WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return true;
  char ended[60];
  if (WIFSIGNALED(status))
    snprintf(ended, sizeof ended, "it was ended by signal %d", WTERMSIG(status));
  else
    snprintf(ended, sizeof ended, "it ended with exit code %d%s", WEXITSTATUS(status),
             fed ? "" : " before it had all frames");
  return fail(run, "ffmpeg", line[0] ? line : ended);
}

/* ---- its input --------------------------------------------------------------------------- */

/* False: ffmpeg does not read any more, or a signal came. */
static bool write_all(const Run *run, const char *data, size_t size) {
  while (size > 0) {
    struct pollfd ready = {.fd = run->input, .events = POLLOUT};
    if (signals_pending())
      return false;
    if (poll(&ready, 1, WAIT) <= 0)
      continue;
    const ssize_t n = write(run->input, data, size);
    if (n < 0 && errno != EAGAIN && errno != EINTR)
      return false;
    data += n > 0 ? n : 0;
    size -= n > 0 ? (size_t)n : 0;
  }
  return true;
}

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
  snprintf(text, sizeof text, "has %u x %u pixels, the first frame %u x %u", width, height,
           run->width, run->height);
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
      check_size(run, path, data, size) && (run->input < 0 || write_all(run, data, size));
  free(data);
  return ok;
}

static bool feed(Run *run) {
  const uint32_t count = run->source->count;
  for (uint32_t i = 0; i < count; i++) {
    char text[200];
    snprintf(text, sizeof text, "%.120s: frame %u of %u", run->source->name, i + 1, count);
    if (report_is_terminal() && !report_is_quiet())
      report_status_line(text);
    if (!feed_frame(run, i))
      return false;
  }
  return true;
}

static bool run_ffmpeg(Run *run, const char *const *words, int output, int further) {
  enum { MOST = 64 };
  char *copies[MOST];
  int count = 0;
  while (words[count] && count < MOST - 1)
    count++;
  memcpy(copies, words, (size_t)count * sizeof *copies);
  copies[count] = NULL;
  const bool done = start(run, copies, output, further) && finish(run, feed(run));
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
  snprintf(filter, sizeof filter,
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
  Run run = {.source = source, .wrong = wrong, .size = size, .input = -1};
  wrong[0] = 0;
  snprintf(fps, sizeof fps, "%.10g", source->fps);
  snprintf(output, sizeof output, "file:%s", to);
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
