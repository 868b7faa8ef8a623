/* import/gltf/extension.c: the extensions that are read. An unknown extension is an error when
 * the file requires it and a warning when the file only uses it. */
#include <stdio.h>

#include "base/text.h"
#include "import/gltf/gltf.h"

static const char *const known[] = {
    "KHR_materials_unlit",        "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",
    "KHR_materials_clearcoat",    "KHR_materials_transmission",
    "KHR_materials_volume",       "KHR_materials_sheen",
    "KHR_materials_iridescence",  "KHR_materials_anisotropy",
    "KHR_materials_dispersion",   "KHR_materials_diffuse_transmission",
    "KHR_materials_variants",     "KHR_materials_pbrSpecularGlossiness",
    "KHR_texture_transform",      "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",    "KHR_lights_punctual",
    "EXT_texture_webp",           "EXT_meshopt_compression",
    "EXT_lights_image_based",     "EXT_lights_ies",
    "KHR_animation_pointer",      "KHR_node_visibility",
#ifdef VELO_DRACO
    "KHR_draco_mesh_compression",
#endif
};
/* Extensions of the Khronos registry that velo does not read. Messages show their names in full
 * and shorten unknown names. */
static const char registered[] =
    "ADOBE_materials_clearcoat_specular AGI_articulations AGI_stk_metadata "
    "CESIUM_primitive_outline CESIUM_RTC EXT_mesh_features EXT_mesh_manifold "
    "EXT_structural_metadata EXT_texture_avif FB_geometry_metadata KHR_audio_emitter "
    "KHR_draco_mesh_compression KHR_gaussian_splatting KHR_interactivity "
    "KHR_materials_diffuse_roughness KHR_materials_retroreflection KHR_materials_scatter "
    "KHR_materials_subsurface KHR_materials_volume_scatter KHR_physics_rigid_bodies "
    "KHR_techniques_webgl KHR_texture_basisu KHR_xmp_json_ld MPEG_media MSFT_lod "
    "MSFT_packing_normalRoughnessMetallic MSFT_packing_occlusionRoughnessMetallic "
    "MSFT_texture_dds NV_materials_mdl VRM VRMC_materials_mtoon VRMC_vrm";
/* These extensions do not change the image. */
static const char silent[] =
    "KHR_xmp KHR_xmp_json_ld KHR_node_hoverability KHR_node_selectability";

bool vl_gltf_reads_extension(const char *name) {
  return VL_IS_AMONG(name, known);
}

bool vl_gltf_passes_extension(const char *name) {
  return vl_has_word(silent, name);
}

vlShortText vl_gltf_extension_text(const char *name) {
  vlShortText text = vl_short_text(name);
  if (vl_has_word(registered, name))
    snprintf(text.text, sizeof text.text, "%s", name);
  return text;
}

/* Reports an extension that the file requires and velo does not read. */
static bool fail_required(const vlGltfLocation *at, const char *name) {
  if (vl_text_is(name, "KHR_draco_mesh_compression"))
    return vl_gltf_fail_code(VL_ERROR_UNSUPPORTED, at,
                             "this velo was built without libdraco, which %s needs", name);
  if (vl_text_is(name, "KHR_texture_basisu"))
    return vl_gltf_fail_code(
        VL_ERROR_UNSUPPORTED, at,
        "velo does not read KTX2 images (%s): convert them to PNG, as gltf-transform does",
        name);
  const char *near = vl_nearest_name(name, known, VL_LENGTH(known));
  return vl_gltf_fail_code(VL_ERROR_UNSUPPORTED, at, "velo does not read %s%s%s%s",
                           vl_gltf_extension_text(name).text, near ? " (it reads " : "",
                           near ? near : "", near ? ")" : "");
}

/* Looks at a list of extensions of the file's root. */
static bool check_list(vlGltf *g, const char *key, bool required) {
  const json_t *list;
  size_t count;
  if (!vl_gltf_array(&g->top, key, &list, &count))
    return false;
  for (size_t i = 0; i < count; i++) {
    const char *name = json_string_value(json_array_get(list, i));
    const vlGltfLocation *at = VL_GLTF_ROOT(g, key, i);
    if (!name)
      return vl_gltf_fail(at, "must be a string");
    if (vl_gltf_reads_extension(name))
      continue;
    if (required)
      return fail_required(at, name);
    if (!vl_gltf_passes_extension(name))
      vl_gltf_warn(VL_LOG_WARNING, at, "%s is ignored: velo does not read it",
                   vl_gltf_extension_text(name).text);
  }
  return true;
}

bool vl_gltf_check_extensions(vlGltf *g) {
  return check_list(g, "extensionsRequired", true) && check_list(g, "extensionsUsed", false);
}
