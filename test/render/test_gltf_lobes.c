/* test_gltf_lobes.c: each lobe of glTF's materials, read from a file and rendered: spheres in a
 * white room against albedos integrated here, walls against reflectances at normal incidence,
 * slabs against the transmittance of glass of known thickness. */
#include "render/gltf_shots.h"

#include "material/principled.h"

/* ---- albedos, without velo's tables ------------------------------------------------------ */

/* The albedo of GGX microfacets with single scattering for F0 and F90, integrated in double
 * over the half vectors that are visible from o (Heitz 2018). */
static double ggx_albedo(double cosine, double alpha, double f0, double f90) {
  enum { U = 24, V = 200 };
  double ox = sqrt(1 - cosine * cosine), sum = 0, wx = alpha * ox,
         length = sqrt(wx * wx + cosine * cosine);
  wx /= length;
  double wz = cosine / length, lo = sqrt(alpha * alpha * ox * ox + cosine * cosine);
  for (int i = 0; i < U * V; i++) {
    double phi = M_PI * (i % U + 0.5) / U, z = (1 - (i / U + 0.5) / V) * (1 + wz) - wz;
    double r = sqrt(fmax(0, 1 - z * z)), hx = alpha * (r * cos(phi) + wx),
           hy = alpha * r * sin(phi), hz = z + wz;
    double n = 1 / sqrt(hx * hx + hy * hy + hz * hz), oh = (ox * hx + cosine * hz) * n;
    double ix = 2 * oh * hx * n - ox, iy = 2 * oh * hy * n, iz = 2 * oh * hz * n - cosine;
    if (iz <= 0)
      continue;
    double li = sqrt(alpha * alpha * (ix * ix + iy * iy) + iz * iz);
    sum += iz * (lo + cosine) / (lo * iz + li * cosine) * (f0 + (f90 - f0) * pow(1 - oh, 5));
  }
  return sum / (U * V);
}
/* int E 2 cos dcos */
static double ggx_mean(double alpha, double f0, double f90) {
  double sum = 0;
  for (int i = 0; i < 40; i++) {
    double c = (i + 0.5) / 40;
    sum += 2 * c / 40 * ggx_albedo(c, alpha, f0, f90);
  }
  return sum;
}
/* A metal of that colour with all its bounces between microfacets (Kulla and Conty 2017). */
static double metal_mean(double alpha, double base) {
  double one = ggx_mean(alpha, 1, 1), f = base + (1 - base) / 21;
  return ggx_mean(alpha, base, 1) + f * f * one / (1 - f * (1 - one)) * (1 - one);
}

#define PBR                                                                           \
  "\"pbrMetallicRoughness\":{\"baseColorFactor\":[%g,%g,%g,1],\"metallicFactor\":%g," \
  "\"roughnessFactor\":%g}"
#define BLACK                                                                     \
  "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1],\"metallicFactor\":0," \
  "\"roughnessFactor\":0}"
#define NO_SPECULAR "\"KHR_materials_specular\":{\"specularFactor\":0}"
static char text[1024];
static const char *pbr(double base, double metal, double rough, const char *more) {
  int n = snprintf(text, sizeof text, PBR, base, base, base, metal, rough);
  snprintf(text + n, sizeof text - (size_t)n, "%s%s", *more ? "," : "", more);
  return text;
}

/* ---- balls ------------------------------------------------------------------------------- */

static void metallic_roughness(void **state) {
  (void)state;
  static const double roughs[] = {0.1, 0.4, 0.7, 1};
  for (int i = 0; i < 4; i++) {
    double alpha = roughs[i] * roughs[i], shine = ggx_mean(alpha, 0.04, 1);
    for (double base = 0; base <= 1; base += 0.5) {
      char name[80];
      double metal = metal_mean(alpha, base);
      for (double share = 0; share <= 1; share += 0.5) {
        snprintf(name, sizeof name, "base %g, metallic %g, roughness %g", base, share,
                 roughs[i]);
        Shot shot = {.material = pbr(base, share, roughs[i], ""), .spp = base == 1 ? 128 : 64};
        double e = share * metal + (1 - share) * (shine + base * (1 - shine));
        expect_shot(name, &shot, e, e, e, base == 1 ? 0.003 : 0.005);
      }
    }
  }
}

