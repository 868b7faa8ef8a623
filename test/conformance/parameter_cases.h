/* conformance/parameter_cases.h: what the laws of parameters must know beyond the rows.
 * Families with a folder have the cases of a kind there: src/texture/NAME.case.c,
 * src/light/NAME.case.c, src/medium/NAME.case.c, src/shape/NAME.case.c. */
#ifndef TEST_CONFORMANCE_PARAMETER_CASES_H
#define TEST_CONFORMANCE_PARAMETER_CASES_H

#include <stddef.h>

#include "light/light.case.h"
#include "medium/medium.case.h"
#include "schema/parameter.case.h"
#include "shape/shape.case.h"
#include "texture/texture.case.h"
#include "velo/shape_kinds.h"

#define TEXTURE_CASE(kind, name, ...) &name##_texture,
static const TextureCase *const texture_cases[] = {VL_TEXTURE_KINDS(TEXTURE_CASE)};
#define LIGHT_CASE(kind, name) &name##_light,
static const LightCase *const light_cases[] = {VL_LIGHT_KINDS(LIGHT_CASE)};
#define MEDIUM_CASE(kind, name) &name##_medium,
static const MediumCase *const medium_cases[] = {VL_MEDIUM_KINDS(MEDIUM_CASE)};
#define SHAPE_CASE(kind, name) &name##_shape,
static const ShapeCase *const shape_cases[] = {VL_SHAPE_KINDS(SHAPE_CASE)};

static const ParameterCase parameter_cases[] = {
    /* materials */
    {.family = "materials",
     .parameter = "normalmap",
     .value = "\"string normalmap\" \"normals.img\""},
    {.family = "materials",
     .parameter = "displacement",
     .value = "\"texture displacement\" \"bumps\""},
    {.family = "materials",
     .kind = "conductor",
     .parameter = "remaproughness",
     .base = "\"float roughness\" .3"},
    {.family = "materials",
     .kind = "dielectric",
     .parameter = "remaproughness",
     .base = "\"float roughness\" .3"},
    {.family = "materials",
     .kind = "coateddiffuse",
     .parameter = "remaproughness",
     .base = "\"float roughness\" .3"},
    {.family = "materials",
     .kind = "subsurface",
     .parameter = "remaproughness",
     .base = "\"float roughness\" .3"},
    {.family = "materials",
     .kind = "coateddiffuse",
     .parameter = "g",
     .base = "\"rgb albedo\" [.9 .8 .7];\"float thickness\" .5"},
    {.family = "materials",
     .kind = "coatedconductor",
     .parameter = "g",
     .base = "\"rgb albedo\" [.9 .8 .7];\"float thickness\" .5"},
    {.family = "materials",
     .parameter = "nsamples",
     .no_effect = "velo computes what pbrt samples by random walks"},
    {.family = "materials",
     .kind = "coatedconductor",
     .parameter = "remaproughness",
     .base = "\"float conductor.roughness\" .3"},
    {.family = "materials",
     .kind = "coatedconductor",
     .parameter = "conserveenergy",
     .value = "\"bool conserveenergy\" false",
     .no_effect = "only a coat over a diffuse base can conserve energy; true is refused"},
    {.family = "materials",
     .kind = "principled",
     .base = "\"float metallic\" 0;\"float roughness\" .3"},
    {.family = "materials",
     .kind = "principled",
     .parameter = "anisotropyrotation",
     .base = "\"float anisotropy\" .8;\"float roughness\" .3"},
    {.family = "materials",
     .kind = "principled",
     .parameter = "thinwalled",
     .base = "\"float metallic\" 0;\"float transmission\" 1;\"float roughness\" .2"},
    {.family = "materials",
     .kind = "principled",
     .parameter = "dispersion",
     .base = "\"float metallic\" 0;\"float transmission\" 1;\"float roughness\" .2;"
             "\"bool thinwalled\" false"},
    {.family = "materials",
     .kind = "principled",
     .parameter = "diffusetransmissioncolor",
     .base = "\"float metallic\" 0;\"float diffusetransmission\" .5"},
    {.family = "materials",
     .kind = "principled",
     .parameter = "clearcoatroughness",
     .base = "\"float clearcoat\" .5"},
    {.family = "materials",
     .kind = "principled",
     .parameter = "sheenroughness",
     .base = "\"rgb sheencolor\" [.5 .6 .7]"},
    {.family = "materials",
     .kind = "principled",
     .parameter = "iridescenceeta",
     .base = "\"float iridescence\" .5"},
    {.family = "materials",
     .kind = "principled",
     .parameter = "iridescencethickness",
     .base = "\"float iridescence\" .5"},
    {.family = "materials", .kind = "measured", .base = "\"string filename\" \"a.bsdf\""},
    {.family = "materials",
     .kind = "measured",
     .parameter = "filename",
     .value = "\"string filename\" \"b.bsdf\""},
    {.family = "materials", .kind = "mix", .base = "\"string materials\" [\"grey\" \"red\"]"},
    {.family = "materials",
     .kind = "mix",
     .parameter = "materials",
     .value = "\"string materials\" [\"red\" \"grey\"]"},
    {.family = "materials",
     .kind = "subsurface",
     .parameter = "mfp",
     .base = "\"rgb reflectance\" [.6 .5 .4];\"rgb mfp\" [.1 .2 .3]"},
    {.family = "materials",
     .kind = "subsurface",
     .parameter = "name",
     .value = "\"string name\" \"Skin1\""},
    {.family = "materials",
     .kind = "subsurface",
     .parameter = "sigma_a",
     .base = "\"rgb sigma_s\" [3 4 5];\"rgb sigma_a\" [1 2 1]"},
    {.family = "materials",
     .kind = "subsurface",
     .parameter = "sigma_s",
     .base = "\"rgb sigma_s\" [3 4 5];\"rgb sigma_a\" [1 2 1]"},
    /* textures */
    {.family = "textures", .parameter = "mapping", .value = "\"string mapping\" \"spherical\""},
    {.family = "textures", .parameter = "v1", .base = "\"string mapping\" \"planar\""},
    {.family = "textures", .parameter = "v2", .base = "\"string mapping\" \"planar\""},
    /* footprints leave out the octaves that a pixel averages */
    {.family = "textures", .parameter = "octaves", .value = "\"integer octaves\" 2"},
    /* lights */
    {.family = "lights", .parameter = "power", .value = "\"float power\" 30"},
    {.family = "lights", .parameter = "illuminance", .value = "\"float illuminance\" 2"},
    {.family = "lights", .parameter = "filename", .value = "\"string filename\" \"other.pfm\""},
    /* emission */
    {.family = "emission", .parameter = "power", .value = "\"float power\" 30"},
    {.family = "emission", .parameter = "filename", .value = "\"string filename\" \"a.pfm\""},
    /* media */
    {.family = "media", .parameter = "preset", .value = "\"string preset\" \"Skin1\""},
    {.family = "media",
     .parameter = "density",
     .value = "\"float density\" [.1 .5 .9 .3 1 .6 .8 .2]"},
    /* tracers */
    {.family = "tracers", .parameter = "maxdepth", .value = "\"integer maxdepth\" 1"},
    {.family = "tracers", .parameter = "radius", .value = "\"float radius\" .4"},
    {.family = "tracers",
     .kind = "path",
     .parameter = "maxvolumedepth",
     .no_effect = "it follows no light through media"},
    {.family = "tracers", .parameter = "maxdistance", .value = "\"float maxdistance\" .4"},
    /* shapes */
    {.family = "shapes", .parameter = "alpha", .value = "\"float alpha\" .4"},
};

#endif
