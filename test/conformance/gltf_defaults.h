/* conformance/gltf_defaults.h: laws of glTF's members: one that is left out has the default of
 * the specification, and what stands in for a rough material in a glTF file is as rough. */
#ifndef TEST_CONFORMANCE_GLTF_DEFAULTS_H
#define TEST_CONFORMANCE_GLTF_DEFAULTS_H

#include "conformance.h"
#include "files.h"
#include "materials.h"
#include "parameters.h"
#include "unit.h"

/* ---- defaults ---------------------------------------------------------------------------- */

/* Members of a material, or with "light" of a lamp: what a file may leave out, and the same
 * with the defaults of glTF 2.0 and of its extensions. */
static const struct {
  const char *extension, *brief, *whole;
} gltf_defaults[] = {
    {NULL, "\"pbrMetallicRoughness\":{}",
     "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,1],\"metallicFactor\":1,"
     "\"roughnessFactor\":1},\"emissiveFactor\":[0,0,0],\"alphaMode\":\"OPAQUE\","
     "\"doubleSided\":false"},
    {"KHR_materials_ior", "", "\"ior\":1.5"},
    {"KHR_materials_specular", "", "\"specularFactor\":1,\"specularColorFactor\":[1,1,1]"},
    {"KHR_materials_transmission", "", "\"transmissionFactor\":0"},
    {"KHR_materials_clearcoat", "", "\"clearcoatFactor\":0"},
    {"KHR_materials_clearcoat", "\"clearcoatFactor\":1",
     "\"clearcoatFactor\":1,\"clearcoatRoughnessFactor\":0"},
    {"KHR_materials_sheen", "", "\"sheenColorFactor\":[0,0,0]"},
    {"KHR_materials_sheen", "\"sheenColorFactor\":[1,1,1]",
     "\"sheenColorFactor\":[1,1,1],\"sheenRoughnessFactor\":0"},
    {"KHR_materials_iridescence", "", "\"iridescenceFactor\":0"},
    {"KHR_materials_iridescence", "\"iridescenceFactor\":1",
     "\"iridescenceFactor\":1,\"iridescenceIor\":1.3,\"iridescenceThicknessMinimum\":100,"
     "\"iridescenceThicknessMaximum\":400"},
    {"KHR_materials_anisotropy", "", "\"anisotropyStrength\":0"},
    {"KHR_materials_anisotropy", "\"anisotropyStrength\":0.5",
     "\"anisotropyStrength\":0.5,\"anisotropyRotation\":0"},
    {"KHR_materials_diffuse_transmission", "", "\"diffuseTransmissionFactor\":0"},
    {"KHR_materials_diffuse_transmission", "\"diffuseTransmissionFactor\":1",
     "\"diffuseTransmissionFactor\":1,\"diffuseTransmissionColorFactor\":[1,1,1]"},
    {"KHR_materials_pbrSpecularGlossiness", "",
     "\"diffuseFactor\":[1,1,1,1],\"specularFactor\":[1,1,1],\"glossinessFactor\":1"},
    {"light", "\"type\":\"point\"", "\"type\":\"point\",\"color\":[1,1,1],\"intensity\":1"},
    {"light", "\"type\":\"directional\"",
     "\"type\":\"directional\",\"color\":[1,1,1],\"intensity\":1"},
    {"light", "\"type\":\"spot\",\"spot\":{}",
     "\"type\":\"spot\",\"spot\":{\"innerConeAngle\":0,\"outerConeAngle\":0.785398163397448}"},
};

/* A triangle with a material, or a lamp beside it. */
static const char gltf_form[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0%s]}],"
    "\"nodes\":[{\"mesh\":0}%s],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}%s}]}],%s"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
    "\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

