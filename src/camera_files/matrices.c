/* camera_files/matrices.c: the projection and view matrix of OpenGL, Vulkan and Direct3D, as
 * JSON or YAML. The file states the conventions in which the three differ: `order` of the 16
 * numbers; `vectors` that the matrix acts on; clip_y (direction of the image's top); clip_z
 * (values of the near and far plane). Written for a view space x right, y up, z back. Read for
 * any view space, since the matrix itself determines the view direction. */
#include <math.h>

#include "base/text.h"
#include "camera_files/fields.h"
#include "math/transform.h"

typedef struct {
  const char *name;
  vlCameraDialect dialect;
  bool down;       /* clip space's y points down */
  double z_near;   /* clip z of the near plane; that of the far plane is 1 */
  bool rows_first; /* as written: row-major */
  bool row_vectors;
} Api;

static const Api apis[] = {{"opengl", VL_CAMERA_DIALECT_OPENGL, false, -1.0, false, false},
                           {"vulkan", VL_CAMERA_DIALECT_VULKAN, true, 0.0, false, false},
                           {"d3d", VL_CAMERA_DIALECT_D3D, false, 0.0, true, true}};
enum { API_COUNT = VL_LENGTH(apis) };

/* ---- reading ----------------------------------------------------------------------------- */

/* A string that must be one of two words. */
static vlResult choice(const vlCameraFile *file, const json_t *tree, const char *key,
                       const char *yes, const char *no, bool *value) {
  const char *word;
  VL_TRY(vl_camera_word(file, tree, key, &word));
  *value = vl_text_is(word, yes);
  if (*value || vl_text_is(word, no))
    return VL_OK;
  return vl_camera_wrong(file, "%s: \"%s\" must be \"%s\" or \"%s\"", file->dialect, key, yes,
                         no);
}

/* Reads 16 numbers from a list, lists, or a string; converts to row-major, acting on column
 * vectors. */
static vlResult read_matrix(const vlCameraFile *file, const json_t *tree, const char *key,
                            bool transposed, vlMat4 *matrix) {
  double m[16];
  const char *text = vl_camera_text(tree, key);
  uint32_t count = 0;
  if (text) {
    for (char *end; count < 17; text = end, count++) {
      double value = vl_camera_parse(text, &end);
      if (end == text)
        break;
      if (count < 16)
        m[count] = value;
    }
    if (count != 16 || text[strspn(text, " \t\r\n,;")] != 0)
      return vl_camera_wrong(file, "%s: \"%s\" must hold 16 numbers", file->dialect, key);
  } else {
    VL_TRY(vl_camera_list(file, tree, key, m, 16));
  }
  for (int i = 0; i < 16; i++) {
    matrix->m[i] = m[transposed ? 4 * (i % 4) + i / 4 : i];
    if (!isfinite(matrix->m[i]))
      return vl_camera_wrong(file, "%s: \"%s\" is not finite", file->dialect, key);
  }
  return VL_OK;
}

/* z at which clip.z / clip.w = value, where clip.z = a z + b and clip.w = z, or 1. */
static double plane_at(bool flat, double a, double b, double value) {
  if (flat)
    return (value - b) / a;
  return value == a ? INFINITY : b / (value - a);
}

static vlResult planes(const vlCameraFile *file, bool flat, double a, double b, double z_near,
                       vlCameraDef *d) {
  double near_plane = plane_at(flat, a, b, z_near), far_plane = plane_at(flat, a, b, 1.0);
  if (near_plane > far_plane) { /* reversed z */
    double other = near_plane;
    near_plane = far_plane;
    far_plane = other;
  }
  /* the far plane is infinite, inexactly represented in single precision */
  if (!flat && far_plane < 0.0)
    far_plane = INFINITY;
  if (!(near_plane >= 0.0 && far_plane > near_plane))
    return vl_camera_wrong(
        file, "%s: \"projection_matrix\" has its near plane at %g and its far plane at %g",
        file->dialect, near_plane, far_plane);
  d->near_plane = near_plane;
  d->far_plane = far_plane;
  return VL_OK;
}

