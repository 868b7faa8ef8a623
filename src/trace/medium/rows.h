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
  vlFloatRow u[4], l[4];
  vlUintRow medium; /* medium at the ray's origin; VL_NONE: vacuum */
} vlVolumeRows;

/* How rays end: values of vlFlightEnds.event. */
enum { VL_ON_SURFACE, VL_IN_SKY, VL_IN_MEDIUM, VL_AT_END };
typedef struct vlFlightEnds {
  VL_ROW uint8_t event[VL_ROW_SIZE];
  vlFloatRow t;        /* distance along the ray at which a medium scatters */
  vlFloatRow odds;     /* by lane: vlFlight.odds of the path's last flight */
  vlFloatRow given[4]; /* only if paths are recorded: radiance that media added to the last
                          flight */
} vlFlightEnds;

/* Paths that scatter in media. The rays start at the scattering points and have the direction
 * of flight; once the phase function is sampled, they are the next rays. */
typedef struct vlMediumVertices {
  vlPaths paths;
  vlVolumeRows rows;
  vlUintRow ray; /* the ray that arrived at the vertex */
} vlMediumVertices;

/* What shadow rays through media have besides vlShadowRays. */
typedef struct vlShadowFlights {
  vlUintRow from; /* the vertex from which the ray starts */
  vlUintRow medium;
  /* densities of the light sample and of the BSDF or phase function; those of the path */
  vlFloatRow light_pdf, pdf, density[4];
  /* once the ray has passed the media: beta, u, l and odds of its flight (vlFlight) */
  vlFloatRow beta[4], u[4], l[4], odds;
  vlFloatRow passed[3]; /* vlTracing.passed at the ray's origin */
} vlShadowFlights;

typedef struct vlVolumeScratch {
  vlVolumeRows rays, at; /* of vlTraceScratch.rays and vlTraceScratch.at */
  vlFlightEnds ends;     /* of vlTraceScratch.rays */
  vlMediumVertices scattered;
  vlUintRow kept;         /* those of `scattered` that go on */
  vlShadowFlights shadow; /* of vlTraceScratch.shadow */
} vlVolumeScratch;

#endif
