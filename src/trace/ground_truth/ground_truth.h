/* trace/ground_truth/ground_truth.h: computes the first hits of batches of exact rays, for
 * ground truth. This code is separate from the tracers because it must be exact and may be
 * slow: distances are computed in double from the surface itself. */
#ifndef TRACE_GROUND_TRUTH_GROUND_TRUTH_H
#define TRACE_GROUND_TRUTH_GROUND_TRUTH_H

#include "trace/trace.h"

/* Albedo: the sum over `sets` of 4 channels of reflectance times weight[set][channel][rgb].
 * Spectral mode has 64 wavelengths in 16 sets, or 8 in 2 sets if `coarse` is set. RGB mode has
 * one set, with the matrix of the colour space as its weights. */
enum { VL_GROUND_TRUTH_SETS = 16, VL_GROUND_TRUTH_COARSE_SETS = 2 };
typedef struct vlGroundTruthDef {
  float pixel_spread, pixel_width; /* as in vlTraceDef */
  vlIsa isa;
  bool shading, albedo; /* what to compute: shading normals (with bump maps), albedo */
  bool coarse; /* compute albedo from fewer wavelengths, distances from the rays in float, and
                  neither geometric normals nor uv, which are 0 */
  uint32_t sets;
  float lambda[VL_GROUND_TRUTH_SETS][4];
  float weight[VL_GROUND_TRUTH_SETS][4][3];
} vlGroundTruthDef;

/* Fills sets, lambda and weight of def. If def->albedo is false, there is one set with weight
 * 0. */
void vl_ground_truth_plan_albedo(const vlWorld *world, vlColorSpace space,
                                 vlGroundTruthDef *def);

/* Rays in double precision and their first hits. d has unit length, and n <= VL_BATCH. If a ray
 * hits nothing, its distance is infinite and its other results are zero. Ids count from 1. */
typedef struct vlGroundTruthBatch {
  uint32_t n;
  float time[VL_ROW_SIZE]; /* the world's time */
  double o[3][VL_ROW_SIZE], d[3][VL_ROW_SIZE];
  float t_min[VL_ROW_SIZE], t_max[VL_ROW_SIZE];
  double distance[VL_ROW_SIZE];
  float n_shading[3][VL_ROW_SIZE], n_geometric[3][VL_ROW_SIZE], uv[2][VL_ROW_SIZE],
      albedo[3][VL_ROW_SIZE];
  uint32_t object[VL_ROW_SIZE], material[VL_ROW_SIZE], instance[VL_ROW_SIZE],
      primitive[VL_ROW_SIZE];
} vlGroundTruthBatch;

/* Ids of the first hits of the same float rays with which the image's paths begin. Arrays have
 * VL_PAD(n) elements. distance may be null; it is infinite if a ray hits nothing. Ids count
 * from 1. */
typedef struct vlGroundTruthHits {
  uint32_t n;
  vlRays rays; /* time: null if nothing moves */
  uint32_t *object, *material, *instance;
  float *distance;
} vlGroundTruthHits;

/* All crossings of one ray with surfaces, visible or hidden; at most VL_GROUND_TRUTH_LAYERS. */
enum { VL_GROUND_TRUTH_LAYERS = 256 };
typedef struct vlGroundTruthLayers {
  uint32_t count;
  uint32_t object[VL_GROUND_TRUTH_LAYERS], instance[VL_GROUND_TRUTH_LAYERS];
} vlGroundTruthLayers;

typedef struct vlGroundTruthScratch vlGroundTruthScratch;
size_t vl_ground_truth_scratch_size(void); /* allocate 64-byte aligned, zeroed */

typedef struct vlGroundTruthKernels {
  void (*trace)(const vlWorld *world, const vlGroundTruthDef *def,
                vlGroundTruthScratch *scratch, vlGroundTruthBatch *batch);
  void (*hits)(const vlWorld *world, const vlGroundTruthDef *def, vlGroundTruthScratch *scratch,
               const vlGroundTruthHits *hits);
  /* Finds the crossings of lane `lane` of a traced batch, from its first hit on. Each surface
   * is listed once. */
  void (*layers)(const vlWorld *world, const vlGroundTruthBatch *batch, uint32_t lane,
                 vlGroundTruthLayers *layers);
} vlGroundTruthKernels;
VL_KERNEL_TABLE(vlGroundTruthKernels, vl_ground_truth)

#endif
