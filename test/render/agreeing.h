/* test/render/agreeing.h: the rows of test_tracers_agree.c. */
/* clang-format off */
/* ---- what light paths lack */
{.name = "flat curves", .lacking = "shape \"curve\"",
 .world = ROOM "Shape \"curve\" \"string type\" \"flat\" \"point3 P\" [-.8 .3 .4 -.2 0 .5 .3 .5 .3 .8 .3 .4] \"float width\" .1"},
{.name = "hair on a ball", .lacking = "material \"hair\"", .world = ROOM "Material \"hair\" \"rgb sigma_a\" [3 1 .3] " BALL},
{.name = "mix with hair", .lacking = "material \"hair\"",
 .world = ROOM "MakeNamedMaterial \"h\" \"string type\" \"hair\" MakeNamedMaterial \"d\" \"string type\" \"diffuse\" "
               "Material \"mix\" \"string materials\" [\"d\" \"h\"] " BALL},
{.name = "regularization", .lacking = "regularization", .head = "Integrator \"volpath\" \"bool regularize\" true " CAMERA,
 .world = ROOM "Material \"conductor\" \"float roughness\" .1 " BALL},
{.name = "subsurface", .lacking = "material \"subsurface\"", .world = ROOM "Material \"subsurface\" " BALL},

/* ---- materials */
{.name = "room", .world = ROOM},
{.name = "diffuse transmission", .world = ROOM "Material \"diffusetransmission\" \"rgb reflectance\" [.2 .3 .4] \"rgb transmittance\" [.5 .4 .2] " BALL},
{.name = "mix", .world = ROOM "MakeNamedMaterial \"a\" \"string type\" \"conductor\" \"float roughness\" .4 MakeNamedMaterial \"b\" \"string type\" \"diffuse\" "
               "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .4 " BALL},
{.name = "mix with interface", .world = ROOM "MakeNamedMaterial \"a\" \"string type\" \"interface\" MakeNamedMaterial \"b\" \"string type\" \"diffuse\" "
               "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .4 " BALL},
{.name = "alpha", .world = ROOM "Material \"diffuse\" AttributeBegin Translate 0 .3 .45 Shape \"sphere\" \"float radius\" .4 \"float alpha\" .5 AttributeEnd "},
{.name = "alpha texture", .world = ROOM "Texture \"c\" \"float\" \"checkerboard\" \"float tex1\" 1 \"float tex2\" .2 \"float uscale\" 7 \"float vscale\" 5 "
               "Material \"diffuse\" AttributeBegin Translate 0 .3 .45 Shape \"sphere\" \"float radius\" .4 \"texture alpha\" \"c\" AttributeEnd "},
{.name = "bump", .world = WALLS PANEL "Texture \"n\" \"float\" \"wrinkled\" \"integer octaves\" 2 Texture \"s\" \"float\" \"scale\" \"texture tex\" \"n\" \"float scale\" .15 "
               "Material \"diffuse\" \"texture displacement\" \"s\" " BALL},
{.name = "shading normals", .world = ROOM "Material \"diffuse\" "
  "Shape \"trianglemesh\" \"point3 P\" [-.5 .3 .3 .5 .3 .3 .5 .3 1.1 -.5 .3 1.1] \"normal N\" [-.7 -.7 0 .7 -.7 0 .5 -.7 .5 -.5 -.7 .5] \"integer indices\" [0 1 2 0 2 3]"},
{.name = "shading normals, metal", .world = ROOM "Material \"conductor\" \"float roughness\" .5 "
  "Shape \"trianglemesh\" \"point3 P\" [-.5 .3 .3 .5 .3 .3 .5 .3 1.1 -.5 .3 1.1] \"normal N\" [-.7 -.7 0 .7 -.7 0 .5 -.7 .5 -.5 -.7 .5] \"integer indices\" [0 1 2 0 2 3]"},
{.name = "rough coat", .world = ROOM "Material \"coateddiffuse\" \"float roughness\" .4 \"rgb reflectance\" [.6 .3 .1] " BALL},
{.name = "layered coat", .world = ROOM "Material \"coateddiffuse\" \"float roughness\" .4 \"rgb reflectance\" [.6 .3 .1] \"rgb albedo\" [.5 .5 .5] \"float thickness\" .5 \"integer nsamples\" 4 " BALL},
{.name = "coated metal", .world = ROOM "Material \"coatedconductor\" \"float interface.roughness\" .3 \"float conductor.roughness\" .4 " BALL},
{.name = "anisotropic metal", .world = ROOM "Material \"conductor\" \"float uroughness\" .2 \"float vroughness\" .6 " BALL},
{.name = "frosted glass", .world = ROOM "Material \"dielectric\" \"float roughness\" .5 " BALL},
{.name = "thin dielectric", .weak = true, .smooth = true, .world = ROOM "Material \"thindielectric\" Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1.3 -1 1 1.3 1 -1 1.3 1 1 1.3] Material \"diffuse\" " BALL},
{.name = "nested dielectrics", .world = ROOM "Material \"dielectric\" \"float roughness\" .4 " BALL
  "Material \"dielectric\" \"float eta\" 1.2 \"float roughness\" .4 AttributeBegin Translate 0 .3 .45 Shape \"sphere\" \"float radius\" .2 AttributeEnd "},
{.name = "glass under the light", .smooth = true, .world = ROOM "Material \"dielectric\" AttributeBegin Translate 0 .3 1.4 Shape \"sphere\" \"float radius\" .15 AttributeEnd "},
{.name = "dispersion", .world = ROOM "Material \"dielectric\" \"spectrum eta\" \"glass-SF11\" \"float roughness\" .4 " BALL},
{.name = "principled", .world = ROOM "Material \"principled\" \"rgb basecolor\" [.7 .4 .2] \"float metallic\" .4 \"float roughness\" .5 " BALL},
{.name = "checkerboard", .world = WALLS PANEL "Texture \"k\" \"spectrum\" \"checkerboard\" \"float uscale\" 9 \"float vscale\" 9 \"rgb tex1\" [.8 .2 .1] \"rgb tex2\" [.1 .3 .8] "
               "Material \"diffuse\" \"texture reflectance\" \"k\" " BALL},