static void diffuse_and_layers(void **state) {
  (void)state;
  Shot shot = {.material = pbr(0.6, 0, 1, "\"extensions\":{" NO_SPECULAR "}")};
  expect_shot("diffuse", &shot, 0.6, 0.6, 0.6, 0.003);
  double coat = ggx_mean(0.09, 0.04, 1);
  for (double base = 0; base <= 0.8; base += 0.8) {
    shot.material = pbr(base, 0, 1,
                        "\"extensions\":{" NO_SPECULAR
                        ",\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1,"
                        "\"clearcoatRoughnessFactor\":0.3}}");
    double e = coat + base * (1 - coat);
    expect_shot("clear coat", &shot, e, e, e, 0.005);
  }
  double fuzz = 0, rough = 0.6; /* Charlie, from its own formula */
  for (int i = 0; i < 40; i++) {
    double o = (i + 0.5) / 40, sine = sqrt(1 - o * o), sum = 0;
    for (int k = 0; k < 40 * 60; k++) {
      double z = (k % 40 + 0.5) / 40, r = sqrt(1 - z * z), phi = M_PI * (k / 40 + 0.5) / 60;
      double h = (o + z) /
                 sqrt(pow(sine + r * cos(phi), 2) + pow(r * sin(phi), 2) + (o + z) * (o + z));
      sum += (double)vl_sheen((float)o, (float)z, (float)h, (float)(rough * rough)) * 2 * M_PI /
             (40 * 60);
    }
    fuzz += 2 * o / 40 * fmin(sum, 1);
  }
  shot.material = pbr(0, 0, 1,
                      "\"extensions\":{" NO_SPECULAR
                      ",\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,0.5,0.25],"
                      "\"sheenRoughnessFactor\":0.6}}");
  expect_shot("sheen", &shot, fuzz, 0.5 * fuzz, 0.25 * fuzz, 0.006);
  shot.material =
      pbr(1, 1, 0.5,
          "\"extensions\":{\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.6,"
          "\"anisotropyRotation\":0.7}}");
  expect_shot("anisotropy", &shot, 1, 1, 1, 0.03);
  shot.material = pbr(
      1, 1, 0.4, "\"extensions\":{\"KHR_materials_iridescence\":{\"iridescenceFactor\":1}}");
  expect_shot("film over a white metal", &shot, 1, 1, 1, 0.006);
}

static void glass(void **state) {
  (void)state;
  static const char *const bodies[] = {"", ",\"KHR_materials_volume\":{\"thicknessFactor\":1}"};
  char more[300];
  for (int solid = 0; solid < 2; solid++)
    for (double rough = 0; rough <= 1; rough += 0.25) {
      snprintf(more, sizeof more,
               "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}%s}",
               bodies[solid]);
      Shot shot = {.material = pbr(1, 0, rough, more), .depth = 200};
      expect_shot(solid ? "clear solid" : "clear sheet", &shot, 1, 1, 1, 0.006);
    }
  /* A ball of thin glass: F + b^2 (1 - F) for each ray, with the Schlick mean .04 + .96 /
   * 21. */
  double f = 0.04 + 0.96 / 21, e = f + 0.25 * (1 - f);
  Shot shot = {
      .material =
          pbr(0.5, 0, 0,
              "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}}")};
  expect_shot("tinted sheet", &shot, e, e, e, 0.006);
  shot.material =
      pbr(1, 0, 0.4,
          "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
          "\"KHR_materials_volume\":{\"thicknessFactor\":1},\"KHR_materials_dispersion\":{"
          "\"dispersion\":2}}");
  shot.spectral = true;
  shot.depth = 200;
  expect_shot("dispersion", &shot, 1, 1, 1, 0.015);
}

/* ---- walls ------------------------------------------------------------------------------- */

