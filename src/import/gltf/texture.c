/* import/gltf/texture.c: textureInfo objects become textures of the scene: image, sampler, uv
 * set, KHR_texture_transform. Images are not decoded here; the scene keeps their bytes or
 * paths. */
#include <stdio.h>

#include "base/file.h"
#include "base/text.h"
#include "image/image.h"
#include "import/gltf/gltf.h"

#include "math/elementary.h"
#include "velo/texture.h"

vlGltfTextureUse vl_gltf_use_color(void) {
  return (vlGltfTextureUse){
      .spectrum = true, .channel = -1, .srgb = true, .tint = {1, 1, 1, 1}, .cutoff = VL_UNSET};
}

vlGltfTextureUse vl_gltf_use_channel(int channel, float factor) {
  vlGltfTextureUse use = {.channel = channel, .tint = {1, 1, 1, 1}, .cutoff = VL_UNSET};
  use.tint[channel] = factor;
  return use;
}

static bool is_remote(const char *uri) {
  return strncmp(uri, "data:", 5) != 0 && strncmp(uri, "file://", 7) != 0 && strstr(uri, "://");
}

/* Reports a missing image: as an error if strict. */
static bool report_missing(vlGltf *g, const vlGltfLocation *at, vlGltfImage *image,
                           const char *message) {
  char text[512];
  snprintf(text, sizeof text, "%.480s", message);
  vl_make_printable(text);
  if (g->def->strict)
    return vl_gltf_fail_code(VL_ERROR_MISSING, VL_GLTF_KEY(at, "uri"), "%s", text);
  vl_gltf_warn_missing(VL_GLTF_KEY(at, "uri"), "%s; done without", text);
  g->repairs.images++;
  return image->read = image->missing = true;
}

/* Copies an image's encoded bytes for the scene, once for all of its textures: the bytes of the
 * file are freed when it is read. */
static bool keep_image(vlGltf *g, vlGltfImage *image) {
  static const uint8_t none[1] = {0};
  if (image->kept || image->path)
    return true;
  image->kept = true;
  if (!image->size) {
    image->data = none; /* the reader of images refuses it */
    return true;
  }
  return vl_scene_copy_block(g->scene, image->data, image->size, 1, &image->data);
}

bool vl_gltf_decode_image(vlGltf *g, const vlGltfLocation *at, const char *name,
                          const void *data, size_t size, const char *path, vlImage **image) {
  vlError error;
  vl_error_clear(&error);
  vlResult r = path ? vl_image_read_named(g->context, NULL, path, image, &error)
                    : vl_image_read_memory(g->context, name, data, size, image, &error);
  return r == VL_OK || vl_gltf_fail_code(r, at, "%s", error.message);
}

bool vl_gltf_read_image(vlGltf *g, size_t index) {
  vlGltfImage *image = &g->images[index];
  if (image->read)
    return true;
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "images", index);
  const char *uri = NULL;
  size_t view;
  if (!vl_gltf_text(at, "uri", &uri) || !vl_gltf_index(at, "bufferView", g->view_count, &view))
    return false;
  if (uri) {
    vlError missing;
    if (is_remote(uri)) {
      vl_fail(&missing, VL_ERROR_MISSING, "velo fetches nothing from the net: %.400s", uri);
      return report_missing(g, at, image, missing.message);
    }
    if (!vl_gltf_uri(g, VL_GLTF_KEY(at, "uri"), uri, &image->data, &image->size, &image->path))
      return false;
    if (image->path && vl_context_allows(g->context, image->path) &&
        vl_file_check(g->context, image->path, &missing) == VL_ERROR_MISSING)
      return report_missing(g, at, image, missing.message);
  } else if (view != VL_GLTF_NONE) {
    if (!g->views[view].data)
      return vl_gltf_fail(at, "its bufferView holds nothing that velo can read");
    image->data = g->views[view].data;
    image->size = g->views[view].size;
  } else {
    return vl_gltf_fail(at, "has neither uri nor bufferView");
  }
  image->read = true;
  return true;
}

/* The image of a texture; extensions may replace it by an image of another format. *image is
 * -1, with the result true, when the texture has no image; a warning was then given. */
static bool choose_image(vlGltf *g, size_t texture, size_t *image) {
  static const char *const others[] = {"KHR_texture_basisu", "MSFT_texture_dds",
                                       "EXT_texture_avif"};
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "textures", texture);
  if (!vl_gltf_index(VL_GLTF_KEY(at, "extensions.EXT_texture_webp"), "source", g->image_count,
                     image))
    return false;
  if (*image != VL_GLTF_NONE)
    return true;
  if (!vl_gltf_index(at, "source", g->image_count, image))
    return false;
  if (*image != VL_GLTF_NONE)
    return true;
  for (size_t i = 0; i < VL_LENGTH(others); i++)
    if (vl_gltf_extension(vl_gltf_json(at), others[i]))
      return vl_gltf_fail_code(VL_ERROR_UNSUPPORTED, at,
                               "its image is there by %s only, which velo does not read",
                               others[i]);
  vl_gltf_warn(VL_LOG_WARNING, at, "has no image");
  return true;
}

