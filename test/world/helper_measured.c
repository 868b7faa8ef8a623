/* test/world/helper_measured.c: writes a file in the format of the RGL material database for
 * metal with GGX microfacets (test/trace/measured_file.h). Usage: helper_measured OUT ALPHA_X
 * ALPHA_Y ETA K COLOR. eta and k are given at 400 nm and grow by the factor 1 + COLOR to 700
 * nm. */
#include "../trace/measured_file.h"

int main(int count, char **words) {
  double v[5];
  if (count != 7) {
    fprintf(stderr, "helper_measured OUT ALPHA_X ALPHA_Y ETA K COLOR\n");
    return 2;
  }
  for (int i = 0; i < 5; i++)
    v[i] = atof(words[2 + i]);
  mfSurface metal = mf_surface(v[0], v[1]);
  metal.eta = v[2];
  metal.k = v[3];
  metal.color = v[4];
  metal.nodes = 96;
  metal.lambdas = 24;
  if (metal.phis > 1) {
    metal.phis = 32;
    metal.parts = 4;
  }
  mfFile file = mf_measure(&metal);
  bool done = mf_write(words[1], &file);
  free(file.bytes);
  if (!done)
    fprintf(stderr, "helper_measured: cannot write %s\n", words[1]);
  return done ? 0 : 5;
}
