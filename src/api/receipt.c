/* api/receipt.c: see velo/receipt.h. docs/receipts.md describes the text. */
#include "velo/receipt.h"

#include <stdio.h>

#include "api/receipt.h"
#include "base/cookie.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/free.h"
#include "base/json.h"
#include "base/text.h"
#include "camera/aperture.h"
#include "camera/optics.h"
#include "camera_files/files.h"
#include "sampler/sampler.h"
#include "velo/projection.h"

uint32_t vl_sample_sequence(void) {
  return VL_SAMPLE_SEQUENCE;
}

vlReceiptDef vl_default_receipt_def(void) {
  return (vlReceiptDef){.cookie = VL_COOKIE_RECEIPT, .focus_distance = VL_UNSET};
}

/* ---- making ------------------------------------------------------------------------------ */

static bool put_velo(json_t *tree, const char *commit) {
  json_t *velo = json_object();
  bool good = vl_receipt_put(velo, "version", json_string(vl_version()->text)) &&
              (!commit || vl_receipt_put(velo, "commit", json_string(commit))) &&
              vl_receipt_put(velo, "sequence", json_integer(VL_SAMPLE_SEQUENCE));
  if (!good) {
    json_decref(velo);
    return false;
  }
  return vl_receipt_put(tree, "velo", velo);
}

/* Makes a JSON string of any bytes. If they are not UTF-8 (paths may be so), each byte above
 * 0x7f becomes "?". */
static json_t *json_of_text(vlContext *context, const char *text) {
  json_t *value = json_string(text);
  if (value)
    return value;
  char *copy = vl_strdup(context, text);
  for (char *c = copy; copy && *c; c++)
    if ((unsigned char)*c >= 0x80)
      *c = '?';
  value = copy ? json_string(copy) : NULL;
  vl_free(context, copy);
  return value;
}

static bool put_strings(vlContext *context, json_t *tree, const char *key,
                        const char *const *strings, uint32_t count) {
  if (!strings)
    return true;
  json_t *list = json_array();
  for (uint32_t i = 0; i < count; i++)
    if (!vl_receipt_put(list, NULL, json_of_text(context, strings[i]))) {
      json_decref(list);
      return false;
    }
  return vl_receipt_put(tree, key, list);
}

/* Returns the path relative to the scene's folder if it begins with that folder, else the whole
 * path. */
static const char *relative(const char *path, const char *scene) {
  const char *slash = scene ? strrchr(scene, '/') : NULL;
  size_t folder = slash ? (size_t)(slash + 1 - scene) : 0;
  return folder && strncmp(path, scene, folder) == 0 ? path + folder : path;
}

static bool put_files(vlContext *context, json_t *tree, const char *scene) {
  json_t *list = json_array();
  const vlFileRecord *record;
  for (uint32_t i = 0; (record = vl_context_file(context, i)); i++) {
    char digest[33];
    vl_digest_text(record->digest, digest);
    json_t *file = json_object();
    bool good =
        vl_receipt_put(file, "path", json_of_text(context, relative(record->path, scene))) &&
        vl_receipt_put(file, "size", json_integer((json_int_t)record->size)) &&
        vl_receipt_put(file, "murmur3", json_string(digest));
    if (!good) {
      json_decref(file);
      file = NULL;
    }
    if (!vl_receipt_put(list, NULL, file)) {
      json_decref(list);
      return false;
    }
  }
  return vl_receipt_put(tree, "files", list);
}

/* Makes the camera's tree as in velo's camera files, for the image size of its description. The
 * film holds the size of the image. */
static json_t *camera_tree(vlContext *context, const vlCameraDef *camera) {
  vlCameraRecord record = {.camera = *camera};
  if (camera->own)
    record.camera.projection = VL_PROJECTION_OWN;
  vlCameraText text = {.context = context};
  vl_camera_put_velo(&record, &text);
  /* reads all numbers as reals, which keeps -0; the counts become integers below */
  json_error_t location;
  const size_t flags = JSON_DECODE_INT_AS_REAL | JSON_REJECT_DUPLICATES;
  json_t *tree =
      text.failed ? NULL : vl_json_parse(text.text.items, text.text.count, flags, &location);
  VL_ARRAY_FREE(context, &text.text);
  static const char *const counts[] = {"velo_camera", "width", "height", "blades"};
  bool good = tree != NULL;
  for (size_t i = 0; i < VL_LENGTH(counts) && good; i++) {
    const json_t *value = json_object_get(tree, counts[i]);
    if (value)
      good = vl_receipt_put(tree, counts[i], json_integer((json_int_t)json_real_value(value)));
  }
  if (!good) {
    json_decref(tree);
    tree = NULL;
  }
  return tree;
}

