"""A page in headless Chromium, over the DevTools protocol."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import websocket

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
"""What the program is called on different systems."""


def find() -> str | None:
    """The browser's program; None if there is none."""
    return next((path for name in NAMES if (path := shutil.which(name))), None)


class Page:
    """One tab. Events that tell of faults and of what was asked for are kept."""

    def __init__(self, address: str) -> None:
        self._socket = websocket.create_connection(address, timeout=240, suppress_origin=True)
        self._count = 0
        self.faults: list[str] = []
        self.requested: list[str] = []
        self._loaded = False
        for domain in ("Page", "Runtime", "Log", "Network"):
            self._ask(f"{domain}.enable")

    def _hear(self, message: dict[str, Any]) -> None:
        given = message.get("params", {})
        match message.get("method"):
            case "Runtime.exceptionThrown":
                self.faults.append(json.dumps(given["exceptionDetails"]))
            case "Runtime.consoleAPICalled" if given["type"] in ("error", "assert"):
                self.faults.append(json.dumps(given["args"]))
            case "Log.entryAdded" if given["entry"]["level"] == "error":
                self.faults.append(given["entry"]["text"] + " " + given["entry"].get("url", ""))
            case "Network.requestWillBeSent":
                self.requested.append(given["request"]["url"])
            case "Page.loadEventFired":
                self._loaded = True

    def _ask(self, method: str, **given: Any) -> dict[str, Any]:
        self._count += 1
        self._socket.send(json.dumps({"id": self._count, "method": method, "params": given}))
        while True:
            message = json.loads(self._socket.recv())
            if message.get("id") == self._count:
                assert "error" not in message, message
                return message["result"]
            self._hear(message)

    def open(self, file: Path, width: int, height: int = 900, fragment: str = "") -> None:
        """Loads a file in a window of so many CSS pixels; ``fragment`` is the part of the address from #."""
        self._ask(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600
        )
        # Another fragment of the page that is shown would not load it again.
        for address in ("about:blank", file.resolve().as_uri() + fragment):
            self._loaded = False
            self._ask("Page.navigate", url=address)
            while not self._loaded:
                self._hear(json.loads(self._socket.recv()))

    def run(self, script: str) -> Any:
        """The value of an expression, which may be a promise."""
        found = self._ask("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def until(self, script: str, seconds: float = 20) -> None:
        """Waits for an expression to be true."""
        end = time.monotonic() + seconds
        while not self.run(script):
            assert time.monotonic() < end, f"never: {script}"
            time.sleep(0.05)

    def before_scripts(self, script: str) -> None:
        """Runs a script in each page that is opened from now on, before its own."""
        self._ask("Page.addScriptToEvaluateOnNewDocument", source=script)

    def mouse(self, *places: tuple[float, float]) -> None:
        """Presses the left button at the first place, CSS pixels, moves through the others and releases it."""
        (x, y), *others = places
        button = {"button": "left", "buttons": 1, "clickCount": 1}
        self._ask("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        self._ask("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, **button)
        for x, y in others:
            self._ask("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, **button)
        self._ask("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, **button)

    def give_file(self, selector: str, file: Path) -> None:
        """Chooses a file in an input of the page."""
        root = self._ask("DOM.getDocument")["root"]["nodeId"]
        node = self._ask("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self._ask("DOM.setFileInputFiles", nodeId=node, files=[str(file.resolve())])

    def picture(self, path: Path, whole: bool = False) -> None:
        """Saves what is to be seen, or the whole page, as PNG."""
        found = self._ask("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        path.write_bytes(base64.b64decode(found["data"]))


@contextmanager
def browser(profile: Path) -> Iterator[Page]:
    """A browser of its own, which ends with the block; `profile` is a folder for what it writes."""
    program = find()
    assert program is not None
    profile.mkdir(parents=True, exist_ok=True)
    # Without the sandbox, which root in a container does not have; it shows files of ours alone. WebGL in software.
    options = [
        "--headless",
        "--no-sandbox",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--hide-scrollbars",
        "--remote-debugging-port=0",
    ]
    with (profile / "log.txt").open("w") as log:
        child = subprocess.Popen(
            [program, *options, f"--user-data-dir={profile}", "about:blank"], stderr=log, stdout=log
        )
    try:
        # The first line is the port that it chose, the second the browser's own address.
        file = profile / "DevToolsActivePort"
        end = time.monotonic() + 60
        while not file.exists() or file.read_text().count("\n") < 1:
            assert child.poll() is None and time.monotonic() < end, (profile / "log.txt").read_text()
            time.sleep(0.05)
        port, own = file.read_text().split()
        socket = websocket.create_connection(f"ws://127.0.0.1:{port}{own}", timeout=30, suppress_origin=True)
        socket.send(json.dumps({"id": 1, "method": "Target.getTargets"}))
        while (answer := json.loads(socket.recv())).get("id") != 1:
            pass
        tab = next(target["targetId"] for target in answer["result"]["targetInfos"] if target["type"] == "page")
        yield Page(f"ws://127.0.0.1:{port}/devtools/page/{tab}")
        socket.close()
    finally:
        child.terminate()
        try:
            child.wait(10)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
