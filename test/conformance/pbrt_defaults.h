/* conformance/pbrt_defaults.h: the law of pbrt-v4's defaults. What a file leaves out has in
 * velo the value that it has in pbrt, and the writer leaves out what has its default. The
 * defaults here are those of https://pbrt.org/fileformat-v4, not of the rows. */
#ifndef TEST_CONFORMANCE_PBRT_DEFAULTS_H
#define TEST_CONFORMANCE_PBRT_DEFAULTS_H

#include "conformance.h"
#include "unit.h"

/* Parameters of several kinds. A parameter without a value has no default, or one that depends
 * on others. */
#define SURFACE_DEFAULTS "displacement 0; normalmap; "
#define ROUGH_DEFAULTS "roughness; uroughness 0; vroughness 0; remaproughness true; "
#define LAYER_DEFAULTS \
  "thickness 0.01; g 0; albedo 0; maxdepth 10; nsamples 1; remaproughness true; "
#define MAPPING_DEFAULTS \
  "mapping uv; uscale 1; vscale 1; udelta 0; vdelta 0; v1 1 0 0; v2 0 1 0; "
#define ROUND_DEFAULTS "alpha 1; radius 1; phimax 360; "
#define SIGMA_DEFAULTS "sigma_a 1; sigma_s 1; scale 1; g 0; "
#define GRID_DEFAULTS "p0 0 0 0; p1 1 1 1; nx 1; ny 1; nz 1; "
#define TEMPERATURE_DEFAULTS "temperatureoffset 0; temperaturescale 1; "
#define SHUTTER_DEFAULTS "shutteropen 0; shutterclose 1; "
#define FILM_DEFAULTS                                                                       \
  "xresolution 1280; yresolution 720; filename; pixelbounds; cropwindow; diagonal 35; iso " \
  "100; sensor; whitebalance 0; maxcomponentvalue inf; savefp16; exposuretime; imagingratio; "

