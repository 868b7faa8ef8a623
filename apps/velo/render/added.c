/* render/added.c: see added.h. */
#include "render/added.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/json.h"
#include "cli/macros.h"
#include "cli/options.h"
#include "render/job.h"

/* ---- numbers ----------------------------------------------------------------------------- */

/* Writes a number that reads back as the same float. */
static void put_float(char *text, float value) {
  snprintf(text, ADDED_TEXT, "%.6g", (double)value);
  if ((float)strtod(text, NULL) != value)
    snprintf(text, ADDED_TEXT, "%.9g", (double)value);
}

static void put_point(char *text, const double p[3]) {
  char numbers[3][30];
  for (int i = 0; i < 3; i++)
    format_number(numbers[i], sizeof numbers[i], p[i]);
  snprintf(text, ADDED_TEXT, "%s,%s,%s", numbers[0], numbers[1], numbers[2]);
}

/* Writes an angle in degrees or, where no number of degrees reads back as the same bits, in
 * radians. */
static void put_angle(char *text, size_t size, double radians) {
  for (int digits = 1; digits <= 17; digits++) {
    snprintf(text, size, "%.*g", digits, radians * 180.0 / 3.14159265358979323846);
    if (!strchr(text, 'e') && option_radians(strtod(text, NULL)) == radians)
      return;
  }
  format_number(text, size, radians);
  strncat(text, "rad", size - strlen(text) - 1);
}

/* ---- the options ------------------------------------------------------------------------- */

/* Adds an option. The caller writes its text to the buffer that is returned. */
static char *add(AddedOptions *added, int id) {
  char *text = added->texts[added->count];
  added->items[added->count].id = id;
  added->items[added->count++].text = text;
  return text;
}

static void add_light(const SceneOpening *opening, const Arguments *arguments,
                      AddedOptions *added) {
  const char *const *names = vl_setting(VL_SETTING_COMPLETE, "environment")->choices;
  const vlCompleteDef *d = &opening->complete;
  const bool none = d->environment == VL_ENVIRONMENT_NONE;
  if (none && !opening->model && !arguments->values[RENDER_ENVIRONMENT].given)
    return;
  snprintf(add(added, RENDER_ENVIRONMENT), ADDED_TEXT, "%s", names[d->environment]);
  if (d->environment == VL_ENVIRONMENT_FILE)
    added->items[added->count - 1].text = d->path;
  if (none)
    return;
  if (vl_environment_is_studio(d->environment) || d->rotation != 0)
    put_angle(add(added, RENDER_ENVIRONMENT_ROTATION), ADDED_TEXT, d->rotation);
  if (d->strength != 1.0f)
    put_float(add(added, RENDER_ENVIRONMENT_STRENGTH), d->strength);
}

static void add_ground(const SceneOpening *opening, AddedOptions *added) {
  const vlCompleteDef *d = &opening->complete;
  if (!d->ground && !d->backdrop) {
    if (opening->model && vl_environment_is_studio(d->environment)) {
      add(added, RENDER_NO_GROUND);
      added->items[added->count - 1].text = NULL;
    }
    return;
  }
  if (d->ground) {
    add(added, RENDER_GROUND);
    added->items[added->count - 1].text = NULL;
  }
  put_point(add(added, RENDER_GROUND_MIDDLE), d->ground_middle);
  put_float(add(added, RENDER_GROUND_RADIUS), (float)d->ground_radius);
}

/* The name of the axis that points up; null: it has none. */
static const char *name_of_up(const vlCompleteDef *d) {
  for (const Choice *c = up_choices; c->name; c++) {
    vlCompleteDef other = *d;
    scene_choose_up(c->value, &other);
    if (memcmp(other.up, d->up, sizeof d->up) == 0 &&
        memcmp(other.front, d->front, sizeof d->front) == 0)
      return c->name;
  }
  return NULL;
}

void added_options(const SceneOpening *opening, const Arguments *arguments, bool camera,
                   AddedOptions *added) {
  const vlCompleteDef *d = &opening->complete;
  added->count = 0;
  add_light(opening, arguments, added);
  add_ground(opening, added);
  if (camera) {
    char *text = add(added, RENDER_FRAMING);
    put_angle(text, ADDED_TEXT, d->azimuth);
    strcat(text, ",");
    put_angle(text + strlen(text), ADDED_TEXT - strlen(text), d->elevation);
  }
  if (d->open_walls)
    put_point(add(added, RENDER_WALLS), d->walls_from);
  else if (d->both_sides)
    strcpy(add(added, RENDER_WALLS), "both-sides");
  else if (camera)
    strcpy(add(added, RENDER_WALLS), "keep");
  const char *up = name_of_up(d);
  if (up && (camera || d->environment != VL_ENVIRONMENT_NONE || d->ground || d->backdrop))
    strcpy(add(added, RENDER_UP), up);
}

bool added_replaces(int option) {
  static const int all[] = {RENDER_ENVIRONMENT,
                            RENDER_ENVIRONMENT_ROTATION,
                            RENDER_ENVIRONMENT_STRENGTH,
                            RENDER_GROUND,
                            RENDER_NO_GROUND,
                            RENDER_GROUND_MIDDLE,
                            RENDER_GROUND_RADIUS,
                            RENDER_FRAMING,
                            RENDER_WALLS,
                            RENDER_UP};
  return option_is_in(option, all, LENGTH(all));
}

bool added_has(const AddedOptions *added, int option, const char **text) {
  for (int i = 0; i < added->count; i++)
    if (added->items[i].id == option) {
      *text = added->items[i].text;
      return true;
    }
  return false;
}
