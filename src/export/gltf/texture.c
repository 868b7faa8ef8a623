/* export/gltf/texture.c: images, samplers and textures of a glTF file, each written once. */
#include <math.h>
#include <stdio.h>

#include "export/image.h"

#include "base/text.h"
#include "math/elementary.h"

json_int_t vl_gltf_put_file(vlExport *x, const char *bytes, size_t size, const char *suffix) {
  char name[300];
  json_t *image = json_object();
  if (x->binary) {
    json_object_set_new(image, "bufferView", json_integer(vl_gltf_put_view(x, bytes, size, 0)));
    json_object_set_new(image, "mimeType",
                        json_string(vl_text_is(suffix, ".png") ? "image/png" : "image/jpeg"));
  } else {
    char uri[900], *to = uri;
    snprintf(name, sizeof name, "%.200s-%zu%s", x->stem,
             json_array_size(json_object_get(x->root, "images")), suffix);
    if (!vl_export_data(x, name, bytes, size)) {
      json_decref(image);
      return -1;
    }
    /* escapes blanks and other characters not allowed in uris */
    for (const char *p = name; *p; p++) {
      bool plain = (*p >= 'a' && *p <= 'z') || (*p >= 'A' && *p <= 'Z') ||
                   (*p >= '0' && *p <= '9') || strchr("-._~", *p);
      to += plain ? (*to = *p, 1) : snprintf(to, 4, "%%%02X", (unsigned char)*p);
    }
    *to = 0;
    json_object_set_new(image, "uri", json_string(uri));
  }
  return vl_gltf_put(x, "images", image);
}

/* Variants of an image: its numbers, its colours in sRGB, its own bytes, which serve as both.
 */
enum { NUMBERS, COLORS, KEPT };

/* Index of the image in "images"; -1 after an error. */
static json_int_t put_image(vlExport *x, const vlTextureDef *t) {
  const bool srgb = t->spectrum;
  vlExportImage *image = vl_export_find_image(x, t, KEPT);
  bool kept = image != NULL;
  if (!image)
    image = vl_export_find_image(x, t, srgb ? COLORS : NUMBERS);
  if (!image) {
    char *bytes;
    const char *suffix;
    size_t size;
    if (!vl_export_image(x, t, srgb, &bytes, &size, &suffix, &kept))
      return -1;
    const json_int_t index = vl_gltf_put_file(x, bytes, size, suffix);
    vl_free(x->context, bytes);
    image = index < 0 ? NULL : vl_export_add_image(x, t, kept ? KEPT : srgb ? COLORS : NUMBERS);
    if (!image)
      return -1;
    image->index = index;
  }
  if (kept && srgb && t->space != VL_SPACE_SRGB)
    vl_export_lose(x, "colour spaces that images do not name themselves: sRGB");
  return image->index;
}

static json_int_t put_once(vlExport *x, const char *key, json_t *value) {
  json_t *array = json_object_get(x->root, key);
  for (size_t i = 0; i < json_array_size(array); i++)
    if (json_equal(json_array_get(array, i), value)) {
      json_decref(value);
      return (json_int_t)i;
    }
  return vl_gltf_put(x, key, value);
}

static int wrap_code(vlExport *x, vlWrap wrap) {
  if (wrap == VL_WRAP_BLACK || wrap == VL_WRAP_OCTAHEDRAL)
    vl_export_lose(x, "images that end in black: clamped");
  return wrap == VL_WRAP_REPEAT ? 10497 : wrap == VL_WRAP_MIRROR ? 33648 : 33071;
}

/* KHR_texture_transform, unless it is the identity. Velo's v points upwards, glTF's
 * downwards. */
static void put_transform(vlExport *x, json_t *info, const vlTextureDef *t) {
  double m[6];
  vl_export_st_from_uv(t, m);
  const double g[6] = {m[0], -m[1], m[1] + m[2], -m[3], m[4], 1 - m[4] - m[5]};
  if (g[0] == 1 && g[1] == 0 && g[2] == 0 && g[3] == 0 && g[4] == 1 && g[5] == 0)
    return;
  double sx = vl_precise_hypot(g[0], g[3]), c = sx > 0 ? g[0] / sx : 1,
         s = sx > 0 ? -g[3] / sx : 0, sy = c * g[4] + s * g[1];
  if (fabs(g[1] - s * sy) > 1e-5 * (1 + fabs(sy)) ||
      fabs(g[4] - c * sy) > 1e-5 * (1 + fabs(sy)))
    vl_export_lose(x, "maps of textures that shear: rotation and scale alone");
  json_t *transform = json_pack("{s:[f,f],s:[f,f]}", "offset", g[2], g[5], "scale", sx, sy);
  if (s != 0 || c < 0)
    json_object_set_new(transform, "rotation", json_real(vl_precise_atan2(s, c)));
  json_object_set_new(info, "extensions",
                      json_pack("{s:o}", "KHR_texture_transform", transform));
  vl_gltf_use(x, "KHR_texture_transform");
}

/* Alpha has no curve. */
static bool is_alpha(const vlTextureDef *t) {
  return !t->spectrum && t->channel == 3;
}

json_t *vl_gltf_texture_info(vlExport *x, const vlTextureDef *t, bool linear) {
  if (t->mapping != VL_MAPPING_UV) {
    vl_export_lose(x, "textures mapped other than by uv: left out");
    return NULL;
  }
  const vlEncoding curve = t->encoding_given ? t->encoding : VL_ENCODING_SRGB;
  if (curve != (linear ? VL_ENCODING_LINEAR : VL_ENCODING_SRGB) && !is_alpha(t))
    vl_export_lose(x, "images whose curve is not the one that glTF expects");
  json_int_t image = put_image(x, t);
  if (image < 0) {
    vl_export_lose(x, "images that cannot be read: left out");
    if (x->result != VL_ERROR_MEMORY && x->result != VL_ERROR_IO)
      x->result = VL_OK;
    return NULL;
  }
  bool nearest = t->filter == VL_FILTER_POINT;
  json_t *sampler =
      json_pack("{s:i,s:i,s:i,s:i}", "magFilter", nearest ? 9728 : 9729, "minFilter",
                nearest ? 9728 : 9987, "wrapS", wrap_code(x, t->wrap), "wrapT",
                wrap_code(x, vl_export_wrap_t(t)));
  json_int_t s = put_once(x, "samplers", sampler);
  json_int_t index =
      put_once(x, "textures", json_pack("{s:I,s:I}", "source", image, "sampler", s));
  json_t *info = json_pack("{s:I}", "index", index);
  if (t->uv_set)
    json_object_set_new(info, "texCoord", json_integer((json_int_t)t->uv_set));
  put_transform(x, info, t);
  return info;
}
