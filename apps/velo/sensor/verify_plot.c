/* sensor/verify_plot.c: the photon transfer curve as SVG: variance over mean, measured as
 * points and expected as a line. */
#include <math.h>
#include <stdio.h>

#include "cli/report.h"
#include "sensor/verify.h"

enum { WIDTH = 640, HEIGHT = 420, LEFT = 80, RIGHT = 20, TOP = 40, BOTTOM = 50 };

typedef struct Axes {
  double x, y; /* what the ends of the axes are */
} Axes;

static double svg_x(const Axes *a, double x) {
  return LEFT + x / a->x * (WIDTH - LEFT - RIGHT);
}
static double svg_y(const Axes *a, double y) {
  return HEIGHT - BOTTOM - y / a->y * (HEIGHT - TOP - BOTTOM);
}

/* The smallest of 1, 2, 5 times a power of ten that is not below x. */
static double round_up(double x) {
  double power = pow(10.0, floor(log10(x)));
  double digits = x / power;
  return power * (digits <= 1.0 ? 1.0 : digits <= 2.0 ? 2.0 : digits <= 5.0 ? 5.0 : 10.0);
}

static void put_axes(FILE *file, const Axes *a) {
  fprintf(file,
          "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n"
          "<path d=\"M%d %dV%dH%d\" fill=\"none\" stroke=\"#000\"/>\n"
          "<text x=\"%d\" y=\"24\">photon transfer</text>\n"
          "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">mean of the light, DN</text>\n"
          "<text x=\"8\" y=\"%d\">variance, DN²</text>\n",
          LEFT, TOP, HEIGHT - BOTTOM, WIDTH - RIGHT, LEFT, WIDTH - RIGHT, HEIGHT - 8, TOP - 8);
  for (int i = 0; i <= 5; i++) {
    double x = a->x * i / 5;
    double y = a->y * i / 5;
    fprintf(file,
            "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g</text>\n"
            "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n",
            svg_x(a, x), HEIGHT - BOTTOM + 18, x, LEFT - 6, svg_y(a, y) + 4, y);
  }
}

int verify_plot(const Verify *v, const char *path) {
  Axes axes = {0.0, 0.0};
  for (int i = 0; i < VERIFY_STEPS; i++) {
    axes.x = fmax(axes.x, v->steps[i].mean - v->steps[i].dark_mean);
    axes.y = fmax(axes.y, v->steps[i].variance);
  }
  axes.x = round_up(fmax(axes.x, 1e-3));
  axes.y = round_up(fmax(axes.y, 1e-3));
  FILE *file = fopen(path, "wb");
  if (!file)
    return report_failure(STATUS_IO, "%s: cannot be written", path);
  fprintf(file,
          "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
          "font-family=\"sans-serif\" font-size=\"12\">\n",
          WIDTH, HEIGHT);
  put_axes(file, &axes);
  fprintf(file, "<polyline fill=\"none\" stroke=\"#888\" points=\"");
  for (int i = 0; i < VERIFY_STEPS; i++) {
    const VerifyStep *step = &v->steps[i];
    fprintf(file, "%.1f,%.1f ", svg_x(&axes, step->mean - step->dark_mean),
            svg_y(&axes, verify_expected_variance(v, step)));
  }
  fprintf(file, "\"/>\n");
  for (int i = 0; i < VERIFY_STEPS; i++) {
    const VerifyStep *step = &v->steps[i];
    fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.5\" fill=\"#06c\"/>\n",
            svg_x(&axes, step->mean - step->dark_mean), svg_y(&axes, step->variance));
  }
  fprintf(file, "</svg>\n");
  bool failed = ferror(file) != 0;
  failed |= fclose(file) != 0;
  return failed ? report_failure(STATUS_IO, "%s: cannot be written", path) : -1;
}
