/* import/pbrt/upgrade/check.c: reads the new scene before it is written: what velo refuses is
 * an error of the upgrade.
 */

#include "base/context.h"
#include "base/error.h"
#include "import/import.h"
#include "import/pbrt/upgrade/upgrade.h"

/* A file without WorldBegin is part of a scene and is not checked. What velo does not render is
 * no mistake of the upgrade (permissive), nor is a file that the old scene lacks, too. The
 * images that are made of the old ones are not there yet: permissive again. */
bool vl_old_check(vlUpgrade *u, const char *text) {
  if (!u->has_world)
    return true;
  vlContext *context = NULL;
  vlScene *scene = NULL;
  vlError error = {0};
  vlResult r = vl_context_create_quiet(u->context,
                                       &context); /* its notes would not be about the upgrade */
  if (r == VL_OK)
    r = vl_scene_create(context, &scene);
  if (r == VL_OK) {
    vlLoadDef def = vl_default_load_def();
    def.permissive = true;
    def.search_path = u->def->search_path;
    r = vl_import_pbrt_texts(scene, u->to, text, (const char *const *)u->outputs.items,
                             u->outputs.count / 2, &def, &error);
  }
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  if (r == VL_OK || (r == VL_ERROR_MISSING && u->missing))
    return true;
  if (r == VL_ERROR_MEMORY)
    return vl_old_fail_memory(u);
  u->result =
      vl_fail_at(&u->error, VL_ERROR_SCENE, error.file, error.line, error.column,
                 "%s; the upgraded scene is wrong here, and nothing is written", error.message);
  return false;
}
