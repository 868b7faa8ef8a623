/* scene/verify_plan.c: which tracers claim the light of a scene, and which renders are compared. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "scene/verify.h"
#include "velo/edit.h"

void verify_note(Verify *v, const char *format, ...) {
  va_list arguments;
  if (v->note_count == VERIFY_MOST_NOTES) return;
  va_start(arguments, format);
  vsnprintf(v->notes[v->note_count++], sizeof v->notes[0], format, arguments);
  va_end(arguments);
}

bool verify_has_light(VerifyLights lights, vlLightKind kind) {
  const bool small = kind != VL_LIGHT_INFINITE;
  switch (lights) {
    case VERIFY_ALL: return true;
    case VERIFY_NOT_SMALL: return !small;
    case VERIFY_SMALL: return small;
    case VERIFY_SKY: return !small;
    case VERIFY_SURFACES: break;
  }
  return false;
}

bool verify_has_surfaces(VerifyLights lights) {
  return lights == VERIFY_ALL || lights == VERIFY_NOT_SMALL || lights == VERIFY_SURFACES;
}

/* ---- what the scene has ------------------------------------------------------------------------------------------ */

/* What decides which tracers claim the scene's light. */
typedef struct Features {
  bool hair;           /* its lobes are so narrow that uniform directions hardly ever meet them */
  bool smooth;         /* a material that may reflect or refract like a mirror */
  bool media;          /* any medium */
  bool emissive_media; /* a medium that emits light */
  bool small, sky, surfaces;
  uint64_t lamps;   /* lights; each emissive face counts */
  bool connectable; /* light paths can be connected to the camera */
} Features;

/* Whether a roughness may be so small that the surface is a mirror. A texture may have any value. */
static bool may_be_small(vlFloatInput roughness) {
  return roughness.texture.index != 0 || roughness.value < 0.05f;
}

static bool may_be_smooth(const vlMaterialDef *m) {
  const bool rough = !may_be_small(m->u_roughness) && !may_be_small(m->v_roughness);
  const bool rough_coat = !may_be_small(m->coat_u_roughness) && !may_be_small(m->coat_v_roughness);
  switch (m->kind) {
    case VL_MATERIAL_CONDUCTOR:
    case VL_MATERIAL_DIELECTRIC:
    case VL_MATERIAL_SUBSURFACE:
    case VL_MATERIAL_COATED_DIFFUSE: return !rough;
    case VL_MATERIAL_COATED_CONDUCTOR: return !rough || !rough_coat;
    case VL_MATERIAL_THIN_DIELECTRIC: return true;
    case VL_MATERIAL_PRINCIPLED:
      return may_be_small(m->principled.roughness) ||
             ((m->principled.clearcoat.texture.index || m->principled.clearcoat.value > 0) &&
              may_be_small(m->principled.clearcoat_roughness));
    case VL_MATERIAL_DIFFUSE:
    case VL_MATERIAL_MIX: /* its parts are materials of their own */
    case VL_MATERIAL_DIFFUSE_TRANSMISSION:
    case VL_MATERIAL_HAIR:
    case VL_MATERIAL_MEASURED:
    case VL_MATERIAL_INTERFACE: break;
  }
  return false;
}

/* Light paths are connected to perspective cameras without distortion, with a pinhole or a round lens
 * (docs/tracers.md). */
static bool is_connectable(const vlCamera *c) {
  const double *m = c->world_from_camera;
  const bool round = c->lens.blades == 0 && !c->lens.aperture && c->lens.ratio == 1 && !c->lens.vignetting;
  const bool straight = c->lens.tilt[0] == 0 && c->lens.tilt[1] == 0 && c->lens.hinge[0] == 0 && c->lens.hinge[1] == 0;
  double length[3];
  for (int i = 0; i < 3; i++) length[i] = hypot(m[i], hypot(m[4 + i], m[8 + i]));
  const bool even = fabs(length[1] / length[0] - 1) < 1e-5 && fabs(length[2] / length[0] - 1) < 1e-5;
  return c->projection == VL_PROJECTION_PERSPECTIVE && c->distortion.steps == 0 && round && straight && even &&
         c->skew == 0 && c->eye_circle == 0;
}

static bool emits(const vlMediumDef *medium) {
  const vlSpectrum *e = &medium->emission;
  const bool dark = e->scale == 0 || (e->kind == VL_SPECTRUM_CONSTANT && e->value == 0);
  return medium->emission_scale != 0 &&
         (!dark || medium->temperature || medium->rgb_emission || medium->kind == VL_MEDIUM_NANOVDB);
}