/* ---- lights */
{.name = "point", .world = WALLS "LightSource \"point\" \"point3 from\" [.3 .2 1.5] \"rgb I\" [1 2 3]"},
{.name = "spot", .world = WALLS "LightSource \"spot\" \"point3 from\" [.3 .2 1.8] \"point3 to\" [0 .4 0] \"float coneangle\" 50 \"float conedeltaangle\" 20 \"rgb I\" [3 2 1]"},
{.name = "distant", .weak = true, .world = GREY FLOOR "Material \"diffuse\" " BALL "LightSource \"distant\" \"point3 from\" [1 -1 2] \"point3 to\" [0 0 0] \"rgb L\" [1 2 1]"},
{.name = "sky", .world = GREY FLOOR "Material \"diffuse\" " BALL "LightSource \"infinite\" \"rgb L\" [1 .8 .5]"},
{.name = "two-sided light", .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [3 4 5] \"bool twosided\" true "
   "Shape \"bilinearmesh\" \"point3 P\" [-.4 0 1.5 -.4 .6 1.4 .4 0 1.5 .4 .6 1.6]"},
{.name = "light with alpha", .weak = true, .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] "
   "Shape \"bilinearmesh\" \"point3 P\" [-.4 0 1.8 -.4 .6 1.8 .4 0 1.8 .4 .6 1.8] \"float alpha\" .5"},
{.name = "light with scale", .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] \"float scale\" .7 "
   "AttributeBegin Translate .2 .3 1.5 Scale .4 .2 .3 Shape \"sphere\" AttributeEnd "},
{.name = "sphere light", .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] AttributeBegin Translate .2 .3 1.5 Shape \"sphere\" \"float radius\" .2 AttributeEnd "},
{.name = "disk light", .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] AttributeBegin Translate .2 .3 1.5 Rotate 170 1 0 0 Shape \"disk\" \"float radius\" .3 AttributeEnd "},
{.name = "cylinder light", .weak = true, .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] AttributeBegin Translate .2 .3 1.3 Shape \"cylinder\" \"float radius\" .1 \"float zmin\" 0 \"float zmax\" .4 AttributeEnd "},
{.name = "mirrored lights", .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] AttributeBegin Translate .2 .3 1.5 Scale 1 1 -1 Shape \"disk\" \"float radius\" .3 AttributeEnd "},
{.name = "invisible light", .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] AttributeBegin Translate .2 .3 1.5 Shape \"sphere\" \"float radius\" .2 \"float alpha\" 0 AttributeEnd "},
{.name = "light with a spread", .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [3 4 5] \"float spread\" 100 AttributeBegin Translate .2 .3 1.5 Rotate 200 1 0 0 Shape \"disk\" \"float radius\" .3 AttributeEnd "},
{.name = "light that light passes", .passes = true, .world = ROOM "Material \"interface\" "
   "AttributeBegin Translate .2 .5 .5 Rotate 200 1 0 0 Shape \"disk\" \"float radius\" .5 AttributeEnd "},
{.name = "light of the inside of a sphere that light passes", .passes = true, .world = ROOM "Material \"interface\" ReverseOrientation " BALL},
{.name = "light through a hole", .weak = true, .world = WALLS PANEL "Material \"diffuse\" Shape \"disk\" \"float height\" 1.2 \"float radius\" .9 \"float innerradius\" .3"},
{.name = "light on glass", .world = WALLS "AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] Material \"dielectric\" \"float roughness\" .4 " BALL},

