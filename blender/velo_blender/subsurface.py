"""subsurface.py: subsurface scattering of Blender as velo's subsurface material.

Cycles turns a radius into a mean free path by the surface's colour (kernel/closure/bssrdf.h, kernel/integrator/subsurface_random_walk.h
of 3.4: the dipole of Jensen and others 2001, the fit of Chiang and others 2016); velo takes the mean free path, and both turn the colour
into the albedo of single scattering."""
import math

DEFAULT_ETA = 1.4
GRAY = 0.5  # the colour for the mean free path where the colour varies
MIN_ETA, MAX_ETA = 1.0001, 2.5  # of velo's subsurface material


def _dipole(albedo, internal):
    root = math.sqrt(3 * (1 - albedo))
    return 0.5 * albedo * (1 + math.exp(-internal * root)) * math.exp(-root)


def _reduced_albedo(color, internal):
    """The albedo whose dipole has the reflectance color, by bisection."""
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _dipole(middle, internal) < color else (low, middle)
    return 0.5 * (low + high)


def mean_free_path(radius, color, method, eta):
    """Of one channel, from Cycles' radius, in the same unit."""
    color = min(max(color, 0.0), 0.999)
    if method == "RANDOM_WALK":
        inner = 1 / eta
        diffuse = inner * (-1.44 * inner + 0.71) + 0.668 + 0.0636 * eta
        albedo = _reduced_albedo(color, 4 / 3 * (1 + diffuse) / (1 - diffuse))
        radius = radius * math.sqrt(3 * (1 - albedo))
    else:
        radius = radius * 0.25 / math.pi
    return max(radius * (1.9 - color + 3.5 * (color - 0.8)**2), 1e-7)


def material(inputs, color, radius, method, eta, surface):
    """velo's material. radius: three numbers; surface: its keywords: eta, roughness (squared: alpha), normal, displacement."""
    plain = color if isinstance(color, tuple) else (GRAY,) * 3
    paths = tuple(mean_free_path(part, albedo, method, eta) for part, albedo in zip(radius, plain))
    words = {name: value for name, value in surface.items() if name in ("normal", "displacement")}
    alpha = surface.get("alpha", 0.0)
    if isinstance(color, tuple):
        color = tuple(min(part, 1.0) for part in color)
    return inputs.scene.add_material("subsurface", reflectance=color, mfp=paths, eta=min(max(surface["eta"], MIN_ETA), MAX_ETA),
                                     u_roughness=alpha, v_roughness=alpha, remap_roughness=False, name=inputs.owner, **words)


def three(value):
    return value if isinstance(value, tuple) else (value,) * 3
