/* test/fuzz/fuzz_sensor.c: sensor files. A sensor that is read reads out a small frame. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlSensorDef def;
  vlError error;
  vlSensor *sensor = NULL;
  const char *path = fuzz_file("sensor.yaml", data, size);
  if (vl_sensor_read(context, path, &def, &error) == VL_OK) {
    double means[16];
    uint16_t numbers[16];
    float electrons[16];
    vlSensorOutput out = {.numbers = numbers, .electrons = electrons};
    for (int i = 0; i < 16; i++)
      means[i] = i * 1000.0;
    if (vl_sensor_create(context, &def, &sensor, &error) != VL_OK ||
        vl_sensor_read_out(sensor, 4, 4, means, NULL, &out, &error) != VL_OK)
      abort(); /* a sensor that was read is valid */
    for (int i = 0; i < 16; i++)
      if (electrons[i] != electrons[i] || numbers[i] >> def.bits)
        abort();
    vl_sensor_destroy(sensor);
  }
  fuzz_end(context);
  return 0;
}
