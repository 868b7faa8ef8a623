/* test/import/test_builder.c: what statements mean: transforms, state, names, every kind of thing with its defaults,
 * and the settings of the picture. */
#include "import/load.h"

#define W "WorldBegin\n"

static const double *shape_matrix(const Loaded *l, size_t i) {
  return l->scene->shapes.items[i].group_from_shape;
}

static void assert_matrix(const double *m, const double expected[16]) {
  for (int i = 0; i < 16; i++) assert_near(m[i], expected[i], 1e-12);
}

static void transforms(void **state) {
  (void)state;
  Loaded l;
  load_fine(
      &l, W
      "Translate 1 2 3 Shape \"sphere\"\n"
      "Scale 2 3 4 Shape \"sphere\"\n"
      "Identity Rotate 90 0 0 1 Shape \"sphere\"\n"
      "Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1 ] Shape \"sphere\"\n"
      "ConcatTransform [ 2 0 0 0  0 1 0 0  0 0 1 0  1 0 0 1 ] Shape \"sphere\"\n"
      "CoordinateSystem \"here\" Identity\n"
      "AttributeBegin Translate 9 9 9 Shape \"sphere\" AttributeEnd Shape \"sphere\"\n"
      "TransformBegin Translate 9 9 9 TransformEnd Shape \"sphere\"\n"
      "CoordSysTransform \"here\" Shape \"sphere\"\n"
      "CoordSysTransform \"world\" ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 1 0 0\n"
      "ActiveTransform All TransformBegin TransformEnd Shape \"sphere\"\n");
  assert_matrix(shape_matrix(&l, 0), (double[]){1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1});
  assert_matrix(shape_matrix(&l, 1), (double[]){2, 0, 0, 1, 0, 3, 0, 2, 0, 0, 4, 3, 0, 0, 0, 1});
  assert_matrix(shape_matrix(&l, 2), (double[]){0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  assert_matrix(shape_matrix(&l, 3), (double[]){1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1});
  const double here[] = {2, 0, 0, 6, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1},
               one[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  assert_matrix(shape_matrix(&l, 4), here);
  assert_matrix(shape_matrix(&l, 5), (double[]){1, 0, 0, 9, 0, 1, 0, 9, 0, 0, 1, 9, 0, 0, 0, 1});
  assert_matrix(shape_matrix(&l, 6), one);
  assert_matrix(shape_matrix(&l, 7), one);
  assert_matrix(shape_matrix(&l, 8), here);
  assert_matrix(shape_matrix(&l, 9), (double[]){1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  end_load(&l);
}

static vlCamera camera_of(Loaded *l, const char *text) {
  vlCamera camera;
  vlError error;
  load_fine(l, text);
  vlResult result = vl_camera_make(&vl_scene_settings(l->scene)->camera, &camera, NULL, &error);
  if (result != VL_OK) print_message("%s\n", error.message);
  assert_int_equal(result, VL_OK);
  return camera;
}

static void assert_seen(const vlCamera *camera, double x, double y, double z, double px, double py) {
  double pixel[2], depth;
  assert_true(vl_camera_project(camera, (double[]){x, y, z}, pixel, &depth));
  assert_near(pixel[0], px, 1e-9);
  assert_near(pixel[1], py, 1e-9);
}

/* pbrt looks along +z, x to the right, y up, in a left-handed world; fov spans the smaller side. */
static void pbrt_cameras(void **state) {
  (void)state;
  Loaded l;
  vlCamera c = camera_of(&l,
                         "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\nCamera \"perspective\" "
                         "\"float fov\" 90\n" W);
  assert_seen(&c, 0, 0, 1, 100, 50);
  assert_seen(&c, 1, 0, 1, 150, 50);
  assert_seen(&c, 0, 1, 1, 100, 0);
  assert_string_equal(vl_scene_settings(l.scene)->camera_source.file, "t.pbrt");
  assert_int_equal(vl_scene_settings(l.scene)->camera_source.line, 2);
  end_load(&l);
  /* portrait: fov across */
  c = camera_of(&l, "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 200\nCamera \"perspective\"\n" W);
  assert_seen(&c, 1, 0, 1, 100, 100);
  assert_seen(&c, 0, 1, 1, 50, 50);
  end_load(&l);
  /* LookAt: from (0,0,-5) to the origin; right is +x in pbrt's numbers */
  c = camera_of(&l,
                "LookAt 0 0 -5 0 0 0 0 1 0\nFilm \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" "
                "100\nCamera \"perspective\"\n" W);
  assert_seen(&c, 5, 0, 0, 100, 50);
  assert_seen(&c, 0, 5, 0, 50, 0);
  assert_near(c.world_from_camera[11], -5, 1e-12);
  end_load(&l);
  /* a mirroring transform before the camera swaps left and right */
  c = camera_of(
      &l,
      "Scale -1 1 1\nFilm \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\nCamera \"perspective\"\n" W);
  assert_seen(&c, 1, 0, 1, 0, 50);
  end_load(&l);
  /* screen window: x 0..1, y 0..1 at fov 90: the quadrant right and above */
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n"
                "Camera \"perspective\" \"float screenwindow\" [0 1 0 1] \"float fov\" 90\n" W);
  assert_seen(&c, 0, 0, 1, 0, 100);
  assert_seen(&c, 1, 1, 1, 100, 0);
  end_load(&l);
  /* a frame of another shape than the picture: pixels are not square */
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\nCamera \"perspective\" \"float "
                "frameaspectratio\" 2\n" W);
  assert_seen(&c, 2, 1, 1, 100, 0);
  end_load(&l);
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\nCamera \"orthographic\" \"float "
                "screenwindow\" [-4 4 -2 2]\n" W);
  assert_int_equal(c.projection, VL_PROJECTION_ORTHOGRAPHIC);
  assert_seen(&c, 2, 1, 7, 150, 25);
  end_load(&l);
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\nCamera \"orthographic\"\n" W);
  assert_seen(&c, 2, 1, 7, 200, 0);
  end_load(&l);
  c = camera_of(&l,
                "Camera \"perspective\" \"float lensradius\" 0.5 \"float focaldistance\" 7 \"float shutteropen\" 1 "
                "\"float shutterclose\" 3\n" W);
  assert_near(c.lens_radius, 0.5, 0);
  assert_near(c.focus_distance, 7, 0);
  assert_near(c.shutter_open, 1, 0);
  assert_near(c.shutter_close, 3, 0);
  assert_near(vl_scene_settings(l.scene)->exposure, 2, 0); /* pbrt's imaging ratio counts the time */
  end_load(&l);
  c = camera_of(&l, "Camera \"perspective\" \"float lensradius\" 0.5\n" W);
  assert_near(c.focus_distance, 1e6, 0);
  end_load(&l);
  c = camera_of(&l, W); /* no camera: pbrt's default at the origin */
  assert_seen(&c, 0, 0, 1, 640, 360);
  assert_seen(&c, 0, 1, 1, 640, 0);
  end_load(&l);
}

/* "camera" names the camera's place with pbrt's axes. */
static void camera_system(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l,
            "LookAt 1 2 3 1 2 9 0 1 0\nCamera \"perspective\"\n" W "CoordSysTransform \"camera\"\nShape \"sphere\"");
  assert_matrix(shape_matrix(&l, 0), (double[]){1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1});
  end_load(&l);
  load_fine(&l, "Camera \"pinhole\" \"point3 eye\" [1 2 3] \"point3 lookat\" [1 2 -9]\n" W
                "CoordSysTransform \"camera\"\nShape \"sphere\"");
  assert_matrix(shape_matrix(&l, 0), (double[]){1, 0, 0, 1, 0, 1, 0, 2, 0, 0, -1, 3, 0, 0, 0, 1});
  end_load(&l);
}