static const struct {
  const char *family, *kind, *defaults;
} pbrt_defaults[] = {
    {"materials", "diffuse", "reflectance 0.5; " SURFACE_DEFAULTS},
    {"materials", "coateddiffuse",
     "reflectance 0.5; roughness; uroughness 0; vroughness 0; eta 1.5; " LAYER_DEFAULTS
         SURFACE_DEFAULTS},
    {"materials", "coatedconductor",
     "conductor.eta metal-Cu-eta; conductor.k metal-Cu-k; reflectance; conductor.roughness; "
     "conductor.uroughness 0; conductor.vroughness 0; interface.roughness; "
     "interface.uroughness 0; interface.vroughness 0; interface.eta 1.5; " LAYER_DEFAULTS
         SURFACE_DEFAULTS},
    {"materials", "conductor",
     "eta metal-Cu-eta; k metal-Cu-k; reflectance; " ROUGH_DEFAULTS SURFACE_DEFAULTS},
    {"materials", "dielectric", "eta 1.5; " ROUGH_DEFAULTS SURFACE_DEFAULTS},
    {"materials", "thindielectric", "eta 1.5; " SURFACE_DEFAULTS},
    {"materials", "diffusetransmission",
     "reflectance 0.25; transmittance 0.25; scale 1; " SURFACE_DEFAULTS},
    {"materials", "hair",
     "sigma_a; reflectance; eumelanin 1.3; pheomelanin 0; eta 1.55; beta_m 0.3; beta_n 0.3; "
     "alpha 2; "},
    {"materials", "measured", "filename; " SURFACE_DEFAULTS},
    {"materials", "mix", "materials; amount 0.5; "},
    {"materials", "subsurface",
     "name; sigma_a 0.0011 0.0024 0.014; sigma_s 2.55 3.21 3.77; reflectance; mfp 1; scale 1; "
     "eta 1.33; g 0; " ROUGH_DEFAULTS SURFACE_DEFAULTS},
    {"textures", "constant", "value 1; "},
    {"textures", "scale", "tex 1; scale 1; "},
    {"textures", "mix", "tex1 0; tex2 1; amount 0.5; "},
    {"textures", "checkerboard", "tex1 1; tex2 0; dimension 2; " MAPPING_DEFAULTS},
    {"textures", "imagemap",
     "filename; wrap repeat; filter bilinear; maxanisotropy 8; scale 1; invert false; "
     "encoding; " MAPPING_DEFAULTS},
    {"textures", "directionmix", "tex1 0; tex2 1; dir 0 1 0; "},
    {"textures", "bilerp", "v00 0; v01 1; v10 0; v11 1; " MAPPING_DEFAULTS},
    {"textures", "fbm", "octaves 8; roughness 0.5; "},
    {"textures", "wrinkled", "octaves 8; roughness 0.5; "},
    {"textures", "windy", ""},
    {"textures", "marble", "octaves 8; roughness 0.5; scale 1; variation 0.2; "},
    {"textures", "dots", "inside 1; outside 0; " MAPPING_DEFAULTS},
    {"lights", "point", "I 1 1 1; scale 1; power; from 0 0 0; "},
    {"lights", "spot",
     "I 1 1 1; scale 1; power; from 0 0 0; to 0 0 1; coneangle 30; conedeltaangle 5; "},
    {"lights", "distant", "L 1 1 1; scale 1; illuminance; from 0 0 0; to 0 0 1; "},
    {"lights", "infinite", "L 1 1 1; scale 1; illuminance; filename; portal; "},
    {"lights", "goniometric", "I 1 1 1; scale 1; power; filename; "},
    {"lights", "projection", "scale 1; power; filename; fov 90; "},
    {"emission", "diffuse", "L 1 1 1; scale 1; twosided false; power; filename; "},
    {"shapes", "trianglemesh", "alpha 1; P; indices; N; S; uv; displacement 0; edgelength 1; "},
    {"shapes", "bilinearmesh", "alpha 1; P; indices; N; uv; "},
    {"shapes", "sphere", ROUND_DEFAULTS "zmin -1; zmax 1; "},
    {"shapes", "disk", ROUND_DEFAULTS "innerradius 0; height 0; "},
    {"shapes", "cylinder", ROUND_DEFAULTS "zmin -1; zmax 1; "},
    {"shapes", "curve",
     "alpha 1; type flat; P; basis; degree 3; width 1; width0 1; width1 1; N; splitdepth 3; "},
    {"media", "homogeneous", SIGMA_DEFAULTS "preset; Le 0; Lescale 1; "},
    {"media", "uniformgrid",
     SIGMA_DEFAULTS GRID_DEFAULTS TEMPERATURE_DEFAULTS
     "preset; density; Le 0; Lescale 1; temperature; "},
    {"media", "rgbgrid", "scale 1; g 0; " GRID_DEFAULTS "sigma_a; sigma_s; Le; Lescale 1; "},
    {"media", "cloud",
     SIGMA_DEFAULTS "p0 0 0 0; p1 1 1 1; density 1; wispiness 1; frequency 5; "},
    {"media", "nanovdb",
     SIGMA_DEFAULTS TEMPERATURE_DEFAULTS "filename; gridname; temperaturename; Lescale 1; "},
    {"filters", "box", "xradius 0.5; yradius 0.5; "},
    {"filters", "triangle", "xradius 2; yradius 2; "},
    {"filters", "gaussian", "xradius 1.5; yradius 1.5; sigma 0.5; "},
    {"filters", "mitchell", "xradius 2; yradius 2; B 0.333333; C 0.333333; "},
    {"filters", "sinc", "xradius 4; yradius 4; tau 3; "},
    {"samplers", "independent", "pixelsamples 4; seed; "},
    {"samplers", "stratified", "pixelsamples 16; seed; xsamples; ysamples; jitter true; "},
    {"samplers", "halton", "pixelsamples 16; seed; randomization; "},
    {"samplers", "sobol", "pixelsamples 16; seed; randomization; "},
    {"samplers", "zsobol", "pixelsamples 16; seed; randomization; "},
    {"tracers", "path", "maxdepth 5; lightsampler bvh; regularize false; "},
    {"tracers", "volpath", "maxdepth 5; lightsampler bvh; regularize false; "},
    {"tracers", "bidirectional", "maxdepth 5; regularize; "},
    {"tracers", "sppm", "maxdepth 5; photonsperiteration; "},
    {"tracers", "randomwalk", "maxdepth 5; "},
    {"tracers", "lightpath", "maxdepth 5; "},
    {"tracers", "ambientocclusion", "cossample true; maxdistance inf; "},
    {"films", "rgb", FILM_DEFAULTS},
    {"films", "gbuffer", FILM_DEFAULTS "coordinatesystem; "},
    {"films", "spectral", FILM_DEFAULTS "nbuckets 16; lambdamin 360; lambdamax 830; "},
    {"cameras", "perspective",
     "fov 90; frameaspectratio; screenwindow; lensradius 0; focaldistance 1e+06; " SHUTTER_DEFAULTS},
    {"cameras", "orthographic",
     "frameaspectratio; screenwindow; lensradius 0; focaldistance 1e+06; " SHUTTER_DEFAULTS},
    {"cameras", "spherical", "mapping; " SHUTTER_DEFAULTS},
    {"cameras", "realistic",
     "lensfile; aperturediameter 1; focusdistance 10; aperture; " SHUTTER_DEFAULTS},
};

