/* import/upgrade_statements.h: statements of pbrt-v3, for test_upgrade.c. */
#ifndef TEST_IMPORT_UPGRADE_STATEMENTS_H
#define TEST_IMPORT_UPGRADE_STATEMENTS_H

/* Statements after WorldBegin, and what becomes of them. lost: number of notes without
 * counterpart. */
static const struct {
  const char *from, *to;
  int lost;
} world[] = {
    {"Material \"matte\" \"color Kd\" [ .5 .25 1e-2 ] # kept\n",
     "Material \"diffuse\" \"rgb reflectance\" [ .5 .25 1e-2 ] # kept\n", 0},
    {"Material \"matte\" \"float sigma\" 0\n", "Material \"diffuse\"\n", 0},
    {"LightSource \"point\" \"spectrum I\" [ 400 1 # 12 34\n 500 2 700 3 ]\n",
     "LightSource \"point\" \"spectrum I\" [ 400 1 # 12 34\n 500 2 700 3 ] "
     "\"float scale\" 2.292336\n",
     0},
    {"Material \"matte\" \"float sigma\" 20\n", "Material \"diffuse\"\n", 1},
    {"Material \"plastic\"\n"
     "  \"rgb Kd\" [ .1 .2 .3 ]\n"
     "  \"bool remaproughness\" [ \"false\" ]\n",
     "Material \"coateddiffuse\"\n"
     "  \"rgb reflectance\" [ .1 .2 .3 ]\n"
     "  \"bool remaproughness\" [ false ]\n"
     "  \"float roughness\" 0.1\n",
     0},
    {"Material \"plastic\" \"rgb Ks\" [ 0 0 0 ]\n",
     "Material \"diffuse\" \"rgb reflectance\" [ 0.25 0.25 0.25 ]\n", 0},
    {"Material \"metal\" \"spectrum eta\" \"spds/Au.eta.spd\" "
     "\"spectrum k\" \"spds/Au.k.spd\"\n",
     "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" "
     "\"spectrum k\" \"metal-Au-k\" \"float roughness\" 0.01\n",
     0},
    {"Material \"mirror\"\n", "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.9 0.9 ]\n",
     0},
    {"Material \"glass\" \"float index\" 1.33 \"color Kr\" [ 1 1 1 ] \"color Kt\" [ 1 1 1 ]\n",
     "Material \"dielectric\" \"float eta\" 1.33\n", 0},
    {"Material \"glass\" \"color Kt\" [ 1 .5 1 ]\n", "Material \"dielectric\"\n", 1},
    {"Material \"substrate\" \"rgb Kd\" [ .3 .3 .3 ] \"float uroughness\" .05\n",
     "Material \"coateddiffuse\" \"rgb reflectance\" [ .3 .3 .3 ] \"float uroughness\" .05 "
     "\"float vroughness\" 0.1\n",
     0},
    {"Material \"uber\" \"rgb Kd\" [ .3 .3 .3 ] \"rgb Ks\" [ 0 0 0 ] "
     "\"rgb opacity\" [ 1 1 1 ]\n",
     "Material \"diffuse\" \"rgb reflectance\" [ .3 .3 .3 ]\n", 0},
    {"  Material \"uber\" \"rgb Kd\" [ .3 .3 .3 ] \"rgb opacity\" [ .25 .25 .25 ]\n",
     "  MakeNamedMaterial \"see-through\" \"string type\" \"interface\"\n"
     "  MakeNamedMaterial \"solid-1\" \"string type\" \"coateddiffuse\" "
     "\"rgb reflectance\" [ .3 .3 .3 ] \"float roughness\" 0.1\n"
     "  Material \"mix\" \"string materials\" [ \"see-through\" \"solid-1\" ] "
     "\"float amount\" 0.25\n",
     0},
    {"Material \"translucent\" \"rgb Kd\" [ .5 .5 .5 ] \"rgb reflect\" [ 1 .5 0 ]\n",
     "Material \"diffusetransmission\" \"rgb reflectance\" [ 0.5 0.25 0 ] "
     "\"rgb transmittance\" [ 0.25 0.25 0.25 ]\n",
     0},
    {"MakeNamedMaterial \"a\" \"string type\" \"matte\"\n"
     "MakeNamedMaterial \"b\" \"string type\" [ \"mirror\" ]\n"
     "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" "
     "\"rgb amount\" [ .75 .75 .75 ]\n",
     "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n"
     "MakeNamedMaterial \"b\" \"string type\" [ \"conductor\" ] "
     "\"rgb reflectance\" [ 0.9 0.9 0.9 ]\n"
     "Material \"mix\" \"string materials\" [ \"b\" \"a\" ] \"float amount\" .75\n",
     0},
    {"Material \"kdsubsurface\" \"color Kd\" [ .8 .7 .6 ] \"color mfp\" [ .1 .1 .1 ]\n",
     "Material \"subsurface\" \"rgb reflectance\" [ .8 .7 .6 ] \"rgb mfp\" [ .1 .1 .1 ] "
     "\"float eta\" 1.3\n",
     0},
    {"Material \"subsurface\" \"string name\" \"Skin1\" \"rgb sigma_a\" [ 1 1 1 ]\n",
     "Material \"subsurface\" \"string name\" \"Skin1\"\n", 0},
    {"Material \"hair\" \"rgb color\" [ .3 .2 .1 ]\n",
     "Material \"hair\" \"rgb reflectance\" [ .3 .2 .1 ]\n", 0},
    {"Material \"disney\" \"rgb color\" [ .3 .2 .1 ] \"float metallic\" .5 \"float sheen\" 1\n",
     "Material \"principled\" \"rgb basecolor\" [ .3 .2 .1 ] \"float metallic\" .5 "
     "\"float roughness\" 0.5\n",
     2},
    {"Material \"fourier\" \"string bsdffile\" \"x.bsdf\"\n", "Material \"diffuse\"\n", 1},
    {"Material \"none\"\nMaterial \"\"\n", "Material \"interface\"\nMaterial \"interface\"\n",
     0},
    {"Texture \"t\" \"color\" \"constant\" \"color value\" [ 1 0 0 ]\n",
     "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [ 1 0 0 ]\n", 0},
    {"Texture \"t\" \"spectrum\" \"uv\"\n",
     "Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [ 0 0 0 ] \"rgb v01\" [ 0 1 0 ] "
     "\"rgb v10\" [ 1 0 0 ] \"rgb v11\" [ 1 1 0 ]\n",
     0},
    {"Texture \"a\" \"color\" \"constant\"\n"
     "Texture \"t\" \"color\" \"scale\" \"texture tex1\" \"a\" "
     "\"color tex2\" [ .5 .5 .5 ]\n",
     "Texture \"a\" \"spectrum\" \"constant\"\n"
     "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" .5\n",
     0},
    {"Texture \"a\" \"color\" \"constant\"\n"
     "Texture \"t\" \"color\" \"scale\" \"color tex1\" [ 2 2 2 ] \"texture tex2\" \"a\"\n",
     "Texture \"a\" \"spectrum\" \"constant\"\n"
     "Texture \"t\" \"spectrum\" \"scale\" \"float scale\" 2 \"texture tex\" \"a\"\n",
     0},
    {"Texture \"t\" \"color\" \"fbm\" \"integer octaves\" 3\n",
     "Texture \"t-float\" \"float\" \"fbm\" \"integer octaves\" 3\n"
     "Texture \"t\" \"spectrum\" \"mix\" \"rgb tex1\" [ 0 0 0 ] \"rgb tex2\" [ 1 1 1 ] "
     "\"texture amount\" \"t-float\"\n",
     0},
    {"Texture \"w\" \"color\" \"windy\"\nTexture \"c\" \"color\" \"checkerboard\"\nTexture "
     "\"t\" \"color\" \"scale\" \"texture tex1\" \"w\" \"texture tex2\" \"c\"\n",
     "Texture \"w-float\" \"float\" \"windy\"\n"
     "Texture \"w\" \"spectrum\" \"mix\" \"rgb tex1\" [ 0 0 0 ] \"rgb tex2\" [ 1 1 1 ] "
     "\"texture amount\" \"w-float\"\n"
     "Texture \"c\" \"spectrum\" \"checkerboard\"\n"
     "Texture \"t\" \"spectrum\" \"scale\" \"texture scale\" \"w-float\" "
     "\"texture tex\" \"c\"\n",
     0},
    {"Texture \"t\" \"float\" \"marble\" \"integer octaves\" 3 \"float scale\" 2\n",
     "Texture \"t\" \"float\" \"constant\"\n", 1},
    {"Texture \"t\" \"float\" \"uv\" \"float uscale\" 2\n",
     "Texture \"t\" \"float\" \"constant\"\n", 1},
    {"Texture \"t\" \"color\" \"dots\" \"float uscale\" 2 \"vector v1\" [ 1 0 0 ]\n",
     "Texture \"t\" \"spectrum\" \"dots\" \"float uscale\" 2\n", 0},
    {"Texture \"t\" \"float\" \"bilerp\" \"string mapping\" \"planar\" \"float uscale\" 2 "
     "\"float udelta\" 1 \"vector v1\" [ 1 0 0 ]\n",
     "Texture \"t\" \"float\" \"bilerp\" \"string mapping\" \"planar\" "
     "\"float udelta\" 1 \"vector3 v1\" [ 1 0 0 ]\n",
     0},
    {"Texture \"t\" \"float\" \"dots\" \"string mapping\" \"spherical\" \"float udelta\" 2\n",
     "Texture \"t\" \"float\" \"dots\" \"string mapping\" \"spherical\"\n", 0},
    {"Texture \"t\" \"float\" \"checkerboard\" \"integer dimension\" 3 "
     "\"string mapping\" \"uv\" \"float uscale\" 2\n",
     "Texture \"t\" \"float\" \"checkerboard\" \"integer dimension\" 3\n", 0},
    {"Texture \"t\" \"color\" \"constant\" \"blackbody value\" [ 3000 1 ]\n",
     "Texture \"t\" \"spectrum\" \"constant\" \"blackbody value\" 3000\n", 0},
    {"Material \"matte\" \"blackbody Kd\" [ 3000 .5 ]\n",
     "Material \"diffuse\" \"blackbody reflectance\" 3000\n", 1},
    {"Material \"matte\" \"rgb Kd\" [ 1.5 .5 1 ]\n",
     "Material \"diffuse\" \"rgb reflectance\" [ 1 0.5 1 ]\n", 1},
    {"Material \"matte\" \"float Kd\" 2\n",
     "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n", 1},
    {"Material \"translucent\" \"rgb Kd\" [ 1 1 1 ] \"rgb reflect\" [ 2 .5 0 ]\n",
     "Material \"diffusetransmission\" \"rgb reflectance\" [ 1 0.5 0 ] "
     "\"rgb transmittance\" [ 0.5 0.5 0.5 ]\n",
     1},
    {"Texture \"f\" \"float\" \"constant\"\n"
     "Material \"substrate\" \"color Kd\" [ .5 .5 .5 ] \"float roughness\" .1 "
     "\"float index\" 2\n"
     "Material \"uber\" \"color Kd\" [ .5 .5 .5 ] \"float roughness\" .1 "
     "\"texture eta\" \"f\" \"float index\" 2\n"
     "Material \"glass\" \"float index\" 2 \"float eta\" 1.4\n",
     "Texture \"f\" \"float\" \"constant\"\n"
     "Material \"coateddiffuse\" \"rgb reflectance\" [ .5 .5 .5 ] \"float roughness\" .1\n"
     "Material \"coateddiffuse\" \"rgb reflectance\" [ .5 .5 .5 ] \"float roughness\" .1\n"
     "Material \"dielectric\" \"float eta\" 1.4\n",
     2},
    {"LightSource \"goniometric\" \"rgb I\" [ 1 2 3 ]\n",
     "LightSource \"point\" \"rgb I\" [ 1 2 3 ]\n", 0},
    {"LightSource \"goniometric\" \"rgb scale\" [ 1 2 3 ] \"string mapname\" \"\"\n",
     "LightSource \"point\" \"rgb I\" [ 1 2 3 ]\n", 0},
    {"LightSource \"projection\" \"rgb I\" [ 1 2 3 ]\n", "", 1},
    {"Texture \"t\" \"float\" \"checkerboard\" \"string aamode\" \"none\" \"float tex1\" .3\n",
     "Texture \"t\" \"float\" \"checkerboard\" \"float tex1\" .3\n", 0},
    {"LightSource \"point\" \"point from\" [ 1 2 3 ] \"color I\" [ 1 2 3 ] "
     "\"color scale\" [ 2 2 2 ]\n",
     "LightSource \"point\" \"point3 from\" [ 1 2 3 ] \"rgb I\" [ 1 2 3 ] \"float scale\" 2\n",
     0},
    {"LightSource \"distant\" \"rgb L\" [ 1 2 3 ] \"rgb scale\" [ 2 1 .5 ]\n",
     "LightSource \"distant\" \"rgb L\" [ 2 2 1.5 ]\n", 0},
    {"LightSource \"point\" "
     "\"spectrum I\" [ 300 2 400 2 500 2 600 2 700 2 710 2 720 2 730 2 740 2 900 2 ]\n",
     "LightSource \"point\" "
     "\"spectrum I\" [ 300 2 400 2 500 2 600 2 700 2 710 2 720 2 730 2 740 2 900 2 ] "
     "\"float scale\" 2\n",
     0},
    {"LightSource \"infinite\" \"integer nsamples\" 4 \"integer samples\" 4 "
     "\"rgb L\" [ 1 1 1 ]\n",
     "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n", 0},
    {"AreaLightSource \"area\" \"rgb L\" [ 1 1 1 ] \"bool twosided\" \"true\" "
     "\"integer nsamples\" [ 8 ]\n",
     "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ] \"bool twosided\" true\n", 0},
    {"Shape \"trianglemesh\" \"point P\" [ 0 0 0 1 0 0 0 1 0 ] "
     "\"float st\" [ 0 0 1 0 0 1 ] \"integer indices\" [ 0 1 2 ]\n",
     "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] "
     "\"point2 uv\" [ 0 0 1 0 0 1 ] \"integer indices\" [ 0 1 2 ]\n",
     0},
    {"Shape \"loopsubdiv\" \"integer nlevels\" 2 \"point P\" [ 0 0 0 1 0 0 0 1 0 ] "
     "\"integer indices\" [ 0 1 2 ]\n",
     "Shape \"loopsubdiv\" \"integer levels\" 2 \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] "
     "\"integer indices\" [ 0 1 2 ]\n",
     0},
    {"Shape \"sphere\" \"float radius\" 2 \"rgb Kd\" [ 1 0 0 ]\n",
     "Shape \"sphere\" \"float radius\" 2\n", 1},
    {"Shape \"nurbs\" \"integer nu\" 4\n", "", 1},
    {"TransformBegin\nTranslate [ 1 2 3 ]\nTransform 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 "
     "1\nTransformEnd\n",
     "AttributeBegin\n"
     "Translate  1 2 3 \n"
     "Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ]\n"
     "AttributeEnd\n",
     0},
    {"TransformBegin\n"
     "  AttributeBegin\n"
     "    Material \"mirror\"\n"
     "  AttributeEnd\n"
     "  Material \"matte\"\n"
     "    \"rgb Kd\" [ 1 1 1 ]\n"
     "TransformEnd\n"
     "Shape \"sphere\"\n",
     "AttributeBegin\n"
     "  AttributeBegin\n"
     "    Material \"conductor\" \"rgb reflectance\" [ 0.9 0.9 0.9 ]\n"
     "  AttributeEnd\n"
     "  Material \"diffuse\"\n"
     "    \"rgb reflectance\" [ 1 1 1 ]\n"
     "AttributeEnd\n"
     "Material \"diffuse\"\n"
     "    \"rgb reflectance\" [ 1 1 1 ]\n"
     "Shape \"sphere\"\n",
     0},
    {"MakeNamedMedium \"m\" \"string type\" \"heterogeneous\" \"integer nx\" 1 "
     "\"integer ny\" 1 \"integer nz\" 1 \"float density\" 1 \"color sigma_a\" [ 1 1 1 ]\n",
     "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 1 "
     "\"integer ny\" 1 \"integer nz\" 1 \"float density\" 1 \"rgb sigma_a\" [ 1 1 1 ]\n",
     0},
    {"Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"a.png\" "
     "\"bool trilinear\" \"true\" \"bool gamma\" true\n",
     "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"../old/a.png\" "
     "\"string filter\" \"trilinear\" \"string encoding\" \"sRGB\"\n",
     0},
    {"Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"a.png\" "
     "\"float gamma\" 2.5 \"bool trilinear\" false\n",
     "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"../old/a.png\" "
     "\"string encoding\" \"gamma 2.5\"\n",
     0},
    {"Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"a.png\" \"float gamma\" 1\n",
     "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"../old/a.png\" "
     "\"string encoding\" \"linear\"\n",
     0},
    {"Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"a.png\"\n"
     "Material \"uber\" \"texture opacity\" \"t\"\n",
     "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"../old/a.png\"\n"
     "Texture \"t-float\" \"float\" \"imagemap\" \"string filename\" \"../old/a.png\"\n"
     "MakeNamedMaterial \"see-through\" \"string type\" \"interface\"\n"
     "MakeNamedMaterial \"solid-1\" \"string type\" \"coateddiffuse\" "
     "\"float roughness\" 0.1 \"rgb reflectance\" [ 0.25 0.25 0.25 ]\n"
     "Material \"mix\" \"string materials\" [ \"see-through\" \"solid-1\" ] "
     "\"texture amount\" \"t-float\"\n",
     0},
    {"Texture \"a\" \"float\" \"constant\"\n"
     "Texture \"t\" \"float\" \"scale\" \"texture tex1\" \"a\" \"float tex2\" .5\n",
     "Texture \"a\" \"float\" \"constant\"\n"
     "Texture \"t\" \"float\" \"scale\" \"texture tex\" \"a\" \"float scale\" .5\n",
     0},
    {"Texture \"a\" \"color\" \"constant\"\n"
     "Texture \"t\" \"color\" \"scale\" \"texture tex1\" \"a\" \"rgb tex2\" [ 1 .5 0 ]\n",
     "Texture \"a\" \"spectrum\" \"constant\"\n"
     "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" 0.5\n",
     1},
    {"Texture \"a\" \"color\" \"constant\"\n"
     "Texture \"t\" \"color\" \"scale\" \"texture tex1\" \"a\" "
     "\"spectrum tex2\" [ 400 1 700 2 ]\n",
     "Texture \"a\" \"spectrum\" \"constant\"\n"
     "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"a\"\n",
     1},
    {"Texture \"a\" \"color\" \"constant\"\nTexture \"b\" \"color\" \"constant\"\nTexture "
     "\"t\" \"color\" \"scale\" \"texture tex1\" \"a\" \"texture tex2\" \"b\"\n",
     "Texture \"a\" \"spectrum\" \"constant\"\nTexture \"b\" \"spectrum\" "
     "\"constant\"\nTexture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"a\"\n",
     1},
    {"Texture \"a\" \"color\" \"imagemap\" \"string filename\" \"a.png\"\nTexture \"b\" "
     "\"color\" \"imagemap\" \"string filename\" \"a.png\"\nTexture \"t\" \"color\" "
     "\"scale\" \"texture tex1\" \"a\" \"texture tex2\" \"b\"\n",
     "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"../old/a.png\"\n"
     "Texture \"b\" \"spectrum\" \"imagemap\" \"string filename\" \"../old/a.png\"\n"
     "Texture \"b-float\" \"float\" \"imagemap\" \"string filename\" \"../old/a.png\"\n"
     "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"a\" "
     "\"texture scale\" \"b-float\"\n",
     1},
    {"LightSource \"goniometric\" \"string mapname\" \"around.exr\" \"rgb I\" [ 1 2 3 ] "
     "\"rgb scale\" [ 2 1 1 ]\n",
     "LightSource \"goniometric\" \"string filename\" \"around-equiarea.exr\" "
     "\"rgb I\" [ 2 2 3 ]\n",
     0},
    {"LightSource \"projection\" \"string mapname\" \"a.png\" \"rgb I\" [ 1 2 3 ] "
     "\"rgb scale\" [ 2 1 1 ]\n",
     "LightSource \"projection\" \"string filename\" \"../old/a.png\" \"float fov\" 45\n", 2},
    {"LightSource \"projection\" \"string mapname\" \"a.png\" \"blackbody I\" [ 3000 2 ]\n",
     "LightSource \"projection\" \"string filename\" \"../old/a.png\" \"float fov\" 45\n", 1},
    {"LightSource \"projection\" \"string mapname\" \"a.png\" \"rgb I\" [ 2 2 2 ]\n",
     "LightSource \"projection\" \"string filename\" \"../old/a.png\" \"float scale\" 2 "
     "\"float fov\" 45\n",
     0},
    {"LightSource \"infinite\" \"string mapname\" \"around.exr\" \"rgb L\" [ 1 2 3 ]\n",
     "LightSource \"infinite\" \"string filename\" \"around-equiarea.exr\"\n", 0},
    {"LightSource \"infinite\" \"string mapname\" \"\" \"rgb L\" [ 1 2 3 ]\n",
     "LightSource \"infinite\" \"rgb L\" [ 1 2 3 ]\n", 0},
    {"LightSource \"point\" \"rgb scale\" [ 1 2 3 ]\n",
     "LightSource \"point\" \"rgb I\" [ 1 2 3 ]\n", 0},
    {"LightSource \"distant\" \"rgb scale\" [ 1 2 3 ]\n",
     "LightSource \"distant\" \"rgb L\" [ 1 2 3 ]\n", 0},
    {"LightSource \"point\" \"spectrum I\" [ 360 1 830 1 ] \"rgb scale\" [ 1 2 3 ]\n",
     "LightSource \"point\" \"spectrum I\" [ 360 1 830 1 ]\n", 1},
    {"LightSource \"point\" \"rgb I\" [ 1 1 1 ] \"spectrum scale\" [ 400 1 700 1 ]\n",
     "LightSource \"point\" \"rgb I\" [ 1 1 1 ]\n", 1},
    {"LightSource \"beam\"\n", "", 1},
    {"AreaLightSource \"sphere\"\n", "", 1},
    {"MakeNamedMaterial \"m\" \"string type\" \"uber\" \"rgb opacity\" [ .5 .25 .75 ] "
     "\"rgb Kr\" [ 0 0 0 ]\n"
     "NamedMaterial \"m\"\n",
     "MakeNamedMaterial \"see-through\" \"string type\" \"interface\"\n"
     "MakeNamedMaterial \"m-solid\" \"string type\" \"coateddiffuse\" "
     "\"float roughness\" 0.1 \"rgb reflectance\" [ 0.25 0.25 0.25 ]\n"
     "MakeNamedMaterial \"m\" \"string type\" \"mix\" "
     "\"string materials\" [ \"see-through\" \"m-solid\" ] \"float amount\" 0.5\n"
     "NamedMaterial \"m\"\n",
     1},
    {"Texture \"a\" \"color\" \"constant\"\nMaterial \"uber\" \"texture opacity\" \"a\"\n",
     "Texture \"a\" \"spectrum\" \"constant\"\n"
     "MakeNamedMaterial \"see-through\" \"string type\" \"interface\"\n"
     "MakeNamedMaterial \"solid-1\" \"string type\" \"coateddiffuse\" "
     "\"float roughness\" 0.1 \"rgb reflectance\" [ 0.25 0.25 0.25 ]\n"
     "Material \"mix\" \"string materials\" [ \"see-through\" \"solid-1\" ] "
     "\"float amount\" 0.5\n",
     1},
    {"Texture \"a\" \"color\" \"constant\"\nMaterial \"translucent\" \"texture Kd\" \"a\"\n",
     "Texture \"a\" \"spectrum\" \"constant\"\n"
     "Material \"diffusetransmission\" \"texture reflectance\" \"a\" "
     "\"texture transmittance\" \"a\" \"float scale\" 0.5\n",
     0},
    {"Texture \"a\" \"color\" \"constant\"\n"
     "Material \"translucent\" \"texture Kd\" \"a\" \"rgb reflect\" [ 0 0 0 ]\n",
     "Texture \"a\" \"spectrum\" \"constant\"\n"
     "Material \"diffusetransmission\" \"rgb reflectance\" [ 0 0 0 ] "
     "\"texture transmittance\" \"a\"\n",
     1},
    {"Material \"translucent\" \"spectrum Kd\" [ 400 1 700 1 ] "
     "\"spectrum reflect\" [ 400 1 700 1 ]\n",
     "Material \"diffusetransmission\" \"rgb reflectance\" [ 0.125 0.125 0.125 ] "
     "\"rgb transmittance\" [ 0.125 0.125 0.125 ]\n",
     2},
    {"MakeNamedMaterial \"a\" \"string type\" \"matte\"\n"
     "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"a\" "
     "\"rgb amount\" [ .5 .25 .75 ]\n",
     "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n"
     "Material \"mix\" \"string materials\" [ \"a\" \"a\" ] \"float amount\" 0.5\n",
     1},
    {"MakeNamedMaterial \"a\" \"string type\" \"matte\"\n"
     "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"a\"\n",
     "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n"
     "Material \"mix\" \"string materials\" [ \"a\" \"a\" ]\n",
     0},
};

#endif
