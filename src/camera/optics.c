/* camera/optics.c: a lens of many elements: checks its prescription, focuses it by the thick
 * lens approximation (pbrt book 5.4.2, 5.4.3), and finds its pupils and chief rays. */
#include "camera/optics.h"

#include <math.h>
#include <string.h>

#include "base/context.h"
#include "base/cookie.h"
#include "base/error.h"

vlOpticsDef vl_default_optics_def(void) {
  return (vlOpticsDef){.cookie = VL_COOKIE_OPTICS,
                       .aperture_diameter = VL_UNSET,
                       .focus_distance = 10.0,
                       .film_diagonal = 35.0,
                       .unit_mm = 1000.0};
}

static bool positive(double value) {
  return value > 0.0 && isfinite(value);
}

static vlResult check(const vlOpticsDef *d, const vlLensSurface *s, vlError *error) {
  if (d->count == 0 || d->count > VL_MAX_SURFACES)
    return vl_fail_argument(error, "lens: %u surfaces; there are 1 to %d", d->count,
                            VL_MAX_SURFACES);
  if (!positive(d->film_diagonal) || !positive(d->unit_mm))
    return vl_fail_argument(error, "lens: film_diagonal %g and unit_mm %g must be above zero",
                            d->film_diagonal, d->unit_mm);
  if (!(d->focus_distance > 0.0))
    return vl_fail_argument(error, "lens: focus distance is %g; it must be above zero",
                            d->focus_distance);
  if (!isnan(d->aperture_diameter) && !positive(d->aperture_diameter))
    return vl_fail_argument(error, "lens: aperture diameter is %g; it must be above zero",
                            d->aperture_diameter);
  uint32_t stops = 0;
  for (uint32_t i = 0; i < d->count; i++) {
    bool last = i + 1 == d->count;
    if (!isfinite(s[i].radius) || !positive(s[i].aperture) ||
        !(s[i].thickness >= 0.0 || last) || isinf(s[i].thickness) ||
        !(s[i].ior == 0.0 || (s[i].ior >= 1.0 && s[i].ior < 10.0)))
      return vl_fail(
          error, VL_ERROR_ARGUMENT,
          "lens: surface %u: radius %g, thickness %g, ior %g, aperture %g: the radius must "
          "be finite, the thickness 0 or above, the ior 0 (air) or 1 to 10, the aperture "
          "above 0",
          i + 1, s[i].radius, s[i].thickness, s[i].ior, s[i].aperture);
    stops += s[i].radius == 0.0;
  }
  if (stops > 1)
    return vl_fail_argument(error, "lens: %u aperture stops (radius 0); there is one", stops);
  if (stops == d->count)
    return vl_fail_argument(error, "lens: it has no refracting surface");
  if (d->aperture && stops == 0)
    return vl_fail_argument(error,
                            "lens: an aperture image needs a stop (a surface of radius 0)");
  return VL_OK;
}

/* Index of refraction on the film's side of given surface i; 1 before the first surface. */
static double index_behind(const vlOptics *o, int i) {
  double ior = i >= 0 ? o->given[i].ior : 1.0;
  if (i >= 0 && o->given[i].radius == 0.0)
    return index_behind(o, i - 1); /* a stop does not change the index */
  return ior == 0.0 ? 1.0 : ior;
}

/* Orders the surfaces from the film's side. Vertices are relative to the rear surface, which is
 * at z = 0. */
static void arrange(vlOptics *o) {
  double unit = o->def.unit_mm, z = 0.0;
  o->stop = 0;
  o->has_stop = false;
  for (uint32_t k = 0; k < o->count; k++) {
    int i = (int)(o->count - 1 - k);
    const vlLensSurface *g = &o->given[i];
    if (k > 0)
      z += g->thickness / unit;
    double opening = g->aperture;
    if (g->radius == 0.0) {
      if (o->def.aperture_diameter < opening)
        opening = o->def.aperture_diameter;
      o->stop = k;
      o->has_stop = true;
    }
    o->surfaces[k] = (vlOpticsSurface){.z = z,
                                       .radius = g->radius / unit,
                                       .aperture2 = 0.25 * opening * opening / (unit * unit),
                                       .eta = index_behind(o, i) / index_behind(o, i - 1)};
    if (!o->has_stop && o->surfaces[k].aperture2 < o->surfaces[o->stop].aperture2)
      o->stop = k;
  }
}

/* Paraxial ray transfer matrix: [a b; c d] maps height and (slope times index) at the rear
 * vertex to those behind surface `last`. */
typedef struct {
  double a, b, c, d;
} Matrix;
static Matrix paraxial(const vlOptics *o, uint32_t first, uint32_t last) {
  Matrix m = {1, 0, 0, 1};
  for (uint32_t k = first; k <= last; k++) {
    const vlOpticsSurface *s = &o->surfaces[k];
    double before = index_behind(o, (int)(o->count - 1 - k)), behind = before / s->eta;
    if (k > first) {
      double t = (s->z - o->surfaces[k - 1].z) / before;
      m = (Matrix){m.a + t * m.c, m.b + t * m.d, m.c, m.d};
    }
    if (s->radius == 0.0)
      continue;
    double power = (behind - before) / -s->radius;
    m = (Matrix){m.a, m.b, m.c - power * m.a, m.d - power * m.b};
  }
  return m;
}

