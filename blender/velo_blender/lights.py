"""lights.py: Blender's lights as velo's, with the units of Cycles.

Point and spot of P watts: intensity P / (4 pi) in all directions, along a spot's axis. Sun: irradiance. Area: radiance P / (4 A) on one side.
Cycles hides lights from the camera unless their visibility says otherwise, and mirrors show them: so do velo's."""
import math

import numpy
import velo

from . import evaluate, lamp_nodes, square, versions

SHARP_SUN = 1e-3  # radians from the middle to the rim; suns of a smaller disk are points
SUN_PIXELS = 12  # of a sun's image from the middle to the rim, where MAX_SUN_SIDE allows it
MAX_SUN_SIDE = 2048  # of larger images velo samples blocks of pixels, and rims have noise
MAX_SIZE = 1e12  # radius or side of a lamp, scene units
FAR = 1e6  # where the camera would see a sun
SPOT_POINTS = 16  # of a spot with a radius
NARROWEST = math.radians(1)  # spread of an area light, as in Cycles
SPOT_SIDE = 512  # of the image of a spot's intensity, pixels
AREA_SIDE = 256  # of the image of an area light whose nodes vary, pixels
ROUND_CORNERS = 128  # of the polygon that such a round light is


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
    tint = lamp_nodes.of(light, notes)
    color = numpy.array(light.color, dtype=float) * light.energy
    if tint.color is not None:
        color = color * tint.color
    if not numpy.isfinite(color).all() or color.max() <= 0:
        if light.energy != 0:
            notes.add(item.name, "", "its colour or power is 0, negative or no number; it is left out")
        return
    power = float(color.max())
    words = {"color": tuple(float(max(0.0, x)) / power for x in color)}
    if tint.color is None:
        _add_varying(scene, item, light, pose, words, power, tint, notes)
    elif light.type == "SUN":
        _sun(scene, item, light, pose, words, power, camera_sees, notes)
    else:
        {"POINT": _point, "SPOT": _directed, "AREA": _area}[light.type](scene, item, light, pose, words, power, notes)


def _add_varying(scene, item, light, pose, words, power, tint, notes):
    """A lamp whose nodes differ between directions or places."""
    try:
        if light.type == "AREA":
            _area(scene, item, light, pose, words, power, notes, tint)
        else:
            _directed(scene, item, light, pose, words, power, notes, tint)
    except evaluate.Unsupported as error:
        notes.add(item.name, error.node.name, "%s; the light is left out" % error.text)


def _lamp_surface(scene, words, radiance, item, spread=math.pi, texture=None, **shape):
    """A shape that emits and that, as in Cycles, other light passes. texture: its radiance is this times radiance; None: words' colour."""
    known = {"radiance": words["color"]} if texture is None else {"texture": texture}
    emission = scene.add_emission(scale=radiance, two_sided=False, spread=spread, **known)
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
    side, middle, values = sun_disk(half)
    pixels = numpy.zeros((side, side, 3), dtype=numpy.float32)  # the disk is a small part of it
    pixels[middle, middle] = values[..., None] * total
    scene.add_light("infinite", image=velo.Image(pixels, encoding="linear"), scale=1.0, pose=_frame_along(axis, numpy.zeros(3)))


