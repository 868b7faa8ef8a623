/* trace/medium/rows.h: the arrays that the stages of paths through media exchange, besides
 * those of trace/rows.h. Only worlds with media or subsurface materials have memory for them.
 */
#ifndef TRACE_MEDIUM_ROWS_H
#define TRACE_MEDIUM_ROWS_H

#include "trace/rows.h"

/* What paths through media have besides vlPaths. u and l are the path's rescaled densities
 * (pbrt book 14.2.2): u for the directions as they were sampled, l as if light sampling had
 * drawn the last direction. */
typedef struct vlVolumeRows {
  VL_ROW float u[4][VL_ROW_SIZE], l[4][VL_ROW_SIZE];
  VL_ROW uint32_t medium[VL_ROW_SIZE]; /* medium at the ray's origin; VL_NONE: vacuum */
} vlVolumeRows;

/* How rays end: values of vlFlightEnds.event. */
enum { VL_ON_SURFACE, VL_IN_SKY, VL_IN_MEDIUM, VL_AT_END };
typedef struct vlFlightEnds {
  VL_ROW uint8_t event[VL_ROW_SIZE];
  VL_ROW float t[VL_ROW_SIZE];        /* distance along the ray at which a medium scatters */
  VL_ROW float odds[VL_ROW_SIZE];     /* by lane: vlFlight.odds of the path's last flight */
  VL_ROW float given[4][VL_ROW_SIZE]; /* only if paths are recorded: radiance that media added
                                         to the last flight */
} vlFlightEnds;

/* Paths that scatter in media. The rays start at the scattering points and have the direction
 * of flight; once the phase function is sampled, they are the next rays. */
typedef struct vlMediumVertices {
  vlPaths paths;
  vlVolumeRows rows;
  VL_ROW uint32_t ray[VL_ROW_SIZE]; /* the ray that arrived at the vertex */
} vlMediumVertices;

/* What shadow rays through media have besides vlShadowRays. */
typedef struct vlShadowFlights {
  VL_ROW uint32_t from[VL_ROW_SIZE]; /* the vertex from which the ray starts */
  VL_ROW uint32_t medium[VL_ROW_SIZE];
  /* densities of the light sample and of the BSDF or phase function; those of the path */
  VL_ROW float light_pdf[VL_ROW_SIZE], pdf[VL_ROW_SIZE], density[4][VL_ROW_SIZE];
  /* once the ray has passed the media: beta, u, l and odds of its flight (vlFlight) */
  VL_ROW float beta[4][VL_ROW_SIZE], u[4][VL_ROW_SIZE], l[4][VL_ROW_SIZE], odds[VL_ROW_SIZE];
  VL_ROW float passed[3][VL_ROW_SIZE]; /* vlTracing.passed at the ray's origin */
} vlShadowFlights;

typedef struct vlVolumeScratch {
  vlVolumeRows rays, at; /* of vlTraceScratch.rays and vlTraceScratch.at */
  vlFlightEnds ends;     /* of vlTraceScratch.rays */
  vlMediumVertices scattered;
  VL_ROW uint32_t kept[VL_ROW_SIZE]; /* those of `scattered` that go on */
  vlShadowFlights shadow;            /* of vlTraceScratch.shadow */
} vlVolumeScratch;

#endif
