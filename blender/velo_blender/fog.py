"""fog.py: the volume of Blender's world, which fills all of space, and the volume that the camera is in."""
from typing import Any, NamedTuple

import numpy

from . import links, volumes

#: The direction in which the camera looks for the volume that it is in; askew, so that it meets no edge of a box.
_UP = numpy.array([0.0123, 0.0071, 1.0])


class Solid(NamedTuple):
    """A closed mesh with a medium inside. name: the object's; matrix: world from the mesh; positions: n x 3; triangles: m x 3; medium:
    velo's handle."""
    name: str
    matrix: Any
    positions: Any
    triangles: Any
    medium: Any

    def box(self):
        """(low, high) of the corners in the world."""
        low, high = self.positions.min(axis=0), self.positions.max(axis=0)
        corners = numpy.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
        placed = corners @ self.matrix[:3, :3].T + self.matrix[:3, 3]
        return placed.min(axis=0), placed.max(axis=0)


def of_world(world, inputs):
    """The volumes.Volume of a world, with a density of 1; None: it has none, or none that velo has (noted)."""
    if world is None or not world.use_nodes or world.node_tree is None:
        return None
    output = links.output_node(world.node_tree, "OUTPUT_WORLD")
    if output is None or not output.inputs["Volume"].is_linked:
        return None
    volume = volumes.of_socket(output.inputs["Volume"], inputs)
    if volume is None:
        return None
    if volume.density is None:
        inputs.notes.add(world.name, "Volume", "its density varies; the world's volume is not rendered")
        return None
    volume = volumes.with_density_1(volume)
    extinction = volume.absorption + volume.scattering
    if not numpy.isfinite(extinction).all() or not extinction.max() < volumes.DENSEST:
        inputs.notes.add(world.name, "Volume", "it is too dense; the world's volume is not rendered")
        return None
    if (volume.emission[extinction <= 0] > 0).any():
        inputs.notes.add(world.name, "Volume", "its emission has no end; the world's volume is not rendered")
        return None
    if extinction.max() <= 0:
        return None
    if extinction.min() <= 0:
        inputs.notes.add(world.name, "Volume", "it lets suns and the background pass in the colours that it does not weaken")
    return volume


def medium_at(eye, solids, notes, otherwise):
    """The medium of the solid that a point of the world, three numbers, is in; otherwise: that outside of all. Of several, that whose
    surface is the next one (noted)."""
    found = sorted(((distance, number) for number, distance in enumerate(_way_out(eye, solid) for solid in solids)
                    if distance is not None))
    if not found:
        return otherwise
    for _, number in found[1:]:
        notes.add(solids[number].name, "Volume", "the camera is in that of %s, too, and sees that one alone" % solids[found[0][1]].name)
    return solids[found[0][1]].medium


def _way_out(eye, solid):
    """How far it is from a point of the world to the surface of the solid that it is in; None: it is not in it. As in Cycles
    (kernel/integrator/volume_stack.h) the first surface upwards tells: who sees its back is inside."""
    inverse = numpy.linalg.inv(solid.matrix)
    start = inverse[:3, :3] @ eye + inverse[:3, 3]
    along = inverse[:3, :3] @ _UP
    corners = solid.positions[solid.triangles].astype(float)
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    # Moeller and Trumbore 1997
    across = numpy.cross(along, second)
    facing = numpy.einsum("ij,ij->i", first, across)  # < 0: the ray sees the back
    with numpy.errstate(divide="ignore", invalid="ignore"):
        offset = start - corners[:, 0]
        u = numpy.einsum("ij,ij->i", offset, across) / facing
        turned = numpy.cross(offset, first)
        v = turned @ along / facing
        distance = numpy.einsum("ij,ij->i", second, turned) / facing
        met = (u >= 0) & (v >= 0) & (u + v <= 1) & (distance > 0) & numpy.isfinite(distance)
    if not met.any():
        return None
    nearest = numpy.flatnonzero(met)[distance[met].argmin()]
    return float(distance[nearest]) if facing[nearest] < 0 else None


def note_overlaps(solids, notes):
    """Notes each solid whose box meets that of an earlier one: where volumes overlap velo has one of them."""
    boxes = [solid.box() for solid in solids]
    for number, (low, high) in enumerate(boxes):
        for other in range(number):
            if (low < boxes[other][1]).all() and (high > boxes[other][0]).all():
                notes.add(solids[number].name, "Volume", "where it overlaps that of %s, one of them is rendered" % solids[other].name)
                break
