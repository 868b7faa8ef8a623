/* camera/optics.h: a lens of many elements, ready for tracing. Lens space is in scene units:
 * the film is the plane z = 0, and z points forward along the lens's axis. Each function traces
 * one ray through one surface, so that single rays and batches give the same bits. */
#ifndef CAMERA_OPTICS_H
#define CAMERA_OPTICS_H

#include "camera/aperture.h"

struct vlCameraLocal; /* rays.h */
enum { VL_MAX_SURFACES = 64, VL_PUPILS = 64, VL_CHIEFS = 68 };

typedef struct vlOpticsSurface {
  double z;         /* z of the surface's vertex */
  double radius;    /* the centre of curvature is at z - radius; 0 marks the stop */
  double aperture2; /* square of the aperture radius */
  double eta; /* refractive index on the film's side divided by that on the scene's side */
} vlOpticsSurface;

/* Bounds of the exit pupil in the rear surface's plane, for film points of one ring around the
 * centre, rotated to the positive x axis. The box is x0..x1, -y1..y1. fill is the scale at
 * which the box's inscribed ellipse contains the pupil. If the box has a smaller area than that
 * ellipse, fill is 0 and the box is used. */
typedef struct vlPupil {
  double x0, x1, y1, fill;
  double area; /* area of the ellipse or box; 0: no light reaches the film ring */
} vlPupil;

/* The chief ray of a film radius. It passes through the centre of the stop and leaves the lens
 * along the line x = x0 + slope z. */
typedef struct vlChief {
  double pupil; /* x at the rear surface's plane */
  double x0, slope;
  bool valid;
} vlChief;

struct vlOptics {
  vlContext *context;
  vlLensSurface given[VL_MAX_SURFACES];
  vlOpticsDef def; /* the lens's def; its pointer to surfaces is null */
  uint32_t count;
  vlOpticsSurface surfaces[VL_MAX_SURFACES]; /* ordered from the film's side */
  uint32_t stop; /* the surface through whose centre chief rays pass */
  bool has_stop;
  double rear, front; /* z of the outermost surfaces */
  double half;        /* half of the film's diagonal */
  vlPupil pupils[VL_PUPILS];
  vlChief chiefs[VL_CHIEFS + 1]; /* chief rays at film radii chief_step * index, up to slightly
                                    beyond the corner */
  double chief_step;
  vlOpticsInfo info;
};

/* A ray in lens space; d has unit length. alive is 1, and 0 once an aperture has blocked the
 * ray. The numbers of a blocked ray are finite but meaningless. */
typedef struct vlOpticsRay {
  double x, y, z, dx, dy, dz, alive;
} vlOpticsRay;

/* Propagates the ray to the stop's plane. round: whether the stop's round aperture blocks
 * rays. */
static inline vlOpticsRay vl_optics_stop(const vlOpticsSurface *s, const int round,
                                         vlOpticsRay r) {
  double t = (s->z - r.z) / r.dz;
  r.x += t * r.dx;
  r.y += t * r.dy;
  r.z = s->z;
  int good = t >= 0.0 && (!round || r.x * r.x + r.y * r.y <= s->aperture2);
  r.alive = good ? r.alive : 0.0;
  return r;
}

/* Refracts at a sphere by Snell's law. The ray goes forwards. If the sphere's centre is ahead,
 * the ray intersects the near half of the sphere; if the centre is behind, it intersects the
 * far half. */
static inline vlOpticsRay vl_optics_refract(const vlOpticsSurface *s, const int round,
                                            vlOpticsRay r) {
  double cz = r.z - (s->z - s->radius);
  double b = r.x * r.dx + r.y * r.dy + cz * r.dz;
  double c = r.x * r.x + r.y * r.y + cz * cz - s->radius * s->radius;
  double under = b * b - c, root = __builtin_sqrt(under > 0.0 ? under : 0.0);
  double t = s->radius > 0.0 ? root - b : -root - b;
  r.x += t * r.dx;
  r.y += t * r.dy;
  r.z += t * r.dz;
  double inv = -1.0 / s->radius; /* the normal is oriented against the ray's direction */
  double nx = r.x * inv, ny = r.y * inv, nz = (r.z - (s->z - s->radius)) * inv;
  double cosine = -(nx * r.dx + ny * r.dy + nz * r.dz);
  double rest = 1.0 - s->eta * s->eta * (1.0 - cosine * cosine);
  double k = s->eta * cosine - __builtin_sqrt(rest > 0.0 ? rest : 0.0);
  r.dx = s->eta * r.dx + k * nx;
  r.dy = s->eta * r.dy + k * ny;
  r.dz = s->eta * r.dz + k * nz;
  int good = under > 0.0 && t >= 0.0 && rest > 0.0 &&
             (!round || r.x * r.x + r.y * r.y <= s->aperture2);
  r.alive = good ? r.alive : 0.0;
  return r;
}

/* Returns the ray from the film point (x, y) to a point in the rear surface's plane. */
static inline vlOpticsRay vl_optics_start(double x, double y, double px, double py,
                                          double rear) {
  double dx = px - x, dy = py - y, inv = 1.0 / __builtin_sqrt(dx * dx + dy * dy + rear * rear);
  return (vlOpticsRay){x, y, 0.0, dx * inv, dy * inv, rear * inv, 1.0};
}

/* Rays whose dz is below this are discarded, because their origin is moved along the ray to the
 * film's plane. */
static const double vl_optics_grazing = 1e-3;

/* Fills pupils and chiefs. Defined in optics_find.c. */
void vl_optics_find_pupils(vlOptics *optics);
void vl_optics_find_chiefs(vlOptics *optics);
/* Computes the chief ray of a film point, in camera space, with its origin in the film's plane.
 * Returns false if there is none. x, y: the film point in scene units from the centre, right
 * and down as in the image (the physical film is rotated by 180 degrees). Defined in
 * optics_points.c. */
bool vl_optics_unproject(const vlOptics *optics, double x, double y, struct vlCameraLocal *ray);
/* The inverse of vl_optics_unproject: maps a point in camera space to the film point. */
bool vl_optics_project(const vlOptics *optics, double x, double y, double z, double film[2]);
/* Finds the chief ray of a film radius. guess: start value of x in the pupil's plane. Returns
 * false if the ray misses a surface. */
bool vl_optics_chief(const vlOptics *optics, double radius, double guess, vlChief *chief);
/* The same with a start value from the table of chief rays. Defined in optics_points.c. */
bool vl_optics_chief_at(const vlOptics *optics, double radius, vlChief *chief);
/* The same, and the derivatives of the chief ray's x0 and slope by the film radius. Defined in
 * optics_derive.c. */
bool vl_optics_chief_derivatives(const vlOptics *optics, double radius, vlChief *chief,
                                 double *x0_by_radius, double *slope_by_radius);

#endif
