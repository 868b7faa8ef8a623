/* import/pbrt/lens.h: lens parameters of the Camera directive. */
#ifndef IMPORT_PBRT_LENS_H
#define IMPORT_PBRT_LENS_H

#include "import/pbrt/builder.h"

/* What the rows of cameras leave to a rule: the pixel in focus, the shape of the aperture. */
bool vl_import_lens(vlDict *dict, vlCameraDef *def);
/* pbrt's realistic camera: lens file, aperture, focus. film_diagonal in mm. */
bool vl_import_optics(vlDict *dict, vlCameraDef *def, double film_diagonal);

#endif
