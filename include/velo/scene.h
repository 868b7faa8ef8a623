/* velo/scene.h: the description of a world, editable: what a scene file says, or what a program adds by hand.
 * Everything added is copied. The scene is sticky: it remembers its first error and further adds return id 0; ask with
 * vl_scene_result(). Not thread-safe. */
#ifndef VELO_SCENE_H
#define VELO_SCENE_H

#include "velo/base.h"
#include "velo/camera.h"
#include "velo/image.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vlScene vlScene;

/* Typed ids; index 0 is "none", the first object has index 1. */
typedef struct vlTextureId {
  uint32_t index;
} vlTextureId;
typedef struct vlMaterialId {
  uint32_t index;
} vlMaterialId;
typedef struct vlEmissionId {
  uint32_t index;
} vlEmissionId;
typedef struct vlLightId {
  uint32_t index;
} vlLightId;
typedef struct vlShapeId {
  uint32_t index;
} vlShapeId;
typedef struct vlGroupId {
  uint32_t index;
} vlGroupId; /* 0: the world itself */
typedef struct vlMediumId {
  uint32_t index;
} vlMediumId; /* 0: vacuum */

/* Where in a file something was said; for errors found later. file may be null. Copied. */
typedef struct vlSource {
  const char *file;
  uint32_t line, column;
} vlSource;

typedef enum vlColorSpace { VL_SPACE_SRGB, VL_SPACE_DCI_P3, VL_SPACE_REC2020, VL_SPACE_ACES2065_1 } vlColorSpace;

typedef enum vlSpectrumKind {
  VL_SPECTRUM_CONSTANT,  /* value at every wavelength */
  VL_SPECTRUM_RGB,       /* rgb in space, made a spectrum by the role of the place it stands in */
  VL_SPECTRUM_BLACKBODY, /* kelvin, normalised to maximum 1 */
  VL_SPECTRUM_SAMPLED,   /* count pairs (nm ascending, value): linear between, 0 outside */
  VL_SPECTRUM_NAMED      /* "metal-Au-eta", "glass-BK7", "stdillum-D65", ... see vl_spectrum_names */
} vlSpectrumKind;
/* A spectrum by value. All are multiplied by scale; only the kind's own fields are read. */
typedef struct vlSpectrum {
  vlSpectrumKind kind;
  float scale;
  float value;
  float rgb[3];
  vlColorSpace space;
  float kelvin;
  uint32_t count;
  const float *wavelengths, *values;
  const char *name;
} vlSpectrum;
VL_API vlSpectrum vl_spectrum_constant(float value);
VL_API vlSpectrum vl_spectrum_rgb(float r, float g, float b);
VL_API vlSpectrum vl_spectrum_blackbody(float kelvin);
VL_API vlSpectrum vl_spectrum_named(const char *name);
/* Known names, index from 0; null past the end. */
VL_API const char *vl_spectrum_name(uint32_t index);

/* A parameter that may be textured: the texture where its index is not 0, else the value. */
typedef struct vlFloatInput {
  vlTextureId texture;
  float value;
} vlFloatInput;
typedef struct vlSpectrumInput {
  vlTextureId texture;
  vlSpectrum value;
} vlSpectrumInput;
VL_API vlFloatInput vl_float_input(float value);
VL_API vlSpectrumInput vl_spectrum_input(vlSpectrum value);

/* ---- textures -------------------------------------------------------------------------------------------------- */

/* X(NAME, name) for each kind; what it is and its parameters: velo/schema.h. */
#define VL_TEXTURE_KINDS(X)                                                                                          \
  X(CONSTANT, constant)                                                                                              \
  X(SCALE, scale)                                                                                                    \
  X(MIX, mix)                                                                                                        \
  X(CHECKERBOARD, checkerboard)                                                                                      \
  X(IMAGE, image)                                                                                                    \
  X(DIRECTION_MIX, direction_mix)                                                                                    \
  X(BILERP, bilerp)                                                                                                  \
  X(FBM, fbm)                   /* float: noise of several sizes in texture_from_world, as the next two */           \
  X(WRINKLED, wrinkled)         /* float */                                                                          \
  X(WINDY, windy)               /* float; octaves and roughness are its own */                                       \
  X(MARBLE, marble)             /* colour; scale and variation of its veins */                                       \
  X(DOTS, dots)                 /* a outside of the dots, b inside */                                                \
  X(VERTEX_COLOR, vertex_color) /* the colours of the shape's vertices, with tint, channel, bias, cutoff as an image \
                                 */
