/* texture/dots.case.c: what tests know of the texture dots. */
#include "texture/texture.case.h"

/* pbrt (3rd edition, 10.5.2): of the unit cells of (s, t) around whole numbers those have a dot
 * whose noise is positive; noise moves it so far that it stays in its cell. "inside" is what is
 * between the dots, since pbrt-v4 interchanges the two. */
static void formula(const TextureAt *at, double rgb[3]) {
  static const double inside[3] = {.8, .7, .6};
  static const double outside[3] = {.1, .2, .3};
  const double radius = 0.35;
  const double s = floor(9 * at->u + 0.5);
  const double t = floor(9 * at->v + 0.5);
  const double x = s + (0.5 - radius) * at->noise(s + 1.5, t + 2.8, 0.5);
  const double y = t + (0.5 - radius) * at->noise(s + 4.5, t + 9.8, 0.5);
  const bool dot =
      at->noise(s + 0.5, t + 0.5, 0.5) > 0 && hypot(9 * at->u - x, 9 * at->v - y) < radius;
  for (int k = 0; k < 3; k++)
    rgb[k] = dot ? outside[k] : inside[k];
}

const TextureCase dots_texture = {
    .variants =
        {
            {.parameters = "\"float uscale\" 9 \"float vscale\" 9 \"rgb inside\" [.8 .7 .6] "
                           "\"rgb outside\" [.1 .2 .3]",
             .low = .1,
             .high = .8,
             .formula = formula},
        },
    .parameters =
        {{.parameter = "mapping",
          .base = "\"rgb inside\" [.9 .8 .7]",
          .value =
              "\"string mapping\" \"planar\" \"vector3 v1\" [9 0 0] \"vector3 v2\" [0 9 0]"},
         {.parameter = "v1",
          .base = "\"string mapping\" \"planar\";\"vector3 v2\" [0 9 0]",
          .value = "\"vector3 v1\" [9 0 0]"},
         {.parameter = "v2",
          .base = "\"string mapping\" \"planar\";\"vector3 v1\" [9 0 0]",
          .value = "\"vector3 v2\" [0 9 0]"},

         {.base = "\"float uscale\" 8;\"float vscale\" 8"}},
};
