/* camera_files/collada.c: COLLADA's cameras (.dae, versions 1.4 and 1.5): nodes of the visual
 * scenes with <instance_camera>. Camera axes: x right, y up, z back; the node's transforms in
 * their order, world from camera, column vectors; the axes of the world stay those of the file
 * (<up_axis>). Angles are in degrees. There are no pixels: the image's size comes from the
 * aspect ratio; xmag and ymag are half the image's sides, as in glTF. */
#include <math.h>

#include "base/text.h"
#include "camera_files/fields.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "math/transform.h"

enum { MAX_DEPTH = 30 };

/* <lookat>: eye, the point that is looked at, up. */
static bool look_at(const double v[9], vlMat4 *m) {
  double x[3], y[3], z[3], length = 0.0;
  for (int i = 0; i < 3; i++)
    z[i] = v[i] - v[3 + i];
  length = vl_precise_hypot(vl_precise_hypot(z[0], z[1]), z[2]);
  for (int i = 0; i < 3; i++)
    z[i] /= length;
  vl_cross3(v + 6, z, x);
  length = vl_precise_hypot(vl_precise_hypot(x[0], x[1]), x[2]);
  for (int i = 0; i < 3; i++)
    x[i] /= length;
  vl_cross3(z, x, y);
  *m = vl_mat4_axes(x, y, z, v);
  return vl_mat4_is_finite(*m);
}

/* Multiplies the node's transforms from the right. */
static vlResult add_transforms(const vlCameraFile *file, const json_t *node, vlMat4 *world) {
  const json_t *child;
  VL_EACH_CHILD(child, node) {
    vlMat4 step = vl_mat4_identity();
    double v[9];
    if (vl_camera_has_tag(child, "matrix")) {
      VL_TRY(vl_camera_element_numbers(file, child, step.m, 16));
    } else if (vl_camera_has_tag(child, "translate")) {
      VL_TRY(vl_camera_element_numbers(file, child, v, 3));
      step = vl_mat4_translate(v[0], v[1], v[2]);
    } else if (vl_camera_has_tag(child, "scale")) {
      VL_TRY(vl_camera_element_numbers(file, child, v, 3));
      step = vl_mat4_scale(v[0], v[1], v[2]);
    } else if (vl_camera_has_tag(child, "rotate")) {
      VL_TRY(vl_camera_element_numbers(file, child, v, 4));
      if (v[0] != 0.0 || v[1] != 0.0 || v[2] != 0.0)
        step = vl_mat4_rotate(v[3] * VL_DEGREE, v[0], v[1], v[2]);
    } else if (vl_camera_has_tag(child, "lookat")) {
      VL_TRY(vl_camera_element_numbers(file, child, v, 9));
      if (!look_at(v, &step))
        return vl_camera_wrong_element(file, child, "<lookat> gives no direction");
    } else if (vl_camera_has_tag(child, "skew")) {
      return vl_camera_wrong_element(file, child, "<skew> is not read");
    } else {
      continue;
    }
    *world = vl_mat4_multiply(*world, step);
  }
  return VL_OK;
}

typedef struct {
  const json_t *camera;           /* <instance_camera> of the chosen node */
  const json_t *stops[MAX_DEPTH]; /* the nodes down to it */
  int depth;
  vlCameraRecord *record; /* gets the name, and counts the cameras */
} Search;

static vlResult search(const vlCameraFile *file, const json_t *node, const json_t **stops,
                       int depth, Search *s) {
  const json_t *child;
  if (depth == MAX_DEPTH)
    return vl_camera_wrong_element(file, node, "nested too deeply for a camera");
  stops[depth] = node;
  const char *name = vl_camera_text(node, "name");
  if (!name)
    name = vl_camera_text(node, "id");
  VL_EACH_CHILD(child, node) {
    if (vl_camera_has_tag(child, "instance_camera") &&
        vl_camera_count(file, s->camera, name, s->record)) {
      s->camera = child;
      s->depth = depth + 1;
      vl_camera_name(s->record, name);
      memcpy(s->stops, stops, sizeof s->stops);
    }
    if (vl_camera_has_tag(child, "node"))
      VL_TRY(search(file, child, stops, depth + 1, s));
  }
  return VL_OK;
}

