"""hair.py: hair of particles and Blender's curves objects as velo's curves: strips that face the ray, shaded as tubes."""
import numpy


def segments(points, lengths, radii):
    """Bezier segments of strands, Catmull-Rom curves through their points: (positions 4 m x 3, widths m x 2).

    points: n x 3, strand after strand; lengths: points of each strand; radii: n."""
    lengths = numpy.asarray(lengths)
    last = numpy.cumsum(lengths) - 1
    first = last - lengths + 1
    is_first, is_last = numpy.zeros(len(points), dtype=bool), numpy.zeros(len(points), dtype=bool)
    is_first[first[lengths > 0]] = True
    is_last[last[lengths > 0]] = True
    number = numpy.arange(len(points))
    before, after = numpy.where(is_first, number, number - 1), numpy.where(is_last, number, number + 1)
    tangents = 0.5 * (points[after] - points[before])
    start = number[~is_last]
    end = start + 1
    positions = numpy.stack((points[start], points[start] + tangents[start] / 3, points[end] - tangents[end] / 3, points[end]), axis=1)
    widths = 2 * numpy.stack((radii[start], radii[end]), axis=1)
    good = numpy.isfinite(positions).all(axis=(1, 2)) & (numpy.linalg.norm(positions[:, 3] - positions[:, 0], axis=1) > 1e-9)
    return positions[good].reshape(-1, 3).astype(numpy.float32), numpy.maximum(widths[good], 1e-7).astype(numpy.float32)


def of_particles(item, system):
    """(points in world space, points of each strand, radii) of a hair system of an evaluated object, as a final render has it."""
    options = system.settings
    steps = 2**options.render_step + 1 if hasattr(options, "render_step") else 9
    parents = len(system.particles)
    children = len(system.child_particles)
    begin = 0 if options.use_parent_particles or children == 0 else parents
    strands = []
    for number in range(begin, parents + children):
        strand = [tuple(system.co_hair(object=item, particle_no=number, step=step)) for step in range(steps)]
        filled = [point for k, point in enumerate(strand) if k == 0 or point != (0.0, 0.0, 0.0)]
        if len(filled) > 1:
            strands.append(filled)
    if not strands:
        return None
    lengths = [len(strand) for strand in strands]
    along = numpy.concatenate([numpy.linspace(0, 1, count) for count in lengths])
    root, tip = (0.5 * options.radius_scale * value for value in (options.root_radius, options.tip_radius))
    # The shape's exponent, Cycles' shaperadius.
    power = 1 + options.shape if options.shape < 0 else 1 / (1 - min(options.shape, 0.999))
    radii = tip + (root - tip) * (1 - along)**power
    if options.use_close_tip:
        radii[numpy.cumsum(lengths) - 1] = 0
    return numpy.array([point for strand in strands for point in strand], dtype=float), lengths, radii


def of_curves(data):
    """(points in object space, points of each strand, radii) of a curves object; None: it is empty."""
    if len(data.points) == 0:
        return None
    points = numpy.empty(3 * len(data.points), dtype=numpy.float32)
    data.points.foreach_get("position", points)
    radii = numpy.empty(len(data.points), dtype=numpy.float32)
    data.points.foreach_get("radius", radii)
    lengths = numpy.empty(len(data.curves), dtype=numpy.int32)
    data.curves.foreach_get("points_length", lengths)
    radii = numpy.where(radii > 0, radii, 0.005)
    return points.reshape(-1, 3).astype(float), lengths, radii
