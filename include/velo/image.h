/** @file
 * velo/image.h: an image with named channels and attributes, image files, display transforms
 * and comparison. */
#ifndef VELO_IMAGE_H
#define VELO_IMAGE_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The type of all values of an image: unsigned integers, half and single precision floats. */
typedef enum vlPixelType {
  VL_PIXEL_U8,
  VL_PIXEL_U16,
  VL_PIXEL_F16,
  VL_PIXEL_F32,
  VL_PIXEL_U32
} vlPixelType;

/** The encoding of integer values: linear, sRGB's curve, or x^gamma. Float values are always
 * linear. */
typedef enum vlEncoding { VL_ENCODING_LINEAR, VL_ENCODING_SRGB, VL_ENCODING_GAMMA } vlEncoding;

/** An image: interleaved channels of one type, rows from the top, no padding. Its context must
 * outlive it. */
typedef struct vlImage vlImage;

/** How to create an image. */
typedef struct vlImageDef {
  uint32_t cookie;
  uint32_t width, height;   /**< pixels */
  uint32_t channels;        /**< 1 to 1024 */
  const char *const *names; /**< `channels` strings, OpenEXR's names ("R", "Z", "N.X"); null: Y
                               | Y A | R G B | R G B A */
  vlPixelType type;         /**< default VL_PIXEL_F32 */
  vlEncoding encoding;      /**< of integers */
  float gamma;              /**< used by VL_ENCODING_GAMMA */
  bool unset; /**< its values are not set: the caller sets them all; default false */
} vlImageDef;

/** The default def for this size, in pixels, and number of channels. */
VL_API vlImageDef vl_default_image_def(uint32_t width, uint32_t height, uint32_t channels);
/** Creates an image whose values are 0, but for def.unset. ARGUMENT, MEMORY. */
VL_API vlResult vl_image_create(vlContext *context, const vlImageDef *def, vlImage **image);
/** Null is allowed. */
VL_API void vl_image_destroy(vlImage *image);

/** Pixels in a row. */
VL_API uint32_t vl_image_width(const vlImage *image);
/** Number of rows. */
VL_API uint32_t vl_image_height(const vlImage *image);
/** Number of channels. */
VL_API uint32_t vl_image_channels(const vlImage *image);
/** The type of its values. */
VL_API vlPixelType vl_image_type(const vlImage *image);
/** The encoding of its integers. */
VL_API vlEncoding vl_image_encoding(const vlImage *image);
/** Name of a channel, index from 0; lives until the channel is renamed or the image destroyed.
 * Null past the end. */
VL_API const char *vl_image_channel_name(const vlImage *image, uint32_t channel);
/** Index of the channel of this name; -1 when there is none. */
VL_API int vl_image_find_channel(const vlImage *image, const char *name);
/** width * height * channels values of the image's type, rows from the top; lives as long as
 * the image. */
VL_API void *vl_image_pixels(vlImage *image);
/** The same values, read-only. */
VL_API const void *vl_image_const_pixels(const vlImage *image);
/** Renames a channel. ARGUMENT: no such channel, an empty name, the name of another channel. */
VL_API vlResult vl_image_rename_channel(vlImage *image, uint32_t channel, const char *name);
/** One value as a linear float, whatever the type and encoding. x, y and channel must be inside
 * the image. */
VL_API float vl_image_get(const vlImage *image, uint32_t x, uint32_t y, uint32_t channel);

/** Types of attributes, those of OpenEXR headers. Number of `numbers` used: FLOAT, INT, DOUBLE
 * 1; V2F 2; V3F 3; BOX2I 4; CHROMATICITIES 8; M33F 9; M44F, M44D 16 (OpenEXR's order). */
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
  VL_ATTRIBUTE_STRINGS /**< several strings, separated by line feeds: "left\nright" */
} vlAttributeType;
/** An attribute of an image. Attributes are stored in EXR files. Of other formats PNG (as its
 * text "Comment"), JPEG and TGA (255 bytes) store the string "comments"; no reader returns it.
 */
typedef struct vlAttribute {
  const char *name;     /**< unique in an image */
  vlAttributeType type; /**< which of the following are used */
  double numbers[16];   /**< value of a numeric attribute */
  const char *string;   /**< value of STRING and STRINGS */
} vlAttribute;
/** Sets an attribute, replacing one of the same name. Copied. ARGUMENT (also what no header of
 * OpenEXR can hold: integers beyond 32 bits, a window whose end is before its beginning),
 * MEMORY. */
VL_API vlResult vl_image_set_attribute(vlImage *image, const vlAttribute *attribute);
/** Sets the attributes that another image has. Errors: ARGUMENT, MEMORY. */
VL_API vlResult vl_image_add_attributes(vlImage *image, const vlImage *from);
/** Number of attributes. */
VL_API uint32_t vl_image_attribute_count(const vlImage *image);
/** Attribute `index`, from 0. Its strings live until the attribute is set again or the image
 * destroyed. ARGUMENT: no such attribute. */
VL_API vlResult vl_image_attribute(const vlImage *image, uint32_t index,
                                   vlAttribute *attribute);
/** As vl_image_attribute, by name. */
VL_API vlResult vl_image_find_attribute(const vlImage *image, const char *name,
                                        vlAttribute *attribute);

/** Reads EXR, PNG, JPEG, HDR, PFM, TGA, BMP, GIF, PNM, QOI, WebP; the content decides, not the
 * suffix. Of an EXR file the first part is read. The image is its data window; if the display
 * window differs, both are stored as attributes ("dataWindow", "displayWindow"), which
 * vl_image_write writes back. Errors: SCENE (a damaged file), MISSING, IO, MEMORY. Memory is
 * bounded by the file: a header with more pixels than the file can hold is refused before
 * allocating. */
