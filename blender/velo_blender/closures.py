"""closures.py: each shader node as one of velo's materials; CLOSURES maps the node's kind in Blender to a function (inputs, node,
groups) -> Closure.

Cycles' glossy shaders without multiple scattering are velo's principled dielectric of infinite index (docs/principled.md): F0 is the
specular colour, F90 the specular factor, and light between microfacets is lost in both."""
import math
from typing import Any, NamedTuple

from . import bumps, glow, principled, subsurface


class Closure:
    """material: a handle or None (reflects nothing). emission: list of glow.Glow. coverage: share of the surface
    that is there, a number or a texture; None: 1. is_clear: nothing is there. lobe: what a single lobe is made of, for facing.coated."""

    def __init__(self, material=None, emission=(), coverage=None, is_clear=False, lobe=None):
        self.lobe = lobe
        self.material, self.emission, self.coverage, self.is_clear = material, list(emission), coverage, is_clear


class Lobe(NamedTuple):
    """What a closure of one lobe is made of. kind: diffuse, glossy, refraction or clear; words: of its normal map and bump."""
    kind: str
    color: Any
    roughness: Any
    words: dict


def is_color(value):
    return isinstance(value, tuple)


# ---- coverage ------------------------------------------------------------------------------------------------------------

def product(inputs, a, b):
    if isinstance(a, float) and isinstance(b, float):
        return a * b
    texture, factor = (a, b) if not isinstance(a, float) else (b, a)
    return inputs.scene.add_texture("scale", spectrum=False, float_a=texture, amount=factor)


def one_minus(inputs, value):
    if isinstance(value, float):
        return 1.0 - value
    return inputs.scene.add_texture("mix", spectrum=False, float_a=1.0, float_b=0.0, amount=value)


def mixed_coverage(inputs, factor, first, second):
    a = 1.0 if first is None else first
    b = 1.0 if second is None else second
    if all(isinstance(value, float) for value in (factor, a, b)):
        return a + factor * (b - a)
    return inputs.scene.add_texture("mix", spectrum=False, float_a=a, float_b=b, amount=factor)


# ---- shaders -------------------------------------------------------------------------------------------------------------

def diffuse(inputs, color, words):
    """A diffuse material. words: of its normal map and bump."""
    if "normal" in words:
        return inputs.scene.add_material("principled", reflectance=color, metallic=0.0, roughness=1.0, specular=0.0, name=inputs.owner,
                                         **words)
    return inputs.scene.add_material("diffuse", reflectance=color, name=inputs.owner, **words)


def _diffuse(inputs, node, groups):
    color = inputs.albedo(node.inputs["Color"], groups)
    if inputs.constant(node.inputs["Roughness"], groups) != 0.0:
        inputs.notes.add(inputs.owner, node.name, "a rough diffuse reflection (Oren and Nayar) is a smooth one (Lambert)")
    words = bumps.words(inputs, node, groups)
    return Closure(diffuse(inputs, color, words), lobe=Lobe("diffuse", color, 1.0, words))


def glossy(inputs, color, roughness, multiple, words):
    """A mirror or a rough one of this colour in all directions."""
    if multiple:
        return inputs.scene.add_material("principled", reflectance=color, metallic=1.0, roughness=roughness, name=inputs.owner, **words)
    specular = 1.0
    if is_color(color):
        specular = min(1.0, max(color))
        color = tuple(min(1.0, x / specular) for x in color) if specular > 0 else (0.0,) * 3
    return inputs.scene.add_material("principled", reflectance=(0, 0, 0), metallic=0.0, eta=0.0, specular=specular, specular_color=color,
                                     roughness=roughness, name=inputs.owner, **words)


