/** @file
 * velo/sampler.h: samplers: their kinds. */
#ifndef VELO_SAMPLER_H
#define VELO_SAMPLER_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(kind, name) for each sampler. velo/schema.h has descriptions and the names in pbrt
 * files. */
#define VL_SAMPLER_KINDS(X)                    \
  X(VL_SAMPLER_INDEPENDENT, independent)       \
  X(VL_SAMPLER_REGULAR, regular)               \
  X(VL_SAMPLER_STRATIFIED, stratified)         \
  X(VL_SAMPLER_NROOKS, nrooks)                 \
  X(VL_SAMPLER_MULTI_JITTERED, multi_jittered) \
  X(VL_SAMPLER_HAMMERSLEY, hammersley)         \
  X(VL_SAMPLER_HALTON, halton)                 \
  X(VL_SAMPLER_SOBOL, sobol)                   \
  X(VL_SAMPLER_ZSOBOL, zsobol)
/** Sample generators (src/sampler/sampler.h): those of the lecture and the
 * low-discrepancy samplers of pbrt book 8.6-8.7. */
typedef enum vlSamplerKind {
#define VL_KIND(kind, name) kind,
  VL_SAMPLER_KINDS(VL_KIND)
#undef VL_KIND
} vlSamplerKind;

#ifdef __cplusplus
}
#endif
#endif
