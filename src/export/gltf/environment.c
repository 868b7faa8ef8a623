/* export/gltf/environment.c: infinite lights as EXT_lights_image_based. The sum of all infinite
 * lights becomes one cube map whose axes are glTF's world; smaller levels are filtered by GGX's
 * lobes for roughness up to 1; the irradiance has nine coefficients of spherical harmonics.
 * Faces are PNG of 16 bits, RGBD: radiance = linear colour / D. D is a multiple of 1/255, so a
 * reader of 8 bits sees the same D. */
#include <math.h>

#include "color/color.h"
#include "export/export.h"
#include "image/mipmap.h"
#include "image/pixel.h"
#include "math/cube_map.h"
#include "math/lowdiscrepancy.h"
#include "math/octahedral.h"
#include "velo/light.h"

enum { MIN_SIDE = 16, MAX_SIDE = 1024, LEVELS = 7, LOBE_SAMPLES = 128 };

typedef struct Sky {
  vlMipmap *map; /* null: uniform */
  float rgb[3];  /* uniform: the radiance */
  vlSrgbMap to_srgb;
  float light_from_world[9], scale;
} Sky;

typedef struct Level {
  uint32_t side;
  float *texels; /* six faces, rows from the top, 3 values per texel */
} Level;

typedef struct Cube {
  vlExport *x;
  VL_ARRAY(Sky) skies;
  bool mirror;
  uint32_t levels;
  /* means of four texels; filtered for a roughness. lobes[0] is plain[0] */
  Level plain[LEVELS], lobes[LEVELS];
  uint32_t level; /* the level that rows are made of */
} Cube;

/* ---- what a direction sees --------------------------------------------------------------- */

/* Radiance of an octahedral map, interpolated bilinearly. Beyond an edge of the square lies the
 * edge's other half. */
static void look_octahedral(const vlMipmap *map, vlVec3 d, float out[3]) {
  const int n = (int)map->levels[0].width;
  vlVec2 st = vl_octahedral_encode(d);
  float u = st.x * (float)n - 0.5f, v = st.y * (float)n - 0.5f;
  int i = (int)floorf(u), j = (int)floorf(v);
  float fu = u - (float)i, fv = v - (float)j;
  out[0] = out[1] = out[2] = 0;
  for (int k = 0; k < 4; k++) {
    int a = i + (k & 1), b = j + (k >> 1);
    if (a < 0 || a >= n) {
      a = a < 0 ? 0 : n - 1;
      b = n - 1 - b;
    }
    if (b < 0 || b >= n) {
      b = b < 0 ? 0 : n - 1;
      a = n - 1 - a;
    }
    float w = (k & 1 ? fu : 1 - fu) * (k >> 1 ? fv : 1 - fv);
    for (uint32_t c = 0; c < 3; c++)
      out[c] += w * vl_mip_texel(map, 0, (uint32_t)a, (uint32_t)b, map->channels < 3 ? 0 : c);
  }
}

static void radiance(const Cube *cube, vlVec3 d, float sum[3]) {
  VL_EACH_ITEM(const Sky, s, &cube->skies) {
    float own[3];
    if (!s->map) {
      for (int c = 0; c < 3; c++)
        sum[c] += s->rgb[c];
      continue;
    }
    look_octahedral(s->map, vl_normalize(vl_turn(s->light_from_world, d)), own);
    vl_store3(own, vl_to_srgb(&s->to_srgb, vl_load3(own)));
    for (int c = 0; c < 3; c++) {
      float v = s->scale * own[c];
      sum[c] += v > 0 ? v : 0.0f;
    }
  }
}

/* Illuminance of a surface across the map's z axis, from z > 0, without scale: the world's own
 * sum (pbrt 12.5.2). */
