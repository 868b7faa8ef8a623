/* medium/nanovdb.case.c: what tests know of media of NanoVDB files. */
#include "medium/medium.case.h"

/* The voxels of test/world/nanovdb_file.h are half a unit wide, the first at (-2, -2, -2). */
static double density(const double p[3], PlainNoise *noise) {
  (void)noise;
  return 0.003 * (2 * (p[0] + 2) + 10 * 2 * (p[1] + 2) + 100 * 2 * (p[2] + 2) + 1);
}

/* The voxels of the file are 1/128 wide, the first, (-256, -256, -256), at (-1, -1, -1). Eight
 * blocks of 128 voxels in each direction meet at the origin, each with a density of its own;
 * the first one has eight parts. */
static double density_of_blocks(const double p[3], PlainNoise *noise) {
  (void)noise;
  const int block = (p[0] > 0) + 2 * (p[1] > 0) + 4 * (p[2] > 0);
  const int part = (p[0] > -0.25) + 2 * (p[1] > -0.25) + 4 * (p[2] > -0.25);
  return 0.25 * (block ? block + 1 : part + 2);
}

const MediumCase nanovdb_medium = {
    .shape = "\"string filename\" \"a.nvdb\" \"float scale\" .003 ",
    .scatters = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" .5",
    .absorbs = "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 0 0]",
    .density = density,
    .blocks =
        "\"string filename\" \"blocks.nvdb\" \"float scale\" .25 \"rgb sigma_a\" [1 1 1] "
        "\"rgb sigma_s\" [0 0 0]",
    .density_of_blocks = density_of_blocks,
    .parameters =
        {
            {.base = "\"string filename\" \"a.nvdb\";\"float scale\" .003"},
            {.parameter = "filename", .value = "\"string filename\" \"b.nvdb\""},
            {.parameter = "gridname",
             .value = "\"string gridname\" \"density\"",
             .no_effect = "the file has one grid"},
            {.parameter = "temperaturename", .value = "\"string temperaturename\" \"density\""},
            {.parameter = "Lescale",
             .base = "\"string filename\" \"a.nvdb\";\"float scale\" .003;"
                     "\"string temperaturename\" \"density\";\"float temperaturescale\" 9"},
            {.parameter = "temperatureoffset",
             .base = "\"string filename\" \"a.nvdb\";\"float scale\" .003;"
                     "\"string temperaturename\" \"density\";\"float temperaturescale\" 9",
             .value = "\"float temperatureoffset\" 50"},
            {.parameter = "temperaturescale",
             .base = "\"string filename\" \"a.nvdb\";\"float scale\" .003;"
                     "\"string temperaturename\" \"density\";\"float temperaturescale\" 9",
             .value = "\"float temperaturescale\" 12"},
        },
};
