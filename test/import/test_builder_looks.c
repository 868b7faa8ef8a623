/* test/import/test_builder_looks.c: statements for materials, textures, lights and media, with
 * defaults and attributes. */
#include "import/load.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape.h"
#include "velo/texture.h"

#define W "WorldBegin\n"

static const vlMaterialDef *last_material(const Loaded *l) {
  return &l->scene->materials.items[l->scene->materials.count - 1];
}

static void materials(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W "Material \"diffuse\"");
  assert_near(last_material(&l)->reflectance.value.value, 0.5, 0);
  end_load(&l);
  load_fine(&l, W
            "Material \"coateddiffuse\" \"rgb reflectance\" [.1 .2 .3] \"float roughness\" .3 "
            "\"float uroughness\" .2 \"float thickness\" .5 \"spectrum eta\" \"glass-BK7\" "
            "\"float g\" .7 \"rgb albedo\" [.9 .9 .9] \"integer maxdepth\" 3 "
            "\"integer nsamples\" 2 \"bool remaproughness\" false");
  const vlMaterialDef *m = last_material(&l);
  assert_int_equal(m->kind, VL_MATERIAL_COATED_DIFFUSE);
  assert_near(m->reflectance.value.rgb[1], .2, 1e-7);
  assert_near(m->u_roughness.value, .2, 1e-7);
  assert_near(m->v_roughness.value, .3, 1e-7);
  assert_near(m->thickness.value, .5, 0);
  assert_string_equal(m->eta.value.name, "glass-BK7");
  assert_near(m->g.value, .7, 1e-7);
  assert_int_equal(m->max_depth, 3);
  assert_int_equal(m->samples, 2);
  assert_false(m->remap_roughness);
  end_load(&l);
  load_fine(&l, W "Material \"conductor\" \"float vroughness\" .25");
  m = last_material(&l);
  assert_string_equal(m->eta.value.name, "metal-Cu-eta");
  assert_string_equal(m->k.value.name, "metal-Cu-k");
  assert_near(m->u_roughness.value, 0, 0);
  assert_near(m->v_roughness.value, .25, 0);
  assert_false(m->use_reflectance);
  assert_true(m->remap_roughness);
  end_load(&l);
  load_fine(&l, W "Material \"conductor\" \"rgb reflectance\" [1 .5 0]");
  assert_true(last_material(&l)->use_reflectance);
  end_load(&l);
  load_fine(&l, W
            "Material \"dielectric\" \"float eta\" 1.33 Material \"thindielectric\" "
            "\"spectrum eta\" [400 1.5 700 1.4]");
  assert_near(l.scene->materials.items[0].eta.value.value, 1.33, 1e-6);
  assert_int_equal(last_material(&l)->eta.value.count, 2);
  assert_near(last_material(&l)->eta.value.wavelengths[1], 700, 0);
  assert_near(last_material(&l)->eta.value.values[1], 1.4, 1e-6);
  end_load(&l);
  const char *nothing[] = {"interface", "", "none"};
  for (int i = 0; i < 3; i++) {
    char text[256];
    snprintf(text, sizeof text,
             W "AreaLightSource \"diffuse\" Material \"%s\" Shape \"sphere\"", nothing[i]);
    load_fine(&l, text);
    assert_int_equal(last_material(&l)->kind, VL_MATERIAL_INTERFACE);
    /* as in pbrt, with a warning */
    assert_int_equal(l.scene->shapes.items[0].emission.index, 0);
    assert_non_null(strstr(l.log, "its area light is ignored"));
    end_load(&l);
  }
}