/* The lecture's words: d = x_v u + y_v v - d w with x_v = s (c - h/2 + p_x); rows in files count from the top. */
static void lecture_cameras(void **state) {
  (void)state;
  Loaded l;
  vlCamera c = camera_of(
      &l,
      "Film \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" 300\n"
      "Camera \"pinhole\" \"point3 eye\" [0 0 500] \"point3 lookat\" [0 0 0] \"vector3 up\" [0 1 0] \"float d\" 400\n"
      "  \"float zoom\" 1.5 \"float pixelsize\" 0.5 \"float exposuretime\" 2 \"float roll\" 0\n" W);
  assert_seen(&c, 0, 0, 0, 200, 150);
  assert_seen(&c, 10, 20, 0, 200 + 1.5 * 400 / 0.5 * 10 / 500, 150 - 1.5 * 400 / 0.5 * 20 / 500);
  assert_near(c.exposure_time, 2, 0);
  end_load(&l);
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" 300\n"
                "Camera \"pinhole\" \"point3 eye\" [0 0 5] \"float fov\" 90 \"string fovaxis\" \"horizontal\" \"float "
                "roll\" 90\n" W);
  assert_near(c.fx, 200, 1e-9);
  assert_seen(&c, 0, 1, 4, 0, 150); /* the camera turned clockwise: up is on the left */
  end_load(&l);
  c = camera_of(&l,
                "Camera \"thinlens\" \"float lensradius\" 2 \"float focusdistance\" 30 \"float fx\" 100 \"float cx\" 3 "
                "\"float cy\" 4\n" W);
  assert_near(c.lens_radius, 2, 0);
  assert_near(c.focus_distance, 30, 0);
  assert_near(c.fy, 100, 0);
  assert_near(c.cx, 3, 0);
  end_load(&l);
}

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
            "Material \"coateddiffuse\" \"rgb reflectance\" [.1 .2 .3] \"float roughness\" .3 \"float uroughness\" .2 "
            "\"float thickness\" .5"
            " \"spectrum eta\" \"glass-BK7\" \"float g\" .7 \"rgb albedo\" [.9 .9 .9] \"integer maxdepth\" 3 \"integer "
            "nsamples\" 2"
            " \"bool remaproughness\" false");
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
  load_fine(
      &l,
      W "Material \"dielectric\" \"float eta\" 1.33 Material \"thindielectric\" \"spectrum eta\" [400 1.5 700 1.4]");
  assert_near(l.scene->materials.items[0].eta.value.value, 1.33, 1e-6);
  assert_int_equal(last_material(&l)->eta.value.count, 2);
  assert_near(last_material(&l)->eta.value.wavelengths[1], 700, 0);
  assert_near(last_material(&l)->eta.value.values[1], 1.4, 1e-6);
  end_load(&l);
  const char *nothing[] = {"interface", "", "none"};
  for (int i = 0; i < 3; i++) {
    char text[256];
    snprintf(text, sizeof text, W "AreaLightSource \"diffuse\" Material \"%s\" Shape \"sphere\"", nothing[i]);
    load_fine(&l, text);
    assert_int_equal(last_material(&l)->kind, VL_MATERIAL_INTERFACE);
    assert_int_equal(l.scene->shapes.items[0].emission.index, 0); /* as in pbrt, with a warning */
    assert_non_null(strstr(l.log, "its area light is ignored"));
    end_load(&l);
  }
}

