/* light/lamp_eulumdat.c: reads EULUMDAT files (.ldt; Stockmar 1990): one value per line. The
 * intensities are candela per 1000 lumens of the lamps, of which the first set counts. */
#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "light/lamp.h"
#include "light/lamp_text.h"

enum { MAX_PLANES = 721, MAX_SETS = 20 };

/* What the lines before the angles say. */
typedef struct Header {
  uint32_t symmetry; /* 0: none; 1: about the axis; 2: of C 0 - C 180; 3: of C 90 - C 270; 4: of
                        both */
  uint32_t planes, angles;
  double conversion;  /* factor on the intensities */
  double flux, watts; /* of the first set of lamps: lm, W */
  bool absolute;
} Header;

/* The next line. False: the error is set. */
static bool next_line(vlLampText *t, const char *what, vlLampLine *line) {
  if (vl_lamp_line(t, line))
    return true;
  return vl_lamp_fail(t, t->line, "lamp file: it ends before the %s", what);
}

static bool skip_lines(vlLampText *t, const char *what, uint32_t count) {
  vlLampLine line;
  for (uint32_t i = 0; i < count; i++)
    if (!next_line(t, what, &line))
      return false;
  return true;
}

static bool number_line(vlLampText *t, const char *what, double low, double high,
                        double *value) {
  vlLampLine line;
  if (!next_line(t, what, &line))
    return false;
  if (!vl_lamp_decimal(line.text, line.length, true, value))
    return vl_lamp_fail(t, line.number, "lamp file: the %s: \"%s\" is not a number", what,
                        vl_short_text_of(line.text, line.length).text);
  if (*value >= low && *value <= high)
    return true;
  return vl_lamp_fail(t, line.number, "lamp file: the %s is %g; it must be from %g to %g", what,
                      *value, low, high);
}

static bool whole_line(vlLampText *t, const char *what, double low, double high,
                       uint32_t *value) {
  uint32_t line = t->line;
  double number;
  if (!number_line(t, what, low, high, &number))
    return false;
  *value = (uint32_t)number;
  if (number == floor(number))
    return true;
  return vl_lamp_fail(t, line, "lamp file: the %s is %g, not a whole number", what, number);
}

/* One set of lamps: number, type, flux of all of them, colour, rendering index, power. A
 * negative number stands for absolute photometry. */
static bool read_set(vlLampText *t, bool first, Header *h) {
  double count, flux, watts;
  if (!number_line(t, "number of lamps", -1e6, 1e6, &count) ||
      !skip_lines(t, "type of lamps", 1) ||
      !number_line(t, "flux of the lamps", 0, 1e12, &flux) ||
      !skip_lines(t, "colour of the lamps", 2) ||
      !number_line(t, "power of the lamps", -1e12, 1e12, &watts))
    return false;
  if (!first)
    return true;
  h->absolute = count < 0;
  h->flux = flux;
  h->watts = watts;
  return true;
}

static bool read_header(vlLampText *t, vlLampInfo *info, Header *h) {
  double number;
  uint32_t kind, sets;
  vlLampLine name;
  if (!skip_lines(t, "company", 1) || !whole_line(t, "type indicator", 0, 3, &kind) ||
      !whole_line(t, "symmetry", 0, 4, &h->symmetry) ||
      !whole_line(t, "number of C planes", 1, MAX_PLANES, &h->planes) ||
      !number_line(t, "distance of C planes", 0, 360, &number) ||
      !whole_line(t, "number of intensities per plane", 2, MAX_PLANES, &h->angles) ||
      !number_line(t, "distance of intensities", 0, 180, &number) ||
      !skip_lines(t, "report number", 1) || !next_line(t, "luminaire's name", &name) ||
      !skip_lines(t, "date", 3) || !skip_lines(t, "sizes", 9) ||
      !skip_lines(t, "flux fraction", 2) ||
      !number_line(t, "conversion factor", 0, 1e12, &h->conversion) ||
      !skip_lines(t, "tilt", 1) ||
      !whole_line(t, "number of sets of lamps", 1, MAX_SETS, &sets))
    return false;
  snprintf(info->name, sizeof info->name, "%.*s",
           (int)(name.length < sizeof info->name ? name.length : sizeof info->name - 1),
           name.text);
  vl_make_printable(info->name);
  for (uint32_t i = 0; i < sets; i++)
    if (!read_set(t, i == 0, h))
      return false;
  return skip_lines(t, "direct ratios", 10);
}

