"""displace.py: displacement that moves vertices, as Cycles does without adaptive subdivision, and the height of that which is a bump.

A vertex moves along its normal by scale * (height - midlevel); the height is evaluated at the vertex."""
import numpy

from . import evaluate, links

MAX_HEIGHT = 1e12  # scene units

def _method(material):
    return getattr(getattr(material, "cycles", None), "displacement_method", None) or getattr(material, "displacement_method", "BUMP")


def _socket(material):
    """The output's linked socket Displacement; None."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return None
    output = links.output_node(material.node_tree, "OUTPUT_MATERIAL")
    return output.inputs["Displacement"] if output is not None and output.inputs["Displacement"].is_linked else None


def is_displaced(material):
    """Whether a material moves vertices."""
    return _socket(material) is not None and _method(material) in ("DISPLACEMENT", "BOTH")


def is_bumped(material):
    """Whether a material's displacement changes normals alone."""
    return _socket(material) is not None and _method(material) not in ("DISPLACEMENT", "BOTH")


def _source(material, inputs):
    """The displacement node that feeds the output; None, and a note: there is another one."""
    source, _ = links.follow(_socket(material))
    if source is None:
        return None
    if source.node.type != "DISPLACEMENT":
        inputs.notes.add(inputs.owner, source.node.name, "displacement by this node is not rendered")
        return None
    if links.follow(source.node.inputs["Normal"], source.groups)[0] is not None:
        inputs.notes.add(inputs.owner, source.node.name, "its normal is the surface's own")
    return source


def relief(material, inputs):
    """The height of a displacement that is a bump, as a float texture; None: it has none."""
    source = _source(material, inputs)
    if source is None:
        return None
    height = inputs.number(source.node.inputs["Height"], source.groups)
    if isinstance(height, float):
        return None
    scale = inputs.constant(source.node.inputs["Scale"], source.groups)
    if not isinstance(scale, float):
        inputs.notes.add(inputs.owner, source.node.name, "a scale that varies is 1")
        scale = 1.0
    return inputs.scene.add_texture("scale", spectrum=False, float_a=height, amount=scale)


def apply(arrays, slot, material, inputs, matrix):
    """Moves the vertices of one slot of a mesh. arrays: geometry.MeshArrays; matrix: world from object."""
    source = _source(material, inputs)
    if source is None:
        return
    mine = numpy.unique(arrays.triangles[arrays.slots == slot])
    vertices = arrays.vertex_of(mine)
    vertices, first = numpy.unique(vertices, return_index=True)
    rows = mine[first]
    normals = arrays.vertex_normals()[vertices]
    try:
        moved = normals * _heights(arrays, rows, normals, source, inputs, matrix)[:, None]
    except evaluate.Unsupported as error:
        inputs.notes.add(inputs.owner, error.node.name, "%s; the displacement is not rendered" % error.text)
        return
    wrong = ~(abs(moved) < MAX_HEIGHT)
    if wrong.any():
        inputs.notes.add(inputs.owner, source.node.name, "heights that are no numbers or huge are 0")
        moved = numpy.where(wrong, 0.0, moved)
    arrays.move(vertices, moved)
    if _method(material) == "BOTH":
        inputs.notes.add(inputs.owner, source.node.name, "displacement and bump is displacement alone")


def _heights(arrays, rows, normals, source, inputs, matrix):
    """scale * (height - midlevel) at points of the mesh, in the object's space along the unit normals."""
    fields = dict(inputs.known)
    positions = arrays.positions[rows].astype(float)
    low, size = arrays.texture_space
    fields.update({"object": positions, "generated": (positions - low) / numpy.where(size == 0, 1, size), "normal": normals,
                   "world position": positions @ matrix[:3, :3].T + matrix[:3, 3]})
    for name in arrays.uv_names:
        fields["uv:" + name] = arrays.uvs[name][rows].astype(float)
    if arrays.render_uv is not None:
        fields["uv:"] = fields["uv:" + arrays.render_uv]
    for name in arrays.color_names:
        fields["color:" + name] = arrays.colors(name)[rows].astype(float)
    evaluator = evaluate.Evaluator(fields, inputs.look_up, lambda node, text: inputs.notes.add(inputs.owner, node.name, text))
    height, middle, scale = (evaluator.named(source.node, name, source.groups) for name in ("Height", "Midlevel", "Scale"))
    heights = numpy.broadcast_to(scale * (height - middle), (len(rows),))
    if source.node.space == "WORLD":
        heights = heights / numpy.maximum(numpy.linalg.norm(normals @ matrix[:3, :3].T, axis=1), 1e-30)
    return heights
