/* texture/marble.case.c: what tests know of the texture marble. */
#include "texture/texture.case.h"

/* pbrt (3rd edition, 10.6.6): a sine along y, which noise moves, goes through nine colours: of
 * the six Bezier curves of four successive ones, one and a half times the colour. */
static void marble_of(const TextureAt *at, double scale, double rgb[3]) {
  static const double colors[9][3] = {{.58, .58, .6}, {.58, .58, .6}, {.58, .58, .6},
                                      {.5, .5, .5},   {.6, .59, .58}, {.58, .58, .6},
                                      {.58, .58, .6}, {.2, .2, .33},  {.58, .58, .6}};
  const double p[3] = {scale * at->p[0], scale * at->p[1], scale * at->p[2]};
  const double width = fabs(scale) * at->width;
  const double vein = p[1] + 0.4 * plain_fractal(at->noise, p, width, 0.5, 8);
  const double along = 6 * (0.5 + 0.5 * sin(vein));
  const int first = along < 5 ? (int)along : 5;
  const double t = along - first;
  const double r = 1 - t;
  for (int k = 0; k < 3; k++)
    rgb[k] = 1.5 * (r * r * r * colors[first][k] + 3 * r * r * t * colors[first + 1][k] +
                    3 * r * t * t * colors[first + 2][k] + t * t * t * colors[first + 3][k]);
}

static void formula(const TextureAt *at, double rgb[3]) {
  marble_of(at, 3, rgb);
}

static void mirrored_formula(const TextureAt *at, double rgb[3]) {
  marble_of(at, -3, rgb);
}

const TextureCase marble_texture = {
    .variants =
        {
            {.parameters = "\"float scale\" 3 \"float variation\" .4",
             .high = 1,
             .formula = formula,
             .of_space = true},
            {.parameters = "\"float scale\" -3 \"float variation\" .4",
             .high = 1,
             .formula = mirrored_formula,
             .of_space = true},
        },
};