static double illuminance_of(const Sky *sky) {
  const vlMipmap *map = sky->map;
  const uint32_t n = map->levels[0].width;
  double sum = 0;
  for (uint32_t y = 0; y < n; y++)
    for (uint32_t x = 0; x < n; x++) {
      vlVec3 d =
          vl_octahedral_decode(((float)x + 0.5f) / (float)n, ((float)y + 0.5f) / (float)n);
      if (!(d.z > 0))
        continue;
      float c[3];
      for (uint32_t k = 0; k < 3; k++)
        c[k] = vl_mip_texel(map, 0, x, y, map->channels < 3 ? 0 : k);
      if (sky->to_srgb.needed)
        vl_store3(c, vl_turn(sky->to_srgb.m, vl_load3(c)));
      sum +=
          (double)d.z * (0.2126 * (double)c[0] + 0.7152 * (double)c[1] + 0.0722 * (double)c[2]);
    }
  return sum * 4 * 3.14159265358979 / ((double)n * n);
}

static bool read_map(vlExport *x, const vlLightDef *d, Sky *sky) {
  vlImage *read = NULL;
  vlError error;
  vl_error_clear(&error);
  if (!d->image && vl_image_read_named(x->context, NULL, d->path, &read, &error) != VL_OK)
    return false;
  const vlImage *image = d->image ? d->image : read;
  vlMipmapDef def = {.only_finest = true};
  def.count = vl_image_color(image, def.channel);
  def.count = def.count > 2 ? 3 : def.count ? 1 : 0;
  bool fine = def.count && image->width == image->height &&
              vl_mipmap_create(image, &def, &sky->map) == VL_OK;
  vl_image_destroy(read);
  if (!fine)
    return false;
  sky->to_srgb = vl_srgb_map(vl_mipmap_space(sky->map, d->space), VL_ROLE_ILLUMINANT);
  sky->scale = d->scale;
  const double lux = illuminance_of(sky);
  if (!isnan(d->illuminance) && lux > 0)
    sky->scale *= (float)(d->illuminance / lux);
  return true;
}

static bool add_sky(Cube *cube, const vlLightDef *d) {
  Sky sky = {0};
  vlMat4 m = vl_mat4_load(d->world_from_light), inverse;
  if (d->path || d->image) {
    if (!vl_mat4_inverse(m, &inverse) || !read_map(cube->x, d, &sky)) {
      vl_mipmap_destroy(sky.map);
      vl_export_lose(cube->x, "environments whose image cannot be read: left out");
      return true;
    }
    if (d->has_portal)
      vl_export_lose(cube->x, "portals of environments: their light comes from everywhere");
    /* the parent that mirrors the world (gltf.c) mirrors z */
    for (int i = 0; i < 9; i++)
      sky.light_from_world[i] =
          (float)inverse.m[4 * (i / 3) + i % 3] * (cube->mirror && i % 3 == 2 ? -1.0f : 1.0f);
  } else {
    vl_export_light_rgb(&d->color, sky.rgb);
    const double lux = isnan(d->illuminance) ? 1 : d->illuminance / 3.14159265358979;
    for (int c = 0; c < 3; c++)
      sky.rgb[c] *= d->scale * (float)lux;
  }
  Sky *slot = VL_PUSH(cube->x->context, &cube->skies);
  if (slot) {
    *slot = sky;
    return true;
  }
  vl_mipmap_destroy(sky.map);
  return vl_export_no_memory(cube->x);
}

/* ---- the cube ---------------------------------------------------------------------------- */

static const float *texel_at(const Level *level, vlVec3 d) {
  float s, t;
  const uint32_t face = vl_cube_map_face(d, &s, &t);
  const int n = (int)level->side;
  int i = (int)((s + 1) * 0.5f * (float)n), j = (int)((t + 1) * 0.5f * (float)n);
  i = i < 0 ? 0 : i >= n ? n - 1 : i;
  j = j < 0 ? 0 : j >= n ? n - 1 : j;
  return level->texels +
         3 * (((size_t)face * level->side + (size_t)j) * level->side + (size_t)i);
}

