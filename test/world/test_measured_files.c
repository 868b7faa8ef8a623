/* test_measured_files.c: damaged files of measured materials. Each damage gives one clear error
 * that names the file, with memory bounded by the file's size; failing allocations leak
 * nothing; a file that several materials name is read once; a rendered measured material looks
 * like the metal that was measured. */
#include <stdlib.h>

#include "../trace/measured_file.h"
#include "material/measured_tables.h"
#include "material/tensor.h"
#include "render/shots.h"
#include "trace/bsdf_batch.h"
#include "velo/shape_kinds.h"
#include "world/world.h"

static const char path[] = VELO_BINARY_DIR "/damaged.bsdf";

/* The largest block requested, and the number of live blocks. */
typedef struct Purse {
  long left; /* allocations that still succeed; negative: all */
  long alive;
  size_t largest;
} Purse;
static bool pay(Purse *p, size_t size) {
  if (p->left == 0)
    return false;
  if (p->left > 0)
    p->left--;
  p->largest = size > p->largest ? size : p->largest;
  return true;
}
static void *purse_allocate(void *user, size_t size) {
  Purse *p = user;
  if (!pay(p, size))
    return NULL;
  p->alive++;
  return malloc(size);
}
static void purse_release(void *user, void *block) {
  Purse *p = user;
  if (block)
    p->alive--;
  free(block);
}
static vlContext *open_context(Purse *purse) {
  vlContextDef def = vl_default_context_def();
  def.allocator = (vlAllocator){purse, purse_allocate, purse_release};
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  return context;
}

static mfFile small_file(void) {
  mfSurface metal = mf_surface(0.4, 0.2);
  metal.nodes = metal.samples = 8;
  metal.thetas = metal.lambdas = 3;
  metal.phis = 4;
  return mf_measure(&metal);
}
/* Offset of a field's rank; its type, offset and shape follow after 2, 3 and 11 bytes. */
static size_t head_of(const mfFile *file, const char *name) {
  size_t length = strlen(name);
  for (size_t i = 18; i + length < 600; i++)
    if (file->bytes[i - 2] == length && memcmp(file->bytes + i, name, length) == 0)
      return i + length;
  fail_msg("no field %s", name);
  return 0;
}
static uint64_t offset_of(const mfFile *file, const char *name) {
  uint64_t offset;
  memcpy(&offset, file->bytes + head_of(file, name) + 3, 8);
  return offset;
}

/* ---- damages with a name ----------------------------------------------------------------- */

/* Bytes that replace those of a file, and a word of the error that it then gives. */
typedef struct Damage {
  const char *word;
  const char *field;          /* that they are in; null: `at` counts from the file's start */
  enum { HEAD, VALUES } part; /* what `at` counts from */
  int at;
  uint64_t value;
  size_t size; /* number of bytes of the value */
} Damage;

static void cut_in_the_head(mfFile *f) {
  f->size = 15;
}
static void cut_at_the_end(mfFile *f) {
  f->size -= 2;
}
static void put_values_behind_the_end(mfFile *f) {
  const uint64_t at = f->size + 1;
  memcpy(f->bytes + head_of(f, "vndf") + 3, &at, sizeof at);
}
static void name_a_field_twice(mfFile *f) {
  memcpy(f->bytes + head_of(f, "phi_i") - 5, "sigma", 5);
}
/* A shorter name; the values stay where they are. */
static void make_rgb(mfFile *f) {
  size_t at = head_of(f, "spectra"), end = offset_of(f, "description");
  const uint16_t length = 3;
  memcpy(f->bytes + at - 7, "rgb", length);
  memcpy(f->bytes + at - 9, &length, sizeof length);
  memmove(f->bytes + at - 4, f->bytes + at, end - at);
}

/* floats, as their bits */
enum {
  THREE = 0x40400000,
  HUNDRED = 0x42c80000,
  NOT_A_NUMBER = 0x7fc00000,
  TOO_LARGE = 0x7f800000
};

