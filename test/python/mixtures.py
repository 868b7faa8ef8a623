"""Random scenes of what pbrt files cannot say, beside what they can: lamps of the material interface, shapes hidden from the camera, all
materials with random parameters, alpha, media with temperatures, motion. Each follows from its number."""
import math
import random

import numpy

import velo

WIDTH, HEIGHT = 32, 24
TO_A_POINT = ("point", "spot", "distant", "goniometric", "projection")  # lights that no ray hits: behind smooth glass only light paths find them
CORNERS = numpy.array([[0.4, 0, -0.3], [-0.2, 0.35, -0.3], [-0.2, -0.35, -0.3], [0, 0, 0.4]])  # of a tetrahedron
FACES = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
CLOSE = {"eye": (0, -1.2, 1.2), "lookat": (0, 0, 0.5)}
CAMERAS = (("orthographic", {"fx": 11.0, "fy": 11.0}), ("equidistant", {"fov": 3.0, **CLOSE}), ("equirectangular", CLOSE),
           ("panini", {"fov": 2.4, **CLOSE}), ("double_sphere", {"xi": -0.2, "alpha": 0.6, "fx": 14.0, "fy": 14.0, **CLOSE}),
           ("cylindrical", {"fov": 2.0, **CLOSE}), ("equal_area", CLOSE),
           ("perspective", {"fov": 0.8, "distortion": "opencv", "distortion_coefficients": [-0.2, 0.05, 0.01, -0.01]}),
           ("perspective", {"fov": 0.75, "lens_radius": 0.2, "blades": 5, "ratio": 1.8, "focus_distance": 4.0}),
           ("perspective", {"fov": 1.2, "vignetting": True, **CLOSE}))


