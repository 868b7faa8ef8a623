/* more/materials.c: the materials of more/, by kind; diffuse transmission and thin glass (pbrt book 9.1.2, 9.5). */
#include "more.h"

/* The absorption of the two pigments: pbrt book 9.9.7. */
static const vlSpectrum eumelanin = {.kind = VL_SPECTRUM_RGB, .scale = 1, .rgb = {0.419f, 0.697f, 1.37f}};
static const vlSpectrum pheomelanin = {.kind = VL_SPECTRUM_RGB, .scale = 1, .rgb = {0.187f, 0.4f, 1.05f}};

/* The coefficient that gives many hairs together a colour (Chiang et al. 2016, eq. 9). */
static spectrum absorption_of_hair_color(spectrum looks, double beta_n) {
  double n = beta_n;
  double fit = 5.969 - 0.215 * n + 2.532 * n * n - 10.73 * pow(n, 3) + 5.574 * pow(n, 4) + 0.245 * pow(n, 5);
  for (int i = 0; i < CHANNELS; i++) looks.c[i] = square(log(fmax(1e-4, looks.c[i])) / fit);
  return looks;
}

static spectrum hair_absorption(const world *w, const vlMaterialDef *m, const shade_record *at, double beta_n,
                                const wavelengths *lambda) {
  const vlHairDef *hair = &m->hair;
  if (hair->color == VL_HAIR_SIGMA_A) return spectrum_at(w, &hair->sigma_a, VL_PARAMETER_UNBOUNDED, at, lambda);
  if (hair->color == VL_HAIR_REFLECTANCE) return absorption_of_hair_color(reflectance_at(w, m, at, lambda), beta_n);
  spectrum brown = color_at(find_color(&eumelanin, VL_PARAMETER_UNBOUNDED), lambda);
  spectrum red = color_at(find_color(&pheomelanin, VL_PARAMETER_UNBOUNDED), lambda);
  return plus(scaled(fmax(0, number_at(w, hair->eumelanin, at)), brown),
              scaled(fmax(0, number_at(w, hair->pheomelanin, at)), red));
}

static void make_hair(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda,
                      bsdf *b) {
  const vlHairDef *hair = &m->hair;
  b->more.kind = MORE_HAIR;
  b->more.offset = 2 * at->v - 1;
  b->ior = clamp(number_at(w, hair->eta, at), 1.0001, 10);
  b->more.beta_m = clamp(number_at(w, hair->beta_m, at), 0, 1);
  b->more.beta_n = clamp(number_at(w, hair->beta_n, at), 0, 1);
  b->more.tilt = number_at(w, hair->alpha, at) * PI / 180;
  b->more.absorption = hair_absorption(w, m, at, b->more.beta_n, lambda);
}

/* A metal's index of refraction is relative to the coat. */
static void make_coated(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda,
                        bsdf *b) {
  b->more.kind = MORE_COATED;
  b->more.metal = m->kind == VL_MATERIAL_COATED_CONDUCTOR;
  b->more.coat_alpha_x = alpha_at(w, m, b->more.metal ? m->coat_u_roughness : m->u_roughness, at);
  b->more.coat_alpha_y = alpha_at(w, m, b->more.metal ? m->coat_v_roughness : m->v_roughness, at);
  b->more.coat_thickness = number_at(w, m->thickness, at);
  b->more.coat_albedo = spectrum_at(w, &m->albedo, VL_PARAMETER_ALBEDO, at, lambda);
  b->more.coat_g = clamp(number_at(w, m->g, at), -0.999, 0.999);
  b->more.coat_depth = m->max_depth;
  wavelengths rgb = {.rgb = true};
  b->ior = ior_of(b->more.metal ? &m->coat_eta : &m->eta, &rgb);
  b->reflectance = reflectance_at(w, m, at, lambda);
  if (!b->more.metal) return;
  make_metal(w, m, at, lambda, b);
  b->eta = scaled(1 / b->ior, b->eta);
  b->k = scaled(1 / b->ior, b->k);
}

