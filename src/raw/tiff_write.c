/* raw/tiff_write.c: raw images as DNG (Adobe, Digital Negative Specification 1.4.0.0) and as
 * 16-bit TIFF: little-endian, one uncompressed strip, no date, so that the bytes repeat. */
#include <math.h>
#include <string.h>

#include "raw/files.h"
#include "raw/tiff_memory.h"

enum { CELLS = VL_RAW_MAX_CELLS, COLORS = VL_RAW_MAX_COLORS };
enum { PHOTOMETRIC_CFA_PIXELS = 32803, PHOTOMETRIC_LINEAR_PIXELS = 34892 };

/* libtiff 4.5 knows the other tags. */
static const TIFFFieldInfo noise_profile[] = {{VL_TIFF_NOISE_PROFILE, TIFF_VARIABLE,
                                               TIFF_VARIABLE, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1,
                                               (char *)(uintptr_t) "NoiseProfile"}};

/* What every TIFF file of one strip of 16-bit numbers has. */
static bool set_layout(TIFF *t, const vlRawDef *def, uint32_t photometric) {
  return TIFFSetField(t, TIFFTAG_SUBFILETYPE, 0) &&
         TIFFSetField(t, TIFFTAG_IMAGEWIDTH, def->width) &&
         TIFFSetField(t, TIFFTAG_IMAGELENGTH, def->height) &&
         TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 16) &&
         TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_NONE) &&
         TIFFSetField(t, TIFFTAG_PHOTOMETRIC, photometric) &&
         TIFFSetField(t, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) &&
         TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, 1) &&
         TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, def->height) &&
         TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
         TIFFSetField(t, TIFFTAG_SOFTWARE, "velo");
}

static bool write_numbers(TIFF *t, const vlRaw *raw) {
  tmsize_t size = (tmsize_t)raw->def.width * raw->def.height * 2;
  /* as they are in memory: the machines that velo runs on are little-endian, as the file */
  return TIFFWriteRawStrip(t, 0, raw->numbers, size) == size && TIFFWriteDirectory(t);
}

/* ---- EXIF -------------------------------------------------------------------------------- */

/* The fraction of the least integers whose nearest float is the value, from 1e-6 to 1e9: 1/250,
 * where libtiff finds 8589935/2147483648. By convergents of the continued fraction (Hardy and
 * Wright, An Introduction to the Theory of Numbers, 10.2). */
static void simple_fraction(float value, uint32_t fraction[2]) {
  double rest = (double)value, before[2] = {0.0, 1.0}, now[2] = {1.0, 0.0};
  for (int i = 0; i < 40; i++) {
    double whole = floor(rest);
    for (int k = 0; k < 2; k++) {
      double next = whole * now[k] + before[k];
      before[k] = now[k];
      now[k] = next;
    }
    if ((float)(now[0] / now[1]) == value || !(rest > whole))
      break;
    rest = 1.0 / (rest - whole);
  }
  fraction[0] = (uint32_t)now[0];
  fraction[1] = (uint32_t)now[1];
}

/* Replaces the fraction of a tag, if it is there, in the directory of EXIF that libtiff has
 * written at this offset. */
static void simplify(vlFileWriter *writer, uint64_t offset, uint16_t tag, float value) {
  const uint8_t *bytes = (const uint8_t *)writer->memory;
  uint32_t fraction[2], count = bytes[offset] | (uint32_t)bytes[offset + 1] << 8;
  simple_fraction(value, fraction);
  for (uint32_t i = 0; i < count; i++) {
    const uint8_t *entry = bytes + offset + 2 + 12 * i;
    uint32_t at;
    memcpy(&at, entry + 8, sizeof at);
    if ((entry[0] | entry[1] << 8) == tag)
      vl_file_write_at(writer, fraction, sizeof fraction, at);
  }
}

static bool set_fraction(TIFF *t, uint32_t tag, float value) {
  return !(value > 0.0f) || TIFFSetField(t, tag, (double)value);
}

/* Writes the directory of EXIF and stores its offset in the file. */
static bool write_exif(vlTiffMemory *memory, const vlRawDef *def, uint64_t *offset) {
  TIFF *t = memory->tiff;
  uint16_t iso = (uint16_t)def->iso;
  float millimetres = (float)((double)def->focal_length * 1000.0);
  bool is_written =
      TIFFCreateEXIFDirectory(t) == 0 && TIFFSetField(t, EXIFTAG_EXIFVERSION, "0230") &&
      set_fraction(t, EXIFTAG_EXPOSURETIME, def->exposure_time) &&
      set_fraction(t, EXIFTAG_FNUMBER, def->f_number) &&
      (!iso || TIFFSetField(t, EXIFTAG_ISOSPEEDRATINGS, 1, &iso)) &&
      set_fraction(t, EXIFTAG_FOCALLENGTH, millimetres) && TIFFWriteCustomDirectory(t, offset);
  if (!is_written || memory->writer.failed_errno)
    return false;
  simplify(&memory->writer, *offset, EXIFTAG_EXPOSURETIME, def->exposure_time);
  simplify(&memory->writer, *offset, EXIFTAG_FNUMBER, def->f_number);
  simplify(&memory->writer, *offset, EXIFTAG_FOCALLENGTH, millimetres);
  return true;
}

/* ---- DNG --------------------------------------------------------------------------------- */

