/* scene/schema/textures.c: rows of the textures. Names in files and defaults are pbrt-v4's. */
#include "scene/schema/schema.h"

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
#define PLACE BLOCK(NULL, texture_from_world, "4x4 matrix, row by row: places in the world to those of the texture")
#define MAPPING                                                                                      \
  CHOICE("mapping", mapping, "how (s, t) comes from the surface", .choices = mappings),              \
      FLOAT("uscale", su, "s = uscale u + udelta; of mapping uv", VL_DEFAULT(1)),                    \
      FLOAT("vscale", sv, "t = vscale v + vdelta; of mapping uv", VL_DEFAULT(1)),                    \
      FLOAT("udelta", du, "of mappings uv and planar", VL_DEFAULT(0)),                               \
      FLOAT("vdelta", dv, "of mappings uv and planar", VL_DEFAULT(0)),                               \
      VECTOR("v1", planar_v1, "s = v1 . p + udelta; of mapping planar", VL_DEFAULT(1, 0, 0)),        \
      VECTOR("v2", planar_v2, "t = v2 . p + vdelta; of mapping planar", VL_DEFAULT(0, 1, 0)), PLACE, \
      COUNT(NULL, uv_set, "of triangles that have several", VL_RANGE(0, 3)),                         \
      BOOL(NULL, st_from_uv_given, "st_from_uv counts in place of su, sv, du, dv"),                  \
      BLOCK(NULL, st_from_uv, "2x3 matrix, row by row, times (u, v, 1)")
#define OCTAVES                                                                                   \
  COUNT("octaves", octaves, "how many sizes of noise are summed", VL_DEFAULT(8), VL_RANGE(0, 64), \
        .flags = VL_PARAMETER_CLAMPED),                                                           \
      FLOAT("roughness", omega, "each size is so much weaker than the one before", VL_DEFAULT(0.5)), PLACE
/* The parameters that follow filter, scale and invert. */
#define CHANNELS                                                                                                      \
  BLOCK(NULL, tint, "factors on the four channels"), BOOL(NULL, colors, "times the colours of the shape's vertices"), \
      BLOCK(NULL, channel, "a float texture reads it: 0 to 3, or -1: grey, mean or coverage, by the image"),          \
      FLOAT(NULL, bias, "is added to a float texture", VL_DEFAULT(0)),                                                \
      DOUBLE(NULL, cutoff, "a float texture is 1 from it on and 0 below", .flags = VL_PARAMETER_UNSET)

/* ---- of inputs --------------------------------------------------------------------------------------------------- */

static const vlParameter constant_parameters[] = {INPUT("value", a, "everywhere", 1)};
VL_KIND_ROW(constant, .name = "constant", .description = "the same everywhere")

static const vlParameter scale_parameters[] = {
    INPUT("tex", a, "what is scaled", 1),
    NUMBER("scale", amount, "the factor", VL_DEFAULT(1)),
};
VL_KIND_ROW(scale, .name = "scale", .description = "a texture times a number")

static const vlParameter mix_parameters[] = {
    INPUT("tex1", a, "the first", 0),
    INPUT("tex2", b, "the second", 1),
    NUMBER("amount", amount, "share of the second", VL_DEFAULT(0.5)),
};
VL_KIND_ROW(mix, .name = "mix", .description = "between two textures")

static const vlParameter direction_mix_parameters[] = {
    INPUT("tex1", a, "where the normal is across the direction", 0),
    INPUT("tex2", b, "where it is along it", 1),
    VECTOR("dir", direction, "the direction; its length does not count", VL_DEFAULT(0, 1, 0)),
};
VL_KIND_ROW(direction_mix, .name = "directionmix", .description = "between two textures, by the surface's normal")

static const vlParameter bilerp_parameters[] = {
    INPUT("v00", a, "at s 0, t 0", 0),
    INPUT("v01", b, "at s 0, t 1", 1),
    INPUT("v10", c, "at s 1, t 0", 0),
    INPUT("v11", d, "at s 1, t 1", 1),
    MAPPING,
};
VL_KIND_ROW(bilerp, .name = "bilerp", .description = "linear between four corners")