typedef enum vlTextureKind {
#define VL_KIND(NAME, name) VL_TEXTURE_##NAME,
  VL_TEXTURE_KINDS(VL_KIND)
#undef VL_KIND
} vlTextureKind;

/* Traits of kinds (vlKindRow.traits). */
enum {
  VL_TEXTURE_FLOAT_ONLY = 1, /* there is no colour texture of the kind */
  VL_TEXTURE_COLOR_ONLY = 2  /* there is no float texture of the kind */
};
typedef enum vlWrap { VL_WRAP_REPEAT, VL_WRAP_BLACK, VL_WRAP_CLAMP, VL_WRAP_OCTAHEDRAL, VL_WRAP_MIRROR } vlWrap;
typedef enum vlTextureFilter {
  VL_FILTER_POINT,     /* nearest texel of the level that fits the footprint */
  VL_FILTER_BILINEAR,  /* between four texels of the finer level */
  VL_FILTER_TRILINEAR, /* and between two levels */
  VL_FILTER_EWA        /* read as trilinear: footprints are round */
} vlTextureFilter;
typedef enum vlMapping { VL_MAPPING_UV, VL_MAPPING_SPHERICAL, VL_MAPPING_CYLINDRICAL, VL_MAPPING_PLANAR } vlMapping;

typedef struct vlTextureDef {
  uint32_t cookie;
  const char *name; /* may be null */
  vlSource source;
  vlTextureKind kind;
  bool spectrum; /* a colour texture; else a float texture. Inputs below: the matching half is read */
  vlFloatInput float_a, float_b, float_c, float_d; /* constant value; scale: tex = a; mix, checkerboard: a, b;
                                                    * bilerp: v00, v01, v10, v11 */
  vlSpectrumInput spectrum_a, spectrum_b, spectrum_c, spectrum_d;
  vlFloatInput amount; /* scale's scale, mix's amount */
  float direction[3];  /* direction mix */
  uint32_t dimension;  /* checkerboard: 2 (s, t by the mapping) or 3 (cubes of unit size in texture_from_world) */
  uint32_t octaves;    /* noise: how many sizes, at most 64; default 8 */
  float omega;         /* each is so much weaker than the one before ("roughness"); default 0.5 */
  float variation;     /* marble; default 0.2 */
  /* image */
  const char *path;     /* read when the world is built (once per path); or */
  const vlImage *image; /* given directly, copied; or */
  const void *data;     /* an image file of data_size bytes in memory, copied */
  size_t data_size;
  vlWrap wrap;
  bool wrap_t_given; /* else as wrap */
  vlWrap wrap_t;
  vlTextureFilter filter;
  bool encoding_given; /* else the file's own (8-bit: sRGB) */
  vlEncoding encoding;
  float gamma;
  float scale; /* factor on image values; marble: on positions */
  bool invert;
  /* After filter, scale and invert: channels times tint, and times the colour of the shape's vertices. A float texture
   * reads one channel (0 to 3; coverage is 1 where the image has none; -1: grey, mean or coverage, by the image)
   * and is bias + that; with a cutoff 1 from it on and 0 below (unset: none). */
  float tint[4];
  bool colors;
  int channel;
  float bias;
  double cutoff;
  vlColorSpace space;
  /* mapping: (s, t) = (su u + du, sv v + dv); others map through texture_from_world */
  vlMapping mapping;
  float su, sv, du, dv;
  float planar_v1[3], planar_v2[3];
  double texture_from_world[16];
  uint32_t uv_set;       /* 0 to 3, of triangles that have several */
  bool st_from_uv_given; /* (s, t) = 2x3 matrix, row by row, times (u, v, 1), instead of su, sv, du, dv */
  float st_from_uv[6];
} vlTextureDef;
VL_API vlTextureDef vl_default_texture_def(vlTextureKind kind, bool spectrum);
VL_API vlTextureId vl_scene_add_texture(vlScene *scene, const vlTextureDef *def);

/* ---- materials ------------------------------------------------------------------------------------------------- */

