/* light/lamp.h: a luminaire's intensity over directions, as lights use it, and the readers of
 * lamp files. */
#ifndef LIGHT_LAMP_H
#define LIGHT_LAMP_H

#include "base/context.h"
#include "velo/lamp.h"

/* What a file says, before its symmetry is applied. Angles are in degrees. */
typedef struct vlLampData {
  char type;               /* of photometry: 'A', 'B' or 'C' */
  uint32_t planes, angles; /* horizontal and vertical angles */
  double *horizontal;      /* `planes` ascending angles */
  double *vertical;        /* `angles` ascending angles */
  double *candela;         /* planes rows of `angles` intensities, all factors applied */
} vlLampData;

/* The intensity in coordinates about a pole: an azimuth (radians, the first from -pi to pi, the
 * last at most 2 pi later) and an angle from the pole (0 to pi). It is bilinear in them, and 0
 * outside of the table. Of type C the pole is the nadir, the azimuth is C and the polar angle
 * gamma; types A and B have other poles (lamp_table.c). */
typedef struct vlLampTable {
  uint32_t azimuths, polars; /* at least 2 each */
  float *azimuth, *polar;    /* ascending */
  float *candela;            /* azimuths rows of `polars` */
  float frame[9]; /* rows: the directions of azimuth 0, azimuth 90 degrees, and the pole, in
                     light space; orthonormal */
  float flux;     /* lm */
  /* The distribution of the flux over the cells between the angles: of columns of cells
   * (`azimuths` numbers from 0 to 1), of the cells of each column (azimuths - 1 rows of
   * `polars`), and its density in each cell, per solid angle (azimuths - 1 rows of polars -
   * 1). */
  float *columns, *below, *density;
} vlLampTable;

struct vlLamp {
  vlContext *context;
  vlLampInfo info;
  vlLampTable table;
};

/* Memory of vlLampData. */
bool vl_lamp_data_allocate(vlContext *context, vlLampData *data, uint32_t planes,
                           uint32_t angles);
void vl_lamp_data_free(vlContext *context, vlLampData *data);

/* The least step of angles in degrees, and the greatest intensity in candela, of a file. */
#define VL_LAMP_STEP 0.01
#define VL_LAMP_BRIGHTEST 1e12

struct vlLampText;
/* Checks the first and the last angles. False: the error is set. */
bool vl_lamp_check_angles(const struct vlLampText *t, const vlLampData *data);
/* Makes the table and its distribution. Errors: MEMORY. */
vlResult vl_lamp_table_make(vlLamp *lamp, const vlLampData *data, vlError *error);
void vl_lamp_table_free(vlLamp *lamp);

/* Readers: fill data (zero on entry) and the info's format, name, lamps_flux and watts. The
 * text ends with a zero byte at text[size]. Errors: SCENE with name and line, MEMORY. */
vlResult vl_lamp_read_ies(vlLamp *lamp, const char *name, const char *text, size_t size,
                          vlLampData *data, vlError *error);
vlResult vl_lamp_read_eulumdat(vlLamp *lamp, const char *name, const char *text, size_t size,
                               vlLampData *data, vlError *error);

/* vl_lamp_load. given: the caller names the file; otherwise a scene does, and the context's
 * sandbox applies. */
vlResult vl_lamp_open(vlContext *context, const char *path, bool given, vlLamp **lamp,
                      vlError *error);

#endif
