/* texture/image.row.c: the name and the parameters of the texture image. */
#include "texture/texture.row.h"

#include "color/color.h"

const char *const vl_texture_wraps[] = {"repeat",           "black",  "clamp",
                                        "octahedralsphere", "mirror", NULL};
const char *const vl_texture_filters[] = {"point", "bilinear", "trilinear", "ewa", NULL};

static const vlParameter parameters[] = {
    FILE_NAME("filename", path, "the image file"),
    BLOCK(NULL, image, "an image in memory, in place of a file"),
    BLOCK(NULL, data, "the contents of an image file in memory, in place of a file"),
    BLOCK(NULL, data_size, "length of data, bytes"),
    CHOICE("wrap", wrap, "the value outside the image; mirror is not one of pbrt's",
           .choices = vl_texture_wraps),
    BOOL(NULL, wrap_t_given, "true: wrap_t is used for t"),
    CHOICE(NULL, wrap_t,
           "the value outside the image in the direction of t; wrap is then that of s",
           .choices = vl_texture_wraps),
    CHOICE("filter", filter, "interpolation between texels; ewa is read as trilinear",
           VL_DEFAULT(VL_FILTER_BILINEAR), .choices = vl_texture_filters),
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
          "encoding of the image's numbers: sRGB, linear, or gamma and a number; unset: the "
          "file's own",
          .flags = VL_PARAMETER_RULE),
    BOOL(NULL, encoding_given, "true: encoding and gamma replace the file's own encoding"),
    FLOAT(NULL, gamma, "exponent of the encoding gamma", VL_DEFAULT(2.2), VL_FROM(0),
          .flags = VL_PARAMETER_ABOVE_LOW),
    CHOICE(NULL, space, "colour space of an image that does not name its own",
           .choices = vl_color_space_names),
    CHANNELS,
    MAPPING,
};
VL_TEXTURE_ROW(vl_texture_row_image) = {
    .name = "imagemap",
    .description = "an image, mapped to the surface",
    VL_ROW_PARAMETERS(parameters),
};