VL_API vlResult vl_image_read(vlContext *context, const char *path, vlImage **image,
                              vlError *error);

/** As vl_image_read, from the bytes of a file in memory; they are not kept. name: for messages.
 * The context's limit of pixels applies. */
VL_API vlResult vl_image_read_memory(vlContext *context, const char *name, const void *data,
                                     size_t size, vlImage **image, vlError *error);

/** Reads only the header: an image without pixels (vl_image_pixels is null), with channels and
 * attributes. */
VL_API vlResult vl_image_read_header(vlContext *context, const char *path, vlImage **image,
                                     vlError *error);

/** Reads only these `count` channels of an OpenEXR file (of other formats, all channels); a
 * name without its last ".Y" will do. If the channels have the same type, the image has that
 * type, so ids stay VL_PIXEL_U32. vl_image_read, in contrast, converts ids beside colours to
 * floats (exact up to 2^24). SCENE when the file lacks one of the channels. */
VL_API vlResult vl_image_read_channels(vlContext *context, const char *path,
                                       const char *const *names, uint32_t count,
                                       vlImage **image, vlError *error);
/** The type of a channel in the file that the image was read from; otherwise the image's own
 * type. */
VL_API vlPixelType vl_image_stored_type(const vlImage *image, uint32_t channel);

/** How to write an image file. */
typedef struct vlWriteDef {
  uint32_t cookie;
  bool half; /**< EXR: 16-bit floats for colour channels (ids and depths stay 32-bit); default
              * false
              */
  int compression; /**< EXR: 0 none, 1 ZIP (default). PNG: always deflate */
  int quality;     /**< JPEG: 1 to 100, default 95 */
  bool alone;      /**< single-threaded, on the calling thread: for writing while the context's
                    * workers render; default false
                    */
  const char *format; /**< a suffix that names the format, such as ".png"; default null: the
                         suffix of the path */
} vlWriteDef;
/** The default def. */
VL_API vlWriteDef vl_default_write_def(void);
/** Writes an image. The suffix selects the format: .exr .png .jpg .jpeg .hdr .pfm .tga. The
 * file is written whole or not at all (vl_write_file). 8-bit formats take VL_PIXEL_U8 images
 * unchanged and encode float images with sRGB's curve, clamped. write may be null. EXR is
 * compressed on the context's workers (not from inside a parallel body, except with `alone`);
 * its bytes do not depend on their number. Errors: ARGUMENT, IO, MEMORY. */
VL_API vlResult vl_image_write(const vlImage *image, const char *path, const vlWriteDef *write,
                               vlError *error);

/** As vl_image_write, to memory. suffix: ".png", ".exr" and so on. *data receives the bytes of
 * the file, which the caller frees with vl_release, *size their number. Errors: ARGUMENT,
 * MEMORY; *data is null then. */
VL_API vlResult vl_image_write_memory(const vlImage *image, const char *suffix,
                                      const vlWriteDef *write, void **data, size_t *size,
                                      vlError *error);

/** Writes all channels of several images of the same size to one OpenEXR file, each with its
 * image's type. Channel names must differ. Attributes are those of the first image; `half`
 * applies to the first image only. Errors as above. */
VL_API vlResult vl_image_write_layers(const vlImage *const *images, uint32_t count,
                                      const char *path, const vlWriteDef *write,
                                      vlError *error);

/** The channels of an image that displays and colour-only files show: R G B (A), or Y (A); if
 * there are none, those of the first layer with R, G and B ("diffuse.R"), else the first
 * channel as grey. Returns their number, 1 to 4. */
VL_API uint32_t vl_image_shown(const vlImage *image, uint32_t channel[4]);

/** The transform from linear to display values: sRGB's curve (STANDARD), tone mapping by
 * Khronos PBR Neutral or by AgX, or none (RAW). */
typedef enum vlView {
  VL_VIEW_STANDARD,
  VL_VIEW_KHRONOS_NEUTRAL,
  VL_VIEW_AGX,
  VL_VIEW_RAW
} vlView;
/** Makes an 8-bit sRGB image (R G B, or Y), owned by the caller, from linear Rec. 709 channels
 * R, G, B (or Y), multiplied by 2^exposure and transformed by the view. Values that are not
 * finite become 0 and are counted in *not_finite (may be null). */
VL_API vlResult vl_image_view(const vlImage *image, vlView view, float exposure,
                              uint64_t *not_finite, vlImage **result);

/** Differences of image b from the reference a, over R, G, B (or Y). */
typedef struct vlImageDiff {
  double mse, rel_mse; /**< mean squared error; relative: mean of (b-a)^2 / (a^2 + 0.01) */
  double psnr;         /**< dB, peak 1, of the linear values */
  double flip; /**< mean FLIP (Andersson et al. 2020), both images through sRGB, 67 pixels per
                  degree */
  double mean_ratio;   /**< mean luminance b / mean luminance a */
  double max_abs;      /**< greatest absolute difference */
  uint64_t differing;  /**< pixels with any different value */
  uint64_t not_finite; /**< pixels of either image with a value that is not finite; not counted
                          above */
} vlImageDiff;
/** Compares b with the reference a. ARGUMENT when the sizes differ. heat may be null; else
 * *heat is a new 8-bit image: FLIP in false colour, owned by the caller. */
VL_API vlResult vl_image_compare(const vlImage *a, const vlImage *b, vlImageDiff *diff,
                                 vlImage **heat, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
