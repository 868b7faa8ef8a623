/* medium/rgb_grid.c: media whose coefficients are colours on a grid (pbrt book 11.4). */
#include "color/color.h"
#include "medium/compile.h"

vlCompileMedium vl_compile_medium_rgb_grid;

vlResult vl_compile_medium_rgb_grid(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                                    vlError *error) {
  /* pbrt-v4 multiplies by the illuminant of the colour space, scaled to the luminance of a
   * constant spectrum of 1. */
  double sum = 0, whole = 0;
  const float *y = vl_cie_y(), *illuminant = vl_space_illuminant(def->space);
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    sum += (double)y[i] * (double)illuminant[i];
    whole += (double)y[i];
  }
  m->grey = m->scatters = true;
  m->emits = def->rgb_emission && def->emission_scale > 0;
  m->rgb_scale = def->scale;
  m->rgb_emission_scale = def->emission_scale;
  if (world->def.color == VL_COLOR_RGB)
    m->illuminant =
        (vlSpectral){.kind = VL_SPECTRAL_RGB, .scale = (float)whole, .rgb = {1, 1, 1}};
  else
    m->illuminant = (vlSpectral){
        .kind = VL_SPECTRAL_DENSE, .scale = (float)(whole / sum), .dense = illuminant};
  m->own_sigma = true;
  return vl_medium_cells(world, def, m, error);
}
