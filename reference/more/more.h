/* more/more.h: what the core asks more/ for. Where the core's own switch over kinds ends, it calls one of these
 * functions. program/check.c refuses by name what more/ does not have either. */
#pragma once
#include "world.h"

/* What more/ takes from files of the core, beside world.h. triangle.c: the normals of meshes; the vertex normals, if
 * there are any, are blended with the vertices' weights. material.c: inputs of materials, the index of refraction of
 * glass (in RGB that of catalogues, at the yellow line of sodium), eta and k of a metal. medium.c: sigma per unit of
 * length. texture.c: the coordinates (s, t). */
square_point texture_coordinates(const vlTextureDef *def, const shade_record *at);
void mesh_normals(const placement *where, const uint32_t *vertices, const double *weights, int count, vector by_edges,
                  shade_record *record);
spectrum reflectance_at(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda);
double alpha_at(const world *w, const vlMaterialDef *m, vlFloatInput roughness, const shade_record *at);
double ior_of(const vlSpectrumInput *eta, const wavelengths *lambda);
void make_metal(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda, bsdf *b);
spectrum coefficient(const vlMediumDef *m, const vlSpectrum *sigma, const wavelengths *lambda);

/* more/patch.c: shapes with corners. The number of corners of a face is 0 for a shape that is one primitive. */
uint32_t more_corners(const vlShapeDef *def);
bool meet_more(const world *w, const primitive *p, ray r, meeting *m);
void more_surface(const world *w, const primitive *p, double a, double b, shade_record *record);

/* The point at the share t of the way from a to b. */
static inline vector mix(vector a, vector b, double t) {
  return add(scale(1 - t, a), scale(t, b));
}

/* more/curve.c */
bool meet_curve(const world *w, const primitive *p, ray r, meeting *m);
void curve_surface(const world *w, const primitive *p, double u, double v, shade_record *record);

/* more/materials.c: a material becomes a BSDF of kind BSDF_MORE; directions are local. Sampling chooses wi, and the
 * weight of a specular one; of others the core asks for value and density. */
void more_bsdf_at(const world *w, const vlMaterialDef *m, const shade_record *at, wavelengths *lambda, bsdf *b);
spectrum more_bsdf_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density);
bool sample_more_bsdf(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
/* more/coated.c, more/hair.c. Sampling finds wi; the weight only if specular. A coat draws numbers. */
spectrum coated_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density);
bool sample_coated(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
spectrum hair_value(const bsdf *b, vector wo, vector wi, double *density);
void sample_hair(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
/* more/principled.c; and coated.c: the coat alone, as glass. */
bsdf coat_of(const bsdf *b);
void make_principled(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda,
                     bsdf *b);
spectrum principled_value(const bsdf *b, vector wo, vector wi, double *density);
bool sample_principled(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
/* The path goes from wo to wi, in the world: if that is through the surface, its colour tints the path's light. */
void cross_surface(const bsdf *b, vector wo, vector wi, wavelengths *lambda);
/* more/bump.c: changes the shading normal and the tangent. Called before any BSDF is made. */
void bend_normal(const world *w, const vlMaterialDef *m, shade_record *at);

/* more/textures.c */
square_point more_coordinates(const vlTextureDef *def, const shade_record *at);
double more_number(const world *w, const vlTextureDef *def, const shade_record *at);
spectrum more_spectrum(const world *w, const vlTextureDef *def, vlParameterRole role, const shade_record *at,
                       const wavelengths *lambda);
/* more/noise.c */
double fbm(vector p, double omega, uint32_t octaves);
double turbulence(vector p, double omega, uint32_t octaves);
bool is_in_dot(square_point st);
double cloud_density(vector p, double density, double wispiness, double frequency);
void marble(vector p, double omega, uint32_t octaves, double variation, double rgb[3]);
/* A texel's scale, tint and the like. An image as one number: the channel that the texture selects, else coverage if
 * there is one, else the mean. */
void adjust_texel(const vlTextureDef *def, uint32_t channels, double value[4]);
double number_of_texel(const vlTextureDef *def, uint32_t channels, const double value[4]);

/* more/lights.c: what images of lights show in a direction, or at a point of a surface; whether a sky with a portal is
 * seen. What a light or an emission makes of its spectrum: its scale, or its power (pbrt-v4). */
spectrum shown_by_lamp(const light *l, vector direction, const wavelengths *lambda);
spectrum shown_on_surface(const light *l, const shade_record *at, const wavelengths *lambda);
bool is_through_portal(const light *l, vector from, vector direction);
void read_more_light(light *l);
double emission_factor(const world *w, const light *l);
double share_of_spread(const vlEmissionDef *def, double cosine);

/* more/media.c: what a homogeneous medium emits along a distance; media that are not the same everywhere, along a ray.
 * As in world.h. */
spectrum emission_along(const vlMediumDef *m, double distance, const wavelengths *lambda);
spectrum more_transmittance(const vlMediumDef *m, ray r, double distance, sampler *s, const wavelengths *lambda);
bool scatters_in_more(const vlMediumDef *m, ray r, double *distance, sampler *s, const wavelengths *lambda,
                      spectrum *throughput, spectrum *emitted);

/* more/motion.c: the motion of an instance; null: it is at rest. The pose of what moves at a time, as a transform from
 * where it is at its first pose. */
motion *make_motion(const vlInstanceInfo *info);
matrix world_from_rest(const motion *m, double time);
/* The ray as it would have to be if the shape were at its first pose; and back: what such a ray has found, to the time
 * of the record. Nothing changes for shapes at rest. */
ray seen_at_rest(const placement *where, ray r);
void carry_along(shade_record *record);
/* From when to when it moves. */
void times_of(const motion *m, double *first, double *last);
/* The time of one sample of a pixel; the camera's pose at a time. */
double sample_time(const vlCamera *c, uint32_t column, uint32_t row, sampler *s);
frame camera_pose(const vlCamera *c, double time);

/* more/cameras.c: a point of the projection plane without the lens's distortion, and its direction. False: the camera
 * sees nothing there. */
bool without_distortion(const vlCamera *c, double *x, double *y);
bool more_direction(const vlCamera *c, double x, double y, vector *direction);
