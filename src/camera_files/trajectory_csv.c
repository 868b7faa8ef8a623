/* camera_files/trajectory_csv.c: poses in lines of text. With a header that names the columns:
 * CSV (separated by comma, semicolon, tab or blanks). Without one: TUM's lists (8 numbers:
 * seconds, position, quaternion x y z w) and KITTI's (12 numbers: three rows of a matrix).
 * EuRoC's ground truth has its header in a comment, with units: "#timestamp [ns], p_RS_R_x [m],
 * ...". All are world from camera, x right, y down, z forward, unless a comment before the
 * header says "axes: opengl" or "pose: camera_from_world". */
#include <math.h>
#include <stdlib.h>

#include "base/context.h"
#include "base/text.h"
#include "camera_files/fields.h"
#include "camera_files/lines.h"
#include "camera_files/trajectory.h"
#include "math/double3.h"

enum { MAX_COLUMNS = 64 };

enum Column {
  NAME,
  NUMBER, /* not used: frames are numbered in the order of the file */
  TIME,
  TX,
  TY,
  TZ,
  QX,
  QY,
  QZ,
  QW,
  EYE_X,
  EYE_Y,
  EYE_Z,
  LOOKAT_X,
  LOOKAT_Y,
  LOOKAT_Z,
  UP_X,
  UP_Y,
  UP_Z,
  ROLL,
  M00,
  M23 = M00 + 11,
  COLUMNS,
  IGNORED /* velocities and biases of EuRoC's ground truth */
};

static const char *const names[COLUMNS] = {
    "name", "number", "time",  "tx",    "ty",    "tz",       "qx",       "qy",
    "qz",   "qw",     "eye_x", "eye_y", "eye_z", "lookat_x", "lookat_y", "lookat_z",
    "up_x", "up_y",   "up_z",  "roll",  "m00",   "m01",      "m02",      "m03",
    "m10",  "m11",    "m12",   "m13",   "m20",   "m21",      "m22",      "m23"};
static const struct {
  const char *alias;
  int column;
} aliases[] = {{"image", NAME},   {"file", NAME},   {"filename", NAME},  {"frame", NUMBER},
               {"index", NUMBER}, {"id", NUMBER},   {"timestamp", TIME}, {"t", TIME},
               {"x", TX},         {"y", TY},        {"z", TZ},           {"p_rs_r_x", TX},
               {"p_rs_r_y", TY},  {"p_rs_r_z", TZ}, {"q_rs_w", QW},      {"q_rs_x", QX},
               {"q_rs_y", QY},    {"q_rs_z", QZ}};

typedef struct Csv {
  vlTrajectory *trajectory;
  const vlCameraFile *file;
  char separator; /* 0: columns are separated by blanks */
  uint32_t line;
  int columns, of[MAX_COLUMNS]; /* the Column of each field */
  bool has[COLUMNS], header;
  bool opengl, from_world;
  bool euroc;       /* the header is EuRoC's: its other columns are ignored */
  double time_unit; /* seconds */
} Csv;

static vlResult wrong(const Csv *csv, const char *format, ...) VL_PRINTF(2, 3);
static vlResult wrong(const Csv *csv, const char *format, ...) {
  char message[400];
  VL_FORMAT(message, format);
  return vl_camera_wrong_at(csv->file, csv->line, 1, "%s", message);
}

/* Splits a line in place; removes surrounding blanks and quotes. Returns the number of fields;
 * MAX_COLUMNS + 1: too many. */
static int split(char *line, char separator, char *fields[MAX_COLUMNS]) {
  int count = 0;
  for (char *at = line; at;) {
    if (!separator)
      at += strspn(at, " \t");
    if (!separator && !*at)
      break;
    char *field = at + strspn(at, " \t");
    bool quoted = *field == '"';
    char *end = quoted ? strchr(field + 1, '"') : NULL;
    if (end) {
      field++;
      *end = 0;
      at = end + 1;
      at += strcspn(at, separator ? (char[]){separator, 0} : " \t");
    } else {
      at = field + strcspn(field, separator ? (char[]){separator, 0} : " \t");
    }
    bool more = *at != 0;
    *at = 0;
    at = more ? at + 1 : NULL;
    for (size_t n = strlen(field); n && (field[n - 1] == ' ' || field[n - 1] == '\t'); n--)
      field[n - 1] = 0;
    if (count == MAX_COLUMNS)
      return MAX_COLUMNS + 1;
    fields[count++] = field;
  }
  return count;
}

static bool to_number(const char *text, double *value) {
  char *end;
  *value = strtod(text, &end);
  return end != text && *end == 0;
}

