#!/usr/bin/python3
"""The package's annotations: mypy accepts them (where it is installed), the stub of the extension names what the extension has,
and everything public has a docstring."""
import ast
import inspect
import os
import re
import shutil
import subprocess

import cases
from cases import case, work

import velo
from velo import _velo

PACKAGE = os.path.join(cases.SOURCE, "python/velo")


@case
def mypy_accepts_the_package():
    mypy = shutil.which("mypy", path="/usr/bin:/usr/local/bin")
    if not mypy:
        raise cases.Skip("needs mypy")
    run = subprocess.run([mypy, "--strict", "--ignore-missing-imports", "--cache-dir", work("mypy"), PACKAGE],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=cases.WORK)
    assert run.returncode == 0, run.stdout


@case
def the_stub_names_what_the_extension_has():
    tree = ast.parse(open(os.path.join(PACKAGE, "_velo.pyi")).read())
    functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    classes = {node.name: {item.name for item in node.body if isinstance(item, ast.FunctionDef)} - {"__init__", "__new__"}
               for node in tree.body if isinstance(node, ast.ClassDef)}
    real = {name for name in dir(_velo) if not name.startswith("__")}
    assert functions | set(classes) == real, (functions | set(classes)) ^ real
    for name, members in classes.items():
        own = {member for member in vars(getattr(_velo, name)) if not member.startswith("__")}
        assert members == own, (name, members ^ own)


ARRAYS = {"points", "pixels", "positions", "indices", "transform", "world_from_camera", "array"}
UNITS = {"time", "times", "radius", "distance"}


def complaints(module):
    """What is wrong with the public names of a module: no docstring; a parameter or a result without a type; an array whose shape,
    or a length or a time whose unit the docstring does not give."""
    found = []

    def look(name, function, arguments=True):
        text = inspect.getdoc(function) or ""
        if not text:
            found.append(f"{name}: no docstring")
        function = function.fget if isinstance(function, property) else function
        if not inspect.isfunction(function):
            return
        signature = inspect.signature(function)
        for parameter in signature.parameters.values():
            if parameter.annotation is inspect.Parameter.empty and parameter.name not in ("self", "cls"):
                found.append(f"{name}: {parameter.name} has no type")
        if signature.return_annotation is inspect.Signature.empty:
            found.append(f"{name}: no type of the result")
        names = set(signature.parameters) if arguments else set()
        is_array = names & ARRAYS or (signature.return_annotation == "Any" and name.split(".")[-1] not in
                                      ("get", "settings", "default_context"))
        if is_array and " x " not in text:
            found.append(f"{name}: no shape")
        if names & UNITS and not re.search(r"second|metre|scene unit|velo\.", text):
            found.append(f"{name}: no unit")

    for public in module.__all__:
        thing = getattr(module, public)
        if inspect.isfunction(thing):
            look(public, thing)
        elif inspect.isclass(thing):
            if not inspect.getdoc(thing) or (inspect.getdoc(thing) or "").startswith(public + "("):
                found.append(f"{public}: no docstring")
            for member, value in vars(thing).items():
                own = inspect.isfunction(value) or isinstance(value, property)
                if not member.startswith("_") and own and thing.__module__.startswith(("velo", "planted")):
                    look(f"{public}.{member}", value)
    return found


@case
def everything_public_has_types_docstrings_shapes_and_units():
    found = complaints(velo)
    try:
        import numpy  # noqa: F401: the datasets need it
        from velo import dataset
        found += complaints(dataset)
    except ImportError:
        pass
    assert not found, "\n".join(found)


@case
def what_is_missing_is_found():
    import types
    planted = types.ModuleType("planted")
    exec('''
from __future__ import annotations
from typing import Any
__all__ = ["Thing", "shapeless", "untyped"]
def shapeless(points: Any) -> None:
    "Uses points."
def untyped(a) -> int:
    "A number."
class Thing:
    "A thing."
    def silent(self) -> int:
        return 1
    def late(self, time: float) -> int:
        "Later."
    @property
    def pose(self) -> Any:
        "The pose."
Thing.__module__ = "planted"
''', vars(planted))
    assert sorted(complaints(planted)) == ["Thing.late: no unit", "Thing.pose: no shape", "Thing.silent: no docstring",
                                           "shapeless: no shape", "untyped: a has no type"], complaints(planted)


if __name__ == "__main__":
    cases.main()