/* X(NAME, name) for each kind; what it is and its parameters: velo/schema.h. */
#define VL_MATERIAL_KINDS(X)                                                                                          \
  X(DIFFUSE, diffuse)                                                                                                 \
  X(COATED_DIFFUSE, coated_diffuse)                                                                                   \
  X(CONDUCTOR, conductor)                                                                                             \
  X(DIELECTRIC, dielectric)                                                                                           \
  X(THIN_DIELECTRIC, thin_dielectric)                                                                                 \
  X(MIX, mix)                                                                                                         \
  X(PRINCIPLED, principled) /* many layers in one: glTF's metallic-roughness with its extensions */                   \
  X(DIFFUSE_TRANSMISSION, diffuse_transmission)                                                                       \
  X(COATED_CONDUCTOR, coated_conductor)                                                                               \
  X(HAIR, hair)                                                                                                       \
  X(MEASURED, measured)     /* reflection from a file */                                                              \
  X(SUBSURFACE, subsurface) /* a solid that light enters and leaves elsewhere: VL_TRACER_VOLPATH, others see glass */ \
  X(INTERFACE, interface)
typedef enum vlMaterialKind {
#define VL_KIND(NAME, name) VL_MATERIAL_##NAME,
  VL_MATERIAL_KINDS(VL_KIND)
#undef VL_KIND
} vlMaterialKind;

/* Traits of kinds (vlKindRow.traits). */
enum {
  VL_MATERIAL_OPAQUE = 1,   /* no light passes to the other side */
  VL_MATERIAL_METAL = 2,    /* coloured by a conductor's reflection: has no albedo of its own */
  VL_MATERIAL_ROUGH = 4,    /* has microfacets with an alpha */
  VL_MATERIAL_REFRACTS = 8, /* a closed shape of it bends light */
  VL_MATERIAL_ABSENT = 16   /* no surface */
};

/* The principled material, in the words of glTF 2.0 and its KHR_materials extensions; docs/principled.md has the
 * formulas. Its base colour is vlMaterialDef's reflectance, its index of refraction (one number; 0: as dense as can be)
 * eta. The defaults are the extensions': everything beyond metal, roughness and specular is off. */
typedef struct vlPrincipledDef {
  vlFloatInput metallic;             /* 0 to 1; default 1, as roughness */
  vlFloatInput roughness;            /* alpha = roughness^2 */
  vlFloatInput anisotropy;           /* strength, 0 to 1: alpha along the tangent grows towards 1 by its square */
  vlFloatInput anisotropy_rotation;  /* radians from the tangent towards the bitangent */
  vlFloatInput specular;             /* factor on the dielectric's reflection; default 1 */
  vlSpectrumInput specular_color;    /* factor on its reflection at normal incidence; default 1 */
  vlFloatInput transmission;         /* share of the base that light passes instead of being scattered */
  bool thin_walled;                  /* a sheet: light passes unbent; default true (glTF: no thickness) */
  float dispersion;                  /* 20 / Abbe number; not of sheets */
  vlFloatInput diffuse_transmission; /* share of the diffuse light that leaves on the other side */
  vlSpectrumInput diffuse_transmission_color;
  vlFloatInput clearcoat, clearcoat_roughness;
  vlSpectrumInput sheen_color;
  vlFloatInput sheen_roughness;
  vlFloatInput iridescence; /* share that a thin film of thickness (nm) and index covers */
  float iridescence_ior;    /* default 1.3 */
  vlFloatInput iridescence_thickness;
  /* Tangent-space normal maps: linear colour textures (VL_TEXTURE_IMAGE, not clamped), 0: none; x and y are multiplied
   * by the scale. The clear coat has one of its own. */
  vlTextureId normal, clearcoat_normal;
  float normal_scale, clearcoat_normal_scale;
} vlPrincipledDef;

/* Hair (pbrt book 9.9), for curves: their v lies across it. What it absorbs comes from one of three. */
typedef enum vlHairColor {
  VL_HAIR_SIGMA_A,     /* per radius of the hair */
  VL_HAIR_REFLECTANCE, /* vlMaterialDef's reflectance: the colour of many hairs together */
  VL_HAIR_MELANIN      /* concentrations of two pigments */
} vlHairColor;
typedef struct vlHairDef {
  vlHairColor color; /* default: melanin, of eumelanin 1.3 */
  vlSpectrumInput sigma_a;
  vlFloatInput eumelanin, pheomelanin;
  vlFloatInput eta;            /* default 1.55 */
  vlFloatInput beta_m, beta_n; /* roughness along and around, 0 to 1; default 0.3 */
  vlFloatInput alpha;          /* tilt of the scales, degrees; default 2 */
} vlHairDef;

/* A body of scattering substance below a smooth or rough surface (pbrt book, 3rd edition, 11.4): coefficients per unit
 * of length, textured or not, times vlMaterialDef's scale; or what a thick piece reflects (vlMaterialDef's reflectance)
 * and the mean free path, times scale. Its eta (one number, 0.5 to 2.5) and g are vlMaterialDef's. */