static const Damage damaged_bytes[] = {
    {"this is no tensor file", NULL, HEAD, 3, 'x', 1},
    {"version 2.0", NULL, HEAD, 12, 2, 1},
    {"version 1.1", NULL, HEAD, 13, 1, 1},
    {"announces 65 fields", NULL, HEAD, 14, 65, 4},
    {"has no \"vndf\"", "vndf", HEAD, -1, 'x', 1},
    {"unknown type 12", "vndf", HEAD, 2, 12, 1},
    {"unknown type 0", "vndf", HEAD, 2, 0, 1},
    {"has 9 dimensions", "vndf", HEAD, 0, 9, 2},
    {"ends before what it announces", "vndf", HEAD, 11, (uint64_t)1 << 62, 8},
    {"ends before what it announces", "vndf", HEAD, 3, UINT64_MAX - 4, 8},
    {"should be 32-bit floats of 2 dimensions", "ndf", HEAD, 2, 5, 1},
    {"should be 32-bit floats of 4 dimensions", "vndf", HEAD, 11, 0, 1},
    {"is not ascending", "theta_i", VALUES, 4, 0, 4},
    {"is out of range", "theta_i", VALUES, 8, THREE, 4},
    {"holds a value that is not finite", "luminance", VALUES, 40, NOT_A_NUMBER, 4},
    {"does not fit \"theta_i\"", "luminance", HEAD, 19, 2, 8},
    {"less than 2 x 2 values", "ndf", HEAD, 11, 1, 8},
    {"should be bytes of 1 dimension", "jacobian", HEAD, 2, 2, 1},
    {"should be 32-bit floats of 1 dimension", "wavelengths", HEAD, 2, 5, 1},
    {"holds a value that is not finite", "spectra", VALUES, 0, TOO_LARGE, 4},
    {"is not ascending", "wavelengths", VALUES, 4, HUNDRED, 4}};

static const struct {
  const char *word;
  void (*damage)(mfFile *f);
} other_damages[] = {{"ends before what it announces", cut_in_the_head},
                     {"ends before what it announces", put_values_behind_the_end},
                     {"the same field twice", name_a_field_twice},
                     {"kept as RGB", make_rgb},
                     {"ends before what it announces", cut_at_the_end}};

static void expect(vlContext *context, mfFile *f, const char *word) {
  vlMeasured *m = NULL;
  vlError error = {0};
  assert_true(mf_write(path, f));
  vlResult r = vl_measured_read(context, path, false, &m, &error);
  if (r != VL_ERROR_SCENE || !strstr(error.message, word) || !strstr(error.message, path) || m)
    fail_msg("%d \"%s\", not \"%s\"", (int)r, error.message, word);
  free(f->bytes);
}

static void damages(void **state) {
  (void)state;
  Purse purse = {.left = -1};
  vlContext *context = open_context(&purse);
  vlMeasured *m = NULL;
  vlError error = {0};
  mfFile whole = small_file();
  assert_true(mf_write(path, &whole));
  assert_int_equal(vl_measured_read(context, path, false, &m, &error), VL_OK);
  vl_measured_free(context, m);
  free(whole.bytes);
  for (size_t i = 0; i < sizeof damaged_bytes / sizeof *damaged_bytes; i++) {
    const Damage *d = &damaged_bytes[i];
    mfFile f = small_file();
    size_t start = 0;
    if (d->field)
      start = d->part == HEAD ? head_of(&f, d->field) : offset_of(&f, d->field);
    memcpy(f.bytes + start + d->at, &d->value, d->size);
    expect(context, &f, d->word);
  }
  for (size_t i = 0; i < sizeof other_damages / sizeof *other_damages; i++) {
    mfFile f = small_file();
    other_damages[i].damage(&f);
    expect(context, &f, other_damages[i].word);
  }
  assert_int_equal(vl_measured_read(context, VELO_BINARY_DIR "/absent.bsdf", false, &m, &error),
                   VL_ERROR_MISSING);
  vl_context_destroy(context);
  assert_int_equal(purse.alive, 0);
  remove(path);
}

