/* material.h: what a surface is made of; at a point it becomes a BSDF. */
#ifndef REFERENCE_MATERIAL_H
#define REFERENCE_MATERIAL_H

#include "bsdf.h"
#include "world.h"

/* A material of the scene and its spectra. */
struct material {
  vlMaterialDef def;
  color reflectance, eta, k;
  bool disperses; /* its index of refraction differs between wavelengths */
  more_material more;
};

bool read_materials(world *w, vlError *error);
/* The material at the point: of a mix one of its two, drawn by their shares. */
const material *material_at(const world *w, const shade_record *at, sampler *s);
/* Whether the surface only separates media. */
bool is_interface(const material *m);
/* The BSDF at the point. It may keep only the first wavelength: glass whose index depends on it. */
bsdf make_bsdf(const world *w, const material *m, const shade_record *at, wavelengths *lambda);

/* Inputs at the point. An RGB render has one index of refraction: that of catalogues, at the yellow line of sodium. */
spectrum reflectance_at(const world *w, const material *m, const shade_record *at, const wavelengths *lambda);
double alpha_at(const world *w, const material *m, vlFloatInput roughness, const shade_record *at);
double ior_of(const color *eta, const wavelengths *lambda);

#endif
