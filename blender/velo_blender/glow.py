"""glow.py: what shaders emit: colours times strengths, each of which may vary, as one of velo's emissions."""
from typing import Any, NamedTuple

import numpy

from . import evaluate, links
from .math_nodes import column


class Glow(NamedTuple):
    """What one shader emits. color, strength: three numbers or an image texture, and a number, whose product it is; color None: it has to
    be baked. value: a function (evaluate.Evaluator) -> n x 3; node: the shader."""
    color: Any
    strength: float
    value: Any
    node: Any


def of_sockets(inputs, node, color, strength, groups):
    """The product of a socket of a colour and one of a number."""
    def value(e):
        tint, factor = evaluate.as_vector(e.input(color, groups)), evaluate.as_value(e.input(strength, groups))
        return numpy.maximum(tint, 0) * column(numpy.maximum(factor, 0))

    number = inputs.constant(strength, groups)
    if isinstance(number, float) and number <= 0:
        return Glow((0.0, 0.0, 0.0), 0.0, value, node)
    source = links.follow(color, groups)[0]
    if not isinstance(number, float) or (source is not None and source.node.type in ("VERTEX_COLOR", "ATTRIBUTE")):
        return Glow(None, 1.0, value, node)
    return Glow(inputs.color(color, groups), number, value, node)


def mixed(first, second, factor, socket, groups):
    """The terms of a mix of two shaders by a factor, which is a number, or a texture of what feeds a socket."""
    if isinstance(factor, float):
        return [_times(term, 1 - factor) for term in first] + [_times(term, factor) for term in second]

    def share(e):
        return column(numpy.clip(evaluate.as_value(e.input(socket, groups)), 0, 1))

    return [Glow(None, 1.0, lambda e, term=term: term.value(e) * (1 - share(e)), term.node) for term in first] + [
        Glow(None, 1.0, lambda e, term=term: term.value(e) * share(e), term.node) for term in second]


def _times(term, factor):
    return Glow(term.color, term.strength * factor, lambda e: term.value(e) * factor, term.node)


def emission(terms, inputs):
    """velo's emission of a sum of terms, a handle; None: nothing is emitted."""
    terms = [term for term in terms if term.color is None or (term.strength != 0 and term.color != (0.0, 0.0, 0.0))]
    if not terms:
        return None
    if all(isinstance(term.color, tuple) for term in terms):
        return _plain(tuple(sum(term.color[i] * term.strength for term in terms) for i in range(3)), inputs)
    if len(terms) == 1 and terms[0].color is not None:
        return inputs.scene.add_emission(texture=terms[0].color, scale=terms[0].strength, two_sided=True)
    constant = _constant(terms, inputs)
    if constant is not None:
        return _plain(constant, inputs)
    try:
        texture = inputs.baked(lambda e: sum(term.value(e) for term in terms), terms[0].node, True)
    except evaluate.Unsupported as error:
        inputs.notes.add(inputs.owner, error.node.name, "%s; it does not emit" % error.text)
        return None
    return inputs.scene.add_emission(texture=texture, scale=1.0, two_sided=True)


def _constant(terms, inputs):
    """Three numbers, where the sum is the same everywhere on an object; None: it is not."""
    try:
        total = sum(term.value(inputs.plain_evaluator()) for term in terms)
    except evaluate.Unsupported:
        return None
    return tuple(float(x) for x in total[0]) if len(total) == 1 else None


def _plain(color, inputs):
    high = max(color)
    if not 0 < high < 1e30:
        return None
    return inputs.scene.add_emission(radiance=tuple(max(0.0, x) / high for x in color), scale=high, two_sided=True)
