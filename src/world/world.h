/* world/world.h: the compiled world: flat, constant, index-based. Built from a scene (build.c), read by trace. Nothing
 * here changes while rendering.
 *
 * A surface point is named by (shape, prim, instance): shape indexes world->shapes, prim the face in it, instance
 * world->instances or VL_NONE. Shapes of the world itself hold world-space vertices; shapes of groups hold group space.
 */
#ifndef WORLD_WORLD_H
#define WORLD_WORLD_H

#include "base/array.h"
#include "color/color.h"
#include "velo/render.h"
#include "world/accel/accel.h"
#include "world/material/coat.h"
#include "world/material/measured.h"
#include "world/medium/medium.h"
#include "world/texture/texture.h"

/* ---- shapes ------------------------------------------------------------------------------------------------------ */

typedef struct vlWorldShape {
  vlShapeKind kind;
  uint32_t material;    /* index into materials */
  uint32_t first_light; /* VL_NONE: no light; else see vl_shape_light */
  int32_t alpha;        /* texture node, -1: opaque */
  bool flip;        /* reverse orientation xor the shape's own transform mirrors: turns a triangle's or patch's normal
                     * of face order in group space, and a quadric's or curve's dpdu x dpdv of shape space */
  bool pass_shadow; /* interface material: shadow rays pass */
  uint32_t inside,
      outside; /* media on both sides (the geometric normal's is outside), VL_NONE: vacuum; equal: no change */
  /* triangles (3 indices a face) and bilinear patches (4): positions end in 16 spare bytes for Embree */
  uint32_t vertices, faces;
  float *positions, *normals, *tangents, *uvs;
  uint32_t *indices;
  /* Triangles, may be null: bitangent = sign n x tangent; uv sets 1 to 3; 4 a vertex; uvs of the emission's image */
  float *tangent_signs, *more_uvs[3], *colors, *emission_uvs;
  uint32_t *light_of; /* by prim, VL_NONE: none; null: prim i is light first_light + i */
  bool one_sided;     /* rays pass through from behind */
  uint32_t steps;     /* of positions and normals, one set after the other, evenly over the world's time; 1: at rest */
  /* sphere, disk, cylinder: parameters as in vlShapeDef, and the affine maps, row-major 3x4 */
  float radius, inner_radius, z_min, z_max, phi_max, height;
  double *centers; /* many spheres: 3 a prim, shape space, and */
  float *radii;    /* 1 a prim; else null */
  /* curves: 4 points and 2 widths a segment, ribbons 2 normals, all in shape space; a prim is a piece of a segment */
  vlCurveKind curve;
  uint32_t split; /* faces = segments << split */
  float *widths;
  double from_shape[12], to_shape[12]; /* group space <-> shape space */
} vlWorldShape;

/* The light that a prim is, or VL_NONE. */
static inline uint32_t vl_shape_light(const vlWorldShape *s, uint32_t prim) {
  if (s->first_light == VL_NONE) return VL_NONE;
  return s->light_of ? s->light_of[prim] : s->first_light + prim;
}

typedef struct vlWorldGroup {
  uint32_t *shapes; /* world shape index of each Embree geometry id */
  uint32_t count;
  float low[3], high[3]; /* box round them at all times, group space; empty: low > high */
} vlWorldGroup;

/* What moves goes straight from key to key: Embree and we (moving.h) interpolate the same numbers the same way. */
typedef struct vlWorldInstance {
  uint32_t group;
  bool mirrored;
  float from_group[12], to_group[12]; /* of one that moves: at the world's time 0 */
  uint32_t keys;                      /* of path, evenly over the world's time; 0: at rest */
  const float *path;                  /* 12 a key */
  float doubt[4];                     /* bound of the rounding error of a moved matrix, by column; 0 of those at rest */
} vlWorldInstance;

/* ---- materials --------------------------------------------------------------------------------------------------- */

/* The principled material's inputs: float nodes, spectrum nodes; what stays off for good has its flag unset. */
typedef struct vlWorldPrincipled {
  int32_t metallic, roughness, anisotropy, anisotropy_rotation, specular, transmission, diffuse_transmission;
  int32_t clearcoat, clearcoat_roughness, sheen_roughness, iridescence, iridescence_thickness;
  int32_t specular_color, through, sheen; /* spectra */
  int32_t normal, coat_normal;            /* image nodes, -1: none */
  float normal_scale, coat_normal_scale, film_index;
  float f0;                 /* reflection at normal incidence */
  bool thin;                /* a sheet, or nothing passes */
  float cauchy_a, cauchy_b; /* index of refraction where it disperses: a + b / lambda^2 */
  bool has_coat, has_sheen, has_film, has_anisotropy, has_transmission;
} vlWorldPrincipled;

