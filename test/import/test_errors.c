/* test/import/test_errors.c: every kind of error in a scene file: the exact text of its line
 * and its place. */
#include "import/load.h"
#include "velo/material.h"
#include "velo/shape.h"

#define W "WorldBegin\n"

static const struct {
  const char *text;
  const char *error;
} mistakes[] = {
    /* tokens */
    {W "Shape \"sphere", "t.pbrt:2:7: unclosed string: the file ends before the closing \""},
    {W "Shape \"sphere\nShape",
     "t.pbrt:2:7: unclosed string: the line ends before the closing \""},
    {W "Shape \"sp\\here\"",
     "t.pbrt:2:7: unknown escape in a string (known: \\b \\f \\n \\r \\t \\\\ \\' \\\")"},
    {"\xff\xfeW", "t.pbrt:1:1: the file is encoded as UTF-16; only UTF-8 is understood"},
    /* grammar */
    {"", "t.pbrt:0:0: the file has no WorldBegin"},
    {"Matrial \"diffuse\"",
     "t.pbrt:1:1: unknown directive \"Matrial\" (did you mean Material?)"},
    {"worldbegin", "t.pbrt:1:1: unknown directive \"worldbegin\" (did you mean WorldBegin?)"},
    {"Qwertz", "t.pbrt:1:1: unknown directive \"Qwertz\""},
    {"12", "t.pbrt:1:1: expected a directive, found the number \"12\""},
    {"[", "t.pbrt:1:1: expected a directive, found \"[\""},
    {"\"a\"", "t.pbrt:1:1: expected a directive, found \"a\""},
    {"Translate 1 2", "t.pbrt:1:14: Translate: expected a number, found the end of the file"},
    {"Translate 1 x 3", "t.pbrt:1:13: Translate: expected a number, found \"x\""},
    {"Transform 1 2", "t.pbrt:1:11: Transform: expected [ and 16 numbers, found \"1\""},
    {"Transform [ 1 2 ]", "t.pbrt:1:17: Transform: 16 numbers needed, found 2"},
    {"Transform [ 1 2", "t.pbrt:1:11: unclosed [ of Transform: the file ends before the ]"},
    {"ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 7 ]",
     "t.pbrt:1:51: ConcatTransform: expected ] after 16 numbers, found \"7\""},
    {"Camera perspective",
     "t.pbrt:1:8: Camera: expected a type name in quotes, found \"perspective\""},
    {"ActiveTransform Now",
     "t.pbrt:1:17: ActiveTransform: expected StartTime, EndTime or All, found \"Now\""},
    {"Include 3", "t.pbrt:1:9: Include: expected a file name in quotes, found \"3\""},
    {"Option \"seed\"", "t.pbrt:1:14: Option: expected a value, found the end of the file"},
    {"CoordinateSystem",
     "t.pbrt:1:17: CoordinateSystem: expected a name in quotes, found the end of the file"},
    /* parameters */
    {W "Shape \"sphere\" \"radius\" 1",
     "t.pbrt:2:16: parameter \"radius\" is not of the form \"type name\""},
    {W "Shape \"sphere\" \"float radius big\" 1",
     "t.pbrt:2:16: parameter \"float radius…\" is not of the form \"type name\""},
    {W "Shape \"sphere\" \"flaot radius\" 1",
     "t.pbrt:2:16: unknown parameter type \"flaot\" (did you mean \"float\"?)"},
    {W "Shape \"sphere\" \"float radius\"",
     "t.pbrt:2:30: \"float radius\": expected a value, found the end of the file"},
    {W "Shape \"sphere\" \"float radius\" [ 1",
     "t.pbrt:2:31: unclosed [ in \"float radius\": the file ends before the ]"},
    {W "Shape \"sphere\" \"float radius\" [ 1 [ 2 ]", "t.pbrt:2:35: [ inside of [ ]"},
    {W "Shape \"sphere\" \"float radius\" x",
     "t.pbrt:2:31: \"float radius\": expected a number, found \"x\""},
    {W "Shape \"sphere\" \"float radius\" \"1\"",
     "t.pbrt:2:31: \"float radius\": expected a number, found the string \"1\""},
    {W "Shape \"sphere\" \"float radius\" true",
     "t.pbrt:2:31: \"float radius\": expected a number, found \"true\""},
    {W "Shape \"sphere\" \"float radius\" nan",
     "t.pbrt:2:31: \"float radius\": expected a number, found \"nan\""},
    {W "Shape \"sphere\" \"float radius\" []",
     "t.pbrt:2:16: Shape \"sphere\": parameter \"radius\" has no value"},
    {W "Shape \"sphere\" \"float radius\" [ 1 2 ]",
     "t.pbrt:2:16: Shape \"sphere\": parameter \"radius\" takes 1 value, found 2"},
    {W "Shape \"sphere\" \"integer radius\" 1",
     "t.pbrt:2:16: Shape \"sphere\": parameter \"radius\" must be of type \"float\", not "
     "\"integer\""},
    {W "Shape \"sphere\" \"float raduis\" 1",
     "t.pbrt:2:16: Shape \"sphere\": unknown parameter \"raduis\" (did you mean \"radius\"?)"},
    {W "Shape \"sphere\" \"float bananas\" 1",
     "t.pbrt:2:16: Shape \"sphere\": unknown parameter \"bananas\""},
    {W "Shape \"sphere\" \"integer n\" 1.5",
     "t.pbrt:2:28: \"integer n\": \"1.5\" is not a 32-bit integer"},
    {W "Shape \"sphere\" \"integer n\" 3000000000",
     "t.pbrt:2:28: \"integer n\": \"3000000000\" is not a 32-bit integer"},
    {W "Shape \"sphere\" \"bool b\" 1",
     "t.pbrt:2:25: \"bool b\": expected true or false, found \"1\""},
    {W "Shape \"sphere\" \"string s\" 1",
     "t.pbrt:2:27: \"string s\": expected a string in quotes, found \"1\""},
    {W "Material \"diffuse\" \"spectrum reflectance\" [ 400 \"a\" ]",
     "t.pbrt:2:49: \"spectrum reflectance\": numbers and strings do not mix"},
    {W "Material \"diffuse\" \"rgb reflectance\" [ 1 1 ]",
     "t.pbrt:2:20: \"rgb reflectance\" takes 3 values, found 2"},
    {W "Material \"diffuse\" \"rgb reflectance\" [ 1 1 2 ]",
     "t.pbrt:2:20: Material \"diffuse\": \"rgb reflectance\" is a reflectance and must not be "
     "above 1, it is 2"},
    {W "Material \"diffuse\" \"rgb reflectance\" [ 1 -1 0 ]",
     "t.pbrt:2:20: \"rgb reflectance\" has a negative value"},
    {W "Material \"diffuse\" \"float reflectance\" 0.5",
     "t.pbrt:2:20: Material \"diffuse\": parameter \"reflectance\" must be of type "
     "\"spectrum\" or \"rgb\" or \"blackbody\" or \"texture\", not \"float\""},
    {W "Material \"diffuse\" \"spectrum reflectance\" [ 400 1 500 ]",
     "t.pbrt:2:20: a spectrum holds pairs of wavelength and value; found 3 numbers"},
    {W "Material \"diffuse\" \"spectrum reflectance\" [ 400 1 300 1 ]",
     "t.pbrt:2:20: wavelengths of a spectrum must increase: 300 comes after 400"},
    {W "Material \"conductor\" \"spectrum eta\" \"metal-Au-eda\"",
     "t.pbrt:2:22: no spectrum is named \"metal-Au-eda\" (did you mean \"metal-Au-eta\"?)"},
    {W "LightSource \"point\" \"blackbody I\" 0",
     "t.pbrt:2:21: \"blackbody I\" must be above 0 kelvin"},
    /* order and nesting */
    {"Shape \"sphere\"", "t.pbrt:1:1: Shape must come after WorldBegin"},
    {W "Camera \"perspective\"", "t.pbrt:2:1: Camera must come before WorldBegin"},
    {W W, "t.pbrt:2:1: WorldBegin a second time"},
    {W "AttributeEnd", "t.pbrt:2:1: AttributeEnd without its beginning"},
    {W "AttributeBegin", "t.pbrt:2:1: AttributeBegin is never closed"},
    {W "ObjectBegin \"a\"\nAttributeEnd",
     "t.pbrt:3:1: AttributeEnd: the ObjectBegin of line 2 must be closed first"},
    {W "AttributeBegin\nObjectEnd",
     "t.pbrt:3:1: ObjectEnd: the AttributeBegin of line 2 must be closed first"},
    {W "ObjectBegin \"a\"\nObjectBegin \"b\"",
     "t.pbrt:3:1: ObjectBegin inside of an object: objects do not nest"},
    {W "ObjectBegin \"a\"\nObjectInstance \"a\"",
     "t.pbrt:3:1: ObjectInstance inside of an object: objects do not nest"},
    {W "ObjectBegin \"a\" ObjectEnd\nObjectBegin \"a\" ObjectEnd",
     "t.pbrt:3:1: object \"a\" is defined a second time"},
    {W "ObjectInstance \"a\"", "t.pbrt:2:1: there is no object \"a\""},
    {W "CoordSysTransform \"camra\"", "t.pbrt:2:1: there is no coordinate system \"camra\""},
    {"Camera \"perspective\"\n" W "CoordSysTransform \"camra\"",
     "t.pbrt:3:1: there is no coordinate system \"camra\" (did you mean \"camera\"?)"},
    {W "Attribute \"shapes\"",
     "t.pbrt:2:1: Attribute: unknown target \"shapes\" (known: shape, light, material, medium, "
     "texture)"},
    {"ColorSpace \"adobe\"",
     "t.pbrt:1:1: unknown colour space \"adobe\" (known: srgb, dci-p3, rec2020, aces2065-1)"},
    /* transforms */
    {"LookAt 1 2 3 1 2 3 0 1 0",
     "t.pbrt:1:1: LookAt: the eye and the point it looks at are the same"},
    {"LookAt 1 2 3 1 5 3 0 1 0",
     "t.pbrt:1:1: LookAt: the up vector is parallel to the view direction"},
    {"LookAt 1 2 3 1 5 3 0 0 0", "t.pbrt:1:1: LookAt: the up vector is zero"},
    {"Rotate 10 0 0 0", "t.pbrt:1:1: Rotate: the axis is zero"},
    {"Scale 0 1 1\nCamera \"perspective\"",
     "t.pbrt:2:1: Camera: the current transform is singular"},
    {W "Scale 0 1 1\nShape \"sphere\"",
     "t.pbrt:3:1: transform of the shape is singular: it flattens the shape"},
    {W "ActiveTransform EndTime\nScale 1 1 -1\nShape \"sphere\"",
     "t.pbrt:4:1: no motion leads from the transform at the start to that at the end: one is "
     "singular, not affine, or "
     "mirrors alone"},
    {"TransformTimes 1 1",
     "t.pbrt:1:1: TransformTimes: the end (1) must be after the start (1)"},
    {"Camera \"pinhole\" \"float shutterpoints\" [0 1 1]\n" W,
     "t.pbrt:1:18: Camera \"pinhole\": \"shutterpoints\" are 2 to 16 pairs (share of the "
     "time, how far open), instead of \"shuttercurve\""},
    {"Camera \"pinhole\" \"float shutterrise\" 0.7\n" W,
     "t.pbrt:1:1: Camera \"pinhole\": \"shutterrise\" is the share, above 0 and at most "
     "0.5, in which a trapezoid rises and falls"},
    {"Camera \"pinhole\" \"float readout\" -1\n" W,
     "t.pbrt:1:18: Camera \"pinhole\": parameter \"readout\" must be a number of at least "
     "0; it is -1"},
    /* names of kinds */
    {W "Material \"difuse\"",
     "t.pbrt:2:1: unknown material \"difuse\" (did you mean \"diffuse\"?)"},
    {W "MakeNamedMaterial \"a\" \"string type\" \"subsurfase\"",
     "t.pbrt:2:23: unknown material \"subsurfase\" (did you mean \"subsurface\"?)"},
    {W "Material \"subsurface\" \"string name\" \"skin1\"",
     "t.pbrt:2:23: Material \"subsurface\": no preset is named \"skin1\" (did you mean "
     "\"Skin1\"?)"},
    {W "Material \"subsurface\" \"string name\" \"Skin1\" \"rgb sigma_a\" [1 1 1] "
       "\"rgb sigma_s\" [1 1 1]",
     "t.pbrt:2:1: Material \"subsurface\": give only one of \"name\", \"sigma_a\" and "
     "\"sigma_s\", \"reflectance\" (and \"mfp\"): each says all"},
    {W "Material \"subsurface\" \"rgb sigma_a\" [1 1 1]",
     "t.pbrt:2:1: Material \"subsurface\": \"sigma_s\" is missing beside \"sigma_a\""},
    {W "Material \"subsurface\" \"rgb sigma_s\" [1 1 1]",
     "t.pbrt:2:1: Material \"subsurface\": \"sigma_a\" is missing beside \"sigma_s\""},
    {W "Material \"subsurface\" \"rgb mfp\" [1 1 1]",
     "t.pbrt:2:1: Material \"subsurface\": \"reflectance\" is missing beside \"mfp\""},
    {W "Material \"subsurface\" \"float mfp\" 1",
     "t.pbrt:2:23: Material \"subsurface\": parameter \"mfp\" must be of type \"spectrum\" "
     "or \"rgb\" or \"blackbody\" or \"texture\", not \"float\""},
    {W "Material \"subsurface\" \"float eta\" 4",
     "t.pbrt:2:23: Material \"subsurface\": parameter \"eta\" must be a number from 0.5 to "
     "2.5; it is 4"},
    {W "Material \"subsurface\" \"float g\" 1",
     "t.pbrt:2:23: Material \"subsurface\": parameter \"g\" must be a number above -1 and "
     "below 1; it is 1"},
    {W "Material \"measured\"",
     "t.pbrt:2:1: Material \"measured\": \"string filename\" is missing"},
    {W "MakeNamedMaterial \"a\"",
     "t.pbrt:2:1: MakeNamedMaterial \"a\": \"string type\" is missing"},
    {W "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n"
       "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"",
     "t.pbrt:3:1: material \"a\" is made a second time (first in line 2)"},
    {W "NamedMaterial \"wals\" Shape \"sphere\" MakeNamedMaterial \"walls\" "
       "\"string type\" \"diffuse\"",
     "t.pbrt:2:1: there is no material \"wals\" (did you mean \"walls\"?)"},
    {W "Shape \"curve\" \"point3 P\" [0 0 0]",
     "t.pbrt:2:15: Shape \"curve\": 1 points, but Bezier curves of degree 3 need 4, or that "
     "and a multiple of the degree"},
    {W "Shape \"curve\"", "t.pbrt:2:1: Shape \"curve\": \"point3 P\" is missing"},
    {W "Shape \"curve\" \"integer degree\" 4",
     "t.pbrt:2:1: Shape \"curve\": the degree must be 2 or 3, not 4"},
    {W "Shape \"curve\" \"string type\" \"ribon\"",
     "t.pbrt:2:15: Shape \"curve\": \"type\" cannot be \"ribon\" (did you mean \"ribbon\"?)"},
    {W "Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]",
     "t.pbrt:2:1: Shape \"curve\": ribbons need \"normal N\""},
    {W "Shape \"curve\" \"string basis\" \"bspline\" \"point3 P\" [0 0 0 1 0 0 2 0 0]",
     "t.pbrt:2:40: Shape \"curve\": 3 points, but a B-spline of degree 3 needs at least 4"},
    {W "Shape \"curve\" \"float width0\" -1 \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]",
     "t.pbrt:2:1: Shape \"curve\": a width must not be negative"},
    {W "Shape \"spere\"", "t.pbrt:2:1: unknown shape \"spere\" (did you mean \"sphere\"?)"},
    {W "Texture \"a\" \"spectrum\" \"ptex\"",
     "t.pbrt:2:1: texture \"ptex\": Ptex files are not supported (to convert: bake it into an "
     "image over uv, and name "
     "that by \"imagemap\")"},
    {W "Texture \"a\" \"colour\" \"constant\"",
     "t.pbrt:2:1: Texture \"a\": the type must be \"float\" or \"spectrum\", not \"colour\""},
    {W "Texture \"a\" \"float\" \"constant\"\nTexture \"a\" \"float\" \"constant\"",
     "t.pbrt:3:1: float texture \"a\" is made a second time (first in line 2)"},
    {W "LightSource \"goniometric\"",
     "t.pbrt:2:1: LightSource \"goniometric\": \"string filename\" is missing"},
    {W "LightSource \"infinit\"",
     "t.pbrt:2:1: unknown light \"infinit\" (did you mean \"infinite\"?)"},
    {W "AreaLightSource \"area\"", "t.pbrt:2:1: unknown area light \"area\""},
    {"Camera \"realistic\"\n" W,
     "t.pbrt:1:1: Camera \"realistic\": \"string lensfile\" is missing"},
    {"Film \"spectral\" \"float lambdamin\" 300\n" W,
     "t.pbrt:1:17: Film \"spectral\": parameter \"lambdamin\" must be a number from 360 to "
     "830; it is 300"},
    {"Film \"spectral\" \"float lambdamin\" 700 \"float lambdamax\" 600\n" W,
     "t.pbrt:1:1: Film \"spectral\": \"lambdamin\" is 700, it must be below \"lambdamax\", "
     "600"},
    {"Film \"spectral\" \"integer nbuckets\" 2000\n" W,
     "t.pbrt:1:17: Film \"spectral\": parameter \"nbuckets\" must be a whole number from 1 to "
     "1000; it is 2000"},
    {"Film \"gbuffer\" \"string coordinatesystem\" \"word\"\n" W,
     "t.pbrt:1:16: Film \"gbuffer\": \"coordinatesystem\" cannot be \"word\" (did you mean "
     "\"world\"?)"},
    {"Sampler \"halto\"\n" W,
     "t.pbrt:1:1: unknown sampler \"halto\" (did you mean \"halton\"?)"},
    {"Integrator \"function\"\n" W,
     "t.pbrt:1:1: integrator \"function\" is not understood yet"},
    {"PixelFilter \"gauss\"\n" W, "t.pbrt:1:1: unknown pixel filter \"gauss\""},
    {"Accelerator \"grid\"\n" W, "t.pbrt:1:1: unknown accelerator \"grid\""},
    {"Option \"forcediffuse\" true",
     "t.pbrt:1:1: Option \"forcediffuse\": velo cannot; its materials stay what they are"},
    {"Option \"disablepixeljitter\" 1",
     "t.pbrt:1:1: Option \"disablepixeljitter\": expected true or false, found \"1\""},
    {"Option \"disablepixeljitter\" maybe",
     "t.pbrt:1:1: Option \"disablepixeljitter\": expected true or false, found \"maybe\""},
    {"Option \"seed\" x", "t.pbrt:1:1: Option \"seed\": \"x\" is not an integer"},
    {"Option \"sede\" 1", "t.pbrt:1:1: unknown option \"sede\" (did you mean \"seed\"?)"},
    /* references */
    {W "Texture \"a\" \"spectrum\" \"scale\" \"texture tex\" \"b\"\n"
       "Texture \"b\" \"spectrum\" \"scale\" \"texture tex\" \"a\"",
     "t.pbrt:3:32: texture \"a\" refers to itself"},
    {W
     "Texture \"a\" \"float\" \"constant\"\nMaterial \"diffuse\" \"texture reflectance\" \"a\"",
     "t.pbrt:3:20: texture \"a\" is a float texture; a spectrum texture is needed here"},
    {W "Texture \"wood\" \"spectrum\" \"constant\"\n"
       "Material \"diffuse\" \"texture reflectance\" \"wod\"",
     "t.pbrt:3:20: there is no spectrum texture \"wod\" (did you mean \"wood\"?)"},
    {W "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"]",
     "t.pbrt:2:43: material \"a\" is mixed of itself"},
    {W "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" \"a\"",
     "t.pbrt:2:43: MakeNamedMaterial \"a\": parameter \"materials\" takes 2 values, found 1"},
    {W "Material \"mix\"",
     "t.pbrt:2:1: Material \"mix\": \"string materials\" (two names) is missing"},
    {W "Material \"conductor\" \"rgb reflectance\" [1 1 1] \"rgb k\" [1 1 1]",
     "t.pbrt:2:1: Material \"conductor\": give either \"reflectance\" or \"eta\" and \"k\", "
     "not both"},
    {W "Material \"dielectric\" \"texture eta\" \"a\"",
     "t.pbrt:2:23: Material \"dielectric\": parameter \"eta\" must be of type \"float\" or "
     "\"spectrum\" or \"rgb\" or "
     "\"blackbody\", not \"texture\""},
    {W "Texture \"a\" \"spectrum\" \"checkerboard\" \"integer dimension\" 4",
     "t.pbrt:2:39: Texture \"a\" (checkerboard): parameter \"dimension\" must be a whole "
     "number from 2 to 3; it is 4"},
    {W "Texture \"a\" \"spectrum\" \"imagemap\"",
     "t.pbrt:2:1: Texture \"a\" (imagemap): \"string filename\" is missing"},
    {W "Texture \"a\" \"spectrum\" \"imagemap\" \"string filname\" \"x.png\"",
     "t.pbrt:2:35: Texture \"a\" (imagemap): unknown parameter \"filname\" (did you mean "
     "\"filename\"?)"},
    {W "Texture \"a\" \"spectrum\" \"imagemap\" \"string wrap\" \"repaet\"",
     "t.pbrt:2:35: Texture \"a\" (imagemap): \"wrap\" cannot be \"repaet\" (did you mean "
     "\"repeat\"?)"},
    /* shapes */
    {W "Shape \"sphere\" \"float radius\" -1",
     "t.pbrt:2:16: Shape \"sphere\": parameter \"radius\" must be a number above 0; it is -1"},
    {W "Shape \"trianglemesh\"", "t.pbrt:2:1: Shape \"trianglemesh\": \"point3 P\" is missing"},
    {W "Shape \"trianglemesh\" \"point3 p\" [0 0 0]",
     "t.pbrt:2:22: Shape \"trianglemesh\": unknown parameter \"p\" (did you mean \"P\"?)"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1]",
     "t.pbrt:2:22: Shape \"trianglemesh\": \"P\" holds 8 numbers, not a multiple of 3"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]",
     "t.pbrt:2:1: Shape \"trianglemesh\": \"integer indices\" is missing"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1]",
     "t.pbrt:2:53: Shape \"trianglemesh\": \"indices\" holds 2 numbers, not a multiple of 3"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]",
     "t.pbrt:2:53: Shape \"trianglemesh\": \"indices\": number 2 names vertex 3, but there "
     "are 3 vertices (0 to 2)"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 -1]",
     "t.pbrt:2:53: Shape \"trianglemesh\": \"indices\": number 2 names vertex -1, but there "
     "are 3 vertices (0 to 2)"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"point2 uv\" [0 0]",
     "t.pbrt:2:53: Shape \"trianglemesh\": \"uv\" holds 2 numbers, but 3 vertices need 6"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1e39 0]",
     "t.pbrt:2:1: position of vertex 2 is not finite (y is inf)"},
    {W "Shape \"plymesh\"", "t.pbrt:2:1: Shape \"plymesh\": \"string filename\" is missing"},
    {W "Shape \"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] "
       "\"integer indices\" [0 1 2 0 1 3]",
     "t.pbrt:2:1: Shape \"loopsubdiv\": faces 0 and 1 run along their common edge (vertices "
     "0, 1) in the same direction"},
    {W "Shape \"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer levels\" 30",
     "t.pbrt:2:1: Shape \"loopsubdiv\": 30 levels of 1 faces are too many"},
    /* lights */
    {W "LightSource \"distant\" \"point3 from\" [0 0 1]",
     "t.pbrt:2:1: light: from and to are the same point: it has no direction"},
    {W "LightSource \"infinite\" \"rgb L\" [1 1 1] \"string filename\" \"a.exr\"",
     "t.pbrt:2:40: LightSource \"infinite\": give either \"L\" or \"filename\", not both"},
    {W "LightSource \"infinite\" \"point3 portal\" [0 0 0]",
     "t.pbrt:2:24: LightSource \"infinite\": \"portal\" takes 4 points, found 3 numbers"},
    {W "LightSource \"spot\" \"float coneangle\" 200",
     "t.pbrt:2:20: LightSource \"spot\": parameter \"coneangle\" must be a number above 0 "
     "and at most 180 degrees; it is 200 degrees"},
    /* image */
    {"Film \"rgb\" \"integer xresolution\" 0\n" W,
     "t.pbrt:1:12: Film \"rgb\": parameter \"xresolution\" must be a whole number from 1 to "
     "65536; it is 0"},
    {"Film \"rgb\" \"integer xresolution\" 2000000\n" W,
     "t.pbrt:1:12: Film \"rgb\": parameter \"xresolution\" must be a whole number from 1 to "
     "65536; it is 2000000"},
    {"Film \"rgb\" \"float cropwindow\" [0.5 0.5 0 1]\n" W,
     "t.pbrt:1:1: Film \"rgb\": the crop window holds no pixel"},
    {"Film \"rgb\" \"string sensor\" \"canon_eos_5e\"\n" W,
     "t.pbrt:1:12: unknown sensor \"canon_eos_5e\" (did you mean \"canon_eos_5d\"?)"},
    {"Film \"rgb\" \"string sensor\" \"cie1913\"\n" W,
     "t.pbrt:1:12: unknown sensor \"cie1913\" (did you mean \"cie1931\"?)"},
    {"Film \"rgb\" \"float whitebalance\" 50\n" W,
     "t.pbrt:1:12: Film \"rgb\": \"whitebalance\" is 50; it must be 0 (none) or 1000 to 100000 "
     "kelvin"},
    {"Camera \"perspective\" \"float fov\" 200\n" W,
     "t.pbrt:1:1: Camera \"perspective\": fov is 3.49066 radians (200 degrees); a flat view "
     "plane needs less than 180 degrees"},
    {"Camera \"perspective\" \"float shutterclose\" 0\n" W,
     "t.pbrt:1:1: Camera \"perspective\": the shutter does not open: it closes at 0, opens at "
     "0"},
    {"Camera \"pinhole\" \"point3 eye\" [1 2 3] \"point3 lookat\" [1 2 3]\n" W,
     "t.pbrt:1:1: Camera \"pinhole\": eye and lookat are the same point (1 2 3); there is no "
     "direction to look in"},
    {"LookAt 1 0 0 0 0 1 0 1 0 Camera \"pinhole\"\n" W,
     "t.pbrt:1:26: Camera \"pinhole\": its pose is given by eye, lookat and up; transforms "
     "before it have no meaning"},
    {"Sampler \"zsobol\" \"integer pixelsamples\" 0\n" W,
     "t.pbrt:1:18: Sampler \"zsobol\": parameter \"pixelsamples\" must be a whole number "
     "from 1 to 4294967295; it is 0"},
    {"Sampler \"halton\" \"string randomization\" \"some\"\n" W,
     "t.pbrt:1:18: Sampler \"halton\": \"randomization\" cannot be \"some\" (known: none, "
     "permutedigits, fastowen, "
     "owen)"},
    {"PixelFilter \"box\" \"float xradius\" 0\n" W,
     "t.pbrt:1:19: PixelFilter \"box\": parameter \"xradius\" must be a number above 0 and "
     "at most 32; it is 0"},
    {"PixelFilter \"box\" \"float sigma\" 1\n" W,
     "t.pbrt:1:19: PixelFilter \"box\": unknown parameter \"sigma\""},
    {"Integrator \"path\" \"bool regularise\" true\n" W,
     "t.pbrt:1:19: Integrator \"path\": unknown parameter \"regularise\" (did you mean "
     "\"regularize\"?)"},
    /* media */
    {"MakeNamedMedium \"fog\"",
     "t.pbrt:1:1: MakeNamedMedium \"fog\": \"string type\" is missing"},
    {"MakeNamedMedium \"m\" \"string type\" \"homogenous\"",
     "t.pbrt:1:1: unknown medium type \"homogenous\" (did you mean \"homogeneous\"?)"},
    {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"string preset\" \"Whole milk\"",
     "t.pbrt:1:49: MakeNamedMedium \"m\": no preset is named \"Whole milk\" (did you mean "
     "\"Wholemilk\"?)"},
    {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float sigma_a\" 1",
     "t.pbrt:1:49: MakeNamedMedium \"m\": parameter \"sigma_a\" must be of type "
     "\"spectrum\" or \"rgb\" or \"blackbody\", not \"float\""},
    {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 -1 1]",
     "t.pbrt:1:49: \"rgb sigma_s\" has a negative value"},
    {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float g\" 2",
     "t.pbrt:1:49: MakeNamedMedium \"m\": parameter \"g\" must be a number from -1 to 1; it is "
     "2"},
    {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float scale\" -2",
     "t.pbrt:1:49: MakeNamedMedium \"m\": parameter \"scale\" must be a number of at least "
     "0; it is -2"},
    {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float density\" 2",
     "t.pbrt:1:49: MakeNamedMedium \"m\": unknown parameter \"density\""},
    {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 2 "
     "\"float density\" [1 2 3]",
     "t.pbrt:1:64: MakeNamedMedium \"m\": \"density\" holds 3 numbers, but nx * ny * nz = 2 "
     "* 1 * 1 cells need 2"},
    {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 2 "
     "\"float density\" [1 -2]",
     "t.pbrt:1:1: medium \"m\": density: value 1 is negative (-2)"},
    {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\"",
     "t.pbrt:1:1: MakeNamedMedium \"m\": \"float density\" is missing"},
    {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"float density\" 1 "
     "\"float temperature\" 1 \"rgb Le\" [1 1 1]",
     "t.pbrt:1:1: MakeNamedMedium \"m\": give either \"Le\" or \"temperature\", not both"},
    {"MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"rgb Le\" [1 1 1]",
     "t.pbrt:1:1: MakeNamedMedium \"m\": \"rgb sigma_a\" or \"rgb sigma_s\" (a colour for each "
     "cell) is missing"},
    {"MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"rgb sigma_s\" [1 1 1] "
     "\"rgb Le\" [1 1 1]",
     "t.pbrt:1:1: medium \"m\": a grid that emits needs sigma_a on the grid, too"},
    {"MakeNamedMedium \"m\" \"string type\" \"cloud\" \"point3 p1\" [0 1 1]",
     "t.pbrt:1:1: medium \"m\": its box has no room: p0 must be below p1 in x, y and z"},
    {"MakeNamedMedium \"m\" \"string type\" \"nanovdb\"",
     "t.pbrt:1:1: MakeNamedMedium \"m\": \"string filename\" is missing"},
    {"MakeNamedMedium \"fog\" \"string type\" \"cloud\"\n" W
     "MediumInterface \"fug\"\nShape \"sphere\"",
     "t.pbrt:4:1: there is no medium \"fug\" (did you mean \"fog\"?)"},
    {W "MediumInterface \"fog\"\nShape \"sphere\"", "t.pbrt:3:1: there is no medium \"fog\""},
};

