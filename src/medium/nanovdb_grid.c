/* medium/nanovdb_grid.c: converts a NanoVDB grid into the bricks that lookups read
 * (medium/medium.h). This is the only file that uses PNanoVDB.h. Its readers check every
 * address; addresses outside of the grid read as zero. The number of nodes is bounded by the
 * grid's size in bytes, so that cyclic or shared nodes of a damaged file cannot exhaust
 * memory. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#define PNANOVDB_C
#define PNANOVDB_BUF_BOUNDS_CHECK
#include <nanovdb/PNanoVDB.h>

#include "base/array.h"
#include "base/error.h"
#include "base/free.h"
#include "medium/medium.h"
#include "medium/nanovdb_file.h"
#include "world/world.h"

enum { MAX_TABLE = 1 << 24, MAX_BLOCKS = 1 << 20 };

/* A block of 128^3 values: a lower node, or a constant value. */
typedef struct Block {
  int32_t at[3]; /* in units of blocks */
  uint64_t node; /* address of the lower node; 0: the block has a constant value */
  float value;
} Block;

typedef struct Tree {
  vlWorld *world;
  const char *path, *name;
  pnanovdb_buf_t buffer;
  uint64_t size;
  float background;
  VL_ARRAY(Block) blocks;
  VL_ARRAY(float) tiles;
  VL_ARRAY(uint32_t) bricks;
  VL_ARRAY(float) values;
  uint64_t max_bricks;
  uint64_t nodes; /* number of lower nodes */
  vlError *error;
} Tree;

static const pnanovdb_grid_type_t type = PNANOVDB_GRID_TYPE_FLOAT;

static vlResult fail(const Tree *t, const char *why) {
  return vl_fail(t->error, VL_ERROR_SCENE, "%s: grid \"%s\": %s", t->path,
                 vl_short_text(t->name).text, why);
}

static bool fits(const Tree *t, uint64_t address, uint64_t size) {
  return address % 8 == 0 && address > 0 && address < t->size && size <= t->size - address;
}

static pnanovdb_address_t address_of(uint64_t byte) {
  return (pnanovdb_address_t){byte};
}

static float float_at(const Tree *t, pnanovdb_address_t a) {
  return pnanovdb_read_float(t->buffer, a);
}

/* ---- which blocks there are -------------------------------------------------------------- */

static vlResult add_block(Tree *t, const int32_t at[3], uint64_t node, float value) {
  if (node == 0 && value == t->background)
    return VL_OK;
  if (node == 0 && !isfinite(value))
    return fail(t, "a value is not finite");
  uint64_t lower = PNANOVDB_GRID_TYPE_GET(type, lower_size);
  if (node && ++t->nodes > t->size / lower)
    return fail(t, "its tree is damaged");
  if (t->blocks.count >= MAX_BLOCKS)
    return fail(t, "it fills too much space");
  Block *b = VL_PUSH(t->world->context, &t->blocks);
  if (!b)
    return vl_fail_memory(t->error);
  *b = (Block){{at[0], at[1], at[2]}, node, value};
  return VL_OK;
}

static vlResult list_upper(Tree *t, const int32_t at[3], uint64_t address) {
  pnanovdb_upper_handle_t upper = {address_of(address)};
  for (uint32_t n = 0; n < 32768; n++) {
    int32_t block[3] = {at[0] + (int32_t)(n >> 10), at[1] + (int32_t)(n >> 5 & 31),
                        at[2] + (int32_t)(n & 31)};
    uint64_t child = 0;
    float value = 0;
    if (pnanovdb_upper_get_child_mask(t->buffer, upper, n)) {
      child = pnanovdb_upper_get_child(type, t->buffer, upper, n).address.byte_offset;
      if (!fits(t, child, PNANOVDB_GRID_TYPE_GET(type, lower_size)))
        return fail(t, "its tree is damaged");
    } else {
      value = float_at(t, pnanovdb_upper_get_table_address(type, t->buffer, upper, n));
    }
    VL_TRY(add_block(t, block, child, value));
  }
  return VL_OK;
}

static vlResult list_tile(Tree *t, const int32_t at[3], float value) {
  vlResult r = VL_OK;
  for (int32_t n = 0; r == VL_OK && n < 32768 && value != t->background; n++) {
    int32_t block[3] = {at[0] + (n >> 10), at[1] + (n >> 5 & 31), at[2] + (n & 31)};
    r = add_block(t, block, 0, value);
  }
  return r;
}

/* Maps 21 bits of a root key to the first block: keys hold coordinates >> 12, blocks are 2^7
 * wide. */
static int32_t block_of_key(uint64_t bits) {
  return (int32_t)(uint32_t)((bits & 0x1fffff) << 12) >> 7;
}

