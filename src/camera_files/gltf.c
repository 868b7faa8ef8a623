/* camera_files/gltf.c: glTF 2.0's cameras (section 3.10): a node's transform, world from
 * camera, axes x right, y up, z back, column-major matrices; yfov and aspectRatio
 * (perspective); xmag and ymag, half the image's sides (orthographic). glTF has neither a size
 * in pixels nor a principal point. The full camera is stored in the camera's `extras`, as
 * velo's own JSON, from which velo reads it back. */
#include <math.h>

#include "base/text.h"
#include "camera_files/fields.h"
#include "math/elementary.h"
#include "math/transform.h"

/* A camera in glTF's parameters. */
typedef struct {
  bool flat;
  double aspect, yfov, xmag, ymag;
  double matrix[16]; /* row-major, glTF's axes */
} Numbers;

static Numbers numbers_of(const vlCamera *c) {
  Numbers n = {.flat = c->projection == VL_PROJECTION_ORTHOGRAPHIC};
  n.xmag = 0.5 * c->width / c->fx;
  n.ymag = 0.5 * c->height / c->fy;
  n.aspect = n.xmag / n.ymag;
  n.yfov = 2.0 * vl_precise_atan(n.ymag);
  vl_camera_flip_axes(c->world_from_camera, n.matrix);
  return n;
}

/* A node's own transform: matrix, or translation, rotation (x y z w), scale. */
static vlResult local_matrix(const vlCameraFile *file, const json_t *node, vlMat4 *result) {
  double m[16], r[9];
  double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
  *result = vl_mat4_identity();
  if (vl_camera_has(node, "matrix")) {
    VL_TRY(vl_camera_list(file, node, "matrix", m, 16));
    vl_camera_transpose(m, result->m);
    return VL_OK;
  }
  VL_TRY(VL_READ_FIELDS(file, node, VL_FIELD_LIST_IF_THERE("translation", t, 3),
                        VL_FIELD_LIST_IF_THERE("rotation", q, 4),
                        VL_FIELD_LIST_IF_THERE("scale", s, 3)));
  const double wxyz[4] = {q[3], q[0], q[1], q[2]};
  if (!vl_rotation_from_quaternion(wxyz, r))
    return vl_camera_wrong(file, "gltf: a node's \"rotation\" is no rotation");
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      result->m[4 * i + j] = r[3 * i + j] * s[j];
    result->m[4 * i + 3] = t[i];
  }
  return VL_OK;
}

/* World matrix of a node. *parents[i] is the parent of node i, -1 for none. */
static vlResult world_matrix(const vlCameraFile *file, const json_t *nodes,
                             const int64_t *parents, int64_t index, vlMat4 *result) {
  int64_t steps = 0, count = (int64_t)json_array_size(nodes);
  *result = vl_mat4_identity();
  for (int64_t i = index; i >= 0; i = parents[i]) {
    vlMat4 local;
    if (++steps > count)
      return vl_camera_wrong(file, "gltf: node %lld is among its own children",
                             (long long)index);
    VL_TRY(local_matrix(file, json_array_get(nodes, (size_t)i), &local));
    *result = vl_mat4_multiply(local, *result);
  }
  return VL_OK;
}

static vlResult find_parents(const vlCameraFile *file, const json_t *nodes, int64_t *parents) {
  size_t count = json_array_size(nodes);
  json_t *child;
  for (size_t i = 0; i < count; i++)
    parents[i] = -1;
  for (size_t i = 0; i < count; i++)
    VL_EACH(child, json_object_get(json_array_get(nodes, i), "children")) {
      double at = json_number_value(child);
      if (!json_is_number(child) || !(at >= 0.0 && at < (double)count) || at != floor(at))
        return vl_camera_wrong(file, "gltf: node %zu has a child that does not exist", i);
      parents[(size_t)at] = (int64_t)i;
    }
  return VL_OK;
}

static vlResult read_perspective(const vlCameraFile *file, const json_t *lens,
                                 vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double yfov = 0.0, aspect = VL_UNSET;
  VL_TRY(VL_READ_FIELDS(
      file, lens, VL_FIELD("yfov", &yfov), VL_FIELD_OPTIONAL("aspectRatio", &aspect),
      VL_FIELD("znear", &d->near_plane), VL_FIELD_OPTIONAL("zfar", &d->far_plane)));
  if (!(yfov > 0.0 && yfov < 3.14159265358979))
    return vl_camera_wrong(file, "gltf: \"yfov\" is %g radians; it must lie between 0 and pi",
                           yfov);
  if (aspect == 0.0)
    aspect = VL_UNSET; /* not valid, but Assimp writes it where it knows none */
  if (aspect < 0.0)
    return vl_camera_wrong(file, "gltf: \"aspectRatio\" is %g; it must be above zero", aspect);
  VL_TRY(vl_camera_size(file, vl_is_unset(aspect) ? 16.0 / 9.0 : aspect, record));
  double half = vl_precise_tan(0.5 * yfov);
  d->fy = 0.5 * d->height / half;
  d->fx = vl_is_unset(aspect) ? d->fy : 0.5 * d->width / (half * aspect);
  return VL_OK;
}

