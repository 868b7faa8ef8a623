/* material.h: what a surface is made of; at a point it becomes a BSDF. */
#pragma once
#include "bsdf.h"
#include "world.h"

/* The material at the point: of a mix one of its two, drawn by their shares. */
const vlMaterialDef *material_at(const world *w, const shade_record *at, sampler *s);
/* The BSDF at the point. It may keep only the first wavelength: glass whose index depends on it. */
bsdf make_bsdf(const world *w, const vlMaterialDef *m, const shade_record *at, wavelengths *lambda);

/* Inputs at the point. */
spectrum reflectance_at(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda);
double alpha_at(const world *w, const vlMaterialDef *m, vlFloatInput roughness, const shade_record *at);
/* A dielectric's index of refraction. An RGB render has one: that of catalogues, at the yellow line of sodium. */
double ior_of(const world *w, const vlSpectrumInput *eta, const wavelengths *lambda);
/* eta and k of a metal. */
void make_metal(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda, bsdf *b);
