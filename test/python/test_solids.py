#!/usr/bin/python3
"""Boxes, planes, disks, cylinders; poses; words that other programs use, and what messages say of them."""
import cases
from cases import case, raises

numpy = cases.need("numpy")
import velo

TURN = numpy.array([[0, -1, 0, 1.0], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])  # a quarter about z, and a shift


def seen(scene, origin, direction, far=10.0):
    """Distance to the first hit along a ray, and the normal there; None: nothing is hit."""
    direction = numpy.asarray(direction, dtype=float) / numpy.linalg.norm(direction)
    up = (0, 0, 1) if abs(direction[2]) < 0.9 else (1, 0, 0)
    camera = velo.Camera(9, 9, eye=origin, lookat=numpy.asarray(origin) + direction, up=up, fov=0.01)
    image = scene.ground_truth(["distance", "Ng"], camera=camera)
    distance = float(image["distance"][4, 4])
    return (distance, image["Ng"][4, 4]) if distance < far else None


def hits(scene, origin, direction, distance, normal):
    found = seen(scene, origin, direction)
    assert found is not None and abs(found[0] - distance) < 1e-3, (origin, direction, found, distance)
    assert numpy.allclose(found[1], normal, atol=1e-3), (origin, direction, found, normal)


@case
def a_box_has_six_sides_that_face_outwards():
    scene = velo.Scene()
    box = scene.add_box((-1, -2, -3), (1, 2, 3), name="crate")
    for axis, size in enumerate((1, 2, 3)):
        for side in (-1, 1):
            out = numpy.zeros(3)
            out[axis] = side
            hits(scene, out * (size + 2), -out, 2, out)
    positions, indices = (numpy.asarray(part) for part in scene.mesh(box)[:2])
    corners = positions[indices].astype(float)
    volume = numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert abs(volume - 48) < 1e-9 and scene.info["triangles"] == 12 and box.name == "crate"  # closed, and outwards
    uvs = numpy.asarray(scene.get(box, "uvs"))
    assert uvs.min() == 0 and uvs.max() == 1
    for side in range(6):  # u and v run along the sides of each face: it is not turned inside out
        p, t = positions[4 * side:4 * side + 4], uvs[4 * side:4 * side + 4]
        assert len(numpy.unique(t, axis=0)) == 4 and numpy.ptp(p, axis=0).min() == 0


@case
def planes_disks_and_cylinders_are_where_they_should_be():
    scene = velo.Scene()
    scene.add_plane((0, 0, 1), (0, 0, 2), 2, 4)
    hits(scene, (0.9, 1.9, 3), (0, 0, -1), 2, (0, 0, 1))
    assert seen(scene, (1.1, 0, 3), (0, 0, -1)) is None and seen(scene, (0, 2.1, 3), (0, 0, -1)) is None
    scene = velo.Scene()
    scene.add_plane((1, 0, 0), (1, 1, 0), 2, 1)
    out = numpy.array([1, 1, 0]) / 2**0.5
    hits(scene, numpy.array([1, 0, 0.4]) + 2 * out, -out, 2, out)
    assert seen(scene, numpy.array([1, 0, 0.6]) + 2 * out, -out) is None
    scene = velo.Scene()
    scene.add_disk((1, 2, 3), 0.5, (0, 1, 0))
    hits(scene, (1.4, 4, 3), (0, -1, 0), 2, (0, 1, 0))
    assert seen(scene, (1.4, 4, 3.4), (0, -1, 0)) is None
    scene = velo.Scene()
    scene.add_cylinder((0, 0, 0), (0, 2, 0), 0.5)
    hits(scene, (3, 1.9, 0), (-1, 0, 0), 2.5, (1, 0, 0))
    assert seen(scene, (3, 2.1, 0), (-1, 0, 0)) is None and seen(scene, (3, -0.1, 0), (-1, 0, 0)) is None
    for end in ((0, 0, 3), (0, -3, 0), (-2, 1, 2)):  # each of them three long
        scene = velo.Scene()
        scene.add_cylinder((0, 0, 0), end, 0.5)
        along = numpy.array(end) / 3
        out = numpy.cross(along, (1, 0.1, 0.2))
        out /= numpy.linalg.norm(out)
        for inside in (0.1, 2.9):
            hits(scene, inside * along + 3 * out, -out, 2.5, out)
        for beyond in (-0.1, 3.1):
            assert seen(scene, beyond * along + 3 * out, -out) is None


