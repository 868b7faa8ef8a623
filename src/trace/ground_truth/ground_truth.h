/* trace/ground_truth/ground_truth.h: ground truth: exact rays in, their first hits out, a batch at a time. Separate
 * from the tracers, since it may be slow and must be exact: distances are computed in double against the surface
 * itself. */
#ifndef TRACE_GROUND_TRUTH_GROUND_TRUTH_H
#define TRACE_GROUND_TRUTH_GROUND_TRUTH_H

#include "trace/trace.h"

/* Albedo: the sum over `sets` of 4 channels of reflectance times weight[set][channel][rgb]. Spectral: 64 wavelengths,
 * coarse 12; RGB mode: one set, the matrix of the colour space. */
enum { VL_TRUTH_SETS = 16, VL_ALBEDO_COARSE_SETS = 3 };
typedef struct vlGroundTruthDef {
  float pixel_spread, pixel_width; /* as in vlTraceDef */
  vlIsa isa;
  bool shading, albedo; /* what to compute: normals of shading (with bump maps), albedo */
  bool coarse;          /* albedo from fewer wavelengths */
  uint32_t sets;
  float lambda[VL_TRUTH_SETS][4];
  float weight[VL_TRUTH_SETS][4][3];
} vlGroundTruthDef;

/* Fills sets, lambda and weight; one set of weight 0 where def has no albedo. */
void vl_ground_truth_plan_albedo(const vlWorld *world, vlColorSpace space, vlGroundTruthDef *def);

/* Rays in double, d of unit length, n <= VL_BATCH; arrays of VL_ROW_SIZE. No hit: distance infinity, the rest zero. Ids
 * count from 1. */
typedef struct vlGroundTruthBatch {
  uint32_t n;
  float time; /* the world's time, of all rays */
  double o[3][VL_ROW_SIZE], d[3][VL_ROW_SIZE];
  float t_min[VL_ROW_SIZE], t_max[VL_ROW_SIZE];
  double distance[VL_ROW_SIZE];
  float n_shading[3][VL_ROW_SIZE], n_geometric[3][VL_ROW_SIZE], uv[2][VL_ROW_SIZE], albedo[3][VL_ROW_SIZE];
  uint32_t object[VL_ROW_SIZE], material[VL_ROW_SIZE], instance[VL_ROW_SIZE], primitive[VL_ROW_SIZE];
} vlGroundTruthBatch;

/* Only the ids of the first hits, for the same float rays with which the image's paths begin: arrays of VL_PAD(n).
 * distance (may be null): as float, infinity for no hit. Ids count from 1. */
typedef struct vlGroundTruthHits {
  uint32_t n;
  const float *ox, *oy, *oz, *dx, *dy, *dz, *t_min, *t_max;
  const float *time; /* the world's time; null where nothing moves */
  uint32_t *object, *material, *instance;
  float *distance;
} vlGroundTruthHits;

/* All crossings of one ray of a batch, visible or hidden; at most this many. */
enum { VL_TRUTH_LAYERS = 256 };
typedef struct vlGroundTruthLayers {
  uint32_t count;
  uint32_t object[VL_TRUTH_LAYERS], instance[VL_TRUTH_LAYERS];
} vlGroundTruthLayers;

typedef struct vlGroundTruthScratch vlGroundTruthScratch;
size_t vl_ground_truth_scratch_size(void); /* allocate 64-byte aligned, zeroed */

typedef struct vlGroundTruthKernels {
  void (*trace)(const vlWorld *world, const vlGroundTruthDef *def, vlGroundTruthScratch *scratch,
                vlGroundTruthBatch *batch);
  void (*hits)(const vlWorld *world, const vlGroundTruthDef *def, vlGroundTruthScratch *scratch,
               const vlGroundTruthHits *hits);
  /* For lane `lane` of a traced batch: the crossings from its first hit on, each surface once. */
  void (*layers)(const vlWorld *world, const vlGroundTruthBatch *batch, uint32_t lane, vlGroundTruthLayers *layers);
} vlGroundTruthKernels;
VL_KERNEL_TABLE(vlGroundTruthKernels, vl_ground_truth)

#endif
