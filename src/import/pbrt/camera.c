/* import/pbrt/camera.c: converts the Camera directive to a vlCameraDef. The file reads pbrt's
 * cameras, and velo's own ones (pinhole, thin lens, other projections, calibrated lenses) with
 * the parameters of the lecture (docs/lecture.md). */
#include <string.h>

#include "base/text.h"
#include "image/image.h"
#include "import/pbrt/builder.h"
#include "projection/projection.row.h"
#include "velo/distortion.h"
#include "velo/projection.h"

static const double degrees = 0.017453292519943295;

/* ---- lenses: aperture images and lens files become objects owned by the scene ------------ */

static bool fail_with(vlDict *dict, vlSource source, vlResult code, const vlError *error) {
  if (code == VL_ERROR_MEMORY)
    return vl_import_fail_memory(dict->import);
  if (error->file[0] && error->line > 0) {
    vlSource there = {error->file, error->line, error->column};
    return vl_import_fail(dict->import, code, there, "%s", error->message);
  }
  return vl_import_fail(dict->import, code == VL_ERROR_ARGUMENT ? VL_ERROR_SCENE : code, source,
                        "%s: %s%s%s", dict->what, error->file[0] ? error->file : "",
                        error->file[0] ? ": " : "", error->message);
}

/* Makes an aperture from the mean of the image's red, green and blue, as in pbrt, or from its
 * first channel. */
static vlResult aperture_from_image(vlImport *import, const vlImage *image,
                                    vlAperture **aperture, vlError *error) {
  uint32_t w = vl_image_width(image), h = vl_image_height(image);
  int c[3] = {vl_image_find_channel(image, "R"), vl_image_find_channel(image, "G"),
              vl_image_find_channel(image, "B")};
  if (c[0] < 0 || c[1] < 0 || c[2] < 0)
    c[0] = c[1] = c[2] = 0;
  float *values = vl_alloc_array(import->context, (size_t)w * h, sizeof *values);
  if (!values)
    return VL_ERROR_MEMORY;
  for (uint32_t y = 0; y < h; y++)
    for (uint32_t x = 0; x < w; x++) {
      float sum = 0.0f;
      for (int k = 0; k < 3; k++)
        sum += vl_image_get(image, x, y, (uint32_t)c[k]);
      values[(size_t)y * w + x] = sum / 3.0f;
    }
  vlResult result = vl_aperture_create(import->context, w, h, values, aperture, error);
  vl_free(import->context, values);
  return result;
}

/* The aperture: a built-in name or an image file. "circle" and "circular" mean none. */
static bool read_aperture(vlDict *dict, const vlAperture **aperture) {
  static const char *const names[] = {"gaussian", "square", "pentagon", "star"};
  vlImport *import = dict->import;
  const char *name = "circle";
  vlParam *p = vl_dict_find(dict, "aperture", VL_BIT_STRING);
  if (!vl_dict_string(dict, "aperture", &name) || vl_text_is(name, "circle") ||
      vl_text_is(name, "circular") || name[0] == 0)
    return vl_import_fine(import);
  vlAperture **slot = VL_IMPORT_PUSH(import, &import->scene->apertures);
  if (!slot)
    return false;
  vlError error = {0};
  vlResult result = VL_OK;
  if (VL_IS_AMONG(name, names)) {
    result = vl_aperture_create_named(import->context, name, slot, &error);
  } else {
    char path[4096];
    vlImage *image = NULL;
    if (!vl_import_path(import, p, path, sizeof path))
      return false;
    result = vl_image_read_named(import->context, NULL, path, &image, &error);
    if (result == VL_OK)
      result = aperture_from_image(import, image, slot, &error);
    vl_image_destroy(image);
  }
  if (result != VL_OK)
    return fail_with(dict, p->source, result, &error);
  *aperture = *slot;
  return true;
}

/* Reads the lens parameters that the rows of cameras do not describe: the pixel in focus and
 * the shape of the aperture. */
static bool read_lens(vlDict *dict, vlCameraDef *def) {
  vl_dict_floats(dict, "focuspixel", 2, def->lens.focus_pixel);
  return read_aperture(dict, &def->lens.aperture);
}

/* Reads the parameters of pbrt's realistic camera: lens file, aperture, focus. film_diagonal is
 * in mm. All defaults are pbrt's. */
