/* import/gltf/names.c: warns of members that the format does not have. They are ignored, as the
 * specification demands: a line for each name, with the nearest name that the format has. */
#include <stdio.h>

#include "base/text.h"
#include "import/gltf/gltf.h"

/* The members of an object, by the name that the object has in the file (glTF 2.0; the
 * specifications of the extensions that velo reads). Objects of one name share a row. Any
 * object may have extensions and extras. */
typedef struct {
  const char *object;  /* "": the root */
  const char *members; /* separated by blanks */
} Object;

static const Object objects[] = {
    {"",
     "accessors animations asset buffers bufferViews cameras extensionsRequired "
     "extensionsUsed images materials meshes nodes samplers scene scenes skins textures"},
    {"accessors",
     "bufferView byteOffset componentType count max min name normalized sparse "
     "type"},
    {"animations", "channels name samplers"},
    {"asset", "copyright generator minVersion version"},
    {"attributes",
     "COLOR_0 JOINTS_0 NORMAL POSITION ROTATION SCALE TANGENT TEXCOORD_0 "
     "TRANSLATION WEIGHTS_0"},
    {"bufferViews", "buffer byteLength byteOffset byteStride name target"},
    {"buffers", "byteLength name uri"},
    {"cameras", "name orthographic perspective type"},
    {"channels", "sampler target"},
    {"images", "bufferView mimeType name uri"},
    {"indices", "bufferView byteOffset componentType"},
    {"mappings", "material name variants"},
    {"materials",
     "alphaCutoff alphaMode doubleSided emissiveFactor emissiveTexture name "
     "normalTexture occlusionTexture pbrMetallicRoughness"},
    {"meshes", "name primitives weights"},
    {"nodes", "camera children matrix mesh name rotation scale skin translation weights"},
    {"orthographic", "xmag ymag zfar znear"},
    {"pbrMetallicRoughness",
     "baseColorFactor baseColorTexture metallicFactor "
     "metallicRoughnessTexture roughnessFactor"},
    {"perspective", "aspectRatio yfov zfar znear"},
    {"primitives", "attributes indices material mode targets"},
    {"samplers", "input interpolation magFilter minFilter name output wrapS wrapT"},
    {"scenes", "name nodes"},
    {"skins", "inverseBindMatrices joints name skeleton"},
    {"sparse", "count indices values"},
    {"spot", "innerConeAngle outerConeAngle"},
    {"target", "node path"},
    {"targets", "COLOR_0 NORMAL POSITION TANGENT TEXCOORD_0"},
    {"textures", "name sampler source"},
    {"values", "bufferView byteOffset"},
    {"variants", "name"},
    /* of KHR_lights_punctual, EXT_lights_ies, EXT_lights_image_based */
    {"lights",
     "bufferView color intensity irradianceCoefficients mimeType name range rotation "
     "specularImageSize specularImages spot type uri"},
    {"EXT_lights_ies", "color light lights multiplier"},
    {"EXT_lights_image_based", "light lights"},
    {"EXT_mesh_gpu_instancing", "attributes"},
    {"EXT_meshopt_compression",
     "buffer byteLength byteOffset byteStride count fallback filter "
     "mode"},
    {"EXT_texture_webp", "source"},
    {"KHR_animation_pointer", "pointer"},
    {"KHR_draco_mesh_compression", "attributes bufferView"},
    {"KHR_lights_punctual", "light lights"},
    {"KHR_materials_anisotropy", "anisotropyRotation anisotropyStrength anisotropyTexture"},
    {"KHR_materials_clearcoat",
     "clearcoatFactor clearcoatNormalTexture "
     "clearcoatRoughnessFactor clearcoatRoughnessTexture "
     "clearcoatTexture"},
    {"KHR_materials_diffuse_transmission",
     "diffuseTransmissionColorFactor "
     "diffuseTransmissionColorTexture "
     "diffuseTransmissionFactor "
     "diffuseTransmissionTexture"},
    {"KHR_materials_dispersion", "dispersion"},
    {"KHR_materials_emissive_strength", "emissiveStrength"},
    {"KHR_materials_ior", "ior"},
    {"KHR_materials_iridescence",
     "iridescenceFactor iridescenceIor iridescenceTexture "
     "iridescenceThicknessMaximum iridescenceThicknessMinimum "
     "iridescenceThicknessTexture"},
    {"KHR_materials_pbrSpecularGlossiness",
     "diffuseFactor diffuseTexture glossinessFactor "
     "specularFactor specularGlossinessTexture"},
    {"KHR_materials_sheen",
     "sheenColorFactor sheenColorTexture sheenRoughnessFactor "
     "sheenRoughnessTexture"},
    {"KHR_materials_specular",
     "specularColorFactor specularColorTexture specularFactor "
     "specularTexture"},
    {"KHR_materials_transmission", "transmissionFactor transmissionTexture"},
    {"KHR_materials_unlit", ""},
    {"KHR_materials_variants", "mappings variants"},
    {"KHR_materials_volume",
     "attenuationColor attenuationDistance thicknessFactor "
     "thicknessTexture"},
    {"KHR_mesh_quantization", ""},
    {"KHR_node_visibility", "visible"},
    {"KHR_texture_transform", "offset rotation scale texCoord"},
};
/* Objects whose names end with Texture. */
static const char texture_members[] = "index scale strength texCoord";