/* ---- defaults of rows -------------------------------------------------------------------- */

/* The default in the unit of files, as text; none: empty. */
static void default_text(const vlParameter *p, char text[100]) {
  const double unit = p->factor != 0 ? p->factor : 1;
  const bool many = p->type == VL_PARAMETER_FLOAT3 || p->type == VL_PARAMETER_DOUBLE3 ||
                    p->flags & VL_PARAMETER_RGB;
  text[0] = 0;
  if (p->flags & (VL_PARAMETER_REQUIRED | VL_PARAMETER_UNSET))
    return;
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      snprintf(text, 100, "%s", p->value[0] != 0 ? "true" : "false");
      return;
    case VL_PARAMETER_CHOICE:
      snprintf(text, 100, "%s", p->choices[(int)p->value[0]]);
      return;
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
    case VL_PARAMETER_BLOCK:
    case VL_PARAMETER_TEXTURE:
      return;
    default:
      if (p->text)
        snprintf(text, 100, "%s", p->text);
      else if (many)
        snprintf(text, 100, "%.6g %.6g %.6g", p->value[0] / unit, p->value[1] / unit,
                 p->value[2] / unit);
      else
        snprintf(text, 100, "%.6g", p->value[0] / unit);
  }
}

/* pbrt's default of the parameter `name` in a list of defaults. False: pbrt has no such
 * parameter. */
static bool pbrt_default(const char *list, const char *name, char text[100]) {
  const size_t length = strlen(name);
  for (; *list; list = strstr(list, "; ") + 2)
    if (strncmp(list, name, length) == 0 && (list[length] == ' ' || list[length] == ';')) {
      const char *value = list + length + (list[length] == ' ');
      snprintf(text, 100, "%.*s", (int)strcspn(value, ";"), value);
      return true;
    }
  return false;
}

/* What is not written by its row alone: velo's readers turn unset numbers into pbrt's. */
static const uint32_t by_other_rules =
    VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND | VL_PARAMETER_UNSET;

/* Parameters without a default in the list may have one in the row. */
static void check_defaults(const char *family, const vlKindRow *row, const char *list) {
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    char has[100];
    char wanted[100];
    if (!p->name)
      continue;
    const bool known = pbrt_default(list, p->name, wanted);
    const bool own = p->flags & VL_PARAMETER_OWN;
    if (known && own)
      broken(family, row->name, "\"%s\" is pbrt's, but velo's own by its row", p->name);
    if (!known && !own && !(p->flags & by_other_rules))
      broken(family, row->name, "\"%s\" is written, but pbrt does not read it", p->name);
    default_text(p, has);
    if (known && !own && wanted[0] && strcmp(has, wanted) != 0)
      broken(family, row->name, "\"%s\" is %s unless it is set, in pbrt %s", p->name, has,
             wanted);
  }
}

static const vlKindRow *row_of(const char *family, const char *kind) {
  const vlKindFamily *all = vl_kind_family_find(family);
  for (uint32_t k = 0; all && k < all->kind_count; k++)
    if (all->rows[k]->name && strcmp(all->rows[k]->name, kind) == 0)
      return all->rows[k];
  return NULL;
}

static void defaults_of_pbrt(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof pbrt_defaults / sizeof *pbrt_defaults; i++) {
    const char *family = pbrt_defaults[i].family;
    const vlKindRow *row = row_of(family, pbrt_defaults[i].kind);
    if (!row)
      broken(family, pbrt_defaults[i].kind, "pbrt's kind is not there");
    else
      check_defaults(family, row, pbrt_defaults[i].defaults);
  }
  expect_no_failures();
}

#endif
