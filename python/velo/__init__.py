"""velo: a photorealistic renderer with verified camera models.

    import numpy, velo

    scene = velo.load("room.pbrt")
    image = scene.render(spp=64, resolution=(640, 480), channels=["Z", "id.object"])
    colors = numpy.asarray(image)      # 480 x 640 x 4, float32, linear
    depth = image["Z"]                 # 480 x 640
    image.write("room.exr")

Units are metres (scene units), seconds and radians; the world is right-handed; a camera's x points right, y down, z forward;
the first pixel's centre is (0.5, 0.5), rows are counted from the top. docs/python.md is the guide."""
from __future__ import annotations

from velo import _velo
from velo._context import Context, default_context, set_threads
from velo._errors import (CancelledError, Error, ForkError, MissingFileError, OutOfMemoryError, OutputError, Progress,
                          SceneError, Step, UnsupportedError, UsageError)
from velo.camera import Camera, Projection, Rays, TrajectoryFrame, read_camera, read_trajectory
from velo.film import Film, merge_films, read_film
from velo.image import Image, read_image
from velo.own import (FilmPoints, OwnCamera, OwnSampler, OwnTracer, Paths, Samples, Trace, TraceBounce, TraceHits, TraceLights,
                      TraceRays)
from velo.raw import Raw, read_raw
from velo.rays import RayHits
from velo.scene import Handle, Mesh, Model, Scene, World, load, settings_names
from velo.sensor import Exposure, Sensor, sensor_presets
from velo.settings import Settings
from velo.spectrum import Spectrum, blackbody, named, rgb, sampled, spectrum_names

__version__: str = _velo.version()


def channel_names() -> list[str]:
    """The names of ground truth channels (docs/ground-truth.md)."""
    return _velo.channel_names()


def sensor_names() -> list[str]:
    """The names of measured cameras for the keyword sensor."""
    return _velo.sensor_names()


def kinds(family: str) -> dict[str, dict[str, str]]:
    """The kinds of a family ("materials", "textures", "media", "lights", "shapes", "cameras", ...), each with its keywords
    and what they mean."""
    return _velo.kinds(family)


__all__ = [
    "Camera", "CancelledError", "Context", "Error", "Exposure", "Film", "FilmPoints", "ForkError", "Handle", "Image", "Mesh",
    "MissingFileError", "Model", "OutOfMemoryError", "OutputError", "OwnCamera", "OwnSampler", "OwnTracer", "Paths",
    "Progress", "Projection", "Raw", "RayHits", "Rays", "Samples", "Scene", "SceneError", "Sensor", "Settings", "Spectrum", "Step",
    "Trace", "TraceBounce", "TraceHits", "TraceLights", "TraceRays", "TrajectoryFrame", "UnsupportedError", "UsageError", "World",
    "blackbody", "channel_names", "default_context", "kinds", "load", "merge_films", "named", "read_camera", "read_film", "read_image",
    "read_raw", "read_trajectory", "rgb", "sampled", "sensor_names", "sensor_presets", "set_threads", "settings_names",
    "spectrum_names",
]