static bool read_optics(vlDict *dict, vlCameraDef *def, double film_diagonal) {
  vlImport *import = dict->import;
  vlOpticsDef optics = vl_default_optics_def();
  const char *file = NULL;
  char path[4096];
  optics.aperture_diameter = 1.0;
  optics.film_diagonal = film_diagonal;
  vl_dict_double(dict, "aperturediameter", &optics.aperture_diameter);
  vl_dict_double(dict, "focusdistance", &optics.focus_distance);
  vlParam *p = vl_dict_find(dict, "lensfile", VL_BIT_STRING);
  vl_dict_string(dict, "lensfile", &file);
  if (!vl_import_fine(import))
    return false;
  if (!p)
    return vl_dict_fail(dict, "\"string lensfile\" is missing");
  if (!vl_import_path(import, p, path, sizeof path) || !read_aperture(dict, &optics.aperture))
    return false;
  vlOptics **slot = VL_IMPORT_PUSH(import, &import->scene->optics);
  if (!slot)
    return false;
  vlError error = {0};
  vlResult result = vl_optics_load(import->context, path, &optics, slot, &error);
  if (result != VL_OK)
    return fail_with(dict, p->source, result, &error);
  def->projection = VL_PROJECTION_OPTICS;
  def->lens.optics = *slot;
  return true;
}

/* ---- cameras ----------------------------------------------------------------------------- */

/* Camera space of velo has y down, that of pbrt y up; in both, x points right and z forward.
 * World coordinates are not changed. Since pbrt's world is left-handed and velo's is
 * right-handed, pbrt's cameras mirror the image in velo. */
static bool pose_from(vlImport *import, const vlMat4 *ctm, double pose[16]) {
  vlMat4 m;
  if (!vl_mat4_inverse(*ctm, &m))
    return vl_import_wrong(import, import->camera.source,
                           "Camera: the current transform is singular");
  for (int row = 0; row < 3; row++) {
    for (int column = 0; column < 4; column++)
      pose[4 * row + column] = m.m[4 * row + column] * (column == 1 ? -1.0 : 1.0);
  }
  bool affine = ctm->m[12] == 0.0 && ctm->m[13] == 0.0 && ctm->m[14] == 0.0;
  for (int column = 0; column < 4; column++) {
    double v = m.m[12 + column] * (column == 1 ? -1.0 : 1.0);
    pose[12 + column] = affine ? (column == 3 ? 1.0 : 0.0) : v;
  }
  double w = affine ? m.m[15] : 1.0; /* the last element of the matrix need not be 1 */
  for (int i = 0; i < 12; i++)
    pose[i] /= w;
  return true;
}

static bool pose_from_ctm(vlImport *import, vlCameraDef *def) {
  const vlMat4 *ctm = import->camera_from_world;
  def->has_matrix = true;
  if (!pose_from(import, &ctm[0], def->world_from_camera))
    return false;
  if (memcmp(&ctm[0], &ctm[1], sizeof *ctm) == 0)
    return true;
  def->has_matrix_close = true;
  def->pose_times[0] = import->times[0];
  def->pose_times[1] = import->times[1];
  return pose_from(import, &ctm[1], def->world_from_camera_close);
}

/* A rolling shutter may expose each row for an instant. */
static bool check_shutter(vlDict *dict, vlCameraDef *def) {
  bool instant = def->shutter_close == def->shutter_open && def->readout > 0.0;
  if (instant || def->shutter_close > def->shutter_open || !vl_import_fine(dict->import))
    return vl_import_fine(dict->import);
  return vl_dict_fail(dict, "the shutter does not open: it closes at %g, opens at %g",
                      def->shutter_close, def->shutter_open);
}

/* pbrt's cameras (book 5.2). Unless the file gives the screen window, it extends from -1 to 1
 * along the shorter side of the image. */
static bool read_pbrt(vlDict *dict, vlCameraDef *def, bool flat) {
  vlImport *import = dict->import;
  double frame = (double)def->width / def->height, window[4], focus = 1e6;
  bool given = vl_dict_double(dict, "frameaspectratio", &frame);
  if (given && !(frame > 0.0))
    return vl_dict_fail(dict, "\"frameaspectratio\" must be above 0");
  double x = frame > 1.0 ? frame : 1.0, y = frame > 1.0 ? 1.0 : 1.0 / frame;
  double standard[4] = {-x, x, -y, y};
  memcpy(window, standard, sizeof window);
  given = vl_dict_floats(dict, "screenwindow", 4, window) || given;
  if (given || flat) {
    def->screen_min_x = window[0];
    def->screen_max_x = window[1];
    def->screen_min_y = window[2];
    def->screen_max_y = window[3];
  }
  if (flat)
    def->projection = VL_PROJECTION_ORTHOGRAPHIC;
  if (vl_dict_double(dict, "focaldistance", &focus) || def->lens_radius != 0.0)
    def->focus_distance = focus;
  return check_shutter(dict, def) && vl_dict_done(dict) && pose_from_ctm(import, def);
}