static void each(void **state) {
  (void)state;
  size_t wrong = 0;
  for (size_t i = 0; i < sizeof mistakes / sizeof *mistakes; i++)
    wrong += !gives_error(mistakes[i].text, VL_ERROR_SCENE, mistakes[i].error);
  assert_int_equal(wrong, 0);
}

static void missing_files(void **state) {
  (void)state;
  assert_error(W "Include \"no/such.pbrt\"", VL_ERROR_MISSING,
               "t.pbrt:2:9: no such file: no/such.pbrt");
  assert_error(W "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"no/such.png\"",
               VL_ERROR_MISSING, "t.pbrt:2:32: no such file: no/such.png");
  assert_error(W "Shape \"plymesh\" \"string filename\" \"no/such.ply\"", VL_ERROR_MISSING,
               "t.pbrt:2:17: no such file: no/such.ply");
  assert_error(W "LightSource \"infinite\" \"string filename\" \"no/such.exr\"",
               VL_ERROR_MISSING, "t.pbrt:2:24: no such file: no/such.exr");
  assert_error(W "Material \"conductor\" \"spectrum k\" \"no/such.spd\"", VL_ERROR_MISSING,
               "t.pbrt:2:22: no such file: no/such.spd");
  assert_error(W "Material \"diffuse\" \"string normalmap\" \"no/such.png\"", VL_ERROR_MISSING,
               "t.pbrt:2:20: no such file: no/such.png");
  assert_error(W "AreaLightSource \"diffuse\" \"string filename\" \"no/such.png\"",
               VL_ERROR_MISSING, "t.pbrt:2:27: no such file: no/such.png");
}

