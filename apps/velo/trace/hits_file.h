/* trace/hits_file.h: files of hits: .csv, .npy and .npz. */
#ifndef APP_TRACE_HITS_FILE_H
#define APP_TRACE_HITS_FILE_H

#include <stdio.h>

#include "velo/rays.h"

/* The results of all rays: `hits` rows for each, or `occluded`. */
typedef struct HitsFile {
  uint64_t count;
  uint32_t hits;
  vlCastHits rows;         /* all are there, unless occluded is */
  const uint8_t *occluded; /* null: hits */
} HitsFile;

/* The arrays of vlCastHits, in the order of velo.RayHits. */
typedef struct HitsField {
  const char *name, *type; /* in Python; the type's last digit: bytes of a number */
  /* numbers of a row; 0: the row is one number, without a dimension of its own */
  uint32_t columns;
  size_t offset; /* in vlCastHits */
} HitsField;
enum {
  HITS_FIELDS = 12,
  HITS_ROW = 3 * 24 + 2 * 8 + 4 * 4 + 2 * 12 + 8 + 1 /* bytes of a row in all of them */
};
extern const HitsField hits_fields[HITS_FIELDS];
/* Bytes of a field's row. */
size_t hits_field_size(const HitsField *field);
/* The field's array. */
const char *hits_field_rows(const vlCastHits *hits, const HitsField *field);

/* Writes lines below a header: a line for each hit, and one for each ray without a hit. */
void hits_write_csv(const HitsFile *h, FILE *out);
/* Writes an array of NumPy: of records with the fields of velo.RayHits, n x hits where hits is
 * above 1; or of bools. */
void hits_write_npy(const HitsFile *h, FILE *out);
/* Whether an archive can hold so many: its lengths have 32 bits. */
bool hits_fit_npz(const HitsFile *h);
/* Writes an archive of NumPy's arrays, one for each field, n or n x hits, as np.savez does it
 * (hits_npz.c). Call only where hits_fit_npz. */
void hits_write_npz(const HitsFile *h, FILE *out);

/* Room for what an array's file begins with. */
enum { HITS_NPY_START = 2048 };
/* Makes the start of a .npy file (NumPy's documentation, numpy.lib.format, version 1), filled
 * with blanks to a multiple of 64 bytes; returns its length. type: in Python's spelling. */
size_t hits_npy_start(char start[HITS_NPY_START], const char *type, const char *shape);

#endif