/* Four ways to say what a body is made of. */
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
  load_fine(&l,
            W "Material \"subsurface\" \"string name\" \"Skin1\" \"float g\" .5 \"float scale\" 10 \"float eta\" 1.4");
  m = last_material(&l);
  assert_near(m->subsurface.sigma_s.value.rgb[1], .88, 1e-6);
  assert_near(m->subsurface.sigma_a.value.rgb[1], .17, 1e-7);
  assert_near(m->scale, 10, 0);
  assert_near(m->eta.value.value, 1.4, 1e-6);
  assert_near(m->g.value, 0, 0);
  assert_non_null(strstr(l.log, "\"g\" is ignored beside \"name\""));
  end_load(&l);
  load_fine(
      &l, W
      "Texture \"t\" \"spectrum\" \"checkerboard\" Material \"subsurface\" \"texture sigma_a\" \"t\""
      " \"spectrum sigma_s\" [400 1 700 2] \"float g\" -.5 \"float uroughness\" .2 \"bool remaproughness\" false");
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

/* Materials may be named before they are made; a mix refers by name; shapes get what holds where they stand. */
static void named_materials(void **state) {
  (void)state;
  Loaded l;
  load_fine(
      &l, W
      "Shape \"sphere\"\n"
      "NamedMaterial \"later\" Shape \"sphere\"\n"
      "AttributeBegin Material \"diffuse\" Shape \"sphere\" AttributeEnd Shape \"sphere\"\n"
      "MakeNamedMaterial \"later\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.25\n"
      "MakeNamedMaterial \"a\" \"string type\" \"conductor\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"dielectric\"\n");
  const vlScene *s = l.scene;
  assert_int_equal(s->shapes.items[0].material.index, 0);
  const vlMaterialDef *mix = &s->materials.items[s->shapes.items[1].material.index - 1];
  assert_int_equal(mix->kind, VL_MATERIAL_MIX);
  assert_string_equal(mix->name, "later");
  assert_near(mix->amount.value, 0.25, 0);
  assert_int_equal(s->materials.items[mix->materials[0].index - 1].kind, VL_MATERIAL_CONDUCTOR);
  assert_int_equal(s->materials.items[mix->materials[1].index - 1].kind, VL_MATERIAL_DIELECTRIC);
  assert_int_equal(s->materials.items[s->shapes.items[2].material.index - 1].kind, VL_MATERIAL_DIFFUSE);
  assert_int_equal(s->shapes.items[3].material.index, s->shapes.items[1].material.index);
  end_load(&l);
}

