#!/usr/bin/python3
"""World.trace and World.occluded beside formulas of their own in numpy: triangles, spheres, instances, motion, k hits; what
passes rays; arrays that are not plain; rays that are none; bits."""
import hashlib
import os
import subprocess
import sys

import cases
from cases import case, warned

numpy = cases.need("numpy")
import velo

INF = numpy.inf


def random(seed=1):
    return numpy.random.default_rng(seed)


def unit(vectors):
    return vectors / numpy.linalg.norm(vectors, axis=-1, keepdims=True)


def some_rays(count, seed, reach=3.0):
    """Origins around the origin, directions of lengths 0.1 to 10 roughly towards it."""
    rng = random(seed)
    origins = rng.uniform(-reach, reach, (count, 3))
    return origins, (rng.uniform(-1, 1, (count, 3)) - origins) * 10 ** rng.uniform(-1, 1, (count, 1))


def soup(seed=2, count=200):
    return random(seed).uniform(-1, 1, (3 * count, 3)).astype(numpy.float32), numpy.arange(3 * count, dtype=numpy.uint32).reshape(-1, 3)


def meet_triangles(positions, faces, origins, directions):
    """t of each ray (row) and face (column), inf: none (Moeller and Trumbore 1997)."""
    a, b, c = (positions[faces[:, k]].astype(float) for k in range(3))
    result = numpy.full((len(origins), len(faces)), INF)
    for k in range(len(faces)):
        p = numpy.cross(directions, c[k] - a[k])
        with numpy.errstate(divide="ignore", invalid="ignore"):
            inverse = 1 / (p @ (b[k] - a[k]))
            u = ((origins - a[k]) * p).sum(1) * inverse
            q = numpy.cross(origins - a[k], b[k] - a[k])
            v = (directions * q).sum(1) * inverse
            t = q @ (c[k] - a[k]) * inverse
            met = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
        result[met, k] = t[met]
    return result


def meet_sphere(center, radius, origins, directions):
    """t of the two crossings, n x 2, inf: none."""
    o = origins - center
    a, b, c = (directions ** 2).sum(1), (o * directions).sum(1), (o ** 2).sum(1) - radius ** 2
    with numpy.errstate(invalid="ignore"):
        root = numpy.sqrt(b * b - a * c)
    t = numpy.stack([(-b - root) / a, (-b + root) / a], axis=1)
    return numpy.where(t > 0, t, INF)


def near(a, b, tolerance=1e-9):
    """Equal infinities, and numbers that differ by less than the tolerance, relative to those above 1."""
    a, b = numpy.asarray(a, float), numpy.asarray(b, float)
    with numpy.errstate(invalid="ignore"):
        return (a == b) | (numpy.abs(a - b) <= tolerance * numpy.maximum(1, numpy.abs(b)))


# ---- hits ----

@case
def triangles_as_by_brute_force():
    positions, faces = soup()
    scene = velo.Scene()
    scene.add_mesh(positions, faces)
    origins, directions = some_rays(20000, 3)
    hits = scene.world().trace(origins, directions)
    t = meet_triangles(positions, faces, origins, directions)
    best = t.argmin(1)
    met = numpy.isfinite(t.min(1))
    assert 3000 < met.sum() < 19000 and hits.met == met.sum() and (hits.valid == met).all()
    assert near(hits.t, t.min(1)).all()
    assert (hits.primitive_id == numpy.where(met, best + 1, 0)).all()
    assert (hits.object_id == met).all() and (hits.material_id == met).all() and (hits.instance_id == 0).all()
    length = numpy.linalg.norm(directions, axis=1)
    assert near(hits.distance, hits.t * length).all()
    rows = numpy.flatnonzero(met)
    assert near(hits.position[rows], origins[rows] + t.min(1)[rows, None] * directions[rows], 1e-8).all()
    a, b, c = (positions[faces[best[rows], k]].astype(float) for k in range(3))
    normal = unit(numpy.cross(b - a, c - a))
    assert near(hits.normal[rows], normal, 1e-4).all() and near(hits.shading_normal[rows], normal, 1e-4).all()
    assert not hits.velocity.any() and not hits.position[~met].any() and not hits.normal[~met].any()
    assert (hits.t[~met] == INF).all() and (hits.distance[~met] == INF).all()


