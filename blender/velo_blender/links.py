"""links.py: which node feeds a socket, through reroutes, groups and muted nodes."""
from typing import Any, NamedTuple

MAX_SHADERS = 120  # that are mixed or added one in the other
TOO_DEEP = "its nodes feed themselves, or too many nodes feed each other"
MAX_STEPS = 500  # through reroutes and groups; a chain that is longer is a cycle


class Source(NamedTuple):
    """An output that feeds a socket. groups: the group nodes that it lies in, the outermost first."""
    node: Any
    socket: Any
    groups: tuple


class Nothing:
    """Stands for the unlinked input of a muted node or of a reroute: to Cycles its value is 0."""
    default_value = 0.0

    def __init__(self, socket):
        self.name, self.type, self.node = socket.name, socket.type, socket.node


class Cyclic(Exception):
    """Nodes that feed themselves."""


def follow(socket, groups=()):
    """The source of an input socket; None: it is not linked. The second value is the socket whose own value counts then."""
    for _ in range(MAX_STEPS):
        links = _links_of(socket)
        if not links:
            return None, socket
        node, output = links[0].from_node, links[0].from_socket
        if node.mute:
            inner = [link for link in node.internal_links if link.to_socket == output]
            if not inner:
                return None, socket
            socket = _passed(inner[0].from_socket)
        elif node.type == "REROUTE":
            socket = _passed(node.inputs[0])
        elif node.type == "GROUP" and node.node_tree is not None:
            inside = _output_of(node.node_tree, "GROUP_OUTPUT")
            if inside is None:
                return None, socket
            groups = groups + (node,)
            socket = _same(inside.inputs, output)
        elif node.type == "GROUP_INPUT" and groups:
            outer = groups[-1]
            groups = groups[:-1]
            socket = _same(outer.inputs, output)
        else:
            return Source(node, output, groups), socket
        if socket is None:
            return None, links[0].to_socket
    raise Cyclic(TOO_DEEP)


def _links_of(socket):
    if isinstance(socket, Nothing) or not socket.is_linked:
        return []
    return [link for link in socket.links if link.is_valid and not link.is_muted]


def _passed(socket):
    """An input whose value is passed on as it is."""
    return socket if _links_of(socket) else Nothing(socket)


def _same(sockets, other):
    return next((socket for socket in sockets if socket.identifier == other.identifier), None)


def _output_of(tree, kind):
    outputs = [node for node in tree.nodes if node.type == kind]
    active = [node for node in outputs if getattr(node, "is_active_output", False)]
    return (active or outputs or [None])[0]


def output_node(tree, kind):
    """The output of a tree that Cycles renders, OUTPUT_MATERIAL, OUTPUT_WORLD or OUTPUT_LIGHT; None: there is none."""
    outputs = [node for node in tree.nodes if node.type == kind and getattr(node, "target", "ALL") in ("ALL", "CYCLES")]
    active = [node for node in outputs if node.is_active_output]
    return (active or outputs or [None])[0]
