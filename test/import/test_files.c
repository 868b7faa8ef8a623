/* test/import/test_files.c: scenes of several files: Include, Import, gzip, spectra, relative
 * paths, cycles. */
#include <sys/stat.h>
#include <zlib.h>

#include "import/load.h"
#include "velo/material.h"
#include "velo/shape_kinds.h"

static char folder[64];

static const char *in_folder(const char *name) {
  static char path[4][256];
  static int turn;
  turn = (turn + 1) % 4;
  snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
  return path[turn];
}

static void write_file(const char *name, const char *text) {
  FILE *f = fopen(in_folder(name), "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(text, 1, strlen(text), f), strlen(text));
  fclose(f);
}

static int set_up(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/velo-import-XXXXXX");
  return !mkdtemp(folder) || mkdir(in_folder("parts"), 0777) != 0;
}

static int tear_down(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  return system(command);
}

static void load_file(Loaded *l, const char *name) {
  start_load(l);
  vlLoadDef def = vl_default_load_def();
  l->result = vl_scene_load(l->scene, in_folder(name), &def, &l->error);
}

static void file_fine(Loaded *l, const char *name) {
  load_file(l, name);
  if (l->result != VL_OK)
    print_message("%s:%u:%u: %s\n", l->error.file, l->error.line, l->error.column,
                  l->error.message);
  assert_int_equal(l->result, VL_OK);
}

/* expected holds %s for the folder, some times */
static void file_error(const char *name, vlResult code, const char *expected) {
  Loaded l;
  char said[1200], wanted[1200];
  load_file(&l, name);
  snprintf(said, sizeof said, "%s:%u:%u: %s", l.error.file, l.error.line, l.error.column,
           l.error.message);
  size_t n = 0;
  for (const char *p = expected; *p && n + 80 < sizeof wanted; p++) {
    if (p[0] == '%')
      n += (size_t)snprintf(wanted + n, sizeof wanted - n, "%s", folder);
    else
      wanted[n++] = *p;
  }
  wanted[n] = 0;
  if (l.result != code)
    print_message("%s\n", vl_result_name(l.result));
  assert_string_equal(said, wanted);
  assert_int_equal(l.result, code);
  end_load(&l);
}

static void includes(void **state) {
  (void)state;
  Loaded l;
  write_file("main.pbrt",
             "WorldBegin\nTranslate 1 0 0\nInclude \"parts/a.pbrt\"\nShape \"sphere\"\nImport "
             "\"parts/b.pbrt\"\nShape "
             "\"disk\"\nNamedMaterial \"m\" Shape \"disk\"");
  write_file("parts/a.pbrt", "Translate 2 0 0\nInclude \"c.pbrt\"\nInclude \"main-c.pbrt\"");
  write_file("parts/b.pbrt",
             "Translate 5 0 0\n"
             "ReverseOrientation\n"
             "Shape \"cylinder\"\n"
             "MakeNamedMaterial \"m\" \"string type\" \"dielectric\"");
  write_file("parts/c.pbrt", "Shape \"sphere\" \"float radius\" 2");
  write_file("main-c.pbrt", "Shape \"sphere\" \"float radius\" 7"); /* beside the first file */
  file_fine(&l, "main.pbrt");
  const vlShapeDef *s = l.scene->shapes.items;
  assert_int_equal(l.scene->shapes.count, 6);
  assert_near(s[0].radius, 2, 0);
  assert_near(s[1].radius, 7, 0);
  assert_near(s[2].group_from_shape[3], 3, 0); /* Include leaves its state behind */
  assert_near(s[3].group_from_shape[3], 8, 0);
  assert_true(s[3].reverse_orientation);
  assert_near(s[4].group_from_shape[3], 3, 0); /* Import does not */
  assert_false(s[4].reverse_orientation);
  assert_int_equal(s[5].material.index, 1);
  assert_string_equal(s[0].source.file, in_folder("parts/c.pbrt"));
  end_load(&l);
}

/* As in pbrt-v4's scenes, a file may end within a list of parameters; the list continues in the
 * including file. */
static void lists_across_files(void **state) {
  (void)state;
  Loaded l;
  write_file("main.pbrt",
             "WorldBegin\nInclude \"parts/a.pbrt\"\n \"float zmin\" -1\nShape \"disk\"");
  write_file("parts/a.pbrt",
             "Translate 2 0 0\nInclude \"c.pbrt\" \"float zmax\" 3 # its end\n");
  write_file("parts/c.pbrt", "Shape \"sphere\" \"float radius\" 4");
  file_fine(&l, "main.pbrt");
  const vlShapeDef *s = l.scene->shapes.items;
  assert_int_equal(l.scene->shapes.count, 2);
  assert_near(s[0].radius, 4, 0);
  assert_near(s[0].z_max, 3, 0);
  assert_near(s[0].z_min, -1, 0);
  assert_int_equal(s[1].kind, VL_SHAPE_DISK);
  end_load(&l);
  write_file("main.pbrt", "WorldBegin\nInclude \"parts/a.pbrt\"\n \"float zmni\" -1");
  file_error(
      "main.pbrt", VL_ERROR_SCENE,
      "%/main.pbrt:3:2: Shape \"sphere\": unknown parameter \"zmni\" (did you mean \"zmin\"?)");
  /* a world of its own */
  write_file("main.pbrt", "WorldBegin\nImport \"parts/c.pbrt\"\n \"float zmin\" -1");
  file_error("main.pbrt", VL_ERROR_SCENE,
             "%/main.pbrt:3:2: expected a directive, found \"float zmin\"");
}

static void mistakes_in_parts(void **state) {
  (void)state;
  write_file("m.pbrt", "WorldBegin\n\n  Include \"parts/bad.pbrt\"\n");
  write_file("parts/bad.pbrt", "Shape \"sphere\"\nShape \"sphere\" \"float raduis\" 1");
  file_error(
      "m.pbrt", VL_ERROR_SCENE,
      "%/parts/bad.pbrt:2:16: Shape \"sphere\": unknown parameter \"raduis\" (did you mean "
      "\"radius\"?)");
  /* found at the end, when the file is gone */
  write_file("parts/bad.pbrt", "Material \"diffuse\" \"float raduis\" 1\n");
  file_error("m.pbrt", VL_ERROR_SCENE,
             "%/parts/bad.pbrt:1:20: Material \"diffuse\": unknown parameter \"raduis\"");
  write_file("parts/bad.pbrt", "Shape \"sphere\" \"float radius\" [ 1");
  file_error(
      "m.pbrt", VL_ERROR_SCENE,
      "%/parts/bad.pbrt:1:31: unclosed [ in \"float radius\": the file ends before the ]");
  write_file("parts/bad.pbrt", "AttributeBegin\n");
  file_error("m.pbrt", VL_ERROR_SCENE, "%/parts/bad.pbrt:1:1: AttributeBegin is never closed");
  write_file("m.pbrt", "WorldBegin\nImport \"parts/bad.pbrt\"\nAttributeEnd");
  file_error("m.pbrt", VL_ERROR_SCENE, "%/parts/bad.pbrt:1:1: AttributeBegin is never closed");
  write_file("parts/bad.pbrt", "AttributeEnd\n");
  write_file("m.pbrt", "WorldBegin\nAttributeBegin\nImport \"parts/bad.pbrt\"\nAttributeEnd");
  file_error("m.pbrt", VL_ERROR_SCENE,
             "%/parts/bad.pbrt:1:1: AttributeEnd without its beginning");
  write_file("m.pbrt", "Import \"parts/bad.pbrt\"");
  file_error("m.pbrt", VL_ERROR_SCENE, "%/m.pbrt:1:1: Import must come after WorldBegin");
}

static void circles(void **state) {
  (void)state;
  write_file("self.pbrt", "WorldBegin\nInclude \"self.pbrt\"");
  file_error("self.pbrt", VL_ERROR_SCENE,
             "%/self.pbrt:2:9: the file includes itself: %/self.pbrt");
  write_file("self.pbrt", "WorldBegin\nImport \"./parts/../self.pbrt\"");
  file_error("self.pbrt", VL_ERROR_SCENE,
             "%/self.pbrt:2:8: the file includes itself: %/./parts/../self.pbrt");
  write_file("x.pbrt", "Include \"y.pbrt\"");
  write_file("y.pbrt", "Include \"z.pbrt\"");
  write_file("z.pbrt", "#\nInclude \"x.pbrt\"");
  file_error(
      "x.pbrt", VL_ERROR_SCENE,
      "%/z.pbrt:2:9: the file includes itself in a circle: %/x.pbrt is being read already");
  char name[32], text[64];
  for (int i = 0; i < 70; i++) {
    snprintf(name, sizeof name, "deep%d.pbrt", i);
    snprintf(text, sizeof text, "Include \"deep%d.pbrt\"", i + 1);
    write_file(name, text);
  }
  file_error("deep0.pbrt", VL_ERROR_SCENE,
             "%/deep64.pbrt:1:9: files include each other more than 64 deep");
}

/* Two includes a file: 2^depth of the last file, of this many blanks. */
static void write_twice(int depth, size_t blanks) {
  char name[32], text[64], *last = calloc(1, blanks + 1);
  for (int i = 0; i < depth; i++) {
    snprintf(name, sizeof name, "twice%d.pbrt", i);
    snprintf(text, sizeof text, "Include \"twice%d.pbrt\" Include \"twice%d.pbrt\"", i + 1,
             i + 1);
    write_file(name, text);
  }
  snprintf(name, sizeof name, "twice%d.pbrt", depth);
  memset(last, ' ', blanks);
  write_file(name, last);
  free(last);
  write_file("world.pbrt", "WorldBegin Include \"twice0.pbrt\"");
}

/* The number of includes is not limited; text that is read again and again is. */
static void many_includes(void **state) {
  (void)state;
  Loaded l;
  write_twice(15, 0);
  load_file(&l, "world.pbrt");
  assert_int_equal(l.result, VL_OK);
  end_load(&l);
  write_twice(12, 1 << 20);
  load_file(&l, "world.pbrt");
  assert_int_equal(l.result, VL_ERROR_SCENE);
  assert_string_equal(l.error.message,
                      "files that are included again and again hold more than 1024 megabytes");
  end_load(&l);
  start_load(&l);
  vlLoadDef def = vl_default_load_def();
  def.permissive = true;
  l.result = vl_scene_load(l.scene, in_folder("world.pbrt"), &def, &l.error);
  assert_int_equal(l.result, VL_OK);
  assert_non_null(strstr(l.log, "includes beyond the limits left out"));
  end_load(&l);
}

/* Folders in which files are looked for: of the naming file, of the scene, of the search path,
 * the current one. */
static void search(void **state) {
  (void)state;
  Loaded l;
  char folders[600], before[4096];
  mkdir(in_folder("away"), 0700);
  mkdir(in_folder("here"), 0700);
  write_file("away/far.pbrt", "Shape \"sphere\"");
  write_file("here/near.pbrt", "Shape \"disk\"");
  write_file("looks.pbrt", "WorldBegin Include \"far.pbrt\" Include \"near.pbrt\"");
  load_file(&l, "looks.pbrt");
  assert_int_equal(l.result, VL_ERROR_MISSING);
  end_load(&l);
  snprintf(folders, sizeof folders, "/nowhere:%s", in_folder("away"));
  assert_non_null(getcwd(before, sizeof before));
  assert_int_equal(chdir(in_folder("here")), 0);
  start_load(&l);
  vlLoadDef def = vl_default_load_def();
  def.search_path = folders;
  l.result = vl_scene_load(l.scene, in_folder("looks.pbrt"), &def, &l.error);
  assert_int_equal(chdir(before), 0);
  assert_int_equal(l.result, VL_OK);
  assert_int_equal(l.scene->shapes.count, 2);
  assert_non_null(strstr(l.log, "near.pbrt: taken from the current folder"));
  assert_null(strstr(l.log, "far.pbrt"));
  end_load(&l);
}

static void missing(void **state) {
  (void)state;
  file_error("none-of-this.pbrt", VL_ERROR_MISSING, ":0:0: no such file: %/none-of-this.pbrt");
  write_file("m.pbrt", "WorldBegin\nInclude \"parts/cc.pbrt\"");
  file_error("m.pbrt", VL_ERROR_MISSING,
             "%/m.pbrt:2:9: no such file: %/parts/cc.pbrt (did you mean \"c.pbrt\"?)");
  write_file("m.pbrt", "WorldBegin\nInclude \"parts\"");
  file_error("m.pbrt", VL_ERROR_IO, "%/m.pbrt:2:9: cannot read %/parts: is a folder");
  write_file("m.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"parts\"");
  file_error("m.pbrt", VL_ERROR_IO, "%/m.pbrt:2:17: cannot read %/parts: is a folder");
  file_error("parts", VL_ERROR_IO, ":0:0: cannot read %/parts: is a folder");
  write_file("scene.fbx", "solid");
  file_error(
      "scene.fbx", VL_ERROR_SCENE,
      ":0:0: %/scene.fbx: unknown kind of scene file (known: .pbrt, .pbrt.gz, .gltf, .glb, "
      ".obj, .obj.gz, .ply, "
      ".ply.gz, .stl, .stl.gz, .off, .off.gz)");
}

static void packed(void **state) {
  (void)state;
  Loaded l;
  const char
      *text = "WorldBegin\nShape \"plymesh\" \"string filename\" \"t.ply.gz\"",
      *ply =
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
          "y\nproperty float z\nelement face 1\n"
          "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  gzFile f = gzopen(in_folder("packed.pbrt.gz"), "wb");
  gzwrite(f, text, (unsigned)strlen(text));
  gzclose(f);
  f = gzopen(in_folder("t.ply.gz"), "wb");
  gzwrite(f, ply, (unsigned)strlen(ply));
  gzclose(f);
  file_fine(&l, "packed.pbrt.gz");
  assert_int_equal(l.scene->shapes.items[0].faces, 1);
  end_load(&l);
  write_file("broken.pbrt.gz", "\x1f\x8b\x08 no");
  file_error("broken.pbrt.gz", VL_ERROR_SCENE, ":0:0: %/broken.pbrt.gz: broken gzip file");
  f = gzopen(in_folder("bomb.pbrt.gz"), "wb");
  static char blank[1 << 20];
  memset(blank, ' ', sizeof blank);
  for (int i = 0; i < 130; i++)
    gzwrite(f, blank, sizeof blank);
  gzclose(f);
  file_error("bomb.pbrt.gz", VL_ERROR_SCENE,
             ":0:0: %/bomb.pbrt.gz: unpacks to more than 200 times its size");
  write_file("bad.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
             "y\nproperty float z\nend_header\n0 0 0 1 0 0 0 x 0\n");
  write_file("m.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"bad.ply\"");
  file_error("m.pbrt", VL_ERROR_SCENE, "%/bad.ply:8:1: PLY: expected a number, found \"x\"");
}

static void spectra(void **state) {
  (void)state;
  Loaded l;
  write_file("parts/glass.spd", "# a comment\n400 1.5\n500\t1.4 # in line\n600 1.3");
  write_file("m.pbrt",
             "WorldBegin\nMaterial \"dielectric\" \"spectrum eta\" \"parts/glass.spd\"");
  file_fine(&l, "m.pbrt");
  const vlSpectrum *s = &l.scene->materials.items[0].eta.value;
  assert_int_equal(s->kind, VL_SPECTRUM_SAMPLED);
  assert_int_equal(s->count, 3);
  assert_near(s->wavelengths[1], 500, 0);
  assert_near(s->values[2], 1.3, 1e-6);
  end_load(&l);
  write_file("parts/glass.spd", "400 1.5\n500");
  file_error(
      "m.pbrt", VL_ERROR_SCENE,
      "%/parts/glass.spd:1:1: a spectrum holds pairs of wavelength and value; found 3 numbers");
  write_file("parts/glass.spd", "400 1.5\n500 green");
  file_error("m.pbrt", VL_ERROR_SCENE,
             "%/parts/glass.spd:2:5: spectrum file: expected a number");
  write_file("parts/glass.spd", "");
  file_error("m.pbrt", VL_ERROR_SCENE,
             "%/parts/glass.spd:1:1: spectrum file: holds no numbers");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(includes),          cmocka_unit_test(lists_across_files),
      cmocka_unit_test(mistakes_in_parts), cmocka_unit_test(circles),
      cmocka_unit_test(many_includes),     cmocka_unit_test(search),
      cmocka_unit_test(missing),           cmocka_unit_test(packed),
      cmocka_unit_test(spectra),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
