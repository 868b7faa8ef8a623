/* light/info.c: `velo light info`: the flux, the angles and the intensities of a lamp file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "velo/lamp.h"

enum { SIDE = 480, RADIUS = 200, RINGS = 4 };

/* Intensity in candela in the plane of C (radians, and of C + 180 degrees), at an angle from
 * the nadir (radians, negative: in the half plane of C + 180 degrees). */
static double polar_intensity(const vlLamp *lamp, double c, double angle) {
  const double d[3] = {sin(angle) * cos(c), -cos(angle), -sin(angle) * sin(c)};
  return vl_lamp_intensity(lamp, d);
}

/* The least of 1, 2, 2.5 and 5 times a power of ten that RINGS times is not below the number.
 */
static double ring_step(double greatest) {
  static const double steps[] = {1, 2, 2.5, 5, 10};
  double min = greatest / RINGS;
  double power = pow(10, floor(log10(min)));
  for (int i = 0; i < 4; i++)
    if (steps[i] * power >= min)
      return steps[i] * power;
  return 10 * power;
}

static void write_rings(FILE *out, double step) {
  for (int i = 1; i <= RINGS; i++)
    fprintf(out, "<circle r=\"%d\"/>\n", RADIUS * i / RINGS);
  for (int degrees = 0; degrees < 360; degrees += 30)
    fprintf(out, "<line x2=\"%.2f\" y2=\"%.2f\"/>\n", RADIUS * sin(degrees * M_PI / 180),
            RADIUS * cos(degrees * M_PI / 180));
  fprintf(out, "</g>\n<g font-size=\"11\" font-family=\"sans-serif\" fill=\"#444\">\n");
  for (int i = 1; i <= RINGS; i++)
    fprintf(out, "<text x=\"3\" y=\"%d\">%g</text>\n", RADIUS * i / RINGS - 3, i * step);
  for (int degrees = -150; degrees <= 180; degrees += 30)
    fprintf(out, "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"middle\">%d\u00b0</text>\n",
            (RADIUS + 16) * sin(degrees * M_PI / 180),
            (RADIUS + 16) * cos(degrees * M_PI / 180) + 4, degrees < 0 ? -degrees : degrees);
  fprintf(out, "</g>\n");
}

static void write_curve(FILE *out, const vlLamp *lamp, double c, double max,
                        const char *style) {
  fprintf(out, "<path fill=\"none\" stroke-width=\"2\" %s d=\"", style);
  for (int k = -360; k <= 360; k++) {
    double angle = k * M_PI / 360;
    double r = RADIUS * polar_intensity(lamp, c, angle) / max;
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
          "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"%d "
          "%d %d %d\">\n"
          "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"white\"/>\n"
          "<title>",
          SIDE, SIDE + 40, -SIDE / 2, -SIDE / 2, SIDE, SIDE + 40, -SIDE / 2, -SIDE / 2, SIDE,
          SIDE + 40);
  write_text(out, title);
  fprintf(out, "</title>\n<g fill=\"none\" stroke=\"#bbb\" stroke-width=\".7\">\n");
  write_rings(out, step);
  write_curve(out, lamp, M_PI / 2, RINGS * step, "stroke=\"#06c\" stroke-dasharray=\"6 4\"");
  write_curve(out, lamp, 0, RINGS * step, "stroke=\"#c30\"");
  fprintf(out,
          "<g font-size=\"13\" font-family=\"sans-serif\"><text x=\"%d\" y=\"%d\" "
          "fill=\"#c30\">C 0\u2013C 180</text><text x=\"%d\" y=\"%d\" fill=\"#06c\">C "
          "90\u2013C 270 (dashed)</text><text x=\"%d\" y=\"%d\">cd; %.4g lm</text></g>\n"
          "</svg>\n",
          -RADIUS, SIDE / 2 + 16, -RADIUS + 110, SIDE / 2 + 16, RADIUS - 100, SIDE / 2 + 16,
          info->flux);
}

/* Writes the image to a file. Returns the exit code; errors are reported. */
static int polar_write(vlContext *context, const char *path, const vlLamp *lamp,
                       const vlLampInfo *info, const char *title) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return report_reason(VL_ERROR_MEMORY, path, "polar diagram");
  write_svg(out, lamp, info, title);
  const bool made = fclose(out) == 0;
  vlError error = {0};
  vlResult r = made ? vl_write_file(context, path, text, size, &error) : VL_OK;
  free(text);
  if (!made)
    return report_reason(VL_ERROR_MEMORY, path, "polar diagram");
  return report_finish(&error, r, path);
}

enum { INFO_OUT, INFO_JSON };
enum { TABLE_PLANES = 4, TABLE_STEP = 10 };

static double in_degrees(double radians) {
  return radians * (180 / M_PI);
}

static bool is_given(double number) {
  return number == number;
}

/* Intensities at every tenth degree, in the half planes C 0, 90, 180 and 270. Numbers that only
 * rounding makes at the edge of a table are 0. */
