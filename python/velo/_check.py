"""Checks of arguments. Each failure is a UsageError that names the argument, what it may be, and its value."""
from __future__ import annotations

import itertools
import math
import os
from typing import Any, Optional, Sequence

from velo import _velo
from velo._errors import wrong_value


_NO_LISTS = (str, bytes, dict, set, frozenset)
MAX_ITEMS = 65536  # of a list that is no array


def instance(value: Any, kind: type, what: str, optional: bool = False) -> Any:
    """A value of a class, or None where it is optional."""
    if isinstance(value, kind) or (optional and value is None):
        return value
    raise wrong_value(what, f"a velo.{kind.__name__}" + (", or None" if optional else ""), value)


def callback(value: Any, what: str) -> Any:
    """A function, or None."""
    if value is None or callable(value):
        return value
    raise wrong_value(what, "callable, or None", value)


def items(value: Any, what: str, kind: str = "values") -> list[Any]:
    """A list of a sequence or iterator; a text is not one."""
    if isinstance(value, _NO_LISTS):
        raise wrong_value(what, f"a list of {kind}", value)
    try:
        found = list(itertools.islice(value, MAX_ITEMS + 1))
    except TypeError:
        raise wrong_value(what, f"a list of {kind}", value) from None
    if len(found) > MAX_ITEMS:
        raise wrong_value(what, f"a list of at most {MAX_ITEMS} {kind}", value)
    return found


def names(value: Any, what: str) -> list[str]:
    """A list of names."""
    found = items(value, what, "names")
    for name in found:
        if not isinstance(name, str):
            raise wrong_value(f"each item of {what}", "a name, a str", name)
    return found


def tuple_of(value: Any, count: int, what: str, rule: str) -> Sequence[Any]:
    """Exactly `count` values; rule: what they are."""
    if isinstance(value, _NO_LISTS):
        raise wrong_value(what, rule, value)
    try:
        found = tuple(itertools.islice(value, count + 1))
    except TypeError:
        raise wrong_value(what, rule, value) from None
    if len(found) != count:
        raise wrong_value(what, rule, value)
    return found


def text(value: Any, what: str) -> str:
    """A str."""
    if not isinstance(value, str):
        raise wrong_value(what, "a str", value)
    return value


def path(value: Any, what: str) -> Any:
    """A path that files can have."""
    try:
        fine = isinstance(value, (str, bytes, os.PathLike)) and os.fsencode(value) and b"\0" not in os.fsencode(value)
    except (TypeError, ValueError):
        fine = False
    if not fine:
        raise wrong_value(what, "a path: a str or an os.PathLike", value)
    return value


def flag(value: Any, what: str) -> bool:
    """True or False."""
    return bool(_velo.check_value(value, what, "flag", 0, 0))


def whole(value: Any, what: str, low: int, high: int) -> int:
    """A whole number in a range; the bounds are at most 2**53."""
    return int(_velo.check_value(value, what, "count", low, high))


def number(value: Any, what: str, low: float = -math.inf, high: float = math.inf) -> float:
    """A finite number in a range."""
    return float(_velo.check_value(value, what, "number", low, high))


def setting(value: Any, what: str, group: str, name: str) -> Any:
    """The value of a setting by its row (velo/setting.h), in the row's unit: group "render", name "spp"."""
    return _velo.check_setting(value, what, group, name, True)


def choice(value: Any, what: str, words: Sequence[str]) -> str:
    """One of some words."""
    return words[_velo.check_choice(value, what, list(words))]


def nothing_or(check: Any, value: Any, *arguments: Any) -> Optional[Any]:
    """None, or what a check returns."""
    return None if value is None else check(value, *arguments)
