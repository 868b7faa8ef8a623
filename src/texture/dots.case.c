/* texture/dots.case.c: what tests know of the texture dots. */
#include "texture/texture.case.h"

const TextureCase dots_texture = {
    .variants =
        {
            {.parameters =
                 "\"float uscale\" 9 \"float vscale\" 9 \"rgb inside\" [.8 .7 .6] \"rgb "
                 "outside\" [.1 .2 .3]",
             .low = .1,
             .high = .8},
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
