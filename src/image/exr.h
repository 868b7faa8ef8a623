/* image/exr.h: what reading and writing OpenEXR share: error text, attributes. */
#ifndef IMAGE_EXR_H
#define IMAGE_EXR_H

#include <openexr.h>
#include <stdatomic.h>

#include "image/codec.h"

/* The user data of our OpenEXR contexts. OpenEXR prints errors unless it is given a handler; ours keeps the first. */
typedef struct vlExr {
  const vlImageFile *file; /* reading */
  vlFileWriter *writer;    /* writing */
  atomic_flag told;        /* chunks are packed by many threads */
  char message[256];
} vlExr;

void vl_exr_on_error(exr_const_context_t context, exr_result_t code, const char *message);
/* The header's attributes that vlAttribute can hold into the image, except those that describe the file's layout. */
vlResult vl_exr_attributes_in(exr_const_context_t exr, vlImage *image);
/* The other way; the layout's own (windows, aspect, screen window) by their proper setters. */
vlResult vl_exr_attributes_out(exr_context_t exr, const vlImage *image, vlError *error);

#endif