static vlResult read_orthographic(const vlCameraFile *file, const json_t *lens,
                                  vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double x = 0.0, y = 0.0;
  VL_TRY(VL_READ_FIELDS(file, lens, VL_FIELD("xmag", &x), VL_FIELD("ymag", &y),
                        VL_FIELD("znear", &d->near_plane), VL_FIELD("zfar", &d->far_plane)));
  /* some exporters write negative values; the extent is the same */
  x = fabs(x);
  y = fabs(y);
  if (!(x > 0.0 && y > 0.0))
    return vl_camera_wrong(file, "gltf: \"xmag\" and \"ymag\" must not be zero");
  VL_TRY(vl_camera_size(file, x / y, record));
  d->projection = VL_PROJECTION_ORTHOGRAPHIC;
  d->fx = 0.5 * d->width / x;
  d->fy = 0.5 * d->height / y;
  return VL_OK;
}

/* Whether two numbers are equal but for the rounding of numbers in a file. */
static bool agree(double a, double b) {
  return fabs(a - b) <= 1e-6 * fmax(1.0, fmax(fabs(a), fabs(b)));
}

/* Reads the full camera from the extras. glTF's own numbers must still be those written with
 * it. */
static vlResult read_extras(const vlCameraFile *file, const json_t *extras, const vlMat4 *pose,
                            const json_t *lens, vlCameraRecord *record) {
  vlCamera camera;
  VL_TRY(vl_camera_read_velo(file, extras, record));
  VL_TRY(vl_camera_make(&record->camera, &camera, NULL, file->error));
  Numbers n = numbers_of(&camera);
  const struct {
    const char *key;
    double value;
  } fields[] = {{n.flat ? "xmag" : "yfov", n.flat ? n.xmag : n.yfov},
                {n.flat ? "ymag" : "aspectRatio", n.flat ? n.ymag : n.aspect}};
  for (int i = 0; i < 2; i++) {
    double value = json_number_value(json_object_get(lens, fields[i].key));
    if (!agree(value, fields[i].value))
      return vl_camera_wrong(
          file,
          "gltf: \"%s\" is %.9g, but velo's camera in \"extras\" makes it %.9g; remove one",
          fields[i].key, value, fields[i].value);
  }
  for (int i = 0; i < 12; i++)
    if (!agree(pose->m[i], n.matrix[i]))
      return vl_camera_wrong(file,
                             "gltf: the node stands elsewhere than velo's camera in "
                             "\"extras\"; remove the extras");
  return VL_OK;
}

static vlResult read_camera(const vlCameraFile *file, const json_t *camera, const vlMat4 *pose,
                            vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  const char *type = vl_camera_text(camera, "type");
  bool flat = vl_text_is(type, "orthographic");
  if (!type || (!flat && !vl_text_is(type, "perspective")))
    return vl_camera_wrong(
        file, "gltf: unknown camera type \"%s\"; there are perspective, orthographic",
        vl_short_text(type).text);
  const json_t *lens, *extras = json_object_get(json_object_get(camera, "extras"), "velo");
  VL_TRY(vl_camera_field(file, camera, type, &lens));
  if (extras)
    return read_extras(file, extras, pose, lens, record);
  VL_TRY(flat ? read_orthographic(file, lens, record) : read_perspective(file, lens, record));
  vl_camera_set_flipped(d, pose->m);
  return VL_OK;
}

/* Members that the format does not have, of the camera and of its node. */
static vlResult check_members(const vlCameraFile *file, const json_t *node,
                              const json_t *camera, vlCameraRecord *record) {
  static const char of_node[] =
      "camera children extensions! extras! matrix mesh name rotation "
      "scale skin translation weights";
  static const char of_camera[] =
      "aspectRatio extensions extras! name orthographic "
      "perspective type xmag yfov ymag zfar znear";
  VL_TRY(vl_camera_check_part(file, of_camera, camera, record));
  return vl_camera_check_part(file, of_node, node, record);
}

static vlResult camera_of(const vlCameraFile *file, const json_t *cameras, const json_t *index,
                          const json_t **camera) {
  double at = json_number_value(index);
  *camera = at >= 0.0 && at == floor(at) && at < (double)json_array_size(cameras)
                ? json_array_get(cameras, (size_t)at)
                : NULL;
  return json_is_object(*camera)
             ? VL_OK
             : vl_camera_wrong(file, "gltf: a node names a camera that does not exist");
}

/* World from camera of node `index`. */
static vlResult pose_of(const vlCameraFile *file, const json_t *nodes, size_t index,
                        vlMat4 *pose) {
  int64_t *parents = vl_alloc(file->context, json_array_size(nodes) * sizeof *parents);
  if (!parents)
    return vl_fail_memory(file->error);
  vlResult result = find_parents(file, nodes, parents);
  if (result == VL_OK)
    result = world_matrix(file, nodes, parents, (int64_t)index, pose);
  vl_free(file->context, parents);
  return result;
}

