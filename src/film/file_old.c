/* film/file_old.c: blocks of film files of formats 1 and 2. They lack the sums of the first
 * part of the samples, which films with errors have; format 2 has the means of earlier samples
 * in blocks that adaptive sampling compared. All samples of such a film become its first part.
 * So its standard errors are those of independent samples, until more samples join them. */
#include <string.h>

#include "film/file.h"

typedef struct OldMoments {
  vlInt128 plain[3];
  uint64_t squares[3][3];
  uint64_t samples;
} OldMoments;
_Static_assert(sizeof(OldMoments) == 128, "as in the files");

size_t vl_film_old_data_size(const vlFilmDef *def, uint32_t format, size_t pixels,
                             bool compared) {
  size_t each =
      vl_film_pixel_size(def) - (def->errors ? sizeof(vlFilmMoments) - sizeof(OldMoments) : 0);
  return pixels * (each + (format == 2 && compared ? VL_FILM_OLD_MEAN : 0));
}

void vl_film_convert_old_data(const vlFilmDef *def, size_t pixels, void *data) {
  if (!def->errors)
    return;
  const vlFilmPixel *pixel = data;
  char *moments = (char *)data + pixels * sizeof *pixel;
  size_t spectra = pixels * def->buckets * (sizeof(vlInt128) + sizeof(int64_t));
  memmove(moments + pixels * sizeof(vlFilmMoments), moments + pixels * sizeof(OldMoments),
          spectra);
  for (size_t i = pixels; i-- > 0;) { /* each moves to a later place, the last one first */
    OldMoments old;
    memcpy(&old, moments + i * sizeof old, sizeof old);
    vlFilmMoments made = {.samples = old.samples};
    for (int c = 0; c < 3; c++)
      made.plain[c] = old.plain[c];
    memcpy(made.squares, old.squares, sizeof made.squares);
    vl_film_join_parts(&made, &pixel[i]);
    memcpy(moments + i * sizeof made, &made, sizeof made);
  }
}