/* A row of level 0: each texel is the mean of sixteen directions. */
static void look_row(void *user, uint32_t row, VL_UNUSED uint32_t worker) {
  const Cube *cube = user;
  const Level *level = &cube->plain[0];
  const uint32_t n = level->side, face = row / n, y = row % n;
  for (uint32_t i = 0; i < n; i++) {
    float sum[3] = {0, 0, 0};
    for (uint32_t k = 0; k < 16; k++) {
      float s = ((float)i + 0.125f + 0.25f * (float)(k % 4)) / (float)n * 2 - 1;
      float t = ((float)y + 0.125f + 0.25f * (float)(k / 4)) / (float)n * 2 - 1;
      radiance(cube, vl_normalize(vl_cube_map_direction(face, s, t)), sum);
    }
    for (int c = 0; c < 3; c++)
      level->texels[3 * ((size_t)row * n + i) + (size_t)c] = sum[c] / 16;
  }
}

/* A row of a level that is filtered by GGX's lobe for the viewer along the normal (Karis 2013).
 * A sample looks into the level whose texels have the sample's share of the sphere (Colbert and
 * Krivanek 2007). */
static void filter_row(void *user, uint32_t row, VL_UNUSED uint32_t worker) {
  const Cube *cube = user;
  const Level *level = &cube->lobes[cube->level];
  const uint32_t n = level->side, face = row / n, y = row % n;
  const float rough = (float)cube->level / (float)(cube->levels - 1),
              a2 = rough * rough * rough * rough;
  for (uint32_t i = 0; i < n; i++) {
    vlVec3 normal = vl_normalize(vl_cube_map_direction(
        face, ((float)i + 0.5f) / (float)n * 2 - 1, ((float)y + 0.5f) / (float)n * 2 - 1));
    vlVec3 aside = vl_abs(normal.y) < 0.9f ? vl_vec3(0, 1, 0) : vl_vec3(1, 0, 0);
    vlVec3 tx = vl_normalize(vl_cross(aside, normal)), ty = vl_cross(normal, tx);
    float sum[3] = {0, 0, 0}, weight = 0;
    for (uint32_t k = 0; k < LOBE_SAMPLES; k++) {
      float u = ((float)k + 0.5f) / LOBE_SAMPLES, c2 = (1 - u) / (1 + (a2 - 1) * u),
            c = __builtin_sqrtf(c2);
      vlSinCos turn = vl_sincos_turn(vl_unit_float(vl_reverse_bits(k)));
      float r = 2 * c * vl_safe_sqrt(1 - c2), z = 2 * c2 - 1, inner = c2 * (a2 - 1) + 1;
      if (!(z > 0))
        continue;
      /* solid angle of the sample */
      float share = 4 * 3.14159265f * inner * inner / (a2 * LOBE_SAMPLES);
      uint32_t from = 0;
      while (from + 1 < cube->levels &&
             share > 4 * 12.5663706f /
                         (6 * (float)cube->plain[from].side * (float)cube->plain[from].side))
        from++;
      vlVec3 d = vl_vec3(r * turn.cos * tx.x + r * turn.sin * ty.x + z * normal.x,
                         r * turn.cos * tx.y + r * turn.sin * ty.y + z * normal.y,
                         r * turn.cos * tx.z + r * turn.sin * ty.z + z * normal.z);
      const float *p = texel_at(&cube->plain[from], d);
      for (int q = 0; q < 3; q++)
        sum[q] += z * p[q];
      weight += z;
    }
    for (int q = 0; q < 3; q++)
      level->texels[3 * ((size_t)row * n + i) + (size_t)q] = sum[q] / weight;
  }
}

static bool new_level(Cube *cube, Level *level, uint32_t side) {
  level->side = side;
  level->texels = vl_export_alloc(cube->x, 18 * (size_t)side * side, sizeof *level->texels);
  return level->texels != NULL;
}

