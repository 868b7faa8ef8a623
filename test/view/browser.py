"""Drives a headless chromium through the DevTools protocol, with Python's own library alone."""
import base64, json, os, re, shutil, signal, subprocess, tempfile, time
from urllib.parse import urlsplit

from live import Page

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")


def cannot_view(velo, browser=True):
    """Why `velo view` cannot be tested here, in a browser or without; None: it can."""
    if browser and not any(shutil.which(name) for name in PROGRAMS):
        return "there is no chromium"
    missing = subprocess.run([velo, "view", "missing.pbrt"], capture_output=True, text=True, timeout=60)
    return "velo was built without libwebsockets" if "without libwebsockets" in missing.stderr else None


class Socket(Page):
    """The DevTools connection: the same WebSocket, without velo's protocol."""

    def __init__(self, address):
        parts = urlsplit(address)
        view = type("Place", (), {"host": parts.hostname, "port": parts.port, "path": "/"})
        super().__init__(view, path=parts.path, origin="", protocol=None)


class Browser:
    def __init__(self, width=1280, height=720, dark=False, phone=False, more_flags=()):
        program = next(filter(None, map(shutil.which, PROGRAMS)), None)
        self.folder = tempfile.mkdtemp(prefix="velo-browser-")
        flags = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                 "--remote-debugging-port=0", "--remote-allow-origins=*", "--no-first-run", "--disable-background-networking",
                 "--disable-component-update", "--disable-sync", "--disable-extensions", "--mute-audio", "--hide-scrollbars",
                 f"--user-data-dir={self.folder}", f"--window-size={width},{height}", *more_flags, "about:blank"]
        self.process = subprocess.Popen([program, *flags], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                        start_new_session=True)
        address = ""
        for line in self.process.stderr:
            found = re.search(r"ws://\S+", line)
            if found:
                address = found.group(0)
                break
        if not address:
            raise RuntimeError("chromium did not start")
        self.next, self.events = 0, []
        self.socket = Socket(address)
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = None
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Page.enable")
        self.call("Runtime.enable")
        self.call("Log.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        if phone:
            self.call("Emulation.setTouchEmulationEnabled", enabled=True)

    def call(self, method, **parameters):
        self.next += 1
        message = {"id": self.next, "method": method, "params": parameters}
        if getattr(self, "session", None):
            message["sessionId"] = self.session
        self.socket.send_raw(1, json.dumps(message).encode())
        while True:
            answer = self.socket.receive(120)
            if isinstance(answer, tuple):
                raise ConnectionError(answer)
            if answer.get("id") == self.next:
                if "error" in answer:
                    raise RuntimeError(answer["error"])
                return answer["result"]
            self.events.append(answer)

    def open(self, address):
        self.call("Page.navigate", url=address)

    def run(self, script):
        """The value of a JavaScript expression; promises are awaited."""
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"].get("exception", {}).get("description", "error"))
        return result["result"].get("value")

    def wait(self, script, seconds=90):
        """Waits until the expression is true."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            try:
                value = self.run(script)
            except RuntimeError:
                value = None
            if value:
                return value
            time.sleep(0.05)
        raise TimeoutError(script)

    def mouse(self, kind, x, y, button="left", buttons=1, modifiers=0):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, buttons=buttons, clickCount=1, modifiers=modifiers)

    def drag(self, x0, y0, x1, y1, steps=8, modifiers=0):
        self.mouse("mousePressed", x0, y0, modifiers=modifiers)
        for i in range(1, steps + 1):
            self.mouse("mouseMoved", x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps, modifiers=modifiers)
        self.mouse("mouseReleased", x1, y1, buttons=0, modifiers=modifiers)

    def click(self, x, y):
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y, buttons=0)

    def click_on(self, selector):
        """Clicks on the middle of an element, once it can be clicked: nothing covers it, and it is not disabled."""
        name = json.dumps(selector)
        x, y = self.wait(f"(() => {{ const e = document.querySelector({name}); e.scrollIntoView({{block: 'center'}});"
                         "const b = e.getBoundingClientRect(), at = [b.x + b.width / 2, b.y + b.height / 2];"
                         "return !e.disabled && e.contains(document.elementFromPoint(...at)) ? at : null; })()")
        self.click(x, y)

    def type_into(self, selector, text):
        """Replaces the text of an input and presses Enter."""
        self.run(f"(() => {{ const e = document.querySelector({json.dumps(selector)}); e.focus(); e.value = {json.dumps(text)};"
                 "e.dispatchEvent(new Event('change', {bubbles: true})); e.blur(); })()")

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))

    def problems(self):
        """Errors that the page reported."""
        found = []
        for event in self.events:
            if event.get("method") == "Runtime.exceptionThrown":
                details = event["params"]["exceptionDetails"]
                found.append(details.get("exception", {}).get("description") or details["text"])
            if event.get("method") == "Log.entryAdded" and event["params"]["entry"]["level"] == "error":
                found.append(event["params"]["entry"]["text"])
        return found

    def end(self, kill=False):
        self.socket.close()
        os.killpg(self.process.pid, signal.SIGKILL if kill else signal.SIGTERM)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait(10)
        shutil.rmtree(self.folder, ignore_errors=True)
