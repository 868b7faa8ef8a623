/* world/world.h: the compiled world: flat arrays addressed by index. build.c makes the world
 * from a scene; the room trace reads it. The world does not change during rendering.
 *
 * A surface point is identified by (shape, prim, instance): shape indexes world->shapes, prim
 * is a face of that shape, and instance indexes world->instances or is VL_NONE. Vertices of
 * shapes in group 0 are in world space; vertices of shapes in other groups are in the space of
 * their group. */
#ifndef WORLD_WORLD_H
#define WORLD_WORLD_H

#include "base/array.h"
#include "base/cancel.h"
#include "color/color.h"
#include "light/environment_lookup.h"
#include "light/lamp.h"
#include "material/coat.h"
#include "material/measured_tables.h"
#include "medium/medium.h"
#include "texture/node.h"
#include "velo/world.h"
#include "world/accel/accel.h"
#include "world/part.h"

/* ---- shapes ------------------------------------------------------------------------------ */

typedef struct vlWorldShape {
  uint32_t kind;        /* vlShapeKind */
  bool triangles;       /* of this kind: the room trace computes its hits in batches */
  uint32_t traits;      /* bits VL_SHAPE_TRAIT_*, such as VL_SHAPE_TRAIT_MESH */
  uint32_t material;    /* index into materials */
  uint32_t first_light; /* VL_NONE: the shape emits no light; otherwise see vl_shape_light */
  int32_t alpha;        /* texture node of the opacity; -1: opaque */
  /* True if exactly one holds: the shape has reverse orientation; its transform mirrors. It
   * reverses the normal: for triangles and patches the one given by the order of the vertices,
   * in group space; for quadrics and curves dpdu x dpdv, in shape space. */
  bool flip;
  bool pass_shadow;         /* the material is an interface: shadow rays pass */
  uint32_t inside, outside; /* media; the geometric normal points to `outside`; VL_NONE: vacuum;
                               equal: the surface separates no media */
  /* For triangles (3 indices per face) and bilinear patches (4 indices per face). 16 padding
   * bytes follow the positions, because Embree reads past the last one. */
  uint32_t vertices, faces;
  float *positions, *normals, *tangents, *uvs;
  uint32_t *indices;
  /* For triangles; each pointer may be null. tangent_signs: bitangent = sign * (n x tangent).
   * more_uvs: the uv sets 1 to 3. colors: 4 floats per vertex. emission_uvs: uvs at which the
   * image of the emission is read. */
  float *tangent_signs, *more_uvs[3], *colors, *emission_uvs;
  uint32_t *light_of; /* light index per prim, VL_NONE: no light; null: prim i is light
                         first_light + i */
  bool one_sided;     /* rays that come from behind pass through */
  bool backdrop;      /* alpha is 0 where camera rays meet it first */
  bool hidden;        /* camera rays pass through it */
  uint32_t steps; /* number of sets of positions and normals, at equal time steps; 1: at rest */
  /* For spheres, disks and cylinders: the parameters of vlShapeDef. All shapes but meshes have
   * the two affine maps below. */
  float radius, inner_radius, z_min, z_max, phi_max, height;
  double *centers; /* many spheres: 3 per prim, in shape space; else null */
  float *radii;    /* many spheres: 1 per prim; else null */
  /* Of a full sphere under a similarity: its centre and its radius in group space; the radius
   * of all other shapes is 0. */
  float whole_center[3], whole_radius;
  double own_error[3]; /* bound of the rounding errors of their points along each axis, group
                          space; of many spheres 0: each has its own */
  /* For curves. A segment has 4 control points, 2 widths and, if it is a ribbon, 2 normals, all
   * in shape space. Each segment is split into pieces; a prim is one piece. */
  uint32_t curve; /* vlCurveKind */
  uint32_t split; /* faces = segments << split */
  float *widths;
  /* from_shape: group from shape; to_shape: its inverse; row-major 3x4 */
  double from_shape[12], to_shape[12];
} vlWorldShape;

/* The uv of corner k of a triangle of these vertices, and of its point with the barycentric
 * coordinates b. uvs: by vertex; null: those of pbrt. */
