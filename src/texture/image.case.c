/* texture/image.case.c: what tests know of the texture image. */
#include "texture/texture.case.h"

const TextureCase image_texture = {
    .variants =
        {
            {.parameters = "\"string filename\" \"quarters.pfm\"",
             .low = .2,
             .high = .8,
             .known = {{.25, .25, {.6, .6, .6}},
                       {.75, .25, {.8, .8, .8}},
                       {.25, .75, {.2, .2, .2}},
                       {.75, .75, {.4, .4, .4}}}},
            {.parameters = "\"string filename\" \"quarters.pfm\" \"bool invert\" true "
                           "\"float scale\" .5 \"string filter\" \"point\"",
             .low = .6,
             .high = .9,
             .known = {{.25, .25, {.7, .7, .7}}, {.75, .75, {.8, .8, .8}}}},
            {.parameters = "\"string filename\" \"grain.pfm\" \"string filter\" \"trilinear\" "
                           "\"float uscale\" 2 \"float vscale\" .7",
             .high = 1,
             .filtered = true},
            /* many of its footprints lie across its edges */
            {.parameters = "\"string filename\" \"grain.pfm\" \"string filter\" \"trilinear\" "
                           "\"float uscale\" 20 \"float vscale\" 20 \"float udelta\" -9.5 "
                           "\"float vdelta\" -9.5 \"string wrap\" \"black\"",
             .high = 1,
             .filtered = true},
            /* its bytes by two curves */
            {.parameters = "\"string filename\" \"a.tga\" \"string encoding\" \"linear\"",
             .high = 1,
             .known = {{.3125, .5625, {.93725, .75294, .47059}},
                       {.6875, .1875, {.86667, .65490, .92941}}}},
            {.parameters = "\"string filename\" \"a.tga\" \"string encoding\" \"gamma 3\"",
             .high = 1,
             .known = {{.3125, .5625, {.82333, .42686, .10421}},
                       {.6875, .1875, {.65096, .28089, .80283}}}},
            /* writers of pbrt's files decode what has no name that says its format */
            {.parameters =
                 "\"string filename\" \"normals.img\" \"string encoding\" \"gamma 3\"",
             .high = 1},
            {.parameters =
                 "\"string filename\" \"normals.img\" \"string encoding\" \"gamma 2\"",
             .high = 1},
        },
    .parameters =
        {{.base = "\"string filename\" \"a.pfm\""},
         {.parameter = "filename", .value = "\"string filename\" \"b.pfm\""},
         {.parameter = "encoding",
          .base = "\"string filename\" \"a.tga\"",
          .value = "\"string encoding\" \"linear\""},
         {.parameter = "maxanisotropy", .no_effect = "ignored"},
         {.parameter = "wrap",
          .base = "\"string filename\" \"a.pfm\";\"float uscale\" 3.3;\"float vscale\" 2.7"},
         {.parameter = "mapping",
          .base = "\"string filename\" \"a.pfm\"",
          .value = "\"string mapping\" \"spherical\""},
         {.parameter = "v1",
          .base = "\"string mapping\" \"planar\";\"string filename\" \"a.pfm\""},
         {.parameter = "v2",
          .base = "\"string mapping\" \"planar\";\"string filename\" \"a.pfm\""}},
};