typedef struct vlSubsurfaceDef {
  bool from_reflectance;
  vlSpectrumInput sigma_a, sigma_s; /* default: whole milk, per millimetre */
  vlSpectrumInput mfp;              /* default 1 */
} vlSubsurfaceDef;

/* One flat struct; the defaults of vl_default_material_def(kind) are pbrt-v4's. */
typedef struct vlMaterialDef {
  uint32_t cookie;
  const char *name;
  vlSource source;
  vlMaterialKind kind;
  vlSpectrumInput reflectance; /* diffuse, coated diffuse, diffuse transmission; metals when use_reflectance */
  bool use_reflectance;
  vlFloatInput u_roughness, v_roughness;
  bool remap_roughness;        /* alpha = sqrt(roughness), pbrt book 9.6 */
  vlSpectrumInput eta, k;      /* metals: both; dielectrics and the coat of what is diffuse: eta (no texture) */
  vlFloatInput thickness, g;   /* coat; thickness not textured over what is diffuse. g: subsurface, too, untextured */
  vlSpectrumInput albedo;      /* of the coat's medium; 0: it absorbs only */
  uint32_t max_depth, samples; /* coat: bounces inside; random walks for each look at it, where it takes walks */
  /* Coated diffuse, of a medium that only absorbs and is not textured: a rough coat loses no light (pbrt's loses what
   * scatters between its microfacets more than once, 40 % at alpha 0.4 over white), and max_depth is not read. */
  bool conserve_energy;
  vlFloatInput amount; /* mix: share of the second */
  vlMaterialId materials[2];
  vlFloatInput displacement; /* bump map; texture index 0: none */
  const char *normal_map;    /* path, null: none; linear, tangent space */
  vlPrincipledDef principled;
  vlSpectrumInput transmittance;                   /* diffuse transmission */
  float scale;                                     /* diffuse transmission: on both; subsurface: see there */
  vlFloatInput coat_u_roughness, coat_v_roughness; /* coated conductor: of the coat; the others are the metal's */
  vlSpectrumInput coat_eta;                        /* no texture */
  vlHairDef hair;
  const char *measured; /* path of a file with spectra of the RGL material database (Dupuy and Jakob 2018) */
  vlSubsurfaceDef subsurface;
} vlMaterialDef;
VL_API vlMaterialDef vl_default_material_def(vlMaterialKind kind);
VL_API vlMaterialId vl_scene_add_material(vlScene *scene, const vlMaterialDef *def);

/* ---- participating media --------------------------------------------------------------------------------------- */

/* X(NAME, name) for each kind; its parameters: velo/schema.h. Homogeneous: the same everywhere. Grid: sigma_a and
 * sigma_s times a density on a grid over a box; RGB grid: sigma_a and sigma_s themselves on a grid. Cloud: times a
 * procedural density (pbrt-v4's cloud). NanoVDB: times a density from a NanoVDB file. */
#define VL_MEDIUM_KINDS(X)    \
  X(HOMOGENEOUS, homogeneous) \
  X(GRID, grid)               \
  X(RGB_GRID, rgb_grid)       \
  X(CLOUD, cloud)             \
  X(NANOVDB, nanovdb)
typedef enum vlMediumKind {
#define VL_KIND(NAME, name) VL_MEDIUM_##NAME,
  VL_MEDIUM_KINDS(VL_KIND)
#undef VL_KIND
} vlMediumKind;

/* What fills the space between surfaces (pbrt book 11). Coefficients are per world unit of length, whatever the
 * medium's transform. Light is scattered by the Henyey-Greenstein phase function. Outside its box a medium of a kind
 * that has one is empty. */