static void turn_axes(double pose[16], const double axes[9]) {
  for (int row = 0; row < 3; row++) {
    double old[3] = {pose[4 * row], pose[4 * row + 1], pose[4 * row + 2]};
    for (int column = 0; column < 3; column++)
      pose[4 * row + column] =
          old[0] * axes[column] + old[1] * axes[3 + column] + old[2] * axes[6 + column];
  }
}

/* pbrt's spherical camera shows the whole sphere, whatever the aspect ratio. Its
 * equirectangular image has the poles up and down; its columns start at the right and turn left
 * in pbrt's left-handed camera space. Its equal-area image has the zenith at the centre. The
 * centre of velo's maps is the forward direction, so the axes are exchanged. */
static bool read_spherical(vlDict *dict, vlCameraDef *def) {
  static const char *const mappings[] = {"equalarea", "equirectangular"};
  static const double axes[2][9] = {{1, 0, 0, 0, 0, -1, 0, 1, 0},
                                    {0, 0, -1, 0, 1, 0, -1, 0, 0}};
  int mapping = 0;
  double unused;
  vl_dict_choice(dict, "mapping", mappings, 2, &mapping);
  vl_dict_double(dict, "lensradius", &unused); /* read and ignored, as in pbrt */
  vl_dict_double(dict, "focaldistance", &unused);
  vl_dict_double(dict, "frameaspectratio", &unused);
  double window[4];
  vl_dict_floats(dict, "screenwindow", 4, window);
  def->projection = mapping ? VL_PROJECTION_EQUIRECTANGULAR : VL_PROJECTION_EQUAL_AREA;
  if (!check_shutter(dict, def) || !vl_dict_done(dict) || !pose_from_ctm(dict->import, def))
    return false;
  turn_axes(def->world_from_camera, axes[mapping]);
  if (def->has_matrix_close)
    turn_axes(def->world_from_camera_close, axes[mapping]);
  return true;
}

/* Reads velo's own parameters of the shutter curve: a name, or points (time, value, time,
 * value, ...). */
static bool read_curve(vlDict *dict, vlCameraDef *def) {
  int curve = 0;
  double rise = 0.1;
  vl_dict_choice(dict, "shuttercurve", vl_camera_shutter_curves, 3, &curve);
  bool risen = vl_dict_double(dict, "shutterrise", &rise);
  vlParam *points = vl_dict_find(dict, "shutterpoints", VL_BIT_FLOAT);
  if (!vl_import_fine(dict->import))
    return false;
  if (risen && (curve != 2 || !(rise > 0.0 && rise <= 0.5)))
    return vl_dict_fail(dict,
                        "\"shutterrise\" is the share, above 0 and at most 0.5, in "
                        "which a trapezoid rises and falls");
  if (points) {
    size_t n = vl_param_count(points);
    if (curve || n % 2 || n < 4 || n > 2 * VL_SHUTTER_POINTS)
      return vl_dict_fail_at(dict, points->source,
                             "\"shutterpoints\" are 2 to %d pairs (share of the time, how "
                             "far open), instead of \"shuttercurve\"",
                             (int)VL_SHUTTER_POINTS);
    def->shutter_points = (uint32_t)(n / 2);
    for (size_t i = 0; i < n; i++)
      (i % 2 ? def->shutter_value : def->shutter_at)[i / 2] = vl_param_number(points, i);
  } else if (curve) {
    const double at[4] = {0.0, curve == 1 ? 0.5 : rise, curve == 1 ? 1.0 : 1.0 - rise, 1.0};
    const double value[4] = {0.0, 1.0, curve == 1 ? 0.0 : 1.0, 0.0};
    def->shutter_points = curve == 1 ? 3 : 4;
    memcpy(def->shutter_at, at, sizeof at);
    memcpy(def->shutter_value, value, sizeof value);
  }
  return true;
}

