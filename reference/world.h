/* world.h: the lecture's world, and all that works on it, file by file. The world is made from the scene of a file; it
 * is constant while the image is taken. */
#pragma once
#include <velo/velo.h>

#include "bsdf.h"

/* ---- world.c ----------------------------------------------------------------------------------------------------- */

/* A ray: the points origin + t direction for t between t_min and t_max; the direction has length 1. */
typedef struct ray {
  vector origin, direction;
  double t_min, t_max, time; /* time in seconds */
} ray;

typedef struct motion motion; /* of more/motion.c */

/* A shape of the scene at one place: in the world itself, or in one instance of its group. */
typedef struct placement {
  const vlShapeDef *def;
  matrix world_from_shape, shape_from_world;
  bool mesh_mirrored; /* world_from_shape mirrors: cross products of edges, taken in the world, point to the inside */
  bool flip;          /* a quadric's normals are turned over */
  motion *moves;      /* null: at rest; else the matrices are those of its first pose */
} placement;

/* What rays are tested against: a triangle, or a whole quadric. */
typedef struct primitive {
  uint32_t placement; /* in the world's list */
  uint32_t face;      /* of a mesh */
  int32_t light;      /* in the world's list of lights; -1: it emits none */
  vector corner[4];   /* of a face, in the world */
  vector low, high;   /* its box: program/accelerator.c */
} primitive;

/* The lecture's shade record: all that is known of the point where a ray meets a surface. */
typedef struct shade_record {
  double t, time;
  vector point;
  vector normal;         /* of the surface itself, on its outside */
  vector shading_normal; /* interpolated between the vertices, on the same side */
  vector tangent;        /* along u */
  double u, v;
  double area_density; /* how often sample_shape draws points here, per area */
  double a, b;         /* the point in the primitive's own two coordinates, as in a meeting */
  vector arrival;      /* the direction of the ray that met the point */
  double thickness;    /* of a curve, else 0: how far off the surface a new ray starts */
  const primitive *what;
  const placement *where; /* null: not on a surface, but inside a medium */
} shade_record;

/* An image whose pixels are looked up: a texture, or the light of the sky. */
typedef struct image_map {
  const vlImage *image;
  uint32_t width, height;
  uint32_t channels;   /* 1: grey, 2: grey and coverage, 3: colour, 4: colour and coverage */
  uint32_t channel[4]; /* which of the image's channels they are */
} image_map;

typedef struct light {
  const vlLightDef *def; /* null: a surface */
  const vlEmissionDef *emission;
  const primitive *what;
  double factor;    /* on the colour */
  image_map map;    /* the image that it shows; empty for most */
  vlSpectrum white; /* the white of the image's colour space */
  matrix world_from_light, light_from_world;
  double *sums; /* of a sky with an image: the table of make_sky; null: all directions are alike */
} light;

typedef struct node node; /* of program/accelerator.c */

typedef struct world {
  vlContext *context;
  vlScene *scene;
  bool rgb;              /* red, green and blue instead of wavelengths */
  bool media_are_absent; /* the tracer "path" looks past media */
  placement *placements;
  primitive *primitives;
  light *lights;
  image_map *images;      /* per texture; empty for kinds without an image */
  image_map *normal_maps; /* per material; empty for those without one */
  node *nodes;
  vlMaterialDef standard_material; /* of shapes without one */
  uint32_t placement_count, primitive_count, light_count;
  double radius; /* of a sphere around all surfaces */
} world;

/* Makes the world of a scene, which must outlive it. False, with an error, where an image cannot be read. */
bool make_world(vlContext *context, vlScene *scene, world *w, vlError *error);

/* ---- shape.c, triangle.c, quadric.c ------------------------------------------------------------------------------ */

/* Where a ray meets a primitive: the distance, and the point in the primitive's own two coordinates, 0 to 1. */
typedef struct meeting {
  double t, a, b;
} meeting;

/* The nearest surface along the ray, or false. Where a surface is only partly there (alpha), a lot decides.
 * program/accelerator.c asks nearest_of only for primitives whose boxes the ray meets. */
bool find_hit(const world *w, ray r, sampler *s, shade_record *hit);
/* The nearest of `count` primitives; r->t_max becomes its distance. */
bool nearest_of(const world *w, uint32_t first, uint32_t count, ray *r, sampler *s, shade_record *hit);
void shape_surface(const world *w, const primitive *p, double a, double b, shade_record *record);
/* A point of a primitive that emits light, drawn with the density record->area_density. */
void sample_shape(const world *w, const primitive *p, sampler *s, shade_record *record);
bool is_quadric(vlShapeKind kind);
bool meet_triangle(const primitive *p, ray r, meeting *m);
void triangle_surface(const world *w, const primitive *p, double b1, double b2, shade_record *record);
bool meet_quadric(const world *w, const primitive *p, ray r, meeting *m);
void quadric_surface(const world *w, const primitive *p, double u, double v, shade_record *record);

/* ---- tracer.c, camera.c ------------------------------------------------------------------------------------------ */

/* The radiance along a ray that starts in a medium (null: vacuum). A path has at most max_depth bounces. *met: whether
 * the ray met a surface. */
