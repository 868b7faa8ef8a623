/* import/pbrt/upgrade/materials.c: Material and MakeNamedMaterial: the rows of the materials.
 * Defaults that differ are written out. */

#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

#define BUMP                                    \
  {"bumpmap", VL_OLD_RENAME, "displacement"}, { \
    "displacement"                              \
  }
#define ROUGHNESSES \
  { "roughness uroughness vroughness remaproughness" }
static const char whole_coat[] = "the coat reflects what its eta says";

static const vlOldRow matte[] = {{"Kd", VL_OLD_RENAME, "reflectance"}, {"sigma"}, BUMP, {0}};
static const vlOldRow plastic[] = {
    {"Kd", VL_OLD_RENAME, "reflectance"},
    {"Ks", VL_OLD_LOSE, whole_coat},
    {"reflectance", VL_OLD_DEFAULT, "\"rgb reflectance\" [ 0.25 0.25 0.25 ]"},
    ROUGHNESSES,
    BUMP,
    {0}};
static const vlOldRow substrate[] = {{"Kd", VL_OLD_RENAME, "reflectance"},
                                     {"Ks", VL_OLD_LOSE, whole_coat},
                                     ROUGHNESSES,
                                     BUMP,
                                     {0}};
static const vlOldRow metal[] = {{"eta k"}, ROUGHNESSES, BUMP, {0}};
static const vlOldRow mirror[] = {
    {"Kr", VL_OLD_RENAME, "reflectance"},
    {"reflectance", VL_OLD_DEFAULT, "\"rgb reflectance\" [ 0.9 0.9 0.9 ]"},
    BUMP,
    {0}};
static const vlOldRow glass[] = {
    {"index", VL_OLD_RENAME, "eta"}, {"eta"}, ROUGHNESSES, BUMP, {0}};
static const vlOldRow translucent[] = {{"Ks", VL_OLD_LOSE, "only the diffuse part is kept"},
                                       {"roughness", VL_OLD_DROP},
                                       {"remaproughness", VL_OLD_DROP},
                                       {"reflect", VL_OLD_DROP},
                                       {"transmit", VL_OLD_DROP},
                                       {"Kd", VL_OLD_DROP},
                                       BUMP,
                                       {0}};
static const vlOldRow hair[] = {{"color", VL_OLD_RENAME, "reflectance"},
                                {"sigma_a eumelanin pheomelanin eta beta_m beta_n alpha"},
                                {0}};
static const vlOldRow kdsubsurface[] = {
    {"Kd", VL_OLD_RENAME, "reflectance"},
    {"reflectance", VL_OLD_DEFAULT, "\"rgb reflectance\" [ 0.5 0.5 0.5 ]"},
    {"mfp"},
    {"mfp", VL_OLD_DEFAULT, "\"rgb mfp\" [ 1 1 1 ]"},
    {"Kr", VL_OLD_DROP},
    {"Kt", VL_OLD_DROP},
    {"index", VL_OLD_RENAME, "eta"},
    {"eta", VL_OLD_DEFAULT, "\"float eta\" 1.3"},
    {"eta g scale"},
    ROUGHNESSES,
    BUMP,
    {0}};
static const vlOldRow subsurface[] = {{"Kr", VL_OLD_DROP},
                                      {"Kt", VL_OLD_DROP},
                                      {"index", VL_OLD_RENAME, "eta"},
                                      {"eta name sigma_a sigma_s scale g"},
                                      ROUGHNESSES,
                                      BUMP,
                                      {0}};
static const vlOldRow uber[] = {
    {"Kd", VL_OLD_RENAME, "reflectance"},
    {"reflectance", VL_OLD_DEFAULT, "\"rgb reflectance\" [ 0.25 0.25 0.25 ]"},
    {"Ks", VL_OLD_LOSE, whole_coat},
    {"Kr", VL_OLD_LOSE, "its mirror reflection is that of the coat"},
    {"Kt", VL_OLD_LOSE, "nothing is transmitted"},
    {"index", VL_OLD_RENAME, "eta"},
    {"eta"},
    ROUGHNESSES,
    BUMP,
    {0}};
static const vlOldRow none[] = {{"bumpmap", VL_OLD_DROP}, {0}};
static const vlOldRow fourier[] = {{"bsdffile", VL_OLD_DROP}, BUMP, {0}};
static const vlOldRow disney[] = {{"metallic roughness eta clearcoat"}, BUMP, {0}};
static const vlOldRow mix[] = {{"materials amount"}, {0}};

/* ---- rules ------------------------------------------------------------------------------- */