@case
def uv_and_shading_normals_are_interpolated():
    positions = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], numpy.float32)
    normals = unit(numpy.array([[-1, 0, 1], [1, 0, 1], [0, 1, 1]])).astype(numpy.float32)
    uvs = numpy.array([[0, 0], [2, 0], [0, 3]], numpy.float32)
    scene = velo.Scene()
    scene.add_mesh(positions, [[0, 1, 2]], normals=normals, uvs=uvs)
    points = random(4).dirichlet((1, 1, 1), 500)
    hits = scene.world().trace(points @ positions + [0, 0, 2], [0, 0, -1])
    assert hits.valid.all() and near(hits.uv, points @ uvs, 1e-5).all()
    assert near(hits.shading_normal, unit(points @ normals), 1e-5).all() and near(hits.normal, [0, 0, 1], 1e-6).all()


@case
def a_sphere_as_by_its_formula():
    center, radius = numpy.array([0.2, -0.3, 0.1]), 0.8
    scene = velo.Scene()
    scene.add_sphere(center, radius)
    world = scene.world()
    origins, directions = some_rays(5000, 5, 1.5)
    hits = world.trace(origins, directions, hits=3)
    t = numpy.sort(meet_sphere(center, radius, origins, directions), axis=1)
    assert hits.t.shape == (5000, 3) and (hits.t[:, 2] == INF).all()
    clear = ~(numpy.isfinite(t[:, 1]) & (t[:, 1] < 1.01 * t[:, 0]))  # a ray that grazes it is uncertain
    assert clear.sum() > 4500 and near(hits.t[clear, :2], t[clear], 1e-6).all()
    first = hits.valid[:, 0]
    assert near(hits.normal[first, 0], unit(hits.position[first, 0] - center), 1e-5).all()


@case
def k_hits_are_all_of_them_in_order():
    positions, faces = soup(6, 60)
    scene = velo.Scene()
    scene.add_mesh(positions, faces)
    world = scene.world()
    origins, directions = some_rays(4000, 7)
    t = meet_triangles(positions, faces, origins, directions)
    order = numpy.argsort(t, axis=1)[:, :6]
    sorted_t = numpy.take_along_axis(t, order, 1)
    hits = world.trace(origins, directions, hits=6)
    apart = numpy.diff(numpy.where(numpy.isfinite(sorted_t), sorted_t, 1e30), axis=1)
    clear = ((apart > 1e-4) | (apart == 0)).all(1)
    assert clear.sum() > 3900 and (numpy.isfinite(sorted_t[:, 3])).sum() > 50
    assert near(hits.t[clear], sorted_t[clear]).all()
    assert (hits.primitive_id[clear] == numpy.where(numpy.isfinite(sorted_t), order + 1, 0)[clear]).all()
    assert hits.position.shape == (4000, 6, 3) and hits.met == hits.valid[:, 0].sum()
    one = world.trace(origins, directions)
    assert (one.t == hits.t[:, 0]).all() and (one.normal == hits.normal[:, 0]).all()


