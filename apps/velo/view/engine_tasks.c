/* view/engine_tasks.c: answers to messages that need the world: of the render thread, which has
 * the film, and of a thread beside it, with a higher priority. */
#include <math.h>
#include <string.h>

#include "cli/crop.h"
#include "velo/channels.h"
#include "velo/focus.h"
#include "view/engine_status.h"

Json *engine_reply_begin(const ViewMessage *m, const char *type) {
  Json *json = json_text_begin(type);
  if (json)
    json_integer(json, "id", m->id);
  return json;
}

void engine_refuse(Engine *e, const ViewMessage *m, const char *why) {
  engine_post(e, m->client, "refused", "change %u, id %u, field %s, message %s", m->change,
              m->id, m->field_count ? m->fields[0].name : "", why);
}

Json *engine_reply_with(Engine *e, const ViewMessage *m, const char *type, vlResult result,
                        const vlError *error) {
  if (result != VL_OK)
    engine_refuse(e, m, error->message);
  return result == VL_OK ? engine_reply_begin(m, type) : NULL;
}

ViewCamera engine_camera(Engine *e) {
  engine_lock(e);
  ViewCamera camera = e->wanted.camera;
  engine_unlock(e);
  return camera;
}

/* ---- a pixel ----------------------------------------------------------------------------- */

static void put_values(Json *json, const char *key, const vlImage *image,
                       const char *const *names, int count) {
  json_begin(json, key, '[');
  for (int i = 0; i < count; i++) {
    int channel = vl_image_find_channel(image, names[i]);
    json_number(json, NULL,
                channel < 0 ? NAN : (double)vl_image_get(image, 0, 0, (uint32_t)channel));
  }
  json_end(json, ']');
}

static void put_id(Json *json, const Engine *e, const vlImage *ids, const char *channel,
                   vlIdKind kind, const char *key) {
  int at = vl_image_find_channel(ids, channel);
  const uint32_t id = at < 0 ? 0 : ((const uint32_t *)vl_image_const_pixels(ids))[at];
  vlIdInfo info;
  json_begin(json, key, '{');
  json_integer(json, "id", id);
  if (id && vl_world_id_info(e->model.world, kind, id, &info) == VL_OK) {
    json_put(json, "name %s, type %s, file %s", info.name, info.type, info.source.file);
    if (info.source.file)
      json_integer(json, "line", info.source.line);
  }
  json_end(json, '}');
}

bool engine_is_in_image(Engine *e, const ViewMessage *m, const vlCamera *camera) {
  const bool inside = m->x >= 0 && m->y >= 0 && m->x < camera->width && m->y < camera->height;
  if (!inside)
    engine_refuse(e, m, "the point is outside the image");
  return inside;
}

void engine_pick(Engine *e, const ViewMessage *m) {
  const ViewCamera camera = engine_camera(e);
  const vlCamera *c = &camera.made;
  if (!engine_is_in_image(e, m, c))
    return;
  vlChannelsDef def = vl_default_channels_def(c->width, c->height);
  uint32_t x = (uint32_t)m->x, y = (uint32_t)m->y;
  crop_set_pixel(def.crop, x, y);
  def.priority = 2;
  def.cancel = e->end;
  def.channels = VL_CHANNEL_ALL & ~(uint32_t)(VL_CHANNEL_SAMPLES | VL_CHANNEL_FILM);
  vlImage *floats = NULL, *ids = NULL;
  vlError error = {0};
  vlResult result = vl_render_channels(e->model.world, c, &def, &floats, &ids, &error);
  Json *json = engine_reply_with(e, m, "picked", result, &error);
  if (json) {
    static const char *const vectors[][4] = {{"P", "P.X", "P.Y", "P.Z"},
                                             {"N", "N.X", "N.Y", "N.Z"},
                                             {"Ng", "Ng.X", "Ng.Y", "Ng.Z"},
                                             {"albedo", "albedo.R", "albedo.G", "albedo.B"},
                                             {"ray", "ray.X", "ray.Y", "ray.Z"}};
    static const char *const uv[] = {"uv.U", "uv.V"}, *const z[] = {"Z"},
                             *const distance[] = {"distance.Y"};
    json_put(json, "x %u, y %u", x, y);
    put_values(json, "Z", floats, z, 1);
    put_values(json, "distance", floats, distance, 1);
    put_values(json, "uv", floats, uv, 2);
    for (int i = 0; i < 5; i++)
      put_values(json, vectors[i][0], floats, vectors[i] + 1, 3);
    put_id(json, e, ids, "id.object", VL_ID_OBJECT, "object");
    put_id(json, e, ids, "id.material", VL_ID_MATERIAL, "material");
    put_id(json, e, ids, "id.instance", VL_ID_INSTANCE, "instance");
    json_text_post(json, e->server, m->client);
  }
  vl_image_destroy(floats);
  vl_image_destroy(ids);
}

void engine_focus(Engine *e, const ViewMessage *m) {
  const ViewCamera camera = engine_camera(e);
  ViewCamera next;
  vlError error = {0};
  double distance;
  vlResult result = vl_autofocus(e->model.world, &camera.made, m->x, m->y, &distance, &error);
  engine_lock(e);
  /* an edit may have come meanwhile: it keeps all but the distance, and its change number */
  if (result == VL_OK)
    result = camera_set_focus(&e->wanted.camera, distance, &next, &error);
  if (result != VL_OK) {
    engine_unlock(e);
    engine_refuse(e, m, error.message);
    return;
  }
  const uint32_t change = e->wanted.change > m->change ? e->wanted.change : m->change;
  engine_take_camera(e, &next, change, 0);
  pthread_cond_broadcast(&e->wake);
  engine_unlock(e);
}

void engine_add_task(Engine *e, const ViewMessage *m, TaskList *tasks) {
  if (tasks->count == MAX_TASKS)
    engine_refuse(e, m, "too much at once");
  else
    tasks->messages[tasks->count++] = *m;
}

bool engine_take_task(const Engine *e, TaskList *tasks, ViewMessage *first) {
  if (e->quit || tasks->count == 0)
    return false;
  *first = tasks->messages[0];
  tasks->count--;
  memmove(tasks->messages, tasks->messages + 1, tasks->count * sizeof *tasks->messages);
  return true;
}

bool engine_answer_question(Engine *e) {
  static ViewMessage question; /* the thread that answers alone uses it */
  engine_lock(e);
  bool any = engine_take_task(e, &e->questions, &question);
  engine_unlock(e);
  if (!any)
    return false;
  pthread_rwlock_rdlock(&e->model_lock);
  question.type->answer(e, &question);
  pthread_rwlock_unlock(&e->model_lock);
  return true;
}
