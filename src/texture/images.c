/* texture/images.c: the images of textures: each file is read once, and shared with the world
 * of the build before. */
#include "texture/images.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/digest.h"
#include "base/error.h"
#include "base/free.h"
#include "image/image.h"
#include "velo/texture.h"
#include "world/world.h"

static bool same_image(const vlWorldImage *a, const vlTextureDef *def) {
  bool same_file = a->path && def->path && strcmp(a->path, def->path) == 0;
  return (same_file || (a->data && a->data == def->data)) &&
         a->encoding_given == def->encoding_given &&
         (!a->encoding_given || (a->encoding == def->encoding && a->gamma == def->gamma));
}

static bool is_covered(const vlImage *image, uint32_t alpha) {
  for (uint32_t y = 0; y < image->height; y++) {
    if (image->type == VL_PIXEL_U8) {
      const uint8_t *row = vl_image_const_row(image, y);
      uint32_t min = 255;
      for (uint32_t x = 0; x < image->width; x++) {
        uint32_t v = row[(size_t)x * image->channels + alpha];
        min = v < min ? v : min;
      }
      if (min < 255)
        return false;
      continue;
    }
    for (uint32_t x = 0; x < image->width; x++)
      if (!(vl_image_get(image, x, y, alpha) >= 1.0f))
        return false;
  }
  return true;
}

/* Selects the colour channels (one for a grey image) and alpha, unless alpha is 1 everywhere.
 * Channels are selected by name, because EXR sorts them. */
static void choose_channels(const vlImage *image, vlMipmapDef *mip) {
  int r = vl_image_find_channel(image, "R"), g = vl_image_find_channel(image, "G"),
      b = vl_image_find_channel(image, "B");
  int a = vl_image_find_channel(image, "A");
  bool covered = a < 0 || is_covered(image, (uint32_t)a);
  if (r < 0 || g < 0 || b < 0) {
    int y = vl_image_find_channel(image, "Y");
    mip->channel[0] = y < 0 ? 0 : (uint32_t)y;
    mip->channel[1] = a < 0 ? 0 : (uint32_t)a;
    mip->count = covered ? 1 : 2;
    return;
  }
  uint32_t channels[4] = {(uint32_t)r, (uint32_t)g, (uint32_t)b, (uint32_t)(a < 0 ? 0 : a)};
  mip->count = covered ? 3 : 4;
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
  bool pyramid;
  uint64_t owner; /* vlImageKey.owner */
} Image;

static vlResult load_image(const vlWorld *world, const Image *p, vlMipmap **mipmap,
                           vlError *error) {
  vlContext *context = world->context;
  const vlImage *given = p->given;
  vlImage *image = NULL;
  vlResult r = VL_OK;
  if (p->data)
    r = vl_image_decode(context, world->task, p->name ? p->name : "image", p->data, p->size,
                        &image, error);
  else if (!given)
    r = vl_image_read_named(context, world->task, p->path, &image, error);
  if (r != VL_OK)
    return r;
  given = image ? image : given;
  vlMipmapDef mip;
  memset(&mip, 0, sizeof mip);
  choose_channels(given, &mip);
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
  if (!p->data)
    return;
  key->size = p->size;
  vl_digest(p->data, p->size, key->digest);
}

static bool made_alike(const vlImageKey *a, const vlImageKey *b) {
  return a->stamp.there == b->stamp.there && a->pyramid == b->pyramid &&
         a->encoding_given == b->encoding_given && a->encoding == b->encoding &&
         a->gamma == b->gamma;
}

/* The image of the previous world with these bytes, or null. The key gets its digest if that is
 * needed. */
static const vlWorldImage *find_previous(const vlWorld *world, const Image *p,
                                         vlImageKey *key) {
  const vlWorld *previous = world->previous;
  bool same_scene = previous && previous->scene_number == world->scene_number;
  for (size_t i = 0; same_scene && key->owner && i < previous->images.count; i++) {
    const vlWorldImage *image = &previous->images.items[i];
    if (made_alike(&image->key, key) && image->key.owner == key->owner)
      return image;
  }
  add_digest(p, key);
  if (key->stamp.there && !vl_context_allows(world->context, p->path))
    return NULL;
  for (size_t i = 0; previous && i < previous->images.count; i++) {
    const vlWorldImage *image = &previous->images.items[i];
    if (!made_alike(&image->key, key))
      continue;
    if (key->stamp.there ? vl_file_stamp_same(&image->key.stamp, &key->stamp)
                         : key->size && image->key.size == key->size &&
                               memcmp(image->key.digest, key->digest, 16) == 0)
      return image;
  }
  return NULL;
}

