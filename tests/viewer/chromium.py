"""A headless Chromium that is driven through the DevTools protocol, over two pipes.

Needs Python's standard library and Debian's package chromium alone.
"""
import base64
import json
import os
import re
import select
import shutil
import struct
import subprocess
import tempfile
import time
import zlib

FLAGS = [
    "--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--no-first-run",
    "--disable-quic", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--disable-dev-shm-usage", "--hide-scrollbars", "--mute-audio",
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=1280,800",
]


def find():
    """Returns the program's path, or None."""
    return os.environ.get("CHROMIUM") or shutil.which("chromium")


def plain(text):
    """Returns a message of the browser without the text of inlined scripts."""
    return re.sub(r"base64,[A-Za-z0-9+/=]+", "", text)


class Chromium:
    """One browser with one page. `errors` has the page's exceptions, console errors and refusals."""

    def __init__(self):
        self.profile = tempfile.mkdtemp(prefix="simwright-chromium-")
        to_read, self.to_browser = os.pipe()
        self.from_browser, to_write = os.pipe()

        def connect():  # in the child: the protocol's pipes are 3 and 4
            reading, writing = os.dup(to_read), os.dup(to_write)
            os.dup2(reading, 3)
            os.dup2(writing, 4)

        self.process = subprocess.Popen(
            [find(), *FLAGS, f"--user-data-dir={self.profile}", "about:blank"], close_fds=False,
            preexec_fn=connect, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self.received = b""
        self.number = 0
        self.session = None
        self.errors = []
        self.requests = []
        targets = self.call("Target.getTargets")["targetInfos"]
        page = next(target["targetId"] for target in targets if target["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *fault):
        self.close()

    def close(self):
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.to_browser)
        os.close(self.from_browser)
        shutil.rmtree(self.profile, ignore_errors=True)

    def call(self, method, **parameters):
        """Calls a method of the protocol and returns its result."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.to_browser, data):]
        while True:
            answer = self.receive()
            if answer.get("id") != self.number:
                self.note(answer)
            elif "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']['message']}")
            else:
                return answer["result"]

    def receive(self, seconds=120):
        while b"\0" not in self.received:
            if not select.select([self.from_browser], [], [], seconds)[0]:
                raise TimeoutError("Chromium does not answer")
            data = os.read(self.from_browser, 1 << 16)
            if not data:
                raise RuntimeError("Chromium has ended")
            self.received += data
        message, _, self.received = self.received.partition(b"\0")
        return json.loads(message)

    def note(self, event):
        parameters = event.get("params", {})
        if event.get("method") == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.errors.append(plain(details.get("exception", {}).get("description", details["text"])))
        elif event.get("method") == "Runtime.consoleAPICalled" and parameters["type"] == "error":
            self.errors.append(str([a.get("value", a.get("description")) for a in parameters["args"]]))
        elif event.get("method") == "Log.entryAdded" and parameters["entry"]["level"] == "error":
            self.errors.append(parameters["entry"]["text"])
        elif event.get("method") == "Network.requestWillBeSent":
            self.requests.append(parameters["request"]["url"])

    def size(self, width, height, mobile=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=mobile)

    def open(self, url):
        """Loads a page and waits until the viewer has drawn its content."""
        self.call("Page.navigate", url=url)
        self.wait("window.simwright && simwright.ready")

    def leave(self):
        """Shows an empty page; the former one asks its server for nothing more."""
        self.call("Page.navigate", url="about:blank")
        self.wait("location.href === 'about:blank' && document.readyState === 'complete'")

    def run(self, expression):
        """Returns the value of a JavaScript expression, or of the promise that it is."""
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True,
                           awaitPromise=True)
        if "exceptionDetails" in result:
            details = result["exceptionDetails"]
            raise RuntimeError(plain(details.get("exception", {}).get("description", details["text"])))
        return result["result"].get("value")

    def wait(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while not self.run(f"Boolean({condition})"):
            if time.monotonic() > end:
                raise TimeoutError(f"{condition}; errors of the page: {self.errors}")
            time.sleep(0.05)

    def settle(self):
        """Waits until two more frames of the page are shown."""
        self.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def drag(self, begin, end, button="left", steps=8):
        self.mouse("mousePressed", *begin, button=button, clickCount=1)
        for i in range(1, steps + 1):
            x, y = (a + (b - a) * i / steps for a, b in zip(begin, end))
            self.mouse("mouseMoved", x, y, button=button, buttons=1)
        self.mouse("mouseReleased", *end, button=button, clickCount=1)

    def click(self, x, y):
        self.mouse("mousePressed", x, y, button="left", clickCount=1)
        self.mouse("mouseReleased", x, y, button="left", clickCount=1)

    def key(self, key):
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, text=key if len(key) == 1 else "")
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def screenshot(self):
        """Returns a PNG of the page."""
        self.settle()
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])


def decode_png(data):
    """Returns (width, height, channels, rows) of an 8-bit PNG without interlacing."""
    at, parts, header = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            parts += body
        at += 12 + length
    width, height, depth, color, _, _, interlaced = header
    channels = {0: 1, 2: 3, 6: 4}[color]
    assert depth == 8 and interlaced == 0
    raw, stride, rows = zlib.decompress(parts), width * channels, []
    before = bytearray(stride)
    for y in range(height):
        begin = y * (stride + 1)
        kind, row = raw[begin], bytearray(raw[begin + 1:begin + 1 + stride])
        for i in range(stride):
            left = row[i - channels] if i >= channels else 0
            up = before[i]
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + up) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + up) // 2) & 255
            elif kind == 4:
                corner = before[i - channels] if i >= channels else 0
                estimate = left + up - corner
                a, b, c = abs(estimate - left), abs(estimate - up), abs(estimate - corner)
                best = left if a <= b and a <= c else up if b <= c else corner
                row[i] = (row[i] + best) & 255
        rows.append(row)
        before = row
    return width, height, channels, rows