/* Reads a list of coefficients of any length up to 14; vl_camera_make checks their number. */
static bool read_coefficients(vlDict *dict, const char *name, double *values, uint32_t *count) {
  vlParam *p = vl_dict_find(dict, name, VL_BIT_FLOAT);
  if (!p)
    return false;
  size_t n = vl_param_count(p);
  if (n > 14)
    return vl_dict_fail_at(dict, p->source, "\"%s\" has %zu numbers; at most 14 have a meaning",
                           name, n);
  for (size_t i = 0; i < n; i++)
    values[i] = p->exact[i];
  *count = (uint32_t)n;
  return true;
}

static bool read_colmap(vlDict *dict, vlCameraDef *def) {
  const char *model = "PINHOLE";
  double values[14];
  uint32_t count = 0;
  vlError error = {0};
  vl_dict_string(dict, "model", &model);
  read_coefficients(dict, "parameters", values, &count);
  if (!vl_import_fine(dict->import))
    return false;
  if (vl_camera_def_colmap(def, model, values, count, &error) == VL_OK)
    return true;
  vl_shorten_quoted(&error, model);
  return vl_dict_fail(dict, "%s", error.message + strlen("camera: "));
}

/* Reads the angular limits of the image in degrees; right and up are positive. */
static void read_limits(vlDict *dict, vlCameraDef *def) {
  double window[4] = {-180.0, 180.0, -90.0, 90.0};
  bool given = vl_dict_floats(dict, "longitude", 2, window);
  given = vl_dict_floats(dict, "latitude", 2, window + 2) || given;
  if (!given)
    return;
  def->screen_min_x = window[0] * degrees;
  def->screen_max_x = window[1] * degrees;
  def->screen_min_y = window[2] * degrees;
  def->screen_max_y = window[3] * degrees;
}

/* Reads the parameters of projections and calibrated lenses that their rows do not describe. */
static bool read_model(vlDict *dict, vlCameraDef *def, vlCameraKind kind) {
  int choice = 0;
  uint32_t *count = &def->distortion_count;
  bool given = kind != VL_CAMERA_COLMAP && vl_row_find(dict->row, "coefficients") &&
               read_coefficients(dict, "coefficients", def->distortion_coefficients, count);
  if (given)
    def->distortion =
        kind == VL_CAMERA_OPENCV_FISHEYE ? VL_DISTORTION_RADIAL : VL_DISTORTION_OPENCV;
  if (kind == VL_CAMERA_COLMAP)
    return read_colmap(dict, def);
  vl_dict_row_choice(dict, "mapping", &choice);
  if (kind == VL_CAMERA_FISHEYE)
    def->projection = (vlProjection)((int)VL_PROJECTION_EQUIDISTANT + choice);
  if (kind == VL_CAMERA_OPENCV_FISHEYE)
    def->projection = VL_PROJECTION_EQUIDISTANT;
  if (kind >= VL_CAMERA_OF_PROJECTION)
    def->projection = (vlProjection)((int)kind - (int)VL_CAMERA_OF_PROJECTION);
  if (vl_row_find(dict->row, "longitude"))
    read_limits(dict, def);
  if (vl_row_find(dict->row, "layout")) {
    choice = 0;
    vl_dict_row_choice(dict, "layout", &choice);
    def->shape[0] = choice;
  }
  return vl_import_fine(dict->import);
}

/* Reads the parameters common to velo's own cameras: eye, lookat, up, roll; d, zoom, s or a
 * field of view; exposure time. Their world is right-handed. */
static bool read_lecture(vlDict *dict, vlCameraDef *def, vlCameraKind kind) {
  vlImport *import = dict->import;
  if (!read_model(dict, def, kind))
    return false;
  if (kind != VL_CAMERA_PINHOLE && !read_lens(dict, def))
    return false;
  if (!check_shutter(dict, def) || !read_curve(dict, def) || !vl_dict_done(dict))
    return false;
  const vlMat4 identity = vl_mat4_identity();
  for (int i = 0; i < 16; i++)
    if (import->camera_from_world[0].m[i] != identity.m[i] ||
        import->camera_from_world[1].m[i] != identity.m[i])
      return vl_dict_fail(
          dict,
          "its pose is given by eye, lookat and up; transforms before it have no meaning");
  return true;
}

