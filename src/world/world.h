/* world/world.h: the compiled world: flat arrays addressed by index. build.c makes it from a scene, trace reads it.
 * Constant while rendering.
 *
 * A surface point is identified by (shape, prim, instance): shape indexes world->shapes, prim is the face in it,
 * instance indexes world->instances or is VL_NONE. Vertices of shapes outside of groups are in world space; those of
 * groups are in group space. */
#ifndef WORLD_WORLD_H
#define WORLD_WORLD_H

#include "base/array.h"
#include "color/color.h"
#include "velo/render.h"
#include "world/accel/accel.h"
#include "world/light/environment_lookup.h"
#include "world/material/bsdf_kind.h"
#include "world/material/coat.h"
#include "world/material/measured.h"
#include "world/medium/medium.h"
#include "world/texture/texture.h"

/* ---- shapes ------------------------------------------------------------------------------------------------------ */

typedef struct vlWorldShape {
  vlShapeKind kind;
  uint32_t traits;      /* VL_SHAPE_TRAIT_MESH and so on */
  uint32_t material;    /* index into materials */
  uint32_t first_light; /* VL_NONE: no light; else see vl_shape_light */
  int32_t alpha;        /* texture node, -1: opaque */
  /* Reverse orientation xor a mirroring shape transform: flips a triangle's or patch's face-order normal in group
   * space, and a quadric's or curve's dpdu x dpdv in shape space. */
  bool flip;
  bool pass_shadow;         /* interface material: shadow rays pass */
  uint32_t inside, outside; /* media; the geometric normal points outside; VL_NONE: vacuum; equal: no change */
  /* Triangles (3 indices per face) and bilinear patches (4). positions end in 16 padding bytes for Embree. */
  uint32_t vertices, faces;
  float *positions, *normals, *tangents, *uvs;
  uint32_t *indices;
  /* Triangles; each may be null. Bitangent = sign n x tangent; uv sets 1 to 3; colours, 4 per vertex; uvs of the
   * emission's image. */
  float *tangent_signs, *more_uvs[3], *colors, *emission_uvs;
  uint32_t *light_of; /* per prim, VL_NONE: none; null: prim i is light first_light + i */
  bool one_sided;     /* rays pass through from behind */
  uint32_t steps;     /* sets of positions and normals, one after the other, at equal time steps; 1: at rest */
  /* Sphere, disk, cylinder: parameters as in vlShapeDef, and the affine maps, row-major 3x4. */
  float radius, inner_radius, z_min, z_max, phi_max, height;
  double *centers; /* many spheres: 3 per prim, in shape space; else null */
  float *radii;    /* many spheres: 1 per prim; else null */
  /* Curves: per segment 4 points and 2 widths, for ribbons 2 normals, all in shape space. A prim is a piece of a
   * segment. */
  vlCurveKind curve;
  uint32_t split; /* faces = segments << split */
  float *widths;
  double from_shape[12], to_shape[12]; /* group space <-> shape space */
} vlWorldShape;

/* The light of a prim, or VL_NONE. */
static inline uint32_t vl_shape_light(const vlWorldShape *s, uint32_t prim) {
  if (s->first_light == VL_NONE) return VL_NONE;
  return s->light_of ? s->light_of[prim] : s->first_light + prim;
}

typedef struct vlWorldGroup {
  uint32_t *shapes; /* world shape index of each Embree geometry id */
  uint32_t count;
  float low[3], high[3]; /* box at all times, group space; empty: low > high */
} vlWorldGroup;

/* An instance. A moving instance is interpolated linearly between its keys: Embree and velo (moving.h) interpolate
 * the same numbers in the same way. */
typedef struct vlWorldInstance {
  uint32_t group;
  bool mirrored;
  float from_group[12], to_group[12]; /* of a moving instance: at the world's time 0 */
  uint32_t keys;                      /* of path, at equal steps of the world's time; 0: at rest */
  const float *path;                  /* 12 floats per key */
  float doubt[4];                     /* bound of the rounding error of an interpolated matrix, by column; 0 at rest */
} vlWorldInstance;

/* ---- materials --------------------------------------------------------------------------------------------------- */

/* The principled material's inputs: float nodes and spectrum nodes. A lobe whose weight is always 0 has its flag
 * unset. */
typedef struct vlWorldPrincipled {
  int32_t metallic, roughness, anisotropy, anisotropy_rotation, specular, transmission, diffuse_transmission;
  int32_t clearcoat, clearcoat_roughness, sheen_roughness, iridescence, iridescence_thickness;
  int32_t specular_color, through, sheen; /* spectra */
  int32_t normal, coat_normal;            /* image nodes, -1: none */
  float normal_scale, coat_normal_scale, film_index;
  float f0;                 /* Fresnel reflectance at normal incidence */
  bool thin;                /* thin-walled, or nothing is transmitted */
  float cauchy_a, cauchy_b; /* dispersive: index of refraction a + b / lambda^2 */
  bool has_coat, has_sheen, has_film, has_anisotropy, has_transmission;
} vlWorldPrincipled;