/* Moves the lens so that objects at the focus distance from the film are in focus. */
static vlResult focus(vlOptics *o, vlError *error) {
  Matrix m = paraxial(o, 0, o->count - 1);
  if (!(m.c < 0.0) || !isfinite(m.c))
    return vl_fail_argument(error, "lens: it does not gather light (its focal length is %g)",
                            -1.0 / m.c);
  double f = -1.0 / m.c, length = o->surfaces[o->count - 1].z;
  /* distances from the rear vertex to the rear principal plane (for a parallel ray from the
   * scene) and to the front one (for a parallel ray from the film) */
  double rear = (1.0 - m.d) * f, front = length + (m.a - 1.0) * f, image = f;
  if (isfinite(o->def.focus_distance)) {
    /* distance from the object to the front principal plane, plus from the rear principal plane
     * to the film */
    double rest = o->def.focus_distance - (front - rear);
    if (!(rest >= 4.0 * f))
      return vl_fail_argument(
          error,
          "lens: it cannot focus at a distance of %g; the nearest for its focal "
          "length of %g is %g",
          o->def.focus_distance, f, 4.0 * f + front - rear);
    image = 0.5 * (rest - sqrt(rest * (rest - 4.0 * f)));
    /* The difference loses digits for far objects, so one Newton step for f rest = image (rest
     * - image) follows. */
    image -= (image * (rest - image) - f * rest) / (rest - 2.0 * image);
    if (!isfinite(image))
      image = 2.0 * f;
  }
  double z = image - rear;
  if (!(z > 0.0))
    return vl_fail_argument(error,
                            "lens: focused at %g its last surface would lie %g behind the film",
                            o->def.focus_distance, -z);
  for (uint32_t k = 0; k < o->count; k++)
    o->surfaces[k].z += z;
  o->rear = z;
  o->front = z + length;
  o->half = 0.5 * o->def.film_diagonal / o->def.unit_mm;
  o->info = (vlOpticsInfo){.focal_length = f,
                           .film_distance = o->rear,
                           .length = o->front,
                           .rear_principal = image,
                           .focus_distance = o->def.focus_distance,
                           .film_diagonal = 2.0 * o->half};
  if (o->has_stop && !o->def.aperture) {
    /* d is that of the part of the lens in front of the stop: a ray that is parallel to the
     * axis in front of the lens has d times its height at the stop */
    double share = paraxial(o, o->stop, o->count - 1).d;
    o->info.f_number = f / (2.0 * sqrt(o->surfaces[o->stop].aperture2) / share);
  }
  return VL_OK;
}

vlResult vl_optics_create(vlContext *context, const vlOpticsDef *def, vlOptics **optics,
                          vlError *error) {
  vl_error_clear(error);
  if (optics)
    *optics = NULL;
  if (!context || !def || !optics || !def->surfaces)
    return vl_fail_argument(error, "lens: context, def, optics or def.surfaces is null");
  if (def->cookie != VL_COOKIE_OPTICS)
    return vl_fail_argument(error, "lens: " VL_BAD_COOKIE);
  VL_TRY(check(def, def->surfaces, error));
  vlOptics *o = vl_alloc_zero(context, 1, sizeof *o);
  if (!o)
    return vl_fail_memory(error);
  o->context = context;
  o->count = def->count;
  memcpy(o->given, def->surfaces, def->count * sizeof *o->given);
  o->def = *def;
  o->def.surfaces = NULL;
  arrange(o);
  vlResult result = focus(o, error);
  if (result == VL_OK) {
    vl_optics_find_chiefs(o);
    vl_optics_find_pupils(o);
    if (!(o->pupils[0].area > 0.0))
      result = vl_fail_argument(error, "lens: no light passes it to the middle of the film");
  }
  if (result != VL_OK) {
    vl_free(context, o);
    return result;
  }
  *optics = o;
  return VL_OK;
}

vlResult vl_optics_refocus(vlContext *context, const vlOptics *optics, double focus_distance,
                           vlOptics **result, vlError *error) {
  vl_error_clear(error);
  if (!optics)
    return vl_fail_argument(error, "lens: optics is null");
  vlOpticsDef def = optics->def;
  def.surfaces = optics->given;
  def.focus_distance = focus_distance;
  return vl_optics_create(context, &def, result, error);
}

void vl_optics_destroy(vlOptics *optics) {
  if (optics)
    vl_free(optics->context, optics);
}

void vl_optics_info(const vlOptics *optics, vlOpticsInfo *info) {
  *info = optics->info;
}

void vl_optics_def(const vlOptics *optics, vlOpticsDef *def, vlLensSurface *surfaces) {
  *def = optics->def;
  memcpy(surfaces, optics->given, optics->count * sizeof *surfaces);
  def->surfaces = surfaces;
}
