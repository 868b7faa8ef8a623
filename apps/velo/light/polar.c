/* light/polar.c: see polar.h. The nadir is below, as in catalogues; the plane C 0 - C 180 is
 * drawn through, C 90 - C 270 dashed; the rings are labelled in candela. */
#include "light/polar.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/report.h"

#define PI 3.14159265358979323846

enum { SIDE = 480, RADIUS = 200, RINGS = 4 };

double polar_intensity(const vlLamp *lamp, double c, double angle) {
  const double d[3] = {sin(angle) * cos(c), -cos(angle), -sin(angle) * sin(c)};
  return vl_lamp_intensity(lamp, d);
}

/* The least of 1, 2, 2.5 and 5 times a power of ten that RINGS times is not below the number.
 */
static double ring_step(double greatest) {
  static const double steps[] = {1, 2, 2.5, 5, 10};
  double least = greatest / RINGS;
  double power = pow(10, floor(log10(least)));
  for (int i = 0; i < 4; i++)
    if (steps[i] * power >= least)
      return steps[i] * power;
  return 10 * power;
}

static void write_rings(FILE *out, double step) {
  for (int i = 1; i <= RINGS; i++)
    fprintf(out, "<circle r=\"%d\"/>\n", RADIUS * i / RINGS);
  for (int degrees = 0; degrees < 360; degrees += 30)
    fprintf(out, "<line x2=\"%.2f\" y2=\"%.2f\"/>\n", RADIUS * sin(degrees * PI / 180),
            RADIUS * cos(degrees * PI / 180));
  fprintf(out, "</g>\n<g font-size=\"11\" font-family=\"sans-serif\" fill=\"#444\">\n");
  for (int i = 1; i <= RINGS; i++)
    fprintf(out, "<text x=\"3\" y=\"%d\">%g</text>\n", RADIUS * i / RINGS - 3, i * step);
  for (int degrees = -150; degrees <= 180; degrees += 30)
    fprintf(out, "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"middle\">%d\u00b0</text>\n",
            (RADIUS + 16) * sin(degrees * PI / 180),
            (RADIUS + 16) * cos(degrees * PI / 180) + 4, degrees < 0 ? -degrees : degrees);
  fprintf(out, "</g>\n");
}

static void write_curve(FILE *out, const vlLamp *lamp, double c, double most,
                        const char *style) {
  fprintf(out, "<path fill=\"none\" stroke-width=\"2\" %s d=\"", style);
  for (int k = -360; k <= 360; k++) {
    double angle = k * PI / 360;
    double r = RADIUS * polar_intensity(lamp, c, angle) / most;
    fprintf(out, "%s%.2f %.2f", k == -360 ? "M" : "L", r * sin(angle), r * cos(angle));
  }
  fprintf(out, "Z\"/>\n");
}

static void write_text(FILE *out, const char *text) {
  for (; *text; text++)
    switch (*text) {
      case '&':
        fputs("&amp;", out);
        break;
      case '<':
        fputs("&lt;", out);
        break;
      default:
        fputc(*text, out);
    }
}

static void write_svg(FILE *out, const vlLamp *lamp, const vlLampInfo *info,
                      const char *title) {
  double step = info->max_intensity > 0 ? ring_step(info->max_intensity) : 1;
  fprintf(out,
          "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
          "viewBox=\"%d %d %d %d\">\n<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" "
          "fill=\"white\"/>\n<title>",
          SIDE, SIDE + 40, -SIDE / 2, -SIDE / 2, SIDE, SIDE + 40, -SIDE / 2, -SIDE / 2, SIDE,
          SIDE + 40);
  write_text(out, title);
  fprintf(out, "</title>\n<g fill=\"none\" stroke=\"#bbb\" stroke-width=\".7\">\n");
  write_rings(out, step);
  write_curve(out, lamp, PI / 2, RINGS * step, "stroke=\"#06c\" stroke-dasharray=\"6 4\"");
  write_curve(out, lamp, 0, RINGS * step, "stroke=\"#c30\"");
  fprintf(out,
          "<g font-size=\"13\" font-family=\"sans-serif\"><text x=\"%d\" y=\"%d\" "
          "fill=\"#c30\">C 0\u2013C 180</text><text x=\"%d\" y=\"%d\" fill=\"#06c\">C 90\u2013"
          "C 270 (dashed)</text><text x=\"%d\" y=\"%d\">cd; %.4g lm</text></g>\n</svg>\n",
          -RADIUS, SIDE / 2 + 16, -RADIUS + 110, SIDE / 2 + 16, RADIUS - 100, SIDE / 2 + 16,
          info->flux);
}

int polar_write(vlContext *context, const char *path, const vlLamp *lamp,
                const vlLampInfo *info, const char *title) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return report_reason(VL_ERROR_MEMORY, path, "polar diagram");
  write_svg(out, lamp, info, title);
  if (fclose(out) != 0) {
    free(text);
    return report_reason(VL_ERROR_MEMORY, path, "polar diagram");
  }
  vlError error = {0};
  vlResult r = vl_write_file(context, path, text, size, &error);
  free(text);
  return r == VL_OK ? STATUS_OK : report_error(&error, r, path);
}
