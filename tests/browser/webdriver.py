"""webdriver.py: a browser that tests drive: Chromium without a display, by W3C WebDriver, through chromedriver.

Of the protocol (https://www.w3.org/TR/webdriver2/) this has what the tests need. Nothing but Python's own library.
"""

import base64
import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the key of elements in the protocol
KEYS = {"right": "\ue014", "enter": "\ue007"}
PATIENCE = 240  # seconds that anything may take on a machine that is busy with other things


class WebDriverError(Exception):
    """What chromedriver refuses."""


def is_there():
    return bool(shutil.which("chromedriver") and shutil.which("chromium"))


class Browser:
    """A browser of its own, with an empty profile; gone after `with`."""

    def __init__(self, width=1280, height=720, arguments=()):
        self.folder = tempfile.mkdtemp()
        self.log = open(os.path.join(self.folder, "log"), "w+b")
        self.session = self.driver = None
        try:
            # A group of its own: Chromium goes with it, whatever state that is in.
            self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=self.log, stderr=self.log,
                                           start_new_session=True, env={**os.environ, "TMPDIR": self.folder})
            self.address = "http://127.0.0.1:%d" % self._port()
            self.session = self._ask("POST", "/session", {"capabilities": {"alwaysMatch": {
                "browserName": "chrome",
                "goog:loggingPrefs": {"browser": "ALL"},
                "goog:chromeOptions": {"binary": shutil.which("chromium"), "args": self._arguments(
                    width, height, arguments)},
            }}})["sessionId"]
        except BaseException:
            self.close()
            raise

    def _arguments(self, width, height, more):
        found = ["--headless=new", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", "--hide-scrollbars",
                 "--window-size=%d,%d" % (width, height), "--user-data-dir=" + os.path.join(self.folder, "profile")]
        return found + (["--no-sandbox"] if os.geteuid() == 0 else []) + list(more)

    def _port(self):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end and self.driver.poll() is None:
            with open(self.log.name, "rb") as log:
                found = re.search(rb"successfully on port (\d+)", log.read())
            if found:
                return int(found.group(1))
            time.sleep(0.05)
        raise WebDriverError("chromedriver does not start")

    def _ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.address + path, data, {"Content-Type": "application/json"},
                                         method=method)
        try:
            with urllib.request.urlopen(request, timeout=2 * PATIENCE) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as refusal:
            raise WebDriverError(json.load(refusal)["value"]["message"]) from None

    def ask(self, method, path, body=None):
        return self._ask(method, "/session/%s%s" % (self.session, path), body)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        try:
            if self.session:
                self.ask("DELETE", "")
        finally:
            if self.driver:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(self.driver.pid, signal.SIGKILL)
                self.driver.wait()
            self.log.close()
            shutil.rmtree(self.folder, ignore_errors=True)

    def open(self, address):
        self.ask("POST", "/url", {"url": address})

    def reload(self):
        self.ask("POST", "/refresh", {})

    def run(self, script, *arguments):
        """What the JavaScript function body returns; it may wait for promises."""
        return self.ask("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def find(self, selector):
        return self.ask("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def click(self, selector):
        self.ask("POST", "/element/%s/click" % self.find(selector), {})

    def type(self, selector, text):
        self.ask("POST", "/element/%s/value" % self.find(selector), {"text": text})

    def press(self, text):
        actions = [{"type": kind, "value": letter} for letter in text for kind in ("keyDown", "keyUp")]
        self.ask("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def point(self, x, y):
        self.ask("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [
            {"type": "pointerMove", "x": int(x), "y": int(y), "duration": 0}]}]})

    def drag(self, start, end):
        moves = [{"type": "pointerMove", "x": int(x), "y": int(y), "duration": 50} for x, y in (start, end)]
        self.ask("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [
            moves[0], {"type": "pointerDown", "button": 0}, moves[1], {"type": "pointerUp", "button": 0}]}]})

    def wheel(self, x, y, lines):
        self.ask("POST", "/actions", {"actions": [{"type": "wheel", "id": "wheel", "actions": [
            {"type": "scroll", "x": int(x), "y": int(y), "deltaX": 0, "deltaY": lines, "duration": 0}]}]})

    def tab(self):
        return self.ask("GET", "/window")

    def new_tab(self):
        return self.ask("POST", "/window/new", {"type": "tab"})["handle"]

    def turn_to(self, tab):
        self.ask("POST", "/window", {"handle": tab})

    def close_tab(self):
        self.ask("DELETE", "/window")

    def command(self, name, parameters=None):
        """A command of Chromium's own protocol (https://chromedevtools.github.io/devtools-protocol/)."""
        return self.ask("POST", "/goog/cdp/execute", {"cmd": name, "params": parameters or {}})

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.ask("GET", "/screenshot")))

    def messages(self):
        """Of the browser's console, since they were last asked for: {"level", "source", "message"}."""
        return self.ask("POST", "/se/log", {"type": "browser"})

    def resize(self, width, height):
        self.command("Emulation.setDeviceMetricsOverride",
                     {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
