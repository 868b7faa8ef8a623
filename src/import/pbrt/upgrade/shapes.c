/* import/pbrt/upgrade/shapes.c: Shape. */
#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

#define ALPHA                                                                     \
  {"alpha"}, {"shadowalpha", VL_OLD_LOSE, "\"alpha\" is that of shadows, too"}, { \
    "discarddegenerateUVs", VL_OLD_DROP                                           \
  }

static const vlOldRow sphere[] = {{"radius zmin zmax phimax"}, ALPHA, {0}};
static const vlOldRow disk[] = {{"radius height innerradius phimax"}, ALPHA, {0}};
static const vlOldRow mesh[] = {
    {"P N S uv"}, {"st", VL_OLD_RENAME, "uv"}, {"indices faceIndices"}, ALPHA, {0}};
static const vlOldRow ply[] = {{"filename"}, ALPHA, {0}};
static const vlOldRow loop[] = {
    {"P indices"}, {"nlevels", VL_OLD_RENAME, "levels"}, {"levels scheme"}, ALPHA, {0}};
static const vlOldRow curve[] = {
    {"P N type basis degree width width0 width1 splitdepth"}, ALPHA, {0}};

/* uvs were lists of numbers. */
static bool mesh_rule(vlOldStatement *s) {
  static const char *const names[] = {"uv", "st"};
  for (int i = 0; i < 2; i++) {
    vlOldParam *p = vl_old_find(s, names[i]);
    if (p)
      p->new_type = "point2";
  }
  return true;
}

static bool ply_rule(vlOldStatement *s) {
  return vl_old_write_file_name(s, vl_old_find(s, "filename"));
}

static const vlOldKind kinds[] = {
    {"sphere cylinder", NULL, sphere},
    {"disk", NULL, disk},
    {"trianglemesh", NULL, mesh, mesh_rule},
    {"plymesh", NULL, ply, ply_rule},
    {"loopsubdiv", NULL, loop},
    {"curve", NULL, curve},
    {"cone paraboloid hyperboloid heightfield", "trianglemesh", NULL, vl_old_mesh_of_shape},
    {"bilinearmesh"},
    {0}};

bool vl_old_shape(vlOldStatement *s) {
  const vlOldKind *kind = vl_old_kind(kinds, s->name[0]);
  if (!kind) {
    vl_old_lose(s, "shape \"%s\" has no counterpart: left out%s", s->name[0],
                vl_text_is(s->name[0], "nurbs") ? " (convert it to a mesh)" : "");
    return vl_old_remove(s);
  }
  return (!kind->rule || kind->rule(s)) && (!kind->rows || vl_old_rows(s, kind->rows)) &&
         vl_old_rename(s, 0, kind->to);
}