static Features find_features(const Verify *v) {
  Features f = {.connectable = is_connectable(&v->camera)};
  const vlMaterialDef *material;
  const vlMediumDef *medium;
  const vlLightDef *light;
  for (uint32_t i = 1; (material = vl_scene_material(v->scene, (vlMaterialId){i})); i++) {
    f.smooth = f.smooth || may_be_smooth(material);
    f.hair = f.hair || material->kind == VL_MATERIAL_HAIR;
  }
  for (uint32_t i = 1; (medium = vl_scene_medium(v->scene, (vlMediumId){i})); i++) {
    f.media = true;
    f.emissive_media = f.emissive_media || emits(medium);
  }
  for (uint32_t i = 1; (light = vl_scene_light(v->scene, (vlLightId){i})); i++) {
    const bool sky = light->kind == VL_LIGHT_INFINITE;
    f.sky = f.sky || sky;
    f.small = f.small || !sky;
  }
  f.lamps = v->light_count;
  for (uint32_t i = 0; i < v->shapes; i++) {
    const uint32_t faces = vl_scene_shape(v->scene, (vlShapeId){i + 1})->faces;
    if (!v->emissions[i].index) continue;
    f.surfaces = true;
    f.lamps += faces ? faces : 1;
  }
  return f;
}

/* ---- the runs ---------------------------------------------------------------------------------------------------- */

static int add(Verify *v, VerifyRun run) {
  if (v->run_count == VERIFY_MOST_RUNS) return run.against;
  v->runs[v->run_count] = run;
  return v->run_count++;
}

/* Tracers that must agree with volpath, which is run `against`, under the same lights. */
static void add_tracers(Verify *v, const Features *f, VerifyLights lights, int against) {
  const bool small = f->small && lights == VERIFY_ALL;
  add(v, (VerifyRun){.name = "bidirectional", .tracer = VL_TRACER_BIDIRECTIONAL, .lights = lights, .against = against});
  if (f->smooth)
    verify_note(v, "lightpath and randomwalk are not compared: smooth surfaces are black with them");
  else if (!f->connectable)
    verify_note(v, "lightpath is not compared: light paths cannot be connected to this camera");
  else if (f->emissive_media)
    verify_note(v, "lightpath is not compared: it has no light from media");
  else
    add(v, (VerifyRun){.name = "lightpath", .tracer = VL_TRACER_LIGHT_PATH, .lights = lights, .against = against});
  if (!f->smooth && !f->media && !f->hair && !small)
    add(v, (VerifyRun){.name = "randomwalk", .tracer = VL_TRACER_RANDOM_WALK, .lights = lights, .against = against});
  add(v,
      (VerifyRun){.name = "merging", .tracer = VL_TRACER_MERGING, .lights = lights, .against = against, .apart = true});
}

/* Two tracers under a part of the lights. */
static void add_lights(Verify *v, VerifyLights lights, const char *volpath, const char *bidirectional) {
  const int against =
      add(v, (VerifyRun){.name = volpath, .tracer = VL_TRACER_VOLPATH, .lights = lights, .against = -1});
  add(v, (VerifyRun){.name = bidirectional, .tracer = VL_TRACER_BIDIRECTIONAL, .lights = lights, .against = against});
}

void verify_plan(Verify *v) {
  const Features f = find_features(v);
  const int volpath = add(v, (VerifyRun){.name = "volpath", .tracer = VL_TRACER_VOLPATH, .against = -1});
  /* Behind a smooth surface only light paths find a small light. */
  const bool caustics = f.small && f.smooth;
  if (!caustics) {
    add_tracers(v, &f, VERIFY_ALL, volpath);
  } else {
    verify_note(v, "between tracers, point, spot, distant and similar lights are not compared: %s",
                "only light paths find them through smooth surfaces");
    if (f.sky || f.surfaces) {
      const int others = add(v, (VerifyRun){.name = "volpath, without small lights",
                                            .tracer = VL_TRACER_VOLPATH,
                                            .lights = VERIFY_NOT_SMALL,
                                            .against = -1});
      add_tracers(v, &f, VERIFY_NOT_SMALL, others);
    }
  }
  if (!caustics && f.small + f.sky + f.surfaces > 1) {
    if (f.small) add_lights(v, VERIFY_SMALL, "volpath, small lights", "bidirectional, small lights");
    if (f.sky) add_lights(v, VERIFY_SKY, "volpath, sky", "bidirectional, sky");
    if (f.surfaces) add_lights(v, VERIFY_SURFACES, "volpath, surfaces", "bidirectional, surfaces");
  }
  if (f.lamps > 1)
    add(v,
        (VerifyRun){
            .name = "volpath, lights chosen evenly", .tracer = VL_TRACER_VOLPATH, .evenly = true, .against = volpath});
  add(v, (VerifyRun){
             .name = "volpath, shifted", .tracer = VL_TRACER_VOLPATH, .place = VERIFY_SHIFTED, .against = volpath});
  add(v,
      (VerifyRun){.name = "volpath, turned", .tracer = VL_TRACER_VOLPATH, .place = VERIFY_TURNED, .against = volpath});
  add(v,
      (VerifyRun){.name = "volpath, scaled", .tracer = VL_TRACER_VOLPATH, .place = VERIFY_SCALED, .against = volpath});
  const int both =
      caustics
          ? add(v, (VerifyRun){.name = "bidirectional, all lights", .tracer = VL_TRACER_BIDIRECTIONAL, .against = -1})
          : volpath + 1;
  add(v,
      (VerifyRun){
          .name = "bidirectional, moved", .tracer = VL_TRACER_BIDIRECTIONAL, .place = VERIFY_MOVED, .against = both});
}
