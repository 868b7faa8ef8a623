/** @file
 * velo/raw.h: raw images: the numbers that a sensor's converter gave, one for each pixel behind
 * its colour filter, with what is needed to develop them. Files, colour matrices, development.
 */
#ifndef VELO_RAW_H
#define VELO_RAW_H

#include "velo/color.h"
#include "velo/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The colour of a pixel's filter: the codes of TIFF/EP and DNG. */
typedef enum vlRawColor {
  VL_RAW_RED = 0,
  VL_RAW_GREEN = 1,
  VL_RAW_BLUE = 2,
  VL_RAW_CYAN = 3,
  VL_RAW_MAGENTA = 4,
  VL_RAW_YELLOW = 5,
  VL_RAW_WHITE = 6 /**< no filter */
} vlRawColor;

enum {
  VL_RAW_MAX_SIDE = 8,         /**< rows, and columns, of a pattern */
  VL_RAW_MAX_CELLS = 64,       /**< cells of a pattern */
  VL_RAW_MAX_COLORS = 4,       /**< different colours of a pattern */
  VL_RAW_MAX_PIXELS = 1 << 28, /**< pixels of a raw image */
  VL_RAW_MAX_LENGTH = 65535    /**< its greatest width and height */
};

/** What a raw image is, beside its numbers. Arrays over the pattern's cells are in the order of
 * its rows. Arrays over its colours are in the order of the colours' codes: for Bayer red,
 * green, blue. */
typedef struct vlRawDef {
  uint32_t cookie;
  uint32_t width, height;                 /**< pixels */
  uint32_t bits;                          /**< of a number, 1 to 16: numbers are below 2^bits */
  uint32_t pattern_rows, pattern_columns; /**< of the pattern of filters, 1 to 8 each */
  uint8_t pattern[VL_RAW_MAX_CELLS]; /**< vlRawColor of each cell; the first cell is that of
                                        the first pixel. vl_raw_set_pattern writes it */
  uint16_t black[VL_RAW_MAX_CELLS];  /**< the number for no light, of each cell */
  uint16_t white;  /**< the number for light that saturates, above every black level */
  char camera[64]; /**< name of the camera, printable ASCII; "velo" is put before it in files */
  float exposure_time;     /**< seconds; 0: not known */
  float f_number;          /**< 0: not known */
  float focal_length;      /**< metres; 0: not known */
  uint32_t iso;            /**< ISO speed, up to 65535; 0: not known */
  float gain;              /**< numbers per electron; 0: not known */
  float read_noise;        /**< standard deviation of a dark number, electrons */
  float baseline_exposure; /**< exposure that development adds, in EV */
  /** The camera's numbers for a white surface in the light of the scene, black level
   * subtracted, the greatest of them 1. Zeros: not known. */
  float neutral[VL_RAW_MAX_COLORS];
  /** For each colour a row of three factors: the camera's numbers from CIE 1931 XYZ, under CIE
   * illuminant A ([0]) and D65 ([1]). Zeros: not known. vl_raw_match_color computes both. */
  float matrices[2][3 * VL_RAW_MAX_COLORS];
} vlRawDef;

/** A raw image: its def and width * height numbers. Its context must outlive it. */
typedef struct vlRaw vlRaw;

/** A def of 12 bits with the Bayer pattern RG/GB, black level 0, white level 4095, and no
 * metadata. */
VL_API vlRawDef vl_default_raw_def(uint32_t width, uint32_t height);
/** Writes a pattern, given as letters (R G B C M Y, W for no filter), its rows separated by
 * "/": "RG/GB", "GBRG" would be one row. Quad Bayer is "RRGG/RRGG/GGBB/GGBB", a monochrome
 * sensor "W". ARGUMENT: an unknown letter, rows of different lengths, more than 8 rows or
 * columns, more than 4 colours. */
VL_API vlResult vl_raw_set_pattern(vlRawDef *def, const char *text, vlError *error);
/** Writes the pattern in these letters. The text is shorter than 80 bytes. */
VL_API void vl_raw_pattern_text(const vlRawDef *def, char text[80]);
/** The different colours of a pattern, in ascending order. Returns their number, 1 to
 * VL_RAW_MAX_COLORS; 0: a wrong pattern. */
VL_API uint32_t vl_raw_colors(const vlRawDef *def, uint8_t colors[VL_RAW_MAX_COLORS]);

