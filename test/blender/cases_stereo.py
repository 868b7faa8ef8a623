"""Cases of test_stereo.py: both eyes see points where plain cameras at their places do, and what Cycles' eyes see."""
import math
import os
import random

import bpy
import mathutils
import numpy
from bpy_extras.object_utils import world_to_camera_view

from inside import FOLDER, ball, case, lamp, material, new_scene, notes, plane

MODES = ("OFFAXIS", "PARALLEL", "TOE")


def stereo_scene(mode, **values):
    scene = new_scene(world=(0.4, 0.4, 0.4), **values)
    scene.render.use_multiview = True
    scene.render.image_settings.views_format = "INDIVIDUAL"
    stereo = scene.camera.data.stereo
    stereo.pivot = "CENTER"
    stereo.convergence_mode, stereo.interocular_distance, stereo.convergence_distance = mode, 0.5, 5.0
    return scene


def eyes(scene, engine="VELO", cameras=None):
    """{eye: height x width x 3} of a render; cameras, a list, gets velo's for each view."""
    from velo_blender import export
    see = export.Export.see

    def watched(self, view, name=""):
        see(self, view, name)
        if name:
            cameras.append(self.camera)

    scene.render.engine = engine
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = os.path.join(FOLDER, "stereo")
    export.Export.see = see if cameras is None else watched
    try:
        bpy.ops.render.render(write_still=True)
    finally:
        export.Export.see = see
    import velo
    return {side: numpy.asarray(velo.read_image(os.path.join(FOLDER, "stereo_%s.exr" % side)))[..., :3].astype(float) for side in "LR"}


def plain_eye(scene, side):
    """A camera without stereo at the place of one eye, side -1 left, 1 right: half of the distance to the side, turned or shifted so that
    both see the same at the distance of convergence."""
    center, stereo = scene.camera, scene.camera.data.stereo
    half, far = 0.5 * stereo.interocular_distance, stereo.convergence_distance
    item = bpy.data.objects.new("eye", center.data.copy())
    scene.collection.objects.link(item)
    item.rotation_mode = "QUATERNION"  # Euler's angles lose digits near their poles
    turn = math.atan(half / far) * side if stereo.convergence_mode == "TOE" else 0.0
    item.matrix_world = (center.matrix_world.normalized() @ mathutils.Matrix.Translation((side * half, 0, 0)) @
                         mathutils.Matrix.Rotation(turn, 4, "Y"))
    if stereo.convergence_mode == "OFFAXIS":
        item.data.shift_x -= side * half / item.data.sensor_width * item.data.lens / far
    bpy.context.view_layer.update()
    return item


@case
def both_eyes_see_points_where_plain_cameras_do():
    rng, worst = random.Random(2), 0.0
    for mode in MODES * 4:
        scene = stereo_scene(mode, size=(rng.randint(30, 90), rng.randint(30, 90)), samples=1)
        lens = scene.camera.data
        lens.lens, lens.shift_x, lens.sensor_width = rng.uniform(15, 80), rng.uniform(-0.2, 0.2), rng.uniform(20, 40)
        scene.camera.location, scene.camera.rotation_euler = ([rng.uniform(-3, 3) for _ in range(3)] for _ in range(2))
        lens.stereo.interocular_distance, lens.stereo.convergence_distance = rng.uniform(0.05, 1), rng.uniform(1, 8)
        cameras = []
        eyes(scene, cameras=cameras)
        assert len(cameras) == 2, cameras
        for camera, side in zip(cameras, (-1, 1)):
            item = plain_eye(scene, side)
            for _ in range(10):
                point = item.matrix_world @ mathutils.Vector((rng.uniform(-2, 2), rng.uniform(-2, 2), -rng.uniform(1, 20)))
                seen = world_to_camera_view(scene, item, point)
                if not (-0.5 < seen.x < 1.5 and -0.5 < seen.y < 1.5):
                    continue
                expected = numpy.array((seen.x * camera.width, (1 - seen.y) * camera.height))
                worst = max(worst, float(abs(camera.project([list(point)]).pixels[0] - expected).max()))
    assert worst < 0.01, worst


def things(scene):
    plane(material("ShaderNodeBsdfDiffuse", Color=(0.6, 0.6, 0.6))[0])
    for i in range(3):
        ball(material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.3 * i, 0.1))[0], (-1 + i, 1.5 * i - 1.5, 0.4), 0.4)
    lamp(scene, "POINT", 200, shadow_soft_size=0.0)


@case
def both_eyes_see_what_those_of_cycles_see():
    for mode, kind in (*((mode, "PERSP") for mode in MODES), ("OFFAXIS", "ORTHO")):
        scene = stereo_scene(mode)
        scene.camera.data.type = kind
        things(scene)
        cycles, mine = eyes(scene, "CYCLES"), eyes(scene)
        apart = abs(cycles["L"] - cycles["R"]).mean()
        for side in "LR":
            assert abs(cycles[side] - mine[side]).mean() < max(0.007, 0.3 * apart), (mode, kind, side, abs(cycles[side] - mine[side]).mean(), apart)
        assert abs(mine["L"] - mine["R"]).mean() > 0.7 * apart, (mode, kind)
        assert not notes(scene), notes(scene)


@case
def eyes_of_a_moving_camera():
    scene = stereo_scene("TOE")
    things(scene)
    scene.render.use_motion_blur = True
    for frame, x in ((1, -1.0), (3, 1.0)):
        scene.camera.location.x = x
        scene.camera.keyframe_insert("location", frame=frame)
    scene.frame_set(2)
    bpy.context.view_layer.use_pass_vector = True
    cycles, mine = eyes(scene, "CYCLES"), eyes(scene)
    for side in "LR":
        assert abs(cycles[side] - mine[side]).mean() < 0.01, abs(cycles[side] - mine[side]).mean()
