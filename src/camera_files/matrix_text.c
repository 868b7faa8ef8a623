/* camera_files/matrix_text.c: a matrix alone in a text file, by rows: 3 x 3 numbers are the
 * intrinsics fx skew cx, 0 fy cy, 0 0 1 (3DMatch, Stray Scanner's camera_matrix.csv,
 * numpy.savetxt), and so are 4 x 4 with zeros in the last column (ScanNet's
 * intrinsic_color.txt). Other 4 x 4 are a pose, world from camera (ScanNet's and 7-Scenes' pose
 * files), whose intrinsics are in a file beside it; 3 x 4 are a projection P = K [R | t]
 * (Middlebury's multi-view stereo, DTU, Strecha). Axes: x right, y down, z forward; the first
 * pixel's centre is (0, 0). There is no image size. */
#include <math.h>
#include <stdio.h>

#include "base/file.h"
#include "base/text.h"
#include "camera_files/lines.h"
#include "math/double3.h"

enum { MAX_NUMBERS = 16 };
static const char separators[] = " \t,;[]";

/* The numbers of a text; rows and columns are 0 if it is no matrix. */
typedef struct {
  double m[MAX_NUMBERS];
  uint32_t rows, columns;
} Matrix;

/* Parses numbers, which may be separated by blanks, commas and brackets, and nothing else. */
static Matrix parse(const char *text, size_t size) {
  vlCameraLines lines = {.at = text, .end = text + size};
  const Matrix none = {.rows = 0};
  Matrix matrix = none;
  uint32_t count = 0;
  while (vl_camera_next_line(&lines)) {
    uint32_t first = count;
    for (const char *at = lines.text; *(at += strspn(at, separators));) {
      char *end;
      double value = vl_camera_parse(at, &end);
      if (end == at || !isfinite(value) || count == MAX_NUMBERS || !strchr(separators, *end))
        return none;
      matrix.m[count++] = value;
      at = end;
    }
    if (count == first)
      continue;
    if (matrix.rows++ && count - first != matrix.columns)
      return none;
    matrix.columns = count - first;
  }
  if (matrix.rows == 1 && (count == 9 || count == 16))
    matrix.rows = matrix.columns = count == 9 ? 3 : 4;
  bool known = matrix.columns == 3 ? matrix.rows == 3 : matrix.columns == 4 && matrix.rows >= 3;
  return known && matrix.rows <= 4 ? matrix : none;
}

/* Whether the matrix holds intrinsics; k: fx skew cx, 0 fy cy, 0 0 1. */
static bool intrinsics_of(const Matrix *matrix, double k[9]) {
  uint32_t n = matrix->columns;
  const double *m = matrix->m;
  if (matrix->rows != n || n == 0)
    return false;
  for (uint32_t i = 0; i < 9; i++)
    k[i] = m[n * (i / 3) + i % 3];
  for (uint32_t i = 0; n == 4 && i < 4; i++)
    if (m[4 * i + 3] != (i == 3 ? 1.0 : 0.0) || m[12 + i] != (i == 3 ? 1.0 : 0.0))
      return false;
  return k[3] == 0.0 && k[6] == 0.0 && k[7] == 0.0 && k[8] == 1.0 && k[0] > 1.0 && k[4] > 1.0;
}

/* P = K [R | t]: K is upper triangular with a positive diagonal, found from the rows of P by
 * Gram and Schmidt from the last row on. False: P is no projection of a camera. */