/* A coat over metal, or one that scatters over what is diffuse: looked at by random walks. Spectrum and float nodes. */
typedef struct vlWorldLayers {
  bool metal;
  int32_t albedo, thickness, g;
  int32_t coat_u, coat_v; /* of metal; else the material's own roughness is the coat's */
  uint32_t depth, walks;
} vlWorldLayers;

/* Hair: spectrum nodes of one way to say its colour (-1: another), float nodes. */
typedef struct vlWorldHair {
  int32_t sigma_a, eumelanin, pheomelanin;
  int32_t eumelanin_share, pheomelanin_share, eta, beta_m, beta_n, alpha;
} vlWorldHair;

/* Light that enters a body and leaves it elsewhere: spectrum nodes; mfp is set where the material's reflectance says
 * the rest. The material's scale is a factor on the sigmas, or on mfp. */
typedef struct vlWorldSubsurface {
  int32_t sigma_a, sigma_s, mfp;
  const struct vlBssrdfTable *table;
} vlWorldSubsurface;

typedef struct vlWorldMaterial {
  vlMaterialKind kind;
  int32_t reflectance, eta, k;              /* spectrum nodes, -1: not used */
  int32_t u_roughness, v_roughness, amount; /* float nodes */
  uint32_t mix[2];
  bool absent[2]; /* parts of a mix that are interfaces: shapes take the other, with a coverage (shapes.c) */
  bool remap, use_reflectance;
  bool dispersive;                     /* dielectrics: eta varies with wavelength */
  float eta_s;                         /* dielectrics with one eta */
  int32_t displacement;                /* float node, -1 */
  int32_t normal_map;                  /* image index, -1 */
  const vlCoatTable *coat;             /* may be shared; the world frees them */
  const vlCoatTable *widened;          /* the same of the coat that is rougher (vlBuildDef.regularize), else null */
  const vlWorldPrincipled *principled; /* null for other kinds */
  int32_t transmittance;               /* diffuse transmission: spectrum node; and the factor on both */
  float scale;
  const vlWorldLayers *layers; /* null: none, or in closed form */
  const vlWorldHair *hair;
  const vlMeasured *measured; /* may be shared; the world frees it */
  const vlWorldSubsurface *subsurface;
  bool has_subsurface; /* it, or a part of a mix */
} vlWorldMaterial;

/* Coats of the same numbers share a table. */
typedef struct vlWorldCoat {
  vlCoatTable *table;
  uint32_t depth; /* max_depth of the material */
} vlWorldCoat;

/* ---- lights ------------------------------------------------------------------------------------------------------ */

typedef struct vlEmitted {
  vlSpectral spectrum; /* normalised and scaled */
  int32_t image; /* over uv (area) or directions (infinite), -1; then spectrum is the illuminant's normalised shape */
  int32_t node;  /* 1 + image node over uv, whose image is image; 0: none */
  float image_scale;
  vlColorSpace space;
  bool two_sided;
} vlEmitted;

typedef enum vlWorldLightKind {
  VL_WL_POINT,
  VL_WL_SPOT,
  VL_WL_DISTANT,
  VL_WL_INFINITE,
  VL_WL_AREA,
  VL_WL_GONIOMETRIC,
  VL_WL_PROJECTION
} vlWorldLightKind;

typedef struct vlWorldLight {
  vlWorldLightKind kind;
  uint32_t emitted;         /* index into emitted */
  uint32_t shape, prim;     /* area */
  float area;               /* area: of the primitive, in the world */
  float position[3];        /* point, spot */
  float direction[3];       /* spot: axis away from the light; distant: towards the light */
  float cos_start, cos_end; /* spot: full inside start, nothing outside end */
  bool cone_squared;        /* between them t^2; else smooth */
  uint32_t environment;     /* infinite with an image: index; VL_NONE: uniform */
  float power;              /* for choosing: watts-like, luminance */
  bool outer_side;        /* an invisible whole sphere: light's paths set out from its outside alone, see light.hot.c */
  bool invisible;         /* area, of coverage 0 throughout: no ray meets it, it shines all the same (as pbrt's) */
  uint32_t image;         /* goniometric, projection: image; corners hold the map from world directions to theirs */
  float image_extent[2];  /* projection: half its sides at distance 1 */
  float corners[9];       /* area, triangle: its corners, and */
  bool one_sided_normals; /* direction is the normal to the lit side all over it */
} vlWorldLight;

/* An image of the sky in pbrt's equal-area octahedral square, with a distribution over its texels. */
typedef struct vlEnvironment {
  int32_t image;
  uint32_t size;                                  /* of the distribution: size x size cells */
  float *conditional_cdf;                         /* size rows of size + 1 */
  float *marginal_cdf;                            /* size + 1 */
  float *pdf;                                     /* size * size: density over the unit square */
  float light_from_world[9], world_from_light[9]; /* rotations, row-major */
  const struct vlPortal *portal; /* through which alone it is seen (world/light/portal.h); null: none */
} vlEnvironment;

