"""viewport.py: rendered shading: a thread renders the scene as a view sees it, the view draws the last image.

velo's objects are used by one thread at a time: the thread stops to use them, within .1 s, before the scene or the camera changes."""
import threading
import weakref

import bpy
import numpy
import velo

from . import camera, export, geometry, settings
from .report import Refused

FIRST_FACTOR = 4  # the first image has pixels this many times as wide and high
CLEAN_FROM = 8  # samples per pixel from which the image is denoised


POLL = 0.1  # seconds between looks for new images
_living = weakref.WeakSet()  # the renders of views; Blender draws in its main thread, so a timer of it looks for new images


def _poll():
    for render in list(_living):
        if render.pending:
            render.pending = False
            render.redraw()
    return POLL if len(_living) else None


def view_camera(region, view):
    """velo's camera of a 3D view: a region and its RegionView3D."""
    size = max(1, region.width), max(1, region.height)
    projection = numpy.array(view.window_matrix, dtype=float)
    pose = camera.pose(view.view_matrix.inverted())
    if view.is_perspective:
        words = camera.pinhole_matrix(projection, size)
        # P22 = -(f + n) / (f - n), P23 = -2 f n / (f - n)
        words["near_plane"] = max(0.0, projection[2, 3] / (projection[2, 2] - 1))
    else:
        words = camera.orthographic_window(projection)
        depth = (1 - projection[2, 3]) / -projection[2, 2]  # of the far plane, on both sides of the eye
        pose = pose.copy()
        pose[:3, 3] -= abs(depth) * pose[:3, 2]
    return velo.Camera(*size, world_from_camera=pose, **words)


class ViewRender:
    """The render of one view. image: height x width x 4, float32, rows from the bottom; None: there is none yet. error: one line, or
    None. redraw(): called in Blender's main thread where there is a new image; it must not keep the ViewRender alive."""

    def __init__(self, redraw):
        self.image, self.error, self.samples = None, None, 0
        self.redraw, self.pending = redraw, False
        _living.add(self)
        if not bpy.app.timers.is_registered(_poll):
            bpy.app.timers.register(_poll)
        self._made, self._camera, self._words = None, None, {}
        self._meshes = None  # geometry.Known of the last export
        self._stop = threading.Event()  # of the last thread
        self._using = threading.Lock()  # held while a thread uses the scene

    def update(self, depsgraph, region, view):
        """The scene has changed: moved instances alone are moved, everything else is made anew; worlds share what is the same, and meshes are read
        where the shape of something has changed."""
        self.stop()
        try:
            if self._made is None or not self._made.move(depsgraph):
                previous = None if self._made is None else self._made.scene.world(**settings.world_words(depsgraph.scene))
                meshes = geometry.Known(None if geometry.has_changed(depsgraph) else self._meshes)
                self._meshes = None  # an export that fails leaves nothing that could be old
                self._made = export.Export(depsgraph, (max(1, region.width), max(1, region.height)), view=view_camera(region, view), meshes=meshes)
                self._meshes = meshes
                self._made.scene.world(previous=previous, **settings.world_words(depsgraph.scene))
            self._exposure = settings.exposure(depsgraph.scene)
            self._words = settings.tracing(depsgraph.scene, depsgraph.scene.velo.preview_samples)
            self.error = None
        except (Refused, velo.Error, MemoryError) as error:
            self._made, self.error = None, " ".join(str(error).split())
        self._camera = None

    def look(self, region, view):
        """Starts the render where the view or the scene is another one."""
        if self._made is None:
            return
        try:
            wanted = view_camera(region, view)
        except (Refused, velo.Error) as error:
            self.error = str(error)
            return
        if self._camera is not None and same(self._camera, wanted):
            return
        self.stop()
        self._made.immerse(wanted)
        self._camera = wanted
        self._stop = threading.Event()
        words = (self._made.scene, wanted, dict(self._words), self._stop)
        threading.Thread(target=self._run, args=words, daemon=True).start()

    def stop(self):
        """Ends the render; the scene is free then. A thread that only denoises its image goes on and drops it."""
        self._stop.set()
        with self._using:
            pass

    def _run(self, scene, seen, words, stop):
        def go_on(progress):
            return not stop.is_set()

        def trace(view, film, samples, **more):
            with self._using:
                return None if stop.is_set() else (scene.render(camera=view, film=film, spp=samples, progress=go_on, **words, **more), scene.film)

        total = words.pop("spp")
        words.pop("noise", None)
        transparent = "transparent" in words
        film, samples = None, 1
        try:
            done = trace(seen.coarse(FIRST_FACTOR), None, 1)
            if done is not None:
                self._show(done[0], samples, transparent, stop)
            while not stop.is_set():
                more = {"sequence": 65536, "channels": ["error", "features"] if samples >= CLEAN_FROM else []}
                if film is None:
                    more["errors"] = True
                done = trace(seen, film, samples, **more)
                if done is None or stop.is_set():
                    return
                image, film = done
                if samples >= CLEAN_FROM:
                    image = image.denoise()
                self._show(image, samples, transparent, stop)
                if samples >= total:
                    return
                samples = min(2 * samples, total)
        except (velo.Error, MemoryError) as error:
            self.error = " ".join(str(error).split())
            self.pending = True

    def _show(self, image, samples, transparent, stop):
        pixels = numpy.array(image)[::-1, :, :4]
        pixels[..., :3] *= self._exposure
        if not transparent:
            pixels[..., 3] = 1
        if not stop.is_set():
            self.image, self.samples = numpy.ascontiguousarray(pixels), samples
            self.pending = True


def same(one, other):
    """Whether two cameras see the same."""
    if one.resolution != other.resolution or not numpy.array_equal(one.world_from_camera, other.world_from_camera):
        return False
    names = ("projection", "fx", "fy", "cx", "cy", "screen_min_x", "screen_max_x", "screen_min_y", "screen_max_y")
    return all(one.get(name) == other.get(name) for name in names)
