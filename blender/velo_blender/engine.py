"""engine.py: the render engine: final renders and rendered views."""
import time
import traceback

import bpy
import velo

from . import camera, draw_view, export, motion, passes, report, settings, vectors, viewport

REFRESH = 1.0  # seconds between images of a render that goes on
TELL = 0.2  # seconds between lines about it
QUICK = 0.05  # seconds; where an image was shown in less, the last one of an ended render is shown, too


class Shown:
    """What is told and shown of a render that goes on. at, told: when, seconds; samples: of the image, 0 before the first; cost: seconds
    that it took."""

    def __init__(self):
        self.at, self.told, self.samples, self.cost = -REFRESH, -TELL, 0, 0.0


class VeloRenderEngine(bpy.types.RenderEngine):
    """velo in Blender."""
    bl_idname = "VELO"
    bl_label = "velo"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True

    def update_render_passes(self, scene=None, renderlayer=None):
        """Blender calls it to know the passes of a view layer."""
        passes.register(self, scene, renderlayer)

    def render(self, depsgraph):
        """Blender calls it for each view layer of a final render."""
        try:
            self._render(depsgraph)
        except export.Cancelled:
            pass
        except (report.Refused, velo.Error, MemoryError) as error:
            if not (isinstance(error, velo.Error) and self.is_stopped()):  # else the user has stopped velo
                self._refuse(str(error) or "there is not enough memory", getattr(error, "code", 1))
        except Exception as error:  # pylint: disable=broad-except; Blender shows one line, the terminal the rest
            traceback.print_exc()
            self._refuse("a fault of the add-on: %s: %s" % (type(error).__name__, error))

    def view_update(self, context, depsgraph):
        """Blender calls it when something of the scene has changed, for a view with rendered shading."""
        if getattr(self, "viewed", None) is None:
            self.viewed = viewport.ViewRender(_redraw_views)
        self.viewed.update(depsgraph, context.region, context.region_data)
        self.tag_redraw()

    def view_draw(self, context, depsgraph):
        """Blender calls it to draw a view."""
        if getattr(self, "viewed", None) is None:
            self.view_update(context, depsgraph)
        viewed = self.viewed
        viewed.look(context.region, context.region_data)
        if viewed.error is not None:
            self.update_stats("velo", viewed.error)
        elif viewed.image is not None:
            self.update_stats("velo", "%d samples" % viewed.samples)
        if viewed.image is not None:
            draw_view.draw(self, context, depsgraph.scene, viewed.image)

    def __del__(self):
        try:
            viewed = getattr(self, "viewed", None)
        except ReferenceError:  # Blender has freed its part of the engine, and with it what was kept here
            return
        if viewed is not None:
            viewed.stop()

    def is_stopped(self):
        """Whether the user has ended the render."""
        return self.test_break()

    def _refuse(self, text, status=1):
        report.status = status
        line = " ".join(("velo: " + text).split())
        print(line)
        self.report({"ERROR"}, line)

    def _render(self, depsgraph):
        scene = depsgraph.scene
        size = camera.image_size(scene)
        crop = camera.crop_window(scene, size)
        self.update_stats("", "velo: reading the scene")
        views = self._views(depsgraph)
        flow = vectors.Vectors(self, depsgraph, size, views) if depsgraph.view_layer.use_pass_vector else None
        made = self._export(depsgraph, size, flow, views)
        eyes = camera.eyes_of(self, depsgraph, views)
        report.remember(scene.name, made.notes)
        for text in made.notes.texts():
            print("velo: " + text)
        if made.notes.lines:
            self.report({"WARNING"}, "velo: %d things of the scene are rendered otherwise or not (panel velo)" % len(made.notes.lines))
        self.update_stats("", "velo: building")
        # Of an animation, the worlds of two frames share what is the same.
        self.world = made.scene.world(previous=getattr(self, "world", None), progress=lambda step: not self.is_stopped(),
                                      **settings.world_words(scene))
        passes.add(self, depsgraph.view_layer)
        for eye in eyes:
            self._render_view(depsgraph, made, eye, size, crop, flow)

    def _views(self, depsgraph):
        """The names of the views that Blender wants, [""] where there is one."""
        if not depsgraph.scene.render.use_multiview:
            return [""]
        result = self.begin_result(0, 0, 1, 1, layer=depsgraph.view_layer.name)
        names = [view.name for view in result.views]
        self.end_result(result, cancel=True, do_merge_results=False)
        return names or [""]

    def _render_view(self, depsgraph, made, eye, size, crop, flow):
        """Renders one view of the result; see camera.Eye."""
        if eye.name:
            self.active_view_set(eye.name)
            made.see(export.camera_of(depsgraph, size, eye), eye.name)
        if flow is not None:
            flow.view = eye.name
        window = size if crop is None else (crop[2] - crop[0], crop[3] - crop[1])
        target = passes.Target(self, depsgraph.view_layer.name, eye.name, window)
        fields = self._trace(depsgraph, made, crop, target, flow)
        for field, value in fields.items():
            self.get_result().stamp_data_add_field(field, value)

    def _export(self, depsgraph, size, flow, views):
        """The scene in velo. With Blender's persistent data it is that of the frame before, where places alone have changed."""
        scene = depsgraph.scene
        blurred = scene.render.use_motion_blur and depsgraph.view_layer.use_motion_blur
        if not scene.render.use_persistent_data or blurred or flow is not None:
            moves = motion.Motion(self, depsgraph, views) if blurred else None
            return export.Export(depsgraph, size, self.is_stopped, moves, keep_triangles=flow is not None)
        key = depsgraph.view_layer.name, size, scene.velo.bake_size
        kept = getattr(self, "kept", {})
        made = kept.get(key)
        if made is None or not made.follow(depsgraph):
            made = export.Export(depsgraph, size, self.is_stopped)
        self.kept = {**{known: value for known, value in kept.items() if known[1:] == key[1:]}, key: made}
        return made

    def _trace(self, depsgraph, made, crop, target, flow):
        """Renders into the result; what was shown stays where the user ends it. Returns the fields of the file's header."""
        scene = depsgraph.scene
        film = passes.Film(scene, made, crop)
        shown = Shown()

        def ask():
            if self.is_stopped():
                raise export.Cancelled()

        def show(ask=None):
            begin, image = time.monotonic(), made.scene.film.image()
            try:
                target.put(image, film, ask=ask)
            except export.Cancelled:
                target.keep(image, film)
                raise
            shown.at, shown.samples = time.monotonic(), made.scene.film.spp
            shown.cost = shown.at - begin

        def progress(state):
            ask()
            now = time.monotonic()
            if now - shown.told > TELL:
                self._tell(state)
                shown.told = now
            if state.pass_done and now - shown.at > REFRESH and not (bpy.app.background and shown.samples):
                show(ask)

        words = settings.tracing(scene, scene.velo.samples)
        if made.backdrop is not None:
            words["transparent"] = True
        channels = passes.wanted(depsgraph.view_layer)
        try:
            image = made.scene.render(channels=channels, progress=progress, denoise=scene.velo.denoise, crop=crop, **words)
        except export.Cancelled:
            if shown.samples and shown.cost < QUICK and made.scene.film.spp > shown.samples:
                show()
            raise
        target.put(image, film, ask=ask)
        if not channels:
            return {}
        more = passes.Made(made, image, flow, ask)
        target.put(image, film, more, ask)
        return more.mattes.fields(target.layer)

    def _tell(self, state):
        self.update_progress(min(max(state.fraction, 0.0), 1.0))
        if report.listener is not None:
            report.listener(state.fraction)
        self.update_stats("", "velo: sample %d of %d" % (state.spp, state.spp_total))


def _redraw_views():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def register():
    bpy.utils.register_class(VeloRenderEngine)


def unregister():
    bpy.utils.unregister_class(VeloRenderEngine)
