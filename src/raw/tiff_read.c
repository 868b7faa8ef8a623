/* raw/tiff_read.c: reads DNG files as tiff_write.c writes them. The files come from strangers:
 * what sizes memory is checked against the size of the file before libtiff or velo allocates.
 */
#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "raw/files.h"
#include "raw/tiff_memory.h"

enum { CELLS = VL_RAW_MAX_CELLS, COLORS = VL_RAW_MAX_COLORS };
enum { CFA_PIXELS = 32803, LINEAR_PIXELS = 34892 };

typedef struct Reader {
  vlTiffMemory memory;
  TIFF *tiff;
  const char *path;
  vlError *error;
} Reader;

static vlResult broken(const Reader *r, const char *what) {
  return vl_fail(r->error, VL_ERROR_SCENE, "%s: broken DNG file: %s", r->path, what);
}

static vlResult unsupported(const Reader *r, const char *what) {
  return vl_fail(r->error, VL_ERROR_UNSUPPORTED, "%s: DNG file with %s is not supported",
                 r->path, what);
}

/* ---- the file before libtiff ------------------------------------------------------------- */

static uint32_t integer_at(const vlTiffMemory *m, uint64_t at, uint32_t bytes) {
  uint32_t value = 0;
  for (uint32_t i = 0; i < bytes; i++)
    value |= (uint32_t)m->data[at + i] << (8 * i);
  return value;
}

/* Whether a directory is in the file and has no more entries than velo's. Each entry makes
 * libtiff allocate at most VL_TIFF_MAX_MEMORY. */
static bool is_small_directory(const vlTiffMemory *m, uint64_t at) {
  return at >= 8 && at + 2 <= m->size && integer_at(m, at, 2) >= 1 &&
         integer_at(m, at, 2) <= VL_TIFF_MAX_ENTRIES;
}

static vlResult check_head(const Reader *r, const void *data, size_t size) {
  const vlTiffMemory head = {.data = data, .size = size};
  if (size < 8 || memcmp(data, "II*\0", 4) != 0)
    return vl_fail(r->error, VL_ERROR_SCENE,
                   "%s: not a DNG file as velo writes it (little-endian TIFF)", r->path);
  if (!is_small_directory(&head, integer_at(&head, 4, 4)))
    return broken(r, "its directory is missing or has more than 128 entries");
  return VL_OK;
}

/* ---- tags -------------------------------------------------------------------------------- */

/* A tag of one 16-bit number; 0 if it is missing. */
static uint16_t short_tag(TIFF *t, uint32_t tag) {
  uint16_t value = 0;
  return TIFFGetFieldDefaulted(t, tag, &value) ? value : 0;
}

/* A tag of one fraction, as libtiff stores it; 0 if it is missing. */
static float fraction_tag(TIFF *t, uint32_t tag) {
  const TIFFField *field = TIFFFindField(t, tag, TIFF_ANY);
  float single = 0.0f;
  double value = 0.0;
  if (!field || TIFFFieldPassCount(field))
    return 0.0f;
  if (TIFFFieldSetGetSize(field) == (int)sizeof value)
    return TIFFGetField(t, tag, &value) ? (float)value : 0.0f;
  return TIFFGetField(t, tag, &single) ? single : 0.0f;
}

/* A tag of `count` fractions. False: it is missing or has another number of them. */
static bool fractions_tag(TIFF *t, uint32_t tag, uint32_t count, float *values) {
  const TIFFField *field = TIFFFindField(t, tag, TIFF_ANY);
  uint16_t there = 0;
  const float *from = NULL;
  if (!field || TIFFFieldSetGetSize(field) != (int)sizeof *from ||
      TIFFFieldReadCount(field) != TIFF_VARIABLE)
    return false;
  if (!TIFFGetField(t, tag, &there, &from) || there != count || !from)
    return false;
  memcpy(values, from, count * sizeof *values);
  return true;
}

static vlResult read_layout(const Reader *r, vlRawDef *def) {
  uint32_t width = 0, height = 0;
  TIFF *t = r->tiff;
  if (!TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &width) ||
      !TIFFGetField(t, TIFFTAG_IMAGELENGTH, &height) || !width || !height)
    return broken(r, "it has no size");
  if (short_tag(t, TIFFTAG_BITSPERSAMPLE) != 16 || short_tag(t, TIFFTAG_SAMPLESPERPIXEL) != 1)
    return unsupported(r, "other pixels than one number of 16 bits");
  if (short_tag(t, TIFFTAG_COMPRESSION) != COMPRESSION_NONE || TIFFIsTiled(t))
    return unsupported(r, "compression or tiles");
  if (width > VL_RAW_MAX_LENGTH || height > VL_RAW_MAX_LENGTH ||
      (uint64_t)width * height > VL_RAW_MAX_PIXELS)
    return unsupported(r, "more than 65535 pixels in a row or column, or 2^28");
  if ((uint64_t)width * height * 2 > r->memory.size)
    return broken(r, "it promises more pixels than it holds");
  def->width = width;
  def->height = height;
  def->bits = 16;
  return VL_OK;
}

