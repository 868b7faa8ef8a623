/* import/gltf/animation.c: node transforms and morph weights at one moment. Interpolations:
 * STEP, LINEAR (rotations by slerp) and CUBICSPLINE (specification, appendix C). A channel
 * holds its first value before the first key and its last value after the last key. */
#include <math.h>
#include <stdlib.h>

#include "base/free.h"
#include "base/text.h"
#include "import/gltf/gltf.h"

#include "math/elementary.h"

typedef enum { STEP, LINEAR, CUBIC } Mode;

/* The keys of a sampler: `count` times and count * width values; for CUBICSPLINE three times as
 * many values. */
typedef struct {
  size_t count, width;
  float *times, *values;
  Mode mode;
} Track;

static bool read_track(vlGltf *g, const vlGltfLocation *at, uint32_t components, Track *t) {
  size_t input, output;
  static const char *const modes[] = {"STEP", "LINEAR", "CUBICSPLINE"};
  int mode = LINEAR;
  size_t total = 0;
  if (!vl_gltf_index(at, "input", g->accessor_count, &input) ||
      !vl_gltf_index(at, "output", g->accessor_count, &output) ||
      !vl_gltf_choice(at, "interpolation", modes, 3, &mode))
    return false;
  if (input == VL_GLTF_NONE || output == VL_GLTF_NONE)
    return vl_gltf_fail(at, "needs \"input\" and \"output\"");
  t->mode = (Mode)mode;
  if (!(t->times = vl_gltf_load_floats(VL_GLTF_KEY(at, "input"), input, 1, 0, &t->count)) ||
      !(t->values =
            vl_gltf_load_floats(VL_GLTF_KEY(at, "output"), output, components, 0, &total)))
    return false;
  for (size_t i = 0; i < t->count; i++)
    if (!isfinite(t->times[i]) || (i && !(t->times[i] > t->times[i - 1])))
      return vl_gltf_fail_key(at, "input", "times must ascend; number %zu does not", i);
  for (size_t i = 0; i < total * components; i++)
    if (!isfinite(t->values[i]))
      return vl_gltf_fail_key(at, "output", "a value is not finite");
  size_t keys = t->count * (t->mode == CUBIC ? 3 : 1);
  if (total % keys != 0)
    return vl_gltf_fail_key(at, "output", "%zu values for %zu keys", total, t->count);
  t->width = total / keys * components;
  return true;
}

static void slerp(const float *a, const float *b, double u, double out[4]) {
  double dot = 0, q[4];
  for (int i = 0; i < 4; i++)
    dot += (double)a[i] * b[i];
  double sign = dot < 0 ? -1 : 1;
  dot = fmin(fabs(dot), 1);
  double angle = vl_precise_acos(dot), s = vl_precise_sin(angle), wa = 1 - u, wb = u;
  if (s > 1e-6) {
    wa = vl_precise_sin((1 - u) * angle) / s;
    wb = vl_precise_sin(u * angle) / s;
  }
  for (int i = 0; i < 4; i++)
    q[i] = wa * a[i] + sign * wb * b[i];
  memcpy(out, q, sizeof q);
}

/* The interpolated value of component c. */
static double at_key(const Track *t, size_t key, size_t part, size_t c) {
  size_t step = t->mode == CUBIC ? 3 : 1;
  return t->values[(key * step + part) * t->width + c];
}