typedef struct vlMediumDef {
  uint32_t cookie;
  const char *name; /* may be null */
  vlSource source;
  vlMediumKind kind;
  vlSpectrum sigma_a, sigma_s; /* absorption, scattering; default 1; not of RGB grids */
  float scale;                 /* factor on both */
  float g;                     /* mean cosine of scattering, -1 to 1 */
  /* sigma_a holds for each channel of linear sRGB: of a channel exp(-sigma_a x) is left after a way x, as glTF means
   * it, in both colour modes, however long the way is and however many pieces it has (docs/media.md). Homogeneous media
   * without emission, sigma_a an RGB value or a constant. Default false: sigma_a is a spectrum, as in pbrt. */
  bool rgb_absorption;
  /* Radiance given out where light is absorbed (sigma_a times this per length), divided by its own luminance as that of
   * lights; times emission_scale. Homogeneous and grid. */
  vlSpectrum emission;
  float emission_scale;
  double world_from_medium[16];
  /* grids: nx * ny * nz values, x fastest, at the centres of equal cells of the box low, high; between them linear,
   * towards 0 at the box's faces. May be null but for density. */
  uint32_t nx, ny, nz;
  float low[3], high[3]; /* of clouds, too */
  const float *density, *emission_scales;
  const float *temperature;                    /* kelvin: a black body emits light in place of `emission` */
  float temperature_offset, temperature_scale; /* kelvin = (value - offset) * scale; below 100 nothing emits light */
  const float *rgb_a, *rgb_s, *rgb_emission;   /* RGB grid, 3 numbers a cell, of `space`; null coefficients: 1 */
  vlColorSpace space;
  float cloud_density, wispiness, frequency; /* cloud */
  const char *path;                          /* NanoVDB file */
  const char *grid, *temperature_grid;       /* names of its grids; null: density, temperature (which may be absent) */
} vlMediumDef;
VL_API vlMediumDef vl_default_medium_def(vlMediumKind kind);
/* Errors, sticky: negative coefficients or values, sizes of no cells, boxes without room, numbers not finite. */
VL_API vlMediumId vl_scene_add_medium(vlScene *scene, const vlMediumDef *def);

/* ---- lights ---------------------------------------------------------------------------------------------------- */

/* Light that surfaces give out. Radiance = scale * L normalised so that its luminance Y is 1 for L of Y = 1 (pbrt's
 * SpectrumToPhotometric convention, book 12.1: named, blackbody and sampled spectra are divided by their own Y). */
typedef struct vlEmissionDef {
  uint32_t cookie;
  vlSource source;
  vlSpectrum radiance;
  float scale;
  double power; /* watts (pbrt's "power"); VL_UNSET: from radiance */
  bool two_sided;
  const char *image;   /* emission image over uv, null: none; or */
  vlTextureId texture; /* a colour texture of an image (VL_TEXTURE_IMAGE), times scale; colour is ignored */
} vlEmissionDef;
VL_API vlEmissionDef vl_default_emission_def(void);
VL_API vlEmissionId vl_scene_add_emission(vlScene *scene, const vlEmissionDef *def);

/* X(NAME, name) for each kind; what it is and its parameters: velo/schema.h. A goniometric light's image is an
 * equal-area octahedral square (pbrt book 3.8.3) whose axis is the light's y; a projection light throws its image along
 * z, y up, and the image is the intensity. */
#define VL_LIGHT_KINDS(X)     \
  X(POINT, point)             \
  X(SPOT, spot)               \
  X(DISTANT, distant)         \
  X(INFINITE, infinite)       \
  X(GONIOMETRIC, goniometric) \
  X(PROJECTION, projection)
typedef enum vlLightKind {
#define VL_KIND(NAME, name) VL_LIGHT_##NAME,
  VL_LIGHT_KINDS(VL_KIND)
#undef VL_KIND
} vlLightKind;
typedef struct vlLightDef {
  uint32_t cookie;
  vlSource source;
  vlLightKind kind;
  vlSpectrum color; /* intensity I (point, spot) or radiance L (distant, infinite) */
  float scale;
  double power;       /* all at a point: total watts; VL_UNSET */
  double illuminance; /* distant, infinite: lux; VL_UNSET */
  double world_from_light[16];
  float from[3], to[3];         /* light space: point's position is from; spot and distant shine from -> to */
  float cone_angle, cone_delta; /* spot, radians */
  bool cone_squared;            /* its edge is t^2 in the cosine, as in glTF; else pbrt's smooth step 3t^2 - 2t^3 */
  const char *path;             /* infinite: equal-area octahedral image (pbrt book 3.8.3), square; null: uniform */
  const vlImage *image;         /* or given directly, copied */
  vlColorSpace space;           /* of the image (radiance, times scale; colour is ignored) if it names none itself */
  vlMediumId medium;            /* that it stands in */
  float fov;                    /* projection: radians across the image's smaller side; default a right angle */
  /* Infinite with an image: seen only through a rectangle of the world, its corners one after the other, in directions
   * to the side that (last - first) x (second - first) points to. What has no such light is dark. */
  bool has_portal;
  float portal[4][3];
} vlLightDef;
VL_API vlLightDef vl_default_light_def(vlLightKind kind);
VL_API vlLightId vl_scene_add_light(vlScene *scene, const vlLightDef *def);