def sun_disk(half):
    """The radiance of a sun about +z in an octahedral square: (the square's side, a slice of its rows and columns, the values there); 0
    elsewhere. They are the same within an angle of half, with the shares of the pixels at its rim. Their sum over directions is 1, as in
    Cycles."""
    side = int(min(MAX_SUN_SIDE, max(64, 2 * round(SUN_PIXELS * math.sqrt(math.pi) / half / 2))))
    # The square's middle is +z; an angle of half reaches this far from it.
    reach = min(side // 2, int(math.ceil(side * math.sin(0.5 * half) / math.sqrt(2))) * 2 + 2)
    fine = 4
    local = (numpy.arange(2 * reach * fine) + 0.5) / fine - reach
    v, u = numpy.meshgrid(2 * local / side, 2 * local / side, indexing="ij")
    share = (square.cosines(u, v) >= math.cos(half)).reshape(2 * reach, fine, 2 * reach, fine).mean(axis=(1, 3))
    return side, slice(side // 2 - reach, side // 2 + reach), share / (share.sum() * 4 * math.pi / side**2)


def _directed(scene, item, light, pose, words, power, notes, tint=None):
    """A spot, or a point light whose intensity differs between directions: points with an image of directions. tint: of nodes that vary."""
    frame = _frame_of(pose)
    if frame is None:
        notes.add(item.name, "", "its direction is not defined; it is left out")
        return
    places = _places(item, light, frame, notes)
    if not places:
        notes.add(item.name, "", "its radius is huge or no number; it is left out")
        return
    half = min(0.5 * light.spot_size, 0.5 * math.pi) if light.type == "SPOT" else math.pi
    kind, side, directions, turn = _diagram(half)
    factor = numpy.ones(len(directions)) if light.type != "SPOT" else _spot_factor(-directions[:, 2], half, light.spot_blend)
    values = factor[:, None] if tint is None else numpy.nan_to_num(factor[:, None] * tint.along(directions, frame[:3, :3]), posinf=0.0)
    size = {"fov": 2 * half} if kind == "projection" else {}
    for image, color in _images(kind, side, values, numpy.array(words["color"]) * power / (4 * math.pi * len(places))):
        for place in places:
            frame[:3, 3] = place
            scene.add_light(kind, pose=frame @ turn, image=image, **color, **size)


def _diagram(half):
    """(velo's kind of light, its image's side, the directions of its pixels in the lamp's space, whose axis is -z, the lamp's space from
    the light's), for what shines up to an angle of half from its axis."""
    if half <= math.radians(60):
        place = math.tan(half) * (2 * (numpy.arange(SPOT_SIDE) + 0.5) / SPOT_SIDE - 1)
        y, x = numpy.meshgrid(-place, place, indexing="ij")
        directions = numpy.stack((-x.ravel(), y.ravel(), -numpy.ones(x.size)), axis=1)
        unit = directions / numpy.linalg.norm(directions, axis=1, keepdims=True)
        return "projection", SPOT_SIDE, unit, numpy.diag((-1.0, 1.0, -1.0, 1.0))
    # A goniometric light's axis is y, and it swaps y and z.
    turn = numpy.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    return "goniometric", 2 * SPOT_SIDE, square.directions(2 * SPOT_SIDE) * (1, -1, 1), turn


def _images(kind, side, values, intensity):
    """(image, keywords of its colour) for each light of a kind: factors, n x 1 or 3, on an intensity, three numbers. A goniometric light
    has the means of its pixels: three of them have the colours of an image that has."""
    colored = values * intensity
    if kind == "projection":
        return [(_image(side, colored), {"scale": 1.0})]
    high = float(max(colored.max(), 1e-30))
    sum_of_colors = colored.sum(axis=0)
    tone = sum_of_colors / max(sum_of_colors.max(), 1e-30)
    gray = colored.max(axis=1, keepdims=True)
    if numpy.allclose(colored, gray * tone, atol=1e-4 * high):
        return [(_image(side, gray), {"color": tuple(float(x) for x in tone), "scale": 1.0})]
    axes = numpy.eye(3)
    return [(_image(side, colored[:, i:i + 1]), {"color": tuple(axes[i]), "scale": 1.0}) for i in range(3) if sum_of_colors[i] > 0]


def _image(side, values):
    whole = numpy.repeat(values, 3, axis=1) if values.shape[1] == 1 else values
    return velo.Image(numpy.ascontiguousarray(whole.reshape(side, side, 3), dtype=numpy.float32), encoding="linear")


def _frame_of(pose):
    """The place and the unit axes of a lamp, 4 x 4, mirrored where the pose is; None: it has no direction."""
    axis, up = pose[:3, 2], pose[:3, 1]
    if numpy.linalg.norm(axis) < 1e-12:
        return None
    frame = _frame_along(axis / numpy.linalg.norm(axis), pose[:3, 3])
    side = numpy.cross(up, frame[:3, 2])
    if numpy.linalg.norm(side) > 1e-12 * numpy.linalg.norm(up):
        side = side / numpy.linalg.norm(side)
        frame[:3, 1] = numpy.cross(frame[:3, 2], side)
        frame[:3, 0] = side if numpy.linalg.det(pose[:3, :3]) >= 0 else -side
    return frame


def _places(item, light, frame, notes):
    """The points of a directed light at a frame, one, or more of a disk across its axis; []: its radius is huge or no number."""
    middle, axes = frame[:3, 3].copy(), frame[:3, :2].copy()
    if not light.shadow_soft_size < MAX_SIZE:
        return []
    if light.shadow_soft_size <= 1e-6:
        return [middle]
    notes.add(item.name, "Radius", "its disk is %d points" % SPOT_POINTS)
    return [middle + axes @ point * light.shadow_soft_size for point in disk_points(SPOT_POINTS)]


def disk_points(count):
    """Points spread evenly over a disk of radius 1, count x 2: Vogel's spiral."""
    number = numpy.arange(count) + 0.5
    turn = number * math.pi * (3 - math.sqrt(5))
    return numpy.sqrt(number / count)[:, None] * numpy.stack((numpy.cos(turn), numpy.sin(turn)), axis=1)


def _frame_along(axis, place):
    """A pose at a place whose z is an axis."""
    other = numpy.array((0.0, 0, 1)) if abs(axis[2]) < 0.9 else numpy.array((1.0, 0, 0))
    x = numpy.cross(other, axis)
    x = x / numpy.linalg.norm(x)
    frame = numpy.eye(4)
    frame[:3, 0], frame[:3, 1], frame[:3, 2], frame[:3, 3] = x, numpy.cross(axis, x), axis, place
    return frame


def _spot_factor(cosines, half, blend):
    """A smooth step at the edge of a spot and, in this version of Cycles, the cosine itself."""
    edge = math.cos(half)
    width = max((1 - edge) * blend, 1e-6)
    t = numpy.clip((cosines - edge) / width, 0, 1)
    factor = t * t * (3 - 2 * t)
    if versions.spot_has_cosine():
        factor = factor * numpy.maximum(cosines, 0)
    return factor


def _tinted(scene, words, tint):
    """velo's texture of an area light's tint over its square: (0, 0) at its corner of the least x and y."""
    place = (numpy.arange(AREA_SIDE) + 0.5) / AREA_SIDE
    v, u = numpy.meshgrid(place[::-1], place, indexing="ij")
    values = tint.at({"world parametric": numpy.stack((u.ravel(), v.ravel(), numpy.zeros(u.size)), axis=1)}) * words["color"]
    values = numpy.nan_to_num(numpy.broadcast_to(values, (u.size, 3)), nan=0.0, posinf=0.0, neginf=0.0)
    image = velo.Image(numpy.ascontiguousarray(values.reshape(AREA_SIDE, AREA_SIDE, 3), dtype=numpy.float32), encoding="linear")
    return scene.add_texture("image", spectrum=True, image=image, uv_set=0, st_from_uv=[1.0, 0, 0, 0, 1, 0], wrap="clamp", filter="bilinear")


def _area_mesh(round_shape):
    """A square of side 1 or a polygon of the area of the disk of diameter 1, in the plane z = 0, and its uvs."""
    if not round_shape:
        places, triangles = numpy.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]), numpy.array([[0, 1, 2], [0, 2, 3]])
    else:
        turn = 2 * math.pi * numpy.arange(ROUND_CORNERS) / ROUND_CORNERS
        radius = 0.5 * math.sqrt(2 * math.pi / (ROUND_CORNERS * math.sin(2 * math.pi / ROUND_CORNERS)))
        places = radius * numpy.stack((numpy.cos(turn), numpy.sin(turn)), axis=1)
        first = numpy.arange(1, ROUND_CORNERS - 1)
        triangles = numpy.stack((numpy.zeros_like(first), first, first + 1), axis=1)
    positions = numpy.concatenate((places, numpy.zeros((len(places), 1))), axis=1)
    return positions.astype(numpy.float32), triangles.astype(numpy.int32), (places + 0.5).astype(numpy.float32)


def _area(scene, item, light, pose, words, power, notes, tint=None):
    """tint: of nodes that vary, or None."""
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
    if tint is not None:
        positions, triangles, uvs = _area_mesh(round_shape)
        uvs[:, 1] = 1 - uvs[:, 1]  # the turned y is the lamp's -y
        _lamp_surface(scene, words, radiance, item, kind="triangles", positions=positions, indices=triangles, uvs=uvs, spread=spread,
                      pose=turned @ numpy.diag((width, height, 1.0, 1.0)), texture=_tinted(scene, words, tint))
        return
    if round_shape:
        stretched = turned @ numpy.diag((0.5 * width, 0.5 * height, 1.0, 1.0))
        _lamp_surface(scene, words, radiance, item, kind="disk", radius=1.0, pose=stretched, spread=spread)
        return
    quad = 0.5 * numpy.array([[-width, -height, 0], [width, -height, 0], [width, height, 0], [-width, height, 0]])
    _lamp_surface(scene, words, radiance, item, kind="triangles", positions=quad.astype(numpy.float32),
                  indices=numpy.array([[0, 1, 2], [0, 2, 3]], dtype=numpy.int32), pose=turned, spread=spread)
