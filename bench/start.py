#!/usr/bin/python3
"""How soon after its start a program has an image on disk, and how much processor time it has used by then.
Usage: script/bench start SCENE... [--program PROGRAM]... [--resolution WxH] [--turns N] [--json FILE]
Programs (default: this build) and scenes take turns. Wall-clock times: the machine should have nothing else to do."""
import argparse
import json
import os
import resource
import signal
import statistics
import subprocess
import sys
import tempfile
import time


def once(program, scene, resolution, image):
    """Seconds until the image of the first pass is there, and user seconds of the process, which is then stopped. During
    a render the image so far is in NAME.part.png."""
    part = image.replace(".png", ".part.png")
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    start = time.monotonic()
    process = subprocess.Popen([program, "render", scene, "-o", image, "--resolution", resolution, "--spp", "16777216", "--quiet"])
    while not (os.path.exists(part) or os.path.exists(image)) and process.poll() is None:
        time.sleep(0.001)
    seconds = time.monotonic() - start
    if process.poll() is not None:
        sys.exit("start: %s ended without an image of %s" % (program, scene))
    process.send_signal(signal.SIGTERM)
    process.wait()
    return seconds, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    parser.add_argument("--program", action="append")
    parser.add_argument("--resolution", default="256x256")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--json", default=os.path.join(os.environ["VELO_SOURCE_DIR"], "bench/results/start.json"))
    options = parser.parse_args()
    programs = options.program or [os.environ["VELO"]]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for scene in options.scenes:
            times = {program: [] for program in programs}
            for turn in range(options.turns):
                for program in programs:
                    image = os.path.join(folder, "%d.png" % len(os.listdir(folder)))
                    times[program].append(once(program, scene, options.resolution, image))
            for program in programs:
                seconds = [s for s, _ in times[program]]
                user = statistics.median(u for _, u in times[program])
                print("%s, %s: first image after %.3f s (best), %.3f s (median of %d); %.2f user s" %
                      (os.path.basename(scene), program, min(seconds), statistics.median(seconds), options.turns, user))
                rows.append({"scene": os.path.basename(scene), "program": os.path.basename(program), "best": min(seconds),
                             "median": statistics.median(seconds), "user_seconds": user})
    with open(options.json, "w") as file:
        json.dump({"bench": "start", "resolution": options.resolution, "turns": options.turns, "rows": rows}, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
