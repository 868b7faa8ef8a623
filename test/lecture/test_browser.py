#!/usr/bin/python3
"""The lecture's page in a browser (test/lecture/browser.html), in both languages and at two widths. Needs chromium."""
import functools
import html
import http.server
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading

ROOT = os.path.abspath(os.environ.get("VELO_SOURCE_DIR") or ".")


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def main():
    chromium = shutil.which("chromium")
    if not chromium:
        print("skip browser: needs chromium")
        return 77
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=ROOT))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    failed = 0
    for language, size in (("en", "1280,720"), ("it", "390,800")):
        with tempfile.TemporaryDirectory() as profile:
            done = subprocess.run(
                [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--user-data-dir=" + profile, "--window-size=" + size,
                 "--virtual-time-budget=20000", "--dump-dom",
                 "http://127.0.0.1:%d/test/lecture/browser.html?language=%s" % (server.server_port, language)],
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120)
        found = re.search(r'<pre id="result">(.*?)</pre>', done.stdout.decode(), re.S)
        lines = html.unescape(found.group(1)).split("\n") if found else []
        if "done" not in lines:
            lines.append("not ok browser: no result: %s" % done.stderr.decode(errors="replace")[-500:])
        for line in lines[:-1] if lines[-1] == "done" else lines:
            print(re.sub(r"^(ok|not ok) (\w+)", r"\1 %s_\2" % language, line))
            failed += line.startswith("not ok")
    server.shutdown()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
