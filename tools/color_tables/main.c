/* main.c: color_tables spectra FILE.c | color_tables rgb SPACE FILE.bin: writes velo's colour
 * tables. The build runs it (CMakeLists.txt); all runs together take some seconds on one
 * core. */
#include <stdlib.h>
#include <string.h>

#include "color/rgb_table.h"
#include "tables.h"

int main(int argc, char **argv) {
  static space spaces[SPACE_COUNT];
  bool rgb = argc == 4 && strcmp(argv[1], "rgb") == 0;
  int which = rgb ? atoi(argv[2]) : 0;
  if ((!rgb && (argc != 3 || strcmp(argv[1], "spectra") != 0)) || which < 0 ||
      which >= SPACE_COUNT) {
    fprintf(stderr, "usage: color_tables spectra FILE.c | color_tables rgb SPACE FILE.bin\n");
    return 2;
  }
  make_spectra(spaces);
  const char *path = argv[argc - 1];
  FILE *file = fopen(path, "wb");
  bool good = file;
  if (file && !rgb)
    good = write_spectra(file, spaces);
  if (file && rgb) {
    size_t count = (size_t)3 * VL_RGB_TABLE_Z * VL_RGB_TABLE_XY * VL_RGB_TABLE_XY * 3;
    float *coefficients = calloc(count, sizeof *coefficients);
    if (coefficients)
      solve_space(&spaces[which], coefficients);
    good = coefficients && fwrite(coefficients, sizeof *coefficients, count, file) == count;
    free(coefficients);
  }
  if (file) {
    good = !ferror(file) && good;
    good = fclose(file) == 0 && good;
  }
  if (!good) {
    perror(path);
    remove(path);
    return 5;
  }
  return 0;
}
