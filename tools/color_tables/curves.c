/* curves.c: writes the curves of measured cameras (sensor_data.c) and the sRGB curve of 8-bit
 * codes. */
#include <math.h>

#include "color/sensor.h"
#include "math/elementary.h"
#include "tables.h"

static void write_sensors(FILE *file) {
  fprintf(file, "const uint32_t vl_sensor_count = %u;\n", vl_sensor_count);
  fprintf(file, "const vlSensorCurves vl_sensor_curves[] = {");
  for (uint32_t i = 0; i < vl_sensor_count; i++) {
    fprintf(file, "\n  {\"%s\", {", vl_sensor_curves[i].name);
    write_floats(file, vl_sensor_curves[i].rgb, VL_SENSOR_SAMPLES * 3, 1);
    fprintf(file, "}},");
  }
  fprintf(file,
          "\n};\nconst float vl_checker_patches[VL_CHECKER_PATCHES][VL_CHECKER_SAMPLES] = {");
  for (int i = 0; i < VL_CHECKER_PATCHES; i++) {
    fprintf(file, "\n  {");
    write_floats(file, vl_checker_patches[i], VL_CHECKER_SAMPLES, 1);
    fprintf(file, "},");
  }
}

/* IEC 61966-2-1 */
static double linear(double v) {
  return v <= 0.04045 ? v / 12.92 : vl_precise_pow((v + 0.055) / 1.055, 2.4);
}

void write_curves(FILE *file) {
  float value[256], begin[256] = {0};
  for (int i = 0; i < 256; i++)
    value[i] = (float)linear(i / 255.0);
  for (int i = 1; i < 256; i++) {
    double exact = linear((i - 0.5) / 255.0);
    begin[i] = (float)exact;
    if ((double)begin[i] < exact)
      begin[i] = nextafterf(begin[i], 1.0f);
  }
  write_sensors(file);
  fprintf(file, "\n};\nconst float vl_srgb8_to_linear[256] = {");
  write_floats(file, value, 256, 1);
  fprintf(file, "\n};\nconst float vl_srgb8_begin[256] = {");
  write_floats(file, begin, 256, 1);
  fprintf(file, "\n};\n");
}
