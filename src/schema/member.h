/* schema/member.h: how a def stores the values of its parameters. */
#ifndef SCHEMA_MEMBER_H
#define SCHEMA_MEMBER_H

#include "velo/scene_base.h"
#include "velo/schema.h"
#include "velo/spectrum.h"

/* How the value of a parameter is stored. Offsets are from the value's begin. */
typedef struct vlMemberType {
  int numbers;   /* 1 or 3; 0: it holds a spectrum, a text, or something else */
  size_t number; /* offset of the first one */
  double (*get)(const void *at, int i);
  void (*put)(void *at, int i, double number);
  bool textured;    /* it begins with the id of a texture, which stands for the rest */
  bool spectral;    /* it holds a spectrum */
  size_t spectrum;  /* offset of the spectrum */
  bool text;        /* it is a pointer to characters */
  const char *rule; /* what it must be; null: check.c writes that */
} vlMemberType;
extern const vlMemberType vl_member_types[]; /* by vlParameterType */

static inline uint32_t vl_member_texture(const vlMemberType *type, const void *at) {
  return type->textured ? ((const vlTextureId *)at)->index : 0;
}

static inline double vl_member_number(const vlMemberType *type, const void *at, int i) {
  return type->get((const char *)at + type->number, i);
}

static inline const vlSpectrum *vl_member_spectrum(const vlMemberType *type, const void *at) {
  return (const vlSpectrum *)(const void *)((const char *)at + type->spectrum);
}

#endif
