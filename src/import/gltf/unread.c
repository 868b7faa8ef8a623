/* import/gltf/unread.c: counts what a file has and the scene does not hold: extras, extensions
 * that velo does not read, occlusion maps, further vertex attributes. Exporters report it as
 * lost. The copyright is kept. */
#include <stdio.h>

#include "base/text.h"
#include "import/gltf/gltf.h"

enum { MAX_KINDS = 40 };

/* False: out of memory. */
static bool add(vlGltf *g, const char *format, const char *name) {
  char text[200];
  snprintf(text, sizeof text, format, name);
  for (size_t i = 0; i < g->scene->unread.count; i++)
    if (vl_text_is(g->scene->unread.items[i].what, text)) {
      g->scene->unread.items[i].count++;
      return true;
    }
  if (g->scene->unread.count == MAX_KINDS)
    return true;
  const char *what = text;
  vlSceneUnread *slot =
      vl_scene_copy_string(g->scene, &what) ? VL_PUSH(g->context, &g->scene->unread) : NULL;
  if (!slot)
    return vl_gltf_fail_memory(g);
  *slot = (vlSceneUnread){what, 1};
  return true;
}

/* Extras that hold velo's camera alone are read. */
static bool is_own(const json_t *extras) {
  return json_object_size(extras) == 1 && json_object_get(extras, "velo");
}

static bool count_attributes(vlGltf *g, const json_t *attributes) {
  static const char *const read[] = {"POSITION",   "NORMAL",     "TANGENT",    "TEXCOORD_0",
                                     "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3", "COLOR_0",
                                     "JOINTS_",    "WEIGHTS_"};
  const char *name;
  json_t *value;
  json_object_foreach((json_t *)(uintptr_t)attributes, name, value) {
    bool known = false;
    for (size_t i = 0; i < VL_LENGTH(read); i++)
      known = known || strncmp(name, read[i], strlen(read[i])) == 0;
    if (!known && !add(g, "vertex attribute %s: left out", vl_short_text(name).text))
      return false;
  }
  return true;
}

/* jansson limits the depth of the recursion. */
static bool walk(vlGltf *g, const char *key, json_t *value) {
  const bool extensions = vl_text_is(key, "extensions");
  const char *name;
  json_t *part, *item;
  size_t i;
  if (vl_text_is(key, "attributes") && !count_attributes(g, value))
    return false;
  json_object_foreach(value, name, part) {
    if (vl_text_is(name, "extras")) {
      if (!is_own(part) && !add(g, "%s of applications: left out", name))
        return false;
      continue;
    }
    if (vl_text_is(name, "occlusionTexture") &&
        !add(g, "%s: left out, velo computes occlusion", name))
      return false;
    if (extensions && !vl_gltf_reads_extension(name)) {
      if (!add(g, "extension %s: left out, velo does not read it",
               vl_gltf_extension_text(name).text))
        return false;
      continue;
    }
    if (json_is_object(part) && !walk(g, name, part))
      return false;
    json_array_foreach(part, i, item) {
      if (json_is_object(item) && !walk(g, name, item))
        return false;
    }
  }
  return true;
}

bool vl_gltf_count_unread(vlGltf *g) {
  g->scene->copyright =
      json_string_value(json_object_get(json_object_get(g->root, "asset"), "copyright"));
  return (vl_scene_copy_string(g->scene, &g->scene->copyright) || vl_gltf_fail_memory(g)) &&
         walk(g, "", g->root);
}