@case
def a_pose_moves_a_body_on():
    for word in ("pose", "transform"):
        scene = velo.Scene()
        scene.add_sphere((1, 0, 0), 0.5, **{word: TURN})  # its centre: TURN (1, 0, 0) = (1, 3, 3)
        hits(scene, (1, 3, 6), (0, 0, -1), 2.5, (0, 0, 1))
        scene = velo.Scene()
        scene.add_cylinder((0, 0, 0), (2, 0, 0), 0.25, **{word: TURN.tolist()})  # along y at (1, 2 to 4, 3)
        hits(scene, (1, 3.9, 6), (0, 0, -1), 2.75, (0, 0, 1))
        scene = velo.Scene()
        scene.add_disk((0, 0, 0), 0.5, (0, 0, 1), **{word: TURN})
        hits(scene, (1.4, 2, 5), (0, 0, -1), 2, (0, 0, 1))
        scene = velo.Scene()
        handle = scene.add_box((0, 0, 0), (1, 1, 1), **{word: TURN})
        assert numpy.array_equal(scene.get(handle, "transform"), TURN)
        scene.set(handle, **{word: numpy.eye(4)})
        group = scene.add_group("g")
        instance = scene.add_instance(group, **{word: TURN})
        assert numpy.array_equal(scene.transform(instance), TURN)
        scene.set(instance, **{word: numpy.eye(4)})
        assert numpy.array_equal(scene.transform(instance), numpy.eye(4))
        lamp = scene.add_light("spot", **{word: TURN})
        assert numpy.array_equal(scene.get(lamp, "transform"), TURN)


@case
def messages_have_the_word_that_was_given():
    scene = velo.Scene()
    group = scene.add_group("g")
    lamp = scene.add_light("point")
    for call, texts in (
            (lambda: scene.add_sphere((0, 0, 0), 1, pose=[1, 2]), ("pose must be 4 x 4 numbers",)),
            (lambda: scene.add_box((0, 0, 0), (1, 1, 1), pose=[1, 2]), ("pose must have 16 numbers",)),
            (lambda: scene.add_box((0, 0, 0), (1, 1, 1), pose=TURN, transform=TURN), ("pose and transform are the same",)),
            (lambda: scene.add_sphere((0, 0, 0), 1, pose=TURN, transform=TURN), ("pose and transform are the same",)),
            (lambda: scene.add_instance(group, pose=[1, 2]), ("pose must be",)),
            (lambda: scene.add_instance(group), ("pose", "transform")),
            (lambda: scene.add_instance(group, TURN, pose=TURN), ("pose", "transform")),
            (lambda: scene.add_box((0, 0, 0), (0, 1, 1)), ("high must be above low",)),
            (lambda: scene.add_plane((0, 0, 0), (0, 0, 0), 1, 1), ("normal must be a direction",)),
            (lambda: scene.add_plane((0, 0, 0), (0, 0, 1), -1, 1), ("width",)),
            (lambda: scene.add_disk((0, 0), 1, (0, 0, 1)), ("center must be three numbers",)),
            (lambda: scene.add_cylinder((0, 0, 0), (0, 0, 0), 1), ("end minus start",)),
            (lambda: scene.add_light("point", position=(0, 1)), ("position must have 3 numbers",)),
            (lambda: scene.add_light("point", from_=(0, 1)), ("from_ must have 3 numbers",)),
            (lambda: scene.add_light("point", position=(0, 1, 0), from_=(0, 1, 0)), ("position and from_ are the same",)),
            (lambda: scene.add_light("point", positon=(0, 1, 0)), ('did you mean "position"',)),
            (lambda: scene.add_light("infinite", position=(0, 1, 0)), ("unknown keyword of this light", "position")),
            (lambda: scene.set(lamp, location=(0, 1, 0)), ("it is called position",)),
            (lambda: scene.add_material("diffuse", base_color=(1, 1, 1)), ("it is called reflectance",)),
            (lambda: scene.add_shape("triangles", vertices=[[0, 0, 0]]), ("it is called positions",)),
            (lambda: scene.add_shape("triangles", position=[[0, 0, 0]]), ('did you mean "positions"',)),
            (lambda: scene.render(width=8), ("width", "resolution=(width, height)")),
            (lambda: scene.render(samples=8), ("it is called spp",)),
            (lambda: scene.add_material("diffuse", **{"n" * 150: 1}), ("n" * 150,))):
        with raises(velo.UsageError, *texts):
            call()
    scene.set(lamp, position=(1, 2, 3))
    assert scene.get(lamp, "from") == (1, 2, 3)
    scene.set(lamp, from_=(3, 2, 1))
    assert scene.get(lamp, "from") == (3, 2, 1)


if __name__ == "__main__":
    cases.main()