static const json_t *find_camera(const json_t *tree, const char *url) {
  const json_t *library = vl_camera_child(tree, "library_cameras"), *camera;
  VL_EACH_CHILD(camera, library) {
    const char *id = vl_camera_text(camera, "id");
    if (vl_camera_has_tag(camera, "camera") && id && url && *url == '#' &&
        vl_text_is(id, url + 1))
      return camera;
  }
  return NULL;
}

/* Half the width and height of the image: at distance 1, or for parallel projections in the
 * world's unit. */
static vlResult read_sides(const vlCameraFile *file, const json_t *lens, bool flat,
                           double half[2]) {
  const char *const tags[2] = {flat ? "xmag" : "xfov", flat ? "ymag" : "yfov"};
  double aspect = VL_UNSET;
  VL_TRY(vl_camera_child_number(file, lens, "aspect_ratio", false, &aspect));
  for (int i = 0; i < 2; i++) {
    half[i] = VL_UNSET;
    VL_TRY(vl_camera_child_number(file, lens, tags[i], false, &half[i]));
    if (vl_is_unset(half[i]))
      continue;
    half[i] = fabs(half[i]);
    if (!(half[i] > 0.0) || (!flat && half[i] >= 180.0))
      return vl_camera_wrong_element(file, vl_camera_child(lens, tags[i]),
                                     "<%s> gives no image", tags[i]);
    if (!flat)
      half[i] = vl_precise_tan(0.5 * VL_DEGREE * half[i]);
  }
  if (vl_is_unset(half[0]) && vl_is_unset(half[1]))
    return vl_camera_wrong_element(file, lens, "there is neither <%s> nor <%s>", tags[0],
                                   tags[1]);
  if (!vl_is_unset(half[0]) && !vl_is_unset(half[1]))
    return VL_OK;
  if (vl_is_unset(aspect) && file->def->width && file->def->height)
    aspect = (double)file->def->width / file->def->height;
  if (!(aspect > 0.0))
    return vl_camera_wrong_element(
        file, lens, "there is no <aspect_ratio>; give a size: --size WIDTHxHEIGHT");
  if (vl_is_unset(half[0]))
    half[0] = half[1] * aspect;
  if (vl_is_unset(half[1]))
    half[1] = half[0] / aspect;
  return VL_OK;
}

/* Blender's shift of the lens, in an extra below the camera. */
enum { MAX_EXTRA = 8 };
static vlResult refuse_shift(const vlCameraFile *file, const json_t *element, int depth) {
  const json_t *child;
  VL_EACH_CHILD(child, element) {
    const char *tag = vl_camera_text(child, "<");
    double shift = 0.0;
    if (vl_text_is(tag, "shiftx") || vl_text_is(tag, "shifty"))
      VL_TRY(vl_camera_element_numbers(file, child, &shift, 1));
    else if (depth > 0)
      VL_TRY(refuse_shift(file, child, depth - 1));
    if (shift != 0.0)
      return vl_camera_wrong_element(file, child, "a lens shift, <%s>, is not taken", tag);
  }
  return VL_OK;
}

/* Finds the node of the camera that is to be read, and counts the cameras. */
static vlResult search_scenes(const vlCameraFile *file, const json_t *tree, Search *s) {
  const json_t *scenes = vl_camera_child(tree, "library_visual_scenes"), *scene, *node,
               *stops[MAX_DEPTH] = {NULL};
  size_t i;
  json_array_foreach(json_object_get(scenes, "/"), i, scene) {
    VL_EACH_CHILD(node, scene) {
      if (vl_camera_has_tag(node, "node"))
        VL_TRY(search(file, node, stops, 0, s));
    }
  }
  return VL_OK;
}

