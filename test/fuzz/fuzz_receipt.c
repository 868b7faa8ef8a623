/* test/fuzz/fuzz_receipt.c: fuzzes receipts: reads one, queries all its contents, compares it
 * with itself and with another one, and makes the camera that it holds. */
#include "fuzz.h"

static bool keep_length(void *user, const char *difference) {
  *(size_t *)user += strlen(difference);
  return *(size_t *)user < 20000;
}

static void ask(const vlReceipt *receipt) {
  vlFileRecord record;
  vlCameraDef def;
  vlCamera camera;
  vlError error;
  uint32_t planned, size[2], crop[4], i;
  const char *commit;
  for (i = 0; vl_receipt_command(receipt, i); i++)
    continue;
  for (i = 0; vl_receipt_output(receipt, i); i++)
    continue;
  for (i = 0; vl_receipt_file(receipt, i, &record); i++)
    continue;
  vl_receipt_scene(receipt);
  vlReceipt *image = NULL;
  if (vl_receipt_of_image(receipt, 7, &image, &error) == VL_OK &&
      vl_receipt_samples(image, &planned) != 7)
    abort();
  vl_receipt_destroy(image);
  vl_receipt_samples(receipt, &planned);
  vl_receipt_version(receipt, &commit);
  if (vl_receipt_camera(receipt, &def, size, crop, &error) == VL_OK &&
      vl_camera_make(&def, &camera, NULL, &error) == VL_OK)
    vl_camera_resize(&camera, size[0], size[1], &camera);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const char other[] =
      "{\"velo_receipt\": 1, \"velo\": {\"version\": \"0.1.0\"}, "
      "\"command\": [\"velo\", \"render\", \"a.pbrt\"], "
      "\"files\": [{\"path\": \"a.pbrt\", \"size\": 3, \"murmur3\": "
      "\"00112233445566778899aabbccddeeff\"}], \"camera\": {\"fov\": 0.5}, \"render\": "
      "{\"spp\": 4, \"seed\": 0}, \"samples\": 4}";
  vlContext *context = fuzz_context();
  vlReceipt *receipt = NULL, *fixed = NULL;
  vlError error;
  if (vl_receipt_parse(context, (const char *)data, size, &receipt, &error) == VL_OK) {
    size_t length = 0;
    ask(receipt);
    if (vl_receipt_compare(receipt, receipt, VL_RECEIPT_ALL, NULL, NULL) != 0)
      abort();
    if (vl_receipt_parse(context, other, strlen(other), &fixed, &error) != VL_OK)
      abort();
    vl_receipt_compare(receipt, fixed, VL_RECEIPT_ALL, keep_length, &length);
    vl_receipt_compare(fixed, receipt, VL_RECEIPT_ALL, keep_length, &length);
  }
  vl_receipt_destroy(receipt);
  vl_receipt_destroy(fixed);
  fuzz_end(context);
  return 0;
}