static void gltf_text(char text[TEXT], const char *extension, const char *members) {
  char part[1000];
  const bool lamp = extension && strcmp(extension, "light") == 0;
  if (lamp)
    snprintf(part, sizeof part,
             "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":"
             "{\"KHR_lights_punctual\":{\"lights\":[{%s}]}},",
             members);
  else if (extension)
    snprintf(part, sizeof part,
             "\"extensionsUsed\":[\"%s\"],\"materials\":[{\"extensions\":{\"%s\":{%s}}}],",
             extension, extension, members);
  else
    snprintf(part, sizeof part, "\"materials\":[{%s}],", members);
  snprintf(text, TEXT, gltf_form, lamp ? ",1" : "",
           lamp ? ",{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}" : "",
           lamp ? "" : ",\"material\":0", part);
}

/* The first material and the first light of the text, as velo writes them to a glTF file. */
static bool write_gltf_of(const char *extension, const char *members, Written *w) {
  static char text[TEXT];
  char path[100];
  vlError error = {0};
  vlScene *scene;
  gltf_text(text, extension, members);
  assert_true(write_bytes("members.gltf", text, strlen(text)));
  path_of(path, "members.gltf");
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlResult result = vl_scene_load(scene, path, NULL, &error);
  path_of(path, "defaults.gltf");
  if (result == VL_OK)
    result = vl_scene_save(scene, path, NULL, &error);
  vl_scene_destroy(scene);
  if (result != VL_OK) {
    broken("gltf", extension ? extension : "material", "{%s}: %s", members, error.message);
    return false;
  }
  return read_written(path, w) && w->size > 0;
}

static void defaults_of_gltf(void **state) {
  (void)state;
  static Written written[2];
  for (size_t i = 0; i < sizeof gltf_defaults / sizeof *gltf_defaults; i++) {
    const char *extension = gltf_defaults[i].extension;
    if (!write_gltf_of(extension, gltf_defaults[i].brief, &written[0]) ||
        !write_gltf_of(extension, gltf_defaults[i].whole, &written[1]))
      continue;
    if (written[0].size != written[1].size ||
        memcmp(written[0].bytes, written[1].bytes, written[0].size) != 0)
      broken("gltf", extension ? extension : "material", "{%s} is not {%s}",
             gltf_defaults[i].brief, gltf_defaults[i].whole);
  }
  expect_no_failures();
}

/* ---- roughness --------------------------------------------------------------------------- */

/* The roughness of files: alpha is its square root; in glTF alpha is its square. */
static void rough_stand_ins(void **state) {
  (void)state;
  static char text[TEXT];
  const vlKindFamily *family = vl_kind_family_find("materials");
  int compared = 0;
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    if (!vl_row_find(row, "uroughness") || !vl_row_find(row, "remaproughness"))
      continue;
    for (int remapped = 0; remapped < 2; remapped++) {
      const double alpha = 0.36;
      char parameters[200];
      snprintf(parameters, sizeof parameters,
               "\"float roughness\" %g \"bool remaproughness\" %s",
               remapped ? alpha * alpha : alpha, remapped ? "true" : "false");
      scene_text(text, HEAD "WorldBegin " LIGHTS "Material %s Shape \"sphere\"", row->name,
                 parameters);
      vlScene *scene = need_scene(text);
      vlScene *read = read_again(scene, "roughness.gltf");
      const vlMaterialDef *m = last_def(read, "materials", VL_MATERIAL_PRINCIPLED);
      const bool coat = m && m->principled.clearcoat.value > 0;
      const double found = !m     ? NAN
                           : coat ? (double)m->principled.clearcoat_roughness.value
                                  : (double)m->principled.roughness.value;
      if (!(fabs(found * found - alpha) < 1e-4))
        broken("materials", row->name, "%s: as .gltf alpha is %g, not %g", parameters,
               found * found, alpha);
      compared++;
      vl_scene_destroy(read);
      vl_scene_destroy(scene);
    }
  }
  assert_true(compared >= 8);
  expect_no_failures();
}

#endif