/* Parses a comment such as "# axes: opengl"; false: an unknown value. */
static bool take_comment(Csv *csv, const char *comment) {
  const struct {
    const char *key, *words[2];
    bool *flag;
  } settings[] = {{"axes:", {"opencv", "opengl"}, &csv->opengl},
                  {"pose:", {"world_from_camera", "camera_from_world"}, &csv->from_world}};
  comment += strspn(comment, "# \t");
  for (int i = 0; i < 2; i++) {
    size_t n = strlen(settings[i].key);
    if (strncmp(comment, settings[i].key, n) != 0)
      continue;
    const char *word = comment + n + strspn(comment + n, " \t");
    size_t length = strcspn(word, " \t\r");
    for (int k = 0; k < 2; k++)
      if (strlen(settings[i].words[k]) == length &&
          strncmp(word, settings[i].words[k], length) == 0) {
        *settings[i].flag = k == 1;
        return true;
      }
    return false;
  }
  return true;
}

/* How many of these columns there are. */
static int count_of(const Csv *csv, int first, int last) {
  int count = 0;
  for (int i = first; i <= last; i++)
    count += csv->has[i];
  return count;
}

/* Checks that exactly one representation of the pose is given, and completely. */
static vlResult check_columns(const Csv *csv) {
  static const struct { int first, last; } ways[] = {{TX, QW}, {EYE_X, LOOKAT_Z}, {M00, M23}};
  int found = 0;
  for (int i = 0; i < 3; i++) {
    if (!count_of(csv, ways[i].first, ways[i].last))
      continue;
    for (int k = ways[i].first; k <= ways[i].last; k++)
      if (!csv->has[k])
        return wrong(csv, "the column \"%s\" is missing", names[k]);
    found++;
  }
  if (found != 1)
    return wrong(csv, "%s",
                 found ? "the columns say a pose in two ways"
                       : "the columns say no pose: tx ty tz qx qy qz qw, or eye_x eye_y "
                         "eye_z lookat_x lookat_y lookat_z, or m00 to m23");
  if (count_of(csv, UP_X, UP_Z) % 3 != 0)
    return wrong(csv, "\"up\" has not all of its columns");
  if (count_of(csv, UP_X, ROLL) > 0 && !csv->has[EYE_X])
    return wrong(csv, "\"up\" and \"roll\" go with eye and lookat only");
  return VL_OK;
}

static vlResult read_header(Csv *csv, char *fields[], int count) {
  csv->header = true;
  csv->columns = count;
  for (int i = 0; i < count; i++) {
    int column = 0;
    for (char *c = fields[i]; *c; c++)
      if (*c >= 'A' && *c <= 'Z')
        *c = (char)(*c + 'a' - 'A');
    while (column < COLUMNS && !vl_text_is(names[column], fields[i]))
      column++;
    for (size_t k = 0; k < VL_LENGTH(aliases); k++)
      if (vl_text_is(aliases[k].alias, fields[i]))
        column = aliases[k].column;
    const bool lens = vl_has_word("fx fy cx cy", fields[i]); /* Stray Scanner's */
    if (lens && column == COLUMNS)
      vl_log(csv->file->context, VL_LOG_WARNING, NULL,
             "%s: the column \"%s\" is ignored: the file has poses only", csv->file->path,
             fields[i]);
    if (column == COLUMNS && (csv->euroc || lens)) {
      csv->of[i] = IGNORED;
      continue;
    }
    if (column == COLUMNS) {
      const char *near = vl_nearest_name(fields[i], names, COLUMNS);
      return wrong(csv, "unknown column \"%s\"%s%s%s", vl_short_text(fields[i]).text,
                   near ? "; did you mean \"" : "", near ? near : "", near ? "\"?" : "");
    }
    if (csv->has[column])
      return wrong(csv, "the column \"%s\" stands twice", names[column]);
    csv->has[column] = true;
    csv->of[i] = column;
  }
  return check_columns(csv);
}

/* EuRoC's header: "timestamp [ns], p_RS_R_x [m], ..., q_RS_w [], ...": the body's (IMU's) pose
 * in the reference frame, times in nanoseconds. */
static vlResult read_euroc_header(Csv *csv, char *line) {
  char *fields[MAX_COLUMNS];
  csv->euroc = true;
  csv->separator = ',';
  csv->time_unit = 1e-9;
  int count = split(line, csv->separator, fields);
  if (count > MAX_COLUMNS)
    return wrong(csv, "more than 64 columns");
  for (int i = 0; i < count; i++)
    fields[i][strcspn(fields[i], " [")] = 0; /* the unit */
  return read_header(csv, fields, count);
}

/* Sets the columns of a file without header from the count of numbers per line. 16 numbers are
 * a matrix with its last row (Replica). */
static bool headless(Csv *csv, int count) {
  static const int tum[8] = {TIME, TX, TY, TZ, QX, QY, QZ, QW};
  if (count != 8 && count != 12 && count != 16)
    return false;
  csv->header = true;
  csv->columns = count;
  for (int i = 0; i < count; i++) {
    csv->of[i] = count == 8 ? tum[i] : i < 12 ? M00 + i : IGNORED;
    if (csv->of[i] == IGNORED)
      continue;
    csv->has[csv->of[i]] = true;
  }
  return true;
}