@case
def instances_are_placed_and_named():
    positions, faces = soup(8, 40)
    scene = velo.Scene()
    group = scene.add_group("soup")
    scene.add_mesh(positions, faces, group=group)
    poses = []
    for k in range(3):
        m = numpy.eye(4)
        m[:3, :3] = random(k).normal(size=(3, 3))
        m[:3, 3] = [2 * k - 2, 0.3, 0.1 * k]
        poses.append(m)
        scene.add_instance(group, m)
    origins, directions = some_rays(6000, 9, 5)
    hits = scene.world().trace(origins, directions)
    t = numpy.full((6000, 3, len(faces)), INF)
    for k, m in enumerate(poses):
        inverse = numpy.linalg.inv(m)
        t[:, k] = meet_triangles(positions, faces, origins @ inverse[:3, :3].T + inverse[:3, 3], directions @ inverse[:3, :3].T)
    flat = t.reshape(6000, -1)
    best, met = flat.argmin(1), numpy.isfinite(flat.min(1))
    same = (hits.instance_id == numpy.where(met, best // len(faces) + 1, 0)) & \
        (hits.primitive_id == numpy.where(met, best % len(faces) + 1, 0))
    assert met.sum() > 1000 and (~same).sum() <= 3 and near(hits.t, flat.min(1), 2e-5)[same].all()


# ---- motion ----

def turning(angle, shift):
    c, s = numpy.cos(angle), numpy.sin(angle)
    m = numpy.eye(4)
    m[:2, :2] = [[c, -s], [s, c]]
    m[:3, 3] = shift
    return m


@case
def each_ray_has_its_own_time():
    positions, faces = soup(10, 40)
    scene = velo.Scene()
    group = scene.add_group("soup")
    scene.add_mesh(positions, faces, group=group)
    scene.add_instance(group, [turning(0, (-1, 0, 0)), turning(0, (1, 0.5, 0))], [2.0, 4.0])
    world = scene.world()
    origins, directions = some_rays(4000, 11)
    times = random(12).uniform(1.5, 4.5, 4000)
    hits = world.trace(origins, directions, times=times)
    shift = numpy.array([-1, 0, 0]) + numpy.clip((times - 2) / 2, 0, 1)[:, None] * numpy.array([2, 0.5, 0])
    t = meet_triangles(positions, faces, origins - shift, directions)
    met = numpy.isfinite(t.min(1))
    same = hits.primitive_id == numpy.where(met, t.argmin(1) + 1, 0)
    assert met.sum() > 700 and (~same).sum() <= 3 and near(hits.t, t.min(1), 3e-5)[same].all()
    inside = hits.valid & (times > 2) & (times < 4)
    assert near(hits.velocity[inside], [1, 0.25, 0], 1e-5).all()
    single = world.trace(origins, directions, times=3)
    assert (single.t == world.trace(origins, directions, None, numpy.full(4000, 3.0)).t).all()


@case
def the_velocity_of_a_turning_wheel():
    """omega x r, with an angle of 2 radians in 0.5 seconds."""
    positions, faces = soup(13, 80)
    scene = velo.Scene()
    group = scene.add_group("wheel")
    scene.add_mesh(positions, faces, group=group)
    scene.add_instance(group, [turning(a, (0.5, 0, 0)) for a in (0, 1, 2)], [0, 0.25, 0.5])
    origins, directions = some_rays(4000, 14)
    times = random(15).uniform(0, 0.5, 4000)
    hits = scene.world().trace(origins, directions, times=times)
    r = hits.position - [0.5, 0, 0]
    expected = 4 * numpy.stack([-r[:, 1], r[:, 0], 0 * r[:, 0]], axis=1)
    error = numpy.linalg.norm(hits.velocity - expected, axis=1)[hits.valid]
    assert hits.valid.sum() > 700 and error.max() < 2e-3 * 4, error.max()


@case
def a_motion_with_a_bend_has_two_velocities():
    scene = velo.Scene()
    group = scene.add_group("ball")
    scene.add_sphere((0, 0, 0), 1, group=group)
    scene.add_instance(group, [turning(0, x) for x in ((0, 0, 0), (1, 0, 0), (1, 3, 0))], [0, 1, 2])
    times = numpy.linspace(0.01, 1.99, 40)
    origins = numpy.stack([numpy.clip(times, 0, 1), numpy.clip(3 * times - 3, 0, 3), 5 + 0 * times], axis=1)
    hits = scene.world().trace(origins, [0, 0, -1], times=times, fields=["valid", "velocity"])
    expected = numpy.where(times[:, None] < 1, [1, 0, 0], [0, 3, 0])
    assert hits.valid.all() and near(hits.velocity, expected, 1e-5).all()
    assert hits.t is None and hits.object_id is None


# ---- what passes ----

@case
def rays_pass_interfaces_and_cut_outs():
    quad = numpy.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], numpy.float32)
    scene = velo.Scene()
    nothing = scene.add_material("interface")
    scene.add_mesh(quad + [0, 0, 3], [[0, 1, 2], [0, 2, 3]], material=nothing)
    scene.add_mesh(quad + [0, 0, 2], [[0, 1, 2], [0, 2, 3]], alpha=0)
    scene.add_mesh(quad + [0, 0, 1], [[0, 1, 2], [0, 2, 3]], alpha=0.25)
    scene.add_mesh(quad, [[0, 1, 2], [0, 2, 3]])
    world = scene.world()
    rng = random(16)
    origins = numpy.concatenate([rng.uniform(-0.9, 0.9, (20000, 2)), numpy.full((20000, 1), 5.0)], axis=1)
    hits = world.trace(origins, (0, 0, -1))
    share = (hits.object_id == 3).mean()
    assert hits.valid.all() and set(hits.object_id) == {3, 4} and abs(share - 0.25) < 0.015, share
    assert (hits.object_id == world.trace(origins, (0, 0, -1)).object_id).all()
    stopped = world.occluded(origins, (0, 0, -1), t_max=4.5)
    assert (stopped == (hits.object_id == 3)).all()
    assert near(numpy.sort(numpy.unique(hits.t)), [4, 5], 1e-6).all()


