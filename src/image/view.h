/* image/view.h: view transforms of single colours. */
#ifndef IMAGE_VIEW_H
#define IMAGE_VIEW_H

#include "velo/image.h"

/* Display values (encoded, 0 black to 1 white) of a linear Rec. 709 colour: what vl_image_view
 * rounds to 8 bits. NaN gives 0. The arrays may be the same. */
void vl_view_display(vlView view, const float linear[3], float display[3]);

#endif