/* The four ways to describe the medium of a subsurface material. */
static void bodies(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W "Material \"subsurface\"");
  const vlMaterialDef *m = last_material(&l);
  assert_int_equal(m->kind, VL_MATERIAL_SUBSURFACE);
  assert_false(m->subsurface.from_reflectance);
  assert_near(m->subsurface.sigma_a.value.rgb[2], .014, 1e-7);
  assert_near(m->subsurface.sigma_s.value.rgb[0], 2.55, 1e-6);
  assert_near(m->eta.value.value, 1.33, 1e-6);
  assert_near(m->scale, 1, 0);
  assert_near(m->u_roughness.value, 0, 0);
  end_load(&l);
  load_fine(
      &l, W
      "Material \"subsurface\" \"string name\" \"Skin1\" \"float g\" .5 \"float scale\" 10 "
      "\"float eta\" 1.4");
  m = last_material(&l);
  assert_near(m->subsurface.sigma_s.value.rgb[1], .88, 1e-6);
  assert_near(m->subsurface.sigma_a.value.rgb[1], .17, 1e-7);
  assert_near(m->scale, 10, 0);
  assert_near(m->eta.value.value, 1.4, 1e-6);
  assert_near(m->g.value, 0, 0);
  assert_non_null(strstr(l.log, "\"g\" is ignored beside \"name\""));
  end_load(&l);
  load_fine(&l, W
            "Texture \"t\" \"spectrum\" \"checkerboard\" Material \"subsurface\" "
            "\"texture sigma_a\" \"t\" \"spectrum sigma_s\" [400 1 700 2] \"float g\" -.5 "
            "\"float uroughness\" .2 \"bool remaproughness\" false");
  m = last_material(&l);
  assert_int_equal(m->subsurface.sigma_a.texture.index, 1);
  assert_near(m->subsurface.sigma_s.value.values[1], 2, 0);
  assert_near(m->g.value, -.5, 0);
  assert_near(m->u_roughness.value, .2, 1e-7);
  assert_false(m->remap_roughness);
  end_load(&l);
  load_fine(&l, W "Material \"subsurface\" \"rgb reflectance\" [.8 .5 .4] \"rgb mfp\" [3 2 1]");
  m = last_material(&l);
  assert_true(m->subsurface.from_reflectance);
  assert_near(m->reflectance.value.rgb[1], .5, 0);
  assert_near(m->subsurface.mfp.value.rgb[0], 3, 0);
  end_load(&l);
}

/* A material may be named before it is defined, and a mix names its parts. A shape gets the
 * state at its own statement. */
static void named_materials(void **state) {
  (void)state;
  Loaded l;
  load_fine(
      &l, W
      "Shape \"sphere\"\n"
      "NamedMaterial \"later\" Shape \"sphere\"\n"
      "AttributeBegin Material \"diffuse\" Shape \"sphere\" AttributeEnd Shape \"sphere\"\n"
      "MakeNamedMaterial \"later\" \"string type\" \"mix\" "
      "\"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.25\n"
      "MakeNamedMaterial \"a\" \"string type\" \"conductor\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"dielectric\"\n");
  const vlScene *s = l.scene;
  assert_int_equal(s->shapes.items[0].material.index, 0);
  const vlMaterialDef *mix = &s->materials.items[s->shapes.items[1].material.index - 1];
  assert_int_equal(mix->kind, VL_MATERIAL_MIX);
  assert_string_equal(mix->name, "later");
  assert_near(mix->amount.value, 0.25, 0);
  assert_int_equal(s->materials.items[mix->materials[0].index - 1].kind, VL_MATERIAL_CONDUCTOR);
  assert_int_equal(s->materials.items[mix->materials[1].index - 1].kind,
                   VL_MATERIAL_DIELECTRIC);
  assert_int_equal(s->materials.items[s->shapes.items[2].material.index - 1].kind,
                   VL_MATERIAL_DIFFUSE);
  assert_int_equal(s->shapes.items[3].material.index, s->shapes.items[1].material.index);
  end_load(&l);
}

/* pbrt-v4 shows "inside" between the dots, 1 unless it is given, and "outside" in them, 0
 * unless it is given. */
static void dots(void **state) {
  (void)state;
  Loaded l;
  load_fine(
      &l, W
      "Texture \"d\" \"float\" \"dots\"\n"
      "Texture \"e\" \"spectrum\" \"dots\" \"rgb inside\" [1 0 0] \"rgb outside\" [0 1 0]\n"
      "Material \"diffuse\" \"texture reflectance\" \"e\"\n"
      "Shape \"sphere\" \"texture alpha\" \"d\"\n");
  const vlTextureDef *t = l.scene->textures.items; /* a: between the dots, b: in them */
  assert_near(t[0].float_a.value, 1, 0);
  assert_near(t[0].float_b.value, 0, 0);
  assert_near(t[1].spectrum_a.value.rgb[0], 1, 0);
  assert_near(t[1].spectrum_b.value.rgb[1], 1, 0);
  end_load(&l);
}

