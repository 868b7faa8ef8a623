/* conformance/lights.h: the laws of lights, of the emission of shapes and of the shapes that
 * emit, asked at points of a floor: a sample's radiance is the emission along its direction
 * over the density; the density integrates to 1 where there is light, so that the mean of the
 * samples is the integral of the emission; lights that no ray can hit shine as the closed form
 * says. */
#ifndef TEST_CONFORMANCE_LIGHTS_H
#define TEST_CONFORMANCE_LIGHTS_H

#include "conformance.h"
#include "parameter_cases.h"
#include "schema/schema.h"
#include "shapes.h"
#include "trace/trace.h"
#include "unit.h"
#include "velo/edit.h"
#include "velo/filter_kinds.h"
#include "velo/light.h"
#include "velo/tracer.h"

/* ---- asking ------------------------------------------------------------------------------ */

typedef struct LightLaws {
  double x, z; /* the point of the floor */
  vlTraceRays *rays;
  vlTraceHits *hits;
  vlTraceLights *lights;
  Mean sampled[3], integral[3];
  Mean irradiance; /* green, from directions above the floor */
  uint32_t compared, wrong, deltas;
} LightLaws;

static void ask_light(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  static uint8_t hidden[VL_OWN_BATCH];
  LightLaws *l = probe->user;
  const double above[3] = {l->x, 0.02, l->z};
  const double down[3] = {0, -1, 0};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    set_ray(l->rays, i, above, down);
  vl_world_trace(trace, l->rays, l->hits);
  assert_true(isfinite(l->hits->t[0]));
  vl_trace_lights(trace, 0, l->lights);
  vl_world_occluded(trace, &l->lights->rays, hidden);
  /* the emission of even directions of the upper half */
  double sum[3] = {0, 0, 0};
  double cosines[VL_OWN_BATCH];
  double falls = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    const double from[3] = {l->x, 1e-5, l->z};
    even_direction(i, 2 * VL_OWN_BATCH, 0.7548776662 * probe->batch, w);
    double y = w[1];
    w[1] = w[2];
    w[2] = y;
    cosines[i] = w[1];
    set_ray(l->rays, i, from, w);
  }
  vl_world_trace(trace, l->rays, l->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    for (int c = 0; c < 3; c++)
      sum[c] += (double)l->hits->emission[c][i];
  for (int c = 0; c < 3; c++)
    mean_add(&l->integral[c], sum[c] * 2 * PI / VL_OWN_BATCH);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    falls += (double)l->hits->emission[1][i] * cosines[i];
  mean_add(&l->irradiance, falls * 2 * PI / VL_OWN_BATCH);
  /* the emission along the samples */
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double from[3] = {l->x, 1e-5, l->z};
    const double w[3] = {(double)l->lights->direction[0][i], (double)l->lights->direction[1][i],
                         (double)l->lights->direction[2][i]};
    set_ray(l->rays, i, from, l->lights->pdf[i] > 0 ? w : down);
  }
  vl_world_trace(trace, l->rays, l->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    bool up = l->lights->direction[1][i] > 0;
    bool alike = true;
    for (int c = 0; c < 3; c++) {
      double radiance = (double)l->lights->radiance[c][i];
      double emitted = (double)l->hits->emission[c][i];
      mean_add(&l->sampled[c], up && !hidden[i] ? radiance : 0);
      alike = alike &&
              fabs(radiance * (double)l->lights->pdf[i] - emitted) <= 0.01 * emitted + 1e-5;
    }
    l->deltas += l->lights->delta[i];
    if (l->lights->pdf[i] > 0 && up && !hidden[i] && !l->lights->delta[i]) {
      l->compared++;
      l->wrong += !alike;
    }
  }
}

static LightLaws ask_floor(const char *text, double x, double z, uint32_t batches) {
  LightLaws l = {.x = x, .z = z, .rays = new_rays()};
  l.hits = calloc(1, sizeof *l.hits);
  l.lights = calloc(1, sizeof *l.lights);
  Probe probe = {.ask = ask_light, .user = &l};
  probe_world(text, &probe, batches);
  free(l.rays);
  free(l.hits);
  free(l.lights);
  return l;
}

