/* light/lamp_ies.c: reads IES files: LM-63-1986, -1991, -1995, -2002 and -2019. After the line
 * TILT= all is numbers, which lines only separate. The TILT section is read and checked, but
 * its factors are not applied: they are for lamps that are mounted tilted against the
 * measurement, and the intensities of the file are those of the measurement. */
#include <string.h>

#include "base/error.h"
#include "base/text.h"
#include "light/lamp.h"
#include "light/lamp_text.h"

/* What the numbers before the angles say, in the order of the file. */
typedef struct Header {
  uint32_t lamps;
  double lumens; /* per lamp; -1: absolute photometry */
  double multiplier;
  uint32_t vertical, horizontal;
  uint32_t type;  /* 1: C, 2: B, 3: A */
  uint32_t units; /* 1: feet, 2: metres */
  double width, length, height;
  double ballast;
  double photometric; /* ballast-lamp photometric factor; since 2002 for future use; in 2019 the
                         type of the file's generation */
  double watts;
} Header;

typedef struct Edition {
  const char *first_line, *name;
  bool generation; /* the number after the ballast factor is not a factor */
} Edition;

static const Edition editions[] = {
    {"IESNA91", "IES LM-63-1991", false},
    {"IESNA:LM-63-1995", "IES LM-63-1995", false},
    {"IESNA:LM-63-2002", "IES LM-63-2002", false},
    {"IES:LM-63-2019", "IES LM-63-2019", true},
};
static const Edition oldest = {"", "IES LM-63-1986", false};

static bool line_is(const vlLampLine *line, const char *word) {
  return line->length == strlen(word) && memcmp(line->text, word, line->length) == 0;
}

static bool line_starts(const vlLampLine *line, const char *word) {
  size_t length = strlen(word);
  return line->length >= length && memcmp(line->text, word, length) == 0;
}

static void copy_text(char *to, size_t size, const char *text, size_t length) {
  while (length > 0 && (*text == ' ' || *text == '\t')) {
    text++;
    length--;
  }
  length = length < size ? length : size - 1;
  memcpy(to, text, length);
  to[length] = 0;
  vl_make_printable(to);
}

/* Reads the lines up to TILT=. False: the error is set. *included: the TILT section follows. */
static bool read_labels(vlLampText *t, vlLampInfo *info, const Edition **edition,
                        bool *included) {
  vlLampLine line;
  *edition = &oldest;
  bool first = true;
  while (vl_lamp_line(t, &line)) {
    for (size_t i = 0; first && i < VL_LENGTH(editions); i++)
      if (line_is(&line, editions[i].first_line))
        *edition = &editions[i];
    first = false;
    if (line_starts(&line, "[LUMINAIRE]"))
      copy_text(info->name, sizeof info->name, line.text + 11, line.length - 11);
    if (line_starts(&line, "TILT=")) {
      *included = line_is(&line, "TILT=INCLUDE");
      snprintf(info->format, sizeof info->format, "%s", (*edition)->name);
      return true;
    }
  }
  return vl_lamp_fail(t, 0, "lamp file: an IES file has a line \"TILT=\", this has none");
}

enum { MAX_ANGLES = 10000 };

static bool read_tilt(vlLampText *t) {
  uint32_t geometry, pairs;
  if (!vl_lamp_whole(t, "lamp to luminaire geometry", 1, 3, &geometry) ||
      !vl_lamp_whole(t, "number of tilt angles", 1, MAX_ANGLES, &pairs))
    return false;
  double number;
  for (uint32_t i = 0; i < pairs; i++)
    if (!vl_lamp_number(t, "tilt angle", &number))
      return false;
  for (uint32_t i = 0; i < pairs; i++)
    if (!vl_lamp_number(t, "tilt factor", &number))
      return false;
  return true;
}

static bool read_header(vlLampText *t, Header *h) {
  return vl_lamp_whole(t, "number of lamps", 0, 1e6, &h->lamps) &&
         vl_lamp_number(t, "lumens per lamp", &h->lumens) &&
         vl_lamp_number(t, "candela multiplier", &h->multiplier) &&
         vl_lamp_whole(t, "number of vertical angles", 1, MAX_ANGLES, &h->vertical) &&
         vl_lamp_whole(t, "number of horizontal angles", 1, MAX_ANGLES, &h->horizontal) &&
         vl_lamp_whole(t, "photometric type", 1, 3, &h->type) &&
         vl_lamp_whole(t, "units type", 1, 2, &h->units) &&
         vl_lamp_number(t, "width", &h->width) && vl_lamp_number(t, "length", &h->length) &&
         vl_lamp_number(t, "height", &h->height) &&
         vl_lamp_number(t, "ballast factor", &h->ballast) &&
         vl_lamp_number(t, "ballast-lamp photometric factor", &h->photometric) &&
         vl_lamp_number(t, "input watts", &h->watts);
}

