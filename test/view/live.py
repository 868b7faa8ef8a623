"""A client of `velo view` for tests, with Python's own library alone: starts the program, speaks HTTP and WebSocket."""
import base64, json, os, select, signal, socket, struct, subprocess, threading, time
from urllib.parse import urlsplit


def heed_interrupts():
    """Background jobs of a shell ignore SIGINT, and their children inherit it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class Refused(Exception):
    pass


class View:
    """A running `velo view`."""

    def __init__(self, program, scene, *options, cwd=None, env=None, opens=False):
        no = [] if opens else ["--no-open"]
        self.process = subprocess.Popen([program, "view", scene, *no, *options], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True, cwd=cwd, env=env,
                                        preexec_fn=heed_interrupts)
        ready, _, _ = select.select([self.process.stdout], [], [], 60)
        self.address = self.process.stdout.readline().strip() if ready else ""
        if not self.address:
            self.process.kill()
            raise RuntimeError("no address: " + self.process.stderr.read())
        parts = urlsplit(self.address)
        self.host, self.port, self.path = parts.hostname, parts.port, parts.path

    def get(self, path, host=None, method="GET"):
        """Status and body of a request."""
        with socket.create_connection((self.host, self.port), 10) as s:
            s.sendall(f"{method} {path} HTTP/1.1\r\nHost: {host or f'{self.host}:{self.port}'}\r\n"
                      "Connection: close\r\n\r\n".encode())
            answer = b""
            while True:
                part = s.recv(65536)
                if not part:
                    break
                answer += part
        head, _, body = answer.partition(b"\r\n\r\n")
        words = head.split(b" ")
        return (int(words[1]) if len(words) > 1 else 0), body

    def end(self, number=signal.SIGINT):
        """Ends the program. Returns its exit code and what it reported."""
        self.process.send_signal(number)
        try:
            _, errors = self.process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        return self.process.returncode, errors


class Frame:
    """The header and the tiles of a frame."""

    def __init__(self, data):
        names = ("type serial change width height x0 y0 scale columns rows format channels channel spp tiles "
                 "denoised").split()
        for name, value in zip(names, struct.unpack("<16I", data[:64])):
            setattr(self, name, value)
        self.size, self.parts, at = len(data), [], 64
        for _ in range(self.tiles):
            x, y, w, h = struct.unpack("<4H", data[at:at + 8])
            n = w * h * self.channels * (2 if self.format == 0 else 4)
            self.parts.append((x, y, w, h, data[at + 8:at + 8 + n]))
            at += 8 + (n + 3) // 4 * 4
        assert at == len(data), "a frame has bytes that no tile has"


class Page:
    """A page: a WebSocket of a View."""

    def __init__(self, view, path=None, host=None, origin=None, protocol="velo-view"):
        self.socket = socket.create_connection((view.host, view.port), 10)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # as browsers do
        host = host or f"{view.host}:{view.port}"
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [f"GET {path or view.path + 'socket'} HTTP/1.1", f"Host: {host}", "Upgrade: websocket",
                 "Connection: Upgrade", f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
        if origin != "":
            lines.append(f"Origin: {origin or 'http://' + host}")
        if protocol:
            lines.append(f"Sec-WebSocket-Protocol: {protocol}")
        self.buffer, self.texts, self.frames, self.pixels = b"", [], 0, None
        self.sending = threading.Lock()  # edits may come from a thread of their own
        try:
            self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
            while b"\r\n\r\n" not in self.buffer:
                part = self.socket.recv(65536)
                if not part:
                    raise Refused(self.buffer)
                self.buffer += part
        except (ConnectionError, Refused) as error:
            self.socket.close()
            raise Refused(str(error))
        head, _, self.buffer = self.buffer.partition(b"\r\n\r\n")
        if b" 101 " not in head.split(b"\r\n")[0]:
            self.socket.close()
            raise Refused(head)

    def send_raw(self, opcode, data, final=True, masked=True):
        first, n = (0x80 if final else 0) | opcode, len(data)
        head = bytes([first, (0x80 if masked else 0) | (n if n < 126 else 126 if n < 65536 else 127)])
        head += b"" if n < 126 else struct.pack("!H", n) if n < 65536 else struct.pack("!Q", n)
        mask = os.urandom(4) if masked else b""
        if masked:
            data = bytes(b ^ mask[i % 4] for i, b in enumerate(data))
        with self.sending:
            self.socket.sendall(head + mask + data)

    def send(self, **message):
        self.send_raw(1, json.dumps(message).encode())

    def take(self, n, until):
        while len(self.buffer) < n:
            self.socket.settimeout(max(0.001, until - time.monotonic()))
            part = self.socket.recv(1 << 20)
            if not part:
                raise ConnectionError("closed")
            self.buffer += part
        data, self.buffer = self.buffer[:n], self.buffer[n:]
        return data

    def receive(self, seconds=60):
        """The next message: a dict, a Frame, or ("closed", code, reason)."""
        until, whole, kind = time.monotonic() + seconds, b"", 0
        while True:
            first, second = self.take(2, until)
            n = second & 0x7f
            if n == 126:
                n = struct.unpack("!H", self.take(2, until))[0]
            elif n == 127:
                n = struct.unpack("!Q", self.take(8, until))[0]
            data, opcode = self.take(n, until), first & 15
            if opcode == 8:
                return "closed", struct.unpack("!H", data[:2])[0] if n >= 2 else 0, data[2:].decode()
            if opcode == 9:
                self.send_raw(10, data)
            if opcode > 2:
                continue
            kind, whole = kind or opcode, whole + data
            if not first & 0x80:
                continue
            if kind == 1:
                return json.loads(whole)
            frame = Frame(whole)
            self.draw(frame)
            self.send(type="seen", serial=frame.serial)
            return frame

    def draw(self, frame):
        """Puts the tiles into self.pixels, as the page does."""
        size = frame.channels * (2 if frame.format == 0 else 4)
        form = (frame.width, frame.height, frame.x0, frame.y0, frame.scale, frame.columns, frame.rows, frame.format,
                frame.channels, frame.channel)
        if self.pixels is None or form != self.form:
            self.form, self.pixels = form, bytearray(frame.columns * frame.rows * size)
        for x, y, w, h, data in frame.parts:
            for row in range(h):
                at = ((y + row) * frame.columns + x) * size
                self.pixels[at:at + w * size] = data[row * w * size:(row + 1) * w * size]

    def wait(self, test, seconds=90):
        """The next message for which the test holds."""
        until, seen = time.monotonic() + seconds, []
        while time.monotonic() < until:
            try:
                message = self.receive(until - time.monotonic())
            except TimeoutError:
                break
            if isinstance(message, tuple):
                raise ConnectionError(message)
            if test(message):
                return message
            seen.append("frame" if isinstance(message, Frame) else message)
        raise TimeoutError("%d other messages, the last: %s" % (len(seen), seen[-5:]))

    def wait_text(self, kind, seconds=90):
        return self.wait(lambda m: isinstance(m, dict) and m["type"] == kind, seconds)

    def wait_frame(self, test=lambda f: True, seconds=90):
        return self.wait(lambda m: isinstance(m, Frame) and test(m), seconds)

    def close(self):
        self.socket.close()