/* ---- cameras */
{.name = "lens", .head = "LookAt 0 -.9 1 0 1 .8 0 0 1 Camera \"perspective\" \"float fov\" 80 \"float lensradius\" .1 \"float focaldistance\" 1", .world = ROOM "Material \"diffuse\" " BALL},
{.name = "orthographic", .unseen = true, .head = "LookAt 0 -.9 1 0 1 .8 0 0 1 Camera \"orthographic\"", .world = ROOM "Material \"diffuse\" " BALL},
{.name = "spherical", .weak = true, .unseen = true, .head = "LookAt 0 -.9 1 0 1 .8 0 0 1 Camera \"spherical\"", .world = ROOM "Material \"diffuse\" " BALL},
{.name = "screen window", .head = "LookAt 0 -.9 1 0 1 .8 0 0 1 Camera \"perspective\" \"float fov\" 80 \"float screenwindow\" [-1.3 .4 -.2 1.5]", .world = ROOM "Material \"diffuse\" " BALL},
{.name = "scaled camera", .head = "Scale -1 1 1 LookAt 0 -.9 1 0 1 .8 0 0 1 Camera \"perspective\" \"float fov\" 80 ", .world = ROOM "Material \"diffuse\" " BALL},
{.name = "crop", .head = "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24 \"integer pixelbounds\" [5 17 3 15] PixelFilter \"gaussian\" \"float xradius\" 2 " CAMERA, .world = ROOM "Material \"diffuse\" " BALL},
{.name = "filter", .weak = true, .head = "PixelFilter \"mitchell\" \"float xradius\" 2 \"float yradius\" 2 " CAMERA, .world = ROOM "Material \"diffuse\" " BALL},
{.name = "sensor", .weak = true, .head = "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12 \"float iso\" 200 \"string sensor\" \"canon_eos_100d\" " CAMERA, .world = ROOM "Material \"diffuse\" " BALL},

