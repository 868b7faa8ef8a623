/* import/gltf/volume.c: the medium behind a surface (KHR_materials_volume), and images that are
 * converted before they become textures. */
#include <math.h>

#include "image/image.h"
#include "import/gltf/gltf.h"
#include "math/approx_double.h"
#include "math/elementary.h"
#include "velo/medium.h"
#include "velo/texture.h"

/* White light takes on `attenuationColor` after `attenuationDistance`: sigma_a = -ln(colour) /
 * distance per channel. */
bool vl_gltf_volume(vlGltf *g, const vlGltfLocation *at, vlGltfMaterial *result) {
  double distance = INFINITY, color[3] = {1, 1, 1}, max = 0;
  float sigma[3];
  if (!vl_gltf_number(at, "attenuationDistance", &distance) ||
      !vl_gltf_numbers(at, "attenuationColor", 3, color))
    return false;
  if (!(distance > 0))
    return vl_gltf_fail_key(at, "attenuationDistance", "must be above 0");
  for (int i = 0; i < 3; i++) {
    double c = color[i] > 1e-4 ? color[i] < 1 ? color[i] : 1 : 1e-4;
    sigma[i] = (float)(-vl_precise_log(c) / distance);
    max = sigma[i] > max ? sigma[i] : max;
  }
  if (!(max > 0))
    return true;
  vlMediumDef def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  def.source.file = g->path;
  def.sigma_a = vl_spectrum_rgb(sigma[0], sigma[1], sigma[2]);
  def.sigma_s = vl_spectrum_constant(0.0f);
  def.rgb_absorption = true;
  result->inside = vl_scene_add_medium(g->scene, &def);
  return result->inside.index != 0;
}

/* ---- anisotropy -------------------------------------------------------------------------- */

/* Converts a texture whose red and green channels are the tangent's direction to one of its
 * angle. Angles that differ by pi are equivalent, but their mean is meaningless: the new
 * texture is not filtered. */
bool vl_gltf_angle_texture(vlGltf *g, vlTextureId from, float rotation, vlFloatInput *input) {
  vlTextureDef def = g->scene->textures.items[from.index - 1];
  vlImage *image = NULL, *angles = NULL;
  if (!vl_gltf_decode_image(g, &g->top, def.name, def.data, def.data_size,
                            def.data ? NULL : def.path, &image))
    return false;
  bool ok = image->channels >= 3 || vl_gltf_fail(&g->top, "%s: has no directions", def.name);
  if (ok) {
    vlImageDef form = vl_default_image_def(image->width, image->height, 1);
    form.type = VL_PIXEL_F32;
    ok = vl_image_create(g->context, &form, &angles) == VL_OK || vl_gltf_fail_memory(g);
  }
  uint32_t channel[4];
  float *row = ok ? vl_alloc_array(g->context, image->width, 3 * sizeof *row) : NULL;
  ok = ok && (row || vl_gltf_fail_memory(g)) && vl_image_color(image, channel) >= 3;
  if (ok)
    image->encoding = VL_ENCODING_LINEAR;
  for (uint32_t y = 0; ok && y < image->height; y++) {
    float *to = vl_image_row(angles, y);
    vl_image_row_to_float(image, y, channel, 3, row);
    for (uint32_t x = 0; x < image->width; x++) {
      float a = (float)vl_atan2_double(2 * row[3 * x + 1] - 1, 2 * row[3 * x] - 1) + rotation;
      to[x] = a - floorf(a / 3.14159265f) * 3.14159265f; /* images hold no negative numbers */
    }
  }
  if (ok) {
    def.data = NULL;
    def.path = NULL;
    def.image = angles;
    def.filter = VL_FILTER_POINT;
    def.channel = -1;
    def.tint[0] = def.tint[1] = def.tint[2] = 1;
    def.encoding_given = false;
    input->texture = vl_scene_add_texture(g->scene, &def);
    ok = input->texture.index != 0;
  }
  vl_free(g->context, row);
  vl_image_destroy(angles);
  vl_image_destroy(image);
  return ok;
}