static void halve(const Level *from, Level *to) {
  const size_t n = to->side, wide = from->side;
  for (size_t row = 0; row < 6 * n; row++)
    for (size_t i = 0; i < 3 * n; i++) {
      const float *p = from->texels + 3 * (2 * row * wide + 2 * (i / 3)) + i % 3;
      to->texels[3 * n * row + i] = 0.25f * (p[0] + p[3] + p[3 * wide] + p[3 * wide + 3]);
    }
}

static bool make_levels(Cube *cube) {
  uint32_t side = MIN_SIDE;
  for (size_t i = 0; i < cube->skies.count; i++)
    while (cube->skies.items[i].map && side < MAX_SIDE &&
           2.45 * side < cube->skies.items[i].map->levels[0].width)
      side *= 2;
  for (cube->levels = 0; side >= MIN_SIDE; side /= 2, cube->levels++) {
    const uint32_t k = cube->levels;
    if (!new_level(cube, &cube->plain[k], side) ||
        (k && !new_level(cube, &cube->lobes[k], side)))
      return false;
    if (k)
      halve(&cube->plain[k - 1], &cube->plain[k]);
    if (!k)
      vl_parallel_for(cube->x->context, 6 * side, look_row, cube);
  }
  cube->lobes[0] = cube->plain[0];
  for (cube->level = 1; cube->level < cube->levels; cube->level++)
    vl_parallel_for(cube->x->context, 6 * cube->lobes[cube->level].side, filter_row, cube);
  return true;
}

/* ---- the file ---------------------------------------------------------------------------- */

/* The irradiance's coefficients up to l = 2 (Ramamoorthi and Hanrahan 2001), in the order of l
 * and m. */
static json_t *irradiance(const Cube *cube, double intensity) {
  const Level *level = &cube->plain[cube->levels - 1]; /* sixteen texels across do for l = 2 */
  double sum[9][3] = {{0}}, pi = 3.14159265358979;
  const double bands[9] = {pi,     2 * pi / 3, 2 * pi / 3, 2 * pi / 3, pi / 4,
                           pi / 4, pi / 4,     pi / 4,     pi / 4};
  const uint32_t n = level->side;
  for (uint32_t i = 0; i < 6 * n * n; i++) {
    double s = ((i % n) + 0.5) / n * 2 - 1, t = ((i / n % n) + 0.5) / n * 2 - 1,
           l2 = 1 + s * s + t * t;
    double area = 4.0 / ((double)n * n) / (l2 * sqrt(l2));
    vlVec3 at = vl_cube_map_direction(i / (n * n), (float)s, (float)t);
    double x = (double)at.x / sqrt(l2), y = (double)at.y / sqrt(l2),
           z = (double)at.z / sqrt(l2);
    const double basis[9] = {0.282094791773878,
                             0.488602511902920 * y,
                             0.488602511902920 * z,
                             0.488602511902920 * x,
                             1.092548430592079 * x * y,
                             1.092548430592079 * y * z,
                             0.315391565252520 * (3 * z * z - 1),
                             1.092548430592079 * x * z,
                             0.546274215296040 * (x * x - y * y)};
    for (int k = 0; k < 9; k++)
      for (int c = 0; c < 3; c++)
        sum[k][c] += basis[k] * area * (double)level->texels[3 * (size_t)i + (size_t)c];
  }
  json_t *list = json_array();
  for (int k = 0; k < 9; k++)
    json_array_append_new(
        list, json_pack("[f,f,f]", sum[k][0] * bands[k] / intensity,
                        sum[k][1] * bands[k] / intensity, sum[k][2] * bands[k] / intensity));
  return list;
}

