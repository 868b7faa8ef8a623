"""velo in Blender: a render engine. Needs the Python module velo."""

import importlib.util
import os
import sys

bl_info = {
    "name": "velo",
    "author": "velo contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Render Engine",
    "description": "Photorealistic renderer with verified camera models",
    "category": "Render",
}


def _find_velo():
    """Imports velo: where Blender's Python has it, else from this add-on's own folder (tools/bundle_addon)."""
    own = os.path.join(os.path.dirname(os.path.abspath(__file__)), "modules")
    if importlib.util.find_spec("velo") is None and os.path.isdir(own):
        if sys.version_info < (3, 10):
            raise ImportError("velo in Blender needs Python 3.10 or later, and this Blender has %d.%d" % sys.version_info[:2])
        sys.path.append(own)
    try:
        import velo  # noqa: F401: the message is clearer than that of the first module which needs it
    except ImportError as error:
        raise ImportError("velo in Blender needs the Python module velo: install python3-velo or set PYTHONPATH (%s)" % error) from None


def _modules():
    _find_velo()
    from . import camera_files, datasets, engine, panels, settings
    return settings, camera_files, datasets, engine, panels


def register():
    for module in _modules():
        module.register()


def unregister():
    for module in reversed(_modules()):
        module.unregister()
