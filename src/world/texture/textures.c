/* world/texture/textures.c: compiles the textures of a scene into nodes; reads each image file once; evaluates a float
 * texture at one point (alpha, mix amounts, displacement). */
#include "world/texture/texture.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/digest.h"
#include "base/error.h"
#include "base/free.h"
#include "image/image.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "velo/texture.h"
#include "world/texture/node_kind.h"
#include "world/texture/texture_node.h"
#include "world/world.h"

/* MAX_NESTING bounds the recursion in this file. VL_NODE_ROWS bounds the nesting of textures by their scratch rows,
 * since each level needs rows of its own. */
enum { MAX_NESTING = 32, ROLES = 4, ROLE_FLOAT = 3 };

/* ---- constant spectra -------------------------------------------------------------------------------------------- */

vlResult vl_spectral_compile(vlWorld *world, const vlSpectrum *spectrum, vlSpectrumRole role, vlSpectral *result,
                             vlError *error) {
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
    for (int i = 0; i < 3; i++) result->rgb[i] = 1;
    return VL_OK;
  }
  if (spectrum->kind == VL_SPECTRUM_RGB && role == VL_ROLE_ALBEDO) {
    result->kind = VL_SPECTRAL_SIGMOID;
    result->scale = spectrum->scale;
    result->sigmoid = vl_sigmoid_from_rgb(spectrum->space, spectrum->rgb[0], spectrum->rgb[1], spectrum->rgb[2]);
    vlSpectrum unscaled = *spectrum;
    unscaled.scale = 1;
    return vl_spectrum_to_rgb(&unscaled, role, VL_SPACE_SRGB, result->rgb, error);
  }
  float *dense = vl_world_block(world, VL_LAMBDA_COUNT, sizeof(float));
  if (!dense) return vl_fail_memory(error);
  result->kind = VL_SPECTRAL_DENSE;
  result->dense = dense;
  return vl_spectrum_dense(spectrum, role, dense, error);
}

/* ---- images ---------------------------------------------------------------------------------------------------- */

static bool same_image(const vlWorldImage *a, const vlTextureDef *def) {
  bool same_file = a->path && def->path && strcmp(a->path, def->path) == 0;
  return (same_file || (a->data && a->data == def->data)) && a->encoding_given == def->encoding_given &&
         (!a->encoding_given || (a->encoding == def->encoding && a->gamma == def->gamma));
}

static bool is_covered(const vlImage *image, uint32_t alpha) {
  for (uint32_t y = 0; y < image->height; y++) {
    if (image->type == VL_PIXEL_U8) {
      const uint8_t *row = vl_image_const_row(image, y);
      uint32_t least = 255;
      for (uint32_t x = 0; x < image->width; x++) {
        uint32_t v = row[(size_t)x * image->channels + alpha];
        least = v < least ? v : least;
      }
      if (least < 255) return false;
      continue;
    }
    for (uint32_t x = 0; x < image->width; x++)
      if (!(vl_image_get(image, x, y, alpha) >= 1.0f)) return false;
  }
  return true;
}

/* Selects the colour channels (one for a grey image) and alpha, unless alpha is 1 everywhere. Channels are selected by
 * name, because EXR sorts them. */
static void choose_channels(const vlImage *image, bool keep_coverage, vlMipmapDef *mip) {
  int r = vl_image_find_channel(image, "R"), g = vl_image_find_channel(image, "G"),
      b = vl_image_find_channel(image, "B");
  int a = vl_image_find_channel(image, "A");
  if (r < 0 || g < 0 || b < 0) {
    int y = vl_image_find_channel(image, "Y");
    mip->channel[0] = y < 0 ? 0 : (uint32_t)y;
    mip->channel[1] = a < 0 ? 0 : (uint32_t)a;
    mip->count = a >= 0 && keep_coverage ? 2 : 1;
    return;
  }
  bool covered = a < 0 || is_covered(image, (uint32_t)a);
  uint32_t channels[4] = {(uint32_t)r, (uint32_t)g, (uint32_t)b, (uint32_t)(a < 0 ? 0 : a)};
  mip->count = a >= 0 && !covered ? 4 : 3;
  memcpy(mip->channel, channels, sizeof channels);
}

