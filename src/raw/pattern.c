/* raw/pattern.c: the pattern of a sensor's filters, and its text. */
#include "base/cookie.h"
#include "base/error.h"
#include "base/text.h"
#include "raw/raw.h"

static const char letters[] = "RGBCMYW"; /* of the codes of vlRawColor */
enum { KNOWN_COLORS = sizeof letters - 1 };

char vl_raw_letter(uint32_t color) {
  return color < KNOWN_COLORS ? letters[color] : '?';
}

uint32_t vl_raw_colors(const vlRawDef *def, uint8_t colors[VL_RAW_MAX_COLORS]) {
  bool there[KNOWN_COLORS] = {false};
  uint32_t rows = def->pattern_rows, columns = def->pattern_columns, count = 0;
  if (rows < 1 || rows > VL_RAW_MAX_SIDE || columns < 1 || columns > VL_RAW_MAX_SIDE)
    return 0;
  for (uint32_t i = 0; i < rows * columns; i++) {
    if (def->pattern[i] >= KNOWN_COLORS)
      return 0;
    there[def->pattern[i]] = true;
  }
  for (uint8_t c = 0; c < KNOWN_COLORS; c++) {
    if (!there[c])
      continue;
    if (count == VL_RAW_MAX_COLORS)
      return 0;
    colors[count++] = c;
  }
  return count;
}

uint32_t vl_raw_planes(const vlRawDef *def, uint8_t planes[VL_RAW_MAX_CELLS]) {
  uint8_t colors[VL_RAW_MAX_COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  for (uint32_t i = 0; i < def->pattern_rows * def->pattern_columns; i++)
    for (uint8_t k = 0; k < count; k++)
      if (colors[k] == def->pattern[i])
        planes[i] = k;
  return count;
}

static vlResult wrong(vlError *error, const char *text, const char *what) {
  vlArgumentText shown = vl_argument_text(text);
  return vl_fail_argument(error, "pattern \"%s\": %s", shown.text, what);
}

/* Reads the letters into def. */
static vlResult read_rows(vlRawDef *def, const char *text, vlError *error) {
  uint32_t row = 0, column = 0;
  for (const char *c = text; *c; c++) {
    if (*c == '/') {
      if (row > 0 && column != def->pattern_columns)
        return wrong(error, text, "its rows have different lengths");
      def->pattern_columns = column;
      row++;
      column = 0;
      continue;
    }
    const char *letter = strchr(letters, *c);
    if (!letter)
      return wrong(error, text, "its letters are R G B C M Y W, its rows are separated by /");
    if (column == VL_RAW_MAX_SIDE || row == VL_RAW_MAX_SIDE)
      return wrong(error, text, "it has more than 8 rows or columns");
    def->pattern[(row ? row * def->pattern_columns : 0) + column] = (uint8_t)(letter - letters);
    column++;
    if (row > 0 && column > def->pattern_columns)
      return wrong(error, text, "its rows have different lengths");
  }
  if (column == 0 || (row > 0 && column != def->pattern_columns))
    return wrong(error, text, "its rows have different lengths");
  def->pattern_columns = column;
  def->pattern_rows = row + 1;
  return VL_OK;
}

vlResult vl_raw_set_pattern(vlRawDef *def, const char *text, vlError *error) {
  vl_error_clear(error);
  if (!def || !text)
    return vl_fail_argument(error, "pattern: def or text is null");
  if (def->cookie != VL_COOKIE_RAW)
    return vl_fail_argument(error, "pattern: " VL_BAD_COOKIE);
  vlRawDef changed = *def;
  uint8_t colors[VL_RAW_MAX_COLORS];
  memset(changed.pattern, 0, sizeof changed.pattern);
  VL_TRY(read_rows(&changed, text, error));
  if (!vl_raw_colors(&changed, colors))
    return wrong(error, text, "it has more than 4 colours");
  *def = changed;
  return VL_OK;
}

void vl_raw_pattern_text(const vlRawDef *def, char text[80]) {
  uint32_t rows = def->pattern_rows, columns = def->pattern_columns;
  uint8_t colors[VL_RAW_MAX_COLORS];
  char *end = text;
  *end = 0;
  if (!vl_raw_colors(def, colors))
    return;
  for (uint32_t y = 0; y < rows; y++) {
    if (y)
      *end++ = '/';
    for (uint32_t x = 0; x < columns; x++)
      *end++ = vl_raw_letter(def->pattern[y * columns + x]);
  }
  *end = 0;
}
