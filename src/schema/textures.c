/* schema/textures.c: rows of the textures. Names in files and defaults are pbrt-v4's. */
#include "schema/schema.h"
#include "velo/texture.h"

#define BOOL(...) VL_PARAMETER(BOOL, vlTextureDef, __VA_ARGS__)
#define COUNT(...) VL_PARAMETER(COUNT, vlTextureDef, __VA_ARGS__)
#define FLOAT(...) VL_PARAMETER(FLOAT, vlTextureDef, __VA_ARGS__)
#define DOUBLE(...) VL_PARAMETER(DOUBLE, vlTextureDef, __VA_ARGS__)
#define VECTOR(...) VL_PARAMETER(FLOAT3, vlTextureDef, __VA_ARGS__)
#define CHOICE(...) VL_PARAMETER(CHOICE, vlTextureDef, __VA_ARGS__)
#define FILE_NAME(...) VL_PARAMETER(FILE, vlTextureDef, __VA_ARGS__)
#define NUMBER(...) VL_PARAMETER(FLOAT_INPUT, vlTextureDef, __VA_ARGS__)
#define BLOCK(...) VL_PARAMETER(BLOCK, vlTextureDef, __VA_ARGS__)
/* An input of the texture's own type; half: a, b, c or d. */
#define INPUT(name, half, text, value)                                                  \
  VL_PARAMETER(EITHER_INPUT, vlTextureDef, name, float_##half, text, VL_DEFAULT(value), \
               VL_SECOND(vlTextureDef, spectrum_##half))

static const char *const mappings[] = {"uv", "spherical", "cylindrical", "planar", NULL};
static const char *const wraps[] = {"repeat", "black", "clamp", "octahedralsphere", "mirror", NULL};
static const char *const filters[] = {"point", "bilinear", "trilinear", "ewa", NULL};
static const char *const spaces[] = {"srgb", "dci-p3", "rec2020", "aces2065-1", NULL};

/* Parameters that several kinds share. */
#define PLACE BLOCK(NULL, texture_from_world, "4 x 4 matrix, row-major, from world space to texture space")
#define MAPPING                                                                                                        \
  CHOICE("mapping", mapping, "how the texture coordinates (s, t) follow from the surface point", .choices = mappings), \
      FLOAT("uscale", su, "mapping uv: s = uscale * u + udelta", VL_DEFAULT(1)),                                       \
      FLOAT("vscale", sv, "mapping uv: t = vscale * v + vdelta", VL_DEFAULT(1)),                                       \
      FLOAT("udelta", du, "mappings uv and planar: offset of s", VL_DEFAULT(0)),                                       \
      FLOAT("vdelta", dv, "mappings uv and planar: offset of t", VL_DEFAULT(0)),                                       \
      VECTOR("v1", planar_v1, "mapping planar: s = v1 . p + udelta, p in texture space", VL_DEFAULT(1, 0, 0)),         \
      VECTOR("v2", planar_v2, "mapping planar: t = v2 . p + vdelta, p in texture space", VL_DEFAULT(0, 1, 0)), PLACE,  \
      COUNT(NULL, uv_set, "number of the uv set, for triangles that have several", VL_RANGE(0, 3)),                    \
      BOOL(NULL, st_from_uv_given, "true: st_from_uv replaces su, sv, du and dv"),                                     \
      BLOCK(NULL, st_from_uv, "2 x 3 matrix, row-major: (s, t) is this matrix times (u, v, 1)")
#define OCTAVES                                                                                           \
  COUNT("octaves", octaves, "number of octaves of noise that are summed", VL_DEFAULT(8), VL_RANGE(0, 64), \
        .flags = VL_PARAMETER_CLAMPED),                                                                   \
      FLOAT("roughness", omega, "amplitude of each octave, relative to the one before", VL_DEFAULT(0.5)), PLACE
/* The parameters that follow filter, scale and invert. */
#define CHANNELS                                                                                                   \
  BLOCK(NULL, tint, "factors on R, G, B and alpha"),                                                               \
      BOOL(NULL, colors, "true: multiply by the colours of the shape's vertices"),                                 \
      BLOCK(NULL, channel,                                                                                         \
            "channel that a float texture reads: 0 to 3, or -1: the mean of the colours, or alpha, by the image"), \
      FLOAT(NULL, bias, "number added to the value of a float texture", VL_DEFAULT(0)),                            \
      DOUBLE(NULL, cutoff,                                                                                         \
             "a float texture becomes 1 where its value is at least the cutoff, otherwise 0; unset: not changed",  \
             .flags = VL_PARAMETER_UNSET)

/* ---- of inputs --------------------------------------------------------------------------------------------------- */

static const vlParameter constant_parameters[] = {INPUT("value", a, "the texture's value", 1)};
VL_KIND_ROW(constant, .name = "constant", .description = "the same value everywhere")

static const vlParameter scale_parameters[] = {
    INPUT("tex", a, "the texture that is scaled", 1),
    NUMBER("scale", amount, "factor on the texture", VL_DEFAULT(1)),
};
VL_KIND_ROW(scale, .name = "scale", .description = "a texture multiplied by a number")

static const vlParameter mix_parameters[] = {
    INPUT("tex1", a, "the first texture", 0),
    INPUT("tex2", b, "the second texture", 1),
    NUMBER("amount", amount, "fraction of the second texture", VL_DEFAULT(0.5)),
};
VL_KIND_ROW(mix, .name = "mix", .description = "linear interpolation between two textures")

static const vlParameter direction_mix_parameters[] = {
    INPUT("tex1", a, "texture where the surface normal is parallel to dir", 0),
    INPUT("tex2", b, "texture where the surface normal is perpendicular to dir", 1),
    VECTOR("dir", direction, "the direction with which the normal is compared; its length has no effect",
           VL_DEFAULT(0, 1, 0)),
};
VL_KIND_ROW(direction_mix, .name = "directionmix",
            .description = "interpolation between two textures by |n . dir|, n the surface normal")

static const vlParameter bilerp_parameters[] = {
    INPUT("v00", a, "value at (s, t) = (0, 0)", 0),
    INPUT("v01", b, "value at (s, t) = (0, 1)", 1),
    INPUT("v10", c, "value at (s, t) = (1, 0)", 0),
    INPUT("v11", d, "value at (s, t) = (1, 1)", 1),
    MAPPING,
};
VL_KIND_ROW(bilerp, .name = "bilerp", .description = "bilinear interpolation between the values at four corners")

static const vlParameter checkerboard_parameters[] = {
    INPUT("tex1", a, "texture of the cell at the origin", 1),
    INPUT("tex2", b, "texture of the cells next to it", 0),
    COUNT("dimension", dimension, "2: unit squares of (s, t); 3: unit cubes in texture space", VL_DEFAULT(2),
          VL_RANGE(2, 3)),
    MAPPING,
};
VL_KIND_ROW(checkerboard, .name = "checkerboard", .description = "a checkerboard of two textures")

/* pbrt-v4 interchanges the two: its constructor takes the texture between the dots first, and is given "inside". */
static const vlParameter dots_parameters[] = {
    INPUT("inside", a, "texture between the dots, as pbrt-v4 renders it", 1),
    INPUT("outside", b, "texture in the dots", 0),
    MAPPING,
};
VL_KIND_ROW(dots, .name = "dots", .description = "dots in randomly chosen cells of (s, t)")

/* ---- noise ------------------------------------------------------------------------------------------------------- */

static const vlParameter fbm_parameters[] = {OCTAVES};
VL_KIND_ROW(fbm, .name = "fbm", .description = "fractional Brownian motion: a sum of octaves of noise",
            .traits = VL_TEXTURE_FLOAT_ONLY)

static const vlParameter wrinkled_parameters[] = {OCTAVES};
VL_KIND_ROW(wrinkled, .name = "wrinkled", .description = "turbulence: a sum of octaves of the absolute value of noise",
            .traits = VL_TEXTURE_FLOAT_ONLY)

static const vlParameter windy_parameters[] = {PLACE};
VL_KIND_ROW(windy, .name = "windy", .description = "waves on windy water, from noise", .traits = VL_TEXTURE_FLOAT_ONLY)

static const vlParameter marble_parameters[] = {
    OCTAVES,
    FLOAT("scale", scale, "factor on the positions in texture space", VL_DEFAULT(1)),
    FLOAT("variation", variation, "strength of the noise that displaces the veins", VL_DEFAULT(0.2)),
};
VL_KIND_ROW(marble, .name = "marble", .description = "marble with coloured veins, from noise",
            .traits = VL_TEXTURE_COLOR_ONLY)

/* ---- images and vertices ----------------------------------------------------------------------------------------- */

static const vlParameter image_parameters[] = {
    FILE_NAME("filename", path, "the image file"),
    BLOCK(NULL, image, "an image in memory, in place of a file"),
    BLOCK(NULL, data, "the contents of an image file in memory, in place of a file"),
    BLOCK(NULL, data_size, "length of data, bytes"),
    CHOICE("wrap", wrap, "the value outside the image; mirror is not one of pbrt's", .choices = wraps),
    BOOL(NULL, wrap_t_given, "true: wrap_t is used for t"),
    CHOICE(NULL, wrap_t, "the value outside the image in the direction of t; wrap is then that of s", .choices = wraps),
    CHOICE("filter", filter, "interpolation between texels; ewa is read as trilinear", VL_DEFAULT(VL_FILTER_BILINEAR),
           .choices = filters),
    {.name = "maxanisotropy",
     .member = "",
     .type = VL_PARAMETER_FLOAT,
     .offset = offsetof(vlTextureDef, filter),
     .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND,
     .value = {8},
     .description = "ignored"},
    FLOAT("scale", scale, "factor on the image's values", VL_DEFAULT(1)),
    BOOL("invert", invert, "true: the value becomes 1 - value, after scale"),
    BLOCK("encoding", encoding,
          "encoding of the image's numbers: sRGB, linear, or gamma and a number; unset: the file's own",
          .flags = VL_PARAMETER_RULE),
    BOOL(NULL, encoding_given, "true: encoding and gamma replace the file's own encoding"),
    FLOAT(NULL, gamma, "exponent of the encoding gamma", VL_DEFAULT(2.2), VL_FROM(0), .flags = VL_PARAMETER_ABOVE_LOW),
    CHOICE(NULL, space, "colour space of an image that does not name its own", .choices = spaces),
    CHANNELS,
    MAPPING,
};
VL_KIND_ROW(image, .name = "imagemap", .description = "an image, mapped to the surface")

static const vlParameter vertex_color_parameters[] = {CHANNELS};
VL_KIND_ROW(vertex_color, .description = "the colours of the shape's vertices")

#define ROW(NAME, name) [VL_TEXTURE_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_texture_family, VL_TEXTURE_KINDS, ROW, "textures", "texture", "Texture")
