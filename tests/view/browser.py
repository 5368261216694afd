# SPDX-License-Identifier: MIT
"""Drives a headless Chromium over the pipes of its debugging protocol."""
import base64
import json
import os
import signal
import subprocess
import tempfile
import time


class Browser:
    """One page at a time. Use as a context."""

    def __init__(self, program="chromium", size=(1280, 720), dark=False):
        self.profile = tempfile.TemporaryDirectory()
        to_child, self.to = os.pipe()
        self.back, from_child = os.pipe()

        def pipes():  # 3: it reads, 4: it writes
            os.dup2(to_child, 13)
            os.dup2(from_child, 14)
            os.dup2(13, 3)
            os.dup2(14, 4)

        self.process = subprocess.Popen(
            [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--no-first-run", "--hide-scrollbars",
             "--disable-background-networking", "--disable-component-update", "--force-device-scale-factor=1",
             "--remote-debugging-pipe", f"--window-size={size[0]},{size[1]}",
             f"--user-data-dir={self.profile.name}", "about:blank"],
            preexec_fn=pipes, close_fds=False, start_new_session=True,
            stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        os.close(to_child)
        os.close(from_child)
        self.pending = b""
        self.number = 0
        self.session = None
        self.events = []
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        self.call("Page.enable")
        self.call("Runtime.enable")
        self.call("Log.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1, mobile=False)
        if dark:
            self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        os.close(self.to)
        os.close(self.back)
        last = time.monotonic() + 30
        while os.path.exists(self.profile.name):  # processes that are about to end may still write
            try:
                self.profile.cleanup()
            except OSError:
                if time.monotonic() > last:
                    raise
                time.sleep(0.1)

    def call(self, method, **params):
        """The result of a command; what else comes in between is kept in events."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.pending:
                chunk = os.read(self.back, 1 << 20)
                if not chunk:
                    raise RuntimeError("the browser has ended")
                self.pending += chunk
            one, self.pending = self.pending.split(b"\0", 1)
            answer = json.loads(one)
            if answer.get("id") != self.number:
                self.events.append(answer)
                continue
            if "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']['message']}")
            return answer["result"]

    def open(self, url):
        self.call("Page.navigate", url=url)

    def evaluate(self, expression):
        r = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in r:
            raise RuntimeError(f"{expression}: {r['exceptionDetails']}")
        return r["result"].get("value")

    def wait(self, expression, seconds=60):
        end = time.monotonic() + seconds
        while not self.evaluate(f"Boolean({expression})"):
            if time.monotonic() > end:
                raise RuntimeError(f"still not so after {seconds} s: {expression}")
            time.sleep(0.02)

    def pointer(self, kind, x, y, modifiers=0, pen=False):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=0 if kind == "mouseReleased" else 1,
                  clickCount=1, modifiers=modifiers, pointerType="pen" if pen else "mouse")

    def drag(self, start, end, steps=10, pause=0.016, modifiers=0, pen=False):
        self.pointer("mousePressed", *start, modifiers, pen)
        for k in range(1, steps + 1):
            self.pointer("mouseMoved", start[0] + (end[0] - start[0]) * k / steps, start[1] + (end[1] - start[1]) * k / steps, modifiers, pen)
            time.sleep(pause)
        self.pointer("mouseReleased", *end, modifiers, pen)

    def touch(self, kind, *points):
        """touchStart, touchMove or touchEnd with the fingers that are there then."""
        self.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)])

    def two_fingers(self, starts, ends, steps=8):
        """One after the other they come down, move, and go."""
        self.touch("touchStart", starts[0])
        self.touch("touchStart", *starts)
        for k in range(1, steps + 1):
            self.touch("touchMove", *[tuple(a + (b - a) * k / steps for a, b in zip(s, e)) for s, e in zip(starts, ends)])
            time.sleep(0.02)
        self.touch("touchEnd")

    def key(self, key, modifiers=0):
        code = {"z": 90, " ": 32, "Tab": 9}.get(key, 0)
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, modifiers=modifiers, windowsVirtualKeyCode=code)

    def screenshot(self, path):
        with open(path, "wb") as f:
            f.write(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))

    def errors(self):
        """Exceptions and refusals that the page met."""
        self.evaluate("0")
        bad = [e["params"]["exceptionDetails"]["text"] for e in self.events if e.get("method") == "Runtime.exceptionThrown"]
        return bad + [e["params"]["entry"]["text"] for e in self.events
                      if e.get("method") == "Log.entryAdded" and e["params"]["entry"]["level"] == "error"]


def names(b):
    """All that has the keyboard's focus has a role and a name for screen readers."""
    nameless = []
    for node in b.call("Accessibility.getFullAXTree")["nodes"]:
        value = lambda key: node.get(key, {}).get("value")
        focusable = any(p["name"] == "focusable" and p["value"].get("value") for p in node.get("properties", []))
        if focusable and value("role") not in ("RootWebArea", "row") and not value("name"):
            nameless.append(node)
    assert not nameless, nameless[:3]


def focused(b):
    """What the keyboard's focus is on: the id of an element, else its text."""
    return b.evaluate("document.activeElement.id || document.activeElement.innerText")


def toolbar(b, bar="bar"):
    """One stop of the Tab key, from whose buttons arrow keys, Home and End lead to all that can be pressed; which these are."""
    stops = b.evaluate(f"[...document.querySelectorAll('#{bar} button')].filter((x) => x.tabIndex === 0).length")
    assert stops == 1, f"{stops} buttons are stops of Tab"
    usable = b.evaluate(f"""[...document.querySelectorAll('#{bar} button')].filter((x) => !x.disabled && x.checkVisibility())
                             .map((x) => x.id || x.innerText)""")
    b.evaluate("[...document.querySelectorAll('canvas')].find((x) => x.checkVisibility()).focus()")  # what comes after it
    b.key("Tab", modifiers=8)  # Shift: back
    assert focused(b) in usable, focused(b)
    b.key("Tab")
    assert focused(b) not in usable, focused(b)
    b.key("Tab", modifiers=8)
    b.key("Home")
    met = [focused(b)]
    for _ in usable[1:]:
        b.key("ArrowRight")
        met.append(focused(b))
    assert met == usable, (met, usable)
    b.key("ArrowRight")
    assert focused(b) == usable[0]
    for key, there in (("ArrowLeft", usable[-1]), ("ArrowLeft", usable[-2]), ("End", usable[-1]), ("Home", usable[0])):
        b.key(key)
        assert focused(b) == there, (key, focused(b))
    b.key("Tab")
    b.key("Tab", modifiers=8)
    assert focused(b) == usable[0], "Tab does not come back to where it left"
    return usable


def legible(b, least=4.5):
    """Words stand out from their ground as WCAG 2.1 (1.4.3) asks; controls that are off need not."""
    dim = b.evaluate("""(() => {
      const channels = (c) => (c.match(/[0-9.]+/g) || []).map(Number);
      const light = (c) => [0.2126, 0.7152, 0.0722].reduce((sum, w, i) => {
        const x = c[i] / 255;
        return sum + w * (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
      }, 0);
      const ground = (e) => {
        for (; e; e = e.parentElement) {
          const c = channels(getComputedStyle(e).backgroundColor);
          if (c.length === 3 || c[3] > 0.5) return c;
        }
        return [255, 255, 255];
      };
      return [...document.body.querySelectorAll('button, label, span, p, h1, h2, th, td, a, output')]
        .filter((e) => !e.closest(':disabled') && e.checkVisibility() && e.innerText && e.innerText.trim())
        .map((e) => {
          const pair = [light(channels(getComputedStyle(e).color)), light(ground(e))].sort((p, q) => q - p);
          return [(pair[0] + 0.05) / (pair[1] + 0.05), e.outerHTML.slice(0, 120)];
        });
    })()""")
    assert dim and min(dim)[0] >= least, min(dim)
