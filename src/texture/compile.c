/* texture/compile.c: compiles the textures of a scene into nodes. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "math/double3.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "texture/images.h"
#include "texture/kinds.h"
#include "world/world.h"

/* MAX_NESTING bounds the recursion in this file. VL_NODE_ROWS bounds the nesting of textures by
 * their scratch rows, since each level needs rows of its own. */
enum { MAX_NESTING = 32, ROLES = 4, ROLE_FLOAT = 3 };

/* ---- constant spectra -------------------------------------------------------------------- */

vlResult vl_spectral_compile(vlWorld *world, const vlSpectrum *spectrum, vlSpectrumRole role,
                             vlSpectral *result, vlError *error) {
  memset(result, 0, sizeof *result);
  result->scale = 1;
  if (world->def.color == VL_COLOR_RGB) {
    result->kind = VL_SPECTRAL_RGB;
    return vl_spectrum_to_rgb(spectrum, role, VL_SPACE_SRGB, result->rgb, error);
  }
  float value;
  if (role != VL_ROLE_ILLUMINANT && vl_spectrum_is_constant(spectrum, &value)) {
    result->kind = VL_SPECTRAL_CONSTANT;
    result->scale = value;
    for (int i = 0; i < 3; i++)
      result->rgb[i] = 1;
    return VL_OK;
  }
  if (spectrum->kind == VL_SPECTRUM_RGB && role == VL_ROLE_ALBEDO) {
    result->kind = VL_SPECTRAL_SIGMOID;
    result->scale = spectrum->scale;
    result->sigmoid = vl_sigmoid_from_rgb(spectrum->space, spectrum->rgb[0], spectrum->rgb[1],
                                          spectrum->rgb[2]);
    vlSpectrum unscaled = *spectrum;
    unscaled.scale = 1;
    return vl_spectrum_to_rgb(&unscaled, role, VL_SPACE_SRGB, result->rgb, error);
  }
  float *dense = vl_world_block(world, VL_LAMBDA_COUNT, sizeof(float));
  if (!dense)
    return vl_fail_memory(error);
  result->kind = VL_SPECTRAL_DENSE;
  result->dense = dense;
  return vl_spectrum_dense(spectrum, role, dense, error);
}

/* ---- nodes ------------------------------------------------------------------------------- */

typedef struct Compile {
  vlWorld *world;
  const vlScene *scene;
  int32_t *memo; /* scene texture * ROLES + role -> node + 1 */
  vlError *error;
} Compile;

static int32_t push_node(vlWorld *world, const vlTextureNode *node, vlError *error) {
  vlTextureNode *slot = VL_PUSH(world->context, &world->nodes);
  if (!slot) {
    vl_fail_memory(error);
    return VL_TEXTURE_NO_MEMORY;
  }
  *slot = *node;
  return (int32_t)world->nodes.count - 1;
}

static vlTextureNode empty_node(vlTextureKind kind) {
  vlTextureNode node;
  memset(&node, 0, sizeof node);
  node.kind = kind;
  node.a = node.b = node.c = node.d = node.amount = node.image = -1;
  node.visits = 1;
  node.plain = true;
  node.channel = -1;
  node.cutoff = NAN;
  return node;
}

static int32_t compile_texture(Compile *c, uint32_t index, int role, int nesting);

static int32_t compile_float(Compile *c, vlFloatInput input, int nesting) {
  if (input.texture.index)
    return compile_texture(c, input.texture.index, ROLE_FLOAT, nesting + 1);
  vlTextureNode node = empty_node(VL_TEXTURE_CONSTANT);
  node.value = input.value;
  return push_node(c->world, &node, c->error);
}

static int32_t compile_spectrum(Compile *c, vlSpectrumInput input, int role, int nesting) {
  if (input.texture.index)
    return compile_texture(c, input.texture.index, role, nesting + 1);
  vlTextureNode node = empty_node(VL_TEXTURE_CONSTANT);
  node.is_spectrum = true;
  node.role = (vlSpectrumRole)role;
  if (vl_spectral_compile(c->world, &input.value, (vlSpectrumRole)role, &node.spectrum,
                          c->error) != VL_OK)
    return -1;
  return push_node(c->world, &node, c->error);
}