@case
def the_ends_of_rays():
    quad = numpy.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], numpy.float32)
    scene = velo.Scene()
    scene.add_mesh(quad, [[0, 1, 2], [0, 2, 3]])
    world = scene.world()
    origin = numpy.array([0.1, 0.2, 1.0])
    for length in (1, 2.5, 1e-8, 1e8):
        direction = numpy.array([0, 0, -length])
        for t_max, met in ((0.999 / length, False), (1.001 / length, True), (INF, True), (-1, False), (0, False)):
            assert world.trace(origin, direction, t_max).valid[0] == met, (length, t_max)
            assert world.occluded(origin, direction, t_max)[0] == met, (length, t_max)
        for t_min, met in ((0.999 / length, True), (1.001 / length, False), (-5, True)):
            assert world.trace(origin, direction, t_min=t_min).valid[0] == met
            assert world.occluded(origin, direction, t_min=t_min)[0] == met
    hits = world.trace(origin, [0, 0, -1], t_max=1)
    assert hits.valid[0] and hits.t[0] == 1  # the end belongs to the ray
    targets = random(17).uniform(-0.5, 0.5, (100, 3))
    hidden = world.occluded(origin, targets - origin, t_max=1)
    assert (hidden == (targets[:, 2] < 0)).all()


# ---- arrays ----

@case
def arrays_of_any_form():
    positions, faces = soup(18, 40)
    scene = velo.Scene()
    scene.add_mesh(positions, faces)
    world = scene.world()
    origins, directions = some_rays(600, 19)
    origins, directions = origins.astype(numpy.float32), directions.astype(numpy.float32)
    plain = world.trace(origins, directions)
    both = numpy.concatenate([origins, directions], axis=1)
    backwards = world.trace(both[::-1, :3], both[::-1, 3:])
    forms = {"float64": (origins.astype(float), directions.astype(float)), "mixed": (origins.astype(float), directions),
             "rows of 6": (both[:, :3], both[:, 3:]), "columns first": (numpy.asfortranarray(origins), numpy.asfortranarray(directions)),
             "lists": (origins.tolist(), directions.tolist())}
    with cases.raises(velo.UsageError, "origins"):
        world.trace(origins.astype(">f4"), directions)
    for name, (a, b) in forms.items():
        hits = world.trace(a, b)
        assert (hits.t == plain.t).all() and (hits.primitive_id == plain.primitive_id).all(), name
    assert (backwards.t[::-1] == plain.t).all()
    image = world.trace(origins.reshape(20, 30, 3), directions.reshape(20, 30, 3), hits=2)
    assert image.t.shape == (20, 30, 2) and image.uv.shape == (20, 30, 2, 2) and (image.t[..., 0].ravel() == plain.t).all()
    one = world.trace(origins[0], directions)
    assert (one.t == world.trace(numpy.broadcast_to(origins[0], (600, 3)), directions).t).all() and one.t.shape == (600,)
    whole = numpy.arange(-3, 3).reshape(2, 3)
    assert (world.trace(whole, whole[::-1]).t == world.trace(whole.astype(float), whole[::-1].astype(float)).t).all()
    for shape in ((0, 3), (4, 0, 3)):
        none = world.trace(numpy.zeros(shape), numpy.zeros(shape))
        assert none.t.size == 0 and none.met == 0 and none.position.shape[-1] == 3
    assert plain.t.dtype == numpy.float64 and plain.valid.dtype == bool and plain.object_id.dtype == numpy.uint32


@case
def what_is_wrong_is_named():
    scene = velo.Scene()
    scene.add_sphere((0, 0, 0), 1)
    world = scene.world()
    three = numpy.zeros((3, 3)) + 1
    for call, texts in ((lambda: world.trace(three[:, :2], three), ("origins", "3 numbers")),
                        (lambda: world.trace(three, three[:2]), ("directions has 2 rows", "origins has 3")),
                        (lambda: world.trace(three, three, t_max=[1, 2]), ("t_max has 2 rows",)),
                        (lambda: world.trace(three, three, hits=0), ("hits", "1 to 256")),
                        (lambda: world.trace(three, three, hits=257), ("hits", "1 to 256")),
                        (lambda: world.trace(three, three, fields=["positon"]), ("positon", "position")),
                        (lambda: world.trace(three, three, fields="t"), ("fields",)),
                        (lambda: world.occluded("abc", three), ("origins",)),
                        (lambda: world.occluded(three, None), ("directions",))):
        with cases.raises(velo.UsageError, *texts):
            call()
    huge = numpy.broadcast_to(three[0], (10 ** 11, 3))
    with cases.raises(velo.OutOfMemoryError, "GB"):
        world.trace(huge, huge)
    world.close()
    with cases.raises(velo.UsageError, "closed"):
        world.trace(three, three)


