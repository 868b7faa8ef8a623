"""principled.py: Blender's Principled shader, both generations of its sockets, as velo's principled material."""
import math

from . import bumps, glow, links, subsurface, versions

SHEEN_BEFORE_4 = 0.15  # of Burley's sheen, as a part of velo's: the same light from a ball in a white room, measured


def _get(inputs, node, name, groups, default):
    socket = versions.principled_socket(node, name)
    if socket is None:
        return default
    if isinstance(default, tuple):
        return inputs.albedo(socket, groups)
    return inputs.number(socket, groups) if name == "specular" else inputs.share(socket, groups)


def eta_of_reflectance(f0):
    """The index of refraction whose reflectance at normal incidence is f0."""
    root = math.sqrt(min(max(f0, 0.0), 0.99))
    return (1 + root) / (1 - root)


def _tangent_axis(inputs, node, groups):
    """The axis about which a shader's tangents run; None: they are those of the uv map."""
    source = links.follow(node.inputs["Tangent"], groups)[0] if node.inputs.get("Tangent") is not None else None
    if source is None:
        return "Z"
    if source.node.type == "TANGENT":
        return source.node.axis if source.node.direction_type == "RADIAL" else None
    inputs.notes.add(inputs.owner, source.node.name, "tangents by this node are radial about z")
    return "Z"


def anisotropy(inputs, strength_socket, rotation_socket, roughness, groups, node):
    """Keywords for Cycles' anisotropy; numbers only. Principled: alpha / aspect along the tangent, alpha * aspect across it, aspect =
    sqrt(1 - 0.9 |strength|); the glossy shader: aspect = 1 - |strength|, and the longer side across the tangent. velo: alpha along the
    tangent is mix(alpha, 1, strength^2)."""
    strength, turn = inputs.constant(strength_socket, groups), inputs.constant(rotation_socket, groups)
    if strength == 0.0:
        return {}
    if not all(isinstance(value, float) for value in (strength, turn, roughness)):
        inputs.notes.add(inputs.owner, node.name, "anisotropy by textures is left out")
        return {}
    inputs.tangent = _tangent_axis(inputs, node, groups)
    alpha = roughness * roughness
    is_principled = node.type == "BSDF_PRINCIPLED"
    aspect = math.sqrt(1 - 0.9 * min(abs(strength), 1.0)) if is_principled else 1 - min(abs(strength), 0.99)
    across, along = alpha * aspect, min(alpha / aspect, 1.0)
    if across >= 1:
        return {}
    share = math.sqrt(max(0.0, (along - across) / (1 - across)))
    rotation = 2 * math.pi * turn + (0.5 * math.pi if (strength < 0) == is_principled else 0.0)
    return {"roughness": math.sqrt(across), "anisotropy": share, "anisotropy_rotation": rotation}


def convert(inputs, node, groups, glossy, glass):
    """(material, emission, coverage) of a Principled node. glossy, glass: closures' functions for pure metal and pure glass."""
    generation = versions.principled_generation(node)
    get = lambda name, default: _get(inputs, node, name, groups, default)
    base, metallic, roughness = get("base_color", (0.8,) * 3), get("metallic", 0.0), get("roughness", 0.5)
    transmission = get("transmission", 0.0)
    words = bumps.words(inputs, node, groups)
    coat = get("coat", 0.0)
    plain = coat == 0.0 and get("sheen", 0.0) == 0.0
    words.update(anisotropy(inputs, versions.principled_socket(node, "anisotropic"),
                            versions.principled_socket(node, "anisotropic_rotation"), roughness, groups, node))
    roughness = words.pop("roughness", roughness)
    if generation == 2 and get("film_thickness", 0.0) != 0.0:
        inputs.notes.add(inputs.owner, node.name, "the thin film is left out")
    multiple = generation == 2 or node.distribution == "MULTI_GGX"
    scattering = _subsurface(inputs, node, groups, get, generation, base, {"roughness": roughness, **words})
    if scattering is not None and metallic != 1.0 and transmission != 1.0:
        if not plain or metallic != 0.0 or transmission != 0.0:
            inputs.notes.add(inputs.owner, node.name, "below its surface light scatters; metal, transmission, coat and sheen are left out")
        material = scattering
    elif metallic == 1.0 and plain and not multiple:
        material = _lossy_metal(inputs, base, roughness, words)
    elif transmission == 1.0 and metallic == 0.0 and plain:
        material = glass(inputs, base, roughness, inputs.index(versions.principled_socket(node, "ior"), groups), words)
    else:
        words.update(_dielectric(inputs, node, groups, get, generation, transmission, base))
        if generation == 1 and metallic == 0.0 and transmission == 0.0:
            base = _brightened(inputs, base, get("specular", 0.5), roughness, _hue(inputs, node, groups, base))
        if not plain:
            words.update(_layers(get, generation, coat, base))
        words.update(reflectance=base, metallic=metallic, roughness=roughness)
        if transmission == 0.0:
            material = inputs.scene.add_material("principled", name=inputs.owner, **words)
        else:
            material = refracting(inputs, transmission=transmission, **words)
    return material, _emission(inputs, node, groups), _coverage(get)


