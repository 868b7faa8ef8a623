/* view/engine_outside.c: the camera from outside: the lines of its drawing, which the page
 * projects, and a small image of the scene behind them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "camera/poses.h"
#include "image/display.h"
#include "image/image.h"
#include "velo/drawing.h"
#include "view/engine_status.h"

enum { MAX_SIDE = 800, OUTSIDE_SPP = 2 };

/* vertical; web/outside.js has the same */
static const double outside_fov = 40 * M_PI / 180;

static const MessageField *find_field(const ViewMessage *m, const char *name, uint32_t count) {
  for (uint32_t i = 0; i < m->field_count; i++)
    if (strcmp(m->fields[i].name, name) == 0 && m->fields[i].count == count)
      return &m->fields[i];
  return NULL;
}

static void put_point(Json *json, const double point[3]) {
  for (int i = 0; i < 3; i++)
    json_number(json, NULL, point[i]);
}

static void put_drawing(Json *json, const vlDrawing *d) {
#define NAME(part, name) #name,
  static const char *const parts[] = {VL_DRAWING_PARTS(NAME)};
#undef NAME
  json_begin(json, "lines", '[');
  for (uint32_t i = 0; i < d->line_count; i++) {
    json_begin(json, NULL, '[');
    json_text(json, NULL, parts[d->lines[i].part]);
    put_point(json, d->lines[i].from);
    put_point(json, d->lines[i].to);
    json_end(json, ']');
  }
  json_end(json, ']');
  json_begin(json, "labels", '[');
  for (uint32_t i = 0; i < d->label_count; i++) {
    json_begin(json, NULL, '[');
    json_text(json, NULL, d->labels[i].text);
    put_point(json, d->labels[i].at);
    json_end(json, ']');
  }
  json_end(json, ']');
}

/* The view plane where the page has it, so that it moves with d while it is dragged; else at
 * the lecture's d, where that is before what the camera looks at; else nearer. */
static double plane_distance(const ViewCamera *camera, const MessageField *given) {
  double d = camera->def.view_distance, arm = camera->units.lookat;
  const CameraPose pose = camera_pose(camera);
  if (!camera->def.has_matrix)
    arm = camera_arm(&pose);
  if (given && given->numbers[0] > 0.02 * arm && given->numbers[0] < 4 * arm)
    return given->numbers[0];
  return d > 0.02 * arm && d < 4 * arm ? d : 0.4 * arm;
}

void engine_outline(Engine *e, const ViewMessage *m) {
  const ViewCamera camera = engine_camera(e);
  const MessageField *point = find_field(m, "point", 3);
  vlDrawingDef def = vl_default_drawing_def();
  vlDrawing *drawing = NULL;
  vlError error = {0};
  def.plane = plane_distance(&camera, find_field(m, "plane", 1));
  def.reach = fmax(1.3 * camera.units.lookat, 1.05 * def.plane);
  def.points = point ? point->numbers : NULL;
  def.point_count = point ? 1 : 0;
  vlResult result = vl_camera_outline(e->def.context, &camera.made, 1, &def, &drawing, &error);
  Json *json = engine_reply_with(e, m, "outline", result, &error);
  if (json) {
    json_put(json, "plane %g, d %g", def.plane, camera.def.view_distance);
    put_drawing(json, drawing);
    json_text_post(json, e->server, m->client);
  }
  vl_drawing_destroy(drawing);
}

void engine_cameras(Engine *e, const ViewMessage *m) {
  const Model *model = &e->model;
  vlDrawingDef def = vl_default_drawing_def();
  vlDrawing *drawing = NULL;
  vlError error = {0};
  vlResult result = VL_OK;
  double plane = poses_plane(model->cameras, model->camera_count);
  def.plane = plane > 0 ? plane : 0.1 * model->lookat;
  def.parts &= ~(1u << VL_DRAWING_GRID);
  if (model->camera_count)
    result = vl_camera_outline(e->def.context, model->cameras, model->camera_count, &def,
                               &drawing, &error);
  Json *json = engine_reply_with(e, m, "cameras", result, &error);
  if (json) {
    if (drawing)
      put_drawing(json, drawing);
    json_begin(json, "poses", '[');
    for (uint32_t i = 0; i < model->camera_count; i++)
      json_numbers(json, NULL, model->cameras[i].world_from_camera, 16);
    json_end(json, ']');
    json_text_post(json, e->server, m->client);
  }
  vl_drawing_destroy(drawing);
}

/* ---- the scene from outside -------------------------------------------------------------- */

/* Bytes as base64 (RFC 4648); null: no memory. */
static char *to_base64(const uint8_t *data, size_t size) {
  static const char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  char *text = malloc((size + 2) / 3 * 4 + 1), *to = text;
  if (!text)
    return NULL;
  for (size_t i = 0; i < size; i += 3) {
    uint32_t left = size - i < 3 ? (uint32_t)(size - i) : 3, bits = 0;
    for (uint32_t k = 0; k < 3; k++)
      bits = bits << 8 | (k < left ? data[i + k] : 0u);
    for (uint32_t k = 0; k < 4; k++)
      *to++ = k <= left ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  *to = 0;
  return text;
}

static vlResult make_camera(const ViewMessage *m, vlCamera *camera, vlError *error) {
  static const char *const names[] = {"eye", "lookat", "up"};
  uint32_t width = m->size[0] ? m->size[0] : 320, height = m->size[1] ? m->size[1] : 200;
  vlCameraDef def = vl_default_camera_def(width < MAX_SIDE ? width : MAX_SIDE,
                                          height < MAX_SIDE ? height : MAX_SIDE);
  double *const values[] = {def.eye, def.lookat, def.up};
  for (int i = 0; i < 3; i++) {
    const MessageField *field = find_field(m, names[i], 3);
    if (field)
      memcpy(values[i], field->numbers, 3 * sizeof(double));
  }
  def.fov = outside_fov;
  def.fov_axis = VL_FOV_VERTICAL;
  return vl_camera_make(&def, camera, NULL, error);
}

static vlResult render_outside(const Engine *e, const vlCamera *camera, vlImage **image,
                               vlError *error) {
  vlRenderDef render = engine_render_def(e, OUTSIDE_SPP);
  vlFilmDef def = vl_default_film_def(camera->width, camera->height);
  def.max_component = 10;
  render.sequence = 0;
  if (render.max_depth > 3)
    render.max_depth = 3;
  render.cancel = e->end;
  render.priority = 1;
  return image_render(e->def.context, e->model.world, camera, &def, &render,
                      &e->model.job.defs->develop, image, error);
}

void engine_outside(Engine *e, const ViewMessage *m) {
  vlCamera camera;
  vlImage *image = NULL, *shown = NULL;
  void *data = NULL;
  size_t size = 0;
  vlError error = {0};
  vlWriteDef write = vl_default_write_def();
  write.quality = 85;
  vlResult result = make_camera(m, &camera, &error);
  if (result == VL_OK)
    result = render_outside(e, &camera, &image, &error);
  if (result == VL_OK)
    result = display_image(e->def.context, image, VL_VIEW_STANDARD, (float)m->exposure, false,
                           &shown);
  if (result == VL_OK)
    result = vl_image_write_memory(shown, ".jpg", &write, &data, &size, &error);
  char *bytes = result == VL_OK ? to_base64(data, size) : NULL;
  if (bytes)
    engine_post(e, m->client, "outside", "id %u, data %s", m->id, bytes);
  else if (result != VL_CANCELLED)
    engine_refuse(e, m, error.message);
  free(bytes);
  vl_release(e->def.context, data);
  vl_image_destroy(image);
  vl_image_destroy(shown);
}