/* The path tracer's radiance of a small part of the floor around (x, z), by light that comes
 * straight from the lights. */
static Mean floor_seen(const char *text, double x, double z) {
  enum { FLOOR_SAMPLES = 512 };
  vlImage *image = image_of_floor(text, VL_TRACER_PATH, FLOOR_SAMPLES, x, z, 0.02);
  Mean mean = mean_of_image(image);
  vl_image_destroy(image);
  return mean;
}

/* The floor reflects half of the light that falls on it, evenly over all directions. */
static void check_reflected(const char *family, const char *kind, const char *parameters,
                            const char *text, const double at[2], const Mean *irradiance) {
  Mean seen = floor_seen(text, at[0], at[1]);
  Mean falls = {.sum = irradiance->sum * 0.5 / PI,
                .squares = irradiance->squares * 0.25 / (PI * PI),
                .count = irradiance->count};
  double whole = mean_of(&falls);
  char what[400];
  snprintf(what, sizeof what, "%.200s: reflected, and what falls on the floor", parameters);
  check_same_mean(family, kind, what, &seen, &falls, (Sight){0.008 * whole, 0.08 * whole});
}

/* The laws of light that rays can hit, at a few points of the floor. */
static void check_hit_light(const char *family, const char *kind, const char *parameters,
                            const char *text, bool compensated) {
  static const double points[][2] = {{0.1, 0.2}, {-0.2, 0.4}};
  char what[400];
  for (int k = 0; k < 2; k++) {
    LightLaws l = ask_floor(text, points[k][0], points[k][1], 112);
    if (l.compared < 1000)
      broken(family, kind, "%s: %u samples of 16384", parameters, l.compared);
    if (l.wrong > l.compared / 50)
      broken(family, kind, "%s: %u of %u samples are not emission over density", parameters,
             l.wrong, l.compared);
    check_reflected(family, kind, parameters, text, points[k], &l.irradiance);
    for (int c = 0; c < 3 && !compensated; c++) {
      double whole = mean_of(&l.integral[c]);
      snprintf(what, sizeof what, "%s: samples, and the emission's integral", parameters);
      check_same_mean(family, kind, what, &l.sampled[c], &l.integral[c],
                      (Sight){0.005 * whole, 0.06 * whole});
    }
  }
}

/* Only that each sample has the emission that a ray finds: also none. */
static void check_samples_of_light(const char *family, const char *kind, const char *what,
                                   const char *text) {
  const LightLaws l = ask_floor(text, 0.1, 0.2, 4);
  if (l.wrong > l.compared / 50)
    broken(family, kind, "%s: %u of %u samples are not emission over density", what, l.wrong,
           l.compared);
}

static bool is_known(const LightVariant *v, uint32_t k) {
  static const LightKnown end;
  return k < sizeof v->known / sizeof *v->known && memcmp(&v->known[k], &end, sizeof end) != 0;
}

static void check_delta_light(const char *kind, const LightVariant *v, const char *text) {
  assert_true(is_known(v, 0) || v->before); /* in another frame they may be unknown */
  for (uint32_t k = 0; is_known(v, k); k++) {
    const LightKnown *known = &v->known[k];
    LightLaws l = ask_floor(text, known->x, known->z, 1);
    for (int c = 0; c < 3; c++)
      if (fabs(mean_of(&l.sampled[c]) - known->rgb[c]) > 2e-3 * known->rgb[c] + 2e-4)
        broken("lights", kind, "%s: %.5f arrives at (%g, %g), not %.5f", v->parameters,
               mean_of(&l.sampled[c]), known->x, known->z, known->rgb[c]);
  }
}

#define FLOOR                                                                      \
  "Material \"diffuse\" Shape \"trianglemesh\" \"integer indices\" [0 1 2 2 1 3] " \
  "\"point3 P\" [-9 0 9 9 0 9 -9 0 -9 9 0 -9]\n"

/* The edge of glTF's spots has another profile, and the writer says so; the angles between
 * which it lies are the same. */