/* Oren and Nayar's roughness; zero has no effect. */
static bool matte_rule(vlOldStatement *s) {
  vlOldParam *p = vl_old_find(s, "sigma");
  double value;
  if (!p)
    return true;
  if (!vl_old_is_grey(p, &value) || value != 0)
    vl_old_lose(s, "matte's \"sigma\" has no counterpart: the surface is Lambertian");
  p->dropped = true;
  return true;
}

/* Adds pbrt-v3's default roughness, `value`, along the directions that have none. */
static bool add_roughness(vlOldStatement *s, const char *value) {
  if (vl_old_find(s, "roughness"))
    return true;
  bool u = vl_old_find(s, "uroughness"), v = vl_old_find(s, "vroughness");
  vl_old_note(s, "with roughness %s", value);
  if (!u && !v)
    return vl_old_add(s, "\"float roughness\" %s", value);
  if (u && v)
    return true;
  return vl_old_add(s, u ? "\"float vroughness\" %s" : "\"float uroughness\" %s", value);
}

/* Without its coat, plastic and substrate are diffuse. */
static bool coat_rule(vlOldStatement *s) {
  if (vl_old_is_black(s, "Ks")) {
    static const char *const coat[] = {"Ks", "roughness", "uroughness", "vroughness",
                                       "remaproughness"};
    vl_old_drop_all(s, coat, VL_LENGTH(coat));
    return true;
  }
  return add_roughness(s, "0.1");
}

static bool substrate_rule(vlOldStatement *s) {
  if (!coat_rule(s) || vl_old_find(s, "Kd"))
    return true;
  return vl_old_add(s, "\"rgb reflectance\" [ 0.5 0.5 0.5 ]");
}

static bool metal_rule(vlOldStatement *s) {
  return add_roughness(s, "0.01");
}

/* pbrt-v4's dielectric is not tinted: Kr and Kt go, and are lost unless they are 1. */
static bool glass_rule(vlOldStatement *s) {
  static const char *const names[] = {"Kr", "Kt"};
  for (int i = 0; i < 2; i++)
    if (vl_old_drop_loses(s, names[i], 1))
      vl_old_lose(s, "glass: \"%s\" has no counterpart: clear glass is written", names[i]);
  return true;
}

/* pbrt-v3's path tracer renders subsurface scattering, pbrt-v4's does not. Reports it once, if
 * the integrator is written already and its name cannot be changed any more. */
static bool warn_of_path(vlOldStatement *s) {
  vlUpgrade *u = s->u;
  if (u->plain_path && !u->subsurface)
    vl_old_lose(s,
                "pbrt-v4's \"path\" does not render subsurface scattering: name \"volpath\" as "
                "integrator");
  u->plain_path = false;
  return true;
}

/* The name of a measured substance replaces sigma_a and sigma_s. Without it pbrt-v4 wants both
 * or neither: the one that is missing gets pbrt-v3's default. */
static bool subsurface_rule(vlOldStatement *s) {
  vlOldParam *name = vl_old_find(s, "name"), *a = vl_old_find(s, "sigma_a"),
             *b = vl_old_find(s, "sigma_s");
  bool named = name && name->strings && name->text[0][0];
  if (named) {
    vl_old_drop(s, a);
    vl_old_drop(s, b);
  }
  warn_of_path(s);
  if (named || !a == !b)
    return true;
  return vl_old_add(
      s, "%s",
      a ? "\"rgb sigma_s\" [ 2.55 3.21 3.77 ]" : "\"rgb sigma_a\" [ .0011 .0024 .014 ]");
}

static bool none_rule(vlOldStatement *s) {
  for (size_t i = 0; i < s->params.count; i++)
    if (!vl_text_is(s->params.items[i].name, "type"))
      vl_old_drop(s, &s->params.items[i]);
  return true;
}

static const vlOldKind kinds[] = {
    {"matte", "diffuse", matte, matte_rule},
    {"plastic", "coateddiffuse", plastic, coat_rule},
    {"substrate", "coateddiffuse", substrate, substrate_rule},
    {"metal", "conductor", metal, metal_rule},
    {"mirror", "conductor", mirror},
    {"glass", "dielectric", glass, glass_rule},
    {"uber", "coateddiffuse", uber, vl_old_uber},
    {"translucent", "diffusetransmission", translucent, vl_old_translucent},
    {"mix", "mix", mix, vl_old_mix},
    {"hair", "hair", hair},
    {"kdsubsurface", "subsurface", kdsubsurface, warn_of_path},
    {"subsurface", "subsurface", subsurface, subsurface_rule},
    {"disney", "principled", disney, vl_old_disney,
     "disney has no counterpart in pbrt-v4: velo's own principled is written"},
    {"fourier", "diffuse", fourier, NULL,
     "fourier has no counterpart: grey diffuse is written"},
    {"measured", "diffuse", none, none_rule,
     "pbrt-v2's measured has no counterpart: grey diffuse is written"},
    {"shinymetal", "conductor", NULL, none_rule,
     "pbrt-v2's shinymetal has no counterpart: a conductor is written"},
    {"none", "interface", none, none_rule},
    {"", "interface", none, none_rule},
    {0}};