/* A node that holds a camera, and that camera. */
typedef struct {
  size_t index;
  const json_t *node, *camera;
} Holder;

/* Counts the nodes with cameras, and finds the one that is asked for. */
static vlResult find_holder(const vlCameraFile *file, const json_t *cameras,
                            const json_t *nodes, vlCameraRecord *record, Holder *chosen) {
  *chosen = (Holder){.node = NULL};
  record->frames = 0;
  for (size_t i = 0; i < json_array_size(nodes); i++) {
    const json_t *camera, *node = json_array_get(nodes, i);
    const json_t *index = json_object_get(node, "camera");
    if (!index)
      continue;
    VL_TRY(camera_of(file, cameras, index, &camera));
    const char *name = vl_camera_text(node, "name");
    if (!name)
      name = vl_camera_text(camera, "name");
    if (vl_camera_count(file, chosen->node, name, record)) {
      *chosen = (Holder){i, node, camera};
      vl_camera_name(record, name);
    }
  }
  if (record->frames == 0)
    return vl_camera_wrong(file, "gltf: no node holds a camera (\"cameras\" has %zu)",
                           json_array_size(cameras));
  return chosen->node ? VL_OK : vl_camera_no_frame(file, "camera", record);
}

static vlResult read_gltf(const vlCameraFile *file, const json_t *tree,
                          vlCameraRecord *record) {
  const json_t *cameras, *nodes = json_object_get(tree, "nodes");
  Holder holder;
  vlMat4 pose;
  VL_TRY(vl_camera_field(file, tree, "cameras", &cameras));
  VL_TRY(find_holder(file, cameras, nodes, record, &holder));
  VL_TRY(pose_of(file, nodes, holder.index, &pose));
  char name[sizeof record->name];
  memcpy(name, record->name, sizeof name);
  VL_TRY(read_camera(file, holder.camera, &pose, record)); /* may read a record with a name */
  if (!record->name[0])
    memcpy(record->name, name, sizeof name);
  return check_members(file, holder.node, holder.camera, record);
}

/* Whether two of the matrix's axes are not perpendicular. */
static bool shears(const double m[16]) {
  double dots[3] = {0, 0, 0}, squares[3] = {0, 0, 0};
  for (int i = 0; i < 12; i += 4)
    for (int k = 0; k < 3; k++) {
      dots[k] += m[i + k] * m[i + (k + 1) % 3];
      squares[k] += m[i + k] * m[i + k];
    }
  for (int k = 0; k < 3; k++)
    if (fabs(dots[k]) > 1e-9 * sqrt(squares[k] * squares[(k + 1) % 3]))
      return true;
  return false;
}

static vlResult write_gltf(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  Numbers n = numbers_of(c);
  if (shears(n.matrix))
    return vl_camera_cannot_hold(fit->file, "a pose that shears");
  /* glTF requires a near plane, and a far plane of orthographic cameras; the extras record that
   * the camera has none */
  double near_plane =
      c->near_plane > 0.0 || n.flat ? c->near_plane : fmin(0.01, 1e-3 * c->far_plane);
  const double planes[2] = {near_plane, isinf(c->far_plane) ? near_plane + 1e4 : c->far_plane};
  const double sides[4] = {n.xmag, n.ymag, n.aspect, n.yfov};
  VL_PUT_FORM(text, fit,
              "{\n"
              "  \"asset\": {\"version\": \"2.0\", \"generator\": \"velo\"},\n"
              "  \"scene\": 0,\n"
              "  \"scenes\": [{\"nodes\": [0]}],\n"
              "  \"nodes\": [{\n"
              "    \"name\": $name,\n"
              "    \"camera\": 0,\n"
              "    \"matrix\": [$flippedcolumns]\n"
              "  }],\n"
              "  \"cameras\": [{\n"
              "    \"type\": \"$type\",\n"
              "    \"$type\": {$sides, \"znear\": $planes@0$end},\n"
              "    \"extras\": {\"velo\": ",
              VL_WORD("type", n.flat ? "orthographic" : "perspective"),
              {.key = "sides",
               .part = n.flat ? "\"xmag\": $own@0, \"ymag\": $own@1"
                              : "\"aspectRatio\": $own@2, \"yfov\": $own@3"},
              VL_VALUES("own", sides, 4), VL_VALUES("planes", planes, 2),
              VL_PART("end", !isinf(c->far_plane) || n.flat, ", \"zfar\": $planes@1"));
  vlCameraText whole = {.context = text->context};
  const vlResult result = vl_camera_write_velo(fit, &whole);
  vl_camera_put_text(text, &whole);
  VL_ARRAY_FREE(text->context, &whole.text);
  vl_camera_put(text, "}\n  }]\n}\n");
  return result;
}

const vlCameraFormat vl_format_gltf = {
    .name = "gltf",
    .marks = "asset",
    .read = read_gltf,
    .holds = VL_HOLDS_POSE | VL_HOLDS_SCALE | VL_HOLDS_PLANES,
    .plain = true,
    .centred = true,
    .unnamed = "Camera",
    .write = write_gltf};