static inline const float *vl_corner_uv(const float *uvs, const uint32_t vertices[3], int k) {
  static const float none[3][2] = {{0, 0}, {1, 0}, {1, 1}};
  return uvs ? uvs + 2 * (size_t)vertices[k] : none[k];
}
static inline vlVec2 vl_triangle_uv(const float *uvs, const uint32_t vertices[3],
                                    const float b[3]) {
  vlVec2 uv = {0, 0};
  for (int k = 0; k < 3; k++) {
    const float *corner = vl_corner_uv(uvs, vertices, k);
    uv.x += b[k] * corner[0];
    uv.y += b[k] * corner[1];
  }
  return uv;
}

/* The light of a prim, or VL_NONE. */
static inline uint32_t vl_shape_light(const vlWorldShape *s, uint32_t prim) {
  if (s->first_light == VL_NONE)
    return VL_NONE;
  return s->light_of ? s->light_of[prim] : s->first_light + prim;
}

typedef struct vlWorldGroup {
  uint32_t *shapes; /* world shape index of each Embree geometry id */
  uint32_t count;
  /* bounding box over all times, in group space; an empty box has low > high */
  float low[3], high[3];
} vlWorldGroup;

/* An instance of a group. The pose of a moving instance is interpolated linearly between its
 * keys. Embree and velo (moving.h) interpolate the same matrices. */
typedef struct vlWorldInstance {
  uint32_t group;
  bool mirrored;
  /* world from group, and its inverse; if moving, at the world's time 0 */
  float from_group[12], to_group[12];
  uint32_t keys; /* number of poses in path, at equal steps of the world's time; 0: at rest */
  const float *path; /* pose (world from group) of each key, 12 floats */
  /* Bound of the distance, world space, between a placed point and the surface that a ray
   * meets: a point x of the group may be off by error[0] |x| + error[1] |y| + error[2] |z| +
   * error[3] (surface_point.h). */
  float error[4];
} vlWorldInstance;

/* ---- materials --------------------------------------------------------------------------- */

/* Inputs of the principled material, as indices of float nodes and spectrum nodes. The flags
 * has_* are false for lobes whose weight is always 0. */
typedef struct vlWorldPrincipled {
  int32_t metallic, roughness, anisotropy, anisotropy_rotation, specular, transmission,
      diffuse_transmission;
  int32_t clearcoat, clearcoat_roughness, sheen_roughness, iridescence, iridescence_thickness;
  int32_t specular_color, through, sheen; /* spectra */
  int32_t normal, coat_normal;            /* image nodes, -1: none */
  float normal_scale, coat_normal_scale, film_index;
  float f0;                 /* Fresnel reflectance at normal incidence */
  bool thin;                /* thin-walled, or nothing is transmitted */
  float cauchy_a, cauchy_b; /* dispersive: index of refraction a + b / lambda^2 */
  bool has_coat, has_sheen, has_film, has_anisotropy, has_transmission;
  bool by_channel; /* spectral mode: transmitted light has the base colour per channel of linear
                      sRGB */
} vlWorldPrincipled;

/* Inputs of layered materials that are evaluated by random walks: a coat over metal or over a
 * diffuse base. Numbers of type int32_t are indices of spectrum or float nodes. */
typedef struct vlWorldLayers {
  bool metal;
  int32_t albedo, thickness, g;
  int32_t coat_u, coat_v; /* roughness of a coat over metal; a coat over a diffuse base has the
                             material's u_roughness and v_roughness */
  uint32_t depth, walks;
} vlWorldLayers;

/* Inputs of hair. The first three are spectrum nodes, alternative parameters of the colour (-1:
 * not given). The others are float nodes. */
typedef struct vlWorldHair {
  int32_t sigma_a, eumelanin, pheomelanin;
  int32_t eumelanin_share, pheomelanin_share, eta, beta_m, beta_n, alpha;
} vlWorldHair;

/* Inputs of subsurface scattering, as spectrum nodes. mfp, the mean free path, is used if the
 * material is described by its reflectance and mean free path; sigma_a and sigma_s otherwise.
 * The material's scale multiplies mfp or the sigmas. */
typedef struct vlWorldSubsurface {
  int32_t sigma_a, sigma_s, mfp;
  const struct vlBssrdfTable *table;
  vlPart *part; /* owns the table */
} vlWorldSubsurface;

