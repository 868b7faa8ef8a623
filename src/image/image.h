/* image/image.h: what other rooms may use of an image beyond velo/image.h: its struct, rows as linear floats, reading
 * from memory. */
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
  char **names;    /* one block: `channels` pointers, then the strings */
  void *pixels;    /* interleaved, rows from the top, without padding */
  uint8_t *stored; /* vlPixelType of each channel in the file it came from; null: as the image's type */
  VL_ARRAY(vlImageAttribute) attributes;
};

/* As vl_image_create; without pixels (null) when `pixels` is false. */
vlResult vl_image_create_parts(vlContext *context, const vlImageDef *def, bool pixels, vlImage **image);
/* Bytes per value. */
size_t vl_pixel_size(vlPixelType type);
/* Bytes per row. */
size_t vl_image_row_size(const vlImage *image);
void *vl_image_row(vlImage *image, uint32_t y);
const void *vl_image_const_row(const vlImage *image, uint32_t y);

/* The colour channels: Y -> 1, Y A -> 2, R G B -> 3, R G B A -> 4 indices in channel[]; returns their number. The only
 * channel of an image counts as Y whatever its name. 0: no colour. */
uint32_t vl_image_color(const vlImage *image, uint32_t channel[4]);

/* Row y of the chosen channels as linear floats, interleaved: width*count values. A channel called A (or ending in .A)
 * is already linear. */
void vl_image_row_to_float(const vlImage *image, uint32_t y, const uint32_t *channel, uint32_t count, float *result);
/* The same for the whole image: width*height*count floats, freed with vl_free. */
vlResult vl_image_to_float(const vlImage *image, const uint32_t *channel, uint32_t count, float **result);

/* As vl_image_read for a file that a scene names: no pipes; the context's sandbox and its limit of pixels apply. */
vlResult vl_image_read_named(vlContext *context, const char *path, vlImage **image, vlError *error);
/* As vl_image_read_named from the bytes of a file; name is used in messages. */
vlResult vl_image_read_memory(vlContext *context, const char *name, const void *data, size_t size, vlImage **image,
                              vlError *error);

#endif