static void textures(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "Texture \"c\" \"float\" \"constant\" \"float value\" 3\n"
            "Texture \"s\" \"float\" \"scale\" \"texture tex\" \"c\" \"float scale\" 2\n"
            "Texture \"m\" \"spectrum\" \"mix\" \"rgb tex1\" [1 0 0] \"texture amount\" \"s\"\n"
            "Texture \"d\" \"spectrum\" \"directionmix\" \"vector3 dir\" [0 0 2]\n"
            "Translate 1 0 0\n"
            "Texture \"k\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3\n"
            "Texture \"q\" \"spectrum\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 5 \"float udelta\" 6 "
            "\"float vdelta\" 7\n"
            "Texture \"p\" \"float\" \"bilerp\" \"float v00\" 9 \"string mapping\" \"planar\" \"vector3 v1\" [2 0 0] "
            "\"vector3 v2\" [0 3 0]\n"
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
  assert_int_equal(l.scene->shapes.items[0].alpha.texture.index, 1); /* the float one of the two named c */
  assert_near(l.scene->shapes.items[1].alpha.value, 0.25, 0);
  end_load(&l);
}

/* A sky of one colour behind a portal is a picture of one pixel, of the light that it would be without. */
static void plain_portal(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "LightSource \"infinite\" \"rgb L\" [3 2 1] \"float scale\" 4 "
            "\"point3 portal\" [0 0 0 0 1 0 1 1 0 1 0 0]\n"
            "LightSource \"infinite\" \"blackbody L\" 3000 \"point3 portal\" [0 0 0 0 1 0 1 1 0 1 0 0]");
  const vlLightDef *d = l.scene->lights.items;
  assert_true(d[0].has_portal && d[1].has_portal);
  assert_int_equal(vl_image_width(d[0].image), 1);
  const float *rgb = vl_image_const_pixels(d[0].image), *warm = vl_image_const_pixels(d[1].image);
  for (int i = 0; i < 3; i++) assert_near(rgb[i], 3 - i, 1e-4);
  assert_near(d[0].scale, 4, 0);
  assert_near(0.2126 * warm[0] + 0.7152 * warm[1] + 0.0722 * warm[2], 1, 1e-3);
  assert_true(warm[0] > 1.5f * warm[1] && warm[1] > warm[2]);
  end_load(&l);
}

