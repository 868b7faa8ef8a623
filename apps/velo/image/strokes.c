/* image/strokes.c: overlay_text: letters as strokes. */

#include "image/overlay.h"

/* Points of the strokes of a letter: two digits each, x to the right and y downwards; the base
 * line is y = 6, small letters begin at y = 2, a stroke ends at |. */
static const char *strokes_of(char letter) {
  static const char *const small[26] = {"42 46|43 32 12 03 05 16 36 45",
                                        "00 06|03 12 32 43 45 36 16 05",
                                        "43 32 12 03 05 16 36 45",
                                        "40 46|43 32 12 03 05 16 36 45",
                                        "04 44 43 32 12 03 05 16 36 45",
                                        "41 30 20 11 16|02 32",
                                        "42 47 38 18 07|43 32 12 03 05 16 36 45",
                                        "00 06|03 12 32 43 46",
                                        "22 26|20 20",
                                        "32 37 28 18|30 30",
                                        "00 06|42 04|24 46",
                                        "10 15 26 36",
                                        "02 06|03 12 23 26|23 32 43 46",
                                        "02 06|03 12 32 43 46",
                                        "12 32 43 45 36 16 05 03 12",
                                        "02 08|03 12 32 43 45 36 16 05",
                                        "42 48|43 32 12 03 05 16 36 45",
                                        "02 06|04 13 22 32",
                                        "43 32 12 03 14 34 45 36 16 05",
                                        "10 15 26 36|02 32",
                                        "02 05 16 36 45|42 46",
                                        "02 26 42",
                                        "02 16 24 36 42",
                                        "02 46|42 06",
                                        "02 26|42 08",
                                        "02 42 06 46"};
  static const char *const digits[10] = {"10 30 41 45 36 16 05 01 10",
                                         "11 20 26",
                                         "01 10 30 41 42 06 46",
                                         "00 40 23 33 44 45 36 16 05",
                                         "36 30 04 44",
                                         "40 00 03 33 44 45 36 06",
                                         "30 10 02 05 16 36 45 44 33 13 04",
                                         "00 40 16",
                                         "13 02 01 10 30 41 42 33 13 04 05 16 36 45 44 33",
                                         "43 13 02 01 10 30 41 44 26"};
  if (letter >= 'a' && letter <= 'z')
    return small[letter - 'a'];
  if (letter >= '0' && letter <= '9')
    return digits[letter - '0'];
  if (letter == 'P')
    return "06 00 30 41 42 33 03";
  return letter == '\'' ? "10 12" : "";
}

static double advance(char letter) {
  return letter == '\'' || letter == ' ' ? 3.0 : 5.5;
}

double overlay_text_width(const char *text, double size) {
  double width = 0;
  for (; *text; text++)
    width += advance(*text);
  return (width - 1.5) * size / 6.0;
}

void overlay_text(Overlay *o, const char *text, double x, double y, double size, double width) {
  double unit = size / 6.0;
  for (; *text; text++) {
    const char *s = strokes_of(*text);
    double last[2] = {0, 0};
    bool connected = false;
    while (*s) {
      double px = x + (s[0] - '0') * unit, py = y + (s[1] - '0' - 6) * unit;
      bool ends = s[2] != ' ';
      if (connected)
        overlay_line(o, last[0], last[1], px, py, width);
      last[0] = px;
      last[1] = py;
      connected = !ends;
      s += s[2] ? 3 : 2;
    }
    x += advance(*text) * unit;
  }
}
