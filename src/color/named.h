/* color/named.h: named spectra (metals, glasses, illuminants). */
#ifndef COLOR_NAMED_H
#define COLOR_NAMED_H

/* Name by index, from 0; null past the end. */
const char *vl_named_spectrum_name(unsigned index);
/* Dense spectrum (471 values, 360 to 830 nm), or null for an unknown name. Static storage. */
const float *vl_named_spectrum(const char *name);

#endif