static void lights(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, "ColorSpace \"rec2020\"\n" W
                "LightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 4 \"float power\" 60 \"point3 from\" [1 2 3]\n"
                "LightSource \"spot\" \"blackbody I\" 3000 \"float coneangle\" 45 \"float conedeltaangle\" 10 \"point3 "
                "to\" [0 1 0]\n"
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
  load_fine(&l, W
            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 2 \"bool twosided\" true "
            "\"float power\" 7\n"
            "Shape \"sphere\" Shape \"disk\" AreaLightSource \"\" Shape \"sphere\" AttributeEnd Shape \"cylinder\"\n"
            "ObjectBegin \"o\" AreaLightSource \"diffuse\" Shape \"sphere\" ObjectEnd\n");
  vl_scene_info(l.scene, &info);
  assert_int_equal(info.emissive_shapes, 2);
  const vlEmissionDef *e = &l.scene->emissions.items[l.scene->shapes.items[1].emission.index - 1];
  assert_near(e->radiance.rgb[1], 2, 0);
  assert_near(e->scale, 2, 0);
  assert_near(e->power, 7, 0);
  assert_true(e->two_sided);
  assert_non_null(strstr(l.log, "warning t.pbrt:4:")); /* in objects they give no light */
  end_load(&l);
}

static void shapes(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "Shape \"sphere\" \"float radius\" 2 \"float phimax\" 180\n"
            "Shape \"sphere\" \"float radius\" 2 \"float zmin\" -1 \"float zmax\" 1.5\n"
            "Shape \"disk\" \"float height\" 3 \"float innerradius\" .5\n"
            "Shape \"cylinder\" \"float zmin\" 4 \"float zmax\" -4\n"
            "ReverseOrientation\n"
            "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [0 1 2 1 3 2]\n"
            "  \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1] \"vector3 S\" [1 0 0 1 0 0 1 0 0 1 0 0] \"point2 uv\" [0 0 1 0 0 "
            "1 1 1]\n"
            "  \"integer faceIndices\" [0 1]\n"
            "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0]\n"
            "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n"
            "Shape \"sphere\" \"float zmin\" 9 \"float zmax\" -.5\n");
  const vlShapeDef *s = l.scene->shapes.items;
  assert_near(s[0].z_min, -2, 0);
  assert_near(s[0].z_max, 2, 0);
  assert_near(s[0].phi_max, M_PI, 1e-6);
  assert_near(s[1].z_min, -1, 0);
  assert_near(s[1].z_max, 1.5, 0);
  assert_near(s[2].height, 3, 0);
  assert_near(s[2].inner_radius, .5, 0);
  assert_near(s[3].z_min, -4, 0);
  assert_false(s[3].reverse_orientation);
  assert_true(s[4].reverse_orientation);
  assert_int_equal(s[4].vertices, 4);
  assert_int_equal(s[4].faces, 2);
  assert_int_equal(s[4].indices[4], 3);
  assert_near(s[4].uvs[6], 1, 0);
  assert_near(s[4].normals[11], 1, 0);
  assert_near(s[4].tangents[9], 1, 0);
  assert_int_equal(s[5].faces, 1);
  assert_int_equal(s[5].indices[2], 2);
  assert_int_equal(s[6].kind, VL_SHAPE_BILINEAR);
  assert_int_equal(s[6].indices[3], 3);
  assert_near(s[7].z_min, -.5, 0); /* sorted and clamped, as in pbrt */
  assert_near(s[7].z_max, 1, 0);
  assert_int_equal(s[4].source.line, 7);
  end_load(&l);
}

