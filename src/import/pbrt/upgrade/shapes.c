/* import/pbrt/upgrade/shapes.c: Shape. */

#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

#define END \
  { NULL, VL_OLD_KEEP, NULL }
#define ALPHA                                                                                        \
  {"alpha", VL_OLD_KEEP, NULL}, {"shadowalpha", VL_OLD_LOSE, "\"alpha\" is that of shadows, too"}, { \
    "discarddegenerateUVs", VL_OLD_DROP, NULL                                                        \
  }
#define KEEP(name) \
  { name, VL_OLD_KEEP, NULL }

static const vlOldRow sphere[] = {KEEP("radius"), KEEP("zmin"), KEEP("zmax"), KEEP("phimax"), ALPHA, END};
static const vlOldRow disk[] = {KEEP("radius"), KEEP("height"), KEEP("innerradius"), KEEP("phimax"), ALPHA, END};
static const vlOldRow mesh[] = {
    KEEP("P"),       KEEP("N"),           KEEP("S"), KEEP("uv"), {"st", VL_OLD_RENAME, "uv"},
    KEEP("indices"), KEEP("faceIndices"), ALPHA,     END};
static const vlOldRow ply[] = {KEEP("filename"), ALPHA, END};
static const vlOldRow loop[] = {
    KEEP("P"), KEEP("indices"), {"nlevels", VL_OLD_RENAME, "levels"}, KEEP("levels"), KEEP("scheme"), ALPHA, END};
static const vlOldRow curve[] = {KEEP("P"),
                                 KEEP("N"),
                                 KEEP("type"),
                                 KEEP("basis"),
                                 KEEP("degree"),
                                 KEEP("width"),
                                 KEEP("width0"),
                                 KEEP("width1"),
                                 KEEP("splitdepth"),
                                 ALPHA,
                                 END};

/* uvs were lists of numbers. */
static bool mesh_rule(vlOldFile *file, vlOldStatement *s) {
  static const char *const names[] = {"uv", "st"};
  (void)file;
  for (int i = 0; i < 2; i++) {
    vlOldParam *p = vl_old_find(s, names[i]);
    if (p) p->new_type = "point2";
  }
  return true;
}

static bool ply_rule(vlOldFile *file, vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "filename");
  char name[4096];
  if (!p || !p->strings) return true;
  if (!vl_old_file_name(file, s->line, p->text[0], name, sizeof name)) return false;
  if (vl_text_is(name, p->text[0])) return true;
  vl_old_note(s, "filename is \"%s\"", name);
  return vl_old_edit(file, p->span[0], "\"%s\"", name);
}

static const vlOldKind kinds[] = {{"sphere", "sphere", sphere, NULL, NULL},
                                  {"cylinder", "cylinder", sphere, NULL, NULL},
                                  {"disk", "disk", disk, NULL, NULL},
                                  {"trianglemesh", "trianglemesh", mesh, mesh_rule, NULL},
                                  {"plymesh", "plymesh", ply, ply_rule, NULL},
                                  {"loopsubdiv", "loopsubdiv", loop, NULL, NULL},
                                  {"curve", "curve", curve, NULL, NULL},
                                  {"cone", "trianglemesh", NULL, vl_old_mesh_of_shape, NULL},
                                  {"paraboloid", "trianglemesh", NULL, vl_old_mesh_of_shape, NULL},
                                  {"hyperboloid", "trianglemesh", NULL, vl_old_mesh_of_shape, NULL},
                                  {"heightfield", "trianglemesh", NULL, vl_old_mesh_of_shape, NULL},
                                  {"bilinearmesh", "bilinearmesh", NULL, NULL, NULL},
                                  {NULL, NULL, NULL, NULL, NULL}};

bool vl_old_shape(vlOldFile *file, vlOldStatement *s) {
  const vlOldKind *kind = vl_old_kind(kinds, s->name[0]);
  if (!kind) {
    vl_old_lose(file, s->line, "shape \"%s\" has no counterpart: left out%s", s->name[0],
                vl_text_is(s->name[0], "nurbs") ? " (convert it to a mesh)" : "");
    return vl_old_remove(file, s);
  }
  return (!kind->rule || kind->rule(file, s)) && (!kind->rows || vl_old_rows(file, s, kind->rows, VL_OLD_LOSE)) &&
         vl_old_rename(file, s, 0, kind->to);
}