/* A coat over metal, or a scattering coat over a diffuse base, evaluated by random walks. Spectrum and float nodes. */
typedef struct vlWorldLayers {
  bool metal;
  int32_t albedo, thickness, g;
  int32_t coat_u, coat_v; /* of metal; else the coat has the material's own roughness */
  uint32_t depth, walks;
} vlWorldLayers;

/* Hair: spectrum nodes of the alternative colour parameters (-1: not given), float nodes. */
typedef struct vlWorldHair {
  int32_t sigma_a, eumelanin, pheomelanin;
  int32_t eumelanin_share, pheomelanin_share, eta, beta_m, beta_n, alpha;
} vlWorldHair;

/* Subsurface scattering: spectrum nodes. mfp is set if the material is given by reflectance and mean free path. The
 * material's scale multiplies the sigmas, or mfp. */
typedef struct vlWorldSubsurface {
  int32_t sigma_a, sigma_s, mfp;
  const struct vlBssrdfTable *table;
} vlWorldSubsurface;

/* When all scattering of a material is specular (delta). */
typedef enum vlSmooth {
  VL_SMOOTH_NEVER,
  VL_SMOOTH_BY_ALPHA,          /* if its alphas are small */
  VL_SMOOTH_BY_ALPHA_OR_INDEX, /* also if its relative index of refraction is 1 */
  VL_SMOOTH_ALWAYS
} vlSmooth;

typedef struct vlWorldMaterial {
  vlMaterialKind kind;
  vlBsdfKind bsdf;
  vlSmooth smooth;
  uint32_t traits; /* of the kind: VL_MATERIAL_OPAQUE and so on */
  const void *own; /* data of this kind alone (vlWorldLayers, vlWorldHair, ...): a block owned by the world */
  bool no_cosine;  /* throughput has no cosine factor */
  int32_t reflectance, eta, k;              /* spectrum nodes, -1: not used */
  int32_t u_roughness, v_roughness, amount; /* float nodes */
  uint32_t mix[2];
  bool absent[2]; /* parts of a mix that are interfaces: shapes use the other part, with a coverage (shapes.c) */
  bool remap, use_reflectance;
  bool dispersive;                     /* dielectrics: eta depends on wavelength */
  float eta_s;                         /* dielectrics with one eta */
  int32_t displacement;                /* float node, -1 */
  int32_t normal_map;                  /* image index, -1 */
  const vlCoatTable *coat;             /* may be shared; the world frees them */
  const vlCoatTable *widened;          /* the table of the coat widened by vlBuildDef.regularize, else null */
  const vlWorldPrincipled *principled; /* null for other kinds */
  int32_t transmittance; /* diffuse transmission: spectrum node; scale multiplies reflectance and transmittance */
  float scale;
  const vlMeasured *measured; /* may be shared; the world frees it */
  const vlWorldSubsurface *subsurface;
  bool has_subsurface; /* the material has subsurface scattering, or a part of the mix has */
} vlWorldMaterial;

/* Coats with equal parameters share a table. */
typedef struct vlWorldCoat {
  vlCoatTable *table;
  uint32_t depth; /* max_depth of the material */
} vlWorldCoat;

/* ---- lights ------------------------------------------------------------------------------------------------------ */

typedef struct vlEmitted {
  vlSpectral spectrum; /* normalised and scaled */
  int32_t image;       /* over uv (area) or directions (infinite), multiplied by spectrum (the illuminant); -1: none */
  int32_t node;        /* 1 + index of the image node over uv that reads image; 0: none */
  float image_scale;
  vlColorSpace space;
  bool two_sided;
} vlEmitted;

/* The scene's kinds, with the same numbers, and faces of emissive shapes. X(NAME, name). */
#define VL_WORLD_LIGHT_KINDS(X) VL_LIGHT_KINDS(X) X(AREA, area)
#define VL_WORLD_LIGHT_KIND(K, k) VL_WL_##K,
typedef enum vlWorldLightKind { VL_WORLD_LIGHT_KINDS(VL_WORLD_LIGHT_KIND) } vlWorldLightKind;
#undef VL_WORLD_LIGHT_KIND

