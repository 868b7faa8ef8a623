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
    run = subprocess.run([mypy, "--strict", "--ignore-missing-imports", "--enable-incomplete-feature=Unpack", "--cache-dir", work("mypy"), PACKAGE],
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


@case
def keywords_are_those_of_the_rows():
    """Each keyword of the library's tables is in python/velo/_keywords.py, for completion, and each of it is accepted."""
    from velo import _keywords

    def names(group):
        return {name for base in group.__mro__ for name in getattr(base, "__annotations__", {})}

    for family, group in (("textures", _keywords.Textures), ("materials", _keywords.Materials), ("media", _keywords.Media),
                          ("emission", _keywords.Emission), ("lights", _keywords.Lights), ("shapes", _keywords.Shapes)):
        rows = {word for row in velo.kinds(family).values() for word in row} - _keywords.APART
        assert rows <= names(group), (family, rows - names(group))
        for name in sorted(names(group) - rows):  # known, whatever is said of the value
            said = []
            for kind in velo.kinds(family):
                try:
                    scene = velo.Scene()
                    scene._new(family, kind, {name: object()}) if name != "range" else scene.add_texture("image", range=object())
                except velo.UsageError as error:
                    said.append(str(error))
            assert not all("unknown keyword" in text for text in said), (family, name)
    assert names(_keywords.Settings) == set(velo.settings_names())
    for group, rows in (("load", _keywords.Load), ("complete", _keywords.Complete), ("camera", _keywords.Cameras)):
        known = {row.name for row in cases.setting_rows() if row.group == group and "[" not in row.name}
        assert known - {"path", "width", "height"} <= names(rows), (group, known - names(rows))

    def accepts(kind, word):
        try:
            velo.Camera(8, 8, **{"projection": kind, word: object()})
        except velo.UsageError as error:
            return "unknown" not in str(error)
        return True

    cameras = velo.kinds("cameras")
    for name in names(_keywords.Cameras):
        assert any(accepts(kind, name) for kind in cameras), name
    for kind, row in cameras.items():  # `lambda` of a division is a word of Python
        lacking = {word for word in row if accepts(kind, word)} - names(_keywords.Cameras) - {"lambda"}
        assert not lacking, (kind, lacking)
    assert "panini" in cameras["panini"] and "shape[0]" not in cameras["panini"]


@case
def completion_knows_the_keywords():
    for function, wanted in ((velo.Scene.render, "max_depth"), (velo.Scene.add_material, "roughness"), (velo.Scene.add_mesh, "uvs"),
                             (velo.Scene().add_light, "position"), (velo.Scene.add_box, "pose"), (velo.Camera, "fov"),
                             (velo.Camera.replace, "K"), (velo.load, "environment"), (velo.Scene.load, "search_path")):
        parameter = inspect.signature(function).parameters[wanted]
        assert parameter.kind is parameter.KEYWORD_ONLY, wanted
    assert "samples_per_pixel" not in inspect.signature(velo.Scene.render).parameters


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
        plain = [parameter for parameter in signature.parameters.values() if parameter.default is not ...]  # without those of _keywords
        signature = signature.replace(parameters=plain)
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
