/* color/named.c: finds spectra by name. */
#include "color/named.h"

#include "base/text.h"
#include "color/tables.h"

const char *vl_named_spectrum_name(unsigned index) {
  return index < vl_table_named_count ? vl_table_named[index].name : NULL;
}

const float *vl_named_spectrum(const char *name) {
  if (!name)
    return NULL;
  for (uint32_t i = 0; i < vl_table_named_count; i++) {
    if (vl_text_is(vl_table_named[i].name, name))
      return vl_table_named[i].values;
  }
  return NULL;
}
