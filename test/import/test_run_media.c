/* test/import/test_run_media.c: shapes that are combined (curves, small meshes, spheres) have
 * the media of the Shapes from which they are made. These are the media of the state at each
 * Shape, not those of the state when the run of shapes ends. */
#include "import/load.h"
#include "velo/shape_kinds.h"

enum { BEFORE = 4096 };

static const char *const kinds[3] = {
    "Shape \"curve\" \"point3 P\" [0 0 0  0 1 0  0 2 0  0 3 0]\n",
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0] \"integer indices\" [0 1 2]\n",
    "Shape \"sphere\"\n",
};

/* Makes the text of a scene: four shapes in fog, four between mist and fog, and four without
 * media. `integrator` is written before them. */
static char *text_of(const char *shape, const char *integrator) {
  char *text = malloc(20 * (size_t)BEFORE + 4000), *at = text;
  at += sprintf(at, "%sWorldBegin\n", integrator);
  at += sprintf(at,
                "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
                "MakeNamedMedium \"mist\" \"string type\" \"homogeneous\"\n");
  for (int i = 0; i < BEFORE; i++)
    at += sprintf(at, "Shape \"disk\"\n");
  static const char *const media[3] = {"MediumInterface \"fog\" \"\"\n",
                                       "MediumInterface \"mist\" \"fog\"\n", ""};
  for (int k = 0; k < 3; k++) {
    at += sprintf(at, "AttributeBegin\n%s", media[k]);
    for (int i = 0; i < 4; i++)
      at += sprintf(at, "%s", shape);
    at += sprintf(at, "AttributeEnd\n");
  }
  return text;
}

/* The index in `media` of text_of of the media that the shape lies between; 3: none of them. */
static uint32_t media_of(const vlShapeDef *d) {
  static const uint32_t inside[3] = {1, 2, 0}, outside[3] = {0, 1, 0};
  uint32_t k = 0;
  while (k < 3 && (d->inside.index != inside[k] || d->outside.index != outside[k]))
    k++;
  return k;
}

static void runs_lie_in_their_media(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    char *text = text_of(kinds[k], "");
    Loaded l;
    load_fine(&l, text);
    uint32_t seen[3] = {0};
    size_t shapes = l.scene->shapes.count - BEFORE;
    /* 12 Shapes in 3 runs; for curves a change of state alone may also end a run */
    assert_true(shapes <= 4);
    for (size_t i = 0; i < l.scene->shapes.count; i++) {
      const vlShapeDef *d = &l.scene->shapes.items[i];
      if (d->kind == VL_SHAPE_DISK)
        continue;
      uint32_t which = media_of(d);
      assert_true(which < 3);
      seen[which] += d->faces;
    }
    for (int m = 0; m < 3; m++)
      if (seen[m] != 4)
        fail_msg("kind %d: %u shapes in media %d, not 4", k, seen[m], m);
    end_load(&l);
    free(text);
  }
}

/* The warning that an integrator ignores media has the place of the run's first Shape. */
static void runs_are_warned_of(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    char *text = text_of(kinds[k], "Integrator \"path\"\n");
    Loaded l;
    load_fine(&l, text);
    char place[40];
    snprintf(place, sizeof place, "t.pbrt:%d:1: integrator \"path\"", 4 + BEFORE + 3);
    if (!strstr(l.log, place))
      fail_msg("kind %d: no warning at %s in\n%s", k, place, l.log);
    end_load(&l);
    free(text);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(runs_lie_in_their_media),
      cmocka_unit_test(runs_are_warned_of),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