/* Says when all scattering of a material is specular (a delta distribution). */
typedef enum vlSmooth {
  VL_SMOOTH_NEVER,
  VL_SMOOTH_BY_ALPHA,          /* if its roughness alphas are small */
  VL_SMOOTH_BY_ALPHA_OR_INDEX, /* if its roughness alphas are small or its relative index of
                                  refraction is 1 */
  VL_SMOOTH_ALWAYS
} vlSmooth;

typedef struct vlWorldMaterial {
  uint32_t kind; /* vlMaterialKind */
  uint32_t bsdf; /* vlBsdfKind */
  bool diffuse;  /* bsdf is VL_BSDF_DIFFUSE */
  vlSmooth smooth;
  uint32_t traits; /* bits of the kind, such as VL_MATERIAL_OPAQUE */
  const void *own; /* data of this kind alone (vlWorldHair, ...): a block owned
                      by the world */
  bool no_cosine;  /* the path throughput is not multiplied by the cosine */
  bool one_sided;  /* light only leaves on the side on which it arrives: only lights on the
                      viewer's side count */
  int32_t reflectance, eta, k;              /* spectrum nodes, -1: not used */
  int32_t u_roughness, v_roughness, amount; /* float nodes */
  bool mixed; /* a mix of the materials mix[0] and mix[1], which come before it */
  uint32_t mix[2];
  /* nothing: an interface, or a mix of interfaces only. presence: of a mix with an interface
   * among its parts, the node of the share that is not interface; shapes have it as an alpha
   * (shapes.c). -1: all of it. */
  bool nothing;
  int32_t presence;
  bool remap, use_reflectance;
  bool dispersive;         /* for dielectrics: eta depends on the wavelength */
  float eta_s;             /* for dielectrics whose eta does not depend on the wavelength */
  int32_t displacement;    /* float node, -1: none */
  int32_t normal_map;      /* image index, -1: none */
  const vlCoatTable *coat; /* may be shared with other materials; the world frees it */
  /* the same for the roughness that vlBuildDef.regularize gives; else null */
  const vlCoatTable *widened;
  const vlWorldPrincipled *principled; /* null for other kinds */
  const vlWorldLayers *layers;         /* null for other kinds */
  int32_t transmittance; /* for diffuse transmission: spectrum node; scale multiplies
                            reflectance and transmittance */
  float scale;
  const vlMeasured *measured; /* may be shared with other materials; the world frees it */
  const vlWorldSubsurface *subsurface;
  bool has_subsurface; /* the material, or a part of the mix, has subsurface scattering */
} vlWorldMaterial;

/* Table of a coat. Materials whose coats have equal parameters share one table. */
typedef struct vlWorldCoat {
  vlPart *part; /* owns the table */
  vlCoatTable *table;
  uint32_t depth; /* max_depth of the materials that share the table */
} vlWorldCoat;

/* ---- lights ------------------------------------------------------------------------------ */

typedef struct vlEmitted {
  vlSpectral spectrum; /* normalised and scaled */
  int32_t image;       /* index of an image over uv (area lights) or over directions (infinite
                          lights); spectrum, the illuminant, multiplies it; -1: none */
  int32_t node;        /* 1 + index of the texture node that reads image at uv; 0: none */
  float image_scale;
  vlColorSpace space; /* of the image */
  vlSrgbMap to_srgb;  /* in RGB mode, of the image's colours */
  bool two_sided;
  /* Of surfaces whose spread is below 180 degrees, with h half of it: 1 / tan h, the factor
   * 1 / (1 - h / tan h) and sin^2 h. Of all others 0, 1 and 1 (light/spread.h). */
  float spread_cot, spread_scale, spread_sin2;
} vlEmitted;

