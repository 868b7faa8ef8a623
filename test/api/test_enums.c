/* test/api/test_enums.c: numbers that no enumerator has (2^31 - 1 and -1), in every field and
 * every argument of the public API that is an enum. A call that can fail refuses them, others
 * return what stands for nothing; none crashes. test_enums.py looks for each field of the
 * headers in FIELDS, and for each function with an argument that is an enum in this file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "small_world.h"
#include "unit.h"
#include "velo/setting.h"
#include "velo/velo.h"

static vlContext *context;
static vlScene *scene;
static vlWorld *world;
static vlCamera camera;

static int begin(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  vlCameraDef camera_def = vl_default_camera_def(8, 8);
  vlError error;
  def.threads = 1;
  camera_def.eye[2] = 5;
  return vl_context_create(&def, &context) == VL_OK &&
                 vl_scene_create(context, &scene) == VL_OK &&
                 (small_scene(scene), vl_scene_result(scene, &error)) == VL_OK &&
                 vl_world_build(scene, NULL, &world, &error) == VL_OK &&
                 vl_camera_make(&camera_def, &camera, NULL, &error) == VL_OK
             ? 0
             : -1;
}

static int end(void **state) {
  (void)state;
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  const size_t left = vl_context_memory(context, NULL);
  vl_context_destroy(context);
  return left == 0 ? 0 : -1;
}

/* ---- fields ------------------------------------------------------------------------------ */

/* Writes a number into the field at this offset of a def. */
static void put(void *def, size_t offset, int32_t number) {
  memcpy((char *)def + offset, &number, sizeof number);
}

/* Each of these makes a def that is valid but for the field, and the call that reads it.
 * Returns the call's result. */
typedef vlResult TryField(size_t offset, int32_t number);

static vlResult try_context(size_t offset, int32_t number) {
  vlContextDef def = vl_default_context_def();
  vlContext *made = NULL;
  put(&def, offset, number);
  const vlResult result = vl_context_create(&def, &made);
  vl_context_destroy(made);
  return result;
}

static vlResult try_camera(size_t offset, int32_t number) {
  vlCameraDef def = vl_default_camera_def(8, 8);
  vlCamera made;
  vlError error = {0};
  def.fov = 40;
  put(&def, offset, number);
  return vl_camera_make(&def, &made, NULL, &error);
}

static vlResult try_moving_camera(size_t offset, int32_t number) {
  vlCameraDef def = vl_default_camera_def(8, 8);
  vlCamera made;
  vlError error = {0};
  def.readout = 0.5;
  put(&def, offset, number);
  return vl_camera_make(&def, &made, NULL, &error);
}

static vlResult try_stereo(size_t offset, int32_t number) {
  vlCameraDef def = vl_default_camera_def(8, 8);
  vlCamera left;
  vlCamera right;
  vlError error = {0};
  put(&def.stereo, offset, number);
  vlStereo stereo = def.stereo;
  const vlResult one = vl_camera_eye(&camera, &stereo, VL_EYE_LEFT, &left, &error);
  const vlResult both = vl_camera_stereo(&def, &left, &right, NULL, &error);
  return one == VL_OK ? one : both;
}

static vlResult try_camera_file(size_t offset, int32_t number) {
  vlCameraFileDef def = vl_default_camera_file_def();
  vlCameraRecord record;
  vlError error = {0};
  memset(&record, 0, sizeof record);
  record.camera = vl_default_camera_def(8, 8);
  put(&def, offset, number);
  const vlResult read = vl_camera_read(context, "no.yaml", &def, &record, &error);
  const vlResult written = vl_camera_write(context, "no/camera.yaml", &def, &record, &error);
  return read == VL_ERROR_ARGUMENT ? written : read;
}

static vlResult try_channels(size_t offset, int32_t number) {
  vlChannelsDef def = vl_default_channels_def(8, 8);
  vlImage *floats = NULL;
  vlImage *ids = NULL;
  vlError error = {0};
  put(&def, offset, number);
  const vlResult result = vl_render_channels(world, &camera, &def, &floats, &ids, &error);
  vl_image_destroy(floats);
  vl_image_destroy(ids);
  return result;
}

