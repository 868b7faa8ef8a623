#!/usr/bin/python3
"""The Python examples of README.md, docs/python.md, docs/own-code.md, docs/raw.md, docs/rays.md and docs/datasets.md, and the notebooks of examples/, run as written: the
blocks of a page one after the other in a folder of their own. Renders get at most 2 samples per pixel."""
import contextlib
import glob
import io
import json
import os
import re
import subprocess
import sys

import cases
from cases import case, work

cases.need("numpy")

START = """
import velo
_prepare = velo.Scene._prepare
def capped(self, camera, resolution, crop, channels, film, denoise, keywords):
    settings, view = _prepare(self, camera, resolution, crop, channels, film, denoise, keywords)
    if film is None and settings.get("first_sample") == 0:
        settings.set("spp", min(2, settings.get("spp")) if CAP else settings.get("spp"))
    return settings, view
velo.Scene._prepare = capped
"""


def blocks(path):
    """(line, text) of each fenced block of Python."""
    lines = open(path, encoding="utf-8").read().split("\n")
    result, i = [], 0
    while i < len(lines):
        if lines[i].strip() == "```python":
            end = lines.index("```", i + 1)
            result.append((i + 2, "\n".join(lines[i + 1:end])))
            i = end
        i += 1
    return result


def run(name, parts, cap):
    folder = work(name)
    os.makedirs(folder)
    os.symlink(cases.SCENES, os.path.join(folder, "scenes"))
    text = "CAP = %r\n" % cap + START
    for line, part in parts:
        text += "print('# line %d', flush=True)\n%s\n" % (line, part)
    script = os.path.join(folder, "page.py")
    with open(script, "w") as file:
        file.write(text)
    done = subprocess.run([sys.executable, script], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=300)
    assert done.returncode == 0, done.stdout[-3000:]
    return folder


@case
def the_readme():
    parts = blocks(os.path.join(cases.SOURCE, "README.md"))
    assert len(parts) >= 1
    run("readme", parts, True)


@case
def docs_python():
    parts = blocks(os.path.join(cases.SOURCE, "docs/python.md"))
    assert len(parts) >= 9
    run("python", parts, False)


@case
def docs_raw():
    parts = blocks(os.path.join(cases.SOURCE, "docs/raw.md"))
    assert len(parts) >= 1
    run("raw", parts, False)


@case
def docs_own_code():
    parts = blocks(os.path.join(cases.SOURCE, "docs/own-code.md"))
    assert len(parts) >= 1
    run("own", parts, False)


@case
def docs_rays():
    parts = blocks(os.path.join(cases.SOURCE, "docs/rays.md"))
    assert len(parts) >= 1
    run("rays", parts, False)


@case
def docs_datasets():
    page = os.path.join(cases.SOURCE, "docs/datasets.md")
    parts = blocks(page)
    assert len(parts) >= 4
    folder = run("datasets", parts, True)
    assert os.path.exists(os.path.join(folder, "out/bop/train_pbr/000000/scene_gt.json"))
    one = open(os.path.join(folder, "out/bop/train_pbr/000000/rgb/000002.png"), "rb").read()
    assert one == open(os.path.join(folder, "again/bop/train_pbr/000000/rgb/000002.png"), "rb").read()
    try:
        import yaml
    except ImportError:
        return
    from velo import dataset
    text = re.search(r"```yaml\n(.*?)```", open(page, encoding="utf-8").read(), re.S).group(1)
    recipe = dataset.recipe_from(yaml.safe_load(text), folder)
    assert recipe.frames == 200 and dataset.Stage(recipe).plan(4).objects


@case
def notebooks():
    """By nbconvert where it is installed, else their code cells in order."""
    paths = glob.glob(os.path.join(cases.SOURCE, "examples/*.ipynb"))
    assert paths
    for path in paths:
        book = json.load(open(path, encoding="utf-8"))
        assert book["nbformat"] == 4 and all(not cell.get("outputs") for cell in book["cells"])
        if subprocess.run([sys.executable, "-c", "import nbconvert.__main__, ipykernel.kernelapp"], stderr=subprocess.DEVNULL).returncode == 0:
            folder = work("book")
            os.makedirs(folder, exist_ok=True)
            subprocess.run([sys.executable, "-m", "nbconvert", "--execute", "--to", "notebook", "--output-dir", folder, path],
                           check=True, cwd=cases.SOURCE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=300)
            outputs = [output for cell in json.load(open(os.path.join(folder, os.path.basename(path)), encoding="utf-8"))["cells"]
                       for output in cell.get("outputs", [])]
            assert sum("image/png" in output.get("data", {}) for output in outputs) >= 3
            assert any("samples per pixel" in "".join(output.get("text", "")) for output in outputs)
            continue
        try:
            import IPython  # noqa: F401
        except ImportError:
            stand_in = os.path.join(cases.WORK, "modules/IPython")
            os.makedirs(stand_in)
            open(os.path.join(stand_in, "__init__.py"), "w").close()
            with open(os.path.join(stand_in, "display.py"), "w") as file:
                file.write("def display(thing):\n    assert thing._repr_png_()[1:4] == b'PNG'\ndef clear_output(wait=False):\n    pass\n")
            os.environ["PYTHONPATH"] += os.pathsep + os.path.dirname(stand_in)
        cells = [(i + 1, "".join(cell["source"])) for i, cell in enumerate(book["cells"]) if cell["cell_type"] == "code"]
        run(os.path.basename(path), [(i, re.sub(r"^%.*$", "", text, flags=re.M)) for i, text in cells], True)


if __name__ == "__main__":
    cases.main()