def _glossy(inputs, node, groups):
    color = inputs.albedo(node.inputs["Color"], groups)
    distribution = node.distribution
    roughness = 0.0 if distribution == "SHARP" else inputs.number(node.inputs["Roughness"], groups)
    if distribution in ("BECKMANN", "ASHIKHMIN_SHIRLEY") and roughness != 0.0:
        inputs.notes.add(inputs.owner, node.name, "the distribution %s is GGX" % distribution)
    words = bumps.words(inputs, node, groups)
    if node.inputs.get("Anisotropy") is not None:
        words.update(principled.anisotropy(inputs, node.inputs["Anisotropy"], node.inputs["Rotation"], roughness, groups, node))
        roughness = words.pop("roughness", roughness)
    return Closure(glossy(inputs, color, roughness, distribution == "MULTI_GGX", words), lobe=Lobe("glossy", color, roughness, words))


def glass(inputs, color, roughness, eta, words):
    """A solid of glass. color: factor on reflection and refraction, as in Cycles."""
    if not inputs.is_open and color == (1.0, 1.0, 1.0) and isinstance(roughness, float) and "normal" not in words:
        alpha = roughness * roughness
        return inputs.scene.add_material("dielectric", eta=eta, u_roughness=alpha, v_roughness=alpha, remap_roughness=False,
                                         name=inputs.owner, **words)
    return principled.refracting(inputs, reflectance=color, specular_color=color, metallic=0.0, roughness=roughness, eta=eta,
                                 transmission=1.0, **words)


def _glass(inputs, node, groups):
    color = inputs.albedo(node.inputs["Color"], groups)
    roughness = 0.0 if node.distribution == "SHARP" else inputs.number(node.inputs["Roughness"], groups)
    if node.distribution == "BECKMANN" and roughness != 0.0:
        inputs.notes.add(inputs.owner, node.name, "the distribution BECKMANN is GGX")
    return Closure(glass(inputs, color, roughness, inputs.index(node.inputs["IOR"], groups), bumps.words(inputs, node, groups)))


def _refraction(inputs, node, groups):
    color = inputs.albedo(node.inputs["Color"], groups)
    roughness = 0.0 if node.distribution == "SHARP" else inputs.number(node.inputs["Roughness"], groups)
    words = bumps.words(inputs, node, groups)
    handle = principled.refracting(inputs, reflectance=color, specular=0.0, metallic=0.0, roughness=roughness,
                                   eta=inputs.index(node.inputs["IOR"], groups), transmission=1.0, **words)
    return Closure(handle, lobe=Lobe("refraction", color, roughness, words))


def _translucent(inputs, node, groups):
    color = inputs.albedo(node.inputs["Color"], groups)
    handle = inputs.scene.add_material("diffuse_transmission", reflectance=(0, 0, 0), transmittance=color, scale=1.0, name=inputs.owner,
                                       **bumps.without_map(inputs, node, groups))
    return Closure(handle)


def _transparent(inputs, node, groups):
    color = inputs.albedo(node.inputs["Color"], groups)
    if is_color(color) and min(color) > 0.999:
        return Closure(is_clear=True, coverage=0.0, lobe=Lobe("clear", (1.0, 1.0, 1.0), 0.0, {}))
    if color == (0.0, 0.0, 0.0):
        return Closure()
    # What all colours let pass is not there, so that light samples pass it; the rest of the surface has the rest of the colour.
    coverage = None
    if is_color(color):
        low = min(color)
        coverage = 1.0 - low if low > 0 else None
        if max(color) - low > 0.01:
            inputs.notes.add(inputs.owner, node.name, "the light of lamps without a size passes it without its tint")
        color = tuple((x - low) / (1 - low) for x in color)
    handle = inputs.scene.add_material("principled", reflectance=color, specular=0.0, metallic=0.0, roughness=0.0, eta=1.5,
                                       transmission=1.0, thin_walled=True, name=inputs.owner)
    return Closure(handle, coverage=coverage)


def _emission(inputs, node, groups):
    return Closure(emission=[glow.of_sockets(inputs, node, node.inputs["Color"], node.inputs["Strength"], groups)])