/* Makes the camera once, so that its errors are reported at the directive. */
static bool check(vlImport *import, const char *what, const vlCameraDef *def) {
  vlCamera camera;
  vlError error = {0};
  const char *warning = NULL;
  if (vl_camera_make(def, &camera, &warning, &error) != VL_OK) {
    const char *text =
        strncmp(error.message, "camera: ", 8) == 0 ? error.message + 8 : error.message;
    return vl_import_wrong(import, import->camera.source, "%s: %s", what, text);
  }
  if (warning && camera.outside > 0.0)
    vl_import_warn(import, VL_LOG_WARNING, import->camera.source,
                   "%s: the lens folds or its model ends inside the image: %.2g %% of it sees "
                   "nothing (alpha 0)",
                   what, 100.0 * camera.outside);
  else if (warning)
    vl_import_warn(import, VL_LOG_WARNING, import->camera.source, "%s", warning);
  return true;
}

/* Defines the coordinate system "camera" with pbrt's axes: x right, y up, z forward. */
static bool name_lecture_system(vlImport *import, const vlCameraDef *def) {
  vlCamera camera;
  vlError error;
  uint32_t index;
  if (vl_camera_make(def, &camera, NULL, &error) != VL_OK ||
      !vl_names_find(&import->coordinate_systems, "camera", &index))
    return true;
  vlMat4 m = vl_mat4_load(camera.world_from_camera);
  for (int row = 0; row < 3; row++)
    m.m[4 * row + 1] = -m.m[4 * row + 1];
  import->matrices.items[index].at[0] = import->matrices.items[index].at[1] = m;
  return true;
}

/* Reads the parameters of a kind of camera. Returns false after an error. */
static bool read_kind(vlDict *dict, vlCameraDef *def) {
  const vlCameraKind kind = (vlCameraKind)dict->kind;
  vlImport *import = dict->import;
  switch (kind) {
    case VL_CAMERA_PBRT_PERSPECTIVE:
      return read_pbrt(dict, def, false);
    case VL_CAMERA_PBRT_ORTHOGRAPHIC:
      return read_pbrt(dict, def, true);
    case VL_CAMERA_SPHERICAL:
      return read_spherical(dict, def);
    case VL_CAMERA_REALISTIC:
      return read_optics(dict, def, import->film_diagonal) && check_shutter(dict, def) &&
             vl_dict_done(dict) && pose_from_ctm(import, def);
    case VL_CAMERA_PINHOLE:
    case VL_CAMERA_THIN_LENS:
    case VL_CAMERA_FISHEYE:
    case VL_CAMERA_OPENCV:
    case VL_CAMERA_OPENCV_FISHEYE:
    case VL_CAMERA_COLMAP:
    case VL_CAMERA_OF_PROJECTION:
      break;
  }
  return read_lecture(dict, def, kind);
}

bool vl_import_camera(vlImport *import) {
  vlSceneDefs *defs = vl_scene_defs(import->scene);
  const vlChoice *choice = &import->camera;
  vlDict dict =
      vl_import_choice_dict(import, "Camera", &vl_camera_family, choice, "perspective");
  vlCameraDef def = vl_default_camera_def(defs->film.width, defs->film.height);
  for (int i = 0; i < 2 && !choice->given; i++)
    import->camera_from_world[i] = vl_mat4_identity();
  defs->camera_source = choice->source;
  if (!dict.row) { /* permissive: pbrt's perspective camera at the same pose replaces it */
    if (!vl_import_unknown_kind(import, choice->source, &vl_camera_family, choice->kind))
      return false;
    vl_dict_skip(&dict);
    def.fov = 90.0 * degrees;
    if (!pose_from_ctm(import, &def))
      return false;
  } else {
    vl_row_set_defaults(dict.row, &def);
    if (!vl_import_parameters(&dict, &def, false) || !read_kind(&dict, &def))
      return false;
  }
  if (!check(import, dict.what, &def))
    return false;
  defs->camera = def;
  /* in pbrt the exposure grows with the time that the shutter is open; velo's own cameras have
   * a separate factor */
  bool pbrts = dict.row && dict.kind <= (int)VL_CAMERA_REALISTIC;
  if (pbrts)
    defs->develop.exposure *= (float)(def.shutter_close - def.shutter_open);
  /* pbrt limits the sensor's output, velo's film its input. */
  if (defs->develop.exposure > 0.0f)
    defs->film.max_component /= defs->develop.exposure;
  return pbrts || !dict.row || name_lecture_system(import, &def);
}
