/* texture/point.c: evaluates a float texture at one point, for alpha, mix amounts and
 * displacement. */
#include <math.h>

#include "texture/kinds.h"
#include "world/world.h"

/* The texture point for a node: its uv set, the vertex colour, the normal if the node reads it.
 * No footprint. */
static vlTexturePoint point_of(const vlTextureNode *node, const vlTextureQuery *q) {
  vlTexturePoint at = {q->u, q->v, q->p, vl_vec3(0, 0, 0), 0, {0, 0, 0, 0}, {1, 1, 1, 1}};
  if (vl_texture_needs_corner(node))
    vl_texture_at_corner(node, q->corner, &at);
  if (node->kind == VL_TEXTURE_DIRECTION_MIX)
    at.n = vl_normalize(q->n);
  return at;
}

/* A case of the switch below, by what the function of the kind gives (VL_TEXTURE_KINDS). */
#define CASE(kind, name, row, gives, function) gives(kind, function)
#define FLOAT(kind, function) \
  case kind:                  \
    return function(node, at);
#define SHARE(kind, function)   \
  case kind:                    \
    share = function(node, at); \
    break;
/* vl_scene_add_texture refuses them where a float is wanted. */
#define COLOR(kind, function) \
  case kind:                  \
    return NAN;
#define OTHER(kind, function)

float vl_texture_float_at(const vlWorld *world, int32_t index, const vlTextureQuery *q) {
  const vlTextureNode *node = &world->nodes.items[index];
  vlTexturePoint at = point_of(node, q);
  float share = 0;
  switch ((vlTextureKind)node->kind) {
    case VL_TEXTURE_CONSTANT:
      return node->is_spectrum ? NAN : node->value;
    case VL_TEXTURE_IMAGE:
      return vl_node_image_float(node, world->images.items[node->image].mipmap, at);
    case VL_TEXTURE_VERTEX_COLOR:
      return vl_node_vertex_color_float(node, at);
    case VL_TEXTURE_SCALE:
      return vl_node_scale(vl_texture_float_at(world, node->a, q),
                           vl_texture_float_at(world, node->amount, q));
    case VL_TEXTURE_BILERP: {
      vlBilerpWeights k = vl_node_bilerp(node, at);
      const int32_t input[4] = {node->a, node->b, node->c, node->d};
      float sum = 0;
      for (int i = 0; i < 4; i++)
        sum = vl_node_bilerp_add(sum, k.w[i], vl_texture_float_at(world, input[i], q));
      return sum;
    }
    case VL_TEXTURE_MIX:
      share = vl_texture_float_at(world, node->amount, q);
      break;
      VL_TEXTURE_KINDS(CASE)
  }
  return vl_node_mix(vl_texture_float_at(world, node->a, q),
                     vl_texture_float_at(world, node->b, q), share);
}
