/* color/space.c: the colour spaces and the standard observer, from the constant tables; finds
 * spectra by name. */
#include "base/text.h"
#include "color/named.h"
#include "color/tables.h"

static const vlSpaceTable *space_table(vlColorSpace space) {
  return &vl_table_spaces[(unsigned)space < 4 ? space : VL_SPACE_SRGB];
}

const char *const vl_color_space_names[] = {[VL_SPACE_SRGB] = "srgb",
                                            [VL_SPACE_DCI_P3] = "dci-p3",
                                            [VL_SPACE_REC2020] = "rec2020",
                                            [VL_SPACE_ACES2065_1] = "aces2065-1",
                                            NULL};

/* The density at both ends of a segment, in 1 / 1000 nm; below: the integral up to its start,
 * in 1 / 1000. */
#define ROW(below, lambda, density, lambda_next, density_next)             \
  (float)((below) / 1000.0), (float)(lambda), (float)((density) / 1000.0), \
      (float)(((density_next) - (density)) / (500.0 * ((lambda_next) - (lambda))))
__attribute__((aligned(64))) const float vl_visible_knots[VL_VISIBLE_KNOTS * 4] = {
    ROW(0, 360, 0.24, 400, 0.7),      ROW(18.8, 400, 0.7, 430, 4.6),
    ROW(98.3, 430, 4.6, 470, 3.88),   ROW(267.9, 470, 3.88, 490, 2.6),
    ROW(332.7, 490, 2.6, 530, 3.75),  ROW(459.7, 530, 3.75, 560, 3.35),
    ROW(566.2, 560, 3.35, 600, 3.85), ROW(710.2, 600, 3.85, 635, 3.75),
    ROW(843.2, 635, 3.75, 680, 0.97), ROW(949.4, 680, 0.97, 720, 0.24),
    ROW(973.6, 720, 0.24, 830, 0.24), ROW(1000, 830, 0.24, 831, 0.24),
};
#undef ROW

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
  for (int i = 0; i < 9; i++)
    m[i] = (float)space_table(space)->rgb_from_xyz[i];
}
void vl_xyz_from_rgb(vlColorSpace space, float m[9]) {
  for (int i = 0; i < 9; i++)
    m[i] = (float)space_table(space)->xyz_from_rgb[i];
}
void vl_space_chromaticities(vlColorSpace space, float xy[8]) {
  for (int i = 0; i < 8; i++)
    xy[i] = (float)space_table(space)->xy[i];
}

const char *vl_named_spectrum_name(unsigned index) {
  return index < vl_table_named_count ? vl_table_named[index].name : NULL;
}

const char *vl_named_spectrum_find(const char *name, const char **near) {
  enum { MAX_NAMES = 512 };
  const char *names[MAX_NAMES];
  uint32_t count = vl_table_named_count < MAX_NAMES ? vl_table_named_count : MAX_NAMES;
  for (uint32_t i = 0; i < count; i++) {
    names[i] = vl_table_named[i].name;
    if (vl_text_is(names[i], name))
      return names[i];
  }
  *near = vl_nearest_name(name, names, count);
  return NULL;
}

const float *vl_named_spectrum(const char *name) {
  if (!name)
    return NULL;
  for (uint32_t i = 0; i < vl_table_named_count; i++) {
    if (vl_text_is(vl_table_named[i].name, name))
      return vl_table_named[i].values;
  }
  return NULL;
}