static void make_diffuse_transmission(const world *w, const vlMaterialDef *m, const shade_record *at,
                                      const wavelengths *lambda, bsdf *b) {
  b->more.kind = MORE_TRANSLUCENT;
  spectrum r = spectrum_at(w, &m->reflectance, VL_PARAMETER_ALBEDO, at, lambda);
  spectrum t = spectrum_at(w, &m->transmittance, VL_PARAMETER_ALBEDO, at, lambda);
  for (int i = 0; i < CHANNELS; i++) {
    b->reflectance.c[i] = clamp((double)m->scale * r.c[i], 0, 1);
    b->more.transmittance.c[i] = clamp((double)m->scale * t.c[i], 0, 1);
  }
}

static void make_thin_glass(const vlMaterialDef *m, wavelengths *lambda, bsdf *b) {
  b->more.kind = MORE_THIN_GLASS;
  if (find_color(&m->eta.value, VL_PARAMETER_UNBOUNDED)->varies) keep_first_wavelength(lambda);
  b->ior = ior_of(&m->eta, lambda);
}

/* Diffuse on both sides: one colour comes back, another goes through. */
static spectrum diffuse_transmission_value(const bsdf *b, vector wo, vector wi, double *density) {
  bool reflects = wo.z * wi.z > 0;
  double r = largest(b->reflectance), t = largest(b->more.transmittance);
  if (r + t > 0) *density = (reflects ? r : t) / (r + t) * fabs(wi.z) / PI;
  return scaled(fabs(wi.z) / PI, reflects ? b->reflectance : b->more.transmittance);
}

static bool sample_diffuse_transmission(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  double r = largest(b->reflectance), t = largest(b->more.transmittance);
  bool reflects = next_number(s) * (r + t) < r;
  result->wi = face_forward(sample_cosine_hemisphere(s), make_vector(0, 0, reflects ? wo.z : -wo.z));
  return r + t > 0;
}

/* Two parallel faces: light that enters is reflected between them any number of times. Of that, R + T R T + T R R R T +
 * ... = R + T^2 R / (1 - R^2) comes back, and the rest goes straight on. */
static void sample_thin_glass(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  double r = reflected_by_glass(fabs(wo.z), b->ior);
  if (r < 1) r += square(1 - r) * r / (1 - square(r));
  result->specular = true;
  bool reflects = next_number(s) < r;
  result->wi = make_vector(-wo.x, -wo.y, reflects ? wo.z : -wo.z);
}

void more_bsdf_at(const world *w, const vlMaterialDef *m, const shade_record *at, wavelengths *lambda, bsdf *b) {
  switch (m->kind) {
    case VL_MATERIAL_HAIR: make_hair(w, m, at, lambda, b); break;
    case VL_MATERIAL_DIFFUSE_TRANSMISSION: make_diffuse_transmission(w, m, at, lambda, b); break;
    case VL_MATERIAL_PRINCIPLED: make_principled(w, m, at, lambda, b); break;
    case VL_MATERIAL_THIN_DIELECTRIC: make_thin_glass(m, lambda, b); break;
    default: make_coated(w, m, at, lambda, b);
  }
}

spectrum more_bsdf_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  switch (b->more.kind) {
    case MORE_HAIR: return hair_value(b, wo, wi, density);
    case MORE_TRANSLUCENT: return diffuse_transmission_value(b, wo, wi, density);
    case MORE_THIN_GLASS: return gray(0);
    case MORE_PRINCIPLED: return principled_value(b, wo, wi, density);
    default: return coated_value(b, wo, wi, s, density);
  }
}

bool sample_more_bsdf(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  switch (b->more.kind) {
    case MORE_HAIR: sample_hair(b, wo, s, result); return true;
    case MORE_TRANSLUCENT: return sample_diffuse_transmission(b, wo, s, result);
    case MORE_PRINCIPLED: return sample_principled(b, wo, s, result);
    case MORE_THIN_GLASS: sample_thin_glass(b, wo, s, result); return true;
    default: return sample_coated(b, wo, s, result);
  }
}
