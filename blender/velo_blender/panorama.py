"""panorama.py: the panoramas of Cycles as cameras of velo's user: film points to directions and back.

A film point (u, v) runs from 0 to 1 across the image, v upwards, whatever the image's shape, as in Cycles (kernel/camera/projection.h).
Directions in Cycles' panorama space (x forward, y left, z up) become velo's (x right, y down, z forward)."""
import math

import numpy
import velo

from . import versions
from .report import Refused


def _to_velo(x, y, z):
    return numpy.stack((-y, -z, x), axis=1)


def _from_velo(points):
    length = numpy.maximum(numpy.linalg.norm(points, axis=1), 1e-300)
    return points[:, 2] / length, -points[:, 0] / length, -points[:, 1] / length


class Equirectangular:
    """Longitude and latitude between limits, radians."""
    name = "blender-equirectangular"

    def __init__(self, settings, sensor):
        # Cycles' longitudes run from left to right, its angle phi the other way.
        self.longitude = -settings.longitude_min, -settings.longitude_max
        self.latitude = settings.latitude_min, settings.latitude_max

    def directions(self, u, v):
        phi = self.longitude[0] + u * (self.longitude[1] - self.longitude[0])
        theta = self.latitude[0] + v * (self.latitude[1] - self.latitude[0])
        return numpy.cos(theta) * numpy.cos(phi), numpy.cos(theta) * numpy.sin(phi), numpy.sin(theta)

    def points(self, x, y, z):
        phi = numpy.arctan2(y, x)
        theta = numpy.arcsin(numpy.clip(z, -1, 1))
        u = (phi - self.longitude[0]) / (self.longitude[1] - self.longitude[0])
        v = (theta - self.latitude[0]) / (self.latitude[1] - self.latitude[0])
        return u, v


class _Fisheye:
    """A map between the angle from the axis and a radius in the image, the same in all directions."""

    def radius_of(self, u, v):
        """(across, up, radius) in the unit in which the map has its radius."""
        raise NotImplementedError

    def directions(self, u, v):
        across, up, radius = self.radius_of(u, v)
        theta, valid = self.angle(radius)
        safe = numpy.maximum(radius, 1e-300)
        sine = numpy.where(valid, numpy.sin(theta), 0.0)
        return numpy.where(valid, numpy.cos(theta), 0.0), -sine * across / safe, sine * up / safe

    def points(self, x, y, z):
        theta = numpy.arctan2(numpy.hypot(y, z), x)
        radius, valid = self.radius(theta)
        side = numpy.maximum(numpy.hypot(y, z), 1e-300)
        u, v = self.film(-y / side * radius, z / side * radius)
        return numpy.where(valid, u, numpy.nan), numpy.where(valid, v, numpy.nan)


class Equidistant(_Fisheye):
    """r = theta; the circle of the field of view touches all four edges."""
    name = "blender-fisheye-equidistant"

    def __init__(self, settings, sensor):
        self.fov = settings.fisheye_fov

    def radius_of(self, u, v):
        across, up = 2 * u - 1, 2 * v - 1
        return across, up, numpy.hypot(across, up)

    def angle(self, radius):
        return 0.5 * radius * self.fov, radius <= 1

    def radius(self, theta):
        radius = 2 * theta / self.fov
        return radius, radius <= 1

    def film(self, across, up):
        return 0.5 * (across + 1), 0.5 * (up + 1)


class _OnSensor(_Fisheye):
    """Radii in millimetres on the sensor."""

    def radius_of(self, u, v):
        across, up = (u - 0.5) * self.sensor[0], (v - 0.5) * self.sensor[1]
        return across, up, numpy.hypot(across, up)

    def film(self, across, up):
        return across / self.sensor[0] + 0.5, up / self.sensor[1] + 0.5


class Equisolid(_OnSensor):
    """r = 2 f sin(theta / 2), millimetres."""
    name = "blender-fisheye-equisolid"

    def __init__(self, settings, sensor):
        self.focal, self.fov, self.sensor = settings.fisheye_lens, settings.fisheye_fov, sensor

    def angle(self, radius):
        limit = 2 * self.focal * math.sin(0.25 * self.fov)
        return 2 * numpy.arcsin(numpy.clip(radius / (2 * self.focal), -1, 1)), radius <= limit

    def radius(self, theta):
        return 2 * self.focal * numpy.sin(0.5 * theta), theta <= 0.5 * self.fov