static vlResult try_denoise(size_t offset, int32_t number) {
  vlDenoiseDef def = vl_default_denoise_def();
  const vlImageDef image_def = vl_default_image_def(8, 8, 3);
  vlImage *image = NULL;
  vlImage *clean = NULL;
  vlError error = {0};
  put(&def, offset, number);
  assert_int_equal(vl_image_create(context, &image_def, &image), VL_OK);
  const vlResult result = vl_denoise(image, &def, &clean, NULL, &error);
  vl_image_destroy(image);
  vl_image_destroy(clean);
  return result;
}

static vlResult try_image(size_t offset, int32_t number) {
  vlImageDef def = vl_default_image_def(8, 8, 3);
  vlImage *image = NULL;
  put(&def, offset, number);
  const vlResult result = vl_image_create(context, &def, &image);
  vl_image_destroy(image);
  return result;
}

static vlResult try_attribute(size_t offset, int32_t number) {
  const vlImageDef def = vl_default_image_def(8, 8, 3);
  vlAttribute attribute = {.name = "a", .string = "b"};
  vlImage *image = NULL;
  put(&attribute, offset, number);
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  const vlResult result = vl_image_set_attribute(image, &attribute);
  vl_image_destroy(image);
  return result;
}

static vlResult try_complete(size_t offset, int32_t number) {
  vlCompleteDef def = vl_default_complete_def();
  vlScene *made = NULL;
  vlError error = {0};
  put(&def, offset, number);
  assert_int_equal(vl_scene_create(context, &made), VL_OK);
  const vlShapeDef sphere = vl_default_shape_def(VL_SHAPE_SPHERE);
  vl_scene_add_shape(made, &sphere);
  const vlResult result = vl_scene_complete(made, &def, &error);
  vl_scene_destroy(made);
  return result;
}

static vlResult try_develop(size_t offset, int32_t number) {
  vlRawDevelopDef def = vl_default_raw_develop_def();
  const vlRawDef raw_def = vl_default_raw_def(8, 8);
  vlRaw *raw = NULL;
  vlImage *image = NULL;
  vlError error = {0};
  put(&def, offset, number);
  assert_int_equal(vl_raw_create(context, &raw_def, &raw, &error), VL_OK);
  const vlResult result = vl_raw_develop(raw, &def, &image, &error);
  vl_raw_destroy(raw);
  vl_image_destroy(image);
  return result;
}

static vlResult try_film(size_t offset, int32_t number) {
  vlFilmDef def = vl_default_film_def(8, 8);
  vlFilm *film = NULL;
  put(&def, offset, number);
  const vlResult result = vl_film_create(context, &def, &film);
  vl_film_destroy(film);
  return result;
}

static vlResult try_render(size_t offset, int32_t number) {
  vlRenderDef def = vl_default_render_def();
  const vlFilmDef film_def = vl_default_film_def(8, 8);
  vlFilm *film = NULL;
  vlError error = {0};
  put(&def, offset, number);
  assert_int_equal(vl_film_create(context, &film_def, &film), VL_OK);
  vlTracerChoice choice;
  vlPixelPaths *paths = NULL;
  vlResult result = vl_render(world, &camera, film, &def, NULL, &error);
  if (result != VL_OK &&
      vl_choose_tracer(world, &camera, &film_def, &def, false, &choice, &error) == VL_OK)
    result = VL_OK;
  if (result != VL_OK &&
      vl_trace_paths(world, &camera, &film_def, &def, 1, 1, 0, 1, &paths, &error) == VL_OK)
    result = VL_OK;
  vl_pixel_paths_destroy(paths);
  vl_film_destroy(film);
  return result;
}

static vlResult try_spectrum(size_t offset, int32_t number) {
  vlSpectrum spectrum = vl_spectrum_rgb(0.1f, 0.2f, 0.3f);
  float values[VL_SPECTRUM_VALUES];
  float rgb[3];
  vlError error = {0};
  put(&spectrum, offset, number);
  const vlParameterRole role = VL_PARAMETER_ALBEDO;
  const vlResult table = vl_spectrum_tabulate(&spectrum, role, values, &error);
  const vlResult color = vl_spectrum_linear_rgb(&spectrum, role, rgb, &error);
  return table == VL_OK ? table : color;
}

static vlResult try_build(size_t offset, int32_t number) {
  vlBuildDef def = vl_default_build_def();
  vlWorld *made = NULL;
  vlError error = {0};
  put(&def, offset, number);
  const vlResult result = vl_world_build(scene, &def, &made, &error);
  vl_world_destroy(made);
  return result;
}

