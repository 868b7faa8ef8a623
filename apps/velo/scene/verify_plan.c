/* scene/verify_plan.c: which tracers claim the light of a scene, and which renders are
 * compared. */
#include <stdarg.h>
#include <stdio.h>

#include "scene/verify.h"
#include "velo/edit.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/schema.h"
#include "velo/shape.h"
#include "velo/tracer.h"

void verify_note(Verify *v, const char *format, ...) {
  va_list arguments;
  if (v->note_count == VERIFY_MAX_NOTES)
    return;
  va_start(arguments, format);
  vsnprintf(v->notes[v->note_count++], sizeof v->notes[0], format, arguments);
  va_end(arguments);
}

bool verify_has_light(VerifyLights lights, const vlLightDef *light) {
  const bool small = light->kind != VL_LIGHT_INFINITE;
  switch (lights) {
    case VERIFY_ALL:
      return true;
    case VERIFY_SMALL:
      return small;
    case VERIFY_NOT_SMALL:
    case VERIFY_SKY:
      return !small;
    case VERIFY_SURFACES:
      break;
  }
  return false;
}

bool verify_has_surfaces(VerifyLights lights) {
  return lights == VERIFY_ALL || lights == VERIFY_NOT_SMALL || lights == VERIFY_SURFACES;
}

/* ---- what the scene has ------------------------------------------------------------------ */

/* What decides which light of the scene the tracers find, besides what they do not support
 * (vl_tracer_lacks). */
typedef struct Features {
  bool narrow; /* hair and glass: their lobes are so narrow that uniform directions hardly ever
                  meet them */
  bool smooth; /* a material that may reflect or refract like a mirror */
  bool media;  /* any medium, or light that goes through a solid */
  bool small, sky, surfaces;
  uint64_t lamps; /* lights; each emissive face counts */
  bool textures;
} Features;

/* Whether a roughness may be so small that the surface is like a mirror. A texture may have any
 * value. */
static bool may_be_small(vlFloatInput roughness) {
  const float like_a_mirror = 0.05f;
  return roughness.texture.index != 0 || roughness.value < like_a_mirror;
}

/* Whether the material may reflect or transmit like a mirror. The parts of a mixed one are
 * materials of their own. */
static bool may_be_smooth(const vlMaterialDef *m) {
  const bool rough = !may_be_small(m->u_roughness) && !may_be_small(m->v_roughness);
  const bool rough_coat =
      !may_be_small(m->coat_u_roughness) && !may_be_small(m->coat_v_roughness);
  const bool coat = m->principled.clearcoat.texture.index || m->principled.clearcoat.value > 0;
  if (m->kind == VL_MATERIAL_PRINCIPLED)
    return may_be_small(m->principled.roughness) ||
           (coat && may_be_small(m->principled.clearcoat_roughness));
  if (m->kind == VL_MATERIAL_THIN_DIELECTRIC)
    return true;
  if (m->kind == VL_MATERIAL_COATED_CONDUCTOR && !rough_coat)
    return true;
  const vlKindRow *row = vl_kind_family_find("materials")->rows[m->kind];
  return (row->traits & VL_MATERIAL_ROUGH) && !rough;
}

static Features find_features(Verify *v) {
  Features f = {.narrow = false};
  const vlMaterialDef *material;
  const vlLightDef *light;
  for (uint32_t i = 1; (material = vl_scene_material(v->in.scene, (vlMaterialId){i})); i++) {
    f.smooth = f.smooth || may_be_smooth(material);
    f.narrow = f.narrow || material->kind == VL_MATERIAL_HAIR ||
               material->kind == VL_MATERIAL_DIELECTRIC;
    f.media = f.media || material->kind == VL_MATERIAL_SUBSURFACE;
  }
  f.media = f.media || vl_scene_medium(v->in.scene, (vlMediumId){1});
  f.textures = vl_scene_texture(v->in.scene, (vlTextureId){1});
  for (uint32_t i = 1; (light = vl_scene_light(v->in.scene, (vlLightId){i})); i++) {
    const bool sky = light->kind == VL_LIGHT_INFINITE;
    f.sky = f.sky || sky;
    v->far_light = v->far_light || sky || light->kind == VL_LIGHT_DISTANT;
    f.small = f.small || !sky;
  }
  f.lamps = v->light_count;
  for (uint32_t i = 0; i < v->shapes; i++) {
    const uint32_t faces = vl_scene_shape(v->in.scene, (vlShapeId){i + 1})->faces;
    if (!v->emissions[i].index)
      continue;
    f.surfaces = true;
    f.lamps += faces ? faces : 1;
  }
  return f;
}

/* ---- the runs ---------------------------------------------------------------------------- */

