/* image/exr.h: declarations shared by the OpenEXR reader and writer: error handling and
 * attributes. */
#ifndef IMAGE_EXR_H
#define IMAGE_EXR_H

#include <openexr.h>
#include <stdatomic.h>

#include "image/codec.h"

/* The user data of an OpenEXR context. OpenEXR prints errors unless a handler is set.
 * vl_exr_on_error is that handler; it stores the first message of a reader here. */
typedef struct vlExr {
  const vlImageFile *file; /* the file being read; null in a writer */
  vlFileWriter *writer;    /* the file being written; null in a reader */
  atomic_flag failed;      /* an error was stored; chunks are packed by several threads */
  char message[256];
} vlExr;

void vl_exr_on_error(exr_const_context_t context, exr_result_t code, const char *message);
/* Copies the header's attributes that vlAttribute can hold to the image, except those that
 * describe the file's layout. */
vlResult vl_exr_attributes_in(exr_const_context_t exr, vlImage *image);
/* Copies the image's attributes to the header. Layout attributes (windows, aspect, screen
 * window) use OpenEXR's setters. */
vlResult vl_exr_attributes_out(exr_context_t exr, const vlImage *image, vlError *error);

#endif
