/* camera/optics.h: a lens of many elements, ready to be traced. Its space: the film is the plane z = 0, the axis is z,
 * forwards; scene units. One surface at a time, by value, so that single rays and batches give the same bits. */
#ifndef CAMERA_OPTICS_H
#define CAMERA_OPTICS_H

#include "camera/aperture.h"
#include "camera/local.h"

enum { VL_MOST_SURFACES = 64, VL_PUPILS = 64, VL_CHIEFS = 68 };

typedef struct vlOpticsSurface {
  double z;         /* of the vertex */
  double radius;    /* its centre of curvature is at z - radius; 0: the stop */
  double aperture2; /* square of the opening's radius */
  double eta;       /* index before the surface (film's side) over the one behind it */
} vlOpticsSurface;

/* What the rear surface's plane shows of the exit pupil from a ring of the film, for a film point on the positive x
 * axis: x0..x1, -y1..y1. fill: the ellipse in this box, so scaled, holds it all; 0: the box is smaller. */
typedef struct vlPupil {
  double x0, x1, y1, fill;
  double area; /* of ellipse or box; 0: no light comes here */
} vlPupil;

/* The ray from a film radius through the middle of the stop, and where it leaves: at x0 + slope z, in its plane. */
typedef struct vlChief {
  double pupil; /* x where it meets the rear surface's plane */
  double x0, slope;
  bool valid;
} vlChief;

struct vlOptics {
  vlContext *context;
  vlLensSurface given[VL_MOST_SURFACES];
  vlOpticsDef def; /* surfaces: null */
  uint32_t count;
  vlOpticsSurface surfaces[VL_MOST_SURFACES]; /* from the film's side */
  uint32_t stop;                              /* the surface through whose middle chief rays go */
  bool has_stop;
  double rear, front; /* z of the outer surfaces */
  double half;        /* of the film's diagonal */
  vlPupil pupils[VL_PUPILS];
  vlChief chiefs[VL_CHIEFS + 1]; /* at film radii chief_step * index: a little beyond the corner */
  double chief_step;
  vlOpticsInfo info;
};

/* d of unit length. alive: 1, or 0 once an opening has stopped it; it goes on as some ray then. */
typedef struct vlOpticsRay {
  double x, y, z, dx, dy, dz, alive;
} vlOpticsRay;

/* To the stop's plane. round: its opening counts. */
static inline vlOpticsRay vl_optics_stop(const vlOpticsSurface *s, const int round, vlOpticsRay r) {
  double t = (s->z - r.z) / r.dz;
  r.x += t * r.dx;
  r.y += t * r.dy;
  r.z = s->z;
  int good = t >= 0.0 && (!round || r.x * r.x + r.y * r.y <= s->aperture2);
  r.alive = good ? r.alive : 0.0;
  return r;
}

/* Through a sphere, by Snell's law. The ray goes forwards: it meets the near half of a sphere whose centre lies ahead,
 * the far half of one whose centre lies behind. */
static inline vlOpticsRay vl_optics_refract(const vlOpticsSurface *s, const int round, vlOpticsRay r) {
  double cz = r.z - (s->z - s->radius);
  double b = r.x * r.dx + r.y * r.dy + cz * r.dz;
  double c = r.x * r.x + r.y * r.y + cz * cz - s->radius * s->radius;
  double under = b * b - c, root = __builtin_sqrt(under > 0.0 ? under : 0.0);
  double t = s->radius > 0.0 ? root - b : -root - b;
  r.x += t * r.dx;
  r.y += t * r.dy;
  r.z += t * r.dz;
  double inv = -1.0 / s->radius; /* the normal looks back at the ray */
  double nx = r.x * inv, ny = r.y * inv, nz = (r.z - (s->z - s->radius)) * inv;
  double cosine = -(nx * r.dx + ny * r.dy + nz * r.dz);
  double rest = 1.0 - s->eta * s->eta * (1.0 - cosine * cosine);
  double k = s->eta * cosine - __builtin_sqrt(rest > 0.0 ? rest : 0.0);
  r.dx = s->eta * r.dx + k * nx;
  r.dy = s->eta * r.dy + k * ny;
  r.dz = s->eta * r.dz + k * nz;
  int good = under > 0.0 && t >= 0.0 && rest > 0.0 && (!round || r.x * r.x + r.y * r.y <= s->aperture2);
  r.alive = good ? r.alive : 0.0;
  return r;
}

/* From the film point to the point of the rear surface's plane. */
static inline vlOpticsRay vl_optics_start(double x, double y, double px, double py, double rear) {
  double dx = px - x, dy = py - y, inv = 1.0 / __builtin_sqrt(dx * dx + dy * dy + rear * rear);
  return (vlOpticsRay){x, y, 0.0, dx * inv, dy * inv, rear * inv, 1.0};
}

/* Less than this forwards and a ray does not count: its start is told in the film's plane. */
static const double vl_optics_grazing = 1e-3;

/* optics_find.c: fills pupils and chiefs. */
void vl_optics_find_pupils(vlOptics *optics);
void vl_optics_find_chiefs(vlOptics *optics);
/* optics_points.c. x, y: a point of the film as the image shows it, scene units from its middle (right and down; on
 * the film itself it lies opposite). The chief ray in camera space, its start in the film's plane; false where there is
 * none. */
bool vl_optics_unproject(const vlOptics *optics, double x, double y, vlCameraLocal *ray);
/* The other way, a point in camera space. */
bool vl_optics_project(const vlOptics *optics, double x, double y, double z, double film[2]);
/* The first chief ray's trace: x at the stop of the ray from film radius r through the pupil's point p; false: it
 * misses a surface. */
bool vl_optics_chief(const vlOptics *optics, double radius, double guess, vlChief *chief);

#endif