/* The source of an image: a file, a file in memory, or an image in memory. */
typedef struct Image {
  const char *name; /* name for error messages if there is no path */
  const char *path;
  const void *data;
  size_t size;
  const vlImage *given;
  const vlEncoding *encoding; /* null: the image's own */
  float gamma;
  bool pyramid, keep_coverage;
  uint64_t owner; /* vlImageKey.owner */
} Image;

static vlResult load_image(const vlWorld *world, const Image *p, vlMipmap **mipmap, vlError *error) {
  vlContext *context = world->context;
  const vlImage *given = p->given;
  vlImage *image = NULL;
  vlResult r = VL_OK;
  if (p->data)
    r = vl_image_decode(context, world->task, p->name ? p->name : "image", p->data, p->size, &image, error);
  else if (!given)
    r = vl_image_read_named(context, world->task, p->path, &image, error);
  if (r != VL_OK) return r;
  given = image ? image : given;
  vlMipmapDef mip;
  memset(&mip, 0, sizeof mip);
  choose_channels(given, p->keep_coverage, &mip);
  mip.only_finest = !p->pyramid;
  mip.own_encoding = p->encoding != NULL;
  mip.encoding = p->encoding ? *p->encoding : VL_ENCODING_LINEAR;
  mip.gamma = p->gamma;
  mip.task = world->task;
  if ((r = vl_mipmap_create(given, &mip, mipmap)) == VL_ERROR_MEMORY)
    vl_fail_memory(error);
  else if (r == VL_CANCELLED)
    vl_fail(error, r, "stopped");
  else if (r != VL_OK)
    vl_fail(error, r, "%s: cannot be used as a texture", p->path ? p->path : "image");
  vl_image_destroy(image);
  return r;
}

/* What identifies the bytes of an image without reading them. */
static vlImageKey key_of(const Image *p) {
  vlImageKey key;
  memset(&key, 0, sizeof key);
  key.pyramid = p->pyramid;
  key.keep_coverage = p->keep_coverage;
  key.owner = p->owner;
  key.encoding_given = p->encoding != NULL;
  if (p->encoding) {
    key.encoding = *p->encoding;
    key.gamma = p->gamma;
  }
  key.stamp = vl_file_stamp(p->path);
  return key;
}

/* Adds the digest of a file in memory. Images in memory are recognised by their owner alone. */
static void add_digest(const Image *p, vlImageKey *key) {
  if (!p->data) return;
  key->size = p->size;
  vl_digest(p->data, p->size, key->digest);
}

static bool made_alike(const vlImageKey *a, const vlImageKey *b) {
  return a->stamp.there == b->stamp.there && a->pyramid == b->pyramid && a->keep_coverage == b->keep_coverage &&
         a->encoding_given == b->encoding_given && a->encoding == b->encoding && a->gamma == b->gamma;
}

/* The image of the previous world with these bytes, or null. The key gets its digest if that is needed. */
static const vlWorldImage *find_previous(const vlWorld *world, const Image *p, vlImageKey *key) {
  const vlWorld *previous = world->previous;
  bool same_scene = previous && previous->scene_number == world->scene_number;
  for (size_t i = 0; same_scene && key->owner && i < previous->images.count; i++) {
    const vlWorldImage *image = &previous->images.items[i];
    if (made_alike(&image->key, key) && image->key.owner == key->owner) return image;
  }
  add_digest(p, key);
  if (key->stamp.there && !vl_context_allows(world->context, p->path)) return NULL;
  for (size_t i = 0; previous && i < previous->images.count; i++) {
    const vlWorldImage *image = &previous->images.items[i];
    if (!made_alike(&image->key, key)) continue;
    if (key->stamp.there ? vl_file_stamp_same(&image->key.stamp, &key->stamp)
                         : key->size && image->key.size == key->size && memcmp(image->key.digest, key->digest, 16) == 0)
      return image;
  }
  return NULL;
}

static void free_mipmap(vlContext *context, void *mipmap) {
  (void)context;
  vl_mipmap_destroy(mipmap);
}

static int32_t push_image(vlWorld *world, vlMipmap *mipmap, const vlImageKey *key, vlError *error) {
  vlPart *part = vl_part_add(world);
  vlWorldImage *entry = part ? VL_PUSH(world->context, &world->images) : NULL;
  if (part) {
    part->destroy = free_mipmap;
    part->object = mipmap;
  }
  if (!part) vl_mipmap_destroy(mipmap);
  if (!entry) {
    vl_fail_memory(error);
    return -1;
  }
  entry->mipmap = mipmap;
  entry->part = part;
  entry->key = *key;
  return (int32_t)world->images.count - 1;
}