static void check_spot_as_gltf(void) {
  vlScene *written = need_scene(HEAD
                                "WorldBegin LightSource \"spot\" \"float coneangle\" 40 "
                                "\"float conedeltaangle\" 10 Shape \"sphere\"\n");
  vlScene *scene = read_again(written, "spot.gltf");
  vl_scene_destroy(written);
  const vlLightDef *light = vl_scene_light(scene, (vlLightId){1});
  double end = light ? (double)light->cone_angle : 0;
  double begin = light ? end - (double)light->cone_delta : 0;
  double degree = acos(-1) / 180;
  if (!(fabs(end - 40 * degree) < 1e-5 && fabs(begin - 30 * degree) < 1e-5))
    broken("lights", "spot", "as gltf: its edge from %.3f to %.3f degrees", begin / degree,
           end / degree);
  vl_scene_destroy(scene);
}

/* form: a scene over a floor, with %s for the light's kind and for its parameters. */
typedef void LightCheck(const vlKindRow *row, const LightVariant *variant, const char *form);

/* Calls `check` for each variant of each kind of light. */
static void for_each_light(const char *floor, LightCheck *check) {
  static char form[TEXT];
  const vlKindFamily *family = vl_kind_family_find("lights");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const LightCase *c = light_cases[k];
    assert_non_null(c->variants[0].parameters);
    for (int i = 0; i < LIGHT_VARIANTS && c->variants[i].parameters; i++) {
      const LightVariant *v = &c->variants[i];
      snprintf(form, sizeof form,
               HEAD "WorldBegin %sAttributeBegin %s %s LightSource %%s AttributeEnd\n", floor,
               c->before ? c->before : "", v->before ? v->before : "");
      change_light = v->change;
      check(family->rows[k], v, form);
      change_light = NULL;
    }
  }
}

static void check_light_samples(const vlKindRow *row, const LightVariant *v, const char *form) {
  static char text[TEXT];
  scene_text(text, form, row->name, v->parameters);
  if (row->traits & VL_LIGHT_TRAIT_DELTA)
    check_delta_light(row->name, v, text);
  else
    check_hit_light("lights", row->name, v->parameters, text, v->compensated);
}

/* What goes from a point to a point needs two of them. */
static void check_aims(const vlKindRow *row) {
  char text[TEXT];
  vlError error = {0};
  bool from = false;
  bool to = false;
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const char *name = row->parameters[i].name;
    from = from || (name && strcmp(name, "from") == 0);
    to = to || (name && strcmp(name, "to") == 0);
  }
  if (!from || !to)
    return;
  snprintf(text, sizeof text,
           HEAD "WorldBegin LightSource \"%s\" \"point3 from\" [1 2 3] \"point3 to\" [1 2 3]",
           row->name);
  vlScene *scene = load_text(context, text, &error);
  if (scene)
    broken("lights", row->name, "may go from a point to the same point");
  vl_scene_destroy(scene);
}

static void laws_of_lights(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("lights");
  for (uint32_t k = 0; k < family->kind_count; k++)
    check_aims(family->rows[k]);
  for_each_light(FLOOR, check_light_samples);
  check_spot_as_gltf();
  expect_no_failures();
}

/* ---- shapes that emit -------------------------------------------------------------------- */

static const char *const emissions[] = {
    "\"rgb L\" [1 2 3] \"float scale\" 2",
    "\"rgb L\" [1 1 1] \"bool twosided\" true",
    "\"rgb L\" [1 1 1] \"float power\" 10",
    "\"rgb L\" [1 2 3] \"float spread\" 100",
    "\"rgb L\" [1 1 1] \"float spread\" 150 \"bool twosided\" true",
    "\"string filename\" \"quarters.pfm\"",
};

/* Emission may be an image texture, too, though not in these files. */
#define TEXTURE_OF_FILENAME "by a texture with a filename"
static void emit_texture(vlScene *scene, vlEmissionDef *def) {
  char path[80];
  vlTextureDef image = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  snprintf(path, sizeof path, "%s/quarters.pfm", folder);
  image.path = path;
  def->texture = vl_scene_add_texture(scene, &image);
  def->scale = 0.4;
}

/* The same by the second set of texture coordinates, which only the square has that this adds:
 * it stands on the floor's middle. */
