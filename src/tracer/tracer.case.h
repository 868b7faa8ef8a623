/* tracer/tracer.case.h: what the tests of tracers must know of a kind beyond its row: what a
 * tilted plate looks like below a sky, and below a ball that shines;
 * whether the tracer finds the light of a room
 * (test/conformance/transport.h). */
#ifndef TRACER_TRACER_CASE_H
#define TRACER_TRACER_CASE_H

#include <stdbool.h>
#include <stdint.h>

#include "velo/tracer.h"

/* The radiance of the plate: `even` of a sky of 1 or of the eye, and `ball` times the share of
 * the hemisphere that the ball covers. */
typedef struct Plate {
  double even, ball;
} Plate;

typedef struct TracerCase {
  Plate sky, lamp;
  Plate mirror; /* below the sky, of a smooth metal that reflects all light; 0: the tracer
                   follows no mirrors */
  uint32_t spp; /* 0: 64 */
  double least_of_lamp;  /* the least mistake that must be found of the lamp's light; 0: .03 */
  uint32_t room_spp;     /* of a room lit from its ceiling; 0: not compared */
  bool blurs;            /* by up to 2 % of the room's light */
  bool mirrors_are_free; /* those that the eye sees do not count as bounces */
} TracerCase;

/* Below a sky of 1: half of it. Below the ball: half of 4 times its share. */
#define TRANSPORT .sky = {.even = 0.5}, .lamp = {.ball = 2}
#define MIRRORS .mirror = {.even = 1}

/* Declares the case of each kind, which is in the file of the kind: tracer/NAME.case.c. */
#define TRACER_CASE(kind, name) extern const TracerCase name##_tracer;
VL_TRACER_KINDS(TRACER_CASE)
#undef TRACER_CASE

#endif