@case
def rays_that_are_none_are_counted():
    scene = velo.Scene()
    scene.add_sphere((0, 0, 0), 1)
    world = scene.world()
    origins = numpy.tile([0.0, 0, 5], (12, 1))
    directions = numpy.tile([0.0, 0, -1], (12, 1))
    t_max, times = numpy.full(12, INF), numpy.zeros(12)
    origins[1, 2], origins[2, 0], origins[3, 1] = numpy.nan, INF, 1e30
    directions[4], directions[5, 1], directions[6, 2] = 0, numpy.nan, -INF
    t_max[7], times[8], times[9] = numpy.nan, numpy.nan, INF
    bad = [1, 2, 3, 4, 5, 6, 7, 8, 9]
    with warned() as notes:
        hits = world.trace(origins, directions, t_max, times, hits=2)
        hidden = world.occluded(origins, directions, t_max, times)
    assert (hits.met, hits.not_finite, hits.zero_directions, hits.too_far) == (3, 7, 1, 1)
    assert not hits.valid[bad].any() and (hits.t[bad] == INF).all() and not hidden[bad].any()
    assert hits.valid[[0, 10, 11]].all() and hidden[[0, 10, 11]].all()
    assert len(notes) == 2 and all(note.category is RuntimeWarning for note in notes)
    assert "of 12 rays, 7 have a number that is not finite, 1 have the direction 0 0 0" in str(notes[0].message)
    assert notes[0].filename == __file__, notes[0].filename


# ---- bits ----

MOVING = """
import hashlib, sys
import numpy, velo
velo.set_threads(int(sys.argv[1]))
rng = numpy.random.default_rng(20)
scene = velo.Scene()
group = scene.add_group("g")
scene.add_mesh(rng.uniform(-1, 1, (900, 3)), numpy.arange(900).reshape(-1, 3), group=group)
scene.add_sphere((0, 0, 0), 0.4, group=group)
a, b = numpy.eye(4), numpy.eye(4)
b[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
scene.add_instance(group, [a, b], [0, 1])
world = scene.world()
origins, directions = rng.uniform(-2, 2, (5000, 3)), rng.normal(size=(5000, 3))
origins[1000:3000], directions[1000:3000] = (0, 0, 3), (0, 0, -1) + 0.03 * rng.normal(size=(2000, 3))  # traced in packets
hits = world.trace(origins, directions, times=rng.uniform(0, 1, 5000), hits=3)
digest = hashlib.sha256()
for field in hits[:12]:
    digest.update(field.tobytes())
digest.update(world.occluded(origins, directions, t_max=0.7).tobytes())
print(digest.hexdigest())
"""


@case
def the_same_bits_everywhere():
    found = set()
    for threads, isa, embree in (("1", "", ""), ("2", "", ""), ("2", "v2", "sse4.2"), ("1", "v3", ""), ("2", "base", "")):
        environment = {**os.environ, "VELO_ISA": isa, "VELO_EMBREE": embree}
        done = subprocess.run([sys.executable, "-c", MOVING, threads], env=environment, capture_output=True, text=True)
        if done.returncode != 0 and "does not have" in done.stderr:
            continue
        assert done.returncode == 0, done.stderr
        found.add(done.stdout)
    assert len(found) == 1, found


@case
def fields_alone_have_the_same_bits():
    positions, faces = soup(21, 60)
    scene = velo.Scene()
    scene.add_mesh(positions, faces)
    world = scene.world()
    origins, directions = some_rays(3000, 22)
    whole = world.trace(origins, directions, t_max=2, hits=2)
    for name in velo.RayHits._fields[:12]:
        alone = world.trace(origins, directions, t_max=2, hits=2, fields=[name])
        digests = [hashlib.sha256(getattr(hits, name).tobytes()).digest() for hits in (whole, alone)]
        assert digests[0] == digests[1], name


if __name__ == "__main__":
    cases.main()