static vlResult decompose(const vlCameraFile *file, const vlMat4 *projection, vlMat4 view,
                          bool down, double z_near, vlCameraDef *d) {
  double p[16], w = d->width, h = d->height;
  memcpy(p, projection->m, sizeof p);
  bool flat = p[14] == 0.0;
  double scale = flat ? p[15] : p[14];
  if (p[12] != 0.0 || p[13] != 0.0 || (flat ? p[15] : p[14]) == 0.0 || (!flat && p[15] != 0.0))
    return vl_camera_wrong(file,
                           "%s: the last row of \"projection_matrix\" is %g %g %g %g; it must "
                           "be 0 0 1 0, 0 0 -1 0 or "
                           "0 0 0 1: are order and vectors right?",
                           file->dialect, p[12], p[13], p[14], p[15]);
  for (int i = 0; i < 16; i++)
    p[i] /= fabs(scale);
  double forward = flat ? 1.0 : scale > 0.0 ? 1.0 : -1.0;
  if (flat && scale < 0.0)
    return vl_camera_wrong(file, "%s: \"projection_matrix\" mirrors w", file->dialect);
  /* orthographic: forward is the direction in which clip.z increases; with reversed z it
   * decreases */
  if (flat)
    forward = p[10] < 0.0 ? -1.0 : 1.0;
  if (p[4] != 0.0 || p[8] != 0.0 || p[9] != 0.0 || (!flat && (p[3] != 0.0 || p[7] != 0.0)))
    return vl_camera_wrong(file, "%s: \"projection_matrix\" is not of the form of a camera's",
                           file->dialect);
  if (p[0] == 0.0 || p[5] == 0.0 || (flat && p[10] == 0.0))
    return vl_camera_wrong(file, "%s: \"projection_matrix\" is singular", file->dialect);
  double flip = down ? 1.0 : -1.0, x = p[0] < 0.0 ? -1.0 : 1.0,
         y = flip * p[5] < 0.0 ? -1.0 : 1.0;
  d->projection = flat ? VL_PROJECTION_ORTHOGRAPHIC : VL_PROJECTION_PERSPECTIVE;
  d->fx = 0.5 * w * fabs(p[0]);
  d->fy = 0.5 * h * fabs(p[5]);
  d->skew = 0.5 * w * p[1] * y;
  d->cx = 0.5 * w * (1.0 + (flat ? p[3] : p[2] * forward));
  d->cy = 0.5 * h * (1.0 + flip * (flat ? p[7] : p[6] * forward));
  if (flat && (p[2] != 0.0 || p[6] != 0.0))
    return vl_camera_wrong(file, "%s: an oblique \"projection_matrix\" is not taken",
                           file->dialect);
  VL_TRY(planes(file, flat, p[10] * forward, p[11], z_near, d));
  vlMat4 inverse;
  if (!vl_is_affine(view.m) || !vl_mat4_inverse(view, &inverse))
    return vl_camera_wrong(file, "%s: \"view_matrix\" is no pose: are order and vectors right?",
                           file->dialect);
  d->has_matrix = true;
  vl_camera_flip_columns(inverse.m, x, y, forward, d->world_from_camera);
  d->world_from_camera[15] = 1.0;
  return VL_OK;
}

static vlResult read_matrices(const vlCameraFile *file, const json_t *tree,
                              vlCameraRecord *record) {
  static const char *const names[] = {"opengl", "vulkan", "d3d"};
  vlCameraDef *d = &record->camera;
  const char *word;
  VL_TRY(vl_camera_word(file, tree, "graphics_api", &word));
  const Api *api = VL_CAMERA_ROW(apis, word);
  if (!api) {
    char known[300];
    vl_tell_names(known, sizeof known, word ? word : "", names, API_COUNT);
    return vl_camera_wrong(file, "unknown graphics_api \"%s\"%s", vl_short_text(word).text,
                           known);
  }
  vlCameraFile own = *file;
  own.dialect = api->name;
  record->dialect = api->dialect;
  bool rows_first = false, row_vectors = false, down = api->down,
       zero_to_one = api->z_near == 0.0;
  double z[2];
  vlMat4 projection, view;
  VL_TRY(vl_camera_side(&own, tree, "width", &d->width));
  VL_TRY(vl_camera_side(&own, tree, "height", &d->height));
  VL_TRY(choice(&own, tree, "order", "row-major", "column-major", &rows_first));
  VL_TRY(choice(&own, tree, "vectors", "row", "column", &row_vectors));
  if (json_object_get(tree, "clip_y"))
    VL_TRY(choice(&own, tree, "clip_y", "down", "up", &down));
  if (json_object_get(tree, "clip_z")) {
    VL_TRY(vl_camera_list(&own, tree, "clip_z", z, 2));
    zero_to_one = z[0] == 0.0;
    if (!(z[1] == 1.0 && (z[0] == 0.0 || z[0] == -1.0)))
      return vl_camera_wrong(&own, "%s: \"clip_z\" must be [0, 1] or [-1, 1]", own.dialect);
  }
  bool transposed = rows_first == row_vectors;
  VL_TRY(read_matrix(&own, tree, "projection_matrix", transposed, &projection));
  VL_TRY(read_matrix(&own, tree, "view_matrix", transposed, &view));
  VL_TRY(decompose(&own, &projection, view, down, zero_to_one ? 0.0 : -1.0, d));
  /* these fields give the camera's planes: a matrix must have planes even if the camera has
   * none */
  VL_TRY(vl_camera_optional(&own, tree, "near_plane", &d->near_plane));
  if (json_is_null(json_object_get(tree, "far_plane")))
    d->far_plane = INFINITY;
  else
    VL_TRY(vl_camera_optional(&own, tree, "far_plane", &d->far_plane));
  vl_camera_name(record, vl_camera_text(tree, "name"));
  return VL_OK;
}

/* ---- writing ----------------------------------------------------------------------------- */

/* Projection matrix from view space (x right, y up, z back) to clip space, for column
 * vectors. */