static void textures(void **state) {
  (void)state;
  Loaded l;
  load_fine(
      &l, W
      "Texture \"c\" \"float\" \"constant\" \"float value\" 3\n"
      "Texture \"s\" \"float\" \"scale\" \"texture tex\" \"c\" \"float scale\" 2\n"
      "Texture \"m\" \"spectrum\" \"mix\" \"rgb tex1\" [1 0 0] \"texture amount\" \"s\"\n"
      "Texture \"d\" \"spectrum\" \"directionmix\" \"vector3 dir\" [0 0 2]\n"
      "Translate 1 0 0\n"
      "Texture \"k\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3\n"
      "Texture \"q\" \"spectrum\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 5 "
      "\"float udelta\" 6 \"float vdelta\" 7\n"
      "Texture \"p\" \"float\" \"bilerp\" \"float v00\" 9 \"string mapping\" \"planar\" "
      "\"vector3 v1\" [2 0 0] \"vector3 v2\" [0 3 0]\n"
      "Texture \"y\" \"float\" \"bilerp\" \"string mapping\" \"spherical\"\n"
      "Texture \"c\" \"spectrum\" \"constant\" \"rgb value\" [.5 .5 .5]\n"
      "Material \"diffuse\" \"texture reflectance\" \"c\" \"texture displacement\" \"s\"\n"
      "Shape \"sphere\" \"texture alpha\" \"c\"\nShape \"sphere\" \"float alpha\" 0.25\n");
  const vlTextureDef *t = l.scene->textures.items;
  assert_near(t[0].float_a.value, 3, 0);
  assert_int_equal(t[1].float_a.texture.index, 1);
  assert_near(t[1].amount.value, 2, 0);
  assert_true(t[2].spectrum);
  assert_near(t[2].spectrum_a.value.rgb[0], 1, 0);
  assert_near(t[2].spectrum_b.value.value, 1, 0); /* default */
  assert_int_equal(t[2].amount.texture.index, 2);
  assert_near(t[3].direction[2], 1, 0);
  assert_int_equal(t[4].dimension, 3);
  assert_near(t[4].texture_from_world[3], -1, 0);
  assert_near(t[4].spectrum_a.value.value, 1, 0);
  assert_near(t[4].spectrum_b.value.value, 0, 0);
  assert_near(t[5].su + 10 * t[5].sv + 100 * t[5].du + 1000 * t[5].dv, 4 + 50 + 600 + 7000, 0);
  assert_near(t[6].float_a.value, 9, 0);
  assert_near(t[6].float_b.value, 1, 0);
  assert_int_equal(t[6].mapping, VL_MAPPING_PLANAR);
  assert_near(t[6].planar_v1[0] + t[6].planar_v2[1], 5, 0);
  assert_int_equal(t[7].mapping, VL_MAPPING_SPHERICAL);
  assert_int_equal(last_material(&l)->reflectance.texture.index, 9);
  assert_int_equal(last_material(&l)->displacement.texture.index, 2);
  /* the float one of the two named c */
  assert_int_equal(l.scene->shapes.items[0].alpha.texture.index, 1);
  assert_near(l.scene->shapes.items[1].alpha.value, 0.25, 0);
  end_load(&l);
}

/* A sky of one colour behind a portal is an image of one pixel, of the light that it would be
 * without. */
static void plain_portal(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "LightSource \"infinite\" \"rgb L\" [3 2 1] \"float scale\" 4 "
            "\"point3 portal\" [0 0 0 0 1 0 1 1 0 1 0 0]\n"
            "LightSource \"infinite\" \"blackbody L\" 3000 "
            "\"point3 portal\" [0 0 0 0 1 0 1 1 0 1 0 0]");
  const vlLightDef *d = l.scene->lights.items;
  assert_true(d[0].has_portal && d[1].has_portal);
  assert_int_equal(vl_image_width(d[0].image), 1);
  const float *rgb = vl_image_const_pixels(d[0].image),
              *warm = vl_image_const_pixels(d[1].image);
  for (int i = 0; i < 3; i++)
    assert_near(rgb[i], 3 - i, 1e-4);
  assert_near(d[0].scale, 4, 0);
  assert_near(0.2126 * warm[0] + 0.7152 * warm[1] + 0.0722 * warm[2], 1, 1e-3);
  assert_true(warm[0] > 1.5f * warm[1] && warm[1] > warm[2]);
  end_load(&l);
}

