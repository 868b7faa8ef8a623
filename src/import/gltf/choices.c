/* import/gltf/choices.c: lists the file's scenes, cameras, animations and variants for
 * vl_scene_choice_info. */
#include <stdlib.h>

#include "base/text.h"
#include "import/gltf/gltf.h"

size_t vl_gltf_find(const vlGltf *g, const char *array, const char *name) {
  const json_t *items = json_object_get(g->root, array);
  char *end;
  for (size_t i = 0; i < json_array_size(items); i++)
    if (vl_text_is(vl_gltf_name(json_array_get(items, i)), name))
      return i;
  unsigned long number = strtoul(name, &end, 10);
  return *end || end == name || number >= json_array_size(items) ? VL_GLTF_NONE : number;
}

bool vl_gltf_fail_choice(vlGltf *g, const char *what, const json_t *items, const char *name,
                         size_t size) {
  char names[300] = "";
  for (size_t i = 0; i < json_array_size(items); i++) {
    const char *own = vl_gltf_name(json_array_get(items, i));
    if (own)
      vl_list_name(names, size, vl_short_text(own).text);
  }
  return vl_gltf_fail(&g->top, "there is no %s \"%s\" (%zu are there%s)", what,
                      vl_argument_text(name).text, json_array_size(items), names);
}

/* The time of the last key: the maximum of the input accessors of its samplers. */
double vl_gltf_animation_end(const vlGltf *g, size_t animation) {
  const json_t *samplers =
      json_object_get(vl_gltf_item(g, "animations", animation), "samplers");
  double end = 0;
  for (size_t i = 0; i < json_array_size(samplers); i++) {
    const size_t input = vl_gltf_peek(json_array_get(samplers, i), "input", g->accessor_count);
    const json_t *max = json_object_get(vl_gltf_item(g, "accessors", input), "max");
    const double last = json_number_value(json_array_get(max, 0));
    if (last > end && last < 1e9)
      end = last;
  }
  return end;
}

/* Cameras are numbered as vl_gltf_choose_camera numbers them: by the nodes of the scene. */
static bool list_cameras(vlGltf *g) {
  size_t camera;
  for (size_t i = 0;; i++) {
    if (!vl_gltf_next_camera(g, &i, &camera))
      return false;
    if (i == g->node_count)
      return true;
    const char *name = vl_gltf_name(g->nodes[i].json);
    if (!name)
      name = vl_gltf_name(vl_gltf_item(g, "cameras", camera));
    if (!vl_scene_add_choice(g->scene, VL_CHOICE_CAMERA, name, 0))
      return false;
  }
}

static bool list(vlGltf *g, vlChoiceKind kind, const json_t *items) {
  for (size_t i = 0; i < json_array_size(items); i++) {
    const double end = kind == VL_CHOICE_ANIMATION ? vl_gltf_animation_end(g, i) : 0;
    if (!vl_scene_add_choice(g->scene, kind, vl_gltf_name(json_array_get(items, i)), end))
      return false;
  }
  return true;
}

bool vl_gltf_list_choices(vlGltf *g) {
  const json_t *variants = vl_gltf_extension(g->root, "KHR_materials_variants");
  return list(g, VL_CHOICE_SCENE, json_object_get(g->root, "scenes")) &&
         list(g, VL_CHOICE_ANIMATION, json_object_get(g->root, "animations")) &&
         list(g, VL_CHOICE_VARIANT, json_object_get(variants, "variants")) && list_cameras(g);
}
