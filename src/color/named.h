/* color/named.h: named spectra (metals, glasses, illuminants). */
#ifndef COLOR_NAMED_H
#define COLOR_NAMED_H

/* Index from 0; null past the end. */
const char *vl_named_spectrum_name(unsigned index);
/* Dense (471 values, velo's range) or null for an unknown name. Lives forever. */
const float *vl_named_spectrum(const char *name);

#endif
