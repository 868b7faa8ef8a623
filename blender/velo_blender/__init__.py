"""velo in Blender: a render engine. Needs the Python module velo."""

bl_info = {
    "name": "velo",
    "author": "velo contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Render Engine",
    "description": "Photorealistic renderer with verified camera models",
    "category": "Render",
}


def _modules():
    try:
        import velo  # noqa: F401: the message is clearer than that of the first module which needs it
    except ImportError as error:
        raise ImportError("velo in Blender needs the Python module velo: install python3-velo or set PYTHONPATH (%s)" % error) from None
    from . import camera_files, datasets, engine, panels, settings
    return settings, camera_files, datasets, engine, panels


def register():
    for module in _modules():
        module.register()


def unregister():
    for module in reversed(_modules()):
        module.unregister()
