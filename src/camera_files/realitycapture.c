/* camera_files/realitycapture.c: RealityCapture's (RealityScan's) XMP beside each image, and
 * its CSV "Internal/External camera parameters". Camera axes of the XMP: x right, y down, z
 * forward; xcr:Rotation is camera from world by rows, xcr:Position the camera's centre. With s
 * the larger side of the image: f = s * 35 mm focal length / 36, cx = w/2 + s * U, cy = h/2 + s
 * * V; the first pixel's centre is (0.5, 0.5). The distortion is Brown's, with t1 and t2 as
 * OpenCV's p1 and p2. The CSV: x, y, alt is the centre; with heading h, pitch p, roll r the
 * camera's axes (x right, y up, z back) are the columns of Rz(-h) Rx(p) Ry(r). */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "camera_files/fields.h"
#include "math/elementary.h"
#include "velo/distortion.h"

/* The numbers that both forms have. */
typedef struct {
  double f35, center[2];
  double k[6]; /* k1 k2 k3 k4 t1 t2 */
} Lens;

static void set_lens(const Lens *lens, vlCameraDef *d) {
  const double *k = lens->k, side = d->width > d->height ? d->width : d->height;
  d->fx = d->fy = side * lens->f35 / 36.0;
  d->cx = 0.5 * d->width + side * lens->center[0];
  d->cy = 0.5 * d->height + side * lens->center[1];
  if (vl_camera_all_zero(k, 6))
    return;
  if (k[3] == 0.0) {
    vl_camera_set_opencv(d, (double[]){k[0], k[1], k[4], k[5], k[2]}, 5);
    return;
  }
  const double thin[8] = {k[0], k[1], k[4], k[5], k[2], k[3]};
  d->distortion = VL_DISTORTION_THIN_PRISM;
  d->distortion_count = 8;
  memcpy(d->distortion_coefficients, thin, sizeof thin);
}

/* ---- XMP --------------------------------------------------------------------------------- */

static const json_t *description_of(const json_t *tree) {
  if (!vl_camera_has_tag(tree, "x:xmpmeta"))
    return NULL;
  return vl_camera_child(vl_camera_child(tree, "rdf:RDF"), "rdf:Description");
}

/* The text of a property, which is an attribute or an element. */
static const char *property(const json_t *description, const char *name) {
  const char *text = vl_camera_text(description, name);
  return text ? text : vl_camera_text(vl_camera_child(description, name), "$");
}

static vlResult read_property(const vlCameraFile *file, const json_t *description,
                              const char *name, uint32_t count, bool needed, double *values) {
  const char *text = property(description, name);
  if (!text && !needed)
    return VL_OK;
  if (!text)
    return vl_camera_wrong_element(file, description, "there is no %s", name);
  if (vl_camera_parse_all(text, values, count) == count)
    return VL_OK;
  return vl_camera_wrong_element(file, description, "%s must hold %u finite number%s", name,
                                 count, count == 1 ? "" : "s");
}

static vlResult read_xmp(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  const json_t *description = description_of(tree);
  double r[9], c[3], aspect = 1.0, skew = 0.0;
  Lens lens = {.f35 = 0.0};
  const char *model = property(description, "xcr:DistortionModel");
  if (model && !vl_has_word("perspective brown3 brown4 brown3t2 brown4t2", model))
    return vl_camera_wrong_element(
        file, description,
        "xcr:DistortionModel \"%s\" is no model of velo; there are perspective, brown3, "
        "brown4, brown3t2, brown4t2",
        vl_short_text(model).text);
  const struct {
    const char *name;
    uint32_t count;
    bool needed;
    double *values;
  } properties[] = {{"xcr:FocalLength35mm", 1, true, &lens.f35},
                    {"xcr:PrincipalPointU", 1, false, &lens.center[0]},
                    {"xcr:PrincipalPointV", 1, false, &lens.center[1]},
                    {"xcr:AspectRatio", 1, false, &aspect},
                    {"xcr:Skew", 1, false, &skew},
                    {"xcr:DistortionCoeficients", 6, false, lens.k},
                    {"xcr:Rotation", 9, true, r},
                    {"xcr:Position", 3, true, c}};
  for (size_t i = 0; i < VL_LENGTH(properties); i++)
    VL_TRY(read_property(file, description, properties[i].name, properties[i].count,
                         properties[i].needed, properties[i].values));
  if (aspect != 1.0 || skew != 0.0)
    return vl_camera_wrong_element(file, description,
                                   "xcr:AspectRatio must be 1 and xcr:Skew 0");
  if (vl_text_is(model, "perspective"))
    memset(lens.k, 0, sizeof lens.k);
  vl_camera_set_centre(&record->camera, r, c);
  VL_TRY(vl_camera_size_of_image(file, record));
  set_lens(&lens, &record->camera);
  return VL_OK;
}

