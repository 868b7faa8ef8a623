/** @file
 * velo/schema.h: a table row for each kind of thing in a scene: its name in files, its
 * parameters (type, unit, default, range, offset in the def) and its traits. The scene's
 * defaults and range checks, the importers, the exporters and the tables of the documentation
 * all read these rows. Constant data: any thread may read it at any time; never freed. */
#ifndef VELO_SCHEMA_H
#define VELO_SCHEMA_H

#include <stddef.h>

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The lists of kinds are VL_MATERIAL_KINDS and the like (velo/scene.h): LIST(X) expands X(kind,
 * name) once per kind, in the order of the enum: its constant and the end of it in lower
 * letters. What follows is of the library: the kind's row, its functions. */

/** How a parameter is stored in its def. */
typedef enum vlParameterType {
  VL_PARAMETER_BOOL,           /**< bool */
  VL_PARAMETER_COUNT,          /**< uint32_t */
  VL_PARAMETER_FLOAT,          /**< float */
  VL_PARAMETER_DOUBLE,         /**< double */
  VL_PARAMETER_FLOAT3,         /**< float[3]: a point, a vector */
  VL_PARAMETER_DOUBLE3,        /**< double[3]: the same */
  VL_PARAMETER_CHOICE,         /**< an enum: one of `choices` */
  VL_PARAMETER_STRING,         /**< const char * */
  VL_PARAMETER_FILE,           /**< const char *: a path */
  VL_PARAMETER_SPECTRUM,       /**< vlSpectrum */
  VL_PARAMETER_FLOAT_INPUT,    /**< vlFloatInput: a number or a float texture */
  VL_PARAMETER_SPECTRUM_INPUT, /**< vlSpectrumInput: a spectrum or a spectrum texture */
  VL_PARAMETER_EITHER_INPUT,   /**< textures: a vlFloatInput at offset, a vlSpectrumInput at
                                  second; chosen by the def */
  VL_PARAMETER_TEXTURE,        /**< vlTextureId of a spectrum texture; 0: none */
  VL_PARAMETER_BLOCK /**< anything else (arrays, pointers to numbers): described only, not read
                        or written by rows */
} vlParameterType;

/** The role of a spectrum parameter; it decides how an RGB value becomes a spectrum. */
typedef enum vlParameterRole {
  VL_PARAMETER_NO_ROLE,   /**< not a spectrum, or the role of the parameter where a texture is
                             used */
  VL_PARAMETER_ALBEDO,    /**< a reflectance or transmittance, 0 to 1 */
  VL_PARAMETER_UNBOUNDED, /**< any value from 0 */
  VL_PARAMETER_ILLUMINANT /**< of a light: times the colour space's white */
} vlParameterRole;

/** Bits of vlParameter.flags. */
enum {
  VL_PARAMETER_REQUIRED = 1,   /**< has no default */
  VL_PARAMETER_NO_TEXTURE = 2, /**< an input that takes no texture */
  VL_PARAMETER_NUMBER = 4,     /**< a spectrum that may be written as one number */
  VL_PARAMETER_ONE_NUMBER = 8, /**< a spectrum that must be one number */
  VL_PARAMETER_UNSET = 16,     /**< a double that may be VL_UNSET, which is the default */
  VL_PARAMETER_RGB = 32,       /**< the default spectrum is RGB: all three numbers of `value` */
  VL_PARAMETER_CLAMPED =
      64, /**< values out of range are clamped when used; without this flag they are errors */
  VL_PARAMETER_ABOVE_LOW = 128,  /**< low itself is out of range */
  VL_PARAMETER_BELOW_HIGH = 256, /**< high itself is out of range */
  VL_PARAMETER_INFINITE = 512,   /**< may be infinite */
  VL_PARAMETER_RULE =
      1024, /**< read and written by a function of the kind, not by the generic code */
  VL_PARAMETER_FILE_NUMBER =
      4096, /**< a number in pbrt files, never a texture; a def may have a texture */
  VL_PARAMETER_SHORTHAND =
      2048, /**< in files only: sets members that other parameters set one by one */
  VL_PARAMETER_VECTOR =
      8192, /**< three numbers that files call a vector; without this flag a point */
  VL_PARAMETER_OWN = 16384 /**< velo's own: pbrt-v4's kind of this name has no such parameter */
};

/** A parameter of a kind. */
typedef struct vlParameter {
  const char *name;        /**< in pbrt files; null: not in files */
  const char *alias;       /**< another name in files; `name` takes precedence; may be null */
  const char *member;      /**< path in the def, for documentation: "hair.beta_m" */
  const char *keyword;     /**< of calls and of velo/setting.h; null: the last word of member */
  const char *description; /**< one line */
  const char *unit;        /**< of the value in files: "nm", "degrees"; null: none */
  vlParameterType type;    /**< how it is stored */
  vlParameterRole role;    /**< of a spectrum */
  uint32_t flags;          /**< VL_PARAMETER_REQUIRED and so on */
  size_t offset, size;     /**< of the value, in bytes from the start of the def */
  size_t second;           /**< of another member that gets the same value; 0: none */
  double factor;           /**< value in the def = factor * value in files; 0 is read as 1 */
  double value[3];  /**< default: a number (of a bool 0 or 1, of a choice its index), or three.
                       In the def's unit */
  const char *text; /**< default of strings; name of a spectrum (vl_spectrum_name); of a BLOCK:
                       its type in files */
  double low, high; /**< range, in the def's unit; no limits where both are 0 */
  /** names in files, ending with null; index = value of the enum */
  const char *const *choices;
} vlParameter;

