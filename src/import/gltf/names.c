/* import/gltf/names.c: warns of members whose name is unknown but similar to a known one. Such
 * members are ignored, as the specification demands. */
#include <stdlib.h>

#include "base/text.h"
#include "import/gltf/gltf.h"

/* All members of glTF 2.0 and of the extensions that velo reads, sorted by strcmp. */
static const char *const known[] = {"COLOR_0",
                                    "JOINTS_0",
                                    "NORMAL",
                                    "POSITION",
                                    "ROTATION",
                                    "SCALE",
                                    "TANGENT",
                                    "TEXCOORD_0",
                                    "TEXCOORD_1",
                                    "TEXCOORD_2",
                                    "TEXCOORD_3",
                                    "TRANSLATION",
                                    "WEIGHTS_0",
                                    "accessors",
                                    "alphaCutoff",
                                    "alphaMode",
                                    "animations",
                                    "anisotropyRotation",
                                    "anisotropyStrength",
                                    "anisotropyTexture",
                                    "aspectRatio",
                                    "asset",
                                    "attenuationColor",
                                    "attenuationDistance",
                                    "attributes",
                                    "baseColorFactor",
                                    "baseColorTexture",
                                    "buffer",
                                    "bufferView",
                                    "bufferViews",
                                    "buffers",
                                    "byteLength",
                                    "byteOffset",
                                    "byteStride",
                                    "camera",
                                    "cameras",
                                    "channels",
                                    "children",
                                    "clearcoatFactor",
                                    "clearcoatNormalTexture",
                                    "clearcoatRoughnessFactor",
                                    "clearcoatRoughnessTexture",
                                    "clearcoatTexture",
                                    "color",
                                    "componentType",
                                    "copyright",
                                    "count",
                                    "diffuseFactor",
                                    "diffuseTexture",
                                    "diffuseTransmissionColorFactor",
                                    "diffuseTransmissionColorTexture",
                                    "diffuseTransmissionFactor",
                                    "diffuseTransmissionTexture",
                                    "dispersion",
                                    "doubleSided",
                                    "emissiveFactor",
                                    "emissiveStrength",
                                    "emissiveTexture",
                                    "extensions",
                                    "extensionsRequired",
                                    "extensionsUsed",
                                    "extras",
                                    "fallback",
                                    "filter",
                                    "generator",
                                    "glossinessFactor",
                                    "images",
                                    "index",
                                    "indices",
                                    "innerConeAngle",
                                    "input",
                                    "intensity",
                                    "interpolation",
                                    "inverseBindMatrices",
                                    "ior",
                                    "iridescenceFactor",
                                    "iridescenceIor",
                                    "iridescenceTexture",
                                    "iridescenceThicknessMaximum",
                                    "iridescenceThicknessMinimum",
                                    "iridescenceThicknessTexture",
                                    "irradianceCoefficients",
                                    "joints",
                                    "light",
                                    "lights",
                                    "magFilter",
                                    "mappings",
                                    "material",
                                    "materials",
                                    "matrix",
                                    "max",
                                    "mesh",
                                    "meshes",
                                    "metallicFactor",
                                    "metallicRoughnessTexture",
                                    "mimeType",
                                    "min",
                                    "minFilter",
                                    "minVersion",
                                    "mode",
                                    "multiplier",
                                    "name",
                                    "node",
                                    "nodes",
                                    "normalTexture",
                                    "normalized",
                                    "occlusionTexture",
                                    "offset",
                                    "orthographic",
                                    "outerConeAngle",
                                    "output",
                                    "path",
                                    "pbrMetallicRoughness",
                                    "perspective",
                                    "primitives",
                                    "range",
                                    "rotation",
                                    "roughnessFactor",
                                    "sampler",
                                    "samplers",
                                    "scale",
                                    "scene",
                                    "scenes",
                                    "sheenColorFactor",
                                    "sheenColorTexture",
                                    "sheenRoughnessFactor",
                                    "sheenRoughnessTexture",
                                    "skeleton",
                                    "skin",
                                    "skins",
                                    "source",
                                    "sparse",
                                    "specularColorFactor",
                                    "specularColorTexture",
                                    "specularFactor",
                                    "specularGlossinessTexture",
                                    "specularImageSize",
                                    "specularImages",
                                    "specularTexture",
                                    "spot",
                                    "strength",
                                    "target",
                                    "targets",
                                    "texCoord",
                                    "textures",
                                    "thicknessFactor",
                                    "thicknessTexture",
                                    "translation",
                                    "transmissionFactor",
                                    "transmissionTexture",
                                    "type",
                                    "uri",
                                    "values",
                                    "variants",
                                    "version",
                                    "weights",
                                    "wrapS",
                                    "wrapT",
                                    "xmag",
                                    "yfov",
                                    "ymag",
                                    "zfar",
                                    "znear"};
enum { KNOWN = VL_LENGTH(known), MAX_REPORTED = 4 };

static int compare(const void *a, const void *b) {
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Numbered attributes (TEXCOORD_7) and application-specific ones (names that start with _) are
 * known. */
static bool is_known(const char *key) {
  if (key[0] == '_' || bsearch(&key, known, KNOWN, sizeof *known, compare))
    return true;
  size_t length = strlen(key);
  while (length > 0 && key[length - 1] >= '0' && key[length - 1] <= '9')
    length--;
  return length > 0 && key[length] && key[length - 1] == '_';
}

static void look(vlGltf *g, const vlGltfLocation *at, const char *key, uint32_t *reported) {
  if (strlen(key) < 4 || is_known(key))
    return;
  const char *near = vl_nearest_name(key, known, KNOWN);
  if (near && ++*reported <= MAX_REPORTED)
    vl_gltf_warn(g, VL_LOG_WARNING, at, "unknown name \"%s\" is ignored (did you mean \"%s\"?)",
                 vl_short_text(key).text, near);
}

/* Unknown names are also shortened where they are part of a location. Extras and extensions
 * that velo does not read are not checked. jansson limits the depth of the recursion. */
static void walk(vlGltf *g, const vlGltfLocation *at, json_t *value, uint32_t *reported) {
  const char *name;
  json_t *part;
  size_t i;
  if (*reported >= MAX_REPORTED)
    return;
  if (json_is_object(value)) {
    bool extensions = at && vl_text_is(at->key, "extensions");
    json_object_foreach(value, name, part) {
      const vlShortText shown = vl_short_text(name);
      const char *key =
          bsearch(&name, known, KNOWN, sizeof *known, compare) || vl_gltf_reads_extension(name)
              ? name
              : shown.text;
      if (extensions ? !vl_gltf_reads_extension(name) : vl_text_is(name, "extras"))
        continue;
      if (!extensions)
        look(g, at, name, reported);
      if (json_is_object(part))
        walk(g, VL_GLTF_KEY(at, key), part, reported);
      if (!json_is_array(part))
        continue;
      for (i = 0; i < json_array_size(part) && *reported < MAX_REPORTED; i++)
        if (json_is_object(json_array_get(part, i)))
          walk(g, VL_GLTF_ITEM(at, key, i), json_array_get(part, i), reported);
    }
  }
}

void vl_gltf_check_names(vlGltf *g) {
  uint32_t reported = 0;
  walk(g, NULL, g->root, &reported);
}
