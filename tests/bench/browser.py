"""A headless Chromium that tests talk to over pipes, by its DevTools protocol: real clicks, keys and screens."""

import json
import os
import signal
import subprocess
import tempfile
import time


class Browser:
    def __init__(self, chromium):
        # processes of its own may still write there when it has gone
        self.home = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, commands = os.pipe()
        answers, from_browser = os.pipe()

        def connect():  # the protocol is spoken on the file descriptors 3 and 4
            first, second = os.dup(to_browser), os.dup(from_browser)
            os.dup2(first, 3)
            os.dup2(second, 4)

        self.process = subprocess.Popen(
            [chromium, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", f"--user-data-dir={self.home.name}/profile", "--remote-debugging-pipe",
             "about:blank"],
            preexec_fn=connect, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "HOME": self.home.name}, start_new_session=True)
        os.close(to_browser)
        os.close(from_browser)
        self.commands, self.answers = os.fdopen(commands, "wb", 0), os.fdopen(answers, "rb", 0)
        self.number, self.rest, self.session = 0, b"", None
        self.complaints, self.requests = [], []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.home.cleanup()
        self.commands.close()
        self.answers.close()

    def _message(self):
        while b"\0" not in self.rest:
            piece = self.answers.read(1 << 16)
            assert piece, "the browser has gone"
            self.rest += piece
        text, _, self.rest = self.rest.partition(b"\0")
        return json.loads(text)

    def call(self, method, **parameters):
        """What the browser answers; what it says meanwhile of errors and of the network is kept."""
        self.number += 1
        order = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            order["sessionId"] = self.session
        self.commands.write(json.dumps(order).encode() + b"\0")
        while True:
            message = self._message()
            if message.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded"):
                self.complaints.append(message["params"])
            if message.get("method") == "Network.requestWillBeSent":
                self.requests.append(message["params"]["request"]["url"])
            if message.get("id") == self.number:
                assert "error" not in message, (method, message)
                return message["result"]

    def open(self, address, width, height=900, dark=False):
        """Shows the page in a fresh tab of this size."""
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in "Page", "Runtime", "Log", "Network":
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                  mobile=width < 600)
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
                            {"name": "prefers-reduced-motion", "value": "reduce"}])
        self.call("Page.navigate", url=address)
        self.wait_for("document.readyState === 'complete'")

    def evaluate(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in result, (expression, result)
        return result["result"].get("value")

    def wait_for(self, expression):
        """Until this is true, and drawn: Chromium goes to the target of a link once more, with its focus, when it draws
        the next frame, which would undo a click or a key that comes before."""
        end = time.monotonic() + 60
        while not self.evaluate(expression):
            assert time.monotonic() < end, expression
            time.sleep(0.02)
        two_frames = "new Promise(drawn => requestAnimationFrame(() => requestAnimationFrame(drawn)))"
        self.call("Runtime.evaluate", expression=two_frames, awaitPromise=True)

    def click(self, x, y):
        for kind in "mousePressed", "mouseReleased":
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def press(self, key, number):
        for kind in "keyDown", "keyUp":
            text = "\r" if key == "Enter" and kind == "keyDown" else ""
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=number, text=text)

    def pdf(self):
        """The page printed on A4, base64."""
        return self.call("Page.printToPDF", preferCSSPageSize=True)["data"]