static bool put_digest(json_t *object, const char *key, const uint8_t digest[16]) {
  char text[33];
  vl_digest_text(digest, text);
  return vl_receipt_put(object, key, json_string(text));
}

/* Adds digests of what camera files cannot hold: the aperture's image and a lens of many
 * elements; and the name of a camera of one's own. */
static bool put_optics(json_t *camera, const vlCameraDef *def) {
  if (def->own && !vl_receipt_put(camera, "own", json_string(def->own->name)))
    return false;
  uint8_t digest[16];
  if (def->lens.aperture) {
    vl_aperture_digest(def->lens.aperture, digest);
    if (!put_digest(camera, "aperture_digest", digest))
      return false;
  }
  if (def->projection != VL_PROJECTION_OPTICS || !def->lens.optics)
    return true;
  vlOpticsDef optics;
  vlLensSurface surfaces[VL_MAX_SURFACES];
  vl_optics_def(def->lens.optics, &optics, surfaces);
  double numbers[4 * VL_MAX_SURFACES + 3];
  size_t count = 0;
  for (uint32_t i = 0; i < optics.count; i++) {
    numbers[count++] = surfaces[i].radius;
    numbers[count++] = surfaces[i].thickness;
    numbers[count++] = surfaces[i].ior;
    numbers[count++] = surfaces[i].aperture;
  }
  numbers[count++] = vl_is_unset(optics.aperture_diameter) ? -1.0 : optics.aperture_diameter;
  numbers[count++] = optics.film_diagonal;
  numbers[count++] = optics.unit_mm;
  vl_digest(numbers, count * sizeof *numbers, digest);
  if (!put_digest(camera, "optics_digest", digest))
    return false;
  if (optics.aperture) {
    vl_aperture_digest(optics.aperture, digest);
    if (!put_digest(camera, "aperture_digest", digest))
      return false;
  }
  return vl_receipt_put(camera, "optics_focus", json_real(optics.focus_distance));
}

static bool put_camera(vlContext *context, json_t *tree, const vlReceiptDef *def) {
  vlCameraDef camera = def->defs->camera;
  if (!vl_is_unset(def->focus_distance)) {
    camera.focus_distance = def->focus_distance;
    for (int i = 0; i < 2; i++)
      camera.lens.focus_pixel[i] = VL_UNSET;
    for (int i = 0; i < 3; i++)
      camera.lens.focus_point[i] = VL_UNSET;
  }
  json_t *object = camera_tree(context, &camera);
  if (!object || !put_optics(object, &camera)) {
    json_decref(object);
    return false;
  }
  return vl_receipt_put(tree, "camera", object);
}

static char *compact_text(vlContext *context, const json_t *tree) {
  return vl_json_text(context, tree, JSON_COMPACT | JSON_PRESERVE_ORDER, "");
}

/* Makes a receipt, which owns tree and text. Null: they could not be made, for lack of memory;
 * the other one is then freed. */
static vlResult receipt_of(vlContext *context, json_t *tree, char *text, vlReceipt **receipt,
                           vlError *error) {
  vlReceipt *made = tree && text ? vl_alloc_zero(context, 1, sizeof *made) : NULL;
  if (!made) {
    json_decref(tree);
    vl_free(context, text);
    return vl_fail_memory(error);
  }
  *made = (vlReceipt){context, tree, text};
  *receipt = made;
  return VL_OK;
}

vlResult vl_receipt_make(vlContext *context, const vlReceiptDef *def, vlReceipt **receipt,
                         vlError *error) {
  if (receipt)
    *receipt = NULL;
  if (!context || !def || !receipt || def->cookie != VL_COOKIE_RECEIPT || !def->defs)
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "receipt: context, def, def.defs or receipt is null, or def.cookie is not that of a "
        "default def of this version");
  json_t *tree = json_object();
  bool good =
      vl_receipt_put(tree, "velo_receipt", json_integer(VL_RECEIPT_FORMAT)) &&
      put_velo(tree, def->commit) &&
      put_strings(context, tree, "command", def->command, def->command_count) &&
      (!def->scene || vl_receipt_put(tree, "scene", json_of_text(context, def->scene))) &&
      put_files(context, tree, def->scene) && put_camera(context, tree, def) &&
      vl_receipt_put_settings(tree, def) &&
      put_strings(context, tree, "outputs", def->outputs, def->output_count);
  return receipt_of(context, tree, good ? compact_text(context, tree) : NULL, receipt, error);
}

