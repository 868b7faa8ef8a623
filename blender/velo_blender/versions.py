"""versions.py: what differs between the versions of Blender, each with its source. Only Debian's 3.4.1 was tried.

Sources: the release notes of Blender's Python API (https://developer.blender.org/docs/release_notes/)."""
import bpy

VERSION = bpy.app.version

#: Principled's sockets: name here -> names in Blender, the newest first. 4.0 renamed them (release notes 4.0, "Shading & Texturing:
#: Principled BSDF") and gave Specular, Sheen and Emission other meanings: see principled_generation.
PRINCIPLED = {
    "base_color": ("Base Color",),
    "metallic": ("Metallic",),
    "roughness": ("Roughness",),
    "ior": ("IOR",),
    "alpha": ("Alpha",),
    "normal": ("Normal",),
    "subsurface": ("Subsurface Weight", "Subsurface"),
    "subsurface_radius": ("Subsurface Radius",),
    "subsurface_scale": ("Subsurface Scale",),
    "specular": ("Specular IOR Level", "Specular"),
    "specular_tint": ("Specular Tint",),
    "anisotropic": ("Anisotropic",),
    "anisotropic_rotation": ("Anisotropic Rotation",),
    "transmission": ("Transmission Weight", "Transmission"),
    "coat": ("Coat Weight", "Clearcoat"),
    "coat_roughness": ("Coat Roughness", "Clearcoat Roughness"),
    "coat_ior": ("Coat IOR",),
    "coat_tint": ("Coat Tint",),
    "coat_normal": ("Coat Normal", "Clearcoat Normal"),
    "sheen": ("Sheen Weight", "Sheen"),
    "sheen_roughness": ("Sheen Roughness",),
    "sheen_tint": ("Sheen Tint",),
    "emission": ("Emission Color", "Emission"),
    "emission_strength": ("Emission Strength",),
    "film_thickness": ("Thin Film Thickness",),
    "film_ior": ("Thin Film IOR",),
}


def principled_generation(node):
    """2 for the sockets of Blender 4.0 and later, 1 for those before."""
    return 2 if node.inputs.get("Specular IOR Level") is not None else 1


def principled_socket(node, name):
    """The socket of a Principled node by its name here; None where this version has none."""
    for known in PRINCIPLED[name]:
        socket = node.inputs.get(known)
        if socket is not None:
            return socket
    return None


def prepare_normals(mesh):
    """Makes the corners' normals readable: until 4.0 they had to be computed by a call that 4.1 removed (release notes 4.1, "Python
    API: Mesh"); mesh.corner_normals is there from 4.1 on."""
    if hasattr(mesh, "calc_normals_split"):
        mesh.calc_normals_split()


def corner_normals(mesh):
    """The collection of the corners' normals and the property to read from it."""
    if hasattr(mesh, "corner_normals"):
        return mesh.corner_normals, "vector"
    return mesh.loops, "normal"


def splits_normals(mesh):
    """Whether normals differ between the corners of one vertex: custom normals, auto smooth (removed in 4.1; source as above)."""
    if hasattr(mesh, "normals_domain"):
        return mesh.normals_domain == "CORNER"
    return mesh.use_auto_smooth or mesh.has_custom_normals


def panorama(camera):
    """The settings of a panorama: Cycles' own until 4.x, where they became the camera's (release notes 5.0, "Python API"); None:
    there are none."""
    settings = getattr(camera, "cycles", None)
    if settings is not None and hasattr(settings, "panorama_type"):
        return settings
    return camera if hasattr(camera, "panorama_type") else None


def eevee_or_cycles_panels():
    """The engines whose panels velo shows, too: EEVEE is called BLENDER_EEVEE_NEXT in 4.2 to 4.5 (release notes 4.2 and 5.0)."""
    return {"BLENDER_RENDER", "BLENDER_EEVEE", "BLENDER_EEVEE_NEXT"}


def spot_has_cosine():
    """Whether a spot's intensity falls with the cosine of the angle from its axis. Measured in 3.4.1; kernel/light/spot.h of Cycles 4.x
    has the smooth step alone."""
    return VERSION < (4, 0)
