#!/usr/bin/python3
"""How soon after its start the program has an image on disk. Usage: first_pass.py VELO SCENE [RESOLUTION] [TURNS]
Prints the best and the median of several starts; the machine should have nothing else to do."""
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time


def once(program, scene, resolution, image):
    start = time.monotonic()
    process = subprocess.Popen([program, "render", scene, "-o", image, "--resolution", resolution, "--spp", "16777216", "--quiet"])
    while not os.path.exists(image) and process.poll() is None:
        time.sleep(0.001)
    seconds = time.monotonic() - start
    process.send_signal(signal.SIGINT)
    process.wait()
    return seconds


def main():
    program, scene = sys.argv[1:3]
    resolution = sys.argv[3] if len(sys.argv) > 3 else "256x256"
    turns = int(sys.argv[4]) if len(sys.argv) > 4 else 5
    seconds = []
    with tempfile.TemporaryDirectory() as folder:
        for turn in range(turns):
            seconds.append(once(program, scene, resolution, os.path.join(folder, "%d.png" % turn)))
    print("first pass on disk: best %.3f s, median %.3f s of %d" % (min(seconds), statistics.median(seconds), turns))


if __name__ == "__main__":
    main()