spectrum trace_ray(const world *w, ray r, const vlMediumDef *inside, uint32_t max_depth, sampler *s,
                   wavelengths *lambda, bool *met);
/* Where a new ray begins to count hits: rounding must not let it meet the surface that it leaves. */
double surface_distance(const world *w, vector p);
/* The ray through the point (x, y) of the image, in pixels from its top left corner, at the time r->time. False: the
 * point is outside of the camera's image circle. */
bool camera_ray(const vlCamera *c, double x, double y, sampler *s, ray *r);

/* ---- material.c, texture.c, image_map.c -------------------------------------------------------------------------- */

/* The material at the point: of a mix one of its two, by lot. */
const vlMaterialDef *material_at(const world *w, const shade_record *at, sampler *s);
/* The BSDF at the point. Glass whose index depends on the wavelength leaves the path only the first one. */
bsdf make_bsdf(const world *w, const vlMaterialDef *m, const shade_record *at, wavelengths *lambda);

/* An input of a material or shape: its texture's value at the point, else its own (pbrt book 10). */
double number_at(const world *w, vlFloatInput input, const shade_record *at);
spectrum spectrum_at(const world *w, const vlSpectrumInput *input, vlParameterRole role, const shade_record *at,
                     const wavelengths *lambda);

/* Reads the images of all textures, or that of a light. False, with an error. */
bool read_images(world *w, vlError *error);
bool read_light_image(const world *w, light *l, vlError *error);
/* The pixel at (x, y), which may lie outside: `wrap` says what is there. All four values are set, and linear: grey
 * fills the colours, a missing coverage is 1. */
void pixel_of(const image_map *map, long x, long y, vlWrap wrap_s, vlWrap wrap_t, double value[4]);
/* Linear between the four pixels around (s, t), measured from the top left corner, 0 to 1 over the image. */
void pixels_around(const image_map *map, double s, double t, vlWrap wrap_s, vlWrap wrap_t, double value[4]);

/* ---- light.c, sky.c, medium.c ------------------------------------------------------------------------------------ */

/* What a point gets from a light that was asked, if nothing is between. */
typedef struct light_sample {
  vector direction; /* from the point to the light */
  double distance;  /* infinite for the sky */
  spectrum radiance;
  double density; /* per solid angle; of one point or direction, the probability of asking it */
  bool single;    /* no ray can meet this light by chance */
} light_sample;

bool read_lights(world *w, vlError *error);
/* One sample of one light, both drawn; the density includes the choice. */
bool sample_light(const world *w, vector point, sampler *s, const wavelengths *lambda, light_sample *result);
/* Sets direction and distance from a point to a place; false if there is no way between. */
bool aim_at(vector place, vector point, light_sample *result);
/* A light's colour times its factor. */
spectrum light_color(const light *l, const wavelengths *lambda);
/* What a surface emits towards a direction, and the density with which sample_light finds it from a point. */
spectrum emitted_by_surface(const world *w, const shade_record *at, vector towards, const wavelengths *lambda);
double density_of_surface(const world *w, const shade_record *at, vector point);
/* The same for a light of the sky, which a ray from a point finds when it leaves the world. */
void make_sky(light *l);
spectrum sky_radiance(const light *l, vector from, vector direction, const wavelengths *lambda);
double sky_density(const world *w, const light *l, vector direction);
vector sample_sky(const light *l, sampler *s);

/* The medium with an id; null: vacuum. */
const vlMediumDef *medium_of(const world *w, vlMediumId id);
/* The medium that a ray enters when it goes on from a point in a direction; `now` where no surface separates media. */
const vlMediumDef *medium_beyond(const world *w, const shade_record *at, vector direction, const vlMediumDef *now);
/* The share of light that is left after a distance along the ray. */
spectrum transmittance(const vlMediumDef *m, ray r, double distance, sampler *s, const wavelengths *lambda);
/* Draws where a path along the ray scatters, before a distance; the throughput becomes what is left there, over the
 * density of the draw. False: not before `distance`. Adds what the medium emits on the way. */
bool scatters_before(const vlMediumDef *m, ray r, double *distance, sampler *s, const wavelengths *lambda,
                     spectrum *throughput, spectrum *emitted);
/* How the medium scatters light that goes on towards wo. */
bsdf phase_function(const vlMediumDef *m, vector wo);

/* ---- film.c: the lecture's view plane ---------------------------------------------------------------------------- */

typedef struct pixel {
  double sum[3], squares[3]; /* of the samples and of their squares */
  double covered;            /* samples that met a surface */
} pixel;

typedef struct view_plane {
  uint32_t width, height;
  uint32_t samples; /* per pixel */
  vlPixelFilter filter;
  observer eye;
  double exposure;
  pixel *pixels;
} view_plane;

view_plane make_view_plane(const vlSceneDefs *defs, uint32_t samples);
/* A point around the middle of a pixel, in pixels. */
square_point sample_filter(const view_plane *v, sampler *s);
/* The lecture's display_pixel, for one sample of the pixel. */
void add_sample(view_plane *v, uint32_t column, uint32_t row, spectrum radiance, const wavelengths *lambda, bool met);
/* The image: R G B A, and error.R error.G error.B, the standard errors of the means. */
bool make_image(const view_plane *v, vlContext *context, vlImage **image);
