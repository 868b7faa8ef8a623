/* test/image/test_stop.c: a request to cancel stops the reading of one image file, and the
 * making of one mipmap, in the middle; nothing is left. */
#include "sample_images.h"

#include "image/mipmap.h"

/* The first step of the work makes the request; the next one finds it. */
static bool request(void *user, const vlStep *step) {
  assert_non_null(step->name);
  vl_cancel_request(user);
  return true;
}

static vlCancel *make_cancel(vlContext *context) {
  vlCancel *cancel;
  assert_int_equal(vl_cancel_create(context, &cancel), VL_OK);
  return cancel;
}

static void files_stop(void **state) {
  (void)state;
  static const char *const SUFFIXES[] = {".png", ".jpg", ".exr", ".hdr"};
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlCancel *cancel = make_cancel(context);
  vlImage *image = make_image(context, 256, 256, 3, VL_PIXEL_F32, VL_ENCODING_LINEAR);
  for (int i = 0; i < 4; i++) {
    void *data = NULL;
    size_t size = 0;
    vlImage *read = NULL;
    vlError error = {0};
    vlTask task;
    assert_int_equal(vl_image_write_memory(image, SUFFIXES[i], NULL, &data, &size, &error),
                     VL_OK);
    vl_task_start(&task, cancel, request, cancel);
    assert_int_equal(vl_image_decode(context, &task, "file", data, size, &read, &error),
                     VL_CANCELLED);
    assert_int_equal(error.code, VL_CANCELLED);
    assert_null(read);
    vl_cancel_clear(cancel);
    vl_task_start(&task, cancel, NULL, NULL);
    assert_int_equal(vl_image_decode(context, &task, "file", data, size, &read, &error), VL_OK);
    vl_image_destroy(read);
    vl_free(context, data);
  }
  vl_image_destroy(image);
  vl_cancel_destroy(cancel);
  end_context(context);
}

static void mipmaps_stop(void **state) {
  (void)state;
  failAllocator failing;
  vlContext *context = make_context(&failing);
  vlCancel *cancel = make_cancel(context);
  for (int bytes = 0; bytes < 2; bytes++) {
    vlImage *image =
        make_image(context, 64, 64, 3, bytes ? VL_PIXEL_U8 : VL_PIXEL_F32, VL_ENCODING_SRGB);
    vlTask task;
    vlMipmapDef def = {.channel = {0, 1, 2}, .count = 3, .task = &task};
    vlMipmap *map;
    vl_task_start(&task, cancel, request, cancel);
    assert_int_equal(vl_mipmap_create(image, &def, &map), VL_CANCELLED);
    assert_null(map);
    vl_cancel_clear(cancel);
    vl_task_start(&task, cancel, NULL, NULL);
    assert_int_equal(vl_mipmap_create(image, &def, &map), VL_OK);
    vl_mipmap_destroy(map);
    vl_image_destroy(image);
  }
  vl_cancel_destroy(cancel);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(files_stop),
                                     cmocka_unit_test(mipmaps_stop)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