static bool is_xmp(const json_t *tree) {
  const json_t *description = description_of(tree);
  return description && (property(description, "xcr:Rotation") ||
                         property(description, "xcr:FocalLength35mm"));
}

static vlResult write_xmp(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  const double *k = fit->k;
  const double side = c->width > c->height ? c->width : c->height;
  const double plane[3] = {36.0 * c->fx / side, (c->cx - 0.5 * c->width) / side,
                           (c->cy - 0.5 * c->height) / side};
  const double brown[6] = {k[0], k[1], k[4], 0.0, k[2], k[3]};
  return VL_PUT_FORM(
      text, fit,
      "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n"
      "  <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n"
      "    <rdf:Description xcr:Version=\"3\" xcr:PosePrior=\"initial\" "
      "xcr:Coordinates=\"absolute\"\n"
      "       xcr:DistortionModel=\"$model\" xcr:FocalLength35mm=\"$plane@0\" "
      "xcr:Skew=\"0\" xcr:AspectRatio=\"1\"\n"
      "       xcr:PrincipalPointU=\"$plane@1\" xcr:PrincipalPointV=\"$plane@2\"\n"
      "       xmlns:xcr=\"http://www.capturingreality.com/ns/xcr/1.1#\">\n"
      "      <xcr:Rotation>$R:s</xcr:Rotation>\n"
      "      <xcr:Position>$centre:s</xcr:Position>\n"
      "      <xcr:DistortionCoeficients>$brown:s</xcr:DistortionCoeficients>\n"
      "    </rdf:Description>\n"
      "  </rdf:RDF>\n"
      "</x:xmpmeta>\n",
      VL_WORD("model", c->distortion.steps == 0     ? "perspective"
                       : k[2] == 0.0 && k[3] == 0.0 ? "brown3"
                                                    : "brown3t2"),
      VL_VALUES("plane", plane, 3), VL_VALUES("brown", brown, 6));
}

/* ---- CSV --------------------------------------------------------------------------------- */

enum {
  NAME,
  X,
  Y,
  ALT,
  HEADING,
  PITCH,
  ROLL,
  F,
  PX,
  PY,
  K1,
  T2 = K1 + 5,
  COLUMNS,
  MAX_FIELDS = 64
};
/* columns, in a list as vlCameraFormat.known has it */
static const char known_columns[] =
    "#name x y alt heading pitch roll f px py k1 k2 k3 k4 t1 t2";
static const char *const columns[COLUMNS] = {"#name", "x",  "y",  "alt", "heading", "pitch",
                                             "roll",  "f",  "px", "py",  "k1",      "k2",
                                             "k3",    "k4", "t1", "t2"};

/* The lines of the text, with those that begin with #, unlike vl_camera_next_line. */
typedef struct {
  const char *at, *end;
  uint32_t number;
  char text[4096];
  const char *fields[MAX_FIELDS];
  int count;
} Row;

static bool next_row(Row *row) {
  while (row->at < row->end) {
    const char *stop = memchr(row->at, '\n', (size_t)(row->end - row->at)),
               *last = stop ? stop : row->end;
    size_t length = (size_t)(last - row->at);
    if (length > sizeof row->text - 1)
      length = sizeof row->text - 1;
    memcpy(row->text, row->at, length);
    row->text[length] = 0;
    row->text[strcspn(row->text, "\r")] = 0;
    row->at = stop ? stop + 1 : row->end;
    row->number++;
    if (!row->text[0] || strncmp(row->text, "#cameras", 8) == 0)
      continue;
    row->count = 0;
    for (char *field = row->text; field && row->count < MAX_FIELDS;) {
      char *comma = strchr(field, ',');
      if (comma)
        *comma = 0;
      row->fields[row->count++] = field;
      field = comma ? comma + 1 : NULL;
    }
    return true;
  }
  return false;
}