#include "world/light/light_tree.h"

/* Where an id comes from, for people (origins.c). */
typedef struct vlWorldOrigin {
  const char *name; /* may be null */
  vlSource source;
} vlWorldOrigin;

/* ---- the whole --------------------------------------------------------------------------------------------------- */

struct vlWorld {
  vlContext *context;
  vlBuildDef def;
  VL_ARRAY(vlWorldShape) shapes;
  VL_ARRAY(vlWorldGroup) groups; /* 0: the world itself */
  VL_ARRAY(vlWorldInstance) instances;
  VL_ARRAY(vlWorldMaterial) materials;
  VL_ARRAY(vlTextureNode) nodes;
  VL_ARRAY(vlWorldImage) images;
  VL_ARRAY(vlEmitted) emitted;
  VL_ARRAY(vlWorldLight) lights;
  VL_ARRAY(uint32_t) infinite_lights; /* indices of lights that a missing ray sees */
  VL_ARRAY(vlEnvironment) environments;
  VL_ARRAY(vlMeasured *) measured;
  VL_ARRAY(vlWorldCoat) coats;
  VL_ARRAY(vlWorldMedium) media;       /* those that something lies in */
  VL_ARRAY(void *) blocks;             /* dense spectra and the like */
  int32_t *texture_memo;               /* while building: scene texture and role -> node */
  uint32_t *rank;                      /* of materials: those of one kind together */
  bool has_interfaces, has_subsurface; /* some material is one; some shape has one */
  bool absorbs_by_channel;             /* some medium does: vlWorldMedium.by_channel */
  uint32_t camera_medium;              /* index into media, VL_NONE: vacuum */
  bool moves;                          /* something does; else no ray need know its time */
  double time_open, time_close;        /* seconds: the world's times 0 and 1; before and after everything rests */
  vlWorldOrigin *shape_origins, *material_origins, *instance_origins; /* one for each element of those arrays */
  vlSpectral white;                                                   /* radiance that shows as white */
  vlLightTree tree;
  vlAccel accel;
  float bounds_min[3], bounds_max[3], center[3], radius; /* of all surfaces; a sphere round them */
  vlWorldInfo info;
};

/* The compiled form of a build in progress; each adds to the world and fails with the place. */
vlResult vl_world_float_node(vlWorld *world, const struct vlScene *scene, vlFloatInput input, int32_t *node,
                             vlError *error);
vlResult vl_world_spectrum_node(vlWorld *world, const struct vlScene *scene, vlSpectrumInput input, vlSpectrumRole role,
                                int32_t *node, vlError *error);
/* Of two float nodes by a third. */
vlResult vl_world_mix_node(vlWorld *world, int32_t a, int32_t b, int32_t amount, int32_t *node, vlError *error);
/* Reads an image (or takes the one given); encoding null: the file's own. Index, or -1 with the error set. */
int32_t vl_world_add_image(vlWorld *world, const char *path, const vlImage *given, const vlEncoding *encoding,
                           float gamma, bool pyramid, vlError *error);
vlResult vl_world_principled(vlWorld *world, const struct vlScene *scene, const vlMaterialDef *def, vlWorldMaterial *m,
                             vlError *error);
vlResult vl_world_layers(vlWorld *world, const struct vlScene *scene, const vlMaterialDef *def, vlWorldMaterial *m,
                         vlError *error);
vlResult vl_world_subsurface(vlWorld *world, const struct vlScene *scene, const vlMaterialDef *def, vlWorldMaterial *m,
                             vlError *error);
vlResult vl_world_hair(vlWorld *world, const struct vlScene *scene, const vlMaterialDef *def, vlWorldMaterial *m,
                       vlError *error);
/* Reads the scene's images on all workers; errors are left to who asks for the image. */
vlResult vl_world_preload_images(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_materials(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_shapes(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_lights(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_origins(vlWorld *world, const struct vlScene *scene, vlError *error);

/* Area of one primitive in the space its vertices are in (with from_group where an instance places it). */
float vl_world_prim_area(const vlWorldShape *shape, uint32_t prim);
void vl_world_prim_bounds(const vlWorldShape *shape, uint32_t prim, float low[3], float high[3]);
/* r, with the place put to an error that was found deeper and has none. */
vlResult vl_world_placed(vlSource source, vlError *error, vlResult r);
/* A new block owned by the world, or null. */
void *vl_world_block(vlWorld *world, size_t count, size_t size);

#endif
