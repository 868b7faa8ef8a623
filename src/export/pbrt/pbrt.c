/* export/pbrt/pbrt.c: a scene in pbrt-v4's language: the part before WorldBegin, the order of
 * the rest, lights. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "color/color.h"
#include "export/pbrt/pbrt.h"
#include "math/motion.h"
#include "math/transform.h"
#include "velo/filter_kinds.h"
#include "velo/light.h"
#include "velo/sampler.h"
#include "velo/shape.h"
#include "velo/texture.h"
#include "velo/tracer.h"

void vl_pbrt_floats(vlExport *x, const float *v, size_t count) {
  PUT("[");
  for (size_t i = 0; i < count; i++)
    PUT("%s%.9g", i ? " " : "", (double)v[i]);
  PUT("]");
}

void vl_pbrt_matrix(vlExport *x, const double m[16]) {
  if (vl_mat4_is_identity(m))
    return;
  PUT("  ConcatTransform [");
  for (int i = 0; i < 16; i++)
    PUT("%s%.17g", i ? " " : "", m[4 * (i % 4) + i / 4]);
  PUT("]\n");
}

void vl_pbrt_spectrum(vlExport *x, const char *name, const vlSpectrum *s) {
  const double k = (double)s->scale;
  float rgb[3];
  switch (s->kind) {
    case VL_SPECTRUM_BLACKBODY:
      PUT(" \"blackbody %s\" [%.9g]", name, (double)s->kelvin);
      return;
    case VL_SPECTRUM_NAMED:
      PUT(" \"spectrum %s\" \"%s\"", name, s->name);
      return;
    case VL_SPECTRUM_CONSTANT:
      PUT(" \"spectrum %s\" [200 %.9g 1000 %.9g]", name, k * (double)s->value,
          k * (double)s->value);
      return;
    case VL_SPECTRUM_SAMPLED:
      PUT(" \"spectrum %s\" [", name);
      for (uint32_t i = 0; i < s->count; i++)
        PUT("%s%.9g %.9g", i ? " " : "", (double)s->wavelengths[i], k * (double)s->values[i]);
      PUT("]");
      return;
    case VL_SPECTRUM_RGB:
      break;
  }
  memcpy(rgb, s->rgb, sizeof rgb);
  for (int i = 0; i < 3; i++)
    rgb[i] *= s->scale;
  if (s->space != x->scene->defs.film.space)
    vl_spectrum_to_rgb(s, VL_ROLE_UNBOUNDED, x->scene->defs.film.space, rgb, NULL);
  PUT(" \"rgb %s\" [%.9g %.9g %.9g]", name, (double)rgb[0], (double)rgb[1], (double)rgb[2]);
}

/* ---- before the world -------------------------------------------------------------------- */

static void put_options(vlExport *x) {
  const vlRenderDef *render = &x->scene->defs.render;
  if (render->centred)
    PUT("Option \"disablepixeljitter\" true\n");
  if (render->same_wavelengths)
    PUT("Option \"disablewavelengthjitter\" true\n");
  if (render->sharp_textures)
    PUT("Option \"disabletexturefiltering\" true\n");
}

/* The text of the camera is a whole scene. This function copies its part before WorldBegin. */
static void put_head(vlExport *x, const char *text) {
  static const char film[] = "Film \"rgb\"";
  const char *world = strstr(text, "WorldBegin"), *at = strstr(text, film);
  const char *rest = at + sizeof film - 1;
  vl_bytes_put(x->context, &x->text, text, (size_t)(at - text));
  PUT("Film \"%s\"", vl_pbrt_film_kind(&x->scene->defs));
  vl_bytes_put(x->context, &x->text, rest, (size_t)(world - rest));
}

/* pbrt has one pair of times for all motions. They are those of the camera, or else of the
 * first instance that moves. camera: its text, which has its own; null: it is left out. */
static void put_times(vlExport *x, const char *camera) {
  const char *own = camera ? strstr(camera, "TransformTimes") : NULL;
  if (own) {
    sscanf(own, "TransformTimes %lf %lf", &x->times[0], &x->times[1]);
    return;
  }
  VL_EACH_ITEM(const vlSceneInstance, instance, &x->scene->instances) {
    if (instance->hidden || !instance->keys)
      continue;
    x->times[0] = instance->times[0];
    x->times[1] = instance->times[instance->keys - 1];
    PUT("TransformTimes %.17g %.17g\n", x->times[0], x->times[1]);
    return;
  }
}

static bool put_camera(vlExport *x) {
  const vlSceneDefs *defs = &x->scene->defs;
  vlCameraRecord record = {.camera = defs->camera};
  record.camera.exposure_time = 1; /* the film's iso holds it */
  vlCameraText text;
  if (!vl_export_camera(x, VL_CAMERA_DIALECT_PBRT, &record, NULL, &text))
    return false;
  const bool held = text.text.count > 0;
  if (held) {
    put_head(x, text.text.items);
  } else {
    vl_export_lose(x, "the camera: left out");
    PUT("Film \"%s\" \"integer xresolution\" [%u] \"integer yresolution\" [%u]\n",
        vl_pbrt_film_kind(defs), defs->film.width, defs->film.height);
  }
  double shutter = defs->camera.shutter_close - defs->camera.shutter_open;
  bool has_shutter = held && shutter > 0 && strstr(text.text.items, "shutterclose");
  x->shutter = has_shutter ? shutter : 1;
  vl_pbrt_film(x);
  put_options(x);
  put_times(x, held ? text.text.items : NULL);
  VL_ARRAY_FREE(x->context, &text.text);
  return true;
}

