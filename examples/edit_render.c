/* edit_render: changes a scene and renders it again: gold becomes red plaster, one ball is hidden. The second world
 * shares with the first what has not changed. The image shows both.
 *
 *   edit_render SCENE IMAGE
 *   build/release/bin/example_edit_render examples/corner.pbrt examples/edit_render.jpg
 */
#include "example.h"

int main(int count, char **arguments) {
  Example e = example_open(count, arguments, NULL);
  example_render(&e);
  vlImage *before = example_develop(&e);
  const vlMaterialDef *material;
  for (uint32_t i = 1; (material = vl_scene_material(e.scene, (vlMaterialId){i})); i++) {
    if (material->kind != VL_MATERIAL_CONDUCTOR) continue;
    vlMaterialDef plaster = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    plaster.reflectance = vl_spectrum_input(vl_spectrum_rgb(0.7f, 0.1f, 0.05f));
    example_must(&e, vl_scene_set_material(e.scene, (vlMaterialId){i}, &plaster, &e.error), "material");
  }
  uint32_t shapes = vl_scene_id_count(e.scene, VL_ID_OBJECT); /* the ball that the file describes last */
  example_must(&e, vl_scene_show_shape(e.scene, (vlShapeId){shapes}, false, &e.error), "shape");
  example_render(&e);
  vlImage *after = example_develop(&e), *both = example_join(&e, before, after);
  example_must(&e, vl_image_write(both, arguments[2], NULL, &e.error), arguments[2]);
  vl_image_destroy(before);
  vl_image_destroy(after);
  vl_image_destroy(both);
  return example_close(&e);
}
