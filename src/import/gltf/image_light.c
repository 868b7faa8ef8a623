/* import/gltf/image_light.c: EXT_lights_image_based. The largest cube map of the light's
 * specular images becomes the environment. The prefiltered smaller ones and the irradiance
 * coefficients are not read. Images with four channels are RGBD: radiance = linear colour /
 * fourth channel. */
#include <math.h>
#include <string.h>

#include "image/image.h"
#include "import/gltf/gltf.h"
#include "math/cube_map.h"
#include "math/octahedral.h"
#include "velo/light.h"

typedef struct Cube {
  uint32_t side[6];
  float *faces[6]; /* 3 per texel, rows from the top */
} Cube;

static bool read_face(vlGltf *g, const vlGltfLocation *at, size_t index, Cube *cube, int face) {
  if (!vl_gltf_read_image(g, index))
    return false;
  const vlGltfImage *file = &g->images[index];
  if (file->missing)
    return true; /* reported */
  vlImage *image = NULL;
  if (!vl_gltf_decode_image(g, at, "image", file->data, file->size, file->path, &image))
    return false;
  uint32_t channel[4], count = vl_image_color(image, channel);
  float *pixels = NULL;
  bool ok = count >= 3 && image->width == image->height;
  if (!ok)
    vl_gltf_fail(at, "images[%zu]: a face of a cube must be square and in colour", index);
  if (ok && vl_image_to_float(image, channel, count, &pixels) != VL_OK)
    ok = vl_gltf_fail_memory(g);
  size_t texels = (size_t)image->width * image->height;
  for (size_t i = 0; ok && i < texels; i++) {
    float d = count == 4 ? pixels[4 * i + 3] : 1.0f;
    for (size_t c = 0; c < 3; c++)
      pixels[3 * i + c] = d > 0 ? pixels[count * i + c] / d : 0.0f;
  }
  cube->side[face] = image->width;
  cube->faces[face] = pixels;
  vl_image_destroy(image);
  return ok;
}

/* Radiance from direction d, interpolated bilinearly within one face. The faces have the order
 * and axes of OpenGL's cube maps. */
static void look(const Cube *cube, vlVec3 d, float out[3]) {
  float s, t;
  const uint32_t face = vl_cube_map_face(d, &s, &t);
  int n = (int)cube->side[face];
  float u = (s + 1) * 0.5f * (float)n - 0.5f, v = (t + 1) * 0.5f * (float)n - 0.5f;
  int i = (int)floorf(u), j = (int)floorf(v);
  float fu = u - (float)i, fv = v - (float)j;
  out[0] = out[1] = out[2] = 0;
  for (int k = 0; k < 4; k++) {
    int a = i + (k & 1), b = j + (k >> 1);
    a = a < 0 ? 0 : a >= n ? n - 1 : a;
    b = b < 0 ? 0 : b >= n ? n - 1 : b;
    float w = (k & 1 ? fu : 1 - fu) * (k >> 1 ? fv : 1 - fv);
    const float *p = cube->faces[face] + 3 * ((size_t)b * (size_t)n + (size_t)a);
    for (int c = 0; c < 3; c++)
      out[c] += w * p[c];
  }
}

static bool add_cube(vlGltf *g, const Cube *cube, const double rotation[4], double intensity) {
  uint32_t side = (uint32_t)(2.45 * cube->side[0]); /* about as many texels as the cube map */
  vlImageDef def = vl_default_image_def(side < 16 ? 16 : side > 2048 ? 2048 : side, 0, 3);
  def.height = def.width;
  def.type = VL_PIXEL_F32;
  vlImage *image;
  if (vl_image_create(g->context, &def, &image) != VL_OK)
    return vl_gltf_fail_memory(g);
  for (uint32_t y = 0; y < def.height; y++) {
    float *row = vl_image_row(image, y);
    for (uint32_t x = 0; x < def.width; x++)
      look(cube,
           vl_octahedral_decode(((float)x + 0.5f) / (float)def.width,
                                ((float)y + 0.5f) / (float)def.height),
           row + 3 * (size_t)x);
  }
  const double zero[3] = {0, 0, 0}, one[3] = {1, 1, 1};
  vlMat4 world = vl_gltf_matrix_from_trs(zero, rotation, one);
  vlLightDef light = vl_default_light_def(VL_LIGHT_INFINITE);
  light.source.file = g->path;
  memcpy(light.world_from_light, world.m, sizeof light.world_from_light);
  light.scale = (float)intensity;
  light.image = image;
  bool ok = vl_scene_add_light(g->scene, &light).index != 0;
  vl_image_destroy(image);
  if (ok)
    vl_scene_defs(g->scene)->light_missing = false;
  return ok;
}

bool vl_gltf_image_light(vlGltf *g, const json_t *scene, const vlGltfLocation *scene_at) {
  const json_t *own = vl_gltf_extension(scene, "EXT_lights_image_based"), *lights, *levels;
  if (!own)
    return true;
  const vlGltfLocation *up = VL_GLTF_KEY(&g->top, "extensions.EXT_lights_image_based");
  size_t count, level_count;
  size_t index;
  if (!vl_gltf_array(up, "lights", &lights, &count) ||
      !vl_gltf_index(VL_GLTF_KEY(scene_at, "extensions.EXT_lights_image_based"), "light", count,
                     &index))
    return false;
  if (index == VL_GLTF_NONE)
    return true;
  const vlGltfLocation *at = VL_GLTF_ITEM(up, "lights", index),
                       *at_images = VL_GLTF_KEY(at, "specularImages");
  const json_t *json = json_array_get(lights, index);
  double rotation[4] = {0, 0, 0, 1}, intensity = 1;
  if (!json_is_object(json))
    return vl_gltf_fail(at, "must be an object");
  if (!vl_gltf_numbers(at, "rotation", 4, rotation) ||
      !vl_gltf_number(at, "intensity", &intensity) ||
      !vl_gltf_array(at, "specularImages", &levels, &level_count))
    return false;
  const json_t *faces = json_array_get(levels, 0);
  if (json_array_size(faces) != 6)
    return vl_gltf_fail(at_images, "must hold six faces for each level");
  if (!(intensity >= 0))
    return vl_gltf_fail_key(at, "intensity", "must not be negative");
  Cube cube = {{0}, {NULL}};
  bool ok = true;
  for (int k = 0; ok && k < 6; k++) {
    size_t image;
    ok = vl_gltf_element(VL_GLTF_ITEM(at_images, "[0]", (size_t)k),
                         json_array_get(faces, (size_t)k), g->image_count, "image", &image) &&
         read_face(g, at_images, image, &cube, k);
  }
  bool whole = true;
  for (int k = 0; k < 6; k++)
    whole = whole && cube.faces[k];
  if (ok && whole && intensity > 0)
    ok = add_cube(g, &cube, rotation, intensity);
  for (int k = 0; k < 6; k++)
    vl_free(g->context, cube.faces[k]);
  return ok;
}