static void emit_by_second_set(vlScene *scene, vlEmissionDef *def) {
  static const float corners[12] = {-1, .2f, 0, 1, .2f, 0, 1, 2, 0, -1, 2, 0};
  static const float uvs[8] = {0, 0, 1, 0, 1, 1, 0, 1};
  static const float turned[8] = {1, 0, 1, 1, 0, 1, 0, 0};
  char path[80];
  vlTextureDef image = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  vlShapeDef square = square_def();
  snprintf(path, sizeof path, "%s/quarters.pfm", folder);
  image.path = path;
  image.uv_set = 1;
  def->texture = vl_scene_add_texture(scene, &image);
  def->two_sided = true;
  square.positions = corners;
  square.uvs = uvs;
  square.more_uvs[0] = turned;
  square.emission = (vlEmissionId){1};
  vl_scene_add_shape(scene, &square);
}

/* Shapes that emit in these ways. The normals of the second's corners lie on both sides of its
 * faces: the side of the light changes within them. The third is so small that its area is
 * sampled, not its solid angle. */
static const char *const emitting_shapes[][2] = {
    {"bilinearmesh", "\"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 .3]"},
    {"trianglemesh",
     "\"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 .3] \"integer indices\" [0 1 2 2 1 3] "
     "\"normal N\" [.1 .2 1 .2 0 -.6 0 .1 1 .2 .1 1]"},
    {"trianglemesh",
     "\"point3 P\" [-.1 -.1 0 .1 -.1 0 -.1 .1 0] \"integer indices\" [0 1 2] "
     "\"point2 uv\" [0 0 1 0 0 1]"},
};

/* A shape that is placed above the floor, and emits. */
static void emitting_text(char text[TEXT], const char *shape, const char *parameters,
                          const char *emission) {
  snprintf(
      text, TEXT,
      HEAD
      "WorldBegin " FLOOR
      "AttributeBegin AreaLightSource \"diffuse\" %s Translate .3 1.1 .2 Rotate 70 1 .2 .1 "
      "Shape \"%s\" %s AttributeEnd\n",
      emission, shape, parameters);
}
static void check_emitting_shape(const char *family, const char *kind, const char *shape,
                                 const char *parameters, const char *emission) {
  static char text[TEXT];
  emitting_text(text, shape, parameters, emission);
  check_hit_light(family, kind, emission, text, false);
}

/* The mean light on a floor of a lamp above it, by samples and by the path tracer. */
static void light_of_lamp(const char *shape, double light[2]) {
  static char text[TEXT];
  snprintf(text, sizeof text,
           HEAD "WorldBegin " FLOOR "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape %s",
           shape);
  const LightLaws l = ask_floor(text, 0.1, 0.2, 16);
  vlImage *image = image_of_floor(text, VL_TRACER_PATH, 64, 0.1, 0.2, 0.02);
  light[0] = mean_of(&l.sampled[1]);
  light[1] = mean_of_green(image);
  vl_image_destroy(image);
}

/* Corners of a square at the height 1, in the order of a patch: above the floor its light
 * shines up, by the order of its corners. */
#define LAMP_CORNERS "\"point3 P\" [-1 1 1 1 1 1 -1 1 -1 1 1 -1] "

/* A lamp of a coverage sends that share of its light; without any it is not seen, but shines
 * (pbrt). */
static void check_covered_lamps(void) {
  static const char *const shapes[] = {
      "\"bilinearmesh\" " LAMP_CORNERS "\"integer indices\" [1 0 3 2]",
      "\"trianglemesh\" " LAMP_CORNERS "\"integer indices\" [1 0 3 0 2 3]"};
  static const double coverage[] = {0.4, 0};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 2; k++) {
      char covered[300];
      double whole[2];
      double part[2];
      const double share = k ? 1 : coverage[0];
      snprintf(covered, sizeof covered, "%s \"float alpha\" %g", shapes[i], coverage[k]);
      light_of_lamp(shapes[i], whole);
      light_of_lamp(covered, part);
      for (int by = 0; by < 2; by++)
        if (!(whole[by] > 0 && fabs(part[by] / whole[by] - share) < 0.05))
          broken("emission", "diffuse", "%s: by %s %.3f of its light, not %.3f", covered,
                 by ? "the path tracer" : "samples", part[by] / whole[by], share);
    }
}