/* ---- shapes ---------------------------------------------------------------------------------------------------- */

/* X(NAME, name) for each kind; what it is and its parameters: velo/schema.h. Curves are hairs and the like: cubic
 * Bezier segments with a width. */
#define VL_SHAPE_KINDS(X) \
  X(TRIANGLES, triangles) \
  X(BILINEAR, bilinear)   \
  X(SPHERE, sphere)       \
  X(DISK, disk)           \
  X(CYLINDER, cylinder)   \
  X(CURVES, curves)
typedef enum vlShapeKind {
#define VL_KIND(NAME, name) VL_SHAPE_##NAME,
  VL_SHAPE_KINDS(VL_KIND)
#undef VL_KIND
} vlShapeKind;
typedef enum vlCurveKind {
  VL_CURVE_FLAT,     /* faces every ray */
  VL_CURVE_CYLINDER, /* so does this one, with the normal of a tube */
  VL_CURVE_RIBBON    /* lies across its normals */
} vlCurveKind;

typedef struct vlShapeDef {
  uint32_t cookie;
  vlSource source;
  vlShapeKind kind;
  vlGroupId group;             /* 0: the world; else part of a group that instances place */
  double group_from_shape[16]; /* shape space to group (or world) space */
  /* pbrt-v4's rule for the side of normals: dpdu x dpdv (of a triangle: by the order of its corners) in shape space
   * goes by the inverse transpose to group space, and is flipped there if reverse_orientation differs from
   * "group_from_shape mirrors". So a mirrored mesh keeps its outside, but a sphere, disk, cylinder or curve under a
   * mirroring group_from_shape turns its normals over. Instances never flip: the side goes with the shape. Vertex
   * normals decide where there are some; only reverse_orientation turns them. */
  bool reverse_orientation;
  vlMaterialId material; /* 0: a default diffuse 0.5 */
  vlFloatInput alpha;    /* coverage; value 1: opaque */
  vlEmissionId emission; /* 0: none */
  /* Media on both sides; the normal points to the outside. Equal ones (so nothing at all, too) say that the shape lies
   * in whatever medium is there. */
  vlMediumId inside, outside;
  /* triangles: 3 indices a face; bilinear: 4 (pbrt's order p00 p10 p01 p11). Shape space. normals, tangents, uvs may
   * be null. */
  uint32_t vertices, faces;
  const float *positions; /* 3 a vertex */
  const float *normals;   /* 3 a vertex */
  const float *tangents;  /* 3 a vertex, pbrt's S */
  const float *uvs;       /* 2 a vertex */
  const uint32_t *indices;
  /* Triangles, may be null: */
  const float *tangent_signs; /* 1 a vertex: the bitangent is sign * n x tangent; null: 1 */
  const float *more_uvs[3];   /* 2 a vertex: uv sets 1 to 3 */
  const float *colors;        /* 4 a vertex: linear R G B and coverage */
  bool one_sided;             /* triangles: rays pass through their backs */
  /* Triangles on the move: where the vertices (and normals) are at times[1], seconds, those above being for times[0];
   * straight between, at rest before and after. May be null. Such a mesh cannot emit light. */
  const float *positions_close, *normals_close;
  double times[2]; /* default 0, 1 */
  /* Triangles at rest: a float texture moves them along their normals (index 0: none), once they are so fine that no
   * edge is longer than edge_length in the group's space; 2^24 triangles at most, else vl_world_build fails. */
  vlFloatInput displacement;
  float edge_length; /* default 1 */
  /* sphere, disk, cylinder: pbrt's, z axis, book 6.2-6.4; angles in radians */
  float radius, inner_radius, z_min, z_max, height, phi_max;
  /* Many whole spheres as one shape, 28 bytes each (a sphere of its own takes some 750): `faces` of them, with centres
   * in shape space; the numbers above are not read. Both null: one sphere at the origin. They cannot emit light. */
  const double *centers; /* 3 a sphere */
  const float *radii;    /* 1 a sphere, > 0 */
  /* curves: `faces` segments, the 4 Bezier points of each in positions (vertices = 4 faces). They cannot emit light. Of
   * a image's coordinates u goes along a segment, v from one side to the other. Ribbons: normals at both ends of each
   * segment (6 numbers a face). Segments are cut into 2^split_depth pieces for speed, fewer where there are millions;
   * the image does not depend on it. */
  vlCurveKind curve;
  const float *widths;  /* 2 a face, at its ends, in shape space */
  uint32_t split_depth; /* default 3 */
} vlShapeDef;
VL_API vlShapeDef vl_default_shape_def(vlShapeKind kind);
/* Errors (sticky): index out of range, position or normal that is not finite (the vertex is named), radius <= 0 ... */
VL_API vlShapeId vl_scene_add_shape(vlScene *scene, const vlShapeDef *def);