static vlResult read_row(const vlCameraFile *file, const Row *row, const int of[COLUMNS],
                         vlCameraRecord *record) {
  double v[COLUMNS] = {0.0};
  const char *last = row->fields[row->count - 1], *end_of_row = last + strlen(last);
  for (int k = X; k < COLUMNS; k++) {
    if (of[k] < 0)
      continue;
    const char *field = of[k] < row->count ? row->fields[of[k]] : end_of_row;
    char *end;
    v[k] = vl_camera_parse(field, &end);
    if (end == field || end[strspn(end, " ")] || !isfinite(v[k]))
      return vl_camera_wrong_at(file, row->number, 1 + (uint32_t)(field - row->text),
                                "realitycapture: \"%s\" is \"%s\"; it must be a finite number",
                                columns[k], vl_short_text(field).text);
  }
  Lens lens = {.f35 = v[F], .center = {v[PX], v[PY]}};
  memcpy(lens.k, v + K1, sizeof lens.k);
  double sine[3], cosine[3];
  for (int i = 0; i < 3; i++) {
    double angle = (i ? v[HEADING + i] : -v[HEADING]) * VL_DEGREE;
    sine[i] = vl_precise_sin(angle);
    cosine[i] = vl_precise_cos(angle);
  }
  const double sh = sine[0], ch = cosine[0], sp = sine[1], cp = cosine[1], sr = sine[2],
               cr = cosine[2];
  const double r[9] = {ch * cr - sh * sp * sr,
                       -sh * cp,
                       ch * sr + sh * sp * cr,
                       sh * cr + ch * sp * sr,
                       ch * cp,
                       sh * sr - ch * sp * cr,
                       -cp * sr,
                       sp,
                       cp * cr};
  vl_camera_set_rigid(&record->camera, r, v + X);
  vl_camera_set_flipped(&record->camera, record->camera.world_from_camera);
  char folder[300];
  const char *name = record->name;
  snprintf(folder, sizeof folder, "images/%s", name);
  VL_TRY(vl_camera_size_beside(file, (const char *const[]){name, folder, NULL}, record));
  set_lens(&lens, &record->camera);
  return VL_OK;
}

/* The fields of a row point into its own text. */
static void copy_row(Row *to, const Row *row) {
  *to = *row;
  for (int i = 0; i < row->count; i++)
    to->fields[i] = to->text + (row->fields[i] - row->text);
}

/* Counts the columns of the header that velo does not know, with the values of a row. */
static vlResult check_columns(const vlCameraFile *file, const Row *header, const Row *row,
                              vlCameraRecord *record) {
  for (int i = 0; i < header->count; i++) {
    const vlCameraName name = {header->fields[i], i < row->count ? row->fields[i] : "",
                               header->number};
    VL_TRY(vl_camera_check_name(file, known_columns, &name, record));
  }
  return VL_OK;
}

static vlResult read_csv(const vlCameraFile *file, const char *text, size_t size,
                         vlCameraRecord *record) {
  Row row = {.at = text, .end = text + size}, header, chosen = {.count = 0};
  int of[COLUMNS];
  if (!next_row(&row))
    return vl_camera_wrong(file, "realitycapture: the file has no header");
  copy_row(&header, &row);
  for (int k = 0; k < COLUMNS; k++) {
    of[k] = -1;
    for (int i = 0; i < row.count; i++)
      if (vl_text_is(row.fields[i], columns[k]))
        of[k] = i;
    if (k <= F && of[k] < 0)
      return vl_camera_wrong_at(file, row.number, 1,
                                "realitycapture: the column \"%s\" is missing", columns[k]);
  }
  record->frames = 0;
  while (next_row(&row)) {
    const char *name = of[NAME] < row.count ? row.fields[of[NAME]] : "";
    if (!vl_camera_count(file, chosen.count, name, record))
      continue;
    vl_camera_name(record, name);
    copy_row(&chosen, &row);
  }
  if (!chosen.count)
    return vl_camera_no_frame(file, "camera", record);
  VL_TRY(check_columns(file, &header, &chosen, record));
  return read_row(file, &chosen, of, record);
}

static bool is_csv(const char *text, VL_UNUSED size_t size) {
  return strncmp(text, "#name,", 6) == 0 ||
         (strncmp(text, "#cameras", 8) == 0 && strstr(text, "\n#name,"));
}

const vlCameraFormat vl_format_realitycapture = {
    .name = "realitycapture",
    .rotates = true,
    .known =
        "x:* xmlns:* rdf:* xcr:Version xcr:PosePrior xcr:Coordinates xcr:DistortionModel "
        "xcr:DistortionCoeficients xcr:FocalLength35mm xcr:Skew xcr:AspectRatio "
        "xcr:PrincipalPointU xcr:PrincipalPointV xcr:CalibrationPrior xcr:CalibrationGroup "
        "xcr:DistortionGroup xcr:InTexturing xcr:InColoring xcr:InMeshing xcr:Rotation "
        "xcr:Position xcr:LatitudeLongitudeAltitude xcr:ComponentId xcr:Georef* "
        "xcr:ComponentTransform",
    .is_tree = is_xmp,
    .is_text = is_csv,
    .read = read_xmp,
    .read_text = read_csv,
    .holds = VL_HOLDS_POSE,
    .lenses = {VL_LENSES_OPENCV, 0, 5},
    .square = true,
    .write = write_xmp};
