"""visibility.py: what the camera sees of an object: nothing, a hole in the image (a holdout), or the object itself."""
from . import links


def words_of(instance, view_layer):
    """Keywords of velo's shapes for an instance of the depsgraph: hidden_from_camera and backdrop, where they are True.

    Copies are hidden, too, where what makes them is. A backdrop has alpha 0, and with a transparent film no light: a holdout of Cycles,
    which other rays see as what it is."""
    words = {}
    if is_hidden(instance.object, view_layer) or (instance.parent is not None and is_hidden(instance.parent, view_layer)):
        words["hidden_from_camera"] = True
    if is_holdout(instance.object, view_layer) or (instance.parent is not None and is_holdout(instance.parent, view_layer)):
        words["backdrop"] = True
    return words


def is_hidden(item, view_layer):
    return not item.visible_camera or item.original.indirect_only_get(view_layer=view_layer)


def is_holdout(item, view_layer):
    return bool(item.is_holdout or item.original.holdout_get(view_layer=view_layer))


def is_hole(material):
    """Whether a material is the shader Holdout alone: the camera sees a hole, other rays see black."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return False
    output = links.output_node(material.node_tree, "OUTPUT_MATERIAL")
    try:
        source = links.follow(output.inputs["Surface"])[0] if output is not None else None
    except links.Cyclic:
        return False
    return source is not None and source.node.type == "HOLDOUT"


def note_opaque_film(scene, name, notes):
    """A hole in a film that is not transparent."""
    if not scene.render.film_transparent:
        notes.add(name, "Holdout", "it is a hole in transparent films alone (Film > Transparent); here it is rendered")
