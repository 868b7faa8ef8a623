/* trace/rays_file.c: rays of a .csv file: a line of numbers for each ray, below a header that
 * names the columns or without one. */
#include "trace/rays_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/options.h"
#include "cli/report.h"
#include "cli/text.h"

/* `valid` is what `velo camera unproject` writes: where it is 0, so is the direction. */
enum { VALID = RAY_NUMBERS, NAMES, MAX_COLUMNS = NAMES };
static const char *const names[NAMES] = {"ox", "oy",    "oz",   "dx",    "dy",
                                         "dz", "t_max", "time", "t_min", "valid"};

/* A file that is being read. */
typedef struct Reader {
  FILE *file;
  const char *path;
  char *line;
  size_t room;
  unsigned long number;             /* of the line, from 1 */
  int columns, column[MAX_COLUMNS]; /* what each column is; 0 columns: not known yet */
  RaysFile *rays;
  uint64_t space; /* rows that rays->rows has room for */
} Reader;

static int wrong(const Reader *r, const char *at, const char *what) {
  return report_failure(STATUS_SCENE, "%s:%lu:%ld: %s", r->path, r->number,
                        (long)(at - r->line) + 1, what);
}

static const char *skip(const char *text) {
  return text + strspn(text, " \t");
}

/* Whether text goes on with another column; *text moves to it. */
static bool next_column(const char **text) {
  *text = skip(*text);
  if (**text != ',')
    return false;
  *text = skip(*text + 1);
  return true;
}

static bool at_end(const char *text) {
  return text[strspn(text, " \t\r\n")] == 0;
}

/* Reads the names of the columns. */
static int read_header(Reader *r, const char *text) {
  do {
    const bool quoted = *text == '"';
    text += quoted;
    size_t length = strcspn(text, quoted ? "\"\r\n" : ", \t\r\n");
    char word[40];
    text_set(word, "%.*s", (int)(length < 39 ? length : 39), text);
    int k = 0;
    while (k < NAMES && strcmp(word, names[k]) != 0)
      k++;
    if (k == NAMES)
      return report_failure(STATUS_SCENE, "%s:%lu:%ld: unknown column \"%s\"%s", r->path,
                            r->number, (long)(text - r->line) + 1, word,
                            did_you_mean("", word, names, NAMES));
    for (int i = 0; i < r->columns; i++)
      if (r->column[i] == k)
        return wrong(r, text, "this column is there twice");
    r->column[r->columns++] = k;
    text += length;
    if (quoted && *text != '"')
      return wrong(r, text, "the quotation mark at the end of the name is missing");
    text += quoted;
  } while (next_column(&text));
  if (!at_end(text))
    return wrong(r, skip(text), "column names are separated by commas");
  for (int k = 0; k < RAY_T_MAX; k++) {
    bool there = false;
    for (int i = 0; i < r->columns; i++)
      there = there || r->column[i] == k;
    if (!there)
      return report_failure(STATUS_SCENE, "%s:%lu:1: the column %s is missing; rays need %s",
                            r->path, r->number, names[k], "ox,oy,oz,dx,dy,dz");
  }
  return -1;
}

/* The columns of a file without a header: as many as the first line has numbers. */
static int count_columns(Reader *r, const char *text) {
  int count = 1;
  for (const char *c = text; *c; c++)
    count += *c == ',';
  if (count < RAY_T_MAX || count > RAY_NUMBERS)
    return wrong(r, text,
                 "a ray has 6 to 9 numbers separated by commas: "
                 "ox,oy,oz,dx,dy,dz, then t_max, time, t_min");
  r->columns = count;
  for (int i = 0; i < count; i++)
    r->column[i] = i;
  return -1;
}

static int add_row(Reader *r, double **row) {
  RaysFile *rays = r->rays;
  if (rays->count == r->space) {
    r->space = 2 * r->space + 1024;
    void *more = realloc(rays->rows, r->space * sizeof *rays->rows);
    if (!more)
      return report_failure(STATUS_OTHER, "%s: out of memory", r->path);
    rays->rows = more;
  }
  *row = rays->rows[rays->count++];
  memset(*row, 0, sizeof *rays->rows);
  (*row)[RAY_T_MAX] = (double)INFINITY;
  return -1;
}

static int read_row(Reader *r, const char *text) {
  double *row = NULL;
  TRY(add_row(r, &row));
  for (int i = 0; i < r->columns; i++) {
    char *end;
    double value = strtod(text, &end);
    if (end == text)
      return wrong(
          r, text,
          at_end(text) || *text == ',' ? "a number is missing here" : "this is no number");
    if (r->column[i] != VALID)
      row[r->column[i]] = value;
    text = end;
    bool more = next_column(&text);
    if (more && i + 1 == r->columns)
      return wrong(r, text, "there are more numbers than columns");
    if (!more && i + 1 < r->columns)
      return wrong(r, skip(text),
                   at_end(text) ? "there are fewer numbers than columns" : "this is no number");
  }
  return at_end(text) ? -1 : wrong(r, skip(text), "this is no number");
}

/* Whether a line holds names: NaN and infinity are numbers. */
static bool is_header(const char *text) {
  char *end;
  strtod(text, &end);
  return end == text && (*text == '"' || *text == '_' || (*text >= 'a' && *text <= 'z') ||
                         (*text >= 'A' && *text <= 'Z'));
}

/* Refuses lines of files that are no text. A byte order mark, as spreadsheets write it, is
 * passed. */
static int begin_line(Reader *r, size_t length, const char **text) {
  *text = r->line;
  r->number++;
  if (r->number == 1 && strncmp(r->line, "\xef\xbb\xbf", 3) == 0)
    *text += 3;
  *text = skip(*text);
  if (r->number == 1 && strncmp(r->line, "\x93NUMPY", 6) == 0)
    return wrong(r, r->line, "this is an array of NumPy; its file's name must end in .npy");
  if (r->number == 1 && strncmp(r->line, "PK", 2) == 0)
    return wrong(r, r->line, "this is an archive; save one array of rays with numpy.save");
  return strlen(r->line) == length ? -1
                                   : wrong(r, r->line + strlen(r->line), "this is no text");
}

static int read_lines(Reader *r) {
  int status = -1;
  ssize_t length;
  while (status < 0 && (length = getline(&r->line, &r->room, r->file)) >= 0) {
    const char *text;
    status = begin_line(r, (size_t)length, &text);
    if (status >= 0)
      break;
    if (at_end(text) || *text == '#')
      continue;
    if (!r->columns && is_header(text)) {
      status = read_header(r, text);
      continue;
    }
    if (!r->columns)
      status = count_columns(r, text);
    if (status < 0)
      status = read_row(r, text);
  }
  if (status < 0 && ferror(r->file))
    return report_failure(STATUS_IO, "%s: %s", r->path, strerror(errno));
  return status;
}

int rays_file_read(const char *path, RaysFile *rays) {
  *rays = (RaysFile){0};
  if (text_ends_with(path, ".npy"))
    return rays_npy_read(path, rays);
  bool from_stdin = strcmp(path, "-") == 0;
  Reader r = {.path = from_stdin ? "stdin" : path, .rays = rays};
  r.file = from_stdin ? stdin : fopen(path, "r");
  if (!r.file)
    return report_failure(errno == ENOENT ? STATUS_MISSING : STATUS_IO, "%s: %s", path,
                          strerror(errno));
  int status = read_lines(&r);
  if (!from_stdin)
    fclose(r.file);
  free(r.line);
  return status;
}

void rays_file_free(RaysFile *rays) {
  free(rays->rows);
  *rays = (RaysFile){0};
}