/* ---- reading ----------------------------------------------------------------------------- */

vlResult vl_receipt_parse(vlContext *context, const char *text, size_t size,
                          vlReceipt **receipt, vlError *error) {
  if (receipt)
    *receipt = NULL;
  if (!context || !text || !receipt)
    return vl_fail_argument(error, "receipt: context, text or receipt is null");
  json_error_t wrong;
  json_t *tree = vl_json_parse(text, size, JSON_REJECT_DUPLICATES, &wrong);
  if (!tree && vl_json_lacks_memory(&wrong))
    return vl_fail_memory(error);
  if (!tree)
    return vl_fail(error, VL_ERROR_SCENE, "receipt: line %d: %s", wrong.line, wrong.text);
  const json_t *format = json_object_get(tree, "velo_receipt");
  bool later = json_is_integer(format) && json_integer_value(format) > VL_RECEIPT_FORMAT;
  if (!json_is_integer(format) || later || json_integer_value(format) < 1) {
    json_decref(tree);
    return later ? vl_fail(error, VL_ERROR_UNSUPPORTED,
                           "receipt: its format is of a later version of velo")
                 : vl_fail(error, VL_ERROR_SCENE,
                           "receipt: this is not a receipt: there is no \"velo_receipt\"");
  }
  char *copy = vl_alloc(context, size + 1);
  if (copy) {
    memcpy(copy, text, size);
    copy[size] = 0;
  }
  return receipt_of(context, tree, copy, receipt, error);
}

/* Replaces the word after --spp in the command, if it has that option. */
static bool put_command_samples(json_t *command, uint32_t samples) {
  char text[16];
  size_t index;
  json_t *word;
  snprintf(text, sizeof text, "%u", samples);
  json_array_foreach(command, index, word) {
    const char *string = json_string_value(word);
    if (vl_text_is(string, "--spp") && index + 1 < json_array_size(command))
      return json_array_set_new(command, index + 1, json_string(text)) == 0;
  }
  return true;
}

vlResult vl_receipt_of_image(const vlReceipt *film, uint32_t samples, vlReceipt **receipt,
                             vlError *error) {
  if (receipt)
    *receipt = NULL;
  if (!film || !receipt)
    return vl_fail_argument(error, "receipt: film or receipt is null");
  json_t *tree = json_deep_copy(film->tree), *render = json_object_get(tree, "render");
  bool good = tree && json_object_set_new(tree, "samples", json_integer(samples)) == 0 &&
              (!json_is_object(render) ||
               json_object_set_new(render, "spp", json_integer(samples)) == 0) &&
              put_command_samples(json_object_get(tree, "command"), samples);
  if (good)
    json_object_del(tree, "outputs");
  return receipt_of(film->context, tree, good ? compact_text(film->context, tree) : NULL,
                    receipt, error);
}

void vl_receipt_destroy(vlReceipt *receipt) {
  if (!receipt)
    return;
  json_decref(receipt->tree);
  VL_FREE(receipt->context, receipt->text, receipt);
}

const char *vl_receipt_text(const vlReceipt *receipt) {
  return receipt->text;
}

const char *vl_receipt_scene(const vlReceipt *receipt) {
  return json_string_value(json_object_get(receipt->tree, "scene"));
}

const char *vl_receipt_command(const vlReceipt *receipt, uint32_t index) {
  return json_string_value(json_array_get(json_object_get(receipt->tree, "command"), index));
}

const char *vl_receipt_output(const vlReceipt *receipt, uint32_t index) {
  return json_string_value(json_array_get(json_object_get(receipt->tree, "outputs"), index));
}

const char *vl_receipt_own(const vlReceipt *receipt, vlOwnKind kind) {
  static const char *const keys[VL_OWN_KINDS][2] = {
      {"camera", "own"}, {"render", "own_sampler"}, {"render", "own_tracer"}};
  if ((unsigned)kind >= VL_OWN_KINDS)
    return NULL;
  return json_string_value(
      json_object_get(json_object_get(receipt->tree, keys[kind][0]), keys[kind][1]));
}