static void objects(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "ObjectInstance \"late\"\n"
            "ObjectBegin \"thing\" Translate 1 0 0 Shape \"sphere\" Shape \"disk\" ObjectEnd\n"
            "Scale 2 2 2 ObjectInstance \"thing\" Shape \"sphere\"\n"
            "ObjectBegin \"late\" Shape \"sphere\" ObjectEnd\n");
  const vlScene *s = l.scene;
  assert_int_equal(s->groups.count, 2);
  assert_int_equal(s->instances.count, 2);
  assert_string_equal(s->groups.items[0].name, "late");
  assert_int_equal(s->groups.items[0].shape_count, 1);
  assert_int_equal(s->groups.items[1].shape_count, 2);
  assert_int_equal(s->groups.items[1].instance_count, 1);
  assert_int_equal(s->shapes.items[0].group.index, 2);
  assert_near(s->shapes.items[0].group_from_shape[3], 1, 0);
  assert_near(s->instances.items[1].world_from_group[0], 2, 0);
  assert_near(s->instances.items[1].world_from_group[3], 0, 0);
  assert_int_equal(s->shapes.items[2].group.index, 0);
  end_load(&l);
}

/* Attribute: defaults for what comes, overridden by the thing's own, gone with their block, unused ones forgiven. */
static void attributes(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "Attribute \"shape\" \"float radius\" 3 \"float nonsense\" 1\n"
            "Shape \"sphere\" Shape \"sphere\" \"float radius\" 4\n"
            "AttributeBegin Attribute \"shape\" \"float radius\" 5 Shape \"sphere\" AttributeEnd Shape \"sphere\"\n"
            "Attribute \"material\" \"rgb reflectance\" [.1 .2 .3]\n"
            "AttributeBegin ColorSpace \"rec2020\" Material \"diffuse\" Shape \"disk\" AttributeEnd\n"
            "Attribute \"light\" \"float scale\" 9 LightSource \"point\"\n"
            "Attribute \"texture\" \"float value\" 2 Texture \"t\" \"float\" \"constant\"\n"
            "Attribute \"shape\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\nShape \"trianglemesh\" Shape \"trianglemesh\"");
  const vlShapeDef *s = l.scene->shapes.items;
  assert_near(s[0].radius, 3, 0);
  assert_near(s[1].radius, 4, 0);
  assert_near(s[2].radius, 5, 0);
  assert_near(s[3].radius, 3, 0);
  assert_near(s[6].positions[3], 1, 0);
  assert_ptr_not_equal(s[5].positions, s[6].positions);
  assert_near(last_material(&l)->reflectance.value.rgb[1], .2, 1e-7);
  assert_int_equal(last_material(&l)->reflectance.value.space, VL_SPACE_SRGB); /* where the attribute stood */
  assert_near(l.scene->lights.items[0].scale, 9, 0);
  assert_near(l.scene->textures.items[0].float_a.value, 2, 0);
  end_load(&l);
}