static int32_t compile_input(Compile *c, const vlTextureDef *def, vlFloatInput f,
                             vlSpectrumInput s, int role, int nesting) {
  return def->spectrum ? compile_spectrum(c, s, role, nesting) : compile_float(c, f, nesting);
}

/* A case of the switch below, by what the function of the kind gives (VL_TEXTURE_KINDS). */
#define CASE(kind, name, row, gives, function) gives(kind)
#define SHARE(kind)                  \
  case kind:                         \
    own = node->is_spectrum ? 5 : 2; \
    break;
#define FLOAT(kind) \
  case kind:        \
    break;
#define COLOR(kind) FLOAT(kind)
#define OTHER(kind)

/* Computes the scratch rows of a node, its own (as in texture/batch.hot.c) and those of the
 * input that needs most, and the number of nodes visited for it. False: too many. */
static bool weigh(const vlWorld *world, vlTextureNode *node) {
  uint32_t own = 0, max = 0, visits = 1;
  switch ((vlTextureKind)node->kind) {
    case VL_TEXTURE_SCALE:
      own = 1;
      break;
    case VL_TEXTURE_MIX:
      own = node->is_spectrum ? 5 : 2;
      break;
    case VL_TEXTURE_BILERP:
      own = node->is_spectrum ? 8 : 5;
      break;
    case VL_TEXTURE_CONSTANT:
    case VL_TEXTURE_IMAGE:
    case VL_TEXTURE_VERTEX_COLOR:
      break; /* no inputs */
      VL_TEXTURE_KINDS(CASE)
  }
  const int32_t input[5] = {node->a, node->b, node->c, node->d, node->amount};
  for (int i = 0; i < 5; i++) {
    if (input[i] < 0)
      continue;
    const vlTextureNode *n = &world->nodes.items[input[i]];
    max = n->rows > max ? n->rows : max;
    visits += n->visits;
  }
  if (own + max > VL_NODE_ROWS || visits > VL_NODE_VISITS)
    return false;
  node->rows = (uint8_t)(own + max);
  node->visits = (uint16_t)visits;
  return true;
}

/* Whether the node gives an RGB colour, which is converted to wavelengths where it is used. */
static bool gives_rgb(const vlTextureNode *node) {
  const vlKindRow *row = vl_kind_row(&vl_texture_family, (int)node->kind);
  return node->kind == VL_TEXTURE_IMAGE || node->kind == VL_TEXTURE_VERTEX_COLOR ||
         (row->traits & VL_TEXTURE_COLOR_ONLY);
}

/* What converts the node's colours: by wavelength, or in RGB. */
static void image_spectrum(const vlWorld *world, vlTextureNode *node) {
  node->spectrum.scale = 1;
  if (world->def.color == VL_COLOR_RGB)
    node->to_srgb = vl_srgb_map(node->space, node->role);
  if (node->role != VL_ROLE_ILLUMINANT || world->def.color == VL_COLOR_RGB)
    return;
  node->spectrum.kind = VL_SPECTRAL_DENSE;
  node->spectrum.dense = vl_space_illuminant(node->space);
}

typedef enum Colors { COLORS_OTHER, COLORS_GREY, COLORS_RGB } Colors;

static Colors colors_of(const vlWorld *world, int32_t index) {
  const vlTextureNode *node = &world->nodes.items[index];
  const vlSpectral *s = &node->spectrum;
  if (gives_rgb(node))
    return node->space == VL_SPACE_SRGB && node->role == VL_ROLE_ALBEDO ? COLORS_RGB
                                                                        : COLORS_OTHER;
  bool constant = node->kind == VL_TEXTURE_CONSTANT && node->is_spectrum;
  if (constant && s->kind != VL_SPECTRAL_CONSTANT && s->kind != VL_SPECTRAL_SIGMOID)
    return COLORS_OTHER;
  if (constant)
    return s->rgb[0] == s->rgb[1] && s->rgb[0] == s->rgb[2] ? COLORS_GREY : COLORS_RGB;
  const int32_t input[4] = {node->a, node->b, node->c, node->d};
  Colors all = COLORS_GREY;
  for (int i = 0; i < 4; i++) {
    Colors one = input[i] < 0 ? COLORS_GREY : colors_of(world, input[i]);
    if (one == COLORS_OTHER)
      return COLORS_OTHER;
    all = one > all ? one : all;
  }
  return all;
}