static const vlParameter checkerboard_parameters[] = {
    INPUT("tex1", a, "of the cell at 0, 0", 1),
    INPUT("tex2", b, "of its neighbours", 0),
    COUNT("dimension", dimension, "2: squares of (s, t); 3: cubes of unit size in the texture's space", VL_DEFAULT(2),
          VL_RANGE(2, 3)),
    MAPPING,
};
VL_KIND_ROW(checkerboard, .name = "checkerboard", .description = "two textures in turn")

static const vlParameter dots_parameters[] = {
    INPUT("outside", a, "between the dots", 0),
    INPUT("inside", b, "in the dots", 1),
    MAPPING,
};
VL_KIND_ROW(dots, .name = "dots", .description = "dots in random cells")

/* ---- noise ------------------------------------------------------------------------------------------------------- */

static const vlParameter fbm_parameters[] = {OCTAVES};
VL_KIND_ROW(fbm, .name = "fbm", .description = "noise of several sizes", .traits = VL_TEXTURE_FLOAT_ONLY)

static const vlParameter wrinkled_parameters[] = {OCTAVES};
VL_KIND_ROW(wrinkled, .name = "wrinkled", .description = "sums of absolute noise", .traits = VL_TEXTURE_FLOAT_ONLY)

static const vlParameter windy_parameters[] = {PLACE};
VL_KIND_ROW(windy, .name = "windy", .description = "waves of water in wind", .traits = VL_TEXTURE_FLOAT_ONLY)

static const vlParameter marble_parameters[] = {
    OCTAVES,
    FLOAT("scale", scale, "factor on positions", VL_DEFAULT(1)),
    FLOAT("variation", variation, "how far the veins are moved", VL_DEFAULT(0.2)),
};
VL_KIND_ROW(marble, .name = "marble", .description = "veins of marble", .traits = VL_TEXTURE_COLOR_ONLY)

/* ---- images and vertices ----------------------------------------------------------------------------------------- */

static const vlParameter image_parameters[] = {
    FILE_NAME("filename", path, "the image"),
    BLOCK(NULL, image, "or an image in memory"),
    BLOCK(NULL, data, "or an image file in memory"),
    BLOCK(NULL, data_size, "its bytes"),
    CHOICE("wrap", wrap, "beyond its edges; mirror is not pbrt's", .choices = wraps),
    BOOL(NULL, wrap_t_given, "wrap_t counts for t"),
    CHOICE(NULL, wrap_t, "the same of t", .choices = wraps),
    CHOICE("filter", filter, "between texels; ewa is read as trilinear", VL_DEFAULT(VL_FILTER_BILINEAR),
           .choices = filters),
    {.name = "maxanisotropy",
     .member = "",
     .type = VL_PARAMETER_FLOAT,
     .offset = offsetof(vlTextureDef, filter),
     .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND,
     .value = {8},
     .description = "read, without effect"},
    FLOAT("scale", scale, "factor on its values", VL_DEFAULT(1)),
    BOOL("invert", invert, "1 minus that"),
    BLOCK("encoding", encoding, "sRGB, linear, or gamma and a number; else by the file", .flags = VL_PARAMETER_RULE),
    BOOL(NULL, encoding_given, "encoding counts"),
    FLOAT(NULL, gamma, "of that encoding", VL_DEFAULT(2.2), VL_FROM(0), .flags = VL_PARAMETER_ABOVE_LOW),
    CHOICE(NULL, space, "colour space, where the file names none", .choices = spaces),
    CHANNELS,
    MAPPING,
};
VL_KIND_ROW(image, .name = "imagemap", .description = "an image")

static const vlParameter vertex_color_parameters[] = {CHANNELS};
VL_KIND_ROW(vertex_color, .description = "the colours of the shape's vertices")

#define ROW(NAME, name) [VL_TEXTURE_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_texture_family, VL_TEXTURE_KINDS, ROW, "textures", "texture", "Texture")
