"""bumps.py: what feeds a shader's Normal: normal maps and bumps."""
from . import links


def words(inputs, node, groups):
    """Keywords of velo's material for a shader node's socket Normal and the material's relief: normal, displacement; none
    where it has none."""
    result = _of_socket(inputs, node, groups)
    if inputs.relief is not None:
        if "displacement" in result:
            inputs.notes.add(inputs.owner, node.name, "of a bump and a displacement the bump is rendered")
        else:
            result["displacement"] = inputs.relief
    return result


def _of_socket(inputs, node, groups):
    result = {}
    socket = node.inputs.get("Normal")
    for _ in range(8):
        source = links.follow(socket, groups)[0] if socket is not None else None
        if source is None:
            return result
        inner, groups = source.node, source.groups
        if inner.type == "BUMP":
            _bump(inputs, inner, groups, result)
            socket = inner.inputs["Normal"]
        elif inner.type == "NORMAL_MAP":
            _normal_map(inputs, inner, groups, result)
            return result
        elif inner.type == "NEW_GEOMETRY" and source.socket.name == "Normal":
            return result
        else:
            inputs.notes.add(inputs.owner, inner.name, "it cannot be a normal; the surface's own is taken")
            return result
    inputs.notes.add(inputs.owner, node.name, "more than 8 bumps follow each other; the others are left out")
    return result


def without_map(inputs, node, groups):
    """As words, for materials that have no normal map."""
    result = words(inputs, node, groups)
    if result.pop("normal", None) is not None:
        inputs.notes.add(inputs.owner, node.name, "this shader has no normal map in velo; the surface's own normal is taken")
    return result


def _bump(inputs, node, groups, result):
    """velo's displacement is a height in scene units. Cycles mixes the bumped normal by Strength; here Strength is a factor on the
    height, which is the same for small slopes."""
    height = inputs.number(node.inputs["Height"], groups)
    if isinstance(height, float):
        return
    strength, distance = inputs.constant(node.inputs["Strength"], groups), inputs.constant(node.inputs["Distance"], groups)
    if not isinstance(strength, float) or not isinstance(distance, float):
        inputs.notes.add(inputs.owner, node.name, "strength and distance that vary are 1")
        strength, distance = 1.0, 1.0
    if "displacement" in result:
        inputs.notes.add(inputs.owner, node.name, "of several bumps the last one is rendered")
        return
    factor = max(strength, 0.0) * distance * (-1 if node.invert else 1)
    result["displacement"] = inputs.scene.add_texture("scale", spectrum=False, float_a=height, amount=factor)


def _normal_map(inputs, node, groups, result):
    if node.space != "TANGENT":
        inputs.notes.add(inputs.owner, node.name, "a normal map in %s space is left out" % node.space.lower())
        return
    if inputs.constant(node.inputs["Color"], groups) is not None:
        return
    strength = inputs.constant(node.inputs["Strength"], groups)
    if not isinstance(strength, float):
        inputs.notes.add(inputs.owner, node.name, "a strength that varies is 1")
        strength = 1.0
    handle = inputs.normals(node.inputs["Color"], groups, max(0.0, strength))
    if handle is not None:
        result["normal"] = handle