class Mixture:
    """scene; depth: the greatest number of bounces; parts: what is in it, in words; smooth: a surface is a mirror or clear; pointed: a light is
    one that no ray hits."""

    def __init__(self, number):
        self._random = random.Random(number)
        self.scene, self.parts, self.smooth, self.pointed = velo.Scene(), [], False, False
        self._may_be_smooth, self._foggy = self._chance(0.25), self._chance(0.5)
        self.scene.add_mesh([[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], [[0, 1, 2], [0, 2, 3]],
                            uvs=[[0, 0], [1, 0], [1, 1], [0, 1]], material=self._material(), name="floor")
        for _ in range(self._random.randint(1, 3)):
            self._random.choice([self._light, self._lamp])()
        for _ in range(self._random.randint(2, 4)):
            (self._fog if self._foggy and self._chance(0.3) else self._thing)()
        self._camera()
        self.depth = self._random.choice([2, 5, 8])

    # ---- numbers ----

    def _chance(self, share):
        return self._random.random() < share

    def _between(self, low, high):
        return self._random.uniform(low, high)

    def _color(self, low=0.1, high=0.9):
        return tuple(self._between(low, high) for _ in range(3))

    def _texels(self, *shape):
        return numpy.random.default_rng(self._random.getrandbits(30)).random(shape, dtype=numpy.float32)

    def _pose(self):
        q = numpy.array([self._random.gauss(0, 1) for _ in range(4)])
        w, x, y, z = q / numpy.linalg.norm(q)
        pose = numpy.eye(4)
        pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        pose[:3, :3] *= [self._between(0.6, 1.5) * (-1 if self._chance(0.05) else 1) for _ in range(3)]
        pose[:3, 3] = self._between(-0.9, 0.9), self._between(-0.9, 0.9), self._between(0.4, 1.1)
        return pose

    def _pose_at(self, position):
        pose = self._pose()
        pose[:3, 3] = position
        return pose

    # ---- materials ----

    def _roughness(self):
        if self._may_be_smooth and self._chance(0.5):
            self.smooth = True
            return 0.0
        return self._between(0.05, 0.6)

    def _spectrum(self):
        kind = self._random.choice(["plain", "plain", "image", "checkerboard", "dots"])
        if kind == "plain":
            return self._color()
        if kind == "image":
            return self.scene.add_texture("image", image=0.9 * self._texels(8, 8, 3))
        colors = {"spectrum_a": self._color(), "spectrum_b": self._color()}
        return self.scene.add_texture(kind, su=4, sv=4, **colors)

    def _number(self):
        if self._chance(0.5):
            return self._between(0.1, 0.9)
        return self.scene.add_texture("dots", su=5, sv=5, float_a=self._between(0, 1), float_b=self._between(0, 1), spectrum=False)

    def _principled(self):
        words = {"reflectance": self._spectrum(), "roughness": self._roughness()}
        for name in ("metallic", "transmission", "clearcoat", "anisotropy", "diffuse_transmission", "iridescence"):
            if self._chance(0.3):
                words[name] = self._random.choice([1.0, self._between(0, 1)])
        if self._chance(0.3):
            words.update(sheen_color=self._color(0, 1), sheen_roughness=self._between(0.1, 1))
        if self._chance(0.3):
            words.update(specular=self._between(0, 2), specular_color=self._color(0, 1))
        if "transmission" in words:
            words.update(thin_walled=self._chance(0.4), dispersion=self._between(0, 1))
        if "clearcoat" in words:
            words["clearcoat_roughness"] = self._roughness()
        return self.scene.add_material("principled", **words)

    def _material(self, depth=0):
        add = self.scene.add_material
        kind = self._random.choice(["diffuse", "principled", "principled", "mix", "thindielectric", "dielectric", "coateddiffuse",
                                    "coatedconductor", "conductor", "subsurface", "diffusetransmission", "layers", "hair", "bumps"])
        self.parts.append(kind)
        if kind == "mix" and depth < 2:
            return add("mix", materials=[self._material(depth + 1), self._material(depth + 1)], amount=self._number())
        if kind == "principled":
            return self._principled()
        if kind == "thindielectric":
            self.smooth = True
            return add(kind, eta=self._between(1.2, 2))
        if kind == "dielectric":
            return add(kind, eta=self._random.choice([1.3, "glass-SF11"]), roughness=self._roughness())
        if kind == "coateddiffuse":
            return add(kind, reflectance=self._color(), roughness=self._roughness())
        if kind == "coatedconductor":
            return add(kind, coat_u_roughness=self._roughness(), coat_v_roughness=self._roughness(), u_roughness=self._roughness(),
                       v_roughness=self._roughness())
        if kind == "conductor":
            return add(kind, eta="metal-Au-eta", k="metal-Au-k", u_roughness=self._roughness(), v_roughness=self._roughness())
        if kind == "subsurface":
            return add(kind, mfp=self._color(0.02, 0.2), reflectance=self._color(), roughness=self._roughness())
        if kind == "diffusetransmission":
            return add(kind, reflectance=self._color(0.1, 0.5), transmittance=self._color(0.1, 0.5))
        if kind == "layers":
            return add("coateddiffuse", reflectance=self._spectrum(), roughness=self._roughness(), thickness=self._between(0.01, 1),
                       g=self._between(-0.5, 0.8), albedo=self._color())
        if kind == "hair":
            return add("hair", sigma_a=self._color(0.1, 3), beta_m=self._between(0.2, 0.9), beta_n=self._between(0.2, 0.9))
        if kind == "bumps":
            height = self.scene.add_texture("image", image=0.05 * self._texels(8, 8), spectrum=False)
            if self._chance(0.5):
                return add("conductor", u_roughness=0.2, v_roughness=0.3, displacement=height)
            return add("diffuse", displacement=height)
        return add("diffuse", reflectance=self._spectrum())

    # ---- light ----

    def _light(self):
        kind = self._random.choice([*TO_A_POINT, "infinite", "sky", "portal"])
        self.parts.append("light " + kind)
        self.pointed = self.pointed or kind in TO_A_POINT
        if kind == "point":
            self.scene.add_light(kind, position=(self._between(-2, 2), self._between(-2, 2), 2.5), color=self._color(5, 9))
        elif kind == "spot":
            self.scene.add_light(kind, position=(1, -1.5, 3), to=(0, 0, 0.3), cone_angle=0.7, cone_delta=self._between(0.05, 0.35),
                                 cone_squared=self._chance(0.5), color=self._color(9, 20))
        elif kind == "distant":
            self.scene.add_light(kind, position=(self._between(-1, 1), self._between(-1, 1), 1), to=(0, 0, 0), color=self._color(0.5, 2))
        elif kind == "goniometric":
            self.scene.add_light(kind, position=(self._between(-1, 1), self._between(-1, 1), 2.5), image=self._texels(16, 16),
                                 color=self._color(5, 20))
        elif kind == "projection":
            down = [[1, 0, 0, self._between(-0.5, 0.5)], [0, -1, 0, self._between(-0.5, 0.5)], [0, 0, -1, 3], [0, 0, 0, 1]]
            self.scene.add_light(kind, pose=down, image=self._texels(6, 9, 3), fov=self._between(0.5, 1.2), scale=self._between(10, 30))
        elif kind == "infinite":
            self.scene.add_light(kind, color=self._color(0.2, 0.6))
        elif kind == "portal":  # things may stand on both sides of it
            half, height = self._between(0.5, 1.5), self._between(0.8, 3)
            corners = [[-half, 1, height], [half, 1, height], [half, -1, height], [-half, -1, height]]
            self.scene.add_light("infinite", image=3 * self._texels(16, 16, 3) ** 2, portal=corners)
        else:
            self.scene.add_light("infinite", image=3 * self._texels(16, 16, 3) ** 4)

    def _lamp(self):
        """A shape that emits: a body or, of the material interface, one that light passes."""
        emission = {"radiance": self._color(2, 8), "two_sided": self._chance(0.4)}
        if self._chance(0.4):
            emission["spread"] = math.radians(self._random.choice([30, 60, 100, 170]))
        if self._chance(0.25):
            emission["texture"] = self.scene.add_texture("image", image=self._texels(4, 4, 3))
        passed = self._chance(0.5)
        words = {"emission": self.scene.add_emission(**emission), "hidden_from_camera": self._chance(0.4),
                 "reverse_orientation": self._chance(0.2)}
        if passed:
            words["material"] = self.scene.add_material("interface")
        at = self._between(-1, 1), self._between(-1, 1), self._between(0.7, 2.2) if passed else self._between(1.6, 2.6)
        down = self._between(-0.4, 0.4), self._between(-0.4, 0.4), -1
        shape = self._random.choice(["plane", "disk", "sphere", "box", "bilinear", "part of a sphere", "ring"])
        self.parts.append("%s that emits%s%s" % (shape, ", passed" if passed else "", ", hidden" if words["hidden_from_camera"] else ""))
        if shape == "plane":
            self.scene.add_plane(at, down, 1, 1, **words)
        elif shape == "disk":
            self.scene.add_disk(at, 0.6, down, **words)
        elif shape == "sphere":
            self.scene.add_sphere(at, 0.3, **words)
        elif shape == "bilinear":
            corners = numpy.add(at, [[-0.5, -0.4, 0], [0.5, -0.5, 0.2], [-0.4, 0.5, 0], [0.6, 0.4, -0.3]])
            self.scene.add_shape(shape, positions=corners, indices=[[0, 1, 2, 3]], **words)
        elif shape == "part of a sphere":
            self.scene.add_shape("sphere", radius=0.4, z_min=-0.3, z_max=0.2, phi_max=4.0, pose=self._pose_at(at), **words)
        elif shape == "ring":
            self.scene.add_shape("disk", radius=0.5, inner_radius=0.2, phi_max=5.0, pose=self._pose_at(at), **words)
        else:
            self.scene.add_box(at, [x + 0.4 for x in at], **words)

    # ---- things ----

    def _fog(self):
        add, kind = self.scene.add_medium, self._random.choice(["homogeneous", "emissive", "grid", "hot grid", "cloud"])
        self.parts.append("medium " + kind)
        cells = 2 * self._texels(5, 5, 5)
        grid = {"density": cells, "low": (-0.6, -0.6, -0.6), "high": (0.6, 0.6, 0.6), "sigma_a": self._color(0, 0.6),
                "sigma_s": self._color(0.2, 2), "g": self._between(-0.3, 0.5)}
        if kind == "homogeneous":
            medium = add(kind, sigma_a=self._color(0, 0.6), sigma_s=self._color(0.2, 1.5), g=self._between(-0.5, 0.7))
        elif kind == "emissive":
            medium = add("homogeneous", sigma_a=self._color(0.1, 0.6), sigma_s=self._color(0.2, 1), emission=self._color(0.1, 1))
        elif kind == "grid":
            medium = add("grid", **grid)
        elif kind == "hot grid":
            medium = add("grid", temperature=1000 * cells + 500, emission_scale=0.02, **grid)
        else:
            medium = add("cloud", sigma_s=(5, 5, 5), sigma_a=(0.1, 0.1, 0.1), cloud_density=2, frequency=3)
        glass = self._chance(0.3)
        skin = self.scene.add_material("dielectric", eta=1.3, roughness=0.2) if glass else self.scene.add_material("interface")
        self.scene.add_sphere((0, 0, 0), self._between(0.3, 0.6), pose=self._pose(), material=skin, inside=medium)

    def _thing(self):
        words = {"material": self._material(), "hidden_from_camera": self._chance(0.2), "reverse_orientation": self._chance(0.1)}
        if self._chance(0.2):
            words["alpha"] = self._number()
        kind = self._random.choice(["sphere", "cylinder", "box", "leaf", "moving", "instances", "hairs", "smooth", "displaced", "one in another"])
        if kind not in ("instances", "hairs") and self._chance(0.1):
            words["emission"] = self.scene.add_emission(radiance=self._color(0.2, 1), two_sided=self._chance(0.5))
        self.parts.append("%s%s" % (kind, ", hidden" if words["hidden_from_camera"] else ""))
        pose = self._pose()
        if kind == "sphere":
            self.scene.add_sphere((0, 0, 0), self._between(0.2, 0.45), pose=pose, **words)
        elif kind == "cylinder":
            self.scene.add_cylinder((0, 0, -0.4), (0, 0, 0.4), 0.25, pose=pose, **words)
        elif kind == "box":
            self.scene.add_box((-0.3, -0.25, -0.2), (0.3, 0.25, 0.2), pose=pose, **words)
        elif kind == "leaf":
            self.scene.add_plane((0, 0, 0), (0, 0, 1), 1, 1, pose=pose, **words)
        elif kind == "moving":
            self.scene.add_mesh(CORNERS, FACES, positions_close=CORNERS + [0.2, 0, 0.1], pose=pose, **words)
        elif kind == "smooth":
            self.scene.add_mesh(CORNERS, FACES, normals=CORNERS / numpy.linalg.norm(CORNERS, axis=1)[:, None], pose=pose, **words)
        elif kind == "displaced":
            height = self.scene.add_texture("image", image=0.2 * self._texels(5, 5), spectrum=False)
            self.scene.add_mesh([[-0.4, -0.4, 0], [0.4, -0.4, 0], [0.4, 0.4, 0], [-0.4, 0.4, 0]], [[0, 1, 2], [0, 2, 3]],
                                uvs=[[0, 0], [1, 0], [1, 1], [0, 1]], displacement=height, edge_length=0.1, pose=pose, **words)
        elif kind == "hairs":
            steps = numpy.cumsum(0.4 * (self._texels(12, 4, 3) - [0.5, 0.5, 0]), axis=1)
            for points in steps:
                self.scene.add_shape("curves", positions=points, widths=[[0.05, 0.03]], pose=pose, **words)
        elif kind == "one in another":
            fog = self.scene.add_medium("homogeneous", sigma_a=self._color(0, 0.5), sigma_s=self._color(0.1, 1.5), g=self._between(-0.3, 0.6))
            glass = self.scene.add_material("dielectric", eta=1.3, roughness=0.25)
            self.scene.add_sphere((0, 0, 0), 0.45, pose=pose, material=glass, inside=fog)
            self.scene.add_sphere((0, 0, 0), 0.2, pose=pose, **words)
        else:
            group = self.scene.add_group("ball")
            self.scene.add_sphere((0, 0, 0), 0.3, group=group, **words)
            for step in (0, 0.35):
                moved = pose.copy()
                moved[:3, 3] += step
                self.scene.add_instance(group, moved)

    def _camera(self):
        words = {"eye": (0, -4, 2), "lookat": (0, 0, 0.4), "up": (0, 0, 1), "shutter_open": 0.0, "shutter_close": 1.0}
        if self._chance(0.4):
            words["projection"], more = self._random.choice(CAMERAS)
            words.update(more)
        else:
            words["fov"] = 0.75
            if self._chance(0.3):
                words.update(lens_radius=0.08, focus_distance=4.0)
            if self._chance(0.3):
                words.update(eye_close=(0.2, -4, 2.1), lookat_close=(0, 0, 0.4), up_close=(0, 0, 1), readout=self._random.choice([0, 0.7]))
        self.parts.append("camera " + words.get("projection", "perspective"))
        self.scene.camera = velo.Camera(WIDTH, HEIGHT, **words)
        if self._foggy and self._chance(0.2):
            self.parts.append("camera in fog")
            self.scene.camera_medium = self.scene.add_medium("homogeneous", sigma_a=self._color(0, 0.05), sigma_s=self._color(0.02, 0.15),
                                                             g=self._between(-0.3, 0.6))

    # ---- edits ----

    def edit(self):
        """A random change of the scene. Of what the scene refuses nothing is changed."""
        change = self._random.choice([self._add, self._camera, self._place, self._show, self._remove, self._change_shape, self._change_number])
        try:
            change()
        except velo.Error:
            pass

    def _one(self, *families):
        handles = self.scene.handles(self._random.choice(families))
        return self._random.choice(handles) if handles else None

    def _add(self):
        self._random.choice([self._thing, self._lamp, self._light, self._fog])()

    def _place(self):
        instance, group = self._one("instances"), self._one("groups")
        if instance and self._chance(0.5):
            self.scene.set(instance, pose=self._pose())
        elif group:
            self.scene.add_instance(group, self._pose())

    def _show(self):
        handle = self._one("lights", "shapes", "instances")
        if handle:
            self.scene.show(handle, self._chance(0.4))

    def _remove(self):
        handle = self._one("lights", "shapes", "instances", "materials", "textures", "media", "emission", "groups")
        if handle:
            self.scene.remove(handle)

    def _change_shape(self):
        shape, choice = self._one("shapes"), self._random.randrange(5)
        if shape is None:
            return
        words = [{"material": self._one("materials")}, {"emission": self._one("emission")}, {"pose": self._pose()},
                 {"hidden_from_camera": self._chance(0.5)}][choice % 4]
        if choice == 4 and shape.kind == "triangles":
            words = {"positions": self.scene.mesh(shape).positions * numpy.float32(self._between(0.7, 1.3))}
        self.scene.set(shape, **words)

    def _change_number(self):
        handle = self._one("materials", "materials", "lights", "textures", "emission", "media")
        if handle is None:
            return
        if handle.family == "materials" and self._chance(0.4):
            self.scene.set(handle, self._random.choice(["diffuse", "conductor", "principled", "dielectric", "interface", "coateddiffuse"]))
            return
        if handle.kind == "image":
            self.scene.set(handle, image=0.5 * (self._texels(6, 6, 3) if self.scene.get(handle, "spectrum") else self._texels(6, 6)))
            return
        numbers = {name: value for name, value in self.scene.get(handle).items() if isinstance(value, float) and math.isfinite(value)}
        if numbers:
            name = self._random.choice(list(numbers))
            self.scene.set(handle, **{name: numbers[name] * self._between(0.8, 1.1)})
