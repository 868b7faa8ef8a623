/* image/image.h: internal interface of images for the other rooms, beyond velo/image.h: the
 * struct, rows as linear floats, reading from memory. */
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include "base/array.h"
#include "base/cancel.h"
#include "base/context.h"
#include "velo/image.h"
#include "velo/spectrum.h"

typedef struct vlImageAttribute {
  char *name;
  vlAttributeType type;
  double numbers[16];
  char *string; /* VL_ATTRIBUTE_STRING, _STRINGS only */
} vlImageAttribute;

struct vlImage {
  vlContext *context;
  uint64_t number; /* of this image in its context; from 1 */
  uint32_t width, height, channels;
  vlPixelType type;
  vlEncoding encoding;
  float gamma;
  char **names;    /* one block: `channels` pointers, then the strings */
  void *pixels;    /* interleaved, rows from the top, without padding */
  uint8_t *stored; /* vlPixelType of each channel in the file that was read; null: the image's
                      type */
  VL_ARRAY(vlImageAttribute) attributes;
};

/* Like vl_image_create. The image has no pixels (null) when `pixels` is false. */
vlResult vl_image_create_parts(vlContext *context, const vlImageDef *def, bool pixels,
                               vlImage **image);
/* Bytes per value. */
size_t vl_pixel_size(vlPixelType type);
/* Bytes per row. */
size_t vl_image_row_size(const vlImage *image);
void *vl_image_row(vlImage *image, uint32_t y);
const void *vl_image_const_row(const vlImage *image, uint32_t y);

/* Finds the colour channels, writes their indices to channel[] and returns their number: 1 for
 * Y, 2 for Y A, 3 for R G B, 4 for R G B A, 0 for an image without colour. The only channel of
 * an image counts as Y, whatever its name is. */
uint32_t vl_image_color(const vlImage *image, uint32_t channel[4]);

/* Names the chromaticities of the image's colours, as files hold them. Error: memory. */
vlResult vl_image_set_space(vlImage *image, vlColorSpace space);
/* The colour space whose chromaticities the image names, to 0.001, as in pbrt. False: it names
 * none, or an unknown one; *space stays. */
bool vl_image_space(const vlImage *image, vlColorSpace *space);

/* Whether a channel is alpha, which is always linear: it is named A or ends in .A. */
bool vl_is_alpha(const char *name);
/* Converts row y of the chosen channels to interleaved linear floats: width*count values.
 * Alpha is linear already. */
void vl_image_row_to_float(const vlImage *image, uint32_t y, const uint32_t *channel,
                           uint32_t count, float *result);
/* Converts the whole image like vl_image_row_to_float: width*height*count floats, which the
 * caller frees with vl_free. */
vlResult vl_image_to_float(const vlImage *image, const uint32_t *channel, uint32_t count,
                           float **result);

/* Adds the colour of a map over longitude and latitude at (u, v), in pixels, interpolated
 * between four of them. channels: of each pixel; of fewer than three the first is grey. */
void vl_map_add_at(const float *pixels, uint32_t width, uint32_t height, uint32_t channels,
                   double u, double v, double sum[3]);

/* Like vl_image_read, for a file that a scene names: pipes are rejected, and the context's
 * sandbox and pixel limit apply. task: of the load or the build that reads it, which stops with
 * CANCELLED; null: none. */
vlResult vl_image_read_named(vlContext *context, vlTask *task, const char *path,
                             vlImage **image, vlError *error);
/* Like vl_image_read_memory, with a task. */
vlResult vl_image_decode(vlContext *context, vlTask *task, const char *name, const void *data,
                         size_t size, vlImage **image, vlError *error);

#endif