/* Returns an integer from 0 to 2^32 - 1, or 0 if the value is anything else. */
static uint32_t count_of(const json_t *value) {
  json_int_t number = json_integer_value(value);
  return number >= 0 && number <= UINT32_MAX ? (uint32_t)number : 0;
}

uint32_t vl_receipt_samples(const vlReceipt *receipt, uint32_t *planned) {
  if (planned)
    *planned = count_of(json_object_get(json_object_get(receipt->tree, "render"), "spp"));
  return count_of(json_object_get(receipt->tree, "samples"));
}

double vl_receipt_noise(const vlReceipt *receipt) {
  const json_t *adaptive =
      json_object_get(json_object_get(receipt->tree, "render"), "adaptive");
  return json_number_value(json_object_get(adaptive, "noise"));
}

float vl_receipt_exposure(const vlReceipt *receipt) {
  const json_t *value = json_object_get(json_object_get(receipt->tree, "develop"), "exposure");
  return json_is_number(value) ? (float)json_number_value(value) : 1.0f;
}

/* The value of a hexadecimal digit; 0 of any other character. */
static int hex_digit(char c) {
  if (c >= '0' && c <= '9')
    return c - '0';
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : 0;
}

const vlFileRecord *vl_receipt_file(const vlReceipt *receipt, uint32_t index,
                                    vlFileRecord *record) {
  const json_t *file = json_array_get(json_object_get(receipt->tree, "files"), index);
  const char *path = json_string_value(json_object_get(file, "path"));
  const char *digest = json_string_value(json_object_get(file, "murmur3"));
  if (!path || !digest || strlen(digest) != 32)
    return NULL;
  json_int_t size = json_integer_value(json_object_get(file, "size"));
  *record = (vlFileRecord){.path = path, .size = size > 0 ? (uint64_t)size : 0};
  for (int i = 0; i < 16; i++)
    record->digest[i] = (uint8_t)(16 * hex_digit(digest[2 * i]) + hex_digit(digest[2 * i + 1]));
  return record;
}

const char *vl_receipt_version(const vlReceipt *receipt, const char **commit) {
  const json_t *velo = json_object_get(receipt->tree, "velo");
  const char *version = json_string_value(json_object_get(velo, "version"));
  const char *from = json_string_value(json_object_get(velo, "commit"));
  if (commit)
    *commit = from ? from : "";
  return version ? version : "";
}

vlResult vl_receipt_camera(const vlReceipt *receipt, vlCameraDef *camera, uint32_t size[2],
                           uint32_t crop[4], vlError *error) {
  const json_t *film = json_object_get(receipt->tree, "film"),
               *tree = json_object_get(receipt->tree, "camera");
  if (!json_is_object(tree) || !json_is_object(film))
    return vl_fail(error, VL_ERROR_SCENE, "receipt: there is no camera");
  if (json_object_get(tree, "optics_digest") || json_object_get(tree, "aperture_digest"))
    return vl_fail(error, VL_ERROR_UNSUPPORTED,
                   "receipt: it does not hold the camera's lens, the scene does");
  const char *own = vl_receipt_own(receipt, VL_OWN_CAMERA);
  if (own)
    return vl_fail(error, VL_ERROR_UNSUPPORTED,
                   "receipt: it does not hold the own camera \"%s\", only its name",
                   vl_short_text(own).text);
  uint32_t window[4], whole[2] = {count_of(json_object_get(film, "width")),
                                  count_of(json_object_get(film, "height"))};
  for (size_t i = 0; i < 4; i++)
    window[i] = count_of(json_array_get(json_object_get(film, "crop"), i));
  if (!(window[0] < window[2] && window[1] < window[3] && window[2] <= whole[0] &&
        window[3] <= whole[1]))
    return vl_fail(error, VL_ERROR_SCENE, "receipt: the size of its image is wrong");
  vlCameraFileDef def = vl_default_camera_file_def();
  vlCameraFile file = {.context = receipt->context,
                       .path = "receipt",
                       .dialect = "velo",
                       .def = &def,
                       .error = error};
  vlCameraRecord record = {.camera = vl_default_camera_def(1, 1), .frames = 1};
  VL_TRY(vl_camera_read_velo(&file, tree, &record));
  *camera = record.camera;
  if (size)
    memcpy(size, whole, sizeof whole);
  if (crop)
    memcpy(crop, window, sizeof window);
  return VL_OK;
}