typedef struct vlWorldLight {
  uint32_t kind;        /* vlLightKind, or VL_LIGHT_AREA (light/light_kind.h) */
  uint32_t emitted;     /* index into emitted */
  uint32_t shape, prim; /* of an area light; for other lights shape is VL_NONE */
  float area;           /* of an area light: area of the primitive in world space */
  float position[3];    /* of lights at a point, world space */
  float direction[3];   /* of a spot light: its axis, away from the light; of a distant light:
                           towards the light */
  /* of a spot light: full intensity within the angle `start`, none beyond `end` */
  float cos_start, cos_end;
  bool cone_squared; /* the falloff between start and end is t^2; otherwise it is smooth */
  bool has_cone;     /* emits only into the cone of cos_end about its direction */
  bool skewed_cone;  /* the cone is round in the light's frame only: `corners` turns directions
                        of the world into it */
  bool at_point;     /* all light starts at `position` */
  bool far;          /* infinitely far away */
  uint32_t environment; /* of an infinite light with an image: index into environments; VL_NONE:
                           uniform radiance */
  float power;          /* for light selection: emitted flux in units of luminance; of a light
                           with a cone, that flux over the share of the sphere that the cone is, its
                           edge by its mean falloff */
  /* the light is an invisible full sphere: light paths start only on its outside
   * (light.hot.c) */
  bool outer_side;
  /* the shape of the area light has alpha 0 everywhere: rays do not hit the shape, but it emits
   * light, as in pbrt */
  bool invisible;
  bool delta;     /* no ray can hit it */
  uint32_t image; /* of goniometric and projection lights: image index; their `corners` hold the
                     rotation from world to light directions */
  uint32_t lamp;  /* of a goniometric light with a lamp file: index into lamps, and `corners`
                     holds the rotation to the table's frame; else VL_NONE */
  float own[4];   /* numbers that only this kind has; of a projection light: half the width and
                     height of the image at distance 1; of a spot light with a skewed cone: the
                     axis in the light's frame, unit */
  /* Of an area light that is a triangle: its corners. Of a whole sphere: its centre, its
   * radius, 1 if it emits outwards or -1 if it emits inwards, and the distance by which points
   * sampled on it may be off. */
  float corners[9];
  bool one_sided_normals; /* `direction` is the normal of the emitting side at every point of
                             the light */
  bool plain_triangle;    /* a triangle with one_sided_normals, opaque, with the same emission
                             everywhere */
  bool plain_sphere;      /* a whole sphere, opaque, with the same emission everywhere */
  bool far_side_seen;     /* a whole sphere of an interface whose inside emits: points outside
                             receive light of the far side through the near side */
} vlWorldLight;

/* What worlds share of a thing that may be read from a file. */
typedef struct vlWorldFilePart {
  vlPart *part;
  vlFileStamp stamp; /* of the file when it was read */
  uint32_t id;       /* of a medium: its id in the scene, and the generation of its mark */
  uint64_t generation;
} vlWorldFilePart;

/* What worlds share of an environment: the distribution over its cells. */
typedef struct vlWorldEnvironmentPart {
  vlPart *part, *image; /* owner of the distribution; the part of its image */
  double mean, illuminance;
} vlWorldEnvironmentPart;

#include "light/light_tree.h"

/* Name and source location of an object in the scene, for reports (origins.c). */
typedef struct vlWorldOrigin {
  vlLabel label;
  bool shared; /* the name is that of a group, which has other instances */
  vlSource source;
} vlWorldOrigin;

/* ---- the whole --------------------------------------------------------------------------- */

