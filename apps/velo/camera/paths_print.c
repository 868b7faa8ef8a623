/* camera/paths_print.c: see paths.h. */
#include <math.h>
#include <stdio.h>

#include "camera/paths.h"
#include "cli/macros.h"
#include "velo/channels.h"
#include "velo/tracer.h"

static const char *const events[] = {"surface", "medium", "exit", "nothing"};
static const char *const fates[] = {"on", "left", "absorbed", "roulette", "depth"};
static const char *const light_events[] = {"sampled", "hit", "sky", "medium"};

static double luminance(const float rgb[3]) {
  return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

double paths_share(const vlPath *path) {
  return (double)path->filter_weight * luminance(path->rgb);
}

/* The sum of the shares' sizes, so that negative ones do not hide large ones. */
static double all_shares(const vlPixelPaths *paths) {
  double sum = 0;
  for (uint32_t i = 0; i < paths->count; i++) {
    double share = fabs(paths_share(&paths->paths[i]));
    if (isfinite(share))
      sum += share;
  }
  return sum;
}

static vlIdInfo info_of(const vlWorld *world, vlIdKind kind, uint32_t id) {
  vlIdInfo info = {0};
  vl_world_id_info(world, kind, id, &info);
  return info;
}

/* The first float of each channel of the ground truth, and its ids. */
enum { C_Z, C_DISTANCE, C_P, C_N = 5, C_NG = 8, C_UV = 11, C_ALBEDO = 13, C_COUNT = 16 };
enum { ID_OBJECT, ID_MATERIAL, ID_INSTANCE, ID_PRIMITIVE };

/* What is told of the surface that the pixel's centre sees. */
static const struct {
  const char *name;
  uint32_t first, count;
} shown_channels[] = {{"depth", C_Z, 1},      {"distance", C_DISTANCE, 1}, {"position", C_P, 3},
                      {"normal", C_NG, 3},    {"shading", C_N, 3},         {"uv", C_UV, 2},
                      {"albedo", C_ALBEDO, 3}};
enum { SHOWN_CHANNELS = LENGTH(shown_channels) };
static double channel_at(const PathsReport *r, uint32_t channel) {
  return (double)vl_image_get(r->traced->channels, 0, 0, channel);
}

static uint32_t id_of(const PathsReport *r, uint32_t channel) {
  return ((const uint32_t *)vl_image_const_pixels(r->traced->ids))[channel];
}

/* ---- text -------------------------------------------------------------------------------- */

/* A word, an id, and the name and type of what has it; nothing for id 0. */
static void print_id(const PathsReport *r, vlIdKind kind, const char *word, uint32_t id) {
  vlIdInfo info = info_of(r->world, kind, id);
  if (id == 0)
    return;
  printf("%s %u", word, id);
  if (info.name && info.name[0])
    printf(" \"%s\"", info.name);
  if (info.type)
    printf(" (%s)", info.type);
}

static void print_seen(const PathsReport *r) {
  uint32_t object = id_of(r, ID_OBJECT);
  printf("the centre of the pixel sees ");
  if (!object) {
    printf("nothing\n");
    return;
  }
  print_id(r, VL_ID_OBJECT, "object", object);
  printf(", ");
  print_id(r, VL_ID_MATERIAL, "material", id_of(r, ID_MATERIAL));
  if (id_of(r, ID_INSTANCE))
    printf(", ");
  print_id(r, VL_ID_INSTANCE, "instance", id_of(r, ID_INSTANCE));
  printf(", face %u\n", id_of(r, ID_PRIMITIVE));
  vlIdInfo info = info_of(r->world, VL_ID_OBJECT, object);
  if (info.source.file)
    printf("  in        %s:%u\n", info.source.file, info.source.line);
  for (int k = 0; k < SHOWN_CHANNELS; k++) {
    printf("  %-9s", shown_channels[k].name);
    for (uint32_t i = 0; i < shown_channels[k].count; i++)
      printf(" %.6g", channel_at(r, shown_channels[k].first + i));
    putchar('\n');
  }
}

static void print_rgb(const float rgb[3]) {
  printf("%.4g %.4g %.4g", (double)rgb[0], (double)rgb[1], (double)rgb[2]);
}

static void print_contribution(const PathsReport *r, const vlPathContribution *c) {
  printf("       light %s", light_events[c->event]);
  if (c->event != VL_PATH_LIGHT_MEDIUM)
    printf(": %s %u", c->type, c->light);
  if (c->object) {
    printf(", ");
    print_id(r, VL_ID_OBJECT, "object", c->object);
  }
  if (c->event != VL_PATH_LIGHT_MEDIUM)
    printf("; pdf light %.4g, bsdf %.4g, weight %.4g", (double)c->light_pdf,
           (double)c->bsdf_pdf, (double)c->weight);
  if (c->occluded) {
    printf("; occluded\n");
    return;
  }
  printf("; adds ");
  print_rgb(c->rgb);
  putchar('\n');
}

static void print_lobe(const vlPathVertex *v) {
  printf("       %s by %s", v->fate == VL_PATH_ON ? "scattered" : "sampled", v->bsdf);
  if (v->lobe & VL_PATH_SPECULAR)
    printf(", specular");
  if (v->event != VL_PATH_MEDIUM)
    printf(v->lobe & VL_PATH_TRANSMISSION ? ", transmitted" : ", reflected");
  printf(": pdf %.4g, factor", (double)v->pdf);
  for (int k = 0; k < 4; k++)
    printf(" %.4g", (double)v->factor[k]);
  if (v->survival < 1.0f)
    printf(", survives with %.4g", (double)v->survival);
  putchar('\n');
}

static void print_vertex(const PathsReport *r, const vlPath *p, uint32_t index) {
  const vlPathVertex *v = &p->vertices[index];
  printf("  %2u   ", index);
  if (v->event == VL_PATH_NOTHING)
    printf("leaves the scene");
  else if (v->event == VL_PATH_MEDIUM)
    printf("medium %u", v->medium);
  else
    print_id(r, VL_ID_OBJECT, v->event == VL_PATH_EXIT ? "leaves object" : "object", v->object);
  if (v->material) {
    printf(", ");
    print_id(r, VL_ID_MATERIAL, "material", v->material);
  }
  if (v->texture)
    printf(", texture %s%s%s", v->texture, v->image ? " " : "", v->image ? v->image : "");
  if (v->event != VL_PATH_NOTHING)
    printf("; at %.4g %.4g %.4g", (double)v->position[0], (double)v->position[1],
           (double)v->position[2]);
  printf("; throughput");
  for (int k = 0; k < 4; k++)
    printf(" %.4g", (double)v->throughput[k]);
  putchar('\n');
  for (uint32_t i = 0; i < p->contribution_count; i++)
    if (p->contributions[i].vertex == index)
      print_contribution(r, &p->contributions[i]);
  if (v->bsdf && v->fate != VL_PATH_DEPTH)
    print_lobe(v);
  if (v->fate == VL_PATH_ABSORBED || v->fate == VL_PATH_ROULETTE || v->fate == VL_PATH_DEPTH)
    printf("       ends: %s\n", v->fate == VL_PATH_DEPTH      ? "the largest number of bounces"
                                : v->fate == VL_PATH_ROULETTE ? "Russian roulette"
                                                              : "absorbed");
}

void paths_print_text(const PathsReport *r) {
  const vlPixelPaths *all = r->traced->paths;
  printf("%s: pixel %u,%u, %u samples", r->file, all->x, all->y, all->samples);
  if (all->count != all->samples)
    printf(" (%u with those of the pixels around that count)", all->count);
  printf(" by %s: mean %.6g %.6g %.6g\n", all->tracer == VL_TRACER_PATH ? "path" : "volpath",
         all->mean[0], all->mean[1], all->mean[2]);
  if (all->dropped)
    printf("%u samples are not finite\n", all->dropped);
  print_seen(r);
  double sum = all_shares(all);
  for (uint32_t k = 0; k < r->shown; k++) {
    const vlPath *p = &all->paths[r->traced->order[k]];
    printf("\nsample %u", p->sample);
    if (p->x != (int32_t)all->x || p->y != (int32_t)all->y)
      printf(" of pixel %d,%d", p->x, p->y);
    printf(": ");
    print_rgb(p->rgb);
    printf(", %.3g %% of the pixel; film point %.6g,%.6g",
           sum > 0 ? 100 * fabs(paths_share(p)) / sum : 0.0, (double)p->film[0],
           (double)p->film[1]);
    if (p->lambda[0] > 0.0f) {
      printf("; nm");
      for (int c = 0; c < 4; c++)
        printf(" %.5g", (double)p->lambda[c]);
    }
    if (p->camera_weight != 1.0f)
      printf("; lens %.4g", (double)p->camera_weight);
    putchar('\n');
    if (!p->vertex_count)
      printf("       the camera has no ray here\n");
    for (uint32_t i = 0; i < p->vertex_count; i++)
      print_vertex(r, p, i);
  }
}

/* ---- JSON -------------------------------------------------------------------------------- */

static void json_floats(Json *json, const char *key, const float *values, int count) {
  json_begin(json, key, '[');
  for (int i = 0; i < count; i++)
    json_number(json, NULL, (double)values[i]);
  json_end(json, ']');
}

static void json_what(Json *json, const PathsReport *r, const char *key, vlIdKind kind,
                      uint32_t id) {
  if (!id)
    return;
  vlIdInfo info = info_of(r->world, kind, id);
  json_begin(json, key, '{');
  json_integer(json, "id", id);
  if (info.name && info.name[0])
    json_text(json, "name", info.name);
  json_text(json, "type", info.type);
  if (info.source.file)
    json_put(json, "file %s, line %u", info.source.file, info.source.line);
  json_end(json, '}');
}

/* One number, or an array. */
static void json_channel(Json *json, const PathsReport *r, int k) {
  const uint32_t count = shown_channels[k].count;
  double values[3];
  for (uint32_t i = 0; i < count; i++)
    values[i] = channel_at(r, shown_channels[k].first + i);
  if (count > 1)
    json_numbers(json, shown_channels[k].name, values, count);
  else
    json_number(json, shown_channels[k].name, values[0]);
}

static void json_seen(Json *json, const PathsReport *r) {
  if (!id_of(r, ID_OBJECT))
    return;
  json_begin(json, "sees", '{');
  json_what(json, r, "object", VL_ID_OBJECT, id_of(r, ID_OBJECT));
  json_what(json, r, "material", VL_ID_MATERIAL, id_of(r, ID_MATERIAL));
  json_what(json, r, "instance", VL_ID_INSTANCE, id_of(r, ID_INSTANCE));
  json_integer(json, "primitive", id_of(r, ID_PRIMITIVE));
  for (int k = 0; k < SHOWN_CHANNELS; k++)
    json_channel(json, r, k);
  json_end(json, '}');
}

static void json_contribution(Json *json, const PathsReport *r, const vlPathContribution *c) {
  json_begin(json, NULL, '{');
  json_put(json, "vertex %u, event %s, light_type %s", c->vertex, light_events[c->event],
           c->type);
  if (c->event != VL_PATH_LIGHT_MEDIUM) {
    json_integer(json, "light", c->light);
    json_what(json, r, "object", VL_ID_OBJECT, c->object);
    json_floats(json, c->distant ? "direction" : "point", c->target, 3);
    json_put(json, "light_pdf %g, bsdf_pdf %g, occluded %i", (double)c->light_pdf,
             (double)c->bsdf_pdf, c->occluded);
  }
  json_number(json, "weight", (double)c->weight);
  json_floats(json, "radiance", c->radiance, 4);
  json_floats(json, "rgb", c->rgb, 3);
  json_end(json, '}');
}

static void json_vertex(Json *json, const PathsReport *r, const vlPathVertex *v) {
  const bool in_scene = v->event != VL_PATH_NOTHING;
  const bool on_surface = v->event == VL_PATH_SURFACE || v->event == VL_PATH_EXIT;
  json_begin(json, NULL, '{');
  json_put(json, "event %s, fate %s, bounce %u", events[v->event], fates[v->fate], v->bounce);
  json_floats(json, "arrival", v->arrival, 3);
  json_floats(json, "throughput", v->throughput, 4);
  if (in_scene) {
    json_floats(json, "position", v->position, 3);
    json_number(json, "distance", (double)v->distance);
  }
  if (v->medium)
    json_integer(json, "medium", v->medium);
  if (on_surface) {
    json_what(json, r, "object", VL_ID_OBJECT, v->object);
    json_what(json, r, "material", VL_ID_MATERIAL, v->material);
    json_what(json, r, "instance", VL_ID_INSTANCE, v->instance);
    json_integer(json, "primitive", v->primitive);
    json_floats(json, "normal", v->normal, 3);
    json_floats(json, "uv", v->uv, 2);
  }
  if (on_surface && v->bsdf) {
    json_floats(json, "shading", v->shading, 3);
    json_floats(json, "reflectance", v->reflectance, 4);
  }
  json_put(json, "texture %s, image %s, bsdf %s", v->texture, v->image, v->bsdf);
  if (v->bsdf && v->fate != VL_PATH_DEPTH) {
    json_put(json, "specular %i, transmission %i, pdf %g", (v->lobe & VL_PATH_SPECULAR) != 0,
             (v->lobe & VL_PATH_TRANSMISSION) != 0, (double)v->pdf);
    json_floats(json, "factor", v->factor, 4);
    json_number(json, "survival", (double)v->survival);
  }
  if (v->fate == VL_PATH_ON)
    json_floats(json, "direction", v->direction, 3);
  json_end(json, '}');
}

static void json_path(Json *json, const PathsReport *r, const vlPath *p, double sum) {
  json_begin(json, NULL, '{');
  json_numbers(json, "pixel", (const double[]){p->x, p->y}, 2);
  json_integer(json, "sample", p->sample);
  json_floats(json, "film", p->film, 2);
  json_floats(json, "origin", p->origin, 3);
  json_floats(json, "direction", p->direction, 3);
  json_put(json, "time %g, filter_weight %g, camera_weight %g", (double)p->time,
           (double)p->filter_weight, (double)p->camera_weight);
  if (p->lambda[0] > 0.0f) {
    json_floats(json, "lambda", p->lambda, 4);
    json_floats(json, "inv_pdf", p->inv_pdf, 4);
  }
  json_floats(json, "radiance", p->radiance, 4);
  json_floats(json, "rgb", p->rgb, 3);
  json_number(json, "share", sum > 0 ? fabs(paths_share(p)) / sum : 0.0);
  json_begin(json, "vertices", '[');
  for (uint32_t i = 0; i < p->vertex_count; i++)
    json_vertex(json, r, &p->vertices[i]);
  json_end(json, ']');
  json_begin(json, "contributions", '[');
  for (uint32_t i = 0; i < p->contribution_count; i++)
    json_contribution(json, r, &p->contributions[i]);
  json_end(json, ']');
  json_end(json, '}');
}

void paths_put_json(Json *json, const PathsReport *r) {
  const vlPixelPaths *all = r->traced->paths;
  double sum = all_shares(all);
  json_text(json, "file", r->file);
  json_numbers(json, "pixel", (const double[]){all->x, all->y}, 2);
  json_put(json, "tracer %s, samples %u, counted %u, dropped %u",
           all->tracer == VL_TRACER_PATH ? "path" : "volpath", all->samples, all->count,
           all->dropped);
  json_numbers(json, "mean", all->mean, 3);
  json_seen(json, r);
  json_begin(json, "paths", '[');
  for (uint32_t k = 0; k < r->shown; k++)
    json_path(json, r, &all->paths[r->traced->order[k]], sum);
  json_end(json, ']');
}
