/* raw/files.h: the formats of raw files. */
#ifndef RAW_FILES_H
#define RAW_FILES_H

#include "raw/raw.h"

/* Writes of a raw image whose numbers were checked. Each fails with IO, MEMORY. Builds without
 * libtiff (VELO_TIFF is not defined) have none of the TIFF functions. */
vlResult vl_raw_write_dng(const vlRaw *raw, const char *path, vlError *error);
vlResult vl_raw_write_tiff(const vlRaw *raw, const char *path, vlError *error);
/* Reads a DNG file from the bytes of a file, which are not kept. Errors: SCENE, UNSUPPORTED,
 * MEMORY. */
vlResult vl_raw_read_dng(vlContext *context, const char *path, const void *data, size_t size,
                         vlRaw **raw, vlError *error);

/* Mean of the black levels of the pattern's cells. */
double vl_raw_mean_black(const vlRawDef *def);

#endif
