/** @file
 * velo/image.h: an image with named channels, its attributes, files, and comparison. */
#ifndef VELO_IMAGE_H
#define VELO_IMAGE_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** One pixel type for the whole image, interleaved channels, rows from the top, no padding. */
typedef enum vlPixelType { VL_PIXEL_U8, VL_PIXEL_U16, VL_PIXEL_F16, VL_PIXEL_F32, VL_PIXEL_U32 } vlPixelType;

/** How integers stand for light: sRGB's curve, linear, or x^gamma. Floats are always linear. */
typedef enum vlEncoding { VL_ENCODING_LINEAR, VL_ENCODING_SRGB, VL_ENCODING_GAMMA } vlEncoding;

typedef struct vlImage vlImage;

typedef struct vlImageDef {
  uint32_t cookie;
  uint32_t width, height;
  uint32_t channels;        /**< 1 to 1024 */
  const char *const *names; /**< channels strings, OpenEXR's names ("R", "Z", "N.X"); null: Y | Y A | R G B | R G B A */
  vlPixelType type;
  vlEncoding encoding;
  float gamma; /**< used by VL_ENCODING_GAMMA */
} vlImageDef;

VL_API vlImageDef vl_default_image_def(uint32_t width, uint32_t height, uint32_t channels);
/** Pixels start as zero. */
VL_API vlResult vl_image_create(vlContext *context, const vlImageDef *def, vlImage **image);
VL_API void vl_image_destroy(vlImage *image);

VL_API uint32_t vl_image_width(const vlImage *image);
VL_API uint32_t vl_image_height(const vlImage *image);
VL_API uint32_t vl_image_channels(const vlImage *image);
VL_API vlPixelType vl_image_type(const vlImage *image);
VL_API vlEncoding vl_image_encoding(const vlImage *image);
VL_API const char *vl_image_channel_name(const vlImage *image, uint32_t channel);
/** -1 when there is none. */
VL_API int vl_image_find_channel(const vlImage *image, const char *name);
/** width*height*channels values of the image's type; lives as long as the image. */
VL_API void *vl_image_pixels(vlImage *image);
VL_API const void *vl_image_const_pixels(const vlImage *image);
/** Another name for a channel. ARGUMENT: no such channel, no name, the name of another one. */
VL_API vlResult vl_image_rename_channel(vlImage *image, uint32_t channel, const char *name);
/** One value as linear float, whatever the type and encoding; x, y inside the image. */
VL_API float vl_image_get(const vlImage *image, uint32_t x, uint32_t y, uint32_t channel);

/** Attributes travel to and from EXR headers (other formats drop them). A name set twice keeps the last value.
 * Numbers: count 1 (float/int), 2 (v2), 3 (v3), 4 (box), 8 (chromaticities), 9 (m33), 16 (m44, OpenEXR's order). */
typedef enum vlAttributeType {
  VL_ATTRIBUTE_FLOAT,
  VL_ATTRIBUTE_INT,
  VL_ATTRIBUTE_STRING,
  VL_ATTRIBUTE_V2F,
  VL_ATTRIBUTE_V3F,
  VL_ATTRIBUTE_M33F,
  VL_ATTRIBUTE_M44F,
  VL_ATTRIBUTE_BOX2I,
  VL_ATTRIBUTE_CHROMATICITIES,
  VL_ATTRIBUTE_DOUBLE,
  VL_ATTRIBUTE_M44D,
  VL_ATTRIBUTE_STRINGS /**< several, each ended by a line end but the last: "left\nright" */
} vlAttributeType;
typedef struct vlAttribute {
  const char *name;
  vlAttributeType type;
  double numbers[16];
  const char *string;
} vlAttribute;
VL_API vlResult vl_image_set_attribute(vlImage *image, const vlAttribute *attribute);
VL_API uint32_t vl_image_attribute_count(const vlImage *image);
/** Strings live until the attribute is set again or the image destroyed. */
VL_API vlResult vl_image_attribute(const vlImage *image, uint32_t index, vlAttribute *attribute);
VL_API vlResult vl_image_find_attribute(const vlImage *image, const char *name, vlAttribute *attribute);