VL_API vlGroupId vl_scene_add_group(vlScene *scene, const char *name);
/* Places a group in the world (groups do not nest). */
VL_API void vl_scene_add_instance(vlScene *scene, vlGroupId group, const double world_from_group[16], vlSource source);
/* One on the move: `keys` poses (16 numbers each) at times, in seconds, that ascend; between them translation, rotation
 * and stretch each go their own way (math/motion.h says how), before the first and after the last it rests. Errors,
 * sticky: a pose that is singular, one that mirrors while the next does not, times that do not ascend. */
VL_API void vl_scene_add_moving_instance(vlScene *scene, vlGroupId group, uint32_t keys, const double *times,
                                         const double *world_from_group, vlSource source);

/* ---- how the image is to be taken: the scene file's own choices, defaults otherwise ---------------------------- */

/* X(NAME, name) for each tracer; what pbrt files call it: velo/schema.h. Those that follow light both ways
 * (docs/tracers.md): with solids that light goes through (VL_MATERIAL_SUBSURFACE), or where something moves while the
 * camera's rows are read out, VL_TRACER_VOLPATH stands in. */
#define VL_TRACER_KINDS(X)                                                                                            \
  X(PATH, path) /* ignores media */                                                                                   \
  X(RAYCAST, raycast)                                                                                                 \
  X(AMBIENT_OCCLUSION, ambient_occlusion)                                                                             \
  X(VOLPATH, volpath)             /* through media and solids; where there are none the same as PATH, to the bit */   \
  X(BIDIRECTIONAL, bidirectional) /* paths from the camera, and paths from the lights that it sees; unbiased */       \
  X(MERGING, merging)             /* and both meet at surfaces, within a radius that shrinks with each pass */        \
  X(SPPM, sppm)                   /* the same; smooth surfaces on the camera's path are no bounces, as pbrt counts */ \
  X(LIGHT_PATH, light_path)       /* from the lights alone: no light through or in what is smooth */                  \
  X(RANDOM_WALK, random_walk)     /* samples no light and scatters all over the sphere: for comparison */
typedef enum vlTracer {
#define VL_KIND(NAME, name) VL_TRACER_##NAME,
  VL_TRACER_KINDS(VL_KIND)
#undef VL_KIND
} vlTracer;
/* X(NAME, name) for each sampler; what it is and what pbrt files call it: velo/schema.h. */
#define VL_SAMPLER_KINDS(X)         \
  X(INDEPENDENT, independent)       \
  X(REGULAR, regular)               \
  X(STRATIFIED, stratified)         \
  X(NROOKS, nrooks)                 \
  X(MULTI_JITTERED, multi_jittered) \
  X(HAMMERSLEY, hammersley)         \
  X(HALTON, halton)                 \
  X(SOBOL, sobol)                   \
  X(ZSOBOL, zsobol)
typedef enum vlSamplerKind {
#define VL_KIND(NAME, name) VL_SAMPLER_##NAME,
  VL_SAMPLER_KINDS(VL_KIND)
#undef VL_KIND
} vlSamplerKind;
/* X(NAME, name) for each kind; what it is and its parameters: velo/schema.h. */
#define VL_PIXEL_FILTER_KINDS(X) \
  X(BOX, box)                    \
  X(TRIANGLE, triangle)          \
  X(GAUSSIAN, gaussian)          \
  X(MITCHELL, mitchell)          \
  X(LANCZOS, lanczos)            \
  X(BLACKMAN_HARRIS, blackman_harris)
typedef enum vlPixelFilterKind {
#define VL_KIND(NAME, name) VL_PIXEL_FILTER_##NAME,
  VL_PIXEL_FILTER_KINDS(VL_KIND)
#undef VL_KIND
} vlPixelFilterKind;
typedef struct vlPixelFilter {
  vlPixelFilterKind kind;
  float radius_x, radius_y; /* pixels */
  float sigma;              /* gaussian */
  float b, c;               /* Mitchell */
  float tau;                /* Lanczos */
} vlPixelFilter;
VL_API vlPixelFilter vl_default_pixel_filter(vlPixelFilterKind kind); /* pbrt-v4's default sizes */
typedef enum vlGbuffer { VL_GBUFFER_NONE, VL_GBUFFER_CAMERA, VL_GBUFFER_WORLD } vlGbuffer;
typedef enum vlColorMode { VL_COLOR_SPECTRAL, VL_COLOR_RGB } vlColorMode;
typedef enum vlLightSampler { VL_LIGHT_SAMPLER_BVH, VL_LIGHT_SAMPLER_POWER, VL_LIGHT_SAMPLER_UNIFORM } vlLightSampler;