def refracting(inputs, **words):
    """velo's principled material of what refracts: a solid or, on open surfaces, a thin pane."""
    if inputs.is_open:
        inputs.notes.add(inputs.owner, "Glass", "on surfaces that are open it is a thin pane, which light passes straight on")
    return inputs.scene.add_material("principled", thin_walled=inputs.is_open, name=inputs.owner, **words)


def _brightened(inputs, base, specular, roughness, hue):
    """The base colour times what velo's reflection takes from the diffuse light, and what Burley's diffuse lobe adds to it: Blender's
    Principled before 4.0 adds its lobes without reduction. A fit to balls in a white room, roughness 0.1 to 1: see docs/blender.md.
    hue: the tint of the reflection, three numbers of which the greatest is 1 or above."""
    specular = specular if isinstance(specular, float) else 0.5
    rough = min(max(roughness, 0.0), 1.0) if isinstance(roughness, float) else 0.5
    factors = []
    for part in hue:
        f0 = min(max(0.08 * specular * part, 0.0), 0.99)
        taken = (f0 + (1 - f0) / 21) * (1.1 - 0.9 * rough) if specular > 0 else 0.0
        factors.append((0.955 + 0.11 * rough) / (1 - taken))
    if isinstance(base, tuple):
        return tuple(min(1.0, x * factor) for x, factor in zip(base, factors))
    return inputs.scene.add_texture("scale", spectrum=True, spectrum_a=base, amount=sum(factors) / 3)


def _lossy_metal(inputs, base, roughness, words):
    """A metal that loses the light between its microfacets, as Blender's Principled before 4.0."""
    return inputs.scene.add_material("principled", reflectance=(0, 0, 0), metallic=0.0, eta=0.0, specular=1.0, specular_color=base,
                                     roughness=roughness, name=inputs.owner, **words)


def _dielectric(inputs, node, groups, get, generation, transmission, base):
    """eta, specular and specular_color."""
    specular, tint = get("specular", 0.5), versions.principled_socket(node, "specular_tint")
    index = inputs.index(versions.principled_socket(node, "ior"), groups) if transmission != 0.0 or generation == 2 else None
    if transmission != 0.0:
        if generation == 1 and specular != 0.5 and transmission != 1.0:
            inputs.notes.add(inputs.owner, node.name, "where it transmits light, its reflection has the index, not Specular")
        return {"eta": index}
    if generation == 2:
        f0 = ((index - 1) / (index + 1))**2
        color = inputs.color(tint, groups)
        level = 2 * specular if isinstance(specular, float) else 1.0
        return {"eta": eta_of_reflectance(f0 * level), "specular_color": color}
    hue = _hue(inputs, node, groups, base)
    most = max(hue)
    words = {} if hue == (1.0,) * 3 else {"specular_color": tuple(x / most for x in hue)}
    if isinstance(specular, float):
        words["eta"] = eta_of_reflectance(0.08 * specular * most)
        words["specular"] = 0.0 if specular <= 0 else 1.0
    else:
        words.update(eta=eta_of_reflectance(0.08 * most), specular=specular)
    return words


def _hue(inputs, node, groups, base):
    """The tint of the reflection of a dielectric before 4.0, three numbers; their luminance is 1."""
    amount = inputs.constant(versions.principled_socket(node, "specular_tint"), groups)
    is_tinted = isinstance(amount, float) and amount > 0 and isinstance(base, tuple)
    return tinted(base, amount) if is_tinted else (1.0,) * 3


