/* color/named.h: named spectra (metals, glasses, illuminants). */
#ifndef COLOR_NAMED_H
#define COLOR_NAMED_H

/* Name of the spectrum at an index, counted from 0; null past the end. */
const char *vl_named_spectrum_name(unsigned index);
/* The same name in static storage. Null for an unknown name: *near is then the nearest one, or
 * null. */
const char *vl_named_spectrum_find(const char *name, const char **near);
/* Dense spectrum of that name (471 values, 360 to 830 nm) in static storage; null for an
 * unknown name. */
const float *vl_named_spectrum(const char *name);

#endif
