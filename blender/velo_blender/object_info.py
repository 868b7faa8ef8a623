"""object_info.py: what a material may ask of the object that it is on: place, colour, index, a random number, custom properties."""
import numpy

from . import links, noise

MAX_COPIES = 1000  # of a mesh whose material differs between its objects

_OF_PLACE = {"Position", "Normal", "True Normal", "Incoming", "Tangent"}


def fields(item, matrix, number):
    """Fields for evaluate.Evaluator, 1 or 1 x 3, and the matrix. matrix: world from object. number: random_id()."""
    found = {"object info location": numpy.array([matrix[:3, 3]]), "object info color": numpy.array([list(item.color)[:3]]),
             "object info alpha": numpy.array([item.color[3]]), "object info object index": numpy.array([float(item.pass_index)]),
             "object info random": numpy.array([number / 0xffffffff]), "matrix": matrix}
    for name in item.keys():
        value = item[name]
        if isinstance(value, (int, float)):
            found["property:" + name] = numpy.array([float(value)])
        elif hasattr(value, "to_list") and 3 <= len(value) <= 4 and all(isinstance(part, (int, float)) for part in value):
            found["property:" + name] = numpy.array([[float(part) for part in value][:3]])
    return found


def random_id(instance):
    """The number from which Cycles makes an object's random one: Blender's for instances, else a hash of its name (util/hash.h)."""
    if instance.is_instance:
        return instance.random_id & 0xffffffff  # Blender shows 32 bits with a sign
    total = 0
    for byte in instance.object.name.encode():
        total = (total * 37 + byte) & 0xffffffff
    return int(noise.hash_words(numpy.array([total], dtype=numpy.uint32), numpy.array([0], dtype=numpy.uint32))[0])


def varies(material):
    """Whether a material may differ between objects that share a mesh."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return False
    output = links.output_node(material.node_tree, "OUTPUT_MATERIAL")
    if output is not None and output.inputs["Volume"].is_linked:
        return True  # its medium is that of one place
    return _tree_varies(material.node_tree, ())


def _tree_varies(tree, seen):
    for node in tree.nodes:
        linked = {socket.name for socket in node.outputs if socket.is_linked}
        if node.type in ("OBJECT_INFO", "VECT_TRANSFORM") and linked:
            return True
        if node.type == "TEX_COORD" and "Object" in linked and node.object is not None:
            return True
        if node.type == "NEW_GEOMETRY" and linked & _OF_PLACE:
            return True
        if node.type == "ATTRIBUTE" and linked and node.attribute_type != "GEOMETRY":
            return True
        if node.type == "GROUP" and node.node_tree is not None and node.node_tree not in seen:
            if _tree_varies(node.node_tree, seen + (node.node_tree,)):
                return True
    return False
