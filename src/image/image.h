/* image/image.h: what other rooms may know of an image besides velo/image.h: its struct, whole rows as linear floats,
 * reading from memory. */
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include "base/array.h"
#include "base/context.h"
#include "velo/image.h"

typedef struct vlImageAttribute {
  char *name;
  vlAttributeType type;
  double numbers[16];
  char *string; /* VL_ATTRIBUTE_STRING, _STRINGS only */
} vlImageAttribute;

struct vlImage {
  vlContext *context;
  uint32_t width, height, channels;
  vlPixelType type;
  vlEncoding encoding;
  float gamma;
  char **names;    /* channels strings in one block with the pointers */
  void *pixels;    /* rows from the top, interleaved, no padding */
  uint8_t *stored; /* vlPixelType of each channel in the file it came from; null: as the image's */
  VL_ARRAY(vlImageAttribute) attributes;
};

/* As vl_image_create; the pixels are left out (null) where pixels is false. */
vlResult vl_image_create_parts(vlContext *context, const vlImageDef *def, bool pixels, vlImage **image);
/* Bytes of one value. */
size_t vl_pixel_size(vlPixelType type);
/* Bytes of one row. */
size_t vl_image_row_size(const vlImage *image);
void *vl_image_row(vlImage *image, uint32_t y);
const void *vl_image_const_row(const vlImage *image, uint32_t y);

/* Which channels are the colour: Y -> 1, Y A -> 2, R G B -> 3, R G B A -> 4 indices in channel[], that number returned.
 * An image of one channel of any name counts as Y. 0: there is no colour. */
uint32_t vl_image_color(const vlImage *image, uint32_t channel[4]);

/* Row y of the chosen channels as linear floats, interleaved: width*count values. A channel called A (or ending in .A)
 * is never put through a curve. */
void vl_image_row_to_float(const vlImage *image, uint32_t y, const uint32_t *channel, uint32_t count, float *result);
/* The whole image so; width*height*count floats, released with vl_free. */
vlResult vl_image_to_float(const vlImage *image, const uint32_t *channel, uint32_t count, float **result);

/* As vl_image_read, for a file that a scene names: no pipes, within the context's sandbox and its limit of pixels. */
vlResult vl_image_read_named(vlContext *context, const char *path, vlImage **image, vlError *error);
/* As vl_image_read_named, from a file's bytes in memory; name is used in messages. */
vlResult vl_image_read_memory(vlContext *context, const char *name, const void *data, size_t size, vlImage **image,
                              vlError *error);

#endif