static void normal_incidence(void **state) {
  (void)state;
  static const struct {
    const char *name, *material;
    double rgb[3];
  } walls[] = {
      {"metal's base colour",
       "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.6,0.3,1],\"roughnessFactor\":0}",
       {0.9, 0.6, 0.3}},
      {"4 % without a word", BLACK, {0.04, 0.04, 0.04}},
      {"ior 2",
       BLACK ",\"extensions\":{\"KHR_materials_ior\":{\"ior\":2}}",
       {1 / 9.0, 1 / 9.0, 1 / 9.0}},
      {"ior 1", BLACK ",\"extensions\":{\"KHR_materials_ior\":{\"ior\":1}}", {0, 0, 0}},
      {"ior 0",
       BLACK ",\"extensions\":{\"KHR_materials_ior\":{\"ior\":0},"
             "\"KHR_materials_specular\":{\"specularColorFactor\":[0.5,0.25,1]}}",
       {0.5, 0.25, 1}},
      {"specular",
       BLACK ",\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0.5,"
             "\"specularColorFactor\":[0.5,1,2]}}",
       {0.01, 0.02, 0.04}},
      {"clear coat",
       BLACK ",\"extensions\":{" NO_SPECULAR
             ",\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.75}}",
       {0.03, 0.03, 0.03}},
      {"specular-glossiness",
       "\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{"
       "\"diffuseFactor\":[0.4,0.2,0.8,1],\"specularFactor\":[0.2,0.2,0.2],"
       "\"glossinessFactor\":1}}",
       {0.2 + 0.4 * 0.8, 0.2 + 0.2 * 0.8, 0.2 + 0.8 * 0.8}},
      {"diffuse transmission",
       "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.8,0.8,1],\"metallicFactor\":0},"
       "\"extensions\":{" NO_SPECULAR ",\"KHR_materials_diffuse_transmission\":{"
       "\"diffuseTransmissionFactor\":0.25,\"diffuseTransmissionColorFactor\":[0.4,0.8,0]}}",
       {0.7, 0.8, 0.6}},
      {"unlit",
       "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.2,0.4,0.8,1]},\"extensions\":{\"KHR_"
       "materials_unlit\":{}}",
       {0.2, 0.4, 0.8}},
      {"emission",
       BLACK ",\"emissiveFactor\":[0.5,0.25,1],\"extensions\":{" NO_SPECULAR
             ",\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4}}",
       {2, 1, 4}},
      {"thin glass",
       "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.25,0.5,1,1],\"metallicFactor\":0,"
       "\"roughnessFactor\":0},"
       "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}}",
       {0.04 + 0.24, 0.04 + 0.48, 1}},
      {"half thin glass, half black",
       "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.5,0,1],\"metallicFactor\":0,"
       "\"roughnessFactor\":0},"
       "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}," NO_SPECULAR
       "}",
       {1, 0.5, 0}},
  };
  for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
    Shot shot = {.body = WALL, .material = walls[i].material};
    expect_shot(walls[i].name, &shot, walls[i].rgb[0], walls[i].rgb[1], walls[i].rgb[2], 0.004);
  }
}

/* A film of index 1.8, 300 nm thick, on glass of 1.5: Airy's sum for three wavelengths a
 * channel. */
static void film(void **state) {
  (void)state;
  static const double waves[3][3] = {{595, 615, 635}, {525, 545, 565}, {435, 452, 470}};
  double rgb[3], a = (1 - 1.8) / (1 + 1.8), b = (1.8 - 1.5) / (1.8 + 1.5);
  for (int c = 0; c < 3; c++) {
    rgb[c] = 0;
    for (int k = 0; k < 3; k++) {
      double wave = 2 * a * b * cos(4 * M_PI * 1.8 * 300 / waves[c][k]);
      rgb[c] += (a * a + b * b + wave) / (1 + a * a * b * b + wave) / 3;
    }
  }
  Shot shot = {.body = WALL,
               .material = BLACK
               ",\"extensions\":{\"KHR_materials_iridescence\":{\"iridescenceFactor\":1,"
               "\"iridescenceIor\":1.8,\"iridescenceThicknessMaximum\":300}}"};
  expect_shot("film", &shot, rgb[0], rgb[1], rgb[2], 0.003);
  assert_true(fabs(rgb[0] - rgb[2]) > 0.02); /* it has a colour */
}

/* ---- slabs ------------------------------------------------------------------------------- */

/* Glass 1 thick in front of a white room: F + (1 - F)^2 a / (1 - F a), a = colour^(1 /
 * attenuationDistance). */
static void attenuation(void **state) {
  (void)state;
  static const struct {
    double ior, distance;
  } slabs[] = {{1.5, 1}, {1.5, 0.5}, {1.5, 4}, {1.33, 1}};
  static const double color[3] = {0.25, 0.5, 0.9};
  char more[400];
  for (size_t i = 0; i < sizeof slabs / sizeof *slabs; i++) {
    snprintf(more, sizeof more,
             "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
             "\"KHR_materials_ior\":{\"ior\":%g},"
             "\"KHR_materials_volume\":{\"thicknessFactor\":0.1,\"attenuationDistance\":%g,"
             "\"attenuationColor\":[0.25,0.5,0.9]}}",
             slabs[i].ior, slabs[i].distance);
    double f = pow((slabs[i].ior - 1) / (slabs[i].ior + 1), 2), rgb[3];
    for (int c = 0; c < 3; c++) {
      double a = pow(color[c], 1 / slabs[i].distance);
      rgb[c] = f + (1 - f) * (1 - f) * a / (1 - f * a);
    }
    Shot shot = {.body = SLAB, .material = pbr(1, 0, 0, more), .spp = 128};
    expect_shot("slab", &shot, rgb[0], rgb[1], rgb[2], 0.006);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(metallic_roughness),
                                     cmocka_unit_test(diffuse_and_layers),
                                     cmocka_unit_test(glass),
                                     cmocka_unit_test(normal_incidence),
                                     cmocka_unit_test(film),
                                     cmocka_unit_test(attenuation)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
