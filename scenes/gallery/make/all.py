#!/usr/bin/python3
"""all.py [--check]: writes the scenes that the programs beside this file make, packed with gzip: arches, jewel, library, table,
watch, and parts/fruit, parts/orangery, parts/rotunda. With --check: writes nothing, and fails if a scene is not the one that its program makes."""
import gzip
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = ("arches", "jewel", "library", "parts/fruit", "parts/orangery", "parts/rotunda", "table", "watch")


def main() -> int:
    different = []
    for scene in SCENES:
        program = os.path.join(HERE, os.path.basename(scene) + ".py")
        text = subprocess.run([sys.executable, "-B", program], check=True, stdout=subprocess.PIPE).stdout
        path = os.path.join(HERE, "..", scene + ".pbrt.gz")
        if "--check" not in sys.argv:
            with open(path, "wb") as file:
                file.write(gzip.compress(text, 9, mtime=0))
        elif gzip.open(path).read() != text:
            different.append(scene)
    for scene in different:
        print(f"{scene}.pbrt.gz is not what make/{os.path.basename(scene)}.py writes; run make/all.py", file=sys.stderr)
    return 1 if different else 0


sys.exit(main())