bool vl_node_has_rgb_colors(const vlWorld *world, int32_t node) {
  return colors_of(world, node) == COLORS_RGB;
}

/* Parameters of image and vertex-colour textures other than the image. */
static void fill_image_node(const vlTextureDef *def, vlTextureNode *node) {
  node->wrap = def->wrap;
  node->filter = def->filter;
  node->scale = def->scale;
  node->invert = def->invert;
  node->wrap_t = def->wrap_t_given ? def->wrap_t : def->wrap;
  node->colors = def->colors || def->kind == VL_TEXTURE_VERTEX_COLOR;
  node->channel = (int8_t)def->channel;
  node->uv_set = (uint8_t)def->uv_set;
  node->bias = def->bias;
  node->cutoff = (float)def->cutoff;
  memcpy(node->tint, def->tint, sizeof node->tint);
  node->st_given = def->st_from_uv_given;
  memcpy(node->st, def->st_from_uv, sizeof node->st);
  bool tinted =
      def->tint[0] != 1 || def->tint[1] != 1 || def->tint[2] != 1 || def->tint[3] != 1;
  node->plain =
      !tinted && !node->colors && def->channel < 0 && def->bias == 0 && isnan(def->cutoff);
}

/* A direction's length has no effect. Unit vectors keep their bits; so does zero. */
static void make_unit(float direction[3]) {
  double d[3] = {direction[0], direction[1], direction[2]};
  const double length = vl_normalize3(d);
  if (length > 0 && fabs(length - 1) > 1e-6)
    for (int i = 0; i < 3; i++)
      direction[i] = (float)d[i];
}

/* The def's numbers, for the functions of the kinds; what belongs to the scene is left out.
 * Null: no memory. */
static const vlTextureDef *keep_numbers(vlWorld *world, const vlTextureDef *def) {
  vlTextureDef *kept = vl_world_block(world, 1, sizeof *kept);
  if (!kept)
    return NULL;
  *kept = *def;
  kept->name = kept->path = kept->source.file = NULL;
  kept->image = NULL;
  kept->data = NULL;
  kept->spectrum_a = kept->spectrum_b = kept->spectrum_c = kept->spectrum_d =
      (vlSpectrumInput){0};
  make_unit(kept->direction);
  return kept;
}

/* Compiles the inputs that the kind's row describes, in the order of the row, into a, b, c, d
 * and the amount. A negative result is an error. */
static int32_t compile_inputs(Compile *c, const vlTextureDef *def, int role, int nesting,
                              vlTextureNode *node) {
  const vlKindRow *row = vl_kind_row(&vl_texture_family, (int)def->kind);
  int32_t *slots[4] = {&node->a, &node->b, &node->c, &node->d}, n = 0;
  uint32_t used = 0;
  for (uint32_t i = 0; i < row->parameter_count && n >= 0; i++) {
    const vlParameter *p = &row->parameters[i];
    const void *f = (const char *)def + p->offset, *s = (const char *)def + p->second;
    if (p->type == VL_PARAMETER_EITHER_INPUT)
      n = *slots[used++] = compile_input(c, def, *(const vlFloatInput *)f,
                                         *(const vlSpectrumInput *)s, role, nesting);
    if (p->type == VL_PARAMETER_FLOAT_INPUT)
      n = node->amount = compile_float(c, *(const vlFloatInput *)f, nesting);
  }
  return n;
}

/* What the def alone says. Its inputs and numbers follow. */
static vlTextureNode node_of(const vlTextureDef *def, int role) {
  vlTextureNode node = empty_node(VL_TEXTURE_CONSTANT);
  node.is_spectrum = def->spectrum;
  node.role = def->spectrum ? (vlSpectrumRole)role : VL_ROLE_UNBOUNDED;
  node.space = def->space;
  node.mapping = def->mapping;
  node.su = def->su;
  node.sv = def->sv;
  node.du = def->du;
  node.dv = def->dv;
  memcpy(node.v1, def->planar_v1, sizeof node.v1);
  memcpy(node.v2, def->planar_v2, sizeof node.v2);
  for (int i = 0; i < 12; i++)
    node.texture_from_world[i] = (float)def->texture_from_world[i];
  fill_image_node(def, &node);
  return node;
}