static vlResult read_collada(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  static const char known[] =
      "camera id name sid optics technique_common perspective "
      "orthographic xfov yfov xmag ymag aspect_ratio znear zfar "
      "asset! extra! technique! imager!";
  vlCameraDef *d = &record->camera;
  Search s = {.record = record};
  vlMat4 world = vl_mat4_identity();
  double half[2];
  record->frames = 0;
  VL_TRY(search_scenes(file, tree, &s));
  if (!s.camera)
    return vl_camera_no_frame(file, "camera", record);
  const json_t *camera = find_camera(tree, vl_camera_text(s.camera, "url"));
  if (!camera)
    return vl_camera_wrong_element(file, s.camera,
                                   "the node names a camera that does not exist");
  VL_TRY(refuse_shift(file, camera, MAX_EXTRA));
  const json_t *common = vl_camera_child(vl_camera_child(camera, "optics"), "technique_common");
  const json_t *lens = vl_camera_child(common, "perspective");
  bool flat = !lens;
  if (flat)
    lens = vl_camera_child(common, "orthographic");
  if (!lens)
    return vl_camera_wrong_element(file, camera,
                                   "the camera is neither perspective nor orthographic");
  for (int depth = 0; depth < s.depth; depth++)
    VL_TRY(add_transforms(file, s.stops[depth], &world));
  VL_TRY(read_sides(file, lens, flat, half));
  VL_TRY(VL_READ_CHILDREN(file, lens, VL_FIELD_OPTIONAL("znear", &d->near_plane),
                          VL_FIELD_OPTIONAL("zfar", &d->far_plane)));
  VL_TRY(vl_camera_size(file, half[0] / half[1], record));
  if (flat)
    d->projection = VL_PROJECTION_ORTHOGRAPHIC;
  d->fx = 0.5 * d->width / half[0];
  d->fy = 0.5 * d->height / half[1];
  vl_camera_set_flipped(d, world.m);
  return vl_camera_check_part(file, known, camera, record);
}

static bool is_collada(const json_t *tree) {
  return vl_camera_has_tag(tree, "COLLADA");
}

static vlResult write_collada(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  bool flat = c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  if (!flat && fit->family != VL_LENS_PINHOLE)
    return vl_camera_no_model(fit->file, &fit->record->camera);
  VL_TRY(vl_camera_refuse_off_centre(fit->file, c));
  double x = 0.5 * c->width / c->fx, y = 0.5 * c->height / c->fy;
  const char *kind = flat ? "orthographic" : "perspective", *side = flat ? "mag" : "fov";
  if (!flat) {
    x = 2.0 / VL_DEGREE * vl_precise_atan(x);
    y = 2.0 / VL_DEGREE * vl_precise_atan(y);
  }
  const double planes[2] = {c->near_plane > 0.0 || flat ? c->near_plane : 0.01,
                            isinf(c->far_plane) ? 10000.0 : c->far_plane};
  return VL_PUT_FORM(
      text, fit,
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
      "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"
      "  <asset><created>1970-01-01T00:00:00</created><modified>1970-01-01T00:00:00</modified>"
      "<unit name=\"meter\" meter=\"1\"/><up_axis>Y_UP</up_axis></asset>\n"
      "  <library_cameras>\n    <camera id=\"camera-lens\" name=\"camera\">\n      "
      "<optics><technique_common>\n"
      "        <$kind>\n          <x$side>$x</x$side>\n          <y$side>$y</y$side>\n"
      "          <znear>$planes@0</znear>\n          <zfar>$planes@1</zfar>\n        </$kind>\n"
      "      </technique_common></optics>\n    </camera>\n  </library_cameras>\n"
      "  <library_visual_scenes>\n    <visual_scene id=\"scene\" name=\"scene\">\n"
      "      <node id=\"camera\" name=\"camera\" type=\"NODE\">\n        <matrix "
      "sid=\"transform\">$flipped:s</matrix>\n"
      "        <instance_camera url=\"#camera-lens\"/>\n      </node>\n    </visual_scene>\n"
      "  </library_visual_scenes>\n  <scene><instance_visual_scene "
      "url=\"#scene\"/></scene>\n</COLLADA>\n",
      VL_WORD("kind", kind), VL_WORD("side", side), VL_VALUES("x", &x, 1),
      VL_VALUES("y", &y, 1), VL_VALUES("planes", planes, 2));
}

const vlCameraFormat vl_format_collada = {
    .name = "collada",
    .is_tree = is_collada,
    .read = read_collada,
    .holds = VL_HOLDS_POSE | VL_HOLDS_SCALE | VL_HOLDS_PLANES,
    .write = write_collada};
