/* test/import/test_memory.c: the n-th allocation fails, for every n: the result is
 * VL_ERROR_MEMORY and nothing leaks. */
#include "import/load.h"

#include "failing_allocator.h"
#include "import/pbrt/loop.h"
#include "import/ply/ply.h"

static const char *const scene_text =
    "Option \"seed\" 1\n"
    "ColorSpace \"rec2020\"\n"
    "LookAt 0 0 5 0 0 0 0 1 0\n"
    "Camera \"perspective\" \"float fov\" 40 \"float screenwindow\" [ -1 1 -1 1 ]\n"
    "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 64 "
    "\"string filename\" \"a.exr\"\n"
    "Sampler \"halton\" \"integer pixelsamples\" 4\n"
    "Integrator \"path\" \"integer maxdepth\" 3\n"
    "PixelFilter \"box\"\n"
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
    "MediumInterface \"\" \"fog\"\n"
    "WorldBegin\n"
    "Attribute \"shape\" \"float alpha\" 0.5\n"
    "Attribute \"material\" \"spectrum albedo\" [ 400 .5 700 .6 ]\n"
    "Texture \"a\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"b\" "
    "\"rgb tex2\" [ 0 0 0 ]\n"
    "Texture \"b\" \"spectrum\" \"constant\" "
    "\"spectrum value\" [ 400 0.1 500 0.2 700 0.3 ]\n"
    "Texture \"f\" \"float\" \"mix\"\n"
    "MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [ \"d\" \"c\" ] "
    "\"texture amount\" \"f\"\n"
    "MakeNamedMaterial \"d\" \"string type\" \"diffuse\" \"texture reflectance\" \"a\"\n"
    "MakeNamedMaterial \"c\" \"string type\" \"conductor\" "
    "\"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"\n"
    "CoordinateSystem \"here\"\n"
    "LightSource \"infinite\" \"blackbody L\" 5000\n"
    "LightSource \"point\" \"spectrum I\" [ 400 1 700 1 ]\n"
    "AttributeBegin NamedMaterial \"m\" AreaLightSource \"diffuse\" "
    "\"rgb L\" [ 1 1 1 ] Shape \"sphere\" \"texture alpha\" \"f\" AttributeEnd\n"
    "ObjectBegin \"o\" Material \"dielectric\" Shape \"trianglemesh\" "
    "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]\n"
    "  \"point2 uv\" [ 0 0 1 0 0 1 ] \"normal N\" [ 0 0 1 0 0 1 0 0 1 ] ObjectEnd\n"
    "ObjectInstance \"o\"\n"
    "Shape \"loopsubdiv\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] "
    "\"integer indices\" [ 0 1 2 ] \"integer levels\" 2\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]\n"
    "Shape \"plymesh\" \"string filename\" \"%s\"\n";

static const char ply_text[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
    "float z\nproperty float nx\n"
    "property float ny\nproperty float nz\nproperty float u\nproperty float v\nelement face "
    "2\nproperty list uchar int vertex_indices\n"
    "end_header\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n4 0 1 "
    "2 3\n3 0 1 2\n";

static vlResult load_scene(vlContext *context, void *user) {
  vlScene *scene;
  vlResult result = vl_scene_create(context, &scene);
  if (result != VL_OK)
    return result;
  vlError error;
  result = vl_import_pbrt_memory(scene, user, strlen(user), "t.pbrt", NULL, &error);
  if (result != VL_OK && result != VL_ERROR_MEMORY)
    print_message("%s:%u:%u: %s\n", error.file, error.line, error.column, error.message);
  vl_scene_destroy(scene);
  return result;
}

static void scene(void **state) {
  (void)state;
  char path[64] = "/tmp/velo-memory-XXXXXX", text[8192];
  int fd = mkstemp(path);
  assert_true(fd >= 0 && write(fd, ply_text, sizeof ply_text - 1) == sizeof ply_text - 1);
  close(fd);
  snprintf(text, sizeof text, scene_text, path);
  fail_everywhere(load_scene, text, 200);
  unlink(path);
}

static vlResult read_ply(vlContext *context, void *user) {
  (void)user;
  vlMesh mesh;
  vlResult result = vl_ply_parse(context, "p.ply", ply_text, sizeof ply_text - 1,
                                 &(vlPlyOptions){0}, &mesh, NULL);
  if (result == VL_OK)
    vl_mesh_free(context, &mesh);
  return result;
}

static void ply(void **state) {
  (void)state;
  fail_everywhere(read_ply, NULL, 5);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(scene), cmocka_unit_test(ply)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