/* Whether a value of this kind fits any row. */
static vlResult try_given(size_t offset, int32_t number) {
  char message[VL_GIVEN_MESSAGE];
  vlGiven given = {.number = 1, .text = "1"};
  put(&given, offset, number);
  const vlParameter *row = vl_setting(VL_SETTING_RENDER, "spp");
  assert_non_null(row);
  return vl_given_check(row, "spp", &given, NULL, message) ? VL_OK : VL_ERROR_ARGUMENT;
}

/* ---- fields of what a scene holds -------------------------------------------------------- */

/* A scene remembers its first error, so each try has its own. */
static vlScene *new_scene(void) {
  vlScene *made = NULL;
  assert_int_equal(vl_scene_create(context, &made), VL_OK);
  return made;
}

static vlResult end_scene(vlScene *made) {
  vlError error = {0};
  vlWorld *built = NULL;
  vlResult result = vl_scene_result(made, &error);
  if (result == VL_OK)
    result = vl_world_build(made, NULL, &built, &error);
  vl_world_destroy(built);
  vl_scene_destroy(made);
  return result;
}

static vlResult try_light(size_t offset, int32_t number) {
  vlLightDef def = vl_default_light_def(VL_LIGHT_POINT);
  vlScene *made = new_scene();
  put(&def, offset, number);
  vl_scene_add_light(made, &def);
  return end_scene(made);
}

/* A sky with an image, whose colour space is read. */
static vlResult try_sky(size_t offset, int32_t number) {
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  const vlImageDef image_def = vl_default_image_def(2, 2, 3);
  vlImage *image = NULL;
  vlScene *made = new_scene();
  assert_int_equal(vl_image_create(context, &image_def, &image), VL_OK);
  def.image = image;
  put(&def, offset, number);
  vl_scene_add_light(made, &def);
  vl_image_destroy(image);
  return end_scene(made);
}

static vlResult try_material_of(vlMaterialKind kind, size_t offset, int32_t number) {
  vlMaterialDef def = vl_default_material_def(kind);
  vlShapeDef shape = vl_default_shape_def(VL_SHAPE_SPHERE);
  vlScene *made = new_scene();
  put(&def, offset, number);
  shape.material = vl_scene_add_material(made, &def);
  if (shape.material.index)
    vl_scene_add_shape(made, &shape);
  return end_scene(made);
}
static vlResult try_material(size_t offset, int32_t number) {
  return try_material_of(VL_MATERIAL_DIFFUSE, offset, number);
}
static vlResult try_hair(size_t offset, int32_t number) {
  return try_material_of(VL_MATERIAL_HAIR, offset + offsetof(vlMaterialDef, hair), number);
}

static vlResult try_medium(size_t offset, int32_t number) {
  vlMediumDef def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  vlScene *made = new_scene();
  put(&def, offset, number);
  vl_scene_add_medium(made, &def);
  return end_scene(made);
}

static vlResult try_shape_of(vlShapeKind kind, size_t offset, int32_t number) {
  vlShapeDef def = vl_default_shape_def(kind);
  vlScene *made = new_scene();
  put(&def, offset, number);
  vl_scene_add_shape(made, &def);
  return end_scene(made);
}
static vlResult try_shape(size_t offset, int32_t number) {
  return try_shape_of(VL_SHAPE_SPHERE, offset, number);
}
static vlResult try_curve(size_t offset, int32_t number) {
  return try_shape_of(VL_SHAPE_CURVES, offset, number);
}

static vlResult try_texture_of(vlTextureKind kind, size_t offset, int32_t number) {
  vlTextureDef def = vl_default_texture_def(kind, true);
  const vlImageDef image_def = vl_default_image_def(2, 2, 3);
  vlImage *image = NULL;
  vlScene *made = new_scene();
  assert_int_equal(vl_image_create(context, &image_def, &image), VL_OK);
  def.image = kind == VL_TEXTURE_IMAGE ? image : NULL;
  put(&def, offset, number);
  vl_scene_add_texture(made, &def);
  vl_image_destroy(image);
  return end_scene(made);
}
static vlResult try_texture(size_t offset, int32_t number) {
  return try_texture_of(VL_TEXTURE_CHECKERBOARD, offset, number);
}
static vlResult try_image_texture(size_t offset, int32_t number) {
  return try_texture_of(VL_TEXTURE_IMAGE, offset, number);
}
static vlResult try_second_wrap(size_t offset, int32_t number) {
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  const vlImageDef image_def = vl_default_image_def(2, 2, 3);
  vlScene *made = new_scene();
  vlImage *image = NULL;
  assert_int_equal(vl_image_create(context, &image_def, &image), VL_OK);
  def.image = image;
  def.wrap_t_given = true;
  put(&def, offset, number);
  vl_scene_add_texture(made, &def);
  vl_image_destroy(image);
  return end_scene(made);
}