static void picture_settings(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W);
  const vlSceneSettings *s = vl_scene_settings(l.scene);
  assert_int_equal(s->width, 1280);
  assert_int_equal(s->height, 720);
  assert_int_equal(s->spp, 16);
  assert_int_equal(s->sampler, VL_SAMPLER_ZSOBOL);
  assert_int_equal(s->tracer, VL_TRACER_VOLPATH);
  assert_int_equal(s->max_depth, 5);
  assert_int_equal(s->filter.kind, VL_PIXEL_FILTER_GAUSSIAN);
  assert_near(s->filter.radius_x, 1.5, 0);
  assert_near(s->filter.sigma, 0.5, 0);
  assert_near(s->exposure, 1, 0);
  end_load(&l);
  load_fine(
      &l,
      "Option \"seed\" 17\nColorSpace \"rec2020\"\n"
      "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" [ 50 ] \"string filename\" \"out.exr\" \"float "
      "iso\" 200\n"
      "  \"float cropwindow\" [ .101 .5 0 .21 ] \"bool savefp16\" false \"float diagonal\" 20 \"string sensor\" "
      "\"cie1931\"\n"
      "Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5\n"
      "PixelFilter \"mitchell\" \"float xradius\" 3 \"float B\" .5 \"float C\" .25\n"
      "Integrator \"volpath\" \"integer maxdepth\" 12 \"string lightsampler\" \"power\" \"bool regularize\" true\n"
      "Accelerator \"kdtree\" \"integer intersectcost\" 5\nTransformTimes 0 1\n" W);
  s = vl_scene_settings(l.scene);
  assert_int_equal(s->crop[0], 11); /* rounded up, as pbrt */
  assert_int_equal(s->crop[2], 50);
  assert_int_equal(s->crop[1], 0);
  assert_int_equal(s->crop[3], 11);
  assert_string_equal(s->output, "out.exr");
  assert_near(s->exposure, 2, 0);
  assert_int_equal(s->space, VL_SPACE_REC2020);
  assert_int_equal(s->sampler, VL_SAMPLER_STRATIFIED);
  assert_int_equal(s->spp, 15);
  assert_int_equal(s->sampler_seed, 17);
  assert_near(s->filter.radius_x, 3, 0);
  assert_near(s->filter.radius_y, 2, 0);
  assert_near(s->filter.c, .25, 0);
  assert_int_equal(s->max_depth, 12);
  assert_int_equal(s->light_sampler, VL_LIGHT_SAMPLER_POWER);
  assert_true(s->regularize);
  end_load(&l);
  load_fine(
      &l,
      "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 50 \"integer pixelbounds\" [ 10 20 -5 500 ]\n"
      "Integrator \"ambientocclusion\" \"float maxdistance\" 4 \"bool cossample\" false\n"
      "Sampler \"paddedsobol\" \"integer pixelsamples\" 8 \"integer seed\" 3 \"string randomization\" \"owen\"\n" W);
  s = vl_scene_settings(l.scene);
  assert_int_equal(s->crop[0], 10);
  assert_int_equal(s->crop[1], 0);
  assert_int_equal(s->crop[2], 20);
  assert_int_equal(s->crop[3], 50);
  assert_int_equal(s->tracer, VL_TRACER_AMBIENT_OCCLUSION);
  assert_near(s->ao_distance, 4, 0);
  assert_false(s->ao_cosine);
  assert_int_equal(s->sampler, VL_SAMPLER_SOBOL);
  assert_int_equal(s->sampler_seed, 3);
  assert_non_null(strstr(l.log, "info t.pbrt:3:1: sampler \"paddedsobol\""));
  end_load(&l);
  load_fine(&l, W
            "Material \"coateddiffuse\" \"float roughness\" 0.001\nShape \"sphere\"\n"
            "Material \"coateddiffuse\" \"float roughness\" 0.1\nShape \"sphere\"");
  assert_non_null(strstr(l.log, ": 1 rough coat: pbrt-v4 shows such 2 to 8 %"));
  end_load(&l);
  const struct {
    const char *name;
    vlSamplerKind kind;
  } samplers[] = {{"independent", VL_SAMPLER_INDEPENDENT},
                  {"random", VL_SAMPLER_INDEPENDENT},
                  {"regular", VL_SAMPLER_REGULAR},
                  {"jittered", VL_SAMPLER_STRATIFIED},
                  {"nrooks", VL_SAMPLER_NROOKS},
                  {"multijittered", VL_SAMPLER_MULTI_JITTERED},
                  {"hammersley", VL_SAMPLER_HAMMERSLEY},
                  {"halton", VL_SAMPLER_HALTON},
                  {"sobol", VL_SAMPLER_SOBOL},
                  {"zsobol", VL_SAMPLER_ZSOBOL},
                  {"pmj02bn", VL_SAMPLER_ZSOBOL}};
  for (size_t i = 0; i < sizeof samplers / sizeof *samplers; i++) {
    char text[128];
    snprintf(text, sizeof text, "Sampler \"%s\" \"integer pixelsamples\" 9\n" W, samplers[i].name);
    load_fine(&l, text);
    assert_int_equal(vl_scene_settings(l.scene)->sampler, samplers[i].kind);
    assert_int_equal(vl_scene_settings(l.scene)->spp, 9);
    end_load(&l);
  }
  const struct {
    const char *name;
    vlPixelFilterKind kind;
    float radius;
  } filters[] = {{"box", VL_PIXEL_FILTER_BOX, .5f},
                 {"triangle", VL_PIXEL_FILTER_TRIANGLE, 2},
                 {"gaussian", VL_PIXEL_FILTER_GAUSSIAN, 1.5f},
                 {"mitchell", VL_PIXEL_FILTER_MITCHELL, 2},
                 {"sinc", VL_PIXEL_FILTER_LANCZOS, 4},
                 {"lanczos", VL_PIXEL_FILTER_LANCZOS, 4},
                 {"blackmanharris", VL_PIXEL_FILTER_BLACKMAN_HARRIS, 2}};
  for (size_t i = 0; i < sizeof filters / sizeof *filters; i++) {
    char text[128];
    snprintf(text, sizeof text, "PixelFilter \"%s\"\n" W, filters[i].name);
    load_fine(&l, text);
    assert_int_equal(vl_scene_settings(l.scene)->filter.kind, filters[i].kind);
    assert_near(vl_scene_settings(l.scene)->filter.radius_x, filters[i].radius, 0);
    end_load(&l);
  }
}

