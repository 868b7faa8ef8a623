/* test/import/load_failing.h: loads a scene while an allocation fails. */
#ifndef TEST_IMPORT_LOAD_FAILING_H
#define TEST_IMPORT_LOAD_FAILING_H

#include "import/load.h"

#include "failing_allocator.h"

/* Loads the text once without a failure, then `last` - 1 times: each of the last allocations
 * fails once, and must give VL_ERROR_MEMORY and leak nothing. (The importer makes runs of
 * shapes there.) */
static inline void fail_last_allocations(const char *text, long last) {
  long all = 0;
  for (long n = 0; n < last; n++) {
    failAllocator fail = {.fail_at = n ? all - n : 0};
    vlContextDef def = vl_default_context_def();
    def.threads = 1;
    def.allocator = fail_allocator(&fail);
    vlContext *context;
    vlScene *scene;
    assert_int_equal(vl_context_create(&def, &context), VL_OK);
    assert_int_equal(vl_scene_create(context, &scene), VL_OK);
    vlResult r = vl_import_pbrt_memory(scene, text, strlen(text), "t.pbrt", NULL, NULL);
    if (n == 0)
      all = atomic_load(&fail.calls) + 1;
    assert_int_equal(r, fail.refused ? VL_ERROR_MEMORY : VL_OK);
    vl_scene_destroy(scene);
    vl_context_destroy(context);
    assert_int_equal(fail.blocks, 0);
  }
}

#endif