#define FIELD(def, member, function) \
  { #def "." #member, offsetof(def, member), function }
static const struct {
  const char *name;
  size_t offset;
  TryField *refuse;
} FIELDS[] = {
    FIELD(vlContextDef, isa, try_context),
    FIELD(vlCameraDef, projection, try_camera),
    FIELD(vlCameraDef, distortion, try_camera),
    FIELD(vlCameraDef, fov_axis, try_camera),
    FIELD(vlCameraDef, readout_direction, try_moving_camera),
    FIELD(vlCameraDef, stereo_eye, try_camera),
    FIELD(vlStereo, mode, try_stereo),
    FIELD(vlCameraFileDef, dialect, try_camera_file),
    FIELD(vlChannelsDef, mode, try_channels),
    FIELD(vlChannelsDef, space, try_channels),
    FIELD(vlDenoiseDef, denoiser, try_denoise),
    FIELD(vlImageDef, type, try_image),
    FIELD(vlImageDef, encoding, try_image),
    FIELD(vlAttribute, type, try_attribute),
    FIELD(vlCompleteDef, framing, try_complete),
    FIELD(vlCompleteDef, environment, try_complete),
    FIELD(vlRawDevelopDef, stop_at, try_develop),
    FIELD(vlFilmDef, space, try_film),
    FIELD(vlFilmDef, filter.kind, try_film),
    FIELD(vlRenderDef, tracer, try_render),
    FIELD(vlRenderDef, sampler, try_render),
    FIELD(vlRenderDef, noise_view, try_render),
    FIELD(vlSpectrum, kind, try_spectrum),
    FIELD(vlSpectrum, space, try_spectrum),
    FIELD(vlBuildDef, color, try_build),
    FIELD(vlBuildDef, light_sampler, try_build),
    FIELD(vlBuildDef, bits, try_build),
    FIELD(vlBuildDef, accelerator, try_build),
    FIELD(vlGiven, kind, try_given),
    FIELD(vlLightDef, kind, try_light),
    FIELD(vlLightDef, space, try_sky),
    FIELD(vlMaterialDef, kind, try_material),
    FIELD(vlHairDef, color, try_hair),
    FIELD(vlMediumDef, kind, try_medium),
    FIELD(vlMediumDef, space, try_medium),
    FIELD(vlShapeDef, kind, try_shape),
    FIELD(vlShapeDef, curve, try_curve),
    FIELD(vlTextureDef, kind, try_texture),
    FIELD(vlTextureDef, mapping, try_texture),
    FIELD(vlTextureDef, wrap, try_image_texture),
    FIELD(vlTextureDef, wrap_t, try_second_wrap),
    FIELD(vlTextureDef, filter, try_image_texture),
    FIELD(vlTextureDef, encoding, try_image_texture),
    FIELD(vlTextureDef, space, try_image_texture),
};

static const int32_t NUMBERS[] = {INT32_MAX, -1};

static void fields(void **state) {
  (void)state;
  int accepted = 0;
  for (size_t i = 0; i < sizeof FIELDS / sizeof *FIELDS; i++)
    for (int k = 0; k < 2; k++)
      if (FIELDS[i].refuse(FIELDS[i].offset, NUMBERS[k]) == VL_OK) {
        print_error("%s: %d is accepted\n", FIELDS[i].name, NUMBERS[k]);
        accepted++;
      }
  assert_int_equal(accepted, 0);
}

/* ---- arguments --------------------------------------------------------------------------- */

static void arguments_that_are_refused(void **state) {
  (void)state;
  const vlSpectrum grey = vl_spectrum_constant(0.5f);
  const float rgb[3] = {0.1f, 0.2f, 0.3f};
  const double wavelength = 550;
  for (int k = 0; k < 2; k++) {
    const int n = NUMBERS[k];
    float values[VL_SPECTRUM_VALUES];
    double numbers[9];
    float color[3];
    vlError error = {0};
    vlCamera eye;
    vlIdInfo id;
    vlChoiceInfo choice;
    vlImage *shown = NULL;
    vlImage *image = NULL;
    const vlImageDef image_def = vl_default_image_def(2, 2, 3);
    const vlStereo stereo = {VL_STEREO_PARALLEL, 0.1, INFINITY};
    assert_int_equal(vl_image_create(context, &image_def, &image), VL_OK);
    assert_int_not_equal(vl_image_view(image, (vlView)n, 0, NULL, &shown), VL_OK);
    vl_image_destroy(image);
    vl_image_destroy(shown);
    assert_int_not_equal(vl_camera_eye(&camera, &stereo, (vlEye)n, &eye, &error), VL_OK);
    assert_int_not_equal(vl_check_output(context, "no.png", (vlOutputKind)n, &error), VL_OK);
    assert_int_not_equal(vl_note_input(context, "no.png", (vlOutputKind)n), VL_OK);
    assert_int_not_equal(vl_world_id_info(world, (vlIdKind)n, 1, &id), VL_OK);
    assert_int_not_equal(vl_scene_id_info(scene, (vlIdKind)n, 1, &id), VL_OK);
    assert_int_not_equal(vl_scene_choice_info(scene, (vlChoiceKind)n, 0, &choice), VL_OK);
    assert_int_not_equal(vl_spectrum_tabulate(&grey, (vlParameterRole)n, values, &error),
                         VL_OK);
    assert_int_not_equal(vl_spectrum_linear_rgb(&grey, (vlParameterRole)n, color, &error),
                         VL_OK);
    assert_int_not_equal(vl_reflectance_at((vlColorSpace)n, rgb, 1, &wavelength, numbers),
                         VL_OK);
    assert_int_not_equal(vl_white_tabulate((vlColorSpace)n, values), VL_OK);
    assert_int_not_equal(vl_color_space_matrix((vlColorSpace)n, numbers), VL_OK);
    assert_int_not_equal(vl_scene_remove(scene, (vlSceneFamily)n, 1, &error), VL_OK);
  }
}

static void arguments_that_stand_for_nothing(void **state) {
  (void)state;
  const vlFilmDef film_def = vl_default_film_def(8, 8);
  vlFilm *film = NULL;
  assert_int_equal(vl_film_create(context, &film_def, &film), VL_OK);
  for (int k = 0; k < 2; k++) {
    const int n = NUMBERS[k];
    assert_true(vl_result_name((vlResult)n) != NULL);
    assert_true(vl_finding_kind_name((vlFindingKind)n) != NULL);
    assert_null(vl_camera_dialect_name((vlCameraDialect)n));
    assert_string_equal(vl_projection_name((vlProjection)n), "unknown");
    assert_false(vl_camera_writes_folder("camera.yaml", (vlCameraDialect)n));
    assert_int_equal(vl_world_id_count(world, (vlIdKind)n), 0);
    assert_int_equal(vl_scene_id_count(scene, (vlIdKind)n), 0);
    assert_int_equal(vl_scene_choice_count(scene, (vlChoiceKind)n), 0);
    assert_false(vl_scene_has(scene, (vlSceneFamily)n, 1));
    assert_int_equal(vl_scene_highest(scene, (vlSceneFamily)n), 0);
    assert_int_equal(vl_scene_removed(scene, (vlSceneFamily)n, NULL), 0);
    assert_int_equal(vl_scene_serial(scene, (vlSceneFamily)n, 1), 0);
    assert_null(vl_film_own(film, (vlOwnKind)n));
    assert_null(vl_receipt_own(NULL, (vlOwnKind)n));
    assert_false(vl_environment_is_studio((vlEnvironmentKind)n));
    assert_null(vl_settings((vlSettingGroup)n));
    assert_null(vl_setting((vlSettingGroup)n, "spp"));
    /* What these return, the calls that take it refuse: see FIELDS. */
    vl_default_pixel_filter((vlPixelFilterKind)n);
    vl_default_light_def((vlLightKind)n);
    vl_default_material_def((vlMaterialKind)n);
    vl_default_medium_def((vlMediumKind)n);
    vl_default_shape_def((vlShapeKind)n);
    vl_default_texture_def((vlTextureKind)n, true);
  }
  vl_film_destroy(film);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fields),
      cmocka_unit_test(arguments_that_are_refused),
      cmocka_unit_test(arguments_that_stand_for_nothing),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
