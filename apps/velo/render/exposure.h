/* render/exposure.h: the exposure of 8-bit images: given by --exposure, or metered. */
#ifndef APP_RENDER_EXPOSURE_H
#define APP_RENDER_EXPOSURE_H

#include "cli/options.h"
#include "velo/render.h"

/* Reads --exposure: a number of stops to *ev, or "auto", which sets *meter. Returns -1, or the
 * exit code after reporting the error. */
int exposure_parse(const OptionValue *value, float *ev, bool *meter);
/* The exposure in stops, rounded to a tenth, that maps the geometric mean of a linear image's
 * luminances to 0.18. Pixels below a thousandth of the mean and pixels with alpha 0 are
 * excluded. */
float exposure_meter(const vlImage *image);
/* Meters the light that falls on a model, not its colours: renders the whole image small and
 * compares the radiance of the model's pixels (alpha > 0) with their albedo. *ev: the exposure
 * in stops, rounded to a tenth, that makes a white surface in this light bright; within `leave`
 * of 0 it becomes 0. What one sees through (glass) does not count, and a tenth of all pixels at
 * most becomes brighter than a white model. An image of which more than half would be nearly
 * white is made darker, whatever `leave` is. A model of which only surfaces are seen that emit
 * light and reflect none is made darker where they are brighter than a white model, never
 * brighter. A note says where nothing of the model is seen. scene: that of the world. Returns
 * -1, or the exit code after reporting the error. */
int exposure_meter_model(vlContext *context, const vlScene *scene, const vlWorld *world,
                         const vlCamera *camera, const vlSceneDefs *defs, double leave,
                         float *ev);
/* Whether the model's surfaces get hardly any light: a white one less than a 32nd of what it
 * has in the studio, and most of them still much less than the mean, or all of them nothing.
 * size: width and height of the image that will be rendered, by which the small one is chosen.
 * Returns -1, or the exit code after reporting the error. */
int exposure_find_unlit(vlContext *context, const vlScene *scene, const vlWorld *world,
                        const vlCamera *camera, const vlSceneDefs *defs, const uint32_t size[2],
                        bool *unlit);
/* Prints the metered exposure. */
void exposure_tell(float ev);

#endif