/* pbrt's name of the kind. When pbrt has no such kind, a loss is counted, the result is null
 * and the caller writes `instead`. */
static const char *pbrt_name(vlExport *x, const vlKindFamily *family, int kind,
                             const char *thing, const char *instead) {
  const vlKindRow *row = vl_kind_row(family, kind);
  if (row && row->traits & VL_TRAIT_PBRT_NAME)
    return row->name;
  if (row && row->traits & VL_TRAIT_PBRT_ALIAS)
    return row->alias;
  vl_export_lose(x, "the %s: %s in its place", thing, instead);
  return NULL;
}

static void put_sampler(vlExport *x) {
  const vlRenderDef *render = &x->scene->defs.render;
  const char *name =
      pbrt_name(x, &vl_sampler_family, (int)render->sampler, "sampler", "zsobol");
  uint32_t side = (uint32_t)(sqrt((double)render->spp) + 0.5);
  bool square = side * side == render->spp;
  PUT("Sampler \"%s\"", name ? name : "zsobol");
  if (render->sampler == VL_SAMPLER_STRATIFIED)
    PUT(" \"integer xsamples\" [%u] \"integer ysamples\" [%u]", square ? side : render->spp,
        square ? side : 1);
  else
    PUT(" \"integer pixelsamples\" [%u]", render->spp);
  if (render->seed)
    PUT(" \"integer seed\" [%u]", render->seed);
}

static void put_filter(vlExport *x) {
  vlPixelFilter filter = x->scene->defs.film.filter;
  const char *name =
      pbrt_name(x, &vl_pixel_filter_family, (int)filter.kind, "pixel filter", "gaussian");
  if (!name)
    filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN);
  PUT("\nPixelFilter \"%s\"", name ? name : "gaussian");
  vl_pbrt_row(x, vl_kind_row(&vl_pixel_filter_family, (int)filter.kind), &filter, true, NULL);
}

static void put_tracer(vlExport *x) {
  const vlSceneDefs *defs = &x->scene->defs;
  const char *name =
      pbrt_name(x, &vl_tracer_family, (int)defs->render.tracer, "tracer", "volpath");
  const vlKindRow *row =
      vl_kind_row(&vl_tracer_family, name ? (int)defs->render.tracer : VL_TRACER_VOLPATH);
  PUT("\nIntegrator \"%s\"", name ? name : "volpath");
  if (vl_row_find(row, "maxdepth"))
    PUT(" \"integer maxdepth\" [%u]", defs->render.max_depth);
  if (vl_row_find(row, "photonsperiteration") &&
      defs->render.light_paths != VL_AS_MANY_AS_PIXELS)
    PUT(" \"integer photonsperiteration\" [%u]", defs->render.light_paths);
  vl_pbrt_row(x, row, defs, false, "maxdepth");
  PUT("\n");
}

/* ---- lights ------------------------------------------------------------------------------ */

/* Writes the light's transform. It includes the position when pbrt's kind has no "from". */
static void put_transform(vlExport *x, const vlKindRow *row, const vlLightDef *d) {
  double m[16];
  memcpy(m, d->world_from_light, sizeof m);
  for (int i = 0; i < 3 && !vl_row_find(row, "from"); i++)
    for (int k = 0; k < 3; k++)
      m[4 * i + 3] += m[4 * i + k] * (double)d->from[k];
  vl_pbrt_matrix(x, m);
}

/* Writes the file of a lamp in memory beside the scene. */
static bool put_lamp(vlExport *x, const vlLightDef *d, char name[300]) {
  snprintf(name, 300, "%.200s-lamp%zu.ies", x->stem, (size_t)(d - x->scene->lights.items) + 1);
  return vl_export_data(x, name, d->lamp_data, d->lamp_size);
}

