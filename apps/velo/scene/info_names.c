/* scene/info_names.c: the names in a scene and what its file lets one choose, for `velo scene
 * info`. */
#include <stdio.h>

#include "cli/macros.h"
#include "cli/text.h"
#include "scene/scene.h"
#include "velo/check.h"

enum { NAMES = 20 }; /* most names listed as text */

static const struct {
  const char *key;
  vlIdKind kind;
} id_kinds[] = {
    {"shape", VL_ID_OBJECT}, {"material", VL_ID_MATERIAL}, {"instance", VL_ID_INSTANCE}};
enum { ID_KINDS = LENGTH(id_kinds) };
static const struct {
  const char *key;
  vlChoiceKind kind;
} choice_kinds[] = {{"scenes", VL_CHOICE_SCENE},
                    {"cameras", VL_CHOICE_CAMERA},
                    {"animations", VL_CHOICE_ANIMATION},
                    {"variants", VL_CHOICE_VARIANT}};
enum { CHOICE_KINDS = LENGTH(choice_kinds) };

/* Named shapes, materials and instances with their ids: "  shape 3     Hall/Chair
 * nodes[3].meshes[1].primitives[0]". */
void info_print_names(const vlScene *scene) {
  for (int k = 0; k < ID_KINDS; k++) {
    const uint32_t n = vl_scene_id_count(scene, id_kinds[k].kind);
    uint32_t named = 0;
    for (uint32_t id = 1; id <= n; id++) {
      vlIdInfo info;
      if (vl_scene_id_info(scene, id_kinds[k].kind, id, &info) != VL_OK || !info.name)
        continue;
      if (named++ == 0)
        printf("%s names\n", id_kinds[k].key);
      if (named > NAMES)
        continue;
      printf("  %-4u ", id);
      text_print_plain(info.name);
      if (info.place)
        printf("  (%s)", info.place);
      putchar('\n');
    }
    if (named > NAMES)
      printf("  and %u more (--json has all)\n", named - NAMES);
  }
}

/* "animations  2: 0 Walk (1.5 s), 1 Run (0.8 s)". */
void info_print_choices(const vlScene *scene) {
  for (int k = 0; k < CHOICE_KINDS; k++) {
    const uint32_t n = vl_scene_choice_count(scene, choice_kinds[k].kind);
    vlChoiceInfo info;
    if (n)
      printf("%-12s%u", choice_kinds[k].key, n);
    for (uint32_t i = 0; i < n && i < NAMES; i++) {
      if (vl_scene_choice_info(scene, choice_kinds[k].kind, i, &info) != VL_OK)
        continue;
      printf("%s%u", i ? ", " : ": ", i);
      if (info.name) {
        putchar(' ');
        text_print_plain(info.name);
      }
      if (choice_kinds[k].kind == VL_CHOICE_ANIMATION)
        printf(" (%g s)", info.seconds);
    }
    if (n)
      puts(n > NAMES ? ", ..." : "");
  }
}

void info_json_names(Json *json, const vlScene *scene) {
  json_begin(json, "names", '{');
  for (int k = 0; k < ID_KINDS; k++) {
    const uint32_t n = vl_scene_id_count(scene, id_kinds[k].kind);
    json_begin(json, id_kinds[k].key, '[');
    for (uint32_t id = 1; id <= n; id++) {
      vlIdInfo info;
      if (vl_scene_id_info(scene, id_kinds[k].kind, id, &info) != VL_OK || !info.name)
        continue;
      json_begin(json, NULL, '{');
      json_put(json, "id %u, name %s, path %s, place %s", id, info.name, info.path, info.place);
      json_end(json, '}');
    }
    json_end(json, ']');
  }
  json_end(json, '}');
}

void info_json_choices(Json *json, const vlScene *scene) {
  for (int k = 0; k < CHOICE_KINDS; k++) {
    const uint32_t n = vl_scene_choice_count(scene, choice_kinds[k].kind);
    vlChoiceInfo info;
    json_begin(json, choice_kinds[k].key, '[');
    for (uint32_t i = 0; i < n; i++) {
      if (vl_scene_choice_info(scene, choice_kinds[k].kind, i, &info) != VL_OK)
        continue;
      json_begin(json, NULL, '{');
      json_put(json, "number %u, name %s", i, info.name);
      if (choice_kinds[k].kind == VL_CHOICE_ANIMATION)
        json_number(json, "seconds", info.seconds);
      json_end(json, '}');
    }
    json_end(json, ']');
  }
}