static json_int_t put_face(vlExport *x, const Level *level, uint32_t face, double intensity) {
  static const char *const names[] = {"R", "G", "B", "A"};
  vlImageDef def = vl_default_image_def(level->side, level->side, 4);
  def.type = VL_PIXEL_U16;
  def.encoding = VL_ENCODING_SRGB;
  def.names = names;
  vlImage *image = NULL;
  if (vl_image_create(x->context, &def, &image) != VL_OK) {
    vl_export_no_memory(x);
    return -1;
  }
  const size_t count = (size_t)level->side * level->side;
  uint16_t *to = vl_image_pixels(image);
  for (size_t i = 0; i < count; i++) {
    const float *from = level->texels + 3 * (face * count + i);
    double max = fmax(from[0], fmax(from[1], from[2])) / intensity,
           d = max > 1 ? fmax(1, floor(255 / max)) : 255;
    for (int c = 0; c < 3; c++) {
      double v = fmin(1, (double)from[c] / intensity * d / 255);
      to[4 * i + (size_t)c] = (uint16_t)(vl_linear_to_srgb(v) * 65535 + 0.5);
    }
    to[4 * i + 3] = (uint16_t)(257 * d);
  }
  char *bytes;
  size_t size;
  json_int_t index = -1;
  if (vl_export_pack(x, image, ".png", &bytes, &size)) {
    index = vl_gltf_put_file(x, bytes, size, ".png");
    vl_free(x->context, bytes);
  }
  vl_image_destroy(image);
  return index;
}

/* Adds the light to the root and to the scene. */
static bool put_cube(const Cube *cube, json_t *scene) {
  vlExport *x = cube->x;
  const Level *finest = &cube->plain[0];
  double max = 0;
  for (size_t i = 0; i < 18 * (size_t)finest->side * finest->side; i++)
    max = fmax(max, (double)finest->texels[i]);
  if (!(max > 0))
    return true;
  /* the range of D is 1 to 255; an intensity takes what is beyond */
  const double intensity = max > 255 ? max / 255 : max < 1 ? max : 1;
  json_t *levels = json_array();
  for (uint32_t k = 0; k < cube->levels; k++) {
    json_t *faces = json_array();
    json_array_append_new(levels, faces);
    for (uint32_t face = 0; face < 6; face++) {
      const json_int_t index = put_face(x, &cube->lobes[k], face, intensity);
      if (index < 0) {
        json_decref(levels);
        return false;
      }
      json_array_append_new(faces, json_integer(index));
    }
  }
  json_t *light =
      json_pack("{s:f,s:o,s:I,s:o}", "intensity", intensity, "irradianceCoefficients",
                irradiance(cube, intensity), "specularImageSize", (json_int_t)finest->side,
                "specularImages", levels);
  vl_gltf_put_extension(x, "EXT_lights_image_based", json_pack("{s:[o]}", "lights", light));
  json_object_set_new(scene, "extensions",
                      json_pack("{s:{s:i}}", "EXT_lights_image_based", "light", 0));
  return true;
}

bool vl_gltf_put_environment(vlExport *x, json_t *scene, bool mirror) {
  Cube cube = {.x = x, .mirror = mirror};
  bool fine = true;
  for (size_t i = 0; fine && i < x->scene->lights.count; i++)
    if (x->scene->lights.items[i].kind == VL_LIGHT_INFINITE)
      fine = add_sky(&cube, &x->scene->lights.items[i]);
  if (cube.skies.count > 1)
    vl_export_lose(x, "several environments: their sum is one");
  if (fine && cube.skies.count && !x->dry)
    fine = make_levels(&cube) && put_cube(&cube, scene);
  for (size_t i = 0; i < cube.skies.count; i++)
    vl_mipmap_destroy(cube.skies.items[i].map);
  VL_ARRAY_FREE(x->context, &cube.skies);
  for (int k = 0; k < LEVELS; k++) {
    vl_free(x->context, cube.plain[k].texels);
    if (k)
      vl_free(x->context, cube.lobes[k].texels);
  }
  return fine;
}