static vlResult list_root(Tree *t, pnanovdb_root_handle_t root) {
  uint32_t count = pnanovdb_root_get_tile_count(t->buffer, root);
  uint64_t tile_size = PNANOVDB_GRID_TYPE_GET(type, root_tile_size);
  if (count > t->size / tile_size)
    return fail(t, "its tree is damaged");
  for (uint32_t n = 0; n < count; n++) {
    pnanovdb_root_tile_handle_t tile = pnanovdb_root_get_tile(type, root, n);
    uint64_t key = pnanovdb_root_tile_get_key(t->buffer, tile);
    int32_t at[3] = {block_of_key(key >> 42), block_of_key(key >> 21), block_of_key(key)};
    vlResult r;
    if (pnanovdb_root_tile_get_child(t->buffer, tile) == 0) {
      r = list_tile(t, at,
                    float_at(t, pnanovdb_root_tile_get_value_address(type, t->buffer, tile)));
    } else {
      uint64_t child = pnanovdb_root_get_child(type, t->buffer, root, tile).address.byte_offset;
      if (!fits(t, child, PNANOVDB_GRID_TYPE_GET(type, upper_size)))
        return fail(t, "its tree is damaged");
      r = list_upper(t, at, child);
    }
    if (r != VL_OK)
      return r;
  }
  return VL_OK;
}

/* ---- their bricks ------------------------------------------------------------------------ */

static vlResult add_tile(Tree *t, float value, uint32_t *entry) {
  if (!isfinite(value))
    return fail(t, "a value is not finite");
  size_t last = t->tiles.count - 1;
  if (value == t->tiles.items[0] || value == t->tiles.items[last]) {
    *entry = VL_SPARSE_TILE | (uint32_t)(value == t->tiles.items[0] ? 0 : last);
    return VL_OK;
  }
  float *slot = VL_PUSH(t->world->context, &t->tiles);
  if (!slot)
    return vl_fail_memory(t->error);
  *slot = value;
  *entry = VL_SPARSE_TILE | (uint32_t)(t->tiles.count - 1);
  return VL_OK;
}

static vlResult add_leaf(Tree *t, uint64_t address, uint32_t *entry) {
  if (!fits(t, address, PNANOVDB_GRID_TYPE_GET(type, leaf_size)) ||
      t->values.count / VL_BRICK_VALUES >= t->max_bricks)
    return fail(t, "its tree is damaged");
  if (!VL_RESERVE(t->world->context, &t->values, VL_BRICK_VALUES))
    return vl_fail_memory(t->error);
  float *to = t->values.items + t->values.count;
  pnanovdb_leaf_handle_t leaf = {address_of(address)};
  bool finite = true;
  for (uint32_t n = 0; n < VL_BRICK_VALUES; n++) { /* z fastest in the file, x fastest here */
    float v = float_at(t, pnanovdb_leaf_get_table_address(type, t->buffer, leaf, n));
    to[((n & 7) * 8 + (n >> 3 & 7)) * 8 + (n >> 6)] = v;
    finite = finite && isfinite(v);
  }
  if (!finite)
    return fail(t, "a value is not finite");
  *entry = (uint32_t)(t->values.count / VL_BRICK_VALUES);
  t->values.count += VL_BRICK_VALUES;
  return VL_OK;
}

static vlResult add_lower(Tree *t, uint64_t address, uint32_t *entry) {
  if (!VL_RESERVE(t->world->context, &t->bricks, VL_BLOCK_BRICKS))
    return vl_fail_memory(t->error);
  uint32_t *to = t->bricks.items + t->bricks.count;
  pnanovdb_lower_handle_t lower = {address_of(address)};
  for (uint32_t n = 0; n < VL_BLOCK_BRICKS; n++) {
    uint32_t *brick = to + ((size_t)(n & 15) * 16 + (n >> 4 & 15)) * 16 + (n >> 8);
    vlResult r;
    if (pnanovdb_lower_get_child_mask(t->buffer, lower, n))
      r = add_leaf(t, pnanovdb_lower_get_child(type, t->buffer, lower, n).address.byte_offset,
                   brick);
    else
      r = add_tile(t, float_at(t, pnanovdb_lower_get_table_address(type, t->buffer, lower, n)),
                   brick);
    if (r != VL_OK)
      return r;
  }
  *entry = (uint32_t)(t->bricks.count / VL_BLOCK_BRICKS);
  t->bricks.count += VL_BLOCK_BRICKS;
  return VL_OK;
}

/* Builds the table over the box of all blocks and fills its entries. */
static vlResult build_table(Tree *t, vlSparseGrid *g) {
  int32_t low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  for (size_t i = 0; i < t->blocks.count; i++)
    for (int k = 0; k < 3; k++) {
      int32_t x = t->blocks.items[i].at[k];
      low[k] = i == 0 || x < low[k] ? x : low[k];
      high[k] = i == 0 || x > high[k] ? x : high[k];
    }
  uint64_t cells = 1;
  for (int k = 0; k < 3; k++) {
    g->low[k] = (int32_t)((uint32_t)low[k] << 7);
    g->size[k] = t->blocks.count ? (uint32_t)(high[k] - low[k]) + 1 : 0;
    cells = cells > MAX_TABLE ? cells : cells * g->size[k];
  }
  if (cells > MAX_TABLE)
    return fail(t, "its parts lie too far from each other");
  uint32_t *table = vl_world_block(t->world, cells, sizeof *table);
  if (!table)
    return vl_fail_memory(t->error);
  for (size_t i = 0; i < cells; i++)
    table[i] = VL_SPARSE_TILE;
  g->blocks = table;
  VL_EACH_ITEM(const Block, b, &t->blocks) {
    size_t x = (size_t)(b->at[0] - low[0]), y = (size_t)(b->at[1] - low[1]),
           z = (size_t)(b->at[2] - low[2]);
    uint32_t *entry = table + (z * g->size[1] + y) * g->size[0] + x;
    VL_TRY(b->node ? add_lower(t, b->node, entry) : add_tile(t, b->value, entry));
  }
  return VL_OK;
}