/* Lamps whose coverage grows along u alone, or along v alone. They are long, and lie aside, so
 * that it matters which part of them shines: samples find the light of rays. */
static void check_patterned_lamps(void) {
  static const char *const grows[] = {"\"float v10\" 1 \"float v11\" 1",
                                      "\"float v01\" 1 \"float v11\" 1"};
  static const char *const lies[] = {"[0 1 .2 3 1 .2 0 1 -.2 3 1 -.2]",
                                     "[-.2 1 3 .2 1 3 -.2 1 0 .2 1 0]"};
  static const char *const shapes[] = {
      "\"bilinearmesh\" \"integer indices\" [1 0 3 2]",
      "\"trianglemesh\" \"integer indices\" [1 0 3 0 2 3] \"point2 uv\" [0 0 1 0 0 1 1 1]"};
  static char text[TEXT];
  for (int i = 0; i < 8; i++) {
    snprintf(text, sizeof text,
             HEAD "WorldBegin " FLOOR
                  "Texture \"grows\" \"float\" \"bilerp\" "
                  "\"float v00\" 0 %s AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape %s "
                  "\"point3 P\" %s \"texture alpha\" \"grows\"",
             grows[i / 4], shapes[i % 2], lies[i / 2 % 2]);
    const LightLaws l = ask_floor(text, 0.1, 0.1, 32);
    const double whole = mean_of(&l.integral[1]);
    check_same_mean("emission", "diffuse", strstr(text, "\"float v00\""), &l.sampled[1],
                    &l.integral[1], (Sight){0.01 * whole, 0.25 * whole});
  }
}

/* Vertex normals tell which side shines, whatever the order of the corners. */
static void check_sides_of_lamps(void) {
  static const char *const shapes[] = {
      "\"bilinearmesh\" " LAMP_CORNERS "\"integer indices\" [%s]",
      "\"trianglemesh\" " LAMP_CORNERS "\"integer indices\" [%s]"};
  static const char *const orders[2][2] = {{"0 1 2 3", "1 0 3 2"},
                                           {"0 1 2 1 3 2", "0 2 1 1 2 3"}};
  for (int i = 0; i < 8; i++) {
    char shape[300];
    char all[400];
    double light[2];
    const bool down = i & 1;
    snprintf(shape, sizeof shape, shapes[i / 4], orders[i / 4][i / 2 % 2]);
    snprintf(all, sizeof all, "%s \"normal N\" [0 %s .1 .1 %s 0 0 %s 0 0 %s 0]", shape,
             down ? "-1" : "1", down ? "-1" : "1", down ? "-1" : "1", down ? "-1" : "1");
    light_of_lamp(all, light);
    for (int by = 0; by < 2; by++)
      if ((light[by] > 0) != down)
        broken("emission", "diffuse", "%s: %s the floor, by %s", all,
               down ? "does not light" : "lights", by ? "the path tracer" : "samples");
  }
}

/* A sphere that is stretched along one axis, or whose axes lean towards each other, is none any
 * more, whichever axes these are: there is light beyond the cone of the sphere. */
static void check_stretched_spheres(void) {
  static const char *const maps[] = {"Scale 1.8 1 1",
                                     "Rotate 90 0 0 1 Scale 1 1.8 1",
                                     "Scale 1 1 1.8",
                                     "ConcatTransform [1 0 0 0 .8 .6 0 0 0 0 1 0 0 0 0 1]",
                                     "ConcatTransform [1 0 0 0 0 1 0 0 0 .8 .6 0 0 0 0 1]",
                                     "ConcatTransform [1 0 0 0 0 1 0 0 .8 0 .6 0 0 0 0 1]"};
  static char text[TEXT];
  for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
    snprintf(text, sizeof text,
             HEAD "WorldBegin " FLOOR
                  "Translate .3 1.1 .2 %s AreaLightSource \"diffuse\" "
                  "\"rgb L\" [1 1 1] Shape \"sphere\" \"float radius\" .5",
             maps[i]);
    const LightLaws l = ask_floor(text, 0.1, 0.2, 16);
    const double whole = mean_of(&l.integral[1]);
    check_same_mean("shapes", "sphere", maps[i], &l.sampled[1], &l.integral[1],
                    (Sight){0.02 * whole, 0.3 * whole});
  }
}

