/* medium/nanovdb.case.c: what tests know of media of NanoVDB files. */
#include "medium/medium.case.h"

/* The voxels of test/world/nanovdb_file.h are half a unit wide, the first at (-2, -2, -2). */
static double density(const double p[3]) {
  return 0.003 * (2 * (p[0] + 2) + 10 * 2 * (p[1] + 2) + 100 * 2 * (p[2] + 2) + 1);
}

const MediumCase nanovdb_medium = {
    .shape = "\"string filename\" \"a.nvdb\" \"float scale\" .003 ",
    .scatters = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" .5",
    .absorbs = "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 0 0]",
    .density = density,
    .parameters =
        {
            {.base = "\"string filename\" \"a.nvdb\";\"float scale\" .003"},
            {.parameter = "filename", .value = "\"string filename\" \"b.nvdb\""},
            {.parameter = "gridname",
             .value = "\"string gridname\" \"density\"",
             .no_effect = "the file has one grid"},
            {.parameter = "temperaturename", .value = "\"string temperaturename\" \"density\""},
            {.parameter = "Lescale",
             .base =
                 "\"string filename\" \"a.nvdb\";\"float scale\" .003;\"string temperaturename\" "
                 "\"density\";\"float "
                 "temperaturescale\" 9"},
            {.parameter = "temperatureoffset",
             .base =
                 "\"string filename\" \"a.nvdb\";\"float scale\" .003;\"string temperaturename\" "
                 "\"density\";\"float "
                 "temperaturescale\" 9",
             .value = "\"float temperatureoffset\" 50"},
            {.parameter = "temperaturescale",
             .base =
                 "\"string filename\" \"a.nvdb\";\"float scale\" .003;\"string temperaturename\" "
                 "\"density\";\"float "
                 "temperaturescale\" 9",
             .value = "\"float temperaturescale\" 12"},
        },
};
