/* light/infinite.c: infinite lights (pbrt book 12.5): uniform, or by an image with its sampling
 * distribution. */
#include <math.h>

#include "base/error.h"
#include "light/compile.h"
#include "math/transform.h"

vlCompileLight vl_compile_light_infinite;

/* Makes the distribution over the cells, or shares that of the previous world. */
static vlResult distribution_of(vlWorld *world, vlEnvironment *env, double *mean,
                                double *illuminance, vlError *error) {
  const vlWorld *previous = world->previous;
  vlPart *image = world->images.items[env->image].part;
  vlWorldEnvironmentPart *kept = VL_PUSH(world->context, &world->environment_parts);
  if (!kept)
    return vl_fail_memory(error);
  for (size_t i = 0; previous && i < previous->environments.count; i++) {
    const vlWorldEnvironmentPart *known = &previous->environment_parts.items[i];
    const vlEnvironment *from = &previous->environments.items[i];
    if (known->image != image || from->space != env->space)
      continue;
    if (!vl_part_share(world, known->part))
      return vl_fail_memory(error);
    *kept = *known;
    env->size = from->size;
    env->cells_are_texels = from->cells_are_texels;
    env->cells = from->cells;
    env->rows = from->rows;
    env->below = from->below;
    env->row_guide = from->row_guide;
    env->cell_guide = from->cell_guide;
    *mean = known->mean;
    *illuminance = known->illuminance;
    return VL_OK;
  }
  if (!(kept->part = vl_part_add(world)))
    return vl_fail_memory(error);
  world->part = kept->part;
  vlResult r = vl_world_build_environment(world, env, &kept->mean, &kept->illuminance, error);
  world->part = NULL;
  kept->image = image;
  *mean = kept->mean;
  *illuminance = kept->illuminance;
  return r;
}

vlResult vl_compile_light_infinite(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                                   vlEmitted *e, vlError *error) {
  light->environment = VL_NONE;
  float area = VL_PI * world->radius * world->radius;
  if (!def->path && !def->image) {
    float factor = def->scale;
    if (!isnan(def->illuminance))
      factor *= (float)(def->illuminance / M_PI);
    vlResult r = vl_light_color(world, &def->color, factor, e, error);
    light->power = 4 * VL_PI * area * vl_light_luminance(&e->spectrum);
    return r;
  }
  e->image = vl_world_add_image(world, def->path, def->image, NULL, false, error);
  if (e->image < 0)
    return error->code;
  vl_light_image_color(world, vl_light_image_space(world, e->image, def->space), def->scale, e);
  const vlMipmap *mip = world->images.items[e->image].mipmap;
  if (mip->levels[0].width != mip->levels[0].height)
    return vl_fail(
        error, VL_ERROR_SCENE,
        "%s: %u x %u: an image of the sky must be square (equal-area octahedral map)",
        def->path ? def->path : "image", mip->levels[0].width, mip->levels[0].height);
  vlEnvironment *env = VL_PUSH(world->context, &world->environments);
  if (!env)
    return vl_fail_memory(error);
  env->image = e->image;
  env->space = e->space;
  vlMat4 m = vl_mat4_load(def->world_from_light), inverse;
  if (!vl_mat4_inverse(m, &inverse))
    return vl_fail(error, VL_ERROR_SCENE, "the light's transform is singular");
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      env->world_from_light[3 * i + j] = (float)m.m[4 * i + j];
      env->light_from_world[3 * i + j] = (float)inverse.m[4 * i + j];
    }
  double mean = 0, illuminance = 0;
  vlResult r = distribution_of(world, env, &mean, &illuminance, error);
  if (!isnan(def->illuminance) && illuminance > 0)
    e->image_scale *= (float)(def->illuminance / illuminance);
  light->environment = (uint32_t)world->environments.count - 1;
  light->power = (float)(4 * M_PI * area * mean * e->image_scale);
  if (r != VL_OK || !def->has_portal)
    return r;
  double passes = 0;
  r = vl_world_add_portal(world, def, &world->environments.items[light->environment], &passes,
                          error);
  light->power = (float)(passes * e->image_scale);
  return r;
}
