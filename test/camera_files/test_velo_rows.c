/* test/camera_files/test_velo_rows.c: velo's JSON holds every parameter of the cameras' rows: a
 * value other than the default is written and read again. */
#include "camera_files/files.h"

#include "base/array.h"
#include "velo/schema.h"

#include "../src/camera_files/files.h" /* the room's header, which has the name of the tests' */

/* Parameters of rows that set other members (words), or that the file holds in another form
 * (blocks, `shape`). Whoever adds one must decide how velo's JSON holds it. */
static bool is_held_in_another_form(const vlParameter *p) {
  static const char *const words[] = {
      "screen_min_x", "focus_distance", "projection",    "lens.optics",
      "fov",          "shape[0]",       "shutter_points"};
  static const char *const blocks[] = {"screen_min_x",  "screen_min_y",
                                       "shutter_at",    "lens.focus_pixel",
                                       "lens.aperture", "distortion_coefficients"};
  const bool word = p->flags & VL_PARAMETER_SHORTHAND;
  const char *const *list = word ? words : blocks;
  const size_t count = word ? sizeof words / sizeof *words : sizeof blocks / sizeof *blocks;
  for (size_t i = 0; i < count; i++)
    if ((word || p->type == VL_PARAMETER_BLOCK) && strcmp(p->member, list[i]) == 0)
      return true;
  return false;
}

/* A value that no camera has by default. */
static void set_other(const vlParameter *p, vlCameraDef *def) {
  char *at = (char *)def + p->offset;
  const double odd[3] = {0.21, -0.43, 0.87};
  const int choice = p->value[0] != 1.0 ? 1 : 0;
  const uint32_t count = 7;
  const bool flag = p->value[0] == 0.0;
  if (p->type == VL_PARAMETER_DOUBLE || p->type == VL_PARAMETER_DOUBLE3)
    memcpy(at, odd, p->size);
  else if (p->type == VL_PARAMETER_CHOICE)
    memcpy(at, &choice, sizeof choice);
  else if (p->type == VL_PARAMETER_COUNT)
    memcpy(at, &count, sizeof count);
  else if (p->type == VL_PARAMETER_BOOL)
    memcpy(at, &flag, sizeof flag);
  else
    fail_msg("%s: velo's JSON holds no parameter of this type", p->member);
}

static void check_parameter(const char *camera, const vlParameter *p) {
  vlCameraRecord record = {.camera = vl_default_camera_def(64, 48), .frames = 1};
  record.camera.fov = 1.0; /* else its axis is not written */
  if (strcmp(p->member, "shape[1]") == 0)
    record.camera.shape[0] = 0.5; /* a list */
  set_other(p, &record.camera);
  vlCameraText text = {.context = context};
  vl_camera_put_velo(&record, &text);
  assert_false(text.failed);
  put_bytes("rows.json", text.text.items, text.text.count);
  VL_ARRAY_FREE(context, &text.text);
  const vlCameraRecord back = read_with(path_of("rows.json"), NULL);
  if (memcmp((const char *)&back.camera + p->offset, (const char *)&record.camera + p->offset,
             p->size) != 0)
    fail_msg("camera %s: velo's JSON does not hold %s", camera, p->member);
}

static void test_all_parameters(void **state) {
  (void)state;
  const vlKindFamily *cameras = vl_kind_family_find("cameras");
  uint32_t checked = 0;
  for (uint32_t i = 0; i < cameras->kind_count; i++)
    for (uint32_t k = 0; k < cameras->rows[i]->parameter_count; k++) {
      const vlParameter *p = &cameras->rows[i]->parameters[k];
      if (is_held_in_another_form(p))
        continue;
      check_parameter(cameras->words[i], p);
      checked++;
    }
  assert_true(checked > 300);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_all_parameters)};
  return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