static vlResult pose_of(const Csv *csv, const vlFrameLocation *location,
                        const double v[COLUMNS], double m[16]) {
  vlCameraDef def = vl_default_camera_def(1, 1);
  vlCamera camera = {.width = 1};
  vlError error;
  if (csv->has[EYE_X]) {
    memcpy(def.eye, v + EYE_X, sizeof def.eye);
    memcpy(def.lookat, v + LOOKAT_X, sizeof def.lookat);
    if (csv->has[UP_X])
      memcpy(def.up, v + UP_X, sizeof def.up);
    if (csv->has[ROLL])
      def.roll = v[ROLL] * M_PI / 180.0;
    if (vl_camera_make(&def, &camera, NULL, &error) != VL_OK) {
      const char *text =
          strncmp(error.message, "camera: ", 8) == 0 ? error.message + 8 : error.message;
      return vl_frame_wrong(csv->file, location, "%s", text);
    }
    memcpy(m, camera.world_from_camera, sizeof camera.world_from_camera);
    return VL_OK;
  }
  double r[9], t[3];
  if (csv->has[QX]) {
    const double q[4] = {v[QW], v[QX], v[QY], v[QZ]};
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(fabs(length - 1.0) < 0.01) || !vl_rotation_from_quaternion(q, r))
      return vl_frame_wrong(csv->file, location,
                            "the quaternion's length is %g; a rotation's is 1", length);
    memcpy(t, v + TX, sizeof t);
  } else {
    vl_split_map(v + M00, r, t);
  }
  if (csv->from_world)
    vl_camera_set_pose(&def, r, t);
  else
    vl_camera_set_rigid(&def, r, t);
  double axes = csv->opengl ? -1.0 : 1.0; /* y up, z back: negates the camera's y and z axes */
  vl_camera_flip_columns(def.world_from_camera, 1.0, axes, axes, m);
  return VL_OK;
}

static vlResult read_line(Csv *csv, char *line) {
  char *fields[MAX_COLUMNS];
  if (!csv->header)
    csv->separator = strchr(line, ',')    ? ','
                     : strchr(line, ';')  ? ';'
                     : strchr(line, '\t') ? '\t'
                                          : 0;
  int count = split(line, csv->separator, fields);
  if (count > MAX_COLUMNS)
    return wrong(csv, "more than 64 columns");
  double v[COLUMNS] = {0}, m[16], unused;
  if (!csv->header) {
    bool numbers = true;
    for (int i = 0; i < count; i++)
      numbers = numbers && to_number(fields[i], &unused);
    if (!numbers)
      return read_header(csv, fields, count);
    if (!headless(csv, count))
      return wrong(
          csv,
          "numbers without a header: lists of TUM have 8 in a line (seconds, tx ty tz, "
          "qx qy qz qw), those of "
          "KITTI 12 (three rows of a matrix), those of Replica 16 (four rows)");
  }
  vlFrameLocation location = {NULL, csv->line, (uint32_t)csv->trajectory->frames.count, NULL};
  if (count != csv->columns)
    return vl_frame_wrong(csv->file, &location, "the line has %d fields; the header has %d",
                          count, csv->columns);
  for (int i = 0; i < count; i++) {
    int column = csv->of[i];
    if (column == NAME)
      location.name = fields[i];
    else if (column != NUMBER && column != IGNORED &&
             (!to_number(fields[i], &v[column]) || !isfinite(v[column])))
      return vl_frame_wrong(csv->file, &location,
                            "\"%s\" is \"%s\"; it must be a finite number", names[column],
                            vl_short_text(fields[i]).text);
  }
  VL_TRY(pose_of(csv, &location, v, m));
  return vl_trajectory_add(csv->trajectory, csv->file, &location, VL_NO_CAMERA, m,
                           csv->has[TIME] ? v[TIME] * csv->time_unit : VL_UNSET);
}

vlResult vl_trajectory_read_csv(vlTrajectory *t, const vlCameraFile *file, char *text,
                                size_t size) {
  Csv csv = {.trajectory = t, .file = file, .time_unit = 1.0};
  vlRawLines lines = {.at = text, .end = text + size};
  for (char *line; (line = vl_camera_raw_line(&lines));) {
    csv.line = lines.number;
    const char *first = line + strspn(line, " \t");
    if (*first == '#' && strstr(first, "p_RS_R_x")) {
      VL_TRY(read_euroc_header(&csv, line + (first - line) + 1));
    } else if (*first == '#') {
      if (!take_comment(&csv, first))
        return wrong(
            &csv,
            "\"%s\": axes are opencv or opengl, poses world_from_camera or camera_from_world",
            vl_short_text(first).text);
    } else if (*first) {
      VL_TRY(read_line(&csv, line));
    }
  }
  return VL_OK;
}
