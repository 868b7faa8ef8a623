/* test_conformance.c: every kind of every family obeys the laws of its family. The laws go over
 * the rows; what they need beyond a row is the kind's case. */
#include "bumps.h"
#include "cameras.h"
#include "channels.h"
#include "coarse_meshes.h"
#include "conformance.h"
#include "coverages.h"
#include "densities.h"
#include "descriptions.h"
#include "dimensions.h"
#include "edited.h"
#include "emitting_faces.h"

#include "failed_saves.h"
#include "far_lamps.h"
#include "files.h"
#include "fog.h"
#include "footprints.h"
#include "formulas.h"
#include "furnaces.h"
#include "gltf_defaults.h"
#include "hostile.h"
#include "instances.h"
#include "lamps.h"
#include "lanes.h"
#include "layers.h"
#include "light_power.h"
#include "lights.h"
#include "lit_materials.h"
#include "materials.h"
#include "mirror_depths.h"
#include "mirrored_textures.h"
#include "moving.h"
#include "nearly_even.h"
#include "neighbours.h"
#include "oblique.h"
#include "parameters.h"
#include "pbrt_defaults.h"
#include "phases.h"
#include "radiometry.h"
#include "ray_derivatives.h"
#include "repeated.h"
#include "rolling.h"
#include "sampling.h"
#include "saved_lights.h"
#include "saved_settings.h"
#include "saved_skies.h"
#include "saved_spectra.h"
#include "scrambles.h"
#include "shading.h"
#include "shapes.h"
#include "spaces.h"
#include "stand_ins.h"
#include "sums_of_lamps.h"
#include "surfaces.h"
#include "texels.h"
#include "textures.h"
#include "transport.h"
#include "turned.h"
#include "unseen.h"
#include "vignetting.h"
#include "wavelengths.h"

/* None of its calls fails; it shows what is read before it is written, and leaks. */
static failAllocator memory;

static int setup(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  def.allocator = fail_allocator(&memory);
  if (!mkdtemp(folder) || vl_context_create(&def, &context) != VL_OK)
    return 1;
  contexts[1] = context;
  def.isa = VL_ISA_BASE;
  return vl_context_create(&def, &contexts[0]) != VL_OK || !write_files();
}

static int teardown(void **state) {
  (void)state;
  remove_files();
  vl_context_destroy(contexts[0]);
  vl_context_destroy(context);
  return memory.blocks != 0;
}

/* An argument names the laws to be tried, as "laws_of_*" does. */
int main(int argc, char **argv) {
  if (argc > 1)
    cmocka_set_test_filter(argv[1]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parameters_of_all_families),
      cmocka_unit_test(uses_of_images),
      cmocka_unit_test(textures_of_parameters),
      cmocka_unit_test(repeated_parameters),
      cmocka_unit_test(defaults_of_pbrt),
      cmocka_unit_test(defaults_of_gltf),
      cmocka_unit_test(rough_stand_ins),
      cmocka_unit_test(laws_of_materials),
      cmocka_unit_test(turned_materials),
      cmocka_unit_test(lit_materials),
      cmocka_unit_test(laws_of_shading),
      cmocka_unit_test(channels_of_materials),
      cmocka_unit_test(laws_of_descriptions),
      cmocka_unit_test(formulas_of_materials),
      cmocka_unit_test(laws_of_layers),
      cmocka_unit_test(laws_of_lights),
      cmocka_unit_test(laws_of_lamps),
      cmocka_unit_test(powers),
      cmocka_unit_test(chosen_powers),
      cmocka_unit_test(lamps_elsewhere),
      cmocka_unit_test(lamps_in_a_row),
      cmocka_unit_test(rays_to_lamps),
      cmocka_unit_test(sums_of_lamps),
      cmocka_unit_test(illuminances),
      cmocka_unit_test(light_paths),
      cmocka_unit_test(laws_of_emission),
      cmocka_unit_test(media_of_lamps),
      cmocka_unit_test(colors_of_lights),
      cmocka_unit_test(colors_of_spaces),
      cmocka_unit_test(laws_of_shapes),
      cmocka_unit_test(laws_of_surfaces),
      cmocka_unit_test(laws_of_instances),
      cmocka_unit_test(moving_meshes),
      cmocka_unit_test(unseen_shapes),
      cmocka_unit_test(laws_of_bumps),
      cmocka_unit_test(laws_of_textures),
      cmocka_unit_test(laws_of_footprints),
      cmocka_unit_test(laws_of_means),
      cmocka_unit_test(laws_of_mappings),
      cmocka_unit_test(laws_of_texels),
      cmocka_unit_test(faces_that_emit),
      cmocka_unit_test(laws_of_projections),
      cmocka_unit_test(derivatives_of_rays),
      cmocka_unit_test(laws_of_distortions),
      cmocka_unit_test(settings_of_cameras),
      cmocka_unit_test(vignetting_of_cameras),
      cmocka_unit_test(settings_of_scenes),
      cmocka_unit_test(laws_of_samplers),
      cmocka_unit_test(purposes_of_samplers),
      cmocka_unit_test(samplers_of_any_count),
      cmocka_unit_test(samplers_of_later_sequences),
      cmocka_unit_test(samplers_that_go_on),
      cmocka_unit_test(samplers_of_neighbours),
      cmocka_unit_test(lanes_of_samplers),
      cmocka_unit_test(scrambles_of_samplers),
      cmocka_unit_test(laws_of_filters),
      cmocka_unit_test(filters_of_light_paths),
      cmocka_unit_test(coverages_of_filters),
      cmocka_unit_test(laws_of_media),
      cmocka_unit_test(oblique_ways),
      cmocka_unit_test(neighbouring_media),
      cmocka_unit_test(neighbouring_materials),
      cmocka_unit_test(neighbouring_textures),
      cmocka_unit_test(lanes_of_materials),
      cmocka_unit_test(lanes_of_textures),
      cmocka_unit_test(laws_of_densities),
      cmocka_unit_test(laws_of_phases),
      cmocka_unit_test(laws_of_tracers),
      cmocka_unit_test(dimensions_of_tracers),
      cmocka_unit_test(media_read_by_rows),
      cmocka_unit_test(limits_of_kinds),
      cmocka_unit_test(depths_behind_mirrors),
      cmocka_unit_test(textures_in_mirrors),
      cmocka_unit_test(widths_after_bounces),
      cmocka_unit_test(laws_of_furnaces),
      cmocka_unit_test(nearly_even_indices),
      cmocka_unit_test(tracers_in_fog),
      cmocka_unit_test(tracers_on_coarse_meshes),
      cmocka_unit_test(spectra_of_files),
      cmocka_unit_test(lights_of_files),
      cmocka_unit_test(skies_of_files),
      cmocka_unit_test(stand_ins_of_files),
      cmocka_unit_test(saves_that_fail),
      cmocka_unit_test(laws_of_wavelengths),
      cmocka_unit_test(hostile_defs),
      cmocka_unit_test(hostile_cameras),
      cmocka_unit_test(hostile_files),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