/* A file of as many fields as can be, each of as many dimensions and of one byte. */
static void most_fields(void **state) {
  (void)state;
  enum { HEADS = VL_MAX_TENSOR_FIELDS * (2 + 2 + 2 + 1 + 8 + 8 * VL_MAX_TENSOR_RANK) };
  static vlTensor tensor;
  Purse purse = {.left = -1};
  vlContext *context = open_context(&purse);
  vlError error = {0};
  mfFile f = {0};
  mf_put(&f, "tensor_file", 12);
  mf_put(&f, "\1", 2);
  mf_put_number(&f, VL_MAX_TENSOR_FIELDS, 4);
  const size_t values = f.size + HEADS;
  for (uint64_t i = 0; i < VL_MAX_TENSOR_FIELDS; i++) {
    mf_put_number(&f, 2, 2);
    mf_put_number(&f, 'a' + i / 8 + ('a' + i % 8) * 256, 2); /* its name */
    mf_put_number(&f, VL_MAX_TENSOR_RANK, 2);
    mf_put_number(&f, VL_TENSOR_U8, 1);
    mf_put_number(&f, values + i, 8);
    for (int k = 0; k < VL_MAX_TENSOR_RANK; k++)
      mf_put_number(&f, 1, 8);
  }
  for (uint64_t i = 0; i < VL_MAX_TENSOR_FIELDS; i++)
    mf_put_number(&f, i, 1);
  assert_true(mf_write(path, &f));
  if (vl_tensor_read(context, path, &tensor, &error) != VL_OK)
    fail_msg("%s", error.message);
  const vlTensorField *last = vl_tensor_find(&tensor, "hh");
  assert_true(last && last->rank == VL_MAX_TENSOR_RANK && last->count == 1);
  assert_int_equal(*last->values, VL_MAX_TENSOR_FIELDS - 1);
  vl_tensor_free(context, &tensor);
  vl_context_destroy(context);
  assert_int_equal(purse.alive, 0);
  free(f.bytes);
  remove(path);
}

/* ---- damages without --------------------------------------------------------------------- */

/* A few hundred files with flipped bits, lost and repeated pieces, extreme numbers: each gives
 * an error with the file's name, or a material with finite values. */
static void mutations(void **state) {
  (void)state;
  Purse purse = {.left = -1};
  vlContext *context = open_context(&purse);
  const vlBsdfKernels *kernels = vl_bsdf_kernels(vl_context_isa(context));
  Batch *b = calloc(1, sizeof *b);
  statRng rng = stat_rng(7);
  uint32_t refused = 0;
  for (int turn = 0; turn < 300; turn++) {
    mfFile f = small_file();
    size_t whole = f.size, head = 420;
    uint64_t wild[6] = {0, 1, UINT64_MAX, (uint64_t)1 << 40, 0x7f800000, 0xff7fffff};
    for (int k = 0; k < 1 + turn % 3; k++) {
      size_t at = stat_bits(&rng) % (turn & 1 ? head : whole - 8);
      if (turn % 5 == 0) {
        f.bytes[at] ^= (unsigned char)(1u << stat_bits(&rng) % 8);
      } else if (turn % 5 == 1) {
        memcpy(f.bytes + at, &wild[stat_bits(&rng) % 6], turn % 3 ? 4 : 8);
      } else if (turn % 5 == 2) {
        f.size = stat_bits(&rng) % whole;
      } else if (turn % 5 == 3) {
        memmove(f.bytes + at, f.bytes + at + 5, whole - at - 5);
        f.size = whole - 5;
      } else {
        f.bytes[at] = (unsigned char)stat_bits(&rng);
      }
    }
    assert_true(mf_write(path, &f));
    vlMeasured *m = NULL;
    vlError error = {0};
    purse.largest = 0;
    vlResult r = vl_measured_read(context, path, turn % 7 == 0, &m, &error);
    if (r != VL_OK) {
      refused++;
      assert_int_equal(r, VL_ERROR_SCENE);
      assert_non_null(strstr(error.message, path));
    } else {
      for (uint32_t i = 0; i < 256; i++) {
        double o[3], w[3];
        stat_direction(&rng, o);
        stat_direction(&rng, w);
        b->measured[i] = m;
        b->ox[i] = (float)o[0];
        b->oy[i] = (float)o[1];
        b->oz[i] = (float)o[2];
        b->ix[i] = (float)w[0];
        b->iy[i] = (float)w[1];
        b->iz[i] = (float)w[2];
        for (int c = 0; c < 4; c++)
          b->lambda[c][i] = 300 + 600 * stat_float(&rng);
      }
      batch_numbers(b, 256, &rng);
      for (int way = 0; way < 2; way++) {
        if (way == 0)
          batch_eval(kernels, VL_BSDF_MEASURED, 256, b);
        else
          batch_sample(kernels, VL_BSDF_MEASURED, 256, b);
        for (uint32_t i = 0; i < 256; i++)
          for (int c = 0; c < 4; c++) {
            float x = way ? b->weight[c][i] : b->value[c][i];
            assert_true(x >= 0 && x < INFINITY && b->pdf[i] >= 0 && b->pdf[i] < INFINITY);
          }
      }
      vl_measured_free(context, m);
    }
    assert_true(purse.largest <= 4 * whole);
    free(f.bytes);
  }
  print_message("%u of 300 refused\n", refused);
  assert_true(refused > 60 && refused < 290);
  free(b);
  vl_context_destroy(context);
  assert_int_equal(purse.alive, 0);
  remove(path);
}