struct vlWorld {
  vlContext *context;
  vlBuildDef def; /* without its pointers, which are valid during the build only */
  vlTask *task;   /* of the build; null afterwards */
  /* during the build: the world whose parts may be shared; null: none */
  const struct vlWorld *previous;
  uint64_t scene_number; /* vlScene.number */
  uint64_t number; /* of the world in its context; changes of the scene have higher ones */
  VL_ARRAY(vlPart *) parts; /* all parts of which the world is a user */
  vlPart *part;             /* during the build: owner of new blocks; null: the world */
  vlPart **shape_parts; /* one per shape: the part with its arrays; null: the shape has none */
  uint32_t *shape_from; /* during the build: index of the previous world's shape with the same
                           geometry, or VL_NONE */
  struct vlShapeSearch *shape_search; /* during the build (share.c) */
  VL_ARRAY(vlWorldShape) shapes;
  VL_ARRAY(vlWorldGroup) groups; /* element 0 holds the shapes outside of groups */
  VL_ARRAY(vlWorldInstance) instances;
  VL_ARRAY(vlWorldMaterial) materials;
  VL_ARRAY(vlTextureNode) nodes;
  VL_ARRAY(vlWorldImage) images;
  VL_ARRAY(vlEmitted) emitted;
  VL_ARRAY(vlWorldLight) lights;
  /* indices of the lights that a ray hits if it misses all surfaces */
  VL_ARRAY(uint32_t) infinite_lights;
  VL_ARRAY(vlEnvironment) environments;
  VL_ARRAY(const vlLamp *) lamps; /* luminaires of goniometric lights, owned by parts */
  VL_ARRAY(vlWorldEnvironmentPart) environment_parts; /* one per environment */
  VL_ARRAY(vlMeasured *) measured;
  VL_ARRAY(vlWorldFilePart) measured_parts; /* one per measured material */
  VL_ARRAY(vlWorldCoat) coats;
  VL_ARRAY(vlWorldMedium) media;          /* media in use */
  VL_ARRAY(vlWorldFilePart) medium_parts; /* one per medium */
  VL_ARRAY(void *) blocks; /* memory blocks owned by the world, such as dense spectra */
  /* used during the build only: maps scene texture and role to the node */
  int32_t *texture_memo;
  uint32_t *rank; /* per material: its position in an order in which materials of one kind are
                     adjacent */
  bool has_interfaces, has_mixtures; /* a material is an interface; a material is mixed */
  bool has_subsurface;               /* a shape has subsurface scattering */
  bool has_one_sided;                /* rays pass through a shape from one side */
  bool has_alpha;                    /* a shape has an alpha */
  bool has_hidden;                   /* camera rays pass through a shape */
  bool by_channel;                   /* a medium (vlWorldMedium.by_channel) or a material
                                        (vlWorldPrincipled.by_channel) attenuates light per
                                        channel of linear sRGB */
  uint32_t camera_medium;            /* index into media, VL_NONE: vacuum */
  bool moves;                        /* something moves; if false, rays need no time */
  /* the world's times 0 and 1 in seconds; nothing moves before or after */
  double time_open, time_close;
  /* one per shape, material and instance */
  vlWorldOrigin *shape_origins, *material_origins, *instance_origins;
  vlSpectral white; /* radiance that is displayed as white */
  vlLightTree tree;
  vlAccel accel;
  /* bounds of all surfaces, and their bounding sphere */
  float bounds_min[3], bounds_max[3], center[3], radius;
  vlWorldInfo info;
};

/* Compiles an input of the scene into a node of a world under construction. Errors carry the
 * source location. */
vlResult vl_world_float_node(vlWorld *world, const struct vlScene *scene, vlFloatInput input,
                             int32_t *node, vlError *error);
vlResult vl_world_spectrum_node(vlWorld *world, const struct vlScene *scene,
                                vlSpectrumInput input, vlSpectrumRole role, int32_t *node,
                                vlError *error);
/* Interpolates between two float nodes by a third. */
vlResult vl_world_mix_node(vlWorld *world, int32_t a, int32_t b, int32_t amount, int32_t *node,
                           vlError *error);
/* Reads an image (or uses the given one). encoding null: the file's own. pyramid: also makes
 * the smaller levels of the MIP map. Returns the image's index, or -1 with the error set. */
int32_t vl_world_add_image(vlWorld *world, const char *path, const vlImage *given,
                           const vlEncoding *encoding, bool pyramid, vlError *error);
/* Reads the scene's images on all workers. Errors of an image are ignored here: the code that
 * uses the image reports them. */
vlResult vl_world_preload_images(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_materials(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_shapes(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_lights(vlWorld *world, const struct vlScene *scene, vlError *error);
vlResult vl_world_add_origins(vlWorld *world, const struct vlScene *scene, vlError *error);

/* Area of one primitive in the space of its vertices: world space for shapes outside of groups,
 * else group space. */
float vl_world_prim_area(const vlWorldShape *shape, uint32_t prim);
void vl_world_prim_bounds(const vlWorldShape *shape, uint32_t prim, float low[3],
                          float high[3]);
/* During the build: CANCELLED if it must stop. name, fraction: as in vlStep. */
vlResult vl_world_step(const vlWorld *world, const char *name, double fraction, vlError *error);
/* Returns r. Adds the source location to an error that has none. */
vlResult vl_world_locate_error(vlSource source, vlError *error, vlResult r);
/* Logs a warning about what stands at this place of a file. */
void vl_world_warn(const vlWorld *world, vlSource source, const char *format, ...)
    VL_PRINTF(3, 4);
/* A new block owned by the world, or null. */
void *vl_world_block(vlWorld *world, size_t count, size_t size);
/* Sets *to to a new block owned by the world, with a copy of the numbers; leaves *to unchanged
 * if from is null. False: out of memory. */
bool vl_world_copy_floats(vlWorld *world, const float *from, size_t count, float **to);

#endif
