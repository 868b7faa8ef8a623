#!/usr/bin/python3
"""The package's annotations: mypy accepts them (where it is installed), the stub of the extension names what the extension has,
and everything public has a docstring."""
import ast
import inspect
import os
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


@case
def everything_public_has_a_docstring():
    missing = []
    for name in velo.__all__:
        thing = getattr(velo, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            if not inspect.getdoc(thing):
                missing.append(name)
        if inspect.isclass(thing) and thing.__module__.startswith("velo."):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    if not inspect.getdoc(value):
                        missing.append(f"{name}.{member}")
    assert not missing, missing


if __name__ == "__main__":
    cases.main()
