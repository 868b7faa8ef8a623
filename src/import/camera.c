/* import/camera.c: the Camera directive to a vlCameraDef: pbrt's perspective and orthographic cameras, and the
 * lecture's pinhole and thin lens in its own words. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/builder.h"

static const double degrees = 0.017453292519943295;

typedef enum Kind { PERSPECTIVE, ORTHOGRAPHIC, PINHOLE, THIN_LENS, KINDS } Kind;
static const char *const kinds[KINDS] = {"perspective", "orthographic", "pinhole", "thinlens"};
static const char *const later[] = {"realistic", "spherical"};

/* velo's camera has y down; pbrt's y up, both x right, z forward. The world's numbers stay as they are: pbrt reads them
 * as left-handed, so that seen from velo its cameras mirror. */
static bool pose_from_ctm(vlImport *import, vlCameraDef *def) {
  vlMat4 m;
  if (!vl_mat4_inverse(import->camera_from_world, &m))
    return vl_import_fail(import, VL_ERROR_SCENE, import->camera.place, "Camera: the current transform is singular");
  for (int row = 0; row < 3; row++) {
    for (int column = 0; column < 4; column++)
      def->world_from_camera[4 * row + column] = m.m[4 * row + column] * (column == 1 ? -1.0 : 1.0);
  }
  bool affine = import->camera_from_world.m[12] == 0.0 && import->camera_from_world.m[13] == 0.0 &&
                import->camera_from_world.m[14] == 0.0;
  for (int column = 0; column < 4; column++) {
    double v = m.m[12 + column] * (column == 1 ? -1.0 : 1.0);
    def->world_from_camera[12 + column] = affine ? (column == 3 ? 1.0 : 0.0) : v;
  }
  double w = affine ? m.m[15] : 1.0; /* a transform's last number need not be 1 */
  for (int i = 0; i < 12; i++) def->world_from_camera[i] /= w;
  def->has_matrix = true;
  return true;
}

static bool read_shutter(vlDict *dict, vlCameraDef *def) {
  vl_dict_double(dict, "shutteropen", &def->shutter_open);
  vl_dict_double(dict, "shutterclose", &def->shutter_close);
  if (def->shutter_close > def->shutter_open || dict->import->scene->error.code != VL_OK)
    return dict->import->scene->error.code == VL_OK;
  return vl_import_fail(dict->import, VL_ERROR_SCENE, dict->place,
                        "%s: the shutter does not open: it closes at %g, opens at %g", dict->what, def->shutter_close,
                        def->shutter_open);
}

/* pbrt's cameras (book 5.2). The window on the screen is -1 to 1 along the smaller side, unless given. */
static bool read_pbrt(vlDict *dict, vlCameraDef *def, Kind kind) {
  vlImport *import = dict->import;
  double frame = (double)def->width / def->height, fov = 90.0, window[4], focus = 1e6;
  bool given = vl_dict_double(dict, "frameaspectratio", &frame);
  if (given && !(frame > 0.0))
    return vl_import_fail(import, VL_ERROR_SCENE, dict->place, "%s: \"frameaspectratio\" must be above 0", dict->what);
  double x = frame > 1.0 ? frame : 1.0, y = frame > 1.0 ? 1.0 : 1.0 / frame;
  double standard[4] = {-x, x, -y, y};
  memcpy(window, standard, sizeof window);
  given = vl_dict_floats(dict, "screenwindow", 4, window) || given;
  if (given || kind == ORTHOGRAPHIC) {
    def->screen_min_x = window[0];
    def->screen_max_x = window[1];
    def->screen_min_y = window[2];
    def->screen_max_y = window[3];
  }
  if (kind == PERSPECTIVE) {
    vl_dict_double(dict, "fov", &fov);
    def->fov = fov * degrees;
    def->fov_axis = VL_FOV_SMALLER;
  } else {
    def->projection = VL_PROJECTION_ORTHOGRAPHIC;
  }
  vl_dict_double(dict, "lensradius", &def->lens_radius);
  if (vl_dict_double(dict, "focaldistance", &focus) || def->lens_radius != 0.0) def->focus_distance = focus;
  return read_shutter(dict, def) && vl_dict_done(dict) && pose_from_ctm(import, def);
}

/* The lecture's camera: eye, lookat, up, roll; d, zoom, s or a field of view; exposure time. Its world is right-handed.
 */
