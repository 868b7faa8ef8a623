/* test/fuzz/fuzz_view.c: fuzzes the messages that a page of `velo view` sends: parses one and
 * applies its fields to a camera or to a sensor. What is accepted has numbers within the limits
 * that apps/velo/view/message.h states. */
#include "fuzz.h"

#include <math.h>

#include "view/camera_edit.h"
#include "view/sensor_edit.h"

/* Each has all members. */
#define TYPE(NAME) \
  { .name = NAME, .members = UINT32_MAX, .place = MESSAGE_AT_ONCE }
static const MessageType types[] = {TYPE("camera"),  TYPE("sensor"), TYPE("settings"),
                                    TYPE("overlay"), TYPE("pick"),   TYPE("save"),
                                    TYPE("scene"),   {.name = NULL}};

static void check_limits(const ViewMessage *m) {
  bool good = m->field_count <= MESSAGE_FIELDS && fabs(m->x) <= 65536 && fabs(m->y) <= 65536 &&
              fabs(m->exposure) <= 64 && m->spp <= 1 << 24 &&
              (!(m->given & MEMBER_SPP) || m->spp) && m->crop[3] <= 65536;
  for (uint32_t i = 0; i < m->field_count; i++) {
    good &= m->fields[i].count <= MESSAGE_NUMBERS &&
            memchr(m->fields[i].name, 0, sizeof m->fields[i].name);
    for (uint32_t k = 0; k < m->fields[i].count; k++)
      good &= isfinite(m->fields[i].numbers[k]);
  }
  if (!good)
    abort();
}

/* What is accepted can be exposed; what is refused is told in a line. */
static void edit_sensor(const ViewMessage *m) {
  static const ViewSensors sensors;
  const ViewSensor now = sensor_default();
  ViewSensor next = now;
  vlSensorDef def;
  vlError error = {0};
  if (sensor_edit(&now, &sensors, m, &next, &error) != VL_OK) {
    if (!error.message[0] || strchr(error.message, '\n') ||
        memcmp(&now, &next, sizeof now) != 0)
      abort();
    return;
  }
  const vlExposureDef *e = &next.exposure;
  if (!(e->time >= 0 && e->time <= 1e6 && e->iso >= 0 && e->iso <= 1e7 && e->f_number >= 0.5) ||
      sensor_find(&sensors, next.preset, &def, &error) != VL_OK)
    abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static ViewMessage message;
  const char *warning = NULL;
  char why[VL_GIVEN_MESSAGE] = "";
  if (!message_parse(types, (const char *)data, size, &message, why)) {
    if (!why[0])
      abort();
    return 0;
  }
  check_limits(&message);
  const vlCameraDef def = vl_default_camera_def(64, 48);
  vlCamera made;
  ViewCamera camera, next;
  vlError error = {0};
  if (vl_camera_make(&def, &made, NULL, &error) != VL_OK)
    abort();
  if (camera_take(&def, &made, 2, &camera, &error) != VL_OK)
    abort();
  if (message.type != types)
    edit_sensor(&message);
  if (camera_edit(&camera, &message, &next, &warning, &error) != VL_OK && !error.message[0])
    abort();
  return 0;
}
