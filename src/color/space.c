/* color/space.c: the colour spaces and the standard observer, from the constant tables. */
#include "color/tables.h"

static const vlSpaceTable *space_table(vlColorSpace space) {
  return &vl_table_spaces[(unsigned)space < 4 ? space : VL_SPACE_SRGB];
}

const vlRgbTable *vl_rgb_table(vlColorSpace space) {
  static const vlRgbTable tables[4] = {{vl_table_rgb_0}, {vl_table_rgb_1}, {vl_table_rgb_2}, {vl_table_rgb_3}};
  return &tables[(unsigned)space < 4 ? space : VL_SPACE_SRGB];
}

const float *vl_cie_x(void) {
  return vl_table_cie[0];
}
const float *vl_cie_y(void) {
  return vl_table_cie[1];
}
const float *vl_cie_z(void) {
  return vl_table_cie[2];
}
const float *vl_space_illuminant(vlColorSpace space) {
  return vl_table_named[space_table(space)->illuminant].values;
}

void vl_rgb_from_xyz(vlColorSpace space, float m[9]) {
  for (int i = 0; i < 9; i++) m[i] = (float)space_table(space)->rgb_from_xyz[i];
}
void vl_xyz_from_rgb(vlColorSpace space, float m[9]) {
  for (int i = 0; i < 9; i++) m[i] = (float)space_table(space)->xyz_from_rgb[i];
}
void vl_space_chromaticities(vlColorSpace space, float xy[8]) {
  for (int i = 0; i < 8; i++) xy[i] = (float)space_table(space)->xy[i];
}