/* The pattern, and the size of the pattern of black levels of a monochrome sensor. */
static vlResult read_pattern(const Reader *r, vlRawDef *def) {
  TIFF *t = r->tiff;
  uint16_t photometric = short_tag(t, TIFFTAG_PHOTOMETRIC), count = 0, *size = NULL;
  const uint8_t *cells = NULL;
  memset(def->pattern, 0, sizeof def->pattern);
  def->pattern_rows = def->pattern_columns = 1;
  if (photometric != LINEAR_PIXELS && photometric != CFA_PIXELS)
    return unsupported(r, "pixels that are no mosaic");
  bool is_mono = photometric == LINEAR_PIXELS;
  uint32_t tag = is_mono ? TIFFTAG_BLACKLEVELREPEATDIM : TIFFTAG_CFAREPEATPATTERNDIM;
  if (TIFFGetField(t, tag, &size) && size) {
    def->pattern_rows = size[0];
    def->pattern_columns = size[1];
  } else if (!is_mono) {
    return broken(r, "its mosaic has no pattern");
  }
  if (def->pattern_rows < 1 || def->pattern_rows > VL_RAW_MAX_SIDE ||
      def->pattern_columns < 1 || def->pattern_columns > VL_RAW_MAX_SIDE)
    return unsupported(r, "a pattern of more than 8 rows or columns");
  uint32_t all = def->pattern_rows * def->pattern_columns;
  if (is_mono) {
    memset(def->pattern, VL_RAW_WHITE, all);
    return VL_OK;
  }
  if (!TIFFGetField(t, TIFFTAG_CFAPATTERN, &count, &cells) || count != all || !cells)
    return broken(r, "its mosaic has no pattern");
  memcpy(def->pattern, cells, all);
  uint8_t colors[COLORS];
  if (!vl_raw_colors(def, colors))
    return unsupported(r, "unknown colours, or more than 4");
  return VL_OK;
}

static vlResult read_levels(const Reader *r, vlRawDef *def) {
  TIFF *t = r->tiff;
  uint16_t *size = NULL, count = 0;
  uint32_t all = def->pattern_rows * def->pattern_columns, rows = 1, columns = 1;
  const uint32_t *white = NULL;
  float black[CELLS] = {0.0f};
  if (!TIFFGetField(t, TIFFTAG_WHITELEVEL, &count, &white) || count != 1 || !white ||
      white[0] < 1 || white[0] > 65535)
    return broken(r, "its white level is not one number from 1 to 65535");
  def->white = (uint16_t)white[0];
  if (TIFFGetField(t, TIFFTAG_BLACKLEVELREPEATDIM, &size) && size) {
    rows = size[0];
    columns = size[1];
  }
  bool is_one = rows == 1 && columns == 1;
  if (!is_one && (rows != def->pattern_rows || columns != def->pattern_columns))
    return unsupported(r, "black levels of another pattern than the mosaic's");
  if (TIFFFindField(t, TIFFTAG_BLACKLEVEL, TIFF_ANY) &&
      !fractions_tag(t, TIFFTAG_BLACKLEVEL, is_one ? 1 : all, black))
    return broken(r, "its black levels are not one, or one for each cell of the pattern");
  for (uint32_t i = 0; i < all; i++) {
    float level = is_one ? black[0] : black[i];
    if (!(level >= 0.0f && level < (float)def->white) || level != floorf(level))
      return broken(r, "a black level is no integer from 0 to below the white level");
    def->black[i] = (uint16_t)level;
  }
  return VL_OK;
}