/** A kind of a family. */
typedef struct vlKindRow {
  const char *name;              /**< in pbrt files; null: files cannot name it */
  const char *alias;             /**< another name that files may use; null: none */
  const char *description;       /**< one line */
  uint32_t traits;               /**< bits of the family: VL_MATERIAL_OPAQUE and so on */
  const vlParameter *parameters; /**< the parameters */
  uint32_t parameter_count;      /**< length of parameters */
} vlKindRow;

/** A family of kinds: textures, materials, media, lights, shapes and so on. */
typedef struct vlKindFamily {
  const char *name;         /**< "materials" */
  const char *thing;        /**< "material", for messages */
  const char *directive;    /**< in pbrt files: "Material" */
  uint32_t kind_count;      /**< values of the enum: 0 to kind_count - 1 */
  const char *const *words; /**< "coated_diffuse": how the names of the enum's constants end */
  const vlKindRow *const *rows; /**< one per kind, never null */
} vlKindFamily;

/** Traits of samplers, filters, tracers: the name, or the alias, is one of pbrt's; the others
 * are velo's own. */
enum { VL_TRAIT_PBRT_NAME = 1, VL_TRAIT_PBRT_ALIAS = 2 };

/** Traits of tracers. */
enum {
  VL_TRACER_TRAIT_NO_MEDIA =
      4 /**< looks past media and into subsurface materials as into clear glass */
};

/** Traits of samplers. */
enum {
  VL_SAMPLER_TRAIT_OPEN =
      4 /**< can go on without end; the others lay out a fixed number of samples */
};

/** Traits of pixel filters. */
enum {
  VL_FILTER_TRAIT_POSITIVE =
      4 /**< nowhere below 0, whatever its parameters: neighbouring pixels can share samples */
};

/** X(kind, name) for each film of pbrt files. */
#define VL_FILM_KINDS(X)      \
  X(VL_FILM_RGB, rgb)         \
  X(VL_FILM_GBUFFER, gbuffer) \
  X(VL_FILM_SPECTRAL, spectral)
/** The films of pbrt files. */
typedef enum vlFilmKind {
#define VL_KIND(kind, name) kind,
  VL_FILM_KINDS(VL_KIND)
#undef VL_KIND
} vlFilmKind;

/** Traits of materials. */
enum {
  VL_MATERIAL_OPAQUE = 1, /**< transmits no light */
  VL_MATERIAL_METAL = 2,  /**< a conductor: its colour is the colour of its specular reflection,
                             and it has no albedo */
  VL_MATERIAL_ROUGH = 4,  /**< has a microfacet distribution with an alpha */
  VL_MATERIAL_REFRACTS = 8, /**< a closed shape of this material refracts light */
  VL_MATERIAL_ABSENT = 16   /**< not a visible surface; it only separates media */
};

/** Traits of lights. */
enum {
  VL_LIGHT_TRAIT_AT_POINT = 1, /**< it emits from one point */
  VL_LIGHT_TRAIT_FAR = 2,      /**< it is infinitely far away, so no medium surrounds it */
  VL_LIGHT_TRAIT_DELTA = 4, /**< no ray can hit it. A light without this trait is FAR: rays that
                               leave the scene hit it */
  VL_LIGHT_TRAIT_AIMS = 8,  /**< its `from` and `to` must differ */
  VL_LIGHT_TRAIT_IMAGE = 16 /**< it requires an image */
};

/** Traits of shapes. */
enum {
  VL_SHAPE_TRAIT_MESH = 1, /**< given by vertices and faces */
  VL_SHAPE_TRAIT_QUADRIC =
      2, /**< given by numbers: radius, z_min, z_max, height, inner_radius, phi_max */
  VL_SHAPE_TRAIT_EMITS = 4 /**< may be an area light */
};

/** Traits of media. */
enum {
  VL_MEDIUM_TRAIT_BOX = 1,  /**< bounded by the box from `low` to `high` */
  VL_MEDIUM_TRAIT_CELLS = 2 /**< that box is a grid of nx * ny * nz cells */
};

/** The families, index from 0; null past the end. */
VL_API const vlKindFamily *vl_kind_family(uint32_t index);
/** The family with that name ("materials"); null: there is none. Any thread. */
VL_API const vlKindFamily *vl_kind_family_find(const char *name);

#ifdef __cplusplus
}
#endif
#endif
