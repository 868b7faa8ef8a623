"""Runs a file of cases inside Blender: `ok NAME`, `not ok NAME`, or `skip NAME: why`, where Blender or a Python module is missing."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

SOURCE = os.environ.get("VELO_SOURCE_DIR") or os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BINARY = os.environ.get("VELO_BINARY_DIR") or os.path.join(SOURCE, "build/release")


def environment(folder):
    """For a Blender that finds the add-on, installed in a folder, and velo's module."""
    addons = os.path.join(folder, "scripts/addons")
    os.makedirs(addons, exist_ok=True)
    if not os.path.exists(os.path.join(addons, "velo_blender")):
        os.symlink(os.path.join(SOURCE, "blender/velo_blender"), os.path.join(addons, "velo_blender"))
    return {**os.environ, "PYTHONPATH": os.path.join(BINARY, "python"), "PYTHONDONTWRITEBYTECODE": "1",
            "BLENDER_USER_SCRIPTS": os.path.join(folder, "scripts"), "BLENDER_USER_CONFIG": os.path.join(folder, "config")}


def why_not():
    """Why Blender cannot run the add-on here; None: it can."""
    if shutil.which("blender") is None:
        return "Blender is not installed (script/bootstrap blender)"
    if not os.path.exists(os.path.join(BINARY, "python/velo/_velo.abi3.so")):
        return "the Python module is not built"
    with open(os.path.join(BINARY, "python/velo/_velo.abi3.so"), "rb") as module:
        if b"libasan" in module.read():
            return "Blender cannot load a module with a sanitizer"
    return None


def run(cases_file):
    """Prints a line for each case; exit code 1 where one failed."""
    reason = why_not()
    name = os.path.basename(cases_file)
    if reason is not None:
        print("skip %s: %s" % (name, reason))
        return 0
    inside = os.path.join(os.path.dirname(os.path.abspath(__file__)), "inside.py")
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["nice", "blender", "-b", "--factory-startup", "-P", inside, "--", cases_file, folder],
                              env=environment(folder), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    lines = re.findall(r"^(?:ok|not ok|skip) .*$", done.stdout, re.M)
    for line in lines:
        print(line)
    if done.returncode != 0 or not lines:
        print("not ok %s: Blender ended with %d" % (name, done.returncode))
    if done.returncode != 0 or not lines or any(line.startswith("not") for line in lines):
        print(done.stdout)
        return 1
    return 0


def main(caller):
    """The cases of test_NAME.py are in cases_NAME.py."""
    folder, name = os.path.split(os.path.abspath(caller))
    sys.exit(run(os.path.join(folder, name.replace("test_", "cases_"))))
