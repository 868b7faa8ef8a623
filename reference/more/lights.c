/* more/lights.c: the images that lights show (pbrt book 12.2, 12.3), and the brightness of lights. */
#include "more.h"
#include "octahedral.h"

/* The pixel at a point of the unit square, which starts at the image's top left corner. */
static void pixel_at_point(const light *l, square_point p, double rgb[4]) {
  pixel_of(&l->map, (long)floor(p.x * l->map.width), (long)floor(p.y * l->map.height), VL_WRAP_CLAMP, VL_WRAP_CLAMP,
           rgb);
  for (int c = 0; c < 3; c++) rgb[c] = fmax(0, rgb[c]);
}

/* Half of the size of a projected image at distance 1: the smaller side spans the angle fov. */
static square_point half_size(const light *l) {
  double t = tan((double)l->def->fov / 2), aspect = (double)l->map.width / l->map.height;
  return (square_point){t * fmax(aspect, 1), t * fmax(1 / aspect, 1)};
}

/* What a lamp shows in a direction: a goniometric light by the map of the sky, whose axis is the light's y, as one
 * number; a projection light by its image on the plane z = 1, y up. */
spectrum shown_by_lamp(const light *l, vector direction, const wavelengths *lambda) {
  vector d = normalize(transform_vector(&l->light_from_world, direction));
  double rgb[4];
  if (l->def->kind == VL_LIGHT_GONIOMETRIC) {
    pixel_at_point(l, square_of(make_vector(d.x, d.z, d.y)), rgb);
    return gray((rgb[0] + rgb[1] + rgb[2]) / 3);
  }
  square_point half = half_size(l), p = {(1 + d.x / d.z / half.x) / 2, (1 - d.y / d.z / half.y) / 2};
  if (d.z < 1e-3 || p.x < 0 || p.x > 1 || p.y < 0 || p.y > 1) return gray(0);
  pixel_at_point(l, p, rgb);
  return texel_spectrum(l->def->space, rgb, VL_PARAMETER_UNBOUNDED, lambda);
}

/* An image over (u, v), v up, linear between its pixels. */
spectrum shown_on_surface(const light *l, const shade_record *at, const wavelengths *lambda) {
  double rgb[4];
  pixels_around(&l->map, at->u, 1 - at->v, VL_WRAP_CLAMP, VL_WRAP_CLAMP, rgb);
  return texel_spectrum(VL_SPACE_SRGB, rgb, VL_PARAMETER_UNBOUNDED, lambda);
}

/* The sky shines through a rectangle only: whether a line from a point meets it, on the way out. */
bool is_through_portal(const light *l, vector from, vector direction) {
  if (!l->def->has_portal) return true;
  vector corner = from_floats(l->def->portal[0]);
  vector x = subtract(from_floats(l->def->portal[3]), corner), y = subtract(from_floats(l->def->portal[1]), corner);
  vector n = cross(x, y);
  double t = dot(n, subtract(corner, from)) / dot(n, direction);
  vector p = subtract(add(from, scale(t, direction)), corner);
  return t > 0 && dot(n, direction) > 0 && dot(p, x) >= 0 && dot(p, x) <= dot(x, x) && dot(p, y) >= 0 &&
         dot(p, y) <= dot(y, y);
}

/* The luminances of all pixels times their solid angles: the power of a lamp of factor 1. Of the sky, also times the
 * cosine: the illuminance of a surface that faces up, light space +z. */
static double light_of_image(const light *l) {
  uint32_t wide = l->map.width, high = l->map.height;
  double sum = 0;
  for (uint32_t i = 0; i < wide * high; i++) {
    square_point p = {(i % wide + 0.5) / wide, (i / wide + 0.5) / high};
    double rgb[4], solid_angle = 4 * PI / ((double)wide * high);
    pixel_at_point(l, p, rgb);
    if (l->def->kind == VL_LIGHT_INFINITE) solid_angle *= fmax(0, direction_of(p).z);
    if (l->def->kind == VL_LIGHT_PROJECTION) {
      square_point half = half_size(l);
      double distance2 = 1 + square(half.x * (2 * p.x - 1)) + square(half.y * (2 * p.y - 1));
      solid_angle = 4 * half.x * half.y / ((double)wide * high) / (distance2 * sqrt(distance2));
    }
    bool gray = l->def->kind == VL_LIGHT_GONIOMETRIC;
    sum += solid_angle * (gray ? (rgb[0] + rgb[1] + rgb[2]) / 3 : 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
  }
  return sum;
}

/* The power of a point is spread over the sphere, that of a spot over its cone, the soft edge counted half. An even sky
 * of radiance 1 has the illuminance pi. */
void read_more_light(light *l) {
  const vlLightDef *def = l->def;
  double inner = cos((double)def->cone_angle - (double)def->cone_delta), outer = cos((double)def->cone_angle);
  l->factor = (double)def->scale;
  double shown = l->map.image ? light_of_image(l) : PI;
  if (def->kind == VL_LIGHT_INFINITE && !isnan(def->illuminance)) l->factor *= def->illuminance / shown;
  if (def->kind > VL_LIGHT_INFINITE && !isnan(def->power)) l->factor *= def->power / shown;
  if (def->kind == VL_LIGHT_DISTANT && !isnan(def->illuminance)) l->factor *= def->illuminance;
  if (def->kind == VL_LIGHT_POINT && !isnan(def->power)) l->factor *= def->power / (4 * PI);
  if (def->kind == VL_LIGHT_SPOT && !isnan(def->power)) l->factor *= def->power / (2 * PI * (1 - (inner + outer) / 2));
}

/* `power` is that of each primitive: radiance times area times pi, on each side. */
double emission_factor(const world *w, const light *l) {
  const vlEmissionDef *def = l->emission;
  if (!(def->power > 0)) return (double)def->scale;
  shade_record corner = {0};
  shape_surface(w, l->what, 0, 0, &corner);
  return (double)def->scale * def->power * corner.area_density / (PI * (def->two_sided ? 2 : 1));
}

/* Slats in front of the surface let the share 1 - tan a / tan h pass at an angle a from the normal, h half of the
 * spread; divided by its mean over the hemisphere, weighted by cosines, so that the power stays. */
double share_of_spread(const vlEmissionDef *def, double cosine) {
  double half = (double)def->spread / 2;
  if (half > PI / 2 - 1e-4) return 1;
  double tangent = sqrt(fmax(0, 1 - cosine * cosine)) / cosine;
  return cosine > 0 ? fmax(0, 1 - tangent / tan(half)) / (1 - half / tan(half)) : 0;
}