static bool put_light(vlExport *x, const vlLightDef *d) {
  const vlKindRow *row = vl_kind_row(&vl_light_family, (int)d->kind);
  char name[300] = "";
  bool lamp = !d->image && vl_names_lamp(d->path);
  if (d->lamp_data && !put_lamp(x, d, name))
    return false;
  if (d->path || d->image) {
    vlTextureDef t = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    t.path = d->path;
    t.image = d->image;
    if (!vl_pbrt_image(x, &t, lamp ? VL_PBRT_ANY : VL_PBRT_COLORS, name))
      return false;
    if (!lamp)
      vl_pbrt_lose_space(x, d->space, d->image);
  }
  if (d->kind == VL_LIGHT_SPOT && d->cone_squared)
    vl_export_lose(x, "edges of spots as glTF has them: pbrt's, which are steeper");
  PUT("AttributeBegin\n");
  put_transform(x, row, d);
  if (d->medium.index)
    PUT("  MediumInterface \"\" \"medium%u\"\n", d->medium.index);
  PUT("  LightSource \"%s\"", row->name);
  vl_pbrt_row(x, row, d, false, name[0] ? "L" : NULL);
  if (name[0])
    PUT(" \"string filename\" \"%s\"", name);
  for (int i = 0; d->has_portal && i < 12; i++)
    PUT("%s%.9g%s", i ? " " : " \"point3 portal\" [", (double)d->portal[i / 3][i % 3],
        i == 11 ? "]" : "");
  PUT("\nAttributeEnd\n");
  return true;
}

/* ---- the whole --------------------------------------------------------------------------- */

/* Whether all poses are, but for rounding, those of a motion from the first one to the last. */
static bool is_one_motion(const vlSceneInstance *instance) {
  const uint32_t last = instance->keys - 1;
  const double *times = instance->times;
  for (uint32_t k = 1; k < last; k++) {
    const double *pose = instance->poses + 16 * (size_t)k;
    const double f = (times[k] - times[0]) / (times[last] - times[0]);
    double between[16];
    vl_motion_at(instance->poses, instance->poses + 16 * (size_t)last, f, between);
    for (int i = 0; i < 16; i++)
      if (!(fabs(between[i] - pose[i]) <= 1e-6 * (1 + fabs(pose[i]))))
        return false;
  }
  return true;
}

/* Writes the pose of an instance, or its first and its last one. */
static void put_poses(vlExport *x, const vlSceneInstance *instance) {
  if (!instance->keys) {
    vl_pbrt_matrix(x, instance->world_from_group);
    return;
  }
  const uint32_t last = instance->keys - 1;
  if (!is_one_motion(instance))
    vl_export_lose(x, "motions over more than two poses: from the first one to the last");
  if (instance->times[0] != x->times[0] || instance->times[last] != x->times[1])
    vl_export_lose(x, "motions at times of their own: at those of the first that moves");
  PUT("  ActiveTransform StartTime\n");
  vl_pbrt_matrix(x, instance->poses);
  PUT("  ActiveTransform EndTime\n");
  vl_pbrt_matrix(x, instance->poses + 16 * (size_t)last);
  PUT("  ActiveTransform All\n");
}

static bool put_groups(vlExport *x) {
  const vlScene *s = x->scene;
  for (size_t g = 0; g < s->groups.count; g++) {
    if (vl_scene_mark(&s->group_marks, g).removed)
      continue;
    PUT("ObjectBegin \"object%zu\"\n", g + 1);
    for (size_t i = 0; i < s->shapes.count; i++)
      if (s->shapes.items[i].group.index == g + 1 && !vl_pbrt_shape(x, i))
        return false;
    PUT("ObjectEnd\n");
  }
  VL_EACH_ITEM(const vlSceneInstance, instance, &s->instances) {
    if (instance->hidden)
      continue;
    PUT("AttributeBegin\n");
    put_poses(x, instance);
    PUT("  ObjectInstance \"object%u\"\nAttributeEnd\n", instance->group.index);
  }
  return true;
}

bool vl_export_pbrt(vlExport *x) {
  const vlScene *s = x->scene;
  PUT("# written by velo\n");
  if (s->copyright) { /* one line */
    PUT("# ");
    for (const char *p = s->copyright; *p; p++)
      PUT("%c", (unsigned char)*p < ' ' ? ' ' : *p);
    PUT("\n");
  }
  vl_export_lose_choices(x);
  if (s->defs.film.space != VL_SPACE_SRGB && (unsigned)s->defs.film.space < 4)
    PUT("ColorSpace \"%s\"\n", vl_color_space_names[s->defs.film.space]);
  for (size_t i = 0; i < s->media.count; i++)
    if (!vl_scene_mark(&s->medium_marks, i).removed && !vl_pbrt_medium(x, i))
      return false;
  if (s->defs.camera_medium.index)
    PUT("MediumInterface \"\" \"medium%u\"\n", s->defs.camera_medium.index);
  if (!put_camera(x))
    return false;
  put_sampler(x);
  put_filter(x);
  put_tracer(x);
  PUT("WorldBegin\n");
  for (size_t i = 0; i < s->lights.count; i++)
    if (!vl_scene_light_is_removed(s, i) && !put_light(x, &s->lights.items[i]))
      return false;
  for (size_t i = 0; i < s->materials.count; i++)
    if (!vl_scene_mark(&s->material_marks, i).removed && !vl_pbrt_material(x, (uint32_t)i + 1))
      return false;
  for (size_t i = 0; i < s->shapes.count; i++)
    if (!s->shapes.items[i].group.index && !vl_pbrt_shape(x, i))
      return false;
  if (!put_groups(x))
    return false;
  if (x->text.full)
    return vl_export_no_memory(x);
  return vl_export_main(x, x->text.data.items, x->text.data.count);
}
