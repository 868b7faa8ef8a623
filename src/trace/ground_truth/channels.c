/* trace/ground_truth/channels.c: the kernel tables of ground truth by instruction set, and the
 * weights that convert reflectance to albedo. */
#include "trace/ground_truth/ground_truth.h"

#include <string.h>

#include "color/color.h"
#include "trace/ground_truth/scratch.h"

size_t vl_ground_truth_scratch_size(void) {
  return sizeof(struct vlGroundTruthScratch);
}

static void plan_rgb(vlColorSpace space, vlGroundTruthDef *def) {
  float to[9], from[9];
  vl_rgb_from_xyz(space, to);
  vl_xyz_from_rgb(VL_SPACE_SRGB, from); /* in RGB mode reflectances are linear Rec.709 */
  for (int k = 0; k < 3; k++)
    for (int c = 0; c < 3; c++)
      def->weight[0][c][k] =
          space == VL_SPACE_SRGB
              ? (float)(k == c)
              : to[3 * k] * from[c] + to[3 * k + 1] * from[3 + c] + to[3 * k + 2] * from[6 + c];
}

/* Quadrature by def->sets over the visible wavelengths, or the coarse one over 400 to 700 nm
 * only, under the white of the colour space, normalised so that reflectance 1 is (1, 1, 1)
 * (pbrt book 4.6.3: the colour of a reflectance under an illuminant). */
static void plan_spectral(vlColorSpace space, vlGroundTruthDef *def) {
  float m[9];
  vl_rgb_from_xyz(space, m);
  const float *white = vl_space_illuminant(space),
              *cie[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()};
  double sum[3] = {0, 0, 0}, weight[VL_GROUND_TRUTH_SETS][4][3];
  const int sets = (int)def->sets;
  const double low = def->coarse ? 400.0 : VL_LAMBDA_MIN,
               high = def->coarse ? 700.0 : VL_LAMBDA_MAX;
  const double step = (high - low) / (4.0 * sets);
  for (int k = 0; k < sets; k++)
    for (int c = 0; c < 4; c++) {
      double xyz[3];
      def->lambda[k][c] = (float)(low + (c * sets + k + 0.5) * step);
      for (int i = 0; i < 3; i++)
        xyz[i] = (double)vl_dense_at(cie[i], def->lambda[k][c]) *
                 vl_dense_at(white, def->lambda[k][c]);
      for (int i = 0; i < 3; i++) {
        weight[k][c][i] = m[3 * i] * xyz[0] + m[3 * i + 1] * xyz[1] + m[3 * i + 2] * xyz[2];
        sum[i] += weight[k][c][i];
      }
    }
  for (int k = 0; k < sets; k++)
    for (int c = 0; c < 4; c++)
      for (int i = 0; i < 3; i++)
        def->weight[k][c][i] = (float)(weight[k][c][i] / sum[i]);
}

void vl_ground_truth_plan_albedo(const vlWorld *world, vlColorSpace space,
                                 vlGroundTruthDef *def) {
  memset(def->weight, 0, sizeof def->weight);
  bool spectral = world->def.color != VL_COLOR_RGB;
  def->sets = !def->albedo || !spectral ? 1
              : def->coarse             ? VL_GROUND_TRUTH_COARSE_SETS
                                        : VL_GROUND_TRUTH_SETS;
  for (int c = 0; c < 4; c++)
    def->lambda[0][c] = spectral ? 550.0f : 0.0f;
  if (!def->albedo)
    return;
  if (spectral)
    plan_spectral(space, def);
  else
    plan_rgb(space, def);
}