static void lights(void **state) {
  (void)state;
  Loaded l;
  load_fine(
      &l, "ColorSpace \"rec2020\"\n" W
          "LightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 4 \"float power\" 60 "
          "\"point3 from\" [1 2 3]\n"
          "LightSource \"spot\" \"blackbody I\" 3000 \"float coneangle\" 45 "
          "\"float conedeltaangle\" 10 \"point3 to\" [0 1 0]\n"
          "ColorSpace \"srgb\" Translate 5 0 0\n"
          "LightSource \"distant\" \"float illuminance\" 100 \"point3 from\" [0 0 5]\n"
          "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\" \"float illuminance\" -1\n"
          "LightSource \"infinite\"\n");
  const vlLightDef *d = l.scene->lights.items;
  assert_int_equal(d[0].kind, VL_LIGHT_POINT);
  assert_int_equal(d[0].color.space, VL_SPACE_REC2020);
  assert_near(d[0].color.rgb[2], 3, 0);
  assert_near(d[0].scale, 4, 0);
  assert_near(d[0].power, 60, 0);
  assert_near(d[0].from[1], 2, 0);
  assert_near(d[1].color.kelvin, 3000, 0);
  assert_near(d[1].cone_angle, M_PI / 4, 1e-6);
  assert_near(d[1].cone_delta, M_PI / 18, 1e-6);
  assert_near(d[1].to[1], 1, 0);
  assert_true(isnan(d[1].power));
  assert_near(d[2].illuminance, 100, 0);
  assert_near(d[2].to[2], 1, 0);
  assert_near(d[2].world_from_light[3], 5, 0);
  assert_int_equal(d[2].color.space, VL_SPACE_SRGB);
  assert_string_equal(d[3].color.name, "stdillum-D65");
  assert_true(isnan(d[3].illuminance));
  assert_near(d[4].color.rgb[0], 1, 0);
  end_load(&l);
}

static void area_lights(void **state) {
  (void)state;
  Loaded l;
  vlSceneInfo info;
  load_fine(
      &l, W
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 2 "
      "\"bool twosided\" true \"float power\" 7\n"
      "Shape \"sphere\" Shape \"disk\" AreaLightSource \"\" Shape \"sphere\" AttributeEnd "
      "Shape \"cylinder\"\n"
      "ObjectBegin \"o\" AreaLightSource \"diffuse\" Shape \"sphere\" ObjectEnd\n");
  vl_scene_info(l.scene, &info);
  assert_int_equal(info.emissive_shapes, 2);
  const vlEmissionDef *e =
      &l.scene->emissions.items[l.scene->shapes.items[1].emission.index - 1];
  assert_near(e->radiance.rgb[1], 2, 0);
  assert_near(e->scale, 2, 0);
  assert_near(e->power, 7, 0);
  assert_true(e->two_sided);
  assert_non_null(strstr(l.log, "warning t.pbrt:4:")); /* in objects they give no light */
  end_load(&l);
}