/* pbrt's surface integrators look past media; so does velo, and says so. */
static void media(void **state) {
  (void)state;
  Loaded l;
  load_fine(
      &l,
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 1 1]\nMediumInterface \"\" \"fog\"\n"
      "Camera \"perspective\"\nIntegrator \"path\"\n" W "Shape \"sphere\"");
  assert_non_null(
      strstr(l.log, "warning t.pbrt:3:1: integrator \"path\" looks past participating media (here \"fog\")"));
  end_load(&l);
  load_fine(&l,
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n" W "Shape \"sphere\""); /* nothing lies in it */
  assert_string_equal(l.log, "");
  end_load(&l);
  /* Every kind; named before they are made; who lies in them. */
  load_fine(
      &l,
      "MediumInterface \"\" \"air\"\nCamera \"perspective\"\n" W
      "MakeNamedMedium \"air\" \"string type\" \"homogeneous\" \"string preset\" \"Skin1\" \"float scale\" 2\n"
      "LightSource \"point\"\nMediumInterface \"grid\" \"air\"\nShape \"sphere\"\n"
      "AttributeBegin Translate 1 2 3\n"
      "MakeNamedMedium \"grid\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer nz\" 2 \"float density\" "
      "[1 2 3 4] \"float Lescale\" [5 6 7 8] \"rgb Le\" [1 2 3] \"point3 p0\" [4 5 6] \"float g\" -.5\nAttributeEnd\n"
      "MakeNamedMedium \"rgb\" \"string type\" \"rgbgrid\" \"rgb sigma_a\" [1 2 3] \"rgb Le\" [3 2 1] \"float "
      "Lescale\" 7\nMakeNamedMedium \"cloud\" \"string type\" \"cloud\" \"float wispiness\" 3\n"
      "MediumInterface \"rgb\"\nShape \"disk\"\nMediumInterface \"cloud\" \"cloud\"\nShape \"disk\"\n");
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
  assert_int_equal(vl_scene_settings(l.scene)->camera_medium.index, 1);
  assert_int_equal(l.scene->lights.items[0].medium.index, 1);
  assert_int_equal(s[0].inside.index, 2);
  assert_int_equal(s[0].outside.index, 1);
  assert_int_equal(s[1].inside.index, 3); /* one name stands for both sides */
  assert_int_equal(s[2].inside.index, 4);
  assert_int_equal(s[2].outside.index, 4);
  end_load(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(transforms),      cmocka_unit_test(pbrt_cameras),     cmocka_unit_test(camera_system),
      cmocka_unit_test(lecture_cameras), cmocka_unit_test(materials),        cmocka_unit_test(named_materials),
      cmocka_unit_test(textures),        cmocka_unit_test(lights),           cmocka_unit_test(plain_portal),
      cmocka_unit_test(area_lights),     cmocka_unit_test(shapes),           cmocka_unit_test(objects),
      cmocka_unit_test(attributes),      cmocka_unit_test(picture_settings), cmocka_unit_test(media),
      cmocka_unit_test(bodies),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