/* Shares an image of the previous world. */
static int32_t share_image(vlWorld *world, const vlWorldImage *from, const vlImageKey *key, vlError *error) {
  vlWorldImage *entry = vl_part_share(world, from->part) ? VL_PUSH(world->context, &world->images) : NULL;
  if (!entry) {
    vl_fail_memory(error);
    return -1;
  }
  entry->mipmap = from->mipmap;
  entry->part = from->part;
  entry->key = from->key;
  entry->key.owner = key->owner;
  return (int32_t)world->images.count - 1;
}

/* Shares the image or reads it. Returns its index, or -1 with the error set. */
static int32_t obtain_image(vlWorld *world, const Image *p, vlError *error) {
  vlImageKey key = key_of(p);
  const vlWorldImage *previous = find_previous(world, p, &key);
  if (previous) return share_image(world, previous, &key, error);
  vlMipmap *mipmap = NULL;
  return load_image(world, p, &mipmap, error) == VL_OK ? push_image(world, mipmap, &key, error) : -1;
}

int32_t vl_world_add_image(vlWorld *world, const char *path, const vlImage *given, const vlEncoding *encoding,
                           float gamma, bool pyramid, vlError *error) {
  Image p = {NULL, path, NULL, 0, given, encoding, gamma, pyramid, false, given ? given->number : 0};
  return obtain_image(world, &p, error);
}

/* vlImageKey.owner: the number of the image, or the texture with its generation. */
static uint64_t owner_of(const vlScene *scene, const vlTextureDef *def) {
  if (def->path) return 0;
  if (def->image) return def->image->number;
  size_t index = (size_t)(def - scene->textures.items);
  return vl_scene_mark(&scene->texture_marks, index).generation << 32 | (index + 1);
}

static Image open_image(const vlScene *scene, const vlTextureDef *def) {
  return (Image){def->name,           def->path,  def->data,
                 def->data_size,      def->image, def->encoding_given ? &def->encoding : NULL,
                 def->gamma,          true,       def->data != NULL,
                 owner_of(scene, def)};
}

/* Stores the path (or memory address) and the encoding in an entry. Later requests find the image by them. */
static bool name_image(vlWorld *world, vlWorldImage *entry, const vlTextureDef *def) {
  entry->encoding = def->encoding;
  entry->encoding_given = def->encoding_given;
  entry->gamma = def->gamma;
  entry->data = def->data;
  if (!def->path) return true;
  size_t size = strlen(def->path) + 1;
  char *copy = vl_world_block(world, size, 1);
  if (copy) memcpy(copy, def->path, size);
  entry->path = copy;
  return copy != NULL;
}

typedef struct Preload {
  const vlWorld *world;
  const vlScene *scene;
  vlImageKey *keys;
  atomic_uint done;
  uint32_t count;
  const vlTextureDef **defs;
  vlMipmap **mipmaps;
} Preload;

static void preload_one(void *user, uint32_t index, uint32_t worker) {
  (void)worker;
  Preload *job = user;
  double share = (double)atomic_fetch_add(&job->done, 1) / job->count;
  if (vl_world_step(job->world, "images", 0.3 * share, NULL) != VL_OK) return;
  Image p = open_image(job->scene, job->defs[index]);
  vlError ignored; /* ignored: whoever uses the image meets the same error and reports it with its source location */
  load_image(job->world, &p, &job->mipmaps[index], &ignored);
}

static bool listed(const vlTextureDef **defs, size_t count, const vlTextureDef *def) {
  for (size_t i = 0; i < count; i++) {
    vlWorldImage like = {.path = defs[i]->path,
                         .data = defs[i]->data,
                         .encoding = defs[i]->encoding,
                         .encoding_given = defs[i]->encoding_given,
                         .gamma = defs[i]->gamma};
    if (same_image(&like, def)) return true;
  }
  return false;
}