static int add(Verify *v, VerifyRun run) {
  if (v->run_count == VERIFY_MAX_RUNS)
    return run.against;
  v->runs[v->run_count] = run;
  return v->run_count++;
}

/* A run of the whole scene in its own pose. against: the run that it must agree with; -1: none.
 */
static int add_tracer(Verify *v, const char *name, vlTracer tracer, VerifyLights lights,
                      int against) {
  return add(v,
             (VerifyRun){.name = name, .tracer = tracer, .lights = lights, .against = against});
}

/* Tracers that must agree with volpath, which is run `against`, under the same lights. */
static void add_tracers(Verify *v, const Features *f, VerifyLights lights, int against) {
  const bool small = f->small && lights == VERIFY_ALL;
  add_tracer(v, "bidirectional", VL_TRACER_BIDIRECTIONAL, lights, against);
  if (f->smooth)
    verify_note(
        v, "lightpath and randomwalk are not compared: smooth surfaces are black with them");
  else
    add_tracer(v, "lightpath", VL_TRACER_LIGHT_PATH, lights, against);
  if (!f->smooth && !f->media && !f->narrow && !small)
    add_tracer(v, "randomwalk", VL_TRACER_RANDOM_WALK, lights, against);
  add(v, (VerifyRun){.name = "merging",
                     .tracer = VL_TRACER_MERGING,
                     .lights = lights,
                     .against = against,
                     .apart = true});
}

/* Two tracers under a part of the lights. */
static void add_lights(Verify *v, VerifyLights lights, const char *volpath,
                       const char *bidirectional) {
  const int against = add_tracer(v, volpath, VL_TRACER_VOLPATH, lights, -1);
  add_tracer(v, bidirectional, VL_TRACER_BIDIRECTIONAL, lights, against);
}

/* A run in another pose. */
static void add_pose(Verify *v, const char *name, vlTracer tracer, VerifyPose pose,
                     int against) {
  add(v, (VerifyRun){.name = name, .tracer = tracer, .pose = pose, .against = against});
}

/* The reference renderer does not filter textures by the pixel's footprint. */
static void add_reference(Verify *v, const Features *f, int volpath) {
  int against = volpath;
  if (!v->reference[0])
    return;
  if (f->textures)
    against = add(v, (VerifyRun){.name = "volpath, sharp textures",
                                 .tracer = VL_TRACER_VOLPATH,
                                 .sharp = true,
                                 .against = -1});
  add(v, (VerifyRun){.name = "reference",
                     .tracer = VL_TRACER_VOLPATH,
                     .reference = true,
                     .against = against});
}

void verify_plan(Verify *v) {
  const Features f = find_features(v);
  const int volpath = add_tracer(v, "volpath", VL_TRACER_VOLPATH, VERIFY_ALL, -1);
  add_reference(v, &f, volpath);
  /* Behind a smooth surface only light paths find a small light. */
  const bool caustics = f.small && f.smooth;
  const int first = v->run_count;
  if (!caustics) {
    add_tracers(v, &f, VERIFY_ALL, volpath);
  } else {
    verify_note(
        v,
        "between tracers, point, spot, distant and similar lights are not compared: only "
        "light paths find them through smooth surfaces");
    if (f.sky || f.surfaces) {
      const int others = add_tracer(v, "volpath, without small lights", VL_TRACER_VOLPATH,
                                    VERIFY_NOT_SMALL, -1);
      add_tracers(v, &f, VERIFY_NOT_SMALL, others);
    }
  }
  if (!caustics && f.small + f.sky + f.surfaces > 1) {
    if (f.small)
      add_lights(v, VERIFY_SMALL, "volpath, small lights", "bidirectional, small lights");
    if (f.sky)
      add_lights(v, VERIFY_SKY, "volpath, sky", "bidirectional, sky");
    if (f.surfaces)
      add_lights(v, VERIFY_SURFACES, "volpath, surfaces", "bidirectional, surfaces");
  }
  if (f.lamps > 1)
    add(v, (VerifyRun){.name = "volpath, lights chosen evenly",
                       .tracer = VL_TRACER_VOLPATH,
                       .evenly = true,
                       .against = volpath});
  add_pose(v, "volpath, shifted", VL_TRACER_VOLPATH, VERIFY_SHIFTED, volpath);
  add_pose(v, "volpath, turned", VL_TRACER_VOLPATH, VERIFY_TURNED, volpath);
  add_pose(v, "volpath, scaled", VL_TRACER_VOLPATH, VERIFY_SCALED, volpath);
  const int both = caustics ? add_tracer(v, "bidirectional, all lights",
                                         VL_TRACER_BIDIRECTIONAL, VERIFY_ALL, -1)
                            : first;
  add_pose(v, "bidirectional, moved", VL_TRACER_BIDIRECTIONAL, VERIFY_MOVED, both);
}