enum { MAX_NAMES = 24, MAX_MEMBERS = 24 };

/* A name that the format does not have, where it is first, and how often it is there. */
typedef struct {
  const char *object, *key;
  char location[200];
  uint32_t count;
} Unknown;

typedef struct {
  const json_t *used; /* extensionsUsed, or null */
  Unknown names[MAX_NAMES];
  uint32_t count, more; /* more: members beyond MAX_NAMES names */
} Look;

/* The members of an object of this name; null: any. */
static const char *members_of(const char *object) {
  for (size_t i = 0; i < VL_LENGTH(objects); i++)
    if (vl_text_is(object, objects[i].object))
      return objects[i].members;
  return vl_ends_with(object, "Texture") ? texture_members : NULL;
}

/* Numbered attributes (TEXCOORD_7) are known, and those of applications, which begin with _. */
static bool is_attribute(const char *key) {
  size_t length = strlen(key);
  while (length > 0 && key[length - 1] >= '0' && key[length - 1] <= '9')
    length--;
  return key[0] == '_' || (length > 0 && key[length] && key[length - 1] == '_');
}

static bool is_known(const char *object, const char *members, const char *key) {
  if (vl_text_is(key, "extras") || vl_text_is(key, "extensions") || vl_has_word(members, key))
    return true;
  return (vl_text_is(object, "attributes") || vl_text_is(object, "targets")) &&
         is_attribute(key);
}

static void count_name(Look *look, const vlGltfLocation *at, const char *object,
                       const char *key) {
  for (uint32_t i = 0; i < look->count; i++)
    if (vl_text_is(look->names[i].key, key) && vl_text_is(look->names[i].object, object)) {
      look->names[i].count++;
      return;
    }
  if (look->count == MAX_NAMES) {
    look->more++;
    return;
  }
  Unknown *name = &look->names[look->count++];
  *name = (Unknown){.object = object, .key = key, .count = 1};
  vl_gltf_write_location(at, name->location, sizeof name->location);
}

/* An extension that velo does not read, and that the file does not declare in extensionsUsed,
 * where it would have been reported. */
static void check_extension(Look *look, const vlGltfLocation *at, const char *name) {
  const json_t *item;
  size_t i;
  if (vl_gltf_passes_extension(name))
    return;
  json_array_foreach((json_t *)(uintptr_t)look->used, i, item) {
    if (vl_text_is(json_string_value(item), name))
      return;
  }
  count_name(look, at, "extensions", name);
}

/* Names that the format does not have are shortened where they are part of a location. Extras
 * are not looked at, nor extensions that velo does not read. jansson limits the depth of the
 * recursion. */
static void walk(Look *look, const vlGltfLocation *at, const char *object, json_t *value) {
  const bool extensions = vl_text_is(object, "extensions");
  const char *members = members_of(object), *name;
  json_t *part, *item;
  size_t i;
  json_object_foreach(value, name, part) {
    if (!extensions && vl_text_is(name, "extras"))
      continue;
    if (extensions && !vl_gltf_reads_extension(name)) {
      check_extension(look, at, name);
      continue;
    }
    const bool known = extensions || !members || is_known(object, members, name);
    if (!known)
      count_name(look, at, object, name);
    const vlShortText shown = vl_short_text(name);
    const char *key = known ? name : shown.text;
    if (json_is_object(part))
      walk(look, VL_GLTF_KEY(at, key), name, part);
    json_array_foreach(part, i, item) {
      if (json_is_object(item))
        walk(look, VL_GLTF_ITEM(at, key, i), name, item);
    }
  }
}

/* The nearest member of the object to the name, of those in words; null if none is near. */
static const char *nearest(const char *object, const char *name, char words[256]) {
  const char *list[MAX_MEMBERS + 2] = {"extensions", "extras"}, *members = members_of(object);
  size_t count = 2;
  snprintf(words, 256, "%s", members ? members : "");
  for (char *at = words; *at && count < VL_LENGTH(list);) {
    list[count++] = at;
    at += strcspn(at, " ");
    if (*at)
      *at++ = 0;
  }
  return vl_nearest_name(name, list, count);
}

static void report(vlGltf *g, const Unknown *name) {
  char times[60] = "", words[256];
  const char *near = NULL;
  const bool extension = vl_text_is(name->object, "extensions");
  if (!extension)
    near = nearest(name->object, name->key, words);
  if (name->count > 1)
    snprintf(times, sizeof times, ", here and in %u other place%s", name->count - 1,
             name->count > 2 ? "s" : "");
  const char *location = *name->location ? name->location : "the root";
  if (extension)
    vl_gltf_warn(VL_LOG_WARNING, &g->top, "%s: %s is ignored: velo does not read it%s",
                 location, vl_gltf_extension_text(name->key).text, times);
  else
    vl_gltf_warn(VL_LOG_WARNING, &g->top, "%s: unknown name \"%s\" is ignored%s%s", location,
                 vl_short_text(name->key).text, vl_hint(near).text, times);
}

void vl_gltf_check_names(vlGltf *g) {
  Look look = {.used = json_object_get(g->root, "extensionsUsed")};
  walk(&look, &g->top, "", g->root);
  for (uint32_t i = 0; i < look.count; i++)
    report(g, &look.names[i]);
  if (look.more)
    vl_gltf_warn(VL_LOG_WARNING, &g->top, "%u members of further unknown names are ignored",
                 look.more);
}