/* pbrt's surface integrators ignore media. velo ignores them, too, and gives a warning. */
static void media(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l,
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 1 1]\n"
            "MediumInterface \"\" \"fog\"\n"
            "Camera \"perspective\"\n"
            "Integrator \"path\"\n" W "Shape \"sphere\"");
  assert_non_null(strstr(
      l.log,
      "warning t.pbrt:3:1: integrator \"path\" looks past participating media (here \"fog\")"));
  end_load(&l);
  load_fine(&l, "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n" W
                "Shape \"sphere\""); /* nothing lies in it */
  assert_string_equal(l.log, "");
  end_load(&l);
  load_fine(&l,
            "MakeNamedMedium \"sea\" \"string type\" \"homogeneous\" "
            "\"string preset\" \"Pacific Ocean Surface Water\"\n" W); /* the last one */
  end_load(&l);
  /* Every kind; named before they are made; who lies in them. */
  load_fine(
      &l, "MediumInterface \"\" \"air\"\nCamera \"perspective\"\n" W
          "MakeNamedMedium \"air\" \"string type\" \"homogeneous\" \"string preset\" \"Skin1\" "
          "\"float scale\" 2\n"
          "LightSource \"point\"\n"
          "MediumInterface \"grid\" \"air\"\n"
          "Shape \"sphere\"\n"
          "AttributeBegin Translate 1 2 3\n"
          "MakeNamedMedium \"grid\" \"string type\" \"uniformgrid\" \"integer nx\" 2 "
          "\"integer nz\" 2 \"float density\" [1 2 3 4] \"float Lescale\" [5 6 7 8] "
          "\"rgb Le\" [1 2 3] \"point3 p0\" [4 5 6] \"float g\" -.5\n"
          "AttributeEnd\n"
          "MakeNamedMedium \"rgb\" \"string type\" \"rgbgrid\" \"rgb sigma_a\" [1 2 3] "
          "\"rgb Le\" [3 2 1] \"float Lescale\" 7\n"
          "MakeNamedMedium \"cloud\" \"string type\" \"cloud\" \"float wispiness\" 3\n"
          "MediumInterface \"rgb\"\n"
          "Shape \"disk\"\n"
          "MediumInterface \"cloud\" \"cloud\"\n"
          "Shape \"disk\"\n");
  const vlMediumDef *m = l.scene->media.items;
  const vlShapeDef *s = l.scene->shapes.items;
  assert_int_equal(l.scene->media.count, 4);
  assert_string_equal(m[0].name, "air");
  assert_near(m[0].sigma_a.rgb[1], 0.17, 1e-6);
  assert_near(m[0].sigma_s.rgb[2], 1.01, 1e-6);
  assert_near(m[0].scale, 2, 0);
  assert_int_equal(m[1].kind, VL_MEDIUM_GRID);
  assert_near(m[1].density[3], 4, 0);
  assert_near(m[1].emission_scales[2], 7, 0);
  assert_near(m[1].emission.rgb[2], 3, 0);
  assert_near(m[1].g, -.5, 0);
  assert_near(m[1].low[0], 1, 0); /* corners sorted */
  assert_near(m[1].high[2], 6, 0);
  assert_near(m[1].world_from_medium[11], 3, 0);
  assert_near(m[2].rgb_a[1], 2, 0);
  assert_near(m[2].emission_scale, 7, 0);
  assert_near(m[3].wispiness, 3, 0);
  assert_int_equal(vl_scene_defs(l.scene)->camera_medium.index, 1);
  assert_int_equal(l.scene->lights.items[0].medium.index, 1);
  assert_int_equal(s[0].inside.index, 2);
  assert_int_equal(s[0].outside.index, 1);
  assert_int_equal(s[1].inside.index, 3); /* one name stands for both sides */
  assert_int_equal(s[2].inside.index, 4);
  assert_int_equal(s[2].outside.index, 4);
  end_load(&l);
}

/* Attribute: defaults for what comes, overridden by the thing's own, gone with their block,
 * unused ones forgiven. */
static void attributes(void **state) {
  (void)state;
  Loaded l;
  load_fine(
      &l, W
      "Attribute \"shape\" \"float radius\" 3 \"float nonsense\" 1\n"
      "Shape \"sphere\" Shape \"sphere\" \"float radius\" 4\n"
      "AttributeBegin Attribute \"shape\" \"float radius\" 5 "
      "Shape \"sphere\" AttributeEnd Shape \"sphere\"\n"
      "Attribute \"material\" \"rgb reflectance\" [.1 .2 .3]\n"
      "AttributeBegin ColorSpace \"rec2020\" Material \"diffuse\" "
      "Shape \"disk\" AttributeEnd\n"
      "Attribute \"light\" \"float scale\" 9 LightSource \"point\"\n"
      "Attribute \"texture\" \"float value\" 2 Texture \"t\" \"float\" \"constant\"\n"
      "Attribute \"shape\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\nShape \"trianglemesh\" Shape "
      "\"trianglemesh\"");
  const vlShapeDef *s = l.scene->shapes.items;
  assert_near(s[0].radius, 3, 0);
  assert_near(s[1].radius, 4, 0);
  assert_near(s[2].radius, 5, 0);
  assert_near(s[3].radius, 3, 0);
  assert_near(s[6].positions[3], 1, 0);
  assert_ptr_not_equal(s[5].positions, s[6].positions);
  assert_near(last_material(&l)->reflectance.value.rgb[1], .2, 1e-7);
  /* where the attribute stood */
  assert_int_equal(last_material(&l)->reflectance.value.space, VL_SPACE_SRGB);
  assert_near(l.scene->lights.items[0].scale, 9, 0);
  assert_near(l.scene->textures.items[0].float_a.value, 2, 0);
  end_load(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(attributes),   cmocka_unit_test(materials),
      cmocka_unit_test(bodies),       cmocka_unit_test(named_materials),
      cmocka_unit_test(dots),         cmocka_unit_test(textures),
      cmocka_unit_test(plain_portal), cmocka_unit_test(lights),
      cmocka_unit_test(area_lights),  cmocka_unit_test(media)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