typedef struct vlWorldLight {
  vlWorldLightKind kind;
  uint32_t emitted;         /* index into emitted */
  uint32_t shape, prim;     /* area; else shape is VL_NONE */
  float area;               /* area: of the primitive, world space */
  float position[3];        /* point, spot */
  float direction[3];       /* spot: axis away from the light; distant: towards the light */
  float cos_start, cos_end; /* spot: full intensity within start, none beyond end */
  bool cone_squared;        /* falloff between them is t^2; else smooth */
  bool has_cone;            /* emits only into the outer cone about its direction */
  bool at_point;            /* all its light starts at its position */
  bool far;                 /* infinitely far away */
  uint32_t environment;     /* infinite with an image: index; VL_NONE: uniform */
  float power;              /* for light selection: radiant flux in luminance units */
  /* an invisible full sphere: light paths start only on its outside, see light.hot.c */
  bool outer_side;
  /* area light of a shape with alpha 0 throughout: rays do not hit it, but it emits light (as in pbrt) */
  bool invisible;
  bool delta;     /* no ray can hit it */
  uint32_t image; /* goniometric, projection: image index; corners hold the rotation from world to light directions */
  float image_extent[2]; /* projection: half the image's sides at distance 1 */
  /* Area: corners of a triangle; of a plain sphere the centre, the radius, and 1, or -1 if it emits inwards. */
  float corners[9];
  bool one_sided_normals; /* direction is the normal of the emitting side at every point */
  bool plain_triangle;    /* a triangle with such a normal, */
  bool plain_sphere;      /* or a whole sphere: opaque, with the same emission everywhere */
} vlWorldLight;

#include "world/light/light_tree.h"

/* Where an id comes from, for reports (origins.c). */
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
  VL_ARRAY(uint32_t) infinite_lights; /* indices of lights that rays hit when they miss all surfaces */
  VL_ARRAY(vlEnvironment) environments;
  VL_ARRAY(vlMeasured *) measured;
  VL_ARRAY(vlWorldCoat) coats;
  VL_ARRAY(vlWorldMedium) media;       /* media in use */
  VL_ARRAY(void *) blocks;             /* memory owned by the world: dense spectra and others */
  int32_t *texture_memo;               /* during the build: scene texture and role -> node */
  uint32_t *rank;                      /* of materials, sorted so that those of one kind are adjacent */
  bool has_interfaces, has_subsurface; /* a material is an interface; a shape has subsurface scattering */
  bool absorbs_by_channel;             /* a medium does: vlWorldMedium.by_channel */
  uint32_t camera_medium;              /* index into media, VL_NONE: vacuum */
  bool moves;                          /* something moves; else rays need no time */
  double time_open, time_close;        /* seconds at the world's times 0 and 1; outside of them nothing moves */
  vlWorldOrigin *shape_origins, *material_origins, *instance_origins; /* one per element of those arrays */
  vlSpectral white;                                                   /* radiance that is displayed as white */
  vlLightTree tree;
  vlAccel accel;
  float bounds_min[3], bounds_max[3], center[3], radius; /* bounds of all surfaces, and their bounding sphere */
  vlWorldInfo info;
};

/* Compiles an input of the scene into a node of a world under construction. Errors carry the source location. */
vlResult vl_world_float_node(vlWorld *world, const struct vlScene *scene, vlFloatInput input, int32_t *node,
                             vlError *error);
vlResult vl_world_spectrum_node(vlWorld *world, const struct vlScene *scene, vlSpectrumInput input, vlSpectrumRole role,
                                int32_t *node, vlError *error);
/* Interpolates between two float nodes by a third. */
vlResult vl_world_mix_node(vlWorld *world, int32_t a, int32_t b, int32_t amount, int32_t *node, vlError *error);
/* Reads an image (or uses the given one). encoding null: the file's own. Returns its index, or -1 with the error
 * set. */
int32_t vl_world_add_image(vlWorld *world, const char *path, const vlImage *given, const vlEncoding *encoding,
                           float gamma, bool pyramid, vlError *error);
/* Reads the scene's images on all workers. Errors are ignored here: the user of the image reports them. */
vlResult vl_world_preload_images(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_materials(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_shapes(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_lights(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_origins(vlWorld *world, const struct vlScene *scene, vlError *error);

/* Area of one primitive in the space of its vertices (times from_group if an instance places it). */
float vl_world_prim_area(const vlWorldShape *shape, uint32_t prim);
void vl_world_prim_bounds(const vlWorldShape *shape, uint32_t prim, float low[3], float high[3]);
/* Returns r. Adds the source location to an error that has none. */
vlResult vl_world_placed(vlSource source, vlError *error, vlResult r);
/* A new block owned by the world, or null. */
void *vl_world_block(vlWorld *world, size_t count, size_t size);
/* *to: such a block with a copy of the numbers; unchanged where from is null. False: out of memory. */
bool vl_world_copy_floats(vlWorld *world, const float *from, size_t count, float **to);

#endif