class Polynomial(_OnSensor):
    """theta = -(k0 + k1 r + k2 r^2 + k3 r^3 + k4 r^4), r in millimetres."""
    name = "blender-fisheye-polynomial"

    def __init__(self, settings, sensor):
        self.k = [getattr(settings, "fisheye_polynomial_k%d" % i) for i in range(5)]
        self.fov, self.sensor = settings.fisheye_fov, sensor

    def _theta(self, radius):
        k = self.k
        return -(k[0] + radius * (k[1] + radius * (k[2] + radius * (k[3] + radius * k[4]))))

    def angle(self, radius):
        theta = self._theta(radius)
        return theta, numpy.abs(theta) <= 0.5 * self.fov

    def radius(self, theta):
        k = self.k
        radius = numpy.full_like(theta, 0.5 * max(self.sensor))
        for _ in range(60):
            slope = -(k[1] + radius * (2 * k[2] + radius * (3 * k[3] + radius * 4 * k[4])))
            slope = numpy.where(numpy.abs(slope) < 1e-9, 1e-9, slope)
            radius = numpy.maximum(radius - (self._theta(radius) - theta) / slope, 0.0)
        valid = (numpy.abs(self._theta(radius) - theta) < 1e-9) & (numpy.abs(theta) <= 0.5 * self.fov)
        return radius, valid


class MirrorBall:
    """What a mirroring ball shows from far away."""
    name = "blender-mirror-ball"

    def __init__(self, settings, sensor):
        pass

    def directions(self, u, v):
        x, z = 2 * u - 1, 2 * v - 1
        inside = x * x + z * z <= 1
        y = -numpy.sqrt(numpy.maximum(1 - x * x - z * z, 0))
        # The reflection of (0, 1, 0) at the ball; the space is turned by 90 degrees.
        dx, dy, dz = (numpy.where(inside, part, 0.0) for part in (-2 * y * x, 1 - 2 * y * y, -2 * y * z))
        return dy * -1, dx * -1, dz

    def points(self, x, y, z):
        dx, dy, dz = -y, -x, z
        length = numpy.sqrt(numpy.maximum(2 * (1 - dy), 1e-300))
        return 0.5 * (dx / length + 1), 0.5 * (dz / length + 1)


KINDS = {"EQUIRECTANGULAR": Equirectangular, "FISHEYE_EQUIDISTANT": Equidistant, "FISHEYE_EQUISOLID": Equisolid,
         "FISHEYE_LENS_POLYNOMIAL": Polynomial, "MIRRORBALL": MirrorBall}


def sensor_size(camera, size):
    """Width and height of the sensor that the image covers, millimetres (Cycles' blender_camera_viewplane)."""
    width, height = size
    horizontal = camera.sensor_fit == "HORIZONTAL" or (camera.sensor_fit == "AUTO" and width >= height)
    along = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    return (along, along * height / width) if horizontal else (along * width / height, along)


def convert(camera, size, words):
    """velo's camera of a panorama. words: the pose."""
    settings = versions.panorama(camera)
    if settings is None:
        raise Refused("camera %s: a panorama needs the settings of Cycles, which is not enabled" % camera.name)
    kind = KINDS.get(settings.panorama_type)
    if kind is None:
        raise Refused("camera %s: velo has no panorama %s" % (camera.name, settings.panorama_type))
    model = kind(settings, sensor_size(camera, size))
    shift_u, shift_v = camera.shift_x, camera.shift_y  # shares of the width and of the height

    def rays(film):
        return _to_velo(*model.directions(film.x / film.width + shift_u, 1 - film.y / film.height + shift_v))

    def pixels(points, width, height):
        u, v = model.points(*_from_velo(points))
        return numpy.stack(((u - shift_u) * width, (1 - v + shift_v) * height), axis=1)

    own = velo.OwnCamera(rays, name=model.name, pixels=pixels)
    return velo.Camera(*size, own=own, near_plane=float(camera.clip_start), far_plane=float(camera.clip_end), **words)