static bool set_names(TIFF *t, const vlRawDef *def) {
  static const uint8_t version[4] = {1, 4, 0, 0}, oldest_reader[4] = {1, 3, 0, 0};
  char unique[sizeof def->camera + 8];
  snprintf(unique, sizeof unique, "velo%s%s", def->camera[0] ? " " : "", def->camera);
  return TIFFSetField(t, TIFFTAG_MAKE, "velo") &&
         TIFFSetField(t, TIFFTAG_MODEL, def->camera[0] ? def->camera : "sensor") &&
         TIFFSetField(t, TIFFTAG_DNGVERSION, version) &&
         TIFFSetField(t, TIFFTAG_DNGBACKWARDVERSION, oldest_reader) &&
         TIFFSetField(t, TIFFTAG_UNIQUECAMERAMODEL, unique);
}

static bool set_mosaic(TIFF *t, const vlRawDef *def) {
  uint16_t size[2] = {(uint16_t)def->pattern_rows, (uint16_t)def->pattern_columns};
  uint8_t colors[COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  return TIFFSetField(t, TIFFTAG_CFAREPEATPATTERNDIM, size) &&
         TIFFSetField(t, TIFFTAG_CFAPATTERN, size[0] * size[1], def->pattern) &&
         TIFFSetField(t, TIFFTAG_CFAPLANECOLOR, count, colors) &&
         TIFFSetField(t, TIFFTAG_CFALAYOUT, 1);
}

/* One black level if all cells have the same, else one for each. */
static bool set_levels(TIFF *t, const vlRawDef *def) {
  uint32_t cells = def->pattern_rows * def->pattern_columns, white = def->white;
  uint16_t size[2] = {(uint16_t)def->pattern_rows, (uint16_t)def->pattern_columns};
  float black[CELLS];
  bool is_one = true;
  for (uint32_t i = 0; i < cells; i++) {
    black[i] = def->black[i];
    is_one = is_one && def->black[i] == def->black[0];
  }
  if (is_one)
    size[0] = size[1] = 1;
  return TIFFSetField(t, TIFFTAG_BLACKLEVELREPEATDIM, size) &&
         TIFFSetField(t, TIFFTAG_BLACKLEVEL, is_one ? 1 : (int)cells, black) &&
         TIFFSetField(t, TIFFTAG_WHITELEVEL, 1, &white);
}

static bool set_color(TIFF *t, const vlRawDef *def, uint32_t colors) {
  if (colors > 1 && vl_raw_has_matrices(def) &&
      !(TIFFSetField(t, TIFFTAG_COLORMATRIX1, 3 * colors, def->matrices[0]) &&
        TIFFSetField(t, TIFFTAG_COLORMATRIX2, 3 * colors, def->matrices[1]) &&
        TIFFSetField(t, TIFFTAG_CALIBRATIONILLUMINANT1, VL_TIFF_LIGHT_A) &&
        TIFFSetField(t, TIFFTAG_CALIBRATIONILLUMINANT2, VL_TIFF_LIGHT_D65)))
    return false;
  if (colors > 1 && def->neutral[0] > 0.0f &&
      !TIFFSetField(t, TIFFTAG_ASSHOTNEUTRAL, colors, def->neutral))
    return false;
  return TIFFSetField(t, TIFFTAG_BASELINEEXPOSURE, (double)def->baseline_exposure);
}

/* The variance of a number v, as a share of white - black, is S v + O: photon noise, and read
 * noise with the twelfth of a square number that rounding adds. */
static bool set_noise(TIFF *t, const vlRawDef *def, uint32_t colors) {
  double range = def->white - vl_raw_mean_black(def), profile[2 * COLORS];
  double dark = (double)def->gain * (double)def->read_noise;
  for (uint32_t k = 0; k < colors; k++) {
    profile[2 * k] = (double)def->gain / range;
    profile[2 * k + 1] = (dark * dark + 1.0 / 12.0) / (range * range);
  }
  return !(def->gain > 0.0f) || TIFFSetField(t, VL_TIFF_NOISE_PROFILE, 2 * colors, profile);
}

static bool write_dng(vlTiffMemory *memory, const vlRaw *raw) {
  TIFF *t = memory->tiff;
  const vlRawDef *def = &raw->def;
  uint8_t colors[COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  uint64_t exif = 0;
  if (!write_exif(memory, def, &exif))
    return false;
  TIFFFreeDirectory(t);
  if (TIFFCreateDirectory(t) != 0 || TIFFMergeFieldInfo(t, noise_profile, 1) != 0)
    return false;
  return set_layout(t, def, count > 1 ? PHOTOMETRIC_CFA_PIXELS : PHOTOMETRIC_LINEAR_PIXELS) &&
         set_names(t, def) && (count == 1 || set_mosaic(t, def)) && set_levels(t, def) &&
         set_color(t, def, count) && set_noise(t, def, count) &&
         TIFFSetField(t, TIFFTAG_EXIFIFD, exif) && write_numbers(t, raw);
}

vlResult vl_raw_write_dng(const vlRaw *raw, const char *path, vlError *error) {
  vlTiffMemory memory;
  bool whole = vl_tiff_open_write(&memory, raw->context, path) && write_dng(&memory, raw);
  return vl_tiff_finish(&memory, whole, path, error);
}

vlResult vl_raw_write_tiff(const vlRaw *raw, const char *path, vlError *error) {
  vlTiffMemory memory;
  bool whole = vl_tiff_open_write(&memory, raw->context, path) &&
               set_layout(memory.tiff, &raw->def, PHOTOMETRIC_MINISBLACK) &&
               write_numbers(memory.tiff, raw);
  return vl_tiff_finish(&memory, whole, path, error);
}
