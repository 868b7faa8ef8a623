/* import/pbrt/lens.h: lens parameters of the Camera directive. */
#ifndef IMPORT_PBRT_LENS_H
#define IMPORT_PBRT_LENS_H

#include "import/pbrt/builder.h"

/* Reads the lens parameters that the rows of cameras do not describe: the pixel in focus and
 * the shape of the aperture. */
bool vl_import_lens(vlDict *dict, vlCameraDef *def);
/* Reads the parameters of pbrt's realistic camera: lens file, aperture, focus. film_diagonal is
 * in mm. */
bool vl_import_optics(vlDict *dict, vlCameraDef *def, double film_diagonal);

#endif