/* Whether the images of a texture are listed for reading; those of the previous world are shared at once. */
static bool list_image(vlWorld *world, Preload *job, const vlTextureDef *def, vlError *error) {
  for (size_t i = 0; i < world->images.count; i++)
    if (same_image(&world->images.items[i], def)) return true;
  if (listed(job->defs, job->count, def)) return true;
  Image p = open_image(job->scene, def);
  vlImageKey key = key_of(&p);
  const vlWorldImage *previous = find_previous(world, &p, &key);
  if (!previous) {
    job->keys[job->count] = key;
    job->defs[job->count++] = def;
    return true;
  }
  int32_t index = share_image(world, previous, &key, error);
  return index >= 0 && name_image(world, &world->images.items[index], def);
}

vlResult vl_world_preload_images(vlWorld *world, const vlScene *scene, vlError *error) {
  enum { MOST = 4096 }; /* duplicates are found by linear search */
  size_t most = scene->textures.count < MOST ? scene->textures.count : MOST;
  Preload job = {.world = world, .scene = scene};
  job.defs = vl_alloc_array(world->context, most + 1, sizeof *job.defs);
  job.keys = vl_alloc_array(world->context, most + 1, sizeof *job.keys);
  job.mipmaps = vl_alloc_zero(world->context, most + 1, sizeof *job.mipmaps);
  bool ok = job.defs && job.mipmaps && job.keys;
  for (size_t i = 0; ok && i < scene->textures.count && job.count < most; i++) {
    const vlTextureDef *def = &scene->textures.items[i];
    if (def->kind == VL_TEXTURE_IMAGE && (def->path || def->data)) ok = list_image(world, &job, def, error);
  }
  if (ok && job.count > 1) vl_parallel_for(world->context, job.count, preload_one, &job);
  for (size_t i = 0; ok && i < job.count; i++) {
    if (!job.mipmaps[i]) continue;
    int32_t index = push_image(world, job.mipmaps[i], &job.keys[i], error);
    job.mipmaps[i] = NULL;
    ok = index >= 0 && name_image(world, &world->images.items[index], job.defs[i]);
  }
  for (size_t i = 0; job.mipmaps && i < job.count; i++) vl_mipmap_destroy(job.mipmaps[i]);
  VL_FREE(world->context, job.defs, job.keys, job.mipmaps);
  return ok ? vl_world_step(world, "images", 0.3, error) : vl_fail_memory(error);
}

static int32_t image_of(vlWorld *world, const vlScene *scene, const vlTextureDef *def, vlError *error) {
  for (size_t i = 0; i < world->images.count; i++)
    if (same_image(&world->images.items[i], def)) return (int32_t)i;
  vlError inner;
  vl_error_clear(&inner);
  Image image = open_image(scene, def);
  int32_t index = obtain_image(world, &image, &inner);
  if (index < 0) {
    vl_fail_at(error, inner.code ? inner.code : VL_ERROR_SCENE, def->source.file, def->source.line, def->source.column,
               "%s", inner.message);
    return -1;
  }
  if (!name_image(world, &world->images.items[index], def)) {
    vl_fail_memory(error);
    return -1;
  }
  return index;
}

/* ---- nodes ------------------------------------------------------------------------------------------------------- */

typedef struct Compile {
  vlWorld *world;
  const vlScene *scene;
  int32_t *memo; /* scene texture * ROLES + role -> node + 1 */
  vlError *error;
} Compile;

static int32_t push_node(vlWorld *world, const vlTextureNode *node) {
  vlTextureNode *slot = VL_PUSH(world->context, &world->nodes);
  if (!slot) return VL_TEXTURE_NO_MEMORY;
  *slot = *node;
  return (int32_t)world->nodes.count - 1;
}

static vlTextureNode empty_node(vlNodeKind kind) {
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
  if (input.texture.index) return compile_texture(c, input.texture.index, ROLE_FLOAT, nesting + 1);
  vlTextureNode node = empty_node(VL_NODE_FLOAT);
  node.value = input.value;
  int32_t n = push_node(c->world, &node);
  if (n == VL_TEXTURE_NO_MEMORY) vl_fail_memory(c->error);
  return n;
}

