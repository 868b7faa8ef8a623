#!/usr/bin/python3
"""Rendered shading in a 3D view, under Xvfb with software OpenGL: the view shows the scene, and what has moved."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import run_inside

reason = run_inside.why_not() or (None if shutil.which("Xvfb") else "Xvfb is not installed (script/bootstrap blender)")
if reason is not None:
    print("skip test_view.py: %s" % reason)
    sys.exit(0)
script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "inside_view.py")
with tempfile.TemporaryDirectory() as folder:
    ends = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(ends[1]), "-screen", "0", "800x600x24"], pass_fds=[ends[1]],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        os.close(ends[1])
        display = os.read(ends[0], 16).decode().strip()
        words = {**run_inside.environment(folder), "DISPLAY": ":" + display, "LIBGL_ALWAYS_SOFTWARE": "1"}
        done = subprocess.run(["nice", "blender", "--factory-startup", "--window-geometry", "0", "0", "800", "600", "-P", script, "--", folder],
                              env=words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300, check=False)
    finally:
        server.terminate()
        server.wait()
lines = re.findall(r"^(?:ok|not ok) .*$", done.stdout, re.M)
print("\n".join(lines or ["not ok test_view.py: Blender ended with %d" % done.returncode]))
if not lines or any(line.startswith("not") for line in lines):
    print(done.stdout)
    sys.exit(1)