static void laws_of_emission(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("emission");
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (size_t i = 0; i < sizeof emissions / sizeof *emissions; i++)
      check_emitting_shape("emission", family->rows[k]->name, emitting_shapes[i == 0][0],
                           emitting_shapes[i == 0][1], emissions[i]);
  static char text[TEXT];
  for (size_t i = 0; i < sizeof emissions / sizeof *emissions; i++) {
    emitting_text(text, emitting_shapes[2][0], emitting_shapes[2][1], emissions[i]);
    check_samples_of_light("emission", "diffuse", emissions[i], text);
  }
  change_emission = emit_by_second_set;
  emitting_text(text, "disk", "\"float radius\" .01", "");
  check_hit_light("emission", "diffuse", TEXTURE_OF_FILENAME, text, false);
  change_emission = NULL;
  check_covered_lamps();
  check_patterned_lamps();
  check_sides_of_lamps();
  check_stretched_spheres();
  expect_no_failures();
}

/* ---- media around lamps ------------------------------------------------------------------ */

/* A lamp in a ball of fog is found to be in it, wherever the ball is, and one beside it is not.
 */
static void check_medium_of_lamp(const char *shape, const char *parameters, bool in_fog) {
  static char text[TEXT];
  enum { MAX_LIGHTS = 16 };
  const float eye[3] = {0, 20, 0};
  uint32_t medium[MAX_LIGHTS];
  vlError error = {0};
  vlWorld *world;
  snprintf(text, sizeof text,
           HEAD
           "WorldBegin MakeNamedMedium \"m\" \"string type\" \"homogeneous\" "
           "AttributeBegin MediumInterface \"m\" \"\" Material \"interface\" "
           "Translate 6 -4 5 Shape \"sphere\" \"float radius\" 3 AttributeEnd "
           "Translate 6 -4 %s AreaLightSource \"diffuse\" Shape \"%s\" %s",
           in_fog ? "5" : "9.5", shape, parameters);
  vlScene *scene = need_scene(text);
  assert_int_equal(vl_world_build(scene, NULL, &world, &error), VL_OK);
  assert_in_range(world->lights.count, 1, MAX_LIGHTS);
  vl_trace_kernels(VL_ISA_BASE)->light_media(world, eye, medium);
  for (size_t i = 0; i < world->lights.count; i++)
    if ((medium[i] != VL_NONE) != in_fog)
      broken("shapes", shape, "%s: lamp %zu is%s in the fog", parameters, i,
             in_fog ? " not" : "");
  vl_world_destroy(world);
  vl_scene_destroy(scene);
}

static void media_of_lamps(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("shapes");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const char *parameters = shape_cases[k]->variants[0].parameters;
    if (strcmp(family->rows[k]->name, "curve") == 0)
      continue; /* emits no light */
    check_medium_of_lamp(family->rows[k]->name, parameters, true);
    check_medium_of_lamp(family->rows[k]->name, parameters, false);
  }
  expect_no_failures();
}

/* ---- in wavelengths ---------------------------------------------------------------------- */

/* In wavelengths a light has the colour that it has in RGB. Both images are of the same paths,
 * so that they differ by the noise of wavelengths alone. */
static void check_colors_of_light(const char *family, const char *kind, const char *parameters,
                                  const char *text) {
  enum { COLOR_SPP = 16 };
  vlImage *images[2];
  for (int i = 0; i < 2; i++)
    images[i] = image_of_floor_in(i ? VL_COLOR_SPECTRAL : VL_COLOR_RGB, text, VL_TRACER_PATH,
                                  COLOR_SPP, 0.1, 0.2, 2);
  const double whole = mean_of_green(images[0]);
  for (uint32_t channel = 0; channel < 3; channel++) {
    const Mean rgb = mean_of_channel(images[0], channel);
    const Mean spectral = mean_of_channel(images[1], channel);
    if (!(fabs(mean_of(&spectral) - mean_of(&rgb)) < 0.02 * whole))
      broken(family, kind, "%s: channel %u of the floor is %.4f, in wavelengths %.4f",
             parameters, channel, mean_of(&rgb), mean_of(&spectral));
  }
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
}