static int32_t compile_spectrum(Compile *c, vlSpectrumInput input, int role, int nesting) {
  if (input.texture.index) return compile_texture(c, input.texture.index, role, nesting + 1);
  vlTextureNode node = empty_node(VL_NODE_SPECTRUM);
  node.is_spectrum = true;
  node.role = (vlSpectrumRole)role;
  if (vl_spectral_compile(c->world, &input.value, (vlSpectrumRole)role, &node.spectrum, c->error) != VL_OK) return -1;
  int32_t n = push_node(c->world, &node);
  if (n == VL_TEXTURE_NO_MEMORY) vl_fail_memory(c->error);
  return n;
}

static int32_t compile_input(Compile *c, const vlTextureDef *def, vlFloatInput f, vlSpectrumInput s, int role,
                             int nesting) {
  return def->spectrum ? compile_spectrum(c, s, role, nesting) : compile_float(c, f, nesting);
}

#define NODE_CASE(NAME, name) case VL_NODE_##NAME:

/* Computes the scratch rows of a node, its own (as in trace/texture/texture.hot.c) and those of the input that needs
 * most, and the number of nodes visited for it. False: too many. */
static bool weigh(const vlWorld *world, vlTextureNode *node) {
  uint32_t own = 0, most = 0, visits = 1;
  switch ((vlNodeKind)node->kind) {
    case VL_NODE_SCALE:
      own = 1;
      break;
      VL_SHARE_NODES(NODE_CASE)
    case VL_NODE_MIX: own = node->is_spectrum ? 5 : 2; break;
    case VL_NODE_BILERP: own = node->is_spectrum ? 8 : 5; break;
    case VL_NODE_FLOAT:
    case VL_NODE_SPECTRUM:
    case VL_NODE_IMAGE:
    case VL_NODE_VERTEX_COLOR:
      VL_FLOAT_NODES(NODE_CASE)
      VL_COLOR_NODES(NODE_CASE)
      break; /* no inputs */
  }
  const int32_t input[5] = {node->a, node->b, node->c, node->d, node->amount};
  for (int i = 0; i < 5; i++) {
    if (input[i] < 0) continue;
    const vlTextureNode *n = &world->nodes.items[input[i]];
    most = n->rows > most ? n->rows : most;
    visits += n->visits;
  }
  if (own + most > VL_NODE_ROWS || visits > VL_NODE_VISITS) return false;
  node->rows = (uint8_t)(own + most);
  node->visits = (uint16_t)visits;
  return true;
}

/* The node kinds that give an RGB colour, which is converted to wavelengths where it is used. */
#define GIVES_RGB(NAME, name) [VL_NODE_##NAME] = true,
static const bool gives_rgb[VL_NODE_SPECTRUM + 1] = {
    [VL_NODE_IMAGE] = true, [VL_NODE_VERTEX_COLOR] = true, VL_COLOR_NODES(GIVES_RGB)};

static vlResult image_spectrum(vlWorld *world, vlTextureNode *node, vlError *error) {
  node->spectrum.scale = 1;
  if (node->role != VL_ROLE_ILLUMINANT || world->def.color == VL_COLOR_RGB) return VL_OK;
  node->spectrum.kind = VL_SPECTRAL_DENSE;
  node->spectrum.dense = vl_space_illuminant(node->space);
  (void)error;
  return VL_OK;
}

typedef enum Colors { COLORS_OTHER, COLORS_GREY, COLORS_RGB } Colors;