/* The factor on the numbers of the file. Negative: the error is set. */
static double factor_of(const vlLampText *t, const Header *h, const Edition *edition) {
  const struct {
    const char *name;
    double value;
  } factors[] = {{"candela multiplier", h->multiplier},
                 {"ballast factor", h->ballast},
                 {"ballast-lamp photometric factor", edition->generation ? 1 : h->photometric}};
  double product = 1;
  for (size_t i = 0; i < VL_LENGTH(factors); i++) {
    if (!(factors[i].value > 0)) {
      vl_lamp_fail(t, t->line, "lamp file: the %s is %g, it must be above 0", factors[i].name,
                   factors[i].value);
      return -1;
    }
    product *= factors[i].value;
  }
  return product;
}

/* Ascending angles, in degrees. */
static bool read_angles(vlLampText *t, const char *what, uint32_t count, double low,
                        double high, double *angles) {
  for (uint32_t i = 0; i < count; i++) {
    if (!vl_lamp_number(t, what, &angles[i]))
      return false;
    if (!(angles[i] >= low && angles[i] <= high))
      return vl_lamp_fail(t, t->line, "lamp file: the %s %g is not between %g and %g degrees",
                          what, angles[i], low, high);
    if (i > 0 && !(angles[i] - angles[i - 1] >= VL_LAMP_STEP))
      return vl_lamp_fail(t, t->line,
                          "lamp file: the %s %g follows %g; the least step is %g degrees", what,
                          angles[i], angles[i - 1], VL_LAMP_STEP);
  }
  return true;
}

static bool read_candela(vlLampText *t, double factor, vlLampData *data) {
  for (uint32_t i = 0; i < data->planes * data->angles; i++) {
    double number;
    if (!vl_lamp_number(t, "candela value", &number))
      return false;
    data->candela[i] = factor * number;
    if (!(number >= 0 && data->candela[i] <= VL_LAMP_BRIGHTEST))
      return vl_lamp_fail(
          t, t->line,
          "lamp file: the candela value %g, times the factors %g, is not between 0 "
          "and %g",
          number, factor, VL_LAMP_BRIGHTEST);
  }
  return vl_lamp_end(t, data->planes, data->angles);
}

static bool read_table(vlLampText *t, double factor, vlLampData *data) {
  /* degrees; type C: from the nadir up, and all around; A and B: up and down, left and right */
  const bool around = data->type == 'C';
  const double low = around ? 0 : -90;
  return read_angles(t, "vertical angle", data->angles, low, around ? 180 : 90,
                     data->vertical) &&
         read_angles(t, "horizontal angle", data->planes, low, around ? 360 : 90,
                     data->horizontal) &&
         vl_lamp_check_angles(t, data) && read_candela(t, factor, data);
}

vlResult vl_lamp_read_ies(vlLamp *lamp, const char *name, const char *text, size_t size,
                          vlLampData *data, vlError *error) {
  vlLampText t = {name, text, text + size, 1, error};
  vlLampInfo *info = &lamp->info;
  const Edition *edition;
  bool included = false;
  Header h;
  if (!read_labels(&t, info, &edition, &included) || (included && !read_tilt(&t)) ||
      !read_header(&t, &h))
    return VL_ERROR_SCENE;
  double factor = factor_of(&t, &h, edition);
  if (factor < 0)
    return VL_ERROR_SCENE;
  if ((size_t)h.vertical * h.horizontal > size) { /* each number takes two bytes */
    vl_lamp_fail(&t, t.line, "lamp file: it is too short for %u x %u angles", h.horizontal,
                 h.vertical);
    return VL_ERROR_SCENE;
  }
  info->lamps_flux = h.lumens >= 0 ? h.lamps * h.lumens : VL_UNSET;
  info->watts = h.watts > 0 ? h.watts : VL_UNSET;
  data->type = h.type == 1 ? 'C' : h.type == 2 ? 'B' : 'A';
  if (!vl_lamp_data_allocate(lamp->context, data, h.horizontal, h.vertical))
    return vl_fail_memory(error);
  return read_table(&t, factor, data) ? VL_OK : VL_ERROR_SCENE;
}
