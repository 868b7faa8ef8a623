/* trace/hits_file.h: files of hits: .csv and .npy. */
#ifndef APP_TRACE_HITS_FILE_H
#define APP_TRACE_HITS_FILE_H

#include <stdint.h>
#include <stdio.h>

#include "velo/rays.h"

/* The results of all rays: `hits` rows for each, or `occluded`. */
typedef struct HitsFile {
  uint64_t count;
  uint32_t hits;
  vlCastHits rows;         /* all are there, unless occluded is */
  const uint8_t *occluded; /* null: hits */
} HitsFile;

/* Writes lines below a header: a line for each hit, and one for each ray without a hit. */
void hits_write_csv(const HitsFile *h, FILE *out);
/* Writes an array of NumPy: of records with the fields of velo.RayHits, n x hits where hits is
 * above 1; or of bools. */
void hits_write_npy(const HitsFile *h, FILE *out);

#endif
