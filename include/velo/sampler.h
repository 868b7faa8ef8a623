/** @file
 * velo/sampler.h: samplers: their kinds. */
#ifndef VELO_SAMPLER_H
#define VELO_SAMPLER_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(NAME, name) for each sampler. velo/schema.h has descriptions and the names in pbrt
 * files. */
#define VL_SAMPLER_KINDS(X)         \
  X(INDEPENDENT, independent)       \
  X(REGULAR, regular)               \
  X(STRATIFIED, stratified)         \
  X(NROOKS, nrooks)                 \
  X(MULTI_JITTERED, multi_jittered) \
  X(HAMMERSLEY, hammersley)         \
  X(HALTON, halton)                 \
  X(SOBOL, sobol)                   \
  X(ZSOBOL, zsobol)
/** Sample generators (src/sampler/sampler.h): those of the lecture and the
 * low-discrepancy samplers of pbrt book 8.6-8.7. */
typedef enum vlSamplerKind {
#define VL_KIND(NAME, name) VL_SAMPLER_##NAME,
  VL_SAMPLER_KINDS(VL_KIND)
#undef VL_KIND
} vlSamplerKind;

#ifdef __cplusplus
}
#endif
#endif