static int32_t compile_texture(Compile *c, uint32_t index, int role, int nesting) {
  const vlTextureDef *def = &c->scene->textures.items[index - 1];
  if (!def->spectrum)
    role = ROLE_FLOAT;
  int32_t *memo = &c->memo[(index - 1) * ROLES + (uint32_t)role];
  if (*memo)
    return *memo - 1;
  if (nesting > MAX_NESTING) {
    vl_fail_source(c->error, VL_ERROR_SCENE, def->source,
                   "textures are nested more than %d deep", MAX_NESTING);
    return -1;
  }
  vlTextureNode node = node_of(def, role);
  if (def->kind == VL_TEXTURE_CONSTANT) { /* a constant texture compiles to its input's node */
    int32_t n = compile_input(c, def, def->float_a, def->spectrum_a, role, nesting);
    if (n >= 0)
      *memo = n + 1;
    return n;
  }
  node.kind = def->kind;
  if (!(node.def = keep_numbers(c->world, def))) {
    vl_fail_memory(c->error);
    return VL_TEXTURE_NO_MEMORY;
  }
  int32_t failed = compile_inputs(c, def, role, nesting, &node);
  if (failed < 0)
    return failed;
  if (node.kind == VL_TEXTURE_IMAGE) {
    if ((node.image = vl_texture_image_index(c->world, c->scene, def, c->error)) < 0)
      return -1;
    node.space = vl_mipmap_space(c->world->images.items[node.image].mipmap, node.space);
  }
  if (def->spectrum && gives_rgb(&node))
    image_spectrum(c->world, &node);
  if (!weigh(c->world, &node)) {
    vl_fail_source(c->error, VL_ERROR_SCENE, def->source, "textures are nested too deep");
    return -1;
  }
  int32_t n = push_node(c->world, &node, c->error);
  if (n >= 0)
    *memo = n + 1;
  return n;
}

/* Compiles a texture with a memo of compiled textures that lives as long as the build. */
static vlResult with_compile(vlWorld *world, const vlScene *scene, Compile *c, vlError *error) {
  if (!world->texture_memo) {
    world->texture_memo =
        vl_world_block(world, (scene->textures.count + 1) * ROLES, sizeof(int32_t));
    if (!world->texture_memo)
      return vl_fail_memory(error);
    memset(world->texture_memo, 0, (scene->textures.count + 1) * ROLES * sizeof(int32_t));
  }
  *c = (Compile){world, scene, world->texture_memo, error};
  return VL_OK;
}

/* Compiles an input: a number or, if there is none, a spectrum for its role. */
static vlResult compile_node(vlWorld *world, const vlScene *scene, const vlFloatInput *number,
                             const vlSpectrumInput *spectrum, vlSpectrumRole role,
                             int32_t *node, vlError *error) {
  Compile c;
  vlError inner;
  vl_error_clear(&inner);
  vlResult r = with_compile(world, scene, &c, &inner);
  if (r == VL_OK) {
    *node =
        number ? compile_float(&c, *number, 0) : compile_spectrum(&c, *spectrum, (int)role, 0);
    if (*node < 0)
      r = inner.code ? inner.code : VL_ERROR_SCENE;
  }
  if (r != VL_OK && error)
    *error = inner;
  return r;
}

vlResult vl_world_float_node(vlWorld *world, const vlScene *scene, vlFloatInput input,
                             int32_t *node, vlError *error) {
  return compile_node(world, scene, &input, NULL, VL_ROLE_UNBOUNDED, node, error);
}

vlResult vl_world_spectrum_node(vlWorld *world, const vlScene *scene, vlSpectrumInput input,
                                vlSpectrumRole role, int32_t *node, vlError *error) {
  return compile_node(world, scene, NULL, &input, role, node, error);
}

vlResult vl_world_mix_node(vlWorld *world, int32_t a, int32_t b, int32_t amount, int32_t *node,
                           vlError *error) {
  vlTextureNode mix = empty_node(VL_TEXTURE_MIX);
  mix.a = a;
  mix.b = b;
  mix.amount = amount;
  if (!weigh(world, &mix))
    return vl_fail(error, VL_ERROR_SCENE, "textures are nested too deep");
  *node = push_node(world, &mix, error);
  return *node == VL_TEXTURE_NO_MEMORY ? VL_ERROR_MEMORY : VL_OK;
}