static void no_memory(void **state) {
  (void)state;
  mfFile f = small_file();
  assert_true(mf_write(path, &f));
  Purse purse = {.left = -1};
  vlContext *context = open_context(&purse);
  long before = purse.alive, n = 0;
  for (vlResult r = VL_ERROR_MEMORY; r != VL_OK; n++) {
    vlMeasured *m = NULL;
    vlError error = {0};
    purse.left = n;
    r = vl_measured_read(context, path, true, &m, &error);
    purse.left = -1;
    assert_true(r == VL_OK || (r == VL_ERROR_MEMORY && !m));
    vl_measured_free(context, m);
    assert_int_equal(purse.alive, before);
  }
  assert_true(n > 4);
  vl_context_destroy(context);
  free(f.bytes);
  remove(path);
}

/* ---- in a scene -------------------------------------------------------------------------- */

/* A ball of brushed metal under a lamp and a sky; another in the back has the same file. */
static Image ball(const mfSurface *metal, bool measured, bool rgb) {
  Stage s = stage_open(64, 64);
  s.build.color = rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
  s.render.spp = 64;
  vlMaterialDef def =
      vl_default_material_def(measured ? VL_MATERIAL_MEASURED : VL_MATERIAL_CONDUCTOR);
  def.measured = measured ? path : NULL;
  def.u_roughness = vl_float_input((float)metal->alpha_x);
  def.v_roughness = vl_float_input((float)metal->alpha_y);
  def.remap_roughness = false;
  def.eta = vl_spectrum_input(vl_spectrum_constant((float)metal->eta));
  def.k = vl_spectrum_input(vl_spectrum_constant((float)metal->k));
  for (int i = 0; i < 2; i++) {
    vlShapeDef round = vl_default_shape_def(VL_SHAPE_SPHERE);
    round.material = vl_scene_add_material(s.scene, &def);
    set_matrix(round.group_from_shape, 1, 0, 0, i, 0, 0, 1, 0, 0, -1, 0, -1.9 - 30 * i);
    assert_int_not_equal(vl_scene_add_shape(s.scene, &round).index, 0);
  }
  add_sky(&s, 0.5f);
  add_point(&s, 2, 3, 1, 40);
  Image p = stage_take(&s);
  if (measured) {
    vlWorld *world = NULL;
    assert_int_equal(vl_world_build(s.scene, &s.build, &world, NULL), VL_OK);
    assert_int_equal(world->measured.count, 1);
    assert_ptr_equal(world->materials.items[1].measured, world->materials.items[2].measured);
    vl_world_destroy(world);
  }
  stage_close(&s);
  return p;
}

static void image(void **state) {
  (void)state;
  mfSurface metal = mf_surface(0.6, 0.25);
  metal.color = 0;
  metal.lambdas = 2;
  metal.parts = 4;
  metal.phis = 32;
  mfFile f = mf_measure(&metal);
  assert_true(mf_write(path, &f));
  for (int rgb = 0; rgb < 2; rgb++) {
    Image a = ball(&metal, true, rgb), b = ball(&metal, false, rgb);
    double off = 0, all = 0;
    for (uint32_t y = 8; y < 56; y += 4)
      for (uint32_t x = 8; x < 56; x += 4)
        for (int c = 0; c < 3; c++) {
          double u = image_region(&a, x, y, x + 4, y + 4, c),
                 v = image_region(&b, x, y, x + 4, y + 4, c);
          off += fabs(u - v);
          all += v;
        }
    print_message("mean %.4f, metal's %.4f; blocks off by %.4f\n", image_mean(&a, 1),
                  image_mean(&b, 1), off / all);
    assert_true(off / all < 0.02 && a.stats.not_finite == 0);
    assert_ratio("measured ball", image_mean(&a, 1), image_mean(&b, 1), 0.004);
    image_free(&a);
    image_free(&b);
  }
  free(f.bytes);
  remove(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(damages), cmocka_unit_test(most_fields),
                                     cmocka_unit_test(mutations), cmocka_unit_test(no_memory),
                                     cmocka_unit_test(image)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