static bool decompose(const double p[12], double k[9], double r[9], double t[3]) {
  double a[3][3];
  for (int i = 0; i < 9; i++)
    a[i / 3][i % 3] = p[4 * (i / 3) + i % 3];
  for (int i = 0; i < 9; i++)
    k[i] = 0.0;
  /* P is defined up to its scale; R must be a rotation */
  double sign = vl_triple3(a[0], a[1], a[2]) < 0.0 ? -1.0 : 1.0;
  for (int i = 2; i >= 0; i--) {
    double rest[3];
    for (int c = 0; c < 3; c++)
      rest[c] = sign * a[i][c];
    for (int j = 2; j > i; j--) {
      k[3 * i + j] = vl_dot3(rest, r + 3 * j);
      for (int c = 0; c < 3; c++)
        rest[c] -= k[3 * i + j] * r[3 * j + c];
    }
    k[4 * i] = vl_norm3(rest);
    if (!(k[4 * i] > 0.0))
      return false;
    for (int c = 0; c < 3; c++)
      r[3 * i + c] = rest[c] / k[4 * i];
  }
  for (int i = 2; i >= 0; i--) {
    t[i] = sign * p[4 * i + 3];
    for (int j = 2; j > i; j--)
      t[i] -= k[3 * i + j] * t[j];
    t[i] /= k[4 * i];
  }
  double scale = k[8];
  for (int i = 0; i < 9; i++)
    k[i] /= scale;
  return isfinite(k[0]) && isfinite(t[0]);
}

/* Reads the intrinsics from the first of the files where datasets have them, seen from the
 * pose's folder. */
static bool find_intrinsics(const vlCameraFile *file, double k[9]) {
  static const char *const names[] = {"../intrinsic/intrinsic_color.txt",
                                      "../intrinsic_color.txt",
                                      "intrinsic_color.txt",
                                      "../camera-intrinsics.txt",
                                      "camera-intrinsics.txt",
                                      "../intrinsics.txt",
                                      "intrinsics.txt",
                                      "../intrinsic.txt",
                                      "intrinsic.txt",
                                      "../camera_matrix.csv",
                                      "../K.txt",
                                      "K.txt",
                                      "../cam_K.txt",
                                      "cam_K.txt"};
  for (size_t i = 0; i < VL_LENGTH(names); i++) {
    char path[4096], *text;
    size_t size;
    if (!vl_path_join(file->path, names[i], path, sizeof path))
      continue;
    if (vl_file_read_given(file->context, path, false, &text, &size, NULL) != VL_OK)
      continue;
    Matrix matrix = parse(text, size);
    vl_free(file->context, text);
    if (intrinsics_of(&matrix, k))
      return true;
  }
  return false;
}

/* The size of an image beside the file: pose/17.txt has color/17.jpg, frame-000017.pose.txt
 * frame-000017.color.png. */
static vlResult find_size(const vlCameraFile *file, vlCameraRecord *record) {
  static const char *const formats[] = {"../color/%.*s",  "../rgb/%.*s", "../images/%.*s",
                                        "../image/%.*s",  "%.*s.color",  "%.*s",
                                        "../color/0%.0s", "color/0%.0s", "../color/000000%.0s"};
  enum { COUNT = VL_LENGTH(formats) };
  char images[COUNT][300];
  const char *list[COUNT + 1], *name = vl_file_name(file->path);
  size_t length = strcspn(name, ".");
  for (int i = 0; i < COUNT; i++) {
    bool plain = strstr(formats[i], "%.0s") != NULL;
    if (plain)
      snprintf(images[i], sizeof images[i], "%.*s", (int)strcspn(formats[i], "%"), formats[i]);
    else
      snprintf(images[i], sizeof images[i], "%.*s%.*s%s", (int)strcspn(formats[i], "%"),
               formats[i], (int)(length < 200 ? length : 200), name,
               strstr(formats[i], "%.*s") + 4);
    list[i] = images[i];
  }
  list[COUNT] = NULL;
  return vl_camera_size_beside(file, list, record);
}

/* Reports where the text differs from a matrix. */
static vlResult no_matrix(const vlCameraFile *file, const char *text, size_t size) {
  vlCameraLines lines = {.at = text, .end = text + size};
  uint32_t columns = 0;
  while (vl_camera_next_line(&lines)) {
    uint32_t count = 0;
    for (const char *at = lines.text; *(at += strspn(at, separators)); count++) {
      char *end;
      double value = vl_camera_parse(at, &end);
      if (end == at || end != at + strcspn(at, separators) || !isfinite(value))
        return vl_camera_wrong_line(file, &lines, at, "no finite number: \"%s\"",
                                    vl_short_text(at).text);
      at = end;
    }
    if (columns && count != columns)
      return vl_camera_wrong_line(file, &lines, lines.text,
                                  "the row has %u numbers, the one before it %u", count,
                                  columns);
    columns = count;
  }
  return vl_camera_wrong_at(file, 1, 1,
                            "matrix: the file is no matrix of 3 x 3, 3 x 4 or 4 x 4 numbers");
}

