"""points.py: point clouds as spheres."""
import numpy

RADIUS = 0.01  # of points without one, as in Cycles


def read(cloud, notes, owner):
    """(centres n x 3, double, radii n, float32) of a point cloud, in the object's space. Points without a place or a radius are left
    out and noted."""
    count = len(cloud.points)
    places = numpy.empty(3 * count, dtype=numpy.float32)
    cloud.points.foreach_get("co", places)
    radii = numpy.full(count, RADIUS, dtype=numpy.float32)
    if cloud.attributes.get("radius") is not None:
        cloud.points.foreach_get("radius", radii)
    places = places.reshape(-1, 3).astype(float)
    good = numpy.isfinite(places).all(axis=1) & numpy.isfinite(radii) & (radii > 0)
    if not good.all():
        notes.add(owner, "", "%d points without a place or a radius are left out" % (count - good.sum()))
    return places[good], radii[good]