static void evaluate(const Track *t, double time, bool rotation, double *out) {
  size_t value = t->mode == CUBIC ? 1 : 0, last = t->count - 1, k = 0;
  if (time <= t->times[0] || last == 0 || time >= t->times[last]) {
    size_t key = last && time >= t->times[last] ? last : 0;
    for (size_t c = 0; c < t->width; c++)
      out[c] = at_key(t, key, value, c);
    return;
  }
  size_t high = last;
  while (high - k > 1) {
    size_t middle = (k + high) / 2;
    if ((double)t->times[middle] <= time)
      k = middle;
    else
      high = middle;
  }
  double span = (double)t->times[k + 1] - t->times[k], u = (time - t->times[k]) / span;
  if (t->mode == LINEAR && rotation && t->width == 4) {
    slerp(t->values + k * 4, t->values + (k + 1) * 4, u, out);
    return;
  }
  for (size_t c = 0; c < t->width; c++) {
    double a = at_key(t, k, value, c), b = at_key(t, k + 1, value, c);
    if (t->mode == STEP)
      out[c] = a;
    if (t->mode == LINEAR)
      out[c] = a + u * (b - a);
    if (t->mode != CUBIC)
      continue;
    double u2 = u * u, u3 = u2 * u, from = span * at_key(t, k, 2, c),
           to = span * at_key(t, k + 1, 0, c);
    out[c] = (2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * from + (3 * u2 - 2 * u3) * b +
             (u3 - u2) * to;
  }
}

static bool apply_weights(vlGltf *g, vlGltfNode *node, const Track *t) {
  double *values = vl_alloc_array(g->context, t->width + 1, sizeof *values);
  float *weights = vl_alloc_array(g->context, t->width + 1, sizeof *weights);
  const bool ok = values && weights;
  if (ok) {
    evaluate(t, g->time, false, values);
    for (size_t i = 0; i < t->width; i++)
      weights[i] = (float)values[i];
    vl_free(g->context, node->weights);
    node->weights = weights;
    node->weight_count = (uint32_t)t->width;
    weights = NULL;
  }
  VL_FREE(g->context, weights, values);
  return ok || vl_gltf_fail_memory(g);
}

/* KHR_animation_pointer: pointers to node properties ("/nodes/3/translation") are read. Other
 * pointers are ignored. */
static bool read_pointer(vlGltf *g, const vlGltfLocation *up, size_t *node, const char **path) {
  const vlGltfLocation *at = VL_GLTF_KEY(up, "extensions.KHR_animation_pointer");
  const char *pointer = "";
  if (!vl_gltf_text(at, "pointer", &pointer))
    return false;
  const char *number = pointer + 7;
  char *end = NULL;
  bool is_node = strncmp(pointer, "/nodes/", 7) == 0 && *number >= '0' && *number <= '9';
  unsigned long index = is_node ? strtoul(number, &end, 10) : 0;
  is_node = is_node && *end == '/' && index < g->node_count;
  *node = is_node ? index : VL_GLTF_NONE;
  *path = is_node ? end + 1 : "";
  if (!is_node)
    vl_gltf_warn(VL_LOG_WARNING, VL_GLTF_KEY(at, "pointer"),
                 "%s is not animated: velo moves nodes only", vl_short_text(pointer).text);
  return true;
}

static bool apply_channel(vlGltf *g, const vlGltfLocation *up, const json_t *animation,
                          size_t i) {
  enum { TRANSLATION, ROTATION, SCALE, WEIGHTS, PATHS };
  static const char *const paths[PATHS] = {"translation", "rotation", "scale", "weights"};
  const vlGltfLocation *at = VL_GLTF_ITEM(up, "channels", i),
                       *at_target = VL_GLTF_KEY(at, "target");
  const json_t *channel = json_array_get(json_object_get(animation, "channels"), i), *target;
  const json_t *samplers = json_object_get(animation, "samplers");
  const char *path = "";
  size_t sampler, node;
  if (!json_is_object(channel))
    return vl_gltf_fail(at, "must be an object");
  if (!vl_gltf_index(at, "sampler", json_array_size(samplers), &sampler) ||
      !vl_gltf_object(at, "target", &target) ||
      !vl_gltf_index(at_target, "node", g->node_count, &node) ||
      !vl_gltf_text(at_target, "path", &path))
    return false;
  if (sampler == VL_GLTF_NONE)
    return vl_gltf_fail(at, "\"sampler\" is missing");
  if (vl_text_is(path, "pointer") && !read_pointer(g, at_target, &node, &path))
    return false;
  const size_t what = vl_name_index(path, paths, PATHS);
  if (what == PATHS && *path)
    vl_gltf_warn(VL_LOG_WARNING, VL_GLTF_KEY(at_target, "path"),
                 "unknown name \"%s\" is ignored", vl_short_text(path).text);
  if (node == VL_GLTF_NONE || what == PATHS)
    return true; /* the specification allows to ignore these channels */
  const json_t *json = json_array_get(samplers, sampler);
  const vlGltfLocation *at_sampler = VL_GLTF_ITEM(up, "samplers", sampler);
  if (!json_is_object(json))
    return vl_gltf_fail(at_sampler, "must be an object");
  static const uint32_t components[] = {3, 4, 3, 1};
  Track track = {0};
  vlGltfNode *n = &g->nodes[node];
  bool ok = read_track(g, at_sampler, components[what], &track);
  if (ok && what == WEIGHTS) {
    ok = apply_weights(g, n, &track);
  } else if (ok && track.width != components[what]) {
    ok = vl_gltf_fail(at_sampler, "its output holds more values than keys");
  } else if (ok) {
    double v[4];
    evaluate(&track, g->time, what == ROTATION, v);
    memcpy(what == TRANSLATION ? n->translation
           : what == ROTATION  ? n->rotation
                               : n->scale,
           v, components[what] * sizeof *v);
    n->has_matrix = false;
  }
  VL_FREE(g->context, track.times, track.values);
  return ok;
}

bool vl_gltf_apply_animation(vlGltf *g, size_t index) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "animations", index);
  const json_t *animation = vl_gltf_item(g, "animations", index), *channels, *samplers;
  size_t count, sampler_count;
  if (!vl_gltf_array(at, "channels", &channels, &count) ||
      !vl_gltf_array(at, "samplers", &samplers, &sampler_count))
    return false;
  for (size_t i = 0; i < count; i++)
    if (!apply_channel(g, at, animation, i))
      return false;
  return true;
}

static bool fail_animation(vlGltf *g, const char *name) {
  return vl_gltf_fail_choice(g, "animation", json_object_get(g->root, "animations"), name, 300);
}

/* One animation, several in this order with commas between them, or "all". A later one
 * overrides properties that an earlier one moves, too. */
bool vl_gltf_each_animation(vlGltf *g, bool (*visit)(vlGltf *g, size_t index)) {
  const char *wanted = g->def->animation;
  if (g->animation_count == 0)
    return true;
  size_t whole = wanted ? vl_gltf_find(g, "animations", wanted) : 0;
  if (whole != VL_GLTF_NONE)
    return visit(g, whole);
  bool all = vl_text_is(wanted, "all");
  for (size_t i = 0; all && i < g->animation_count; i++)
    if (!visit(g, i))
      return false;
  for (const char *from = wanted; !all;) {
    char name[256];
    size_t n = strcspn(from, ",");
    if (n >= sizeof name)
      return fail_animation(g, from);
    memcpy(name, from, n);
    name[n] = 0;
    size_t one = vl_gltf_find(g, "animations", name);
    if (one == VL_GLTF_NONE)
      return fail_animation(g, name);
    if (!visit(g, one))
      return false;
    if (!from[n])
      break;
    from += n + 1;
  }
  return true;
}
