"""lights.py: Blender's lights as velo's, with the units of Cycles.

Point and spot of P watts: intensity P / (4 pi) in all directions, along a spot's axis. Sun: irradiance. Area: radiance P / (4 A) on one side.
Cycles hides lights from the camera unless their visibility says otherwise, and mirrors show them: so do velo's."""
import math

import numpy
import velo

from . import evaluate, links, square, versions

SHARP_SUN = 1e-3  # radians from the middle to the rim; suns of a smaller disk are points
SUN_PIXELS = 12  # of a sun's image from the middle to the rim, where MAX_SUN_SIDE allows it
MAX_SUN_SIDE = 2048
MAX_SIZE = 1e12  # radius or side of a lamp, scene units
FAR = 1e6  # where the camera would see a sun
SPOT_POINTS = 16  # of a spot with a radius
NARROWEST = math.radians(1)  # spread of an area light, as in Cycles
SPOT_SIDE = 512  # of the image of a spot's intensity, pixels


def _color_and_strength(light, inputs):
    """The colour and a factor on the power, with the light's nodes where they are numbers."""
    color, strength = numpy.array(light.color, dtype=float), 1.0
    if not light.use_nodes or light.node_tree is None:
        return color, strength
    output = links.output_node(light.node_tree, "OUTPUT_LIGHT")
    source = links.follow(output.inputs["Surface"])[0] if output is not None else None
    if source is None or source.node.type != "EMISSION":
        inputs.add(light.name, source.node.name if source else "", "the light's nodes are not an emission and are ignored")
        return color, strength
    tint = evaluate.constant(source.node.inputs["Color"], source.groups)
    factor = evaluate.constant(source.node.inputs["Strength"], source.groups)
    if tint is None or not isinstance(factor, float):
        inputs.add(light.name, source.node.name, "nodes of a light that vary are ignored")
        return color, strength
    return color * numpy.array(tint), factor


def _finite_pose(matrix):
    pose = numpy.array(matrix, dtype=float)
    return pose if numpy.isfinite(pose).all() else None


def add(scene, item, matrix, camera_sees, notes):
    """Adds a light object. camera_sees(points n x 3): whether the camera might see one of these points or what lies between."""
    light = item.data
    if getattr(getattr(light, "cycles", None), "is_portal", False):
        return  # it lights nothing; Cycles only aims by it
    pose = _finite_pose(matrix)
    if pose is None:
        notes.add(item.name, "", "its place is no number (NaN or infinite); it is left out")
        return
    color, strength = _color_and_strength(light, notes)
    color = color * (strength * light.energy)
    if not numpy.isfinite(color).all() or color.max() <= 0:
        if light.energy != 0:
            notes.add(item.name, "", "its colour or power is 0, negative or no number; it is left out")
        return
    power = float(color.max())
    words = {"color": tuple(float(max(0.0, x)) / power for x in color)}
    if light.type == "SUN":
        _sun(scene, item, light, pose, words, power, camera_sees, notes)
    else:
        {"POINT": _point, "SPOT": _spot, "AREA": _area}[light.type](scene, item, light, pose, words, power, notes)


def _lamp_surface(scene, words, radiance, item, spread=math.pi, **shape):
    """A shape that emits and that, as in Cycles, other light passes."""
    emission = scene.add_emission(radiance=words["color"], scale=radiance, two_sided=False, spread=spread)
    material = scene.add_material("interface", name=item.name)
    scene.add_shape(emission=emission, material=material, name=item.name, hidden_from_camera=not item.visible_camera, **shape)


def _point(scene, item, light, pose, words, power, notes):
    place, radius = pose[:3, 3], light.shadow_soft_size
    if not radius < MAX_SIZE:
        notes.add(item.name, "", "its radius is huge or no number; it is left out")
        return
    if radius <= 1e-6:
        scene.add_light("point", position=tuple(place), scale=power / (4 * math.pi), **words)
        return
    matrix = numpy.eye(4)
    matrix[:3, 3] = place
    _lamp_surface(scene, words, power / (4 * math.pi**2 * radius**2), item, kind="sphere", radius=radius, z_min=-radius, z_max=radius,
                  pose=matrix)


def _sun(scene, item, light, pose, words, power, camera_sees, notes):
    axis = pose[:3, 2]
    length = numpy.linalg.norm(axis)
    if length < 1e-12:
        notes.add(item.name, "", "its direction is not defined; it is left out")
        return
    axis = axis / length
    frame = _frame_along(axis, numpy.zeros(3))
    half = 0.5 * min(light.angle, math.pi) if math.isfinite(light.angle) else 0.0
    rim = frame[:3, :2] @ (math.tan(min(half, 1.5)) * numpy.array([[1, -1, 0, 0], [0, 0, 1, -1.0]]))
    if half < SHARP_SUN or (not item.visible_camera and camera_sees(FAR * (axis + rim.T))):
        scene.add_light("distant", position=tuple(axis), to=(0.0, 0.0, 0.0), scale=power, **words)
        if half >= SHARP_SUN:
            notes.add(item.name, "Angle", "its disk, which the camera would see, is a point")
        return
    add_disk(scene, axis, half, power * numpy.array(words["color"]))


def add_disk(scene, axis, half, total):
    """A sun with a disk: half its angle, radians; total: its radiance summed over directions, a colour."""
    image = velo.Image(numpy.ascontiguousarray(sun_disk(half)[..., None] * total, dtype=numpy.float32), encoding="linear")
    scene.add_light("infinite", image=image, scale=1.0, pose=_frame_along(axis, numpy.zeros(3)))