static void check_colors(const vlKindRow *row, const LightVariant *v, const char *form) {
  static char text[TEXT];
  scene_text(text, form, row->name, v->parameters);
  check_colors_of_light("lights", row->name, v->parameters, text);
}

/* A portal makes an image of a plain sky, whose colour is that of the sky without it, in
 * wavelengths also beyond the colours of sRGB. */
static void check_color_through_portal(vlColorMode mode) {
  static const char *const portals[] = {"", "\"point3 portal\" [-1 1 -1 1 1 -1 1 1 1 -1 1 1]"};
  static char text[TEXT];
  double colors[2][3];
  for (int i = 0; i < 2; i++) {
    snprintf(text, sizeof text,
             HEAD "WorldBegin " FLOOR
                  "ColorSpace \"rec2020\" LightSource \"infinite\" "
                  "\"rgb L\" [.1 1 .2] %s\n",
             portals[i]);
    vlImage *image = image_of_floor_in(mode, text, VL_TRACER_PATH, 64, 0.1, 0.2, 0.5);
    for (uint32_t c = 0; c < 3; c++) {
      const Mean mean = mean_of_channel(image, c);
      colors[i][c] = mean_of(&mean);
    }
    vl_image_destroy(image);
  }
  for (int c = 0; c < 3; c++) {
    const double open = colors[0][c] / colors[0][1];
    const double through = colors[1][c] / colors[1][1];
    if (!(fabs(open - through) < 0.02))
      broken("lights", "infinite", "channel %d through a portal is %.4f of green, not %.4f", c,
             through, open);
  }
}

/* The light of an image of one channel is that of the same image of three. */
static void check_grey_image(const vlKindRow *row) {
  static const char *const files[] = {"quarters.pfm", "grey.pfm"};
  static char text[TEXT];
  double colors[2][3];
  for (int i = 0; i < 2; i++) {
    snprintf(text, sizeof text,
             HEAD "WorldBegin " FLOOR
                  "Translate 0 1 0 Rotate 90 1 0 0 LightSource \"%s\" "
                  "\"string filename\" \"%s\"\n",
             row->name, files[i]);
    vlImage *image = image_of_floor_in(VL_COLOR_RGB, text, VL_TRACER_PATH, 16, 0.1, 0.2, 0.5);
    for (uint32_t c = 0; c < 3; c++) {
      const Mean mean = mean_of_channel(image, c);
      colors[i][c] = mean_of(&mean);
    }
    vl_image_destroy(image);
  }
  for (int c = 0; c < 3; c++)
    if (!(colors[0][c] > 0 && fabs(colors[1][c] - colors[0][c]) < 1e-3 * colors[0][c]))
      broken("lights", row->name, "channel %d of an image of one channel: %.4f, of three %.4f",
             c, colors[1][c], colors[0][c]);
}

static void colors_of_lights(void **state) {
  (void)state;
  const vlKindFamily *lights = vl_kind_family_find("lights");
  for (uint32_t k = 0; k < lights->kind_count; k++)
    if (vl_row_find(lights->rows[k], "filename"))
      check_grey_image(lights->rows[k]);
  for_each_light(FLOOR, check_colors);
  check_color_through_portal(VL_COLOR_SPECTRAL);
  check_color_through_portal(VL_COLOR_RGB);
  for (size_t i = 0; i < sizeof emissions / sizeof *emissions; i++) {
    static char text[TEXT];
    emitting_text(text, emitting_shapes[0][0], emitting_shapes[0][1], emissions[i]);
    check_colors_of_light("emission", "diffuse", emissions[i], text);
  }
  static char text[TEXT];
  change_emission = emit_texture;
  emitting_text(text, emitting_shapes[1][0], emitting_shapes[1][1], "");
  check_colors_of_light("emission", "diffuse", TEXTURE_OF_FILENAME, text);
  change_emission = NULL;
  expect_no_failures();
}

#endif