static void free_mipmap(VL_UNUSED vlContext *context, void *mipmap) {
  vl_mipmap_destroy(mipmap);
}

static int32_t push_image(vlWorld *world, vlMipmap *mipmap, const vlImageKey *key,
                          vlError *error) {
  vlPart *part = vl_part_add(world);
  vlWorldImage *entry = part ? VL_PUSH(world->context, &world->images) : NULL;
  if (part) {
    part->destroy = free_mipmap;
    part->object = mipmap;
  }
  if (!part)
    vl_mipmap_destroy(mipmap);
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
static int32_t share_image(vlWorld *world, const vlWorldImage *from, const vlImageKey *key,
                           vlError *error) {
  vlWorldImage *entry =
      vl_part_share(world, from->part) ? VL_PUSH(world->context, &world->images) : NULL;
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

/* Tells of texels that are not finite, by the place of the first texture with this image. */
static void tell_not_finite(const vlWorld *world, const vlMipmap *map,
                            const vlTextureDef *def) {
  const vlMipLevel *level = &map->levels[0];
  const size_t pixels = map->is_bytes ? 0 : (size_t)level->width * level->height;
  size_t count = 0;
  size_t first = 0;
  for (size_t i = 0; i < pixels; i++) {
    bool finite = true;
    for (uint32_t c = 0; c < map->channels; c++)
      finite &= isfinite(level->floats[i * map->channels + c]) != 0;
    if (!finite && count++ == 0)
      first = i;
  }
  if (!count)
    return;
  vl_world_warn(
      world, def->source,
      "%s: pixels that are not finite: %zu, the first one (%zu, %zu); what they colour is "
      "black or left out",
      def->path ? def->path : "the image", count, first % level->width, first / level->width);
}

/* Shares the image or reads it. def: the texture that needs it; null: none. Returns its index,
 * or -1 with the error set. */
static int32_t obtain_image(vlWorld *world, const Image *p, const vlTextureDef *def,
                            vlError *error) {
  vlImageKey key = key_of(p);
  const vlWorldImage *previous = find_previous(world, p, &key);
  if (previous)
    return share_image(world, previous, &key, error);
  vlMipmap *mipmap = NULL;
  if (load_image(world, p, &mipmap, error) != VL_OK)
    return -1;
  if (def)
    tell_not_finite(world, mipmap, def);
  return push_image(world, mipmap, &key, error);
}

int32_t vl_world_add_image(vlWorld *world, const char *path, const vlImage *given,
                           const vlEncoding *encoding, bool pyramid, vlError *error) {
  Image p = {.path = path,
             .given = given,
             .encoding = encoding,
             .gamma = 1,
             .pyramid = pyramid,
             .owner = given ? given->number : 0};
  return obtain_image(world, &p, NULL, error);
}

/* vlImageKey.owner: the number of the image, or the texture with its generation. */
static uint64_t owner_of(const vlScene *scene, const vlTextureDef *def) {
  if (def->path)
    return 0;
  if (def->image)
    return def->image->number;
  size_t index = (size_t)(def - scene->textures.items);
  return vl_scene_mark(&scene->texture_marks, index).generation << 32 | (index + 1);
}

static Image open_image(const vlScene *scene, const vlTextureDef *def) {
  return (Image){.name = def->name,
                 .path = def->path,
                 .data = def->data,
                 .size = def->data_size,
                 .given = def->image,
                 .encoding = def->encoding_given ? &def->encoding : NULL,
                 .gamma = def->gamma,
                 .pyramid = true,
                 .owner = owner_of(scene, def)};
}

/* Stores the path (or memory address) and the encoding in an entry. Later requests find the
 * image by them. */
static bool name_image(vlWorld *world, vlWorldImage *entry, const vlTextureDef *def) {
  entry->encoding = def->encoding;
  entry->encoding_given = def->encoding_given;
  entry->gamma = def->gamma;
  entry->data = def->data;
  if (!def->path)
    return true;
  size_t size = strlen(def->path) + 1;
  char *copy = vl_world_block(world, size, 1);
  if (copy)
    memcpy(copy, def->path, size);
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

static void preload_one(void *user, uint32_t index, VL_UNUSED uint32_t worker) {
  Preload *job = user;
  double share = (double)atomic_fetch_add(&job->done, 1) / job->count;
  if (vl_world_step(job->world, "images", 0.3 * share, NULL) != VL_OK)
    return;
  Image p = open_image(job->scene, job->defs[index]);
  vlError ignored; /* ignored: whoever uses the image meets the same error and reports it with
                      its source location */
  load_image(job->world, &p, &job->mipmaps[index], &ignored);
}

static bool listed(const vlTextureDef **defs, size_t count, const vlTextureDef *def) {
  for (size_t i = 0; i < count; i++) {
    vlWorldImage like = {.path = defs[i]->path,
                         .data = defs[i]->data,
                         .encoding = defs[i]->encoding,
                         .encoding_given = defs[i]->encoding_given,
                         .gamma = defs[i]->gamma};
    if (same_image(&like, def))
      return true;
  }
  return false;
}

/* Whether the images of a texture are listed for reading; those of the previous world are
 * shared at once. */
static bool list_image(vlWorld *world, Preload *job, const vlTextureDef *def, vlError *error) {
  for (size_t i = 0; i < world->images.count; i++)
    if (same_image(&world->images.items[i], def))
      return true;
  if (listed(job->defs, job->count, def))
    return true;
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
  enum { MAX_TEXTURES = 4096 }; /* duplicates are found by linear search */
  size_t max = scene->textures.count < MAX_TEXTURES ? scene->textures.count : MAX_TEXTURES;
  Preload job = {.world = world, .scene = scene};
  job.defs = vl_alloc_array(world->context, max + 1, sizeof *job.defs);
  job.keys = vl_alloc_array(world->context, max + 1, sizeof *job.keys);
  job.mipmaps = vl_alloc_zero(world->context, max + 1, sizeof *job.mipmaps);
  bool ok = job.defs && job.mipmaps && job.keys;
  for (size_t i = 0; ok && i < scene->textures.count && job.count < max; i++) {
    const vlTextureDef *def = &scene->textures.items[i];
    if (def->kind == VL_TEXTURE_IMAGE && (def->path || def->data))
      ok = list_image(world, &job, def, error);
  }
  if (ok && job.count > 1)
    vl_parallel_for(world->context, job.count, preload_one, &job);
  for (size_t i = 0; ok && i < job.count; i++) {
    if (!job.mipmaps[i])
      continue;
    tell_not_finite(world, job.mipmaps[i], job.defs[i]);
    int32_t index = push_image(world, job.mipmaps[i], &job.keys[i], error);
    job.mipmaps[i] = NULL;
    ok = index >= 0 && name_image(world, &world->images.items[index], job.defs[i]);
  }
  for (size_t i = 0; job.mipmaps && i < job.count; i++)
    vl_mipmap_destroy(job.mipmaps[i]);
  VL_FREE(world->context, job.defs, job.keys, job.mipmaps);
  return ok ? vl_world_step(world, "images", 0.3, error) : vl_fail_memory(error);
}

int32_t vl_texture_image_index(vlWorld *world, const vlScene *scene, const vlTextureDef *def,
                               vlError *error) {
  for (size_t i = 0; i < world->images.count; i++)
    if (same_image(&world->images.items[i], def))
      return (int32_t)i;
  vlError inner;
  vl_error_clear(&inner);
  Image image = open_image(scene, def);
  int32_t index = obtain_image(world, &image, def, &inner);
  if (index < 0) {
    vl_fail_source(error, inner.code ? inner.code : VL_ERROR_SCENE, def->source, "%s",
                   inner.message);
    return -1;
  }
  if (!name_image(world, &world->images.items[index], def)) {
    vl_fail_memory(error);
    return -1;
  }
  return index;
}
