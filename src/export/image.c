/* export/image.c: images of textures, as the exporters write them: which an input has, where it
 * lies, its bytes. */
#include "export/image.h"

#include "base/text.h"
#include "color/color.h"
#include "image/image.h"

const vlTextureDef *vl_export_texture(const vlExport *x, vlTextureId id) {
  const vlTextureDef *t = vl_scene_texture(x->scene, id);
  return t && t->kind == VL_TEXTURE_IMAGE ? t : NULL;
}

vlWrap vl_export_wrap_t(const vlTextureDef *t) {
  return t->wrap_t_given ? t->wrap_t : t->wrap;
}

void vl_export_st_from_uv(const vlTextureDef *t, double m[6]) {
  const double plain[6] = {t->su, 0, t->du, 0, t->sv, t->dv};
  for (int i = 0; i < 6; i++)
    m[i] = t->st_from_uv_given ? t->st_from_uv[i] : plain[i];
}

static const void *data_of(const vlTextureDef *t) {
  return t->data ? t->data : (const void *)t->image;
}

vlExportImage *vl_export_find_image(vlExport *x, const vlTextureDef *t, uint32_t variant) {
  const void *data = data_of(t);
  VL_EACH_ITEM(vlExportImage, p, &x->images) {
    if (p->variant == variant && p->data == data &&
        (data || (p->path && t->path && vl_text_is(p->path, t->path))))
      return p;
  }
  return NULL;
}

vlExportImage *vl_export_add_image(vlExport *x, const vlTextureDef *t, uint32_t variant) {
  const void *data = data_of(t);
  vlExportImage *slot = VL_PUSH(x->context, &x->images);
  if (slot)
    *slot = (vlExportImage){.data = data, .path = data ? NULL : t->path, .variant = variant};
  else
    vl_export_no_memory(x);
  return slot;
}

const vlImage *vl_export_pixels(vlExport *x, const vlTextureDef *t, vlImage **own) {
  *own = NULL;
  if (t->image)
    return t->image;
  vlError error = {0};
  vlResult r = t->data ? vl_image_read_memory(x->context, t->name ? t->name : "image", t->data,
                                              t->data_size, own, &error)
                       : vl_image_read_named(x->context, NULL, t->path, own, &error);
  /* the scene's image is at fault, not the file that is written: the error is at the image */
  if (r != VL_OK && x->result == VL_OK)
    x->result = vl_fail_source(x->error, r, t->source, "%s", error.message);
  return *own;
}

/* The suffix of an image that both formats can hold as it is; null: another kind. */
static const char *suffix_of(const char *data, size_t size) {
  if (size > 8 && memcmp(data, "\x89PNG\r\n\x1a\n", 8) == 0)
    return ".png";
  if (size > 3 && memcmp(data, "\xff\xd8\xff", 3) == 0)
    return ".jpg";
  return NULL;
}

/* A copy of an image with three or four channels whose colours are converted; null: no memory,
 * which the export knows. */
static vlImage *convert_colors(vlExport *x, const vlImage *image, const vlSrgbMap *map) {
  uint32_t channel[4], count = vl_image_color(image, channel);
  vlImageDef def = vl_default_image_def(image->width, image->height, count);
  def.type = VL_PIXEL_F32;
  vlImage *made = NULL;
  if (vl_image_create(x->context, &def, &made) != VL_OK) {
    vl_export_no_memory(x);
    return NULL;
  }
  for (uint32_t y = 0; y < image->height; y++) {
    float *row = vl_image_row(made, y);
    vl_image_row_to_float(image, y, channel, count, row);
    for (size_t i = 0; i < image->width; i++)
      vl_store3(row + count * i, vl_to_srgb(map, vl_load3(row + count * i)));
  }
  return made;
}

/* Encodes the image of a texture as PNG. srgb: colours of other spaces are converted. */
static bool pack_png(vlExport *x, const vlTextureDef *t, const vlImage *image, bool srgb,
                     char **data, size_t *size) {
  uint32_t channel[4];
  vlColorSpace space = t->space;
  vl_image_space(image, &space);
  const vlSrgbMap map = vl_srgb_map(space, VL_ROLE_ALBEDO);
  if (!srgb || !map.needed || vl_image_color(image, channel) < 3)
    return vl_export_pack(x, image, ".png", data, size);
  vlImage *made = convert_colors(x, image, &map);
  const bool fine = made && vl_export_pack(x, made, ".png", data, size);
  vl_image_destroy(made);
  return fine;
}

bool vl_export_image(vlExport *x, const vlTextureDef *t, bool srgb, char **data, size_t *size,
                     const char **suffix, bool *kept) {
  *data = NULL;
  if (t->data) {
    *data = vl_export_alloc(x, t->data_size + 1, 1);
    if (!*data)
      return false;
    memcpy(*data, t->data, t->data_size);
    *size = t->data_size;
  } else if (t->path && !vl_export_read(x, t->path, data, size)) {
    return false;
  }
  *suffix = *data ? suffix_of(*data, *size) : NULL;
  *kept = *suffix != NULL;
  if (*kept)
    return true;
  vl_free(x->context, *data);
  *data = NULL;
  *suffix = ".png";
  vl_export_lose(x, "image of a kind other than PNG and JPEG: packed as PNG, 0 to 1 only");
  vlImage *own;
  const vlImage *image = vl_export_pixels(x, t, &own);
  bool fine = image && pack_png(x, t, image, srgb, data, size);
  vl_image_destroy(own);
  return fine;
}