static vlMat4 projection_of(const vlCamera *c, const Api *api) {
  bool flat = c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  double w = c->width, h = c->height, up = api->down ? 1.0 : -1.0;
  double x = 2.0 * c->cx / w - 1.0, y = up * (2.0 * c->cy / h - 1.0);
  double f = c->far_plane, n = c->near_plane, a, b;
  if (!(n > 0.0) && !flat)
    n = fmin(0.01, 1e-3 * f);
  if (flat && isinf(f))
    f = n + 1e4;
  double lo = api->z_near;
  /* clip.z = a z + b, z = -Z of view space: n maps to lo w, f to w */
  if (flat) {
    a = (1.0 - lo) / (f - n);
    b = lo - a * n;
  } else if (isinf(f)) {
    a = 1.0;
    b = (lo - 1.0) * n;
  } else {
    a = (f - lo * n) / (f - n);
    b = (lo - a) * n;
  }
  return (vlMat4){{2.0 * c->fx / w, -2.0 * c->skew / w, flat ? 0.0 : -x, flat ? x : 0.0, /* x */
                   0.0, -up * 2.0 * c->fy / h, flat ? 0.0 : -y, flat ? y : 0.0,          /* y */
                   0.0, 0.0, -a, b,                                                      /* z */
                   0.0, 0.0, flat ? 0.0 : -1.0, flat ? 1.0 : 0.0}};
}

static void put_matrix(vlCameraText *text, const char *name, const vlMat4 *m, bool transposed) {
  vl_camera_put(text, "  \"%s\": [", name);
  for (int i = 0; i < 16; i++)
    vl_camera_put(text, "%s%.17g",
                  i == 0  ? "\n    "
                  : i % 4 ? ", "
                          : ",\n    ",
                  m->m[transposed ? 4 * (i % 4) + i / 4 : i] + 0.0);
  vl_camera_put(text, "\n  ]");
}

static vlResult write_matrices(const vlFittedCamera *fit, vlCameraText *text) {
  const Api *api = VL_CAMERA_ROW(apis, fit->file->dialect);
  const vlCamera *c = &fit->camera;
  vlMat4 projection = projection_of(c, api), view = vl_mat4_load(c->camera_from_world);
  for (int i = 4; i < 12; i++)
    view.m[i] = 0.0 - view.m[i];
  bool transposed = api->rows_first == api->row_vectors;
  VL_PUT_FORM(text, fit,
              "{\n"
              "  \"graphics_api\": \"$api\",\n"
              "$named  \"width\": $width,\n"
              "  \"height\": $height,\n"
              "  \"pixel_origin\": \"corner\",\n"
              "  \"view_axes\": \"x right, y up, z back\",\n"
              "  \"order\": \"$order\",\n"
              "  \"vectors\": \"$vectors\",\n"
              "  \"clip_y\": \"$clip\",\n"
              "  \"clip_z\": [$lowest, 1],\n"
              "  \"near_plane\": $near,\n"
              "  \"far_plane\": $end,\n",
              VL_WORD("api", api->name),
              VL_PART("named", fit->record->name[0], "  \"name\": $name,\n"),
              VL_WORD("order", api->rows_first ? "row-major" : "column-major"),
              VL_WORD("vectors", api->row_vectors ? "row" : "column"),
              VL_WORD("clip", api->down ? "down" : "up"), VL_VALUES("lowest", &api->z_near, 1),
              {.key = "end", .part = isinf(c->far_plane) ? "null" : "$far"});
  put_matrix(text, "projection_matrix", &projection, transposed);
  vl_camera_put(text, ",\n");
  put_matrix(text, "view_matrix", &view, transposed);
  vl_camera_put(text, "\n}\n");
  return VL_OK;
}

/* A file with an unknown API is passed to OpenGL's reader, whose error lists the known APIs. */
static bool is_opengl(const json_t *tree) {
  const char *api = vl_camera_text(tree, "graphics_api");
  return api && !vl_text_is(api, "vulkan") && !vl_text_is(api, "d3d");
}
static bool is_vulkan(const json_t *tree) {
  return vl_text_is(vl_camera_text(tree, "graphics_api"), "vulkan");
}
static bool is_d3d(const json_t *tree) {
  return vl_text_is(vl_camera_text(tree, "graphics_api"), "d3d");
}

static const char known_names[] =
    "graphics_api pixel_origin view_axes projection_matrix view_matrix order vectors clip_y clip_z near_plane "
    "far_plane width height name";
#define MATRICES(api, is_api)                                                                 \
  {                                                                                           \
    .name = api, .known = known_names, .is_tree = is_api, .read = read_matrices,              \
    .holds = VL_HOLDS_POSE | VL_HOLDS_SCALE | VL_HOLDS_SKEW | VL_HOLDS_PLANES, .plain = true, \
    .write = write_matrices                                                                   \
  }
const vlCameraFormat vl_format_opengl = MATRICES("opengl", is_opengl);
const vlCameraFormat vl_format_vulkan = MATRICES("vulkan", is_vulkan);
const vlCameraFormat vl_format_d3d = MATRICES("d3d", is_d3d);