static Colors colors_of(const vlWorld *world, int32_t index) {
  const vlTextureNode *node = &world->nodes.items[index];
  const vlSpectral *s = &node->spectrum;
  if (gives_rgb[node->kind])
    return node->space == VL_SPACE_SRGB && node->role == VL_ROLE_ALBEDO ? COLORS_RGB : COLORS_OTHER;
  if (node->kind == VL_NODE_SPECTRUM && s->kind != VL_SPECTRAL_CONSTANT && s->kind != VL_SPECTRAL_SIGMOID)
    return COLORS_OTHER;
  if (node->kind == VL_NODE_SPECTRUM)
    return s->rgb[0] == s->rgb[1] && s->rgb[0] == s->rgb[2] ? COLORS_GREY : COLORS_RGB;
  const int32_t input[4] = {node->a, node->b, node->c, node->d};
  Colors all = COLORS_GREY;
  for (int i = 0; i < 4; i++) {
    Colors one = input[i] < 0 ? COLORS_GREY : colors_of(world, input[i]);
    if (one == COLORS_OTHER) return COLORS_OTHER;
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
  node->st_scale = sqrtf(fmaxf(node->st[0] * node->st[0] + node->st[3] * node->st[3],
                               node->st[1] * node->st[1] + node->st[4] * node->st[4]));
  bool tinted = def->tint[0] != 1 || def->tint[1] != 1 || def->tint[2] != 1 || def->tint[3] != 1;
  node->plain = !tinted && !node->colors && def->channel < 0 && def->bias == 0 && isnan(def->cutoff);
}

/* Compiles the inputs that the kind's row describes, in the order of the row, into a, b, c, d and the amount. A
 * negative result is an error. */
static int32_t compile_inputs(Compile *c, const vlTextureDef *def, int role, int nesting, vlTextureNode *node) {
  const vlKindRow *row = vl_kind_row(&vl_texture_family, (int)def->kind);
  int32_t *slots[4] = {&node->a, &node->b, &node->c, &node->d}, n = 0;
  uint32_t used = 0;
  for (uint32_t i = 0; i < row->parameter_count && n >= 0; i++) {
    const vlParameter *p = &row->parameters[i];
    const void *f = (const char *)def + p->offset, *s = (const char *)def + p->second;
    if (p->type == VL_PARAMETER_EITHER_INPUT)
      n = *slots[used++] = compile_input(c, def, *(const vlFloatInput *)f, *(const vlSpectrumInput *)s, role, nesting);
    if (p->type == VL_PARAMETER_FLOAT_INPUT) n = node->amount = compile_float(c, *(const vlFloatInput *)f, nesting);
  }
  return n;
}

static int32_t compile_texture(Compile *c, uint32_t index, int role, int nesting) {
  const vlTextureDef *def = &c->scene->textures.items[index - 1];
  if (!def->spectrum) role = ROLE_FLOAT;
  int32_t *memo = &c->memo[(index - 1) * ROLES + (uint32_t)role];
  if (*memo) return *memo - 1;
  if (nesting > MAX_NESTING) {
    vl_fail_at(c->error, VL_ERROR_SCENE, def->source.file, def->source.line, def->source.column,
               "textures are nested more than %d deep", MAX_NESTING);
    return -1;
  }
  vlTextureNode node = empty_node(VL_NODE_FLOAT);
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
  for (int i = 0; i < 12; i++) node.texture_from_world[i] = (float)def->texture_from_world[i];
  node.dimension = def->dimension;
  node.octaves = def->octaves < 64 ? def->octaves : 64;
  node.omega = def->omega;
  node.variation = def->variation;
  memcpy(node.direction, def->direction, sizeof node.direction);
  fill_image_node(def, &node);
  if (def->kind == VL_TEXTURE_CONSTANT) { /* a constant texture compiles to its input's node */
    int32_t n = compile_input(c, def, def->float_a, def->spectrum_a, role, nesting);
    if (n >= 0) *memo = n + 1;
    return n;
  }
  node.kind = (vlNodeKind)def->kind;
  int32_t failed = compile_inputs(c, def, role, nesting, &node);
  if (failed < 0) return failed;
  if (node.kind == VL_NODE_IMAGE) {
    if ((node.image = image_of(c->world, c->scene, def, c->error)) < 0) return -1;
    const vlMipmap *mip = c->world->images.items[node.image].mipmap;
    if (mip->space_given) node.space = mip->space;
  }
  if (def->spectrum && gives_rgb[node.kind] && image_spectrum(c->world, &node, c->error) != VL_OK) return -1;
  if (!weigh(c->world, &node)) {
    vl_fail_at(c->error, VL_ERROR_SCENE, def->source.file, def->source.line, def->source.column,
               "textures are nested too deep");
    return -1;
  }
  int32_t n = push_node(c->world, &node);
  if (n == VL_TEXTURE_NO_MEMORY)
    vl_fail_memory(c->error);
  else
    *memo = n + 1;
  return n;
}

/* Compiles a texture with a memo of compiled textures that lives as long as the build. */
static vlResult with_compile(vlWorld *world, const vlScene *scene, Compile *c, vlError *error) {
  if (!world->texture_memo) {
    world->texture_memo = vl_world_block(world, (scene->textures.count + 1) * ROLES, sizeof(int32_t));
    if (!world->texture_memo) return vl_fail_memory(error);
    memset(world->texture_memo, 0, (scene->textures.count + 1) * ROLES * sizeof(int32_t));
  }
  *c = (Compile){world, scene, world->texture_memo, error};
  return VL_OK;
}

vlResult vl_world_float_node(vlWorld *world, const vlScene *scene, vlFloatInput input, int32_t *node, vlError *error) {
  Compile c;
  vlError inner;
  vl_error_clear(&inner);
  vlResult r = with_compile(world, scene, &c, &inner);
  if (r == VL_OK && (*node = compile_float(&c, input, 0)) < 0) r = inner.code ? inner.code : VL_ERROR_SCENE;
  if (r != VL_OK && error) *error = inner;
  return r;
}

vlResult vl_world_spectrum_node(vlWorld *world, const vlScene *scene, vlSpectrumInput input, vlSpectrumRole role,
                                int32_t *node, vlError *error) {
  Compile c;
  vlError inner;
  vl_error_clear(&inner);
  vlResult r = with_compile(world, scene, &c, &inner);
  if (r == VL_OK && (*node = compile_spectrum(&c, input, (int)role, 0)) < 0)
    r = inner.code ? inner.code : VL_ERROR_SCENE;
  if (r != VL_OK && error) *error = inner;
  return r;
}

/* ---- one point --------------------------------------------------------------------------------------------------- */

/* The texture point for a node: its uv set, the vertex colour, the normal if the node reads it. No footprint. */
static vlTexturePoint point_of(const vlTextureNode *node, const vlTextureQuery *q) {
  vlTexturePoint at = {q->u, q->v, q->p, vl_vec3(0, 0, 0), 0, {0, 0, 0, 0}, {1, 1, 1, 1}};
  if (vl_texture_needs_corner(node)) vl_texture_at_corner(node, q->corner, &at);
  if (node->kind == VL_NODE_DIRECTION_MIX) at.n = vl_normalize(q->n);
  return at;
}

float vl_texture_float_at(const vlWorld *world, int32_t index, const vlTextureQuery *q) {
  const vlTextureNode *node = &world->nodes.items[index];
  vlTexturePoint at = point_of(node, q);
  float share = 0;
  switch ((vlNodeKind)node->kind) {
    case VL_NODE_FLOAT: return node->value;
    case VL_NODE_IMAGE: return vl_node_image_float(node, world->images.items[node->image].mipmap, at);
    case VL_NODE_VERTEX_COLOR: return vl_node_vertex_color_float(node, at);
#define FLOAT_CASE(NAME, name) \
  case VL_NODE_##NAME: return vl_node_##name(node, at);
      VL_FLOAT_NODES(FLOAT_CASE)
    case VL_NODE_SCALE:
      return vl_node_scale(vl_texture_float_at(world, node->a, q), vl_texture_float_at(world, node->amount, q));
    case VL_NODE_BILERP: {
      vlBilerpWeights k = vl_node_bilerp(node, at);
      const int32_t input[4] = {node->a, node->b, node->c, node->d};
      float sum = 0;
      for (int i = 0; i < 4; i++) sum = vl_node_bilerp_add(sum, k.w[i], vl_texture_float_at(world, input[i], q));
      return sum;
    }
    case VL_NODE_MIX: share = vl_texture_float_at(world, node->amount, q); break;
#define SHARE_CASE(NAME, name) \
  case VL_NODE_##NAME: share = vl_node_##name(node, at); break;
      VL_SHARE_NODES(SHARE_CASE)
      VL_COLOR_NODES(NODE_CASE)
    case VL_NODE_SPECTRUM: return NAN; /* colours: vl_scene_add_texture refuses them where a float is wanted */
  }
  return vl_node_mix(vl_texture_float_at(world, node->a, q), vl_texture_float_at(world, node->b, q), share);
}

vlResult vl_world_mix_node(vlWorld *world, int32_t a, int32_t b, int32_t amount, int32_t *node, vlError *error) {
  vlTextureNode mix = empty_node(VL_NODE_MIX);
  mix.a = a;
  mix.b = b;
  mix.amount = amount;
  if (!weigh(world, &mix)) return vl_fail(error, VL_ERROR_SCENE, "textures are nested too deep");
  *node = push_node(world, &mix);
  return *node == VL_TEXTURE_NO_MEMORY ? vl_fail_memory(error) : VL_OK;
}