static vlWrap wrap_of(double code) {
  return code == 33071 ? VL_WRAP_CLAMP : code == 33648 ? VL_WRAP_MIRROR : VL_WRAP_REPEAT;
}

static bool read_sampler(vlGltf *g, size_t texture, vlTextureDef *def) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "textures", texture);
  size_t index;
  if (!vl_gltf_index(at, "sampler", g->sampler_count, &index))
    return false;
  const vlGltfLocation *here =
      VL_GLTF_ROOT(g, "samplers", index == VL_GLTF_NONE ? g->sampler_count : index);
  double s = 10497, t = 10497, large = 9729;
  if (!vl_gltf_number(here, "wrapS", &s) || !vl_gltf_number(here, "wrapT", &t) ||
      !vl_gltf_number(here, "magFilter", &large))
    return false;
  def->wrap = wrap_of(s);
  def->wrap_t = wrap_of(t);
  def->wrap_t_given = true;
  def->filter = large == 9728 ? VL_FILTER_POINT : VL_FILTER_TRILINEAR;
  return true;
}

bool vl_gltf_texture_set(vlGltf *g, const vlGltfLocation *at, uint32_t *set) {
  size_t value = 0;
  const json_t *transform = vl_gltf_extension(vl_gltf_json(at), "KHR_texture_transform");
  if (!vl_gltf_size(at, "texCoord", &value) ||
      !vl_gltf_size_in(at, transform, "texCoord", &value))
    return false;
  if (value > 3) {
    if (vl_gltf_once(g, VL_GLTF_REPORTED_SETS))
      vl_gltf_warn(VL_LOG_WARNING, at, "uv set %zu: velo keeps sets 0 to 3; set 0 is taken",
                   value);
    value = 0;
  }
  *set = (uint32_t)value;
  return true;
}

/* KHR_texture_transform maps uvs with v downwards; here v points upwards before and after. */
static bool read_transform(const vlGltfLocation *up, vlTextureDef *def) {
  const vlGltfLocation *at = VL_GLTF_KEY(up, "extensions.KHR_texture_transform");
  if (!json_is_object(vl_gltf_json(at)))
    return true;
  double offset[2] = {0, 0}, scale[2] = {1, 1}, rotation = 0;
  if (!vl_gltf_numbers(at, "offset", 2, offset) || !vl_gltf_numbers(at, "scale", 2, scale) ||
      !vl_gltf_number(at, "rotation", &rotation))
    return false;
  double c = vl_precise_cos(rotation), s = vl_precise_sin(rotation);
  double m[6] = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
  const double flipped[6] = {m[0], -m[1], m[1] + m[2], -m[3], m[4], 1 - m[4] - m[5]};
  def->st_from_uv_given = true;
  for (int i = 0; i < 6; i++)
    def->st_from_uv[i] = (float)flipped[i];
  return true;
}

bool vl_gltf_texture(const vlGltfLocation *up, const char *key, const vlGltfTextureUse *use,
                     vlTextureId *id) {
  vlGltf *g = vl_gltf_of(up);
  const json_t *info;
  const vlGltfLocation *at = VL_GLTF_KEY(up, key);
  size_t texture, image;
  *id = (vlTextureId){0};
  if (!vl_gltf_object(up, key, &info))
    return false;
  if (!info)
    return true;
  if (!vl_gltf_need_index(at, "index", g->texture_count, &texture))
    return false;
  if (!choose_image(g, texture, &image))
    return false;
  if (image == VL_GLTF_NONE)
    return true;
  if (!vl_gltf_read_image(g, image))
    return false;
  if (g->images[image].missing)
    return true;
  if (!keep_image(g, &g->images[image]))
    return false;
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, use->spectrum);
  char name[64];
  snprintf(name, sizeof name, "images[%zu]", image);
  def.name = name;
  def.source.file = g->path;
  def.path = g->images[image].path;
  def.data = def.path ? NULL : g->images[image].data;
  def.data_size = g->images[image].size;
  if (!read_sampler(g, texture, &def) || !vl_gltf_texture_set(g, at, &def.uv_set) ||
      !read_transform(at, &def))
    return false;
  def.encoding_given = !use->srgb;
  def.encoding = VL_ENCODING_LINEAR;
  def.channel = use->channel;
  def.colors = use->colors;
  def.bias = use->bias;
  def.cutoff = use->cutoff;
  memcpy(def.tint, use->tint, sizeof def.tint);
  *id = vl_scene_adopt_texture(g->scene, &def);
  return id->index != 0;
}
