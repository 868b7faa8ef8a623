/* view/engine_overlay.c: what the page draws over the image: vanishing points, horizon, boxes
 * of objects. */
#include <stdlib.h>

#include "velo/boxes.h"
#include "velo/vanishing.h"
#include "view/engine_status.h"

enum { MAX_BOXES = 500 };

static void put_vanishing(Json *json, const vlCamera *camera, const double up[3]) {
  static const char *const kinds[] = {"none", "finite", "infinite"};
  vlVanishingPoints points;
  if (!vl_camera_vanishing_points(camera, up, &points))
    return;
  json_begin(json, "vanishing", '[');
  for (int i = 0; i < 3; i++) {
    const vlVanishingPoint *p = &points.axes[i];
    json_begin(json, NULL, '{');
    json_text(json, "kind", kinds[p->kind]);
    for (int k = 0; k < 2; k++)
      json_number(json, k ? "y" : "x",
                  p->kind == VL_VANISHING_INFINITE ? p->direction[k] : p->pixel[k]);
    json_end(json, '}');
  }
  json_end(json, ']');
  if (!points.has_horizon)
    return;
  json_numbers(json, "horizon", points.horizon, 3);
}

/* Boxes of the objects, those with the most pixels first as long as there is room. */
static void put_boxes(Json *json, Engine *e, const vlCamera *camera) {
  uint32_t count = vl_world_id_count(e->model.world, VL_ID_OBJECT), put = 0;
  vlIdBox *boxes = calloc(count ? count : 1, sizeof *boxes);
  vlBoxesDef def = vl_default_boxes_def(camera->width, camera->height);
  vlError error = {0};
  def.cancel = e->end;
  if (!boxes || vl_world_boxes(e->model.world, camera, &def, boxes, NULL, &error) != VL_OK) {
    free(boxes);
    return;
  }
  json_begin(json, "boxes", '[');
  for (uint32_t i = 0; i < count && put < MAX_BOXES; i++) {
    vlIdInfo info;
    if (!boxes[i].seen || vl_world_id_info(e->model.world, VL_ID_OBJECT, i + 1, &info) != VL_OK)
      continue;
    json_begin(json, NULL, '{');
    json_put(json, "id %u, name %s", i + 1, info.name ? info.name : "");
    json_integers(json, "box", boxes[i].seen_box, 4);
    json_end(json, '}');
    put++;
  }
  json_end(json, ']');
  free(boxes);
}

void engine_overlay(Engine *e, const ViewMessage *m) {
  Json *json = engine_reply_begin(m, "overlay");
  if (!json)
    return;
  engine_lock(e);
  const ViewCamera camera = e->wanted.camera;
  uint32_t change = e->wanted.change;
  engine_unlock(e);
  const CameraPose pose = camera_pose(&camera);
  json_integer(json, "change", change);
  put_vanishing(json, &camera.made, pose.up);
  if (m->curves || m->field)
    engine_put_curves(json, &camera, &e->model.info, m->field);
  if (m->boxes)
    put_boxes(json, e, &camera.made);
  json_text_post(json, e->server, m->client);
}