/** Reads EXR, PNG, JPEG, HDR, PFM, TGA, BMP, GIF, PNM, QOI, WebP; the content decides, not the suffix. Of an EXR: the
 * first part; the image is its data window, and where that is not the display window both are attributes
 * ("dataWindow", "displayWindow"), which vl_image_write puts back. Broken files are VL_ERROR_SCENE, absent ones
 * VL_ERROR_MISSING. Memory is bounded by what the file can really hold: a header that promises more pixels than the
 * file carries is refused before allocating. */
VL_API vlResult vl_image_read(vlContext *context, const char *path, vlImage **image, vlError *error);

/** The same without its pixels: vl_image_pixels is null. Of the file no more is read than that takes. */
VL_API vlResult vl_image_read_header(vlContext *context, const char *path, vlImage **image, vlError *error);

/** Of an OpenEXR file only these channels (other formats: all). They keep a type that all of them have: so ids stay
 * VL_PIXEL_U32 beside colours that are floats, where vl_image_read makes floats of both (exact up to 2^24). SCENE when
 * the file lacks one of them. */
VL_API vlResult vl_image_read_channels(vlContext *context, const char *path, const char *const *names, uint32_t count,
                                       vlImage **image, vlError *error);
/** The type that a channel has in the file that it was read from; the image's own type otherwise. */
VL_API vlPixelType vl_image_stored_type(const vlImage *image, uint32_t channel);

typedef struct vlWriteDef {
  uint32_t cookie;
  bool half;       /**< EXR: 16-bit floats for colour channels (ids and depths stay 32-bit); default false */
  int compression; /**< EXR: 0 none, 1 ZIP (default); PNG: always deflate */
  int quality;     /**< JPEG 1..100, default 95 */
  bool alone;      /**< on the calling thread only: for writing while the context's workers render; default false */
} vlWriteDef;
VL_API vlWriteDef vl_default_write_def(void);
/** The suffix chooses the format: .exr .png .jpg .jpeg .hdr .pfm .tga. Written to a temporary file beside the target,
 * synced, renamed: the target is whole or as before. 8-bit formats take VL_PIXEL_U8 images as they are and encode
 * float ones with sRGB's curve (clamped). write may be null. EXR is packed on the context's workers (not from inside a
 * parallel body); its bytes do not depend on their number. */
VL_API vlResult vl_image_write(const vlImage *image, const char *path, const vlWriteDef *write, vlError *error);

/** One OpenEXR file of all channels of several images of the same size, each in its image's type; names must
 * differ. Attributes are the first image's; `half` touches the first image alone. */
VL_API vlResult vl_image_write_layers(const vlImage *const *images, uint32_t count, const char *path,
                                      const vlWriteDef *write, vlError *error);

/** The channels that files and displays of colours alone show of an image: R G B (A), or Y (A); without those the first
 * layer that has R, G and B ("diffuse.R"), else the first channel, as grey. How many: 1 to 4. */
VL_API uint32_t vl_image_shown(const vlImage *image, uint32_t channel[4]);

/** How a linear image becomes display values. */
typedef enum vlView { VL_VIEW_STANDARD, VL_VIEW_KHRONOS_NEUTRAL, VL_VIEW_AGX, VL_VIEW_RAW } vlView;
/** New 8-bit sRGB image (R G B, or Y) from linear Rec.709 channels R, G, B (or Y): times 2^exposure, through the view.
 * Values that are not finite become 0 and are counted in *not_finite (may be null). */
VL_API vlResult vl_image_view(const vlImage *image, vlView view, float exposure, uint64_t *not_finite,
                              vlImage **result);

/** Statistics of b against the reference a, on R, G, B (or Y); sizes must agree. */
typedef struct vlImageDiff {
  double mse, rel_mse; /**< rel: mean of (b-a)^2 / (a^2 + 0.01) */
  double psnr;         /**< dB, peak 1, of the linear values */
  double flip;         /**< mean FLIP (Andersson et al. 2020), both images through sRGB, 67 pixels per degree */
  double mean_ratio;   /**< mean luminance b / mean luminance a */
  double max_abs;
  uint64_t differing;  /**< pixels with any different value */
  uint64_t not_finite; /**< pixels of either image with a value that is not finite; left out above */
} vlImageDiff;
/** heat may be null; else a new 8-bit image: FLIP in false colour. */
VL_API vlResult vl_image_compare(const vlImage *a, const vlImage *b, vlImageDiff *diff, vlImage **heat, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
