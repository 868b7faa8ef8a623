/* render/near.c: see near.h. */
#include "render/near.h"

#include <math.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/vector.h"
#include "render/job.h"
#include "render/outputs.h"
#include "velo/edit.h"

bool near_is_allowed(const Arguments *arguments) {
  static const int data[] = {RENDER_CHANNELS, RENDER_SPECTRUM, RENDER_HALF,  RENDER_STEREO,
                             RENDER_FILM,     RENDER_CONTINUE, RENDER_AGAIN, RENDER_SHARD};
  const OptionValue *v = arguments->values;
  bool images_only = true;
  for (size_t i = 0; i < LENGTH(data); i++)
    images_only = images_only && !v[data[i]].given;
  for (int i = 0; i < arguments->text_count; i++)
    images_only = images_only && output_is_display(arguments->texts[i]);
  if (v[RENDER_DENOISE].given)
    images_only = images_only && output_is_display(v[RENDER_DENOISE].text);
  return images_only;
}

/* The middle of the box in whole numbers. Returns its distance from the origin, divided by the
 * box's size. */
static double find_middle(const double low[3], const double high[3], double middle[3]) {
  double size = 0, max = 0;
  for (int i = 0; i < 3; i++) {
    middle[i] = floor(0.5 * (low[i] + high[i]) + 0.5);
    size = fmax(size, high[i] - low[i]);
    max = fmax(max, fabs(middle[i]));
  }
  return size > 0 && isfinite(max) ? max / size : 0;
}

static void move_camera(vlCameraDef *camera, const double middle[3]) {
  vector_subtract(camera->eye, middle, camera->eye);
  vector_subtract(camera->lookat, middle, camera->lookat);
}

int near_move(vlScene *scene, const char *path, SceneOpening *opening) {
  const double far = 100;             /* sizes of the model */
  const double float_error = 0x1p-24; /* largest relative rounding error of a float */
  double middle[3];
  const double away = find_middle(opening->low, opening->high, middle);
  if (!(away > far))
    return -1;
  if (!opening->images_only) {
    const double max = fmax(fabs(middle[0]), fmax(fabs(middle[1]), fabs(middle[2])));
    report_note(
        "the model lies %.3g times its size from the origin: its positions are rounded to "
        "about %.2g; .png, .jpg and .tga alone are rendered about its middle, without this",
        away, max * float_error);
    return -1;
  }
  const double world_from_scene[16] = {1, 0, 0, -middle[0], 0, 1, 0, -middle[1],
                                       0, 0, 1, -middle[2], 0, 0, 0, 1};
  vlError error = {0};
  TRY(report_error(&error, vl_scene_transform(scene, world_from_scene, &error), path));
  move_camera(&vl_scene_defs(scene)->camera, middle);
  vector_subtract(opening->low, middle, opening->low);
  vector_subtract(opening->high, middle, opening->high);
  memcpy(opening->moved, middle, 3 * sizeof *opening->moved);
  if (!opening->silent)
    report_note(
        "the model lies %.3g times its size from the origin: it is rendered about "
        "(%.12g, %.12g, %.12g)",
        away, middle[0], middle[1], middle[2]);
  return -1;
}