/* Kinds that only pbrt-v4 has stay as they are. */
static bool is_new(const char *name, vlOldStatement *s) {
  static const char names[] =
      "diffuse coateddiffuse conductor coatedconductor dielectric "
      "diffusetransmission thindielectric interface principled";
  if (vl_text_is(name, "measured"))
    return vl_old_find(s, "filename") != NULL && !vl_old_find(s, "type");
  return vl_has_word(names, name);
}

/* The name of the kind in pbrt-v4. A coated one whose coat is black (coat_rule has dropped its
 * "Ks") is diffuse. */
static const char *new_kind(vlOldStatement *s, const vlOldKind *kind) {
  bool coated = vl_text_is(kind->to, "coateddiffuse");
  for (size_t i = 0; i < s->params.count && coated; i++) {
    const vlOldParam *p = &s->params.items[i];
    double value;
    if (p->dropped && vl_text_is(p->name, "Ks") && vl_old_is_grey(p, &value) && value == 0)
      return "diffuse";
  }
  return kind->to;
}

/* The kind of that name; an unknown one, which is reported, becomes grey diffuse. Null: the
 * name is pbrt-v4's own, and the statement stays as it is. */
static const vlOldKind *find_kind(vlOldStatement *s, const char *name) {
  const vlOldKind *kind = vl_old_kind(kinds, name);
  if (is_new(name, s))
    return NULL;
  if (kind)
    return kind;
  static const vlOldKind unknown = {"", "diffuse", NULL, none_rule};
  vl_old_lose(s, "material \"%s\" is not one of pbrt-v3's: grey diffuse is written", name);
  return &unknown;
}

/* pbrt-v3's "eta" precedes "index", and both may be textures; pbrt-v4 has one, a number. */
static void plain_eta(vlOldStatement *s, const vlOldKind *kind) {
  vlOldParam *eta = vl_old_find(s, "eta"), *index = vl_old_find(s, "index");
  if (vl_has_word("metal hair", kind->from))
    return;
  if (eta)
    vl_old_drop(s, index);
  else
    eta = index;
  if (!eta || !vl_old_is_texture(eta))
    return;
  vl_old_lose(s, "%s: an \"eta\" of a texture has no counterpart: the default is taken",
              kind->from);
  vl_old_drop(s, eta);
}

/* pbrt-v3 takes reflectances above 1. */
static void clip_reflectances(vlOldStatement *s) {
  VL_EACH_ITEM(vlOldParam, p, &s->params) {
    double rgb[3];
    if (!p->dropped && vl_has_word("reflectance transmittance basecolor", p->new_name) &&
        vl_old_is_color(p, rgb) && vl_old_clip(s, p->name, rgb))
      vl_old_set_color(p, rgb);
  }
}

static bool rewrite(vlOldStatement *s, const vlOldKind *kind) {
  if (kind->lost)
    vl_old_lose(s, "%s", kind->lost);
  plain_eta(s, kind);
  if (kind->rule && !kind->rule(s))
    return false;
  const vlOldRow *rows = kind->rows;
  static const vlOldRow without_coat[] = {
      {"Kd", VL_OLD_RENAME, "reflectance"},
      BUMP,
      {"reflectance", VL_OLD_DEFAULT, "\"rgb reflectance\" [ 0.25 0.25 0.25 ]"},
      {0}};
  if (!vl_text_is(new_kind(s, kind), kind->to))
    rows = without_coat;
  if (!vl_old_rows(s, rows))
    return false;
  clip_reflectances(s);
  return true;
}

bool vl_old_material(vlOldStatement *s) {
  const vlOldKind *kind = find_kind(s, s->name[0]);
  if (!kind)
    return true;
  if (!rewrite(s, kind))
    return false;
  return vl_old_rename(s, 0, new_kind(s, kind));
}

bool vl_old_named_material(vlOldStatement *s) {
  vlOldParam *type = vl_old_find(s, "type");
  const char *name = type && type->strings ? type->text[0] : "matte"; /* pbrt-v3's default */
  const vlOldKind *kind = find_kind(s, name);
  if (!kind)
    return true;
  if (!rewrite(s, kind))
    return false;
  const char *to = new_kind(s, kind);
  vl_old_note(s, "\"%s\" -> \"%s\"", name, to);
  if (!type)
    return vl_old_add(s, "\"string type\" \"%s\"", to);
  return vl_old_edit(s, type->span[0], "\"%s\"", to);
}
