/* import/gltf/gltf.c: imports a glTF 2.0 file: the order of the steps. */
#include "import/gltf/gltf.h"
#include "base/text.h"

#include "import/import.h"
#include "import/plain.h"

static bool choose_variant(vlGltf *g) {
  g->variant = VL_GLTF_NONE;
  if (!g->def->variant)
    return true;
  const json_t *variants;
  size_t count;
  const vlGltfLocation *at = VL_GLTF_KEY(&g->top, "extensions.KHR_materials_variants");
  if (!vl_gltf_array(at, "variants", &variants, &count))
    return false;
  for (size_t i = 0; i < count && g->variant == VL_GLTF_NONE; i++)
    if (vl_text_is(vl_gltf_name(json_array_get(variants, i)), g->def->variant))
      g->variant = i;
  return g->variant != VL_GLTF_NONE ||
         vl_gltf_fail_choice(g, "variant", variants, g->def->variant, 300);
}

vlResult vl_import_gltf(vlScene *scene, const char *path, const vlLoadDef *def,
                        vlError *error) {
  vlLoadDef plain = vl_default_load_def();
  vlGltf g = {.context = scene->context,
              .scene = scene,
              .def = def ? def : &plain,
              .path = path,
              .copy = VL_GLTF_NONE};
  g.top.g = &g;
  vl_import_plain_settings(scene);
  bool ok = vl_gltf_open(&g) && vl_gltf_check_extensions(&g);
  if (ok)
    vl_gltf_check_names(&g);
  ok = ok && vl_gltf_count_unread(&g) && vl_gltf_read_buffers(&g) && choose_variant(&g) &&
       vl_gltf_read_nodes(&g) && vl_gltf_make_labels(&g) && vl_gltf_pose(&g) &&
       vl_gltf_draw(&g) && vl_gltf_list_choices(&g);
  ok = ok && vl_gltf_frame_animation(&g);
  vl_repairs_report(g.context, &g.repairs, path);
  if (ok && g.shapes_made == 0)
    vl_gltf_warn(VL_LOG_WARNING, &g.top, "draws nothing");
  if (ok && scene->problem)
    vl_gltf_validate(&g);
  vl_gltf_close(&g);
  return vl_scene_result(scene, error);
}