/* The planes that the file has intensities of: the first, and how many. */
static bool stored_planes(const vlLampText *t, const Header *h, uint32_t *first,
                          uint32_t *count) {
  static const uint32_t divisors[] = {1, 1, 2, 4, 4};
  uint32_t n = h->planes;
  if (h->symmetry != 1 && (n < 4 || n % divisors[h->symmetry] != 0))
    return vl_lamp_fail(t, 4,
                        "lamp file: %u C planes; symmetry %u has 4 or more, a multiple of %u",
                        n, h->symmetry, divisors[h->symmetry]);
  *first = h->symmetry == 3 ? 3 * n / 4 : 0;
  *count = h->symmetry == 0   ? n
           : h->symmetry == 1 ? 1
           : h->symmetry == 4 ? n / 4 + 1
                              : n / 2 + 1;
  return true;
}

/* The angles of all planes, of which those of the stored planes go to data; planes after the
 * last one are 360 degrees further. */
static bool read_planes(vlLampText *t, const Header *h, uint32_t first, vlLampData *data) {
  double previous = -1;
  for (uint32_t i = 0; i < h->planes; i++) {
    uint32_t line = t->line;
    double angle;
    if (!number_line(t, "C angle", 0, 360, &angle))
      return false;
    if (!(angle - previous >= VL_LAMP_STEP))
      return vl_lamp_fail(t, line,
                          "lamp file: the C angle %g follows %g; the least step is %g degrees",
                          angle, previous, VL_LAMP_STEP);
    previous = angle;
    uint32_t at = (i + h->planes - first) % h->planes;
    if (at < data->planes)
      data->horizontal[at] = i < first ? angle + 360 : angle;
  }
  return true;
}

static bool read_gammas(vlLampText *t, vlLampData *data) {
  double previous = -1;
  for (uint32_t i = 0; i < data->angles; i++) {
    uint32_t line = t->line;
    if (!number_line(t, "gamma angle", 0, 180, &data->vertical[i]))
      return false;
    if (!(data->vertical[i] - previous >= VL_LAMP_STEP))
      return vl_lamp_fail(
          t, line, "lamp file: the gamma angle %g follows %g; the least step is %g degrees",
          data->vertical[i], previous, VL_LAMP_STEP);
    previous = data->vertical[i];
  }
  return true;
}

static bool read_intensities(vlLampText *t, double factor, vlLampData *data) {
  for (uint32_t i = 0; i < data->planes * data->angles; i++) {
    uint32_t line = t->line;
    double number;
    if (!number_line(t, "intensity", 0, 1e30, &number))
      return false;
    data->candela[i] = factor * number;
    if (!(data->candela[i] <= VL_LAMP_BRIGHTEST))
      return vl_lamp_fail(t, line, "lamp file: the intensity is above %g candela",
                          VL_LAMP_BRIGHTEST);
  }
  return vl_lamp_end(t, data->planes, data->angles);
}

vlResult vl_lamp_read_eulumdat(vlLamp *lamp, const char *name, const char *text, size_t size,
                               vlLampData *data, vlError *error) {
  vlLampText t = {name, text, text + size, 1, error};
  Header h = {0};
  uint32_t first = 0, count = 0;
  if (!read_header(&t, &lamp->info, &h) || !stored_planes(&t, &h, &first, &count))
    return VL_ERROR_SCENE;
  snprintf(lamp->info.format, sizeof lamp->info.format, "EULUMDAT");
  lamp->info.lamps_flux = h.absolute ? VL_UNSET : h.flux;
  lamp->info.watts = h.watts > 0 ? h.watts : VL_UNSET;
  data->type = 'C';
  if (!vl_lamp_data_allocate(lamp->context, data, count, h.angles))
    return vl_fail_memory(error);
  double factor = h.conversion * h.flux / 1000;
  if (!read_planes(&t, &h, first, data) || !read_gammas(&t, data) ||
      !vl_lamp_check_angles(&t, data) || !read_intensities(&t, factor, data))
    return VL_ERROR_SCENE;
  return VL_OK;
}