/* What is not understood is a warning when permissive; mistakes stay errors. */
static void permissive(void **state) {
  (void)state;
  Loaded l;
  vlSceneInfo info;
  load_text(&l,
            "Film \"rgb\"\n"
            "Camera \"future\" \"string lensfile\" \"wide.dat\"\n"
            "Integrator \"function\" \"integer maxdepth\" 9\n"
            "Option \"forcediffuse\" true\n"
            "Sampler \"future\" \"integer n\" 1\n" W
            "Material \"velvet\" \"rgb mfp\" [1 1 1]\n"
            "Shape \"sphere\"\n"
            "Shape \"heightfield\"\n"
            "LightSource \"projector\"\n"
            "Texture \"t\" \"spectrum\" \"ptex\"\n"
            "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
            "MakeNamedMedium \"m\" \"string type\" \"smoke\"\n"
            "MediumInterface \"m\"\n"
            "ActiveTransform EndTime Translate 1 1 1\n"
            "Shape \"disk\"\n",
            true);
  assert_int_equal(l.result, VL_OK);
  vl_scene_info(l.scene, &info);
  assert_int_equal(info.shapes, 2);
  assert_int_equal(info.materials, 2);
  assert_int_equal(info.lights, 0);
  assert_int_equal(vl_scene_defs(l.scene)->render.max_depth, 9);
  assert_int_equal(l.scene->materials.items[l.scene->shapes.items[0].material.index - 1].kind,
                   VL_MATERIAL_DIFFUSE);
  const char *said[] = {"warning t.pbrt:2:1: unknown camera",
                        "warning t.pbrt:3:1: integrator",
                        "warning t.pbrt:4:1: Option",
                        "warning t.pbrt:5:1: unknown sampler",
                        "warning t.pbrt:7:1: unknown material \"velvet\"",
                        "warning t.pbrt:9:1: unknown shape \"heigh",
                        "warning t.pbrt:10:1: unknown light \"projector",
                        "warning t.pbrt:11:1: texture \"ptex\"",
                        "warning t.pbrt:13:1: unknown medium type"};
  for (size_t i = 0; i < sizeof said / sizeof *said; i++) {
    if (!strstr(l.log, said[i]))
      print_message("not said: %s\nbut:\n%s", said[i], l.log);
    assert_non_null(strstr(l.log, said[i]));
  }
  end_load(&l);
  load_text(&l, W "Shape \"sphere\" \"float raduis\" 1", true);
  assert_int_equal(l.result, VL_ERROR_SCENE);
  end_load(&l);
  load_text(&l, W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1e39 0]", true);
  assert_int_equal(l.result, VL_ERROR_SCENE);
  end_load(&l);
}

/* A failed scene stays failed. */
static void sticky(void **state) {
  (void)state;
  Loaded l;
  load_text(&l, W "Shape \"spere\"", false);
  vlError again;
  assert_int_equal(vl_import_pbrt_memory(l.scene, W, strlen(W), "u.pbrt", NULL, &again),
                   VL_ERROR_SCENE);
  assert_string_equal(again.file, "t.pbrt");
  end_load(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(each), cmocka_unit_test(missing_files),
                                     cmocka_unit_test(permissive), cmocka_unit_test(sticky)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