static void print_table(const vlLamp *lamp, double min) {
  printf("  intensity, cd\n  %9s %9s %9s %9s %9s\n", "gamma", "C 0", "C 90", "C 180", "C 270");
  for (int gamma = 0; gamma <= 180; gamma += TABLE_STEP) {
    printf("  %9d", gamma);
    for (int k = 0; k < TABLE_PLANES; k++) {
      double intensity = polar_intensity(lamp, k * M_PI / 2, gamma * M_PI / 180);
      printf(" %9.4g", intensity < min ? 0 : intensity);
    }
    putchar('\n');
  }
}

static void print_text(const char *path, const vlLamp *lamp, const vlLampInfo *info) {
  const double *d = info->max_direction;
  printf("%s\n  format          %s, photometry of type %c, %u x %u angles\n", path,
         info->format, info->type, info->planes, info->angles);
  if (info->name[0])
    printf("  luminaire       %s\n", info->name);
  printf("  flux            %.6g lm\n", info->flux);
  if (is_given(info->lamps_flux)) {
    printf("  flux of lamps   %.6g lm\n", info->lamps_flux);
    if (info->lamps_flux > 0)
      printf("  ratio           %.2f %%\n", 100 * info->flux / info->lamps_flux);
  } else {
    printf("  flux of lamps   not given (absolute photometry)\n");
  }
  if (is_given(info->watts))
    printf("  power           %.6g W (%.4g lm/W)\n", info->watts, info->flux / info->watts);
  printf("  beam angle      %.2f and %.2f degrees (50 %%; C 0 - C 180 and C 90 - C 270)\n",
         in_degrees(info->beam[0]), in_degrees(info->beam[1]));
  printf("  field angle     %.2f and %.2f degrees (10 %%)\n", in_degrees(info->field[0]),
         in_degrees(info->field[1]));
  printf("  maximum         %.6g cd at C %.4g, gamma %.4g degrees\n", info->max_intensity,
         fmod(in_degrees(atan2(-d[2], d[0])) + 360, 360),
         in_degrees(atan2(hypot(d[0], d[2]), -d[1])));
  print_table(lamp, 1e-6 * info->max_intensity);
}

static void put_degrees(Json *json, const char *key, const double radians[2]) {
  const double degrees[2] = {in_degrees(radians[0]), in_degrees(radians[1])};
  json_numbers(json, key, degrees, 2);
}

static void print_json(const char *path, const vlLampInfo *info) {
  Json *json = json_open();
  const char type[2] = {info->type, 0};
  json_put(json, "file %s, format %s, luminaire %s, photometry %s, planes %u", path,
           info->format, info->name, type, info->planes);
  json_put(json, "angles %u, flux_lm %g, lamps_flux_lm %g, ratio %g, watts %g", info->angles,
           info->flux, info->lamps_flux,
           info->lamps_flux > 0 ? info->flux / info->lamps_flux : NAN, info->watts);
  put_degrees(json, "beam_angle_degrees", info->beam);
  put_degrees(json, "field_angle_degrees", info->field);
  json_number(json, "max_candela", info->max_intensity);
  json_numbers(json, "max_direction", info->max_direction, 3);
  json_close(json);
}

/* -1: the diagram can be written. */
static int check_output(vlContext *context, const OptionValue *output) {
  vlError error = {0};
  vlResult r =
      output->given ? vl_check_output(context, output->text, VL_OUTPUT_PLAIN, &error) : VL_OK;
  if (r == VL_ERROR_ARGUMENT)
    return report_usage("light info: %s", error.message);
  return report_error(&error, r, output->text);
}

/* Prints the lamp and writes its diagram. */
static int show(vlContext *context, const char *path, const vlLamp *lamp,
                const OptionValue *v) {
  TRY(check_output(context, &v[INFO_OUT]));
  vlLampInfo info;
  vl_lamp_info(lamp, &info);
  if (v[INFO_JSON].given)
    print_json(path, &info);
  else
    print_text(path, lamp, &info);
  if (!v[INFO_OUT].given)
    return STATUS_OK;
  return polar_write(context, v[INFO_OUT].text, lamp, &info, info.name[0] ? info.name : path);
}

static int run_info(const Arguments *arguments, vlContext *context) {
  const char *path = arguments->operands[0];
  vlLamp *lamp = NULL;
  vlError error = {0};
  vlResult r = vl_lamp_load(context, path, &lamp, &error);
  const int status =
      r == VL_OK ? show(context, path, lamp, arguments->values) : report_error(&error, r, path);
  vl_lamp_destroy(lamp);
  return status;
}

static Option info_options[] = {{INFO_OUT, "output", "write the polar diagram to this file",
                                 OPTION_TEXT, "FILE.svg", .letter = 'o'},
                                JSON_OPTION(INFO_JSON),
                                {0}};

const Command light_info_command = {
    .name = "light info",
    .usage = "FILE [options]",
    .summary = "print flux, angles and intensities of a lamp file",
    .text =
        "Prints what a lamp file (IES LM-63 or EULUMDAT) says, and what follows from it: the "
        "flux of the luminaire, of its lamps, their ratio, the angles within which the "
        "intensity is at least 50 % (beam) and 10 % (field) of the greatest of the plane, and "
        "the greatest intensity.",
    .examples = "velo light info lamp.ies\nvelo light info lamp.ldt -o lamp.svg",
    .options = info_options,
    .operands = 1,
    .context = CONTEXT_ONE,
    .run = run_info,
};
