/* import/obj/obj_label.c: names of objects (o), groups (g) and materials become labels of
 * shapes. */

#include "base/text.h"
#include "import/obj/obj.h"

/* Index 0 stands for faces before the first o or g. A new object has no group. */
bool vl_obj_open_object(vlObj *obj, bool group) {
  const char *name = vl_obj_rest(obj);
  obj->part_open = false;
  if (!VL_RESERVE(obj->context, &obj->objects, 2))
    return vl_obj_fail_memory(obj);
  if (!obj->objects.count)
    obj->objects.items[obj->objects.count++] = (vlObjObject){NULL, NULL};
  const char *object = group ? obj->objects.items[obj->objects.count - 1].object : name;
  if (!vl_scene_copy_string(obj->scene, &name))
    return false;
  obj->objects.items[obj->objects.count++] =
      (vlObjObject){.object = group ? object : name, .group = group ? name : NULL};
  return true;
}

/* A mesh of several materials is one part per material. */
static bool has_neighbour(const vlObj *obj, size_t part) {
  const uint32_t own = obj->parts.items[part].object;
  return (part > 0 && obj->parts.items[part - 1].object == own) ||
         (part + 1 < obj->parts.count && obj->parts.items[part + 1].object == own);
}

bool vl_obj_label(vlObj *obj, vlNameTable *names, size_t part, vlLabel *label) {
  const vlObjPart *p = &obj->parts.items[part];
  const vlObjObject none = {NULL, NULL},
                    *o = p->object ? &obj->objects.items[p->object] : &none;
  const char *material = obj->materials.items[p->material].name;
  char name[VL_LABEL_SIZE] = "", path[VL_LABEL_SIZE];
  vl_label_append(name, o->object);
  if (!o->object || (o->group && !vl_text_is(o->object, o->group)))
    vl_label_append(name, o->group);
  memcpy(path, name, sizeof path);
  vl_label_append(path, material);
  if (!*name || has_neighbour(obj, part))
    vl_label_append(name, material);
  if (!*name)
    vl_label_of_file(obj->path, name);
  *label = (vlLabel){.path = *path ? path : NULL};
  return vl_label_make_unique(obj->scene, names, name, p->line, &label->name) &&
         vl_scene_copy_string(obj->scene, &label->path);
}