/* How the image is taken: camera, film, build, render and develop, as the scene's file says (velo/render.h). The scene
 * owns it, and what its pointers point at; never null. May be changed until the scene is destroyed. */
typedef struct vlSceneDefs vlSceneDefs;
VL_API vlSceneDefs *vl_scene_defs(vlScene *scene);
/* Camera, image size and crop of another scene of the same context; what its lens needs ignores, so that `from`
 * may go. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_take_camera(vlScene *scene, vlScene *from, vlError *error);
/* Focuses the scene's camera, one with a lens of many elements, at a distance from its film. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_refocus(vlScene *scene, double distance, vlError *error);

VL_API vlResult vl_scene_create(vlContext *context, vlScene **scene);
VL_API void vl_scene_destroy(vlScene *scene);
/* The first error, VL_OK if none. error may be null. */
VL_API vlResult vl_scene_result(const vlScene *scene, vlError *error);

typedef struct vlLoadDef {
  uint32_t cookie;
  bool permissive; /* what is not understood yet is a warning, not an error */
  /* glTF; others pass it over */
  double time;           /* of animations, seconds; unset: as modelled */
  double time_close;     /* the shutter closes then, later than time: what moves is blurred; unset: still */
  const char *scene;     /* name or number from 0; null: the file's own choice */
  const char *animation; /* name or number from 0; null: the first */
  const char *variant;   /* of materials, by name; null: the file's own */
  const char *camera;    /* name or number from 0; null: the first */
} vlLoadDef;
VL_API vlLoadDef vl_default_load_def(void);
/* Adds what a file says. The format is chosen by suffix (.pbrt, .gltf, .glb, .obj, .ply, .gz after pbrt, obj, ply);
 * relative names are relative to the file. Errors: SCENE, MISSING, IO, MEMORY, UNSUPPORTED (as SCENE with a clear
 * message). def may be null. */
VL_API vlResult vl_scene_load(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);

/* What a scene that a file describes may lack: a camera, light, a ground to stand on. */
typedef enum vlEnvironmentKind {
  VL_ENVIRONMENT_AUTO,   /* the studio where vlSceneDefs.light_missing; dim where there are lamps */
  VL_ENVIRONMENT_NONE,   /* none is added */
  VL_ENVIRONMENT_STUDIO, /* neutral: soft lights in a grey room, brighter than it above and in front */
  VL_ENVIRONMENT_SKY,    /* a clear sky and the sun */
  VL_ENVIRONMENT_WHITE,  /* radiance 1 from everywhere */
  VL_ENVIRONMENT_FILE    /* path */
} vlEnvironmentKind;
typedef struct vlCompleteDef {
  uint32_t cookie;
  uint32_t width, height; /* of the image, for framing and where the file says none; 0: the film's */
  vlEnvironmentKind environment;
  const char *path;       /* an image twice as wide as high (longitude, latitude; its centre lies ahead of one who looks
                           * along -front) or square (equal-area octahedral) */
  double rotation;        /* radians about up, counter-clockwise from above */
  float strength;         /* factor on the environment's radiance */
  double up[3], front[3]; /* of the world; default +y, +z (glTF's) */
  bool ground;            /* a wide grey disk under everything */
  bool reframe;           /* a new camera even where the file has one */
} vlCompleteDef;
VL_API vlCompleteDef vl_default_complete_def(void);
/* Adds what is missing (vlSceneDefs.camera_missing, light_missing) or asked for. The camera sees everything from the
 * front, a little from the right and above. def may be null. Errors: as vl_scene_result; MISSING, IO (path). */
VL_API vlResult vl_scene_complete(vlScene *scene, const vlCompleteDef *def, vlError *error);

typedef struct vlSceneInfo {
  uint64_t shapes, triangles, vertices, textures, materials, lights, emissive_shapes, groups, instances, media;
} vlSceneInfo;
VL_API void vl_scene_info(const vlScene *scene, vlSceneInfo *info);

#ifdef __cplusplus
}
#endif
#endif