/* ---- instances, motion */
{.name = "instances", .world = ROOM "Material \"diffuse\" ObjectBegin \"o\" Shape \"sphere\" \"float radius\" .2 Shape \"bilinearmesh\" \"point3 P\" [-.3 0 0 -.3 0 .3 .3 0 0 .3 0 .3] ObjectEnd "
   "AttributeBegin Translate -.4 .4 .4 Scale -1 1.5 .7 ObjectInstance \"o\" AttributeEnd AttributeBegin Translate .4 .4 .4 Scale 1 1 2 ObjectInstance \"o\" AttributeEnd "},
{.name = "moving object", .world = ROOM "Material \"diffuse\" AttributeBegin ActiveTransform EndTime Translate .5 0 .3 ActiveTransform All " BALL "AttributeEnd "},
{.name = "moving camera", .head = "ActiveTransform EndTime Translate .2 0 .1 ActiveTransform All " CAMERA, .world = ROOM "Material \"diffuse\" " BALL},

/* ---- media */
#define FOG "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.05 .1 .2] \"rgb sigma_s\" [.6 .4 .2] \"float g\" .4 "
#define IN_FOG FOG "MediumInterface \"\" \"fog\" " CAMERA
{.name = "fog", .weak = true, .head = IN_FOG, .world = "MediumInterface \"fog\" \"fog\" " ROOM "Material \"diffuse\" " BALL},
{.name = "fog by one side of walls", .lacking = "media that do not fit together", .head = IN_FOG, .world = ROOM "Material \"diffuse\" " BALL},
{.name = "fog that the camera does not name", .lacking = "media that do not fit together", .head = FOG CAMERA,
   .world = ROOM "Material \"interface\" MediumInterface \"\" \"fog\" " BALL},
{.name = "light that names no fog", .lacking = "media that do not fit together", .head = IN_FOG,
   .world = WALLS "MediumInterface \"fog\" \"\" " PANEL},
{.name = "light in fog that light passes", .passes = true, .weak = true, .head = IN_FOG, .world = "MediumInterface \"fog\" \"fog\" " ROOM "Material \"interface\" "
   "AttributeBegin Translate .2 .5 .5 Rotate 200 1 0 0 Shape \"disk\" \"float radius\" .5 AttributeEnd "},
{.name = "ball of fog", .head = FOG CAMERA, .world = ROOM "Material \"interface\" MediumInterface \"fog\" \"\" " BALL},
{.name = "light from media", .unseen = true, .head = "MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.5 .4 .3] \"rgb sigma_s\" [.6 .4 .2] \"rgb Le\" [2 1 .5] " CAMERA,
   .world = ROOM "Material \"interface\" MediumInterface \"fire\" \"\" " BALL},
{.name = "glass with fog", .head = FOG CAMERA, .world = ROOM "Material \"dielectric\" \"float roughness\" .4 MediumInterface \"fog\" \"\" " BALL},
{.name = "bubble in fog", .weak = true, .head = IN_FOG, .world = "MediumInterface \"fog\" \"fog\" " ROOM "Material \"interface\" MediumInterface \"\" \"fog\" " BALL},
{.name = "grid", .head = "MakeNamedMedium \"grid\" \"string type\" \"uniformgrid\" \"rgb sigma_a\" [.5 1 2] \"rgb sigma_s\" [6 4 2] \"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 "
   "\"float density\" [0 1 .5 .2 .7 .1 .9 .3] \"point3 p0\" [-.4 -.1 .05] \"point3 p1\" [.4 .7 .85] " CAMERA,
   .world = ROOM "Material \"interface\" MediumInterface \"grid\" \"\" " BALL},
{.name = "absorbing glass", .head = "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.5 1 3] \"rgb sigma_s\" [0 0 0] " CAMERA,
   .world = ROOM "Material \"dielectric\" \"float roughness\" .3 MediumInterface \"ink\" \"\" " BALL},
    /* clang-format on */