static vlResult read_matrix(const vlCameraFile *file, const char *text, size_t size,
                            vlCameraRecord *record) {
  Matrix matrix = parse(text, size);
  vlCameraDef *d = &record->camera;
  double k[9], r[9], t[3];
  if (matrix.rows == 0)
    return no_matrix(file, text, size);
  if (intrinsics_of(&matrix, k)) {
    vl_camera_set_intrinsics(d, k, true);
    vl_camera_set_origin(d);
    return find_size(file, record);
  }
  if (matrix.columns == 3)
    return vl_camera_wrong_at(
        file, 1, 1,
        "matrix: 3 x 3 numbers must be fx skew cx, 0 fy cy, 0 0 1, with fx and fy in pixels");
  if (matrix.rows == 3) {
    if (!decompose(matrix.m, k, r, t) || !(k[0] > 1.0 && k[4] > 1.0))
      return vl_camera_wrong_at(
          file, 1, 1,
          "matrix: 3 x 4 numbers must be a projection K [R | t], with fx and fy in pixels");
    vl_camera_set_intrinsics(d, k, true);
    vl_camera_set_pose(d, r, t);
    return find_size(file, record);
  }
  if (!vl_is_affine(matrix.m))
    return vl_camera_wrong_at(file, 1, 1,
                              "matrix: the last row of 4 x 4 numbers must be 0 0 0 1");
  if (!find_intrinsics(file, k))
    return vl_camera_wrong(file,
                           "matrix: a pose without intrinsics: beside it there is none of "
                           "intrinsic/intrinsic_color.txt, "
                           "camera-intrinsics.txt, intrinsics.txt, K.txt");
  vl_camera_set_intrinsics(d, k, true);
  vl_camera_set_matrix(d, matrix.m, false);
  return find_size(file, record);
}

/* Also a text that is meant as a matrix: at most four lines of words that are numbers for the
 * most part. */
static bool is_matrix(const char *text, size_t size) {
  vlCameraLines lines = {.at = text, .end = text + size};
  uint32_t rows = 0, words = 0, numbers = 0;
  if (size < 4096 && memchr(text, 0, size))
    return false;
  if (parse(text, size).rows != 0)
    return true;
  while (vl_camera_next_line(&lines)) {
    uint32_t before = words;
    if (++rows > 4)
      return false;
    for (const char *at = lines.text; *(at += strspn(at, separators)); words++) {
      char *end;
      vl_camera_parse(at, &end);
      size_t length = strcspn(at, separators);
      numbers += end == at + length;
      at += length;
    }
    if (words - before > 4)
      return false; /* a list of poses */
  }
  return rows >= 2 && words >= 6 && words <= MAX_NUMBERS && numbers + 2 >= words;
}

static vlResult write_matrix(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  const double i[9] = {c->fx, c->skew, c->cx - 0.5, 0.0, c->fy, c->cy - 0.5, 0.0, 0.0, 1.0},
               *m = c->camera_from_world;
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++) {
      double sum = 0.0;
      for (int j = 0; j < 3; j++)
        sum += i[3 * row + j] * m[4 * j + column];
      vl_camera_put(text, "%.17g%s", sum, column < 3 ? " " : "\n");
    }
  return VL_OK;
}

const vlCameraFormat vl_format_matrix = {.name = "matrix",
                                         .is_text = is_matrix,
                                         .read_text = read_matrix,
                                         .holds = VL_HOLDS_POSE | VL_HOLDS_SKEW,
                                         .lenses = {VL_LENSES_PINHOLE},
                                         .write = write_matrix};