def _subsurface(inputs, node, groups):
    color, words = inputs.albedo(node.inputs["Color"], groups), bumps.words(inputs, node, groups)
    scale, radius = inputs.constant(node.inputs["Scale"], groups), inputs.constant(node.inputs["Radius"], groups)
    if not isinstance(scale, float) or radius is None:
        inputs.notes.add(inputs.owner, node.name, "a radius that varies is 0: the scattering is diffuse")
        return Closure(diffuse(inputs, color, words))
    radius = tuple(max(0.0, part * scale) for part in subsurface.three(radius))
    if max(radius) <= 0:
        return Closure(diffuse(inputs, color, words))
    index = inputs.constant(node.inputs["IOR"], groups) if node.inputs.get("IOR") is not None else subsurface.DEFAULT_ETA
    index = index if isinstance(index, float) else subsurface.DEFAULT_ETA
    return Closure(subsurface.material(inputs, color, radius, node.falloff, max(index, 1.01), {**words, "eta": subsurface.MIN_ETA}))


def _velvet(inputs, node, groups):
    color = inputs.albedo(node.inputs["Color"], groups)
    roughness = (node.inputs.get("Sigma") or node.inputs.get("Roughness"))
    handle = inputs.scene.add_material("principled", reflectance=(0, 0, 0), specular=0.0, metallic=0.0, sheen_color=color,
                                       sheen_roughness=inputs.number(roughness, groups), name=inputs.owner)
    inputs.notes.add(inputs.owner, node.name, "velvet is velo's sheen, whose formula is another")
    return Closure(handle)


def _background(inputs, node, groups):
    return _emission(inputs, node, groups)


def _hair(inputs, node, groups):
    """The hair of Chiang and others 2016, which velo has, too. Cycles' pigments absorb (0.506, 0.841, 1.653) and (0.343, 0.733, 1.924)."""
    number = lambda name: inputs.number(node.inputs[name], groups)
    words = {"eta": inputs.index(node.inputs["IOR"], groups), "beta_m": number("Roughness"), "beta_n": number("Radial Roughness"),
             "alpha": math.degrees(inputs.constant(node.inputs["Offset"], groups) or 0.0)}
    if node.parametrization == "COLOR":
        words.update(color="reflectance", reflectance=inputs.albedo(node.inputs["Color"], groups))
    elif node.parametrization == "ABSORPTION":
        words.update(color="sigma_a", sigma_a=inputs.color(node.inputs["Absorption Coefficient"], groups))
    else:
        melanin, red = (inputs.constant(node.inputs[name], groups) for name in ("Melanin", "Melanin Redness"))
        if not (isinstance(melanin, float) and isinstance(red, float)):
            inputs.notes.add(inputs.owner, node.name, "melanin that varies is 0.8, without redness")
            melanin, red = 0.8, 0.0
        amount = -math.log(max(1 - melanin, 1e-4))
        words.update(color="sigma_a", sigma_a=tuple(amount * ((1 - red) * dark + red * light) for dark, light in
                                                    zip((0.506, 0.841, 1.653), (0.343, 0.733, 1.924))))
    return Closure(inputs.scene.add_material("hair", name=inputs.owner, **words))


def _principled(inputs, node, groups):
    material, emission, coverage = principled.convert(inputs, node, groups, glossy, glass)
    return Closure(material, emission, coverage, is_clear=isinstance(coverage, float) and math.isclose(coverage, 0.0, abs_tol=1e-9))


def _holdout(inputs, node, groups):
    """Black; visibility.is_hole makes a hole of it."""
    return Closure(diffuse(inputs, (0.0, 0.0, 0.0), {}))


CLOSURES = {"HOLDOUT": _holdout, "BSDF_DIFFUSE": _diffuse, "BSDF_GLOSSY": _glossy, "BSDF_ANISOTROPIC": _glossy, "BSDF_GLASS": _glass,
            "BSDF_REFRACTION": _refraction, "BSDF_TRANSLUCENT": _translucent, "BSDF_TRANSPARENT": _transparent, "EMISSION": _emission,
            "BACKGROUND": _background, "SUBSURFACE_SCATTERING": _subsurface, "BSDF_VELVET": _velvet, "BSDF_SHEEN": _velvet,
            "BSDF_HAIR_PRINCIPLED": _hair, "BSDF_PRINCIPLED": _principled}