/** Writes the matrices and the neutral of a def from the sensitivities of its colours.
 *
 * `sensitivities` has VL_SPECTRUM_VALUES values for each colour: the number that radiant power
 * at a wavelength gives, in any unit that is the same for all colours (quantum efficiency times
 * wavelength). `light` has the spectrum of the light of the scene, for each nm, in any unit;
 * null: D65.
 *
 * A matrix is the best one, by least squares, for the 24 reflectances of a ColorChecker (380 to
 * 730 nm in steps of 10 nm; pbrt's, see src/color/README.md) in its illuminant, among those
 * that map white exactly. With three colours the error of XYZ is least (and the inverse is
 * stored), with others that of the camera's numbers. It is exact where the sensitivities are a
 * linear combination of the observer's (Luther's condition). A pattern of one colour has no
 * matrix: zeros. The numbers are rounded to 2^-20, which files hold exactly.
 *
 * ARGUMENT: values that are negative or not finite, a wrong def, colours that are linearly
 * dependent. */
VL_API vlResult vl_raw_match_color(vlRawDef *def, const float *sensitivities,
                                   const float *light, vlError *error);

/** Creates a raw image whose numbers are 0. Errors: ARGUMENT (a value of the def that is out of
 * its range; the message names the field), MEMORY. */
VL_API vlResult vl_raw_create(vlContext *context, const vlRawDef *def, vlRaw **raw,
                              vlError *error);
/** Null is allowed. */
VL_API void vl_raw_destroy(vlRaw *raw);
/** The def; lives as long as the raw image. */
VL_API const vlRawDef *vl_raw_def(const vlRaw *raw);
/** width * height numbers, rows from the top; live as long as the raw image. */
VL_API uint16_t *vl_raw_numbers(vlRaw *raw);
/** The same numbers, read-only. */
VL_API const uint16_t *vl_raw_const_numbers(const vlRaw *raw);

/** Writes a raw image, whole or not at all (vl_write_file). The suffix chooses the format:
 * .dng with all metadata; .tif and .tiff, the 16-bit numbers alone; .png, likewise; .exr, the
 * electrons, (number - black) / gain, in a channel Y of 32-bit floats. The same raw image gives
 * the same bytes on every machine. Errors: ARGUMENT (a number that exceeds `bits`, electrons
 * without gain, an unknown suffix), UNSUPPORTED (.dng and .tif in a velo without libtiff), IO,
 * MEMORY. */
VL_API vlResult vl_raw_write(const vlRaw *raw, const char *path, vlError *error);
/** Reads a DNG file that velo wrote. `bits` becomes the least that holds the white level and
 * all numbers. Memory is bounded by the size of the file. Errors: SCENE (a damaged file),
 * UNSUPPORTED (a DNG file that velo does not write; a velo without libtiff), MISSING, IO,
 * MEMORY. */
VL_API vlResult vl_raw_read(vlContext *context, const char *path, vlRaw **raw, vlError *error);

/** The steps of development, in their order (docs/raw.md has the formulas). */
typedef enum vlRawStep {
  VL_RAW_STEP_BLACK,    /**< (number - black) / (white - black): 1 is the white level */
  VL_RAW_STEP_WHITE,    /**< white balance: divided by the neutral, cut to at most 1 */
  VL_RAW_STEP_DEMOSAIC, /**< the colours of every pixel, by bilinear interpolation */
  VL_RAW_STEP_COLOR,    /**< linear sRGB: colour matrix, white adapted to D65 */
  VL_RAW_STEP_TONE      /**< exposure, cut to [0, 1], sRGB's curve, 16 bits */
} vlRawStep;

/** How to develop a raw image. */
typedef struct vlRawDevelopDef {
  uint32_t cookie;
  vlRawStep stop_at; /**< the last step that is done; default VL_RAW_STEP_TONE */
  float exposure;    /**< EV, added to baseline_exposure by the step of tone; default 0 */
} vlRawDevelopDef;
/** The default def. */
VL_API vlRawDevelopDef vl_default_raw_develop_def(void);
/** Develops a raw image. *image is the caller's: a mosaic in a channel Y (BLACK, WHITE); a
 * channel per colour, named by its letter (DEMOSAIC; of a pattern of one colour, Y); R, G, B,
 * or Y of a pattern of one colour (COLOR, TONE). 32-bit floats; after TONE 16-bit integers with
 * sRGB's curve. def may be null. Without a neutral, white balance does nothing. Errors:
 * ARGUMENT (a wrong def; colours without matrices), MEMORY. */
VL_API vlResult vl_raw_develop(const vlRaw *raw, const vlRawDevelopDef *def, vlImage **image,
                               vlError *error);

#ifdef __cplusplus
}
#endif
#endif