def sun_disk(half):
    """The radiance of a sun about +z in an octahedral square, side x side: the same within an angle of half, with the shares of the
    pixels at its rim. Its sum over directions is 1, as in Cycles."""
    side = int(min(MAX_SUN_SIDE, max(64, 2 * round(SUN_PIXELS * math.sqrt(math.pi) / half / 2))))
    values = numpy.zeros((side, side))
    # The square's middle is +z; an angle of half reaches this far from it.
    reach = min(side // 2, int(math.ceil(side * math.sin(0.5 * half) / math.sqrt(2))) * 2 + 2)
    fine = 4
    local = (numpy.arange(2 * reach * fine) + 0.5) / fine - reach
    v, u = numpy.meshgrid(2 * local / side, 2 * local / side, indexing="ij")
    cosines = square.cosines(u, v)
    share = (cosines >= math.cos(half)).reshape(2 * reach, fine, 2 * reach, fine).mean(axis=(1, 3))
    middle = slice(side // 2 - reach, side // 2 + reach)
    values[middle, middle] = share
    return values / (share.sum() * 4 * math.pi / side**2)


def _spot(scene, item, light, pose, words, power, notes):
    axis = pose[:3, 2]
    length = numpy.linalg.norm(axis)
    if length < 1e-12:
        notes.add(item.name, "", "its direction is not defined; it is left out")
        return
    half = min(0.5 * light.spot_size, 0.5 * math.pi)
    if not light.shadow_soft_size < MAX_SIZE:
        notes.add(item.name, "", "its radius is huge or no number; it is left out")
        return
    frame = _frame_along(-axis / length, pose[:3, 3])
    places = [frame[:3, 3]]
    if light.shadow_soft_size > 1e-6:
        places = [frame[:3, 3] + frame[:3, :2] @ point * light.shadow_soft_size for point in disk_points(SPOT_POINTS)]
        notes.add(item.name, "Radius", "its disk is %d points" % SPOT_POINTS)
    color = numpy.array(words["color"]) * power / (4 * math.pi * len(places))
    kind, image, turn = _spot_image(half, light.spot_blend, color)
    for place in places:
        frame[:3, 3] = place
        size = {"fov": 2 * half} if kind == "projection" else {}
        scene.add_light(kind, pose=frame @ turn, image=image, scale=1.0, **size)


def disk_points(count):
    """Points spread evenly over a disk of radius 1, count x 2: Vogel's spiral."""
    number = numpy.arange(count) + 0.5
    turn = number * math.pi * (3 - math.sqrt(5))
    return numpy.sqrt(number / count)[:, None] * numpy.stack((numpy.cos(turn), numpy.sin(turn)), axis=1)


def _spot_image(half, blend, color):
    """(velo's kind of light, its image, the turn of its axes) for a spot of half an angle."""
    if half <= math.radians(60):
        place = math.tan(half) * (2 * (numpy.arange(SPOT_SIDE) + 0.5) / SPOT_SIDE - 1)
        cosines = 1 / numpy.sqrt(1 + place[:, None]**2 + place[None, :]**2)
        return "projection", _intensity(cosines, half, blend, color), numpy.eye(4)
    side = 2 * SPOT_SIDE
    cosines = square.directions(side)[:, 2].reshape(side, side)
    # A goniometric light's axis is y.
    return "goniometric", _intensity(cosines, half, blend, color), numpy.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])


def _frame_along(axis, place):
    """A pose at a place whose z is an axis."""
    other = numpy.array((0.0, 0, 1)) if abs(axis[2]) < 0.9 else numpy.array((1.0, 0, 0))
    x = numpy.cross(other, axis)
    x = x / numpy.linalg.norm(x)
    frame = numpy.eye(4)
    frame[:3, 0], frame[:3, 1], frame[:3, 2], frame[:3, 3] = x, numpy.cross(axis, x), axis, place
    return frame


def _intensity(cosines, half, blend, color):
    """The image of a spot's intensity for the cosines of angles from its axis: a smooth step at the edge and, in this version of
    Cycles, the cosine itself."""
    edge = math.cos(half)
    width = max((1 - edge) * blend, 1e-6)
    t = numpy.clip((cosines - edge) / width, 0, 1)
    factor = t * t * (3 - 2 * t)
    if versions.spot_has_cosine():
        factor = factor * numpy.maximum(cosines, 0)
    return velo.Image(numpy.ascontiguousarray(factor[..., None] * color, dtype=numpy.float32), encoding="linear")


def _area(scene, item, light, pose, words, power, notes):
    width = light.size
    height = light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
    scales = numpy.linalg.norm(pose[:3, :2], axis=0)
    if not max(width * scales[0], height * scales[1]) < MAX_SIZE:
        notes.add(item.name, "", "its size is huge or no number; it is left out")
        return
    if not width * height * scales[0] * scales[1] > 1e-12:
        notes.add(item.name, "", "its area is 0; it is left out")
        return
    round_shape = light.shape in ("DISK", "ELLIPSE")
    area = width * height * scales[0] * scales[1] * (math.pi / 4 if round_shape else 1)
    radiance = power / (4 * area)
    spread = min(max(light.spread, NARROWEST), math.pi) if math.isfinite(light.spread) else math.pi
    # The light leaves along -z.
    turned = pose @ numpy.diag((1.0, -1.0, -1.0, 1.0))
    if round_shape:
        stretched = turned @ numpy.diag((0.5 * width, 0.5 * height, 1.0, 1.0))
        _lamp_surface(scene, words, radiance, item, kind="disk", radius=1.0, pose=stretched, spread=spread)
        return
    quad = 0.5 * numpy.array([[-width, -height, 0], [width, -height, 0], [width, height, 0], [-width, height, 0]])
    _lamp_surface(scene, words, radiance, item, kind="triangles", positions=quad.astype(numpy.float32),
                  indices=numpy.array([[0, 1, 2], [0, 2, 3]], dtype=numpy.int32), pose=turned, spread=spread)
