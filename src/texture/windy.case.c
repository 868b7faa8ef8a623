/* texture/windy.case.c: what tests know of the texture windy. */
#include "texture/texture.case.h"

/* pbrt (3rd edition, 10.6.5): waves of six octaves, as high as the wind is strong, which three
 * octaves of a tenth of the frequency give, without their sign. */
static void formula(const TextureAt *at, double rgb[3]) {
  const double slow[3] = {0.1 * at->p[0], 0.1 * at->p[1], 0.1 * at->p[2]};
  const double wind = plain_fractal(at->noise, slow, 0.1 * at->width, 0.5, 3);
  const double waves = plain_fractal(at->noise, at->p, at->width, 0.5, 6);
  rgb[0] = rgb[1] = rgb[2] = fabs(wind) * waves;
}

const TextureCase windy_texture = {
    .variants =
        {
            {.parameters = "",
             .high = 1,
             .known = {{.5, .5, {0, 0, 0}}},
             .formula = formula,
             .of_space = true},
        },
};