/* ---- the grid ---------------------------------------------------------------------------- */

/* Moves the pointer to a growing array: the world owns the array from then on. */
static bool give(vlWorld *world, void *pointer, void *result_pointer) {
  void **slot = VL_PUSH(world->context, &world->blocks);
  if (!slot)
    return false;
  memcpy(slot, pointer, sizeof *slot);
  memcpy(result_pointer, pointer, sizeof *slot);
  memset(pointer, 0, sizeof *slot);
  return true;
}

static vlResult take_apart(Tree *t, vlSparseGrid *g) {
  pnanovdb_grid_handle_t grid = {address_of(0)};
  if (t->size < PNANOVDB_GRID_SIZE + PNANOVDB_TREE_SIZE)
    return fail(t, "it is damaged");
  uint32_t kind = pnanovdb_grid_get_grid_type(t->buffer, grid);
  uint32_t use = pnanovdb_grid_get_grid_class(t->buffer, grid);
  if (kind != PNANOVDB_GRID_TYPE_FLOAT)
    return fail(t, "its values are not floats");
  if (use != PNANOVDB_GRID_CLASS_FOG_VOLUME && use != PNANOVDB_GRID_CLASS_UNKNOWN)
    return fail(t, "it is no fog volume");
  pnanovdb_map_handle_t map = pnanovdb_grid_get_map(t->buffer, grid);
  for (uint32_t i = 0; i < 3; i++) {
    double sum = 0;
    for (uint32_t k = 0; k < 3; k++) {
      double m = pnanovdb_map_get_invmatd(t->buffer, map, 3 * i + k);
      g->index_from_medium[4 * i + k] = (float)m;
      sum -= m * pnanovdb_map_get_vecd(t->buffer, map, k);
    }
    g->index_from_medium[4 * i + 3] = (float)sum;
    g->box_low[i] = pnanovdb_grid_get_world_bbox(t->buffer, grid, i);
    g->box_high[i] = pnanovdb_grid_get_world_bbox(t->buffer, grid, 3 + i);
    if (!isfinite(g->box_low[i]) || !isfinite(g->box_high[i]))
      return fail(t, "its box is not finite");
  }
  for (int i = 0; i < 12; i++)
    if (!isfinite(g->index_from_medium[i]))
      return fail(t, "its map is not finite");
  pnanovdb_tree_handle_t tree = pnanovdb_grid_get_tree(t->buffer, grid);
  pnanovdb_root_handle_t root = pnanovdb_tree_get_root(t->buffer, tree);
  if (!fits(t, root.address.byte_offset, PNANOVDB_GRID_TYPE_GET(type, root_size)))
    return fail(t, "its tree is damaged");
  t->background = float_at(
      t,
      pnanovdb_address_offset(root.address, PNANOVDB_GRID_TYPE_GET(type, root_off_background)));
  if (!isfinite(t->background))
    return fail(t, "its background is not finite");
  t->max_bricks = t->size / PNANOVDB_GRID_TYPE_GET(type, leaf_size);
  float *first = VL_PUSH(t->world->context, &t->tiles);
  if (!first)
    return vl_fail_memory(t->error);
  *first = t->background;
  VL_TRY(list_root(t, root));
  return build_table(t, g);
}

vlResult vl_nanovdb_read(vlWorld *world, const char *path, const char *name,
                         const vlSparseGrid **grid, vlError *error) {
  vlNanoGrid found;
  *grid = NULL;
  vlResult r = vl_nanovdb_find(world->context, path, name, &found, error);
  if (r != VL_OK || !found.words)
    return r;
  Tree tree = {.world = world, .path = path, .name = name, .size = found.size, .error = error};
  tree.buffer = pnanovdb_make_buf((uint32_t *)found.words, found.size / 4);
  vlSparseGrid *g = vl_world_block(world, 1, sizeof *g);
  if (g)
    memset(g, 0, sizeof *g);
  r = g ? take_apart(&tree, g) : vl_fail_memory(error);
  VL_FREE(world->context, found.words, tree.blocks.items);
  /* arrays that the world now owns are not freed here */
  if (r == VL_OK && !(give(world, &tree.tiles.items, &g->tiles) &&
                      give(world, &tree.bricks.items, &g->bricks) &&
                      give(world, &tree.values.items, &g->values)))
    r = vl_fail_memory(error);
  VL_FREE(world->context, tree.tiles.items, tree.bricks.items, tree.values.items);
  if (r == VL_OK)
    *grid = g;
  return r;
}