static bool read_lecture(vlDict *dict, vlCameraDef *def, Kind kind) {
  static const char *const axes[] = {"vertical", "horizontal", "diagonal", "smaller", "larger"};
  vlImport *import = dict->import;
  int axis = VL_FOV_SMALLER;
  vl_dict_vector(dict, "eye", VL_PARAM_POINT3, def->eye);
  vl_dict_vector(dict, "lookat", VL_PARAM_POINT3, def->lookat);
  vl_dict_vector(dict, "up", VL_PARAM_VECTOR3, def->up);
  if (vl_dict_double(dict, "roll", &def->roll)) def->roll *= degrees;
  vl_dict_double(dict, "d", &def->view_distance);
  vl_dict_double(dict, "zoom", &def->zoom);
  vl_dict_double(dict, "pixelsize", &def->pixel_size);
  if (vl_dict_double(dict, "fov", &def->fov)) def->fov *= degrees;
  vl_dict_choice(dict, "fovaxis", axes, 5, &axis);
  def->fov_axis = (vlFovAxis)axis;
  vl_dict_double(dict, "focallength", &def->focal_mm);
  vl_dict_double(dict, "sensorwidth", &def->sensor_width_mm);
  vl_dict_double(dict, "fx", &def->fx);
  vl_dict_double(dict, "fy", &def->fy);
  vl_dict_double(dict, "cx", &def->cx);
  vl_dict_double(dict, "cy", &def->cy);
  vl_dict_double(dict, "skew", &def->skew);
  vl_dict_double(dict, "exposuretime", &def->exposure_time);
  vl_dict_double(dict, "near", &def->near_plane);
  vl_dict_double(dict, "far", &def->far_plane);
  if (kind == THIN_LENS) {
    vl_dict_double(dict, "lensradius", &def->lens_radius);
    vl_dict_double(dict, "focusdistance", &def->focus_distance);
    vl_dict_double(dict, "focaldistance", &def->focus_distance); /* pbrt's word for it */
  }
  if (!read_shutter(dict, def) || !vl_dict_done(dict)) return false;
  const vlMat4 identity = vl_mat4_identity();
  for (int i = 0; i < 16; i++)
    if (import->camera_from_world.m[i] != identity.m[i])
      return vl_import_fail(import, VL_ERROR_SCENE, dict->place,
                            "%s: its pose is given by eye, lookat and up; transforms before it have no meaning",
                            dict->what);
  return true;
}

/* The camera that results, for errors at their place. */
static bool check(vlImport *import, const char *what, const vlCameraDef *def) {
  vlCamera camera;
  vlError error = {0};
  const char *warning = NULL;
  if (vl_camera_make(def, &camera, &warning, &error) != VL_OK) {
    const char *text = strncmp(error.message, "camera: ", 8) == 0 ? error.message + 8 : error.message;
    return vl_import_fail(import, VL_ERROR_SCENE, import->camera.place, "%s: %s", what, text);
  }
  if (warning) vl_import_warn(import, VL_LOG_WARNING, import->camera.place, "%s", warning);
  return true;
}

/* "camera" as a coordinate system: pbrt's axes, x right, y up, z forward. */
static bool name_lecture_system(vlImport *import, const vlCameraDef *def) {
  vlCamera camera;
  vlError error;
  uint32_t index;
  if (vl_camera_make(def, &camera, NULL, &error) != VL_OK ||
      !vl_names_find(&import->coordinate_systems, "camera", &index))
    return true;
  vlMat4 m = vl_mat4_load(camera.world_from_camera);
  for (int row = 0; row < 3; row++) m.m[4 * row + 1] = -m.m[4 * row + 1];
  import->matrices.items[index] = m;
  return true;
}

bool vl_import_camera(vlImport *import) {
  vlSceneSettings *settings = vl_scene_settings(import->scene);
  const vlChoice *choice = &import->camera;
  char what[96];
  snprintf(what, sizeof what, "Camera \"%.60s\"", choice->given ? choice->kind : "perspective");
  vlDict dict = vl_import_dict(import, what, choice->place, choice->space, &choice->params, NULL);
  vlCameraDef def = vl_default_camera_def(settings->width, settings->height);
  int kind = choice->given ? -1 : PERSPECTIVE;
  for (int i = 0; choice->given && i < KINDS; i++)
    if (strcmp(choice->kind, kinds[i]) == 0) kind = i;
  if (!choice->given) import->camera_from_world = vl_mat4_identity();
  settings->camera_source = choice->place;
  if (kind < 0) { /* permissive: pbrt's perspective camera from the same place */
    if (!vl_import_unknown(import, choice->place, "camera", choice->kind, kinds, KINDS, later, 2)) return false;
    vl_dict_skip(&dict);
    def.fov = 90.0 * degrees;
    if (!pose_from_ctm(import, &def)) return false;
  } else if (kind == PERSPECTIVE || kind == ORTHOGRAPHIC) {
    if (!read_pbrt(&dict, &def, (Kind)kind)) return false;
  } else if (!read_lecture(&dict, &def, (Kind)kind)) {
    return false;
  }
  if (!check(import, what, &def)) return false;
  settings->camera = def;
  /* pbrt's sensor: the longer the shutter is open, the brighter; the lecture says it with its own factor. */
  if (kind == PERSPECTIVE || kind == ORTHOGRAPHIC) settings->exposure *= (float)(def.shutter_close - def.shutter_open);
  return kind < PINHOLE || name_lecture_system(import, &def);
}