def tinted(base, amount):
    """White mixed with the hue of a colour, of the luminance 1: a component may be above 1."""
    light = 0.2126 * base[0] + 0.7152 * base[1] + 0.0722 * base[2]
    hue = tuple(x / light for x in base) if light > 0 else (1.0,) * 3
    return tuple(1 + amount * (x - 1) for x in hue)


def _layers(get, generation, coat, base):
    """Clear coat and sheen. Before 4.0 the coat had a quarter of its factor (Burley 2012)."""
    words = {}
    if coat != 0.0:
        quarter = 0.25 if generation == 1 else 1.0
        words["clearcoat"] = min(1.0, quarter * coat) if isinstance(coat, float) else coat
        words["clearcoat_roughness"] = get("coat_roughness", 0.03)
    sheen = get("sheen", 0.0)
    if isinstance(sheen, float) and sheen != 0.0:
        if generation == 2:
            tint, rough = get("sheen_tint", (1.0,) * 3), get("sheen_roughness", 0.5)
            words["sheen_color"] = tuple(min(1.0, sheen * x) for x in tint) if isinstance(tint, tuple) else tint
            words["sheen_roughness"] = rough
        else:
            amount = get("sheen_tint", 0.5)
            hue = tinted(base, amount) if isinstance(base, tuple) and isinstance(amount, float) else (1.0,) * 3
            words["sheen_color"] = tuple(min(1.0, max(0.0, SHEEN_BEFORE_4 * sheen * x)) for x in hue)
            words["sheen_roughness"] = 0.5
    return words


def _subsurface(inputs, node, groups, get, generation, base, surface):
    """velo's subsurface material; None: light does not scatter below the surface. surface: keywords of the reflection. Before 4.0 the
    factor scales the radius and mixes two colours; from then on it is the share of the light that scatters."""
    factor = inputs.constant(versions.principled_socket(node, "subsurface"), groups)
    radius = inputs.constant(versions.principled_socket(node, "subsurface_radius"), groups)
    scale = versions.principled_socket(node, "subsurface_scale")
    scale = 1.0 if scale is None else inputs.constant(scale, groups)
    if not isinstance(factor, float) or not isinstance(scale, float) or radius is None:
        inputs.notes.add(inputs.owner, node.name, "subsurface scattering that varies is diffuse")
        return None
    if factor <= 0 or scale <= 0 or max(subsurface.three(radius)) <= 0:
        return None
    color = base
    if generation == 1:
        other = inputs.color(node.inputs["Subsurface Color"], groups)
        if isinstance(base, tuple) and isinstance(other, tuple):
            color = tuple(a + factor * (b - a) for a, b in zip(base, other))
        elif factor > 0.5:
            color = other
        if not isinstance(color, tuple) and factor != 1.0:
            inputs.notes.add(inputs.owner, node.name, "of the two colours of subsurface scattering the heavier one is rendered")
    elif factor < 1:
        inputs.notes.add(inputs.owner, node.name, "all light that enters scatters below the surface, not a share")
    amount = factor if generation == 1 else scale
    radius = tuple(max(0.0, part * amount) for part in subsurface.three(radius))
    specular, rough = get("specular", 0.5), surface["roughness"]
    level = specular if isinstance(specular, float) else 0.5
    surface["eta"] = eta_of_reflectance(0.08 * level)
    surface["alpha"] = rough * rough if isinstance(rough, float) else 0.25
    index = node.inputs.get("Subsurface IOR")
    index = inputs.constant(index, groups) if index is not None else subsurface.DEFAULT_ETA
    return subsurface.material(inputs, color, radius, node.subsurface_method, max(index, 1.01) if isinstance(index, float) else 1.4, surface)


def _emission(inputs, node, groups):
    color, strength = (versions.principled_socket(node, name) for name in ("emission", "emission_strength"))
    if inputs.constant(color, groups) == (0.0, 0.0, 0.0):
        return []
    return [glow.of_sockets(inputs, node, color, strength, groups)]


def _coverage(get):
    alpha = get("alpha", 1.0)
    if isinstance(alpha, float):
        return None if alpha >= 1 else max(0.0, alpha)
    return alpha