static vlResult read_color(const Reader *r, vlRawDef *def) {
  TIFF *t = r->tiff;
  uint8_t colors[COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  def->baseline_exposure = fraction_tag(t, TIFFTAG_BASELINEEXPOSURE);
  if (count == 1)
    return VL_OK;
  fractions_tag(t, TIFFTAG_ASSHOTNEUTRAL, count, def->neutral);
  if (!fractions_tag(t, TIFFTAG_COLORMATRIX1, 3 * count, def->matrices[0]) ||
      !fractions_tag(t, TIFFTAG_COLORMATRIX2, 3 * count, def->matrices[1])) {
    memset(def->matrices, 0, sizeof def->matrices);
    return VL_OK;
  }
  if (short_tag(t, TIFFTAG_CALIBRATIONILLUMINANT1) != VL_TIFF_LIGHT_A ||
      short_tag(t, TIFFTAG_CALIBRATIONILLUMINANT2) != VL_TIFF_LIGHT_D65)
    return unsupported(r, "colour matrices of other lights than A and D65");
  return VL_OK;
}

/* Gain and read noise, from the profile of the first colour (set_noise of tiff_write.c). */
static void read_noise(const Reader *r, vlRawDef *def) {
  const TIFFField *field = TIFFFindField(r->tiff, VL_TIFF_NOISE_PROFILE, TIFF_ANY);
  uint32_t count = 0;
  const double *profile = NULL;
  double range = def->white - vl_raw_mean_black(def);
  if (!field || TIFFFieldDataType(field) != TIFF_DOUBLE || !TIFFFieldPassCount(field) ||
      TIFFFieldReadCount(field) != TIFF_VARIABLE2)
    return;
  if (!TIFFGetField(r->tiff, VL_TIFF_NOISE_PROFILE, &count, &profile) || count < 2 || !profile)
    return;
  double gain = profile[0] * range, dark = profile[1] * range * range - 1.0 / 12.0;
  if (!(gain >= 1e-6 && gain <= 1e6) || !(dark < 1e12))
    return;
  def->gain = (float)gain;
  double noise = dark > 1e-12 ? sqrt(dark) / gain : 0.0;
  def->read_noise = noise >= 1e-6 && noise <= 1e6 ? (float)noise : 0.0f;
}

static void read_name(const Reader *r, vlRawDef *def) {
  char *name = NULL;
  if (!TIFFGetField(r->tiff, TIFFTAG_UNIQUECAMERAMODEL, &name) || !name)
    return;
  if (strncmp(name, "velo", 4) == 0)
    name += name[4] == ' ' ? 5 : 4;
  for (size_t i = 0; name[i] && i + 1 < sizeof def->camera; i++)
    def->camera[i] = name[i] < ' ' || name[i] > '~' ? '?' : name[i];
}

/* ---- numbers and EXIF -------------------------------------------------------------------- */

/* Reads the strips into the raw image and sets its bits. */
static vlResult read_numbers(const Reader *r, vlRaw *raw) {
  TIFF *t = r->tiff;
  uint8_t *to = (uint8_t *)raw->numbers;
  size_t left = (size_t)raw->def.width * raw->def.height * 2;
  uint32_t strips = TIFFNumberOfStrips(t), bits = 1;
  for (uint32_t i = 0; i < strips && left; i++) {
    tmsize_t n = TIFFReadEncodedStrip(t, i, to, (tmsize_t)left);
    if (n <= 0 || (size_t)n > left)
      return broken(r, "its pixels are missing");
    to += n;
    left -= (size_t)n;
  }
  if (left)
    return broken(r, "its pixels are missing");
  uint16_t all = raw->def.white;
  for (size_t i = 0; i < (size_t)raw->def.width * raw->def.height; i++)
    all |= raw->numbers[i];
  while (all >> bits)
    bits++;
  raw->def.bits = bits;
  return VL_OK;
}

/* Reads the directory of EXIF, which takes the place of the main one. Files without it, or with
 * a broken one, have no such metadata. */
static void read_exif(const Reader *r, vlRawDef *def) {
  TIFF *t = r->tiff;
  uint64_t offset = 0;
  uint16_t count = 0, *iso = NULL;
  if (!TIFFGetField(t, TIFFTAG_EXIFIFD, &offset) || offset > r->memory.size ||
      !is_small_directory(&r->memory, offset) || !TIFFReadEXIFDirectory(t, offset))
    return;
  def->exposure_time = fraction_tag(t, EXIFTAG_EXPOSURETIME);
  def->f_number = fraction_tag(t, EXIFTAG_FNUMBER);
  def->focal_length = (float)((double)fraction_tag(t, EXIFTAG_FOCALLENGTH) / 1000.0);
  if (TIFFGetField(t, EXIFTAG_ISOSPEEDRATINGS, &count, &iso) && count && iso)
    def->iso = iso[0];
}

static vlResult read_all(Reader *r, vlRaw **raw) {
  vlRawDef def = vl_default_raw_def(1, 1);
  vlResult result = read_layout(r, &def);
  if (result == VL_OK)
    result = read_pattern(r, &def);
  if (result == VL_OK)
    result = read_levels(r, &def);
  if (result == VL_OK)
    result = read_color(r, &def);
  if (result != VL_OK)
    return result;
  read_noise(r, &def);
  read_name(r, &def);
  vlError why;
  result = vl_raw_create(r->memory.context, &def, raw, &why);
  if (result == VL_ERROR_ARGUMENT)
    return broken(r, why.message);
  if (result != VL_OK)
    return vl_fail_memory(r->error);
  result = read_numbers(r, *raw);
  if (result != VL_OK)
    return result;
  read_exif(r, &(*raw)->def);
  if (vl_raw_check(&(*raw)->def, &why) != VL_OK)
    return broken(r, why.message);
  return VL_OK;
}

vlResult vl_raw_read_dng(vlContext *context, const char *path, const void *data, size_t size,
                         vlRaw **raw, vlError *error) {
  Reader r = {.path = path, .error = error};
  vlRaw *made = NULL;
  vlResult result = check_head(&r, data, size);
  if (result != VL_OK)
    return result;
  if (vl_tiff_open_read(&r.memory, context, path, data, size)) {
    r.tiff = r.memory.tiff;
    result = read_all(&r, &made);
  } else {
    result = broken(&r, r.memory.message[0] ? r.memory.message : "libtiff cannot read it");
  }
  vl_tiff_close(&r.memory);
  if (result == VL_OK)
    *raw = made;
  else
    vl_raw_destroy(made);
  return result;
}
