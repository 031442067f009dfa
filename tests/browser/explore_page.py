"""explore_page.py: what a user of `psplat explore` does, in Chromium, and what must come of it.

Each test starts a server of its own on a copy of a small scene, and a page of its own in one browser. Environment:
PSPLAT, the program; PAGE_CHANGES, how many changes the test of memory makes (default: 150).
"""

import json
import math
import os
import re
import signal
import socket
import subprocess
import tempfile
import time
import unittest
import urllib.request

from webdriver import KEYS, PATIENCE, Browser

SCENE = """psd: 1
parameters:
  lamp: {default: 2, help: intensity of the lamp}
camera: {location: [0, 1, -2.9], look_at: [0, 1, 0]}
lights:
  - point: {location: [0, 1.8, 0], intensity: =lamp}
materials:
  white: {diffuse: 0.7}
  red: {diffuse: [0.7, 0.1, 0.1]}
objects:
  - box: {corners: [[-1.5, 0, -3], [1.5, 2, 2]], material: white}
  - box: {corners: [[-1, 0, 0], [-0.4, 0.8, 1]], material: red}
"""
OPTIONS = ["--size", "64x36", "--plugin", "injection=photon:count=500", "--plugin", "denoiser=none"]
os.environ["MALLOC_ARENA_MAX"] = "1"  # glibc: memory that is measured goes by what is kept, not by how many threads there were
CHANGES = int(os.environ.get("PAGE_CHANGES", "150"))


class Server:
    """`psplat explore` of a scene of its own."""

    def __init__(self, scene, options=()):
        self.folder = tempfile.TemporaryDirectory()
        self.scene = os.path.join(self.folder.name, "scene.psd")
        self.write(scene)
        self.process = subprocess.Popen([os.environ["PSPLAT"], "explore", self.scene, "--no-browser", *options],
                                        stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        if not re.fullmatch(r"http://127\.0\.0\.1:\d+/[0-9a-f]{32}/", self.address):
            self.close()
            raise AssertionError("psplat explore printed %r" % self.address)

    def write(self, text):
        """As editors save: the whole at once."""
        with open(self.scene + ".new", "w") as file:
            file.write(text)
        os.rename(self.scene + ".new", self.scene)

    def get(self, path):
        with urllib.request.urlopen(self.address + path, timeout=PATIENCE) as answer:
            return json.load(answer)

    def state(self):
        return self.get("state")

    def put(self, path, body):
        request = urllib.request.Request(self.address + path, json.dumps(body).encode(),
                                         {"Content-Type": "application/json"}, method="PUT")
        urllib.request.urlopen(request, timeout=PATIENCE).close()

    def memory(self):
        """Resident, in bytes."""
        with open("/proc/%d/status" % self.process.pid) as status:
            return 1024 * int(re.search(r"VmRSS:\s*(\d+)", status.read()).group(1))

    def close(self):
        """The exit status after SIGINT; of one that goes on regardless, that of SIGKILL."""
        self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.wait()
        finally:
            self.process.stdout.close()
            self.folder.cleanup()


def is_bad(message):
    """An error of the page. Refusals and pictures of a view that has just gone are not."""
    if message["level"] != "SEVERE":
        return False
    return message["source"] != "network" or not re.search(r"\b(404|422)\b", message["message"])


class Explore(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.browser.resize(1280, 720)

    def setUp(self):
        self.server = Server(SCENE, OPTIONS)
        self.addCleanup(lambda: self.assertEqual(self.server.close(), 0, "status after SIGINT"))
        self.addCleanup(lambda: self.browser.open("about:blank"))
        self.browser.open(self.server.address)
        self.wait("the first picture", lambda: self.canvas_sum("a") > 0)

    def tearDown(self):
        bad = [message["message"] for message in self.browser.messages() if is_bad(message)]
        self.assertEqual(bad, [], "errors of the page")

    # --- what tests ask and do ---

    def wait(self, what, condition):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            found = condition()
            if found:
                return found
            time.sleep(0.05)
        return self.fail("waited in vain for " + what)

    def canvas_sum(self, view):
        """A number that changes with the canvas of a pane; 0: nothing is drawn."""
        return self.browser.run("""
            const canvas = document.querySelector(`.pane.${arguments[0]} canvas`);
            if (canvas.width === 0 || canvas.height === 0)
                return 0;
            const bytes = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
            let sum = 0;
            for (let i = 0; i < bytes.length; i++)
                sum = (sum * 31 + bytes[i]) % 1000000007;
            return bytes.some((byte) => byte > 0) ? sum + 1 : 0;""", view)

    def brightness(self):
        """The mean of the bytes of A's canvas."""
        return self.browser.run("""
            const canvas = document.querySelector(".pane.a canvas");
            const bytes = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
            return bytes.reduce((sum, byte) => sum + byte, 0) / bytes.length;""")

    def text(self, selector):
        return self.browser.run("return document.querySelector(arguments[0])?.textContent ?? ''", selector)

    def is_seen(self, selector):
        return self.browser.run("return document.querySelector(arguments[0])?.checkVisibility() ?? false", selector)

    def control(self, name):
        return '.control[data-name="%s"]' % name

    def choose(self, selector, value):
        self.browser.run("""
            const select = document.querySelector(arguments[0]);
            select.value = arguments[1];
            select.dispatchEvent(new Event("change", {bubbles: true}));""", selector, value)

    def enter(self, name, value):
        field = self.control(name) + " input:not([type=range])"
        self.browser.run("document.querySelector(arguments[0]).select()", field)
        self.browser.type(field, value + KEYS["enter"])

    def middle(self, view):
        return self.browser.run("""
            const box = document.querySelector(`.pane.${arguments[0]} canvas`).getBoundingClientRect();
            return [box.left + box.width / 2, box.top + box.height / 2];""", view)

    def command(self):
        return self.text("#command")

    def press(self, keys):
        self.browser.run("document.activeElement.blur()")
        self.browser.press(keys)

    def set_at_once(self, **values):
        """Fields by the names of their controls, faster than the page sends what changes."""
        self.browser.run("""
            for (const [name, value] of Object.entries(arguments[0])) {
                const field = document.querySelector(`.control[data-name="${name}"] input:not([type=range])`);
                field.value = value;
                field.dispatchEvent(new Event("change"));
            }""", values)

    def hold(self, pattern, method="GET"):
        """Requests of that kind get no further, until they are let go."""
        self.browser.run("""
            const [pattern, method] = arguments, send = window.fetch;
            window.held = 0;
            const free = new Promise((resolve) => { window.letGo = () => { window.fetch = send; resolve(); }; });
            window.fetch = (path, init) => {
                if (!path.match(pattern) || (init?.method ?? "GET") !== method)
                    return send(path, init);
                window.held++;
                return free.then(() => send(path, init));
            };""", pattern, method)

    def wait_for_held(self):
        self.wait("a request", lambda: self.browser.run("return window.held") > 0)

    def let_go(self):
        self.browser.run("window.letGo()")

    def compare(self):
        self.press("c")
        self.wait("view B", lambda: self.is_seen(".pane.b canvas") and self.canvas_sum("b") > 0)
        self.wait("B's settings", lambda: self.browser.run("return document.querySelector('[value=b]').checked"))

    def rest(self):
        """Waits until all is rendered, and the page knows."""
        def is_done():
            views = [view for view in self.server.state()["views"].values() if view]
            return all(not view["stage"] and view["passes"] == view["passes_wanted"] for view in views) and all(
                "pass %d of" % view["passes"] in self.text("figcaption[data-view=%s] .progress" % name)
                for name, view in zip("ab", views))
        self.wait("all passes", is_done)

    def put_options(self, view, *more, passes=2):
        """More of them than the views have at first, past the page."""
        first = [[OPTIONS[i][2:], OPTIONS[i + 1]] for i in range(0, len(OPTIONS), 2)]
        self.server.put("view/" + view, {"options": first + [list(option) for option in more], "passes": passes})

    # --- tests ---

    def test_refines(self):
        self.choose(self.control("estimator") + " select", "pathtrace")
        self.wait("path tracing", lambda: self.server.state()["views"]["a"]["strategies"]["estimator"] == "pathtrace")
        first = self.wait("a pass", lambda: re.search(r"pass (\d+) of", self.text(".pane.a .progress")))
        before = self.canvas_sum("a")
        self.wait("more passes", lambda: int((re.search(r"pass (\d+) of", self.text(".pane.a .progress")) or
                                              first).group(1)) > int(first.group(1)))
        self.wait("other pixels", lambda: self.canvas_sum("a") != before)
        self.assertIn("estimator=pathtrace", self.command())

    def test_parameters(self):
        self.rest()
        before = self.canvas_sum("a")
        self.choose(self.control("estimator") + " select", "splat")
        self.wait("the command", lambda: "estimator=splat" in self.command())
        self.wait("another picture", lambda: self.canvas_sum("a") != before)
        self.assertTrue(self.is_seen(self.control("estimator") + " .reset"), "the way back")
        self.enter("count", "700")
        self.wait("the command", lambda: "count=700" in self.command())
        self.enter("lamp", "3")
        self.wait("the command", lambda: "lamp=3" in self.command())
        # What is refused is said beside the control, and changes nothing.
        self.enter("count", "-5")
        self.wait("a refusal", lambda: self.is_seen(self.control("count") + " .error"))
        self.assertIn("count", self.text(self.control("count") + " .error"))
        self.assertIn("count=700", self.command())
        self.enter("count", "600")
        self.wait("no refusal", lambda: not self.is_seen(self.control("count") + " .error"))
        self.wait("the command", lambda: "count=600" in self.command())
        self.enter("passes", "many")
        self.wait("a refusal", lambda: "1..65536" in self.text(self.control("passes") + " .error"))
        self.assertEqual(self.browser.run("return document.querySelector(arguments[0]).value",
                                          self.control("passes") + " .number"), "many")
        self.browser.click("#reset-all")
        self.wait("the scene as its file has it", lambda: "lamp" not in self.command())

    def test_refusals_leave_other_changes(self):
        """Of changes that are sent together the page takes back those alone that are refused."""
        self.set_at_once(lamp="3", count="-5", seed="7")
        self.wait("a refusal", lambda: self.is_seen(self.control("count") + " .error"))
        self.wait("the others", lambda: "lamp=3" in self.command() and "--seed 7" in self.command())
        self.assertNotIn("count=-5", self.command())
        self.assertFalse(self.is_seen(self.control("lamp") + " .error"))
        self.assertFalse(self.is_seen(self.control("seed") + " .error"))

    def test_changes_keep_their_order(self):
        """A change whose request is slow comes before a later one all the same."""
        self.hold("view/a", "PUT")
        self.set_at_once(seed="5")
        self.wait_for_held()
        self.set_at_once(seed="6")
        time.sleep(0.4)  # it would be sent by now
        self.assertEqual(self.browser.run("return window.held"), 1)
        self.let_go()
        self.wait("both", lambda: "--seed 6" in self.command())
        time.sleep(0.4)
        self.assertIn(["seed", "6"], self.server.state()["views"]["a"]["options"])

    def test_repeats_by_its_command(self):
        """The command line below the picture makes the same picture."""
        self.enter("passes", "2")
        self.choose(self.control("estimator") + " select", "photonmap")
        self.wait("two passes of it", lambda: re.search(r"photonmap.* --passes 2$", self.command()) and
                  self.server.state()["views"]["a"]["stage"] == "")
        made = os.path.join(self.server.folder.name, "made.exr")
        command = self.command().replace("psplat", os.environ["PSPLAT"], 1)
        subprocess.run(command + " -q -o " + made, shell=True, check=True)
        self.press("e")
        self.choose("#reference-kind", "file")
        self.browser.type("#reference-file", made + KEYS["enter"])
        self.wait("the file", lambda: "made.exr" in self.text("#reference-state"))
        metrics = self.server.get("compare?layer=picture&of=a&against=reference")["metrics"]
        self.assertEqual([metric["value"] for metric in metrics if metric["name"] == "max"], [0])

    def test_pan_zoom_and_values(self):
        self.rest()  # now nothing but what is done here changes the canvas
        box = self.middle("a")
        self.browser.point(*box)
        self.wait("values", lambda: re.fullmatch(r"x 3[12] y 1[78]", self.text("#at")))
        self.assertEqual(len(re.findall(r"\d\.?\d*", self.text("#value-a"))), 3)
        self.press("p")
        self.wait("the pixel", lambda: self.is_seen("#probe") and "indirect" in self.text("#probe-values"))
        self.assertRegex(self.text("#probe-title"), r"Pixel 3[12], 1[78]")
        self.browser.click("#probe-close")
        self.browser.point(*box)
        fitted = self.text("#zoom")
        self.browser.wheel(*box, -240)
        self.wait("a zoom", lambda: self.text("#zoom") != fitted)
        zooms = [float(text.split()[0]) for text in (self.text("#zoom"), fitted)]
        self.assertAlmostEqual(zooms[0] / zooms[1], 2, delta=0.02)
        self.press("1")
        self.wait("1:1", lambda: self.text("#zoom") == "100 %")
        before = self.canvas_sum("a")
        self.press("\ue014")
        self.wait("a pan", lambda: self.canvas_sum("a") != before)
        before = self.canvas_sum("a")
        self.browser.drag(box, (box[0] - 30, box[1] + 10))
        self.wait("a pan by the mouse", lambda: self.canvas_sum("a") != before)
        self.press("f")
        self.wait("the whole", lambda: self.text("#zoom") == fitted)
        for layer in ("display", "picture"):
            self.choose("#layer", layer)
            self.wait("the layer", lambda layer=layer: self.text("#value-a").startswith(layer))
            before = self.brightness()
            self.press("]]")
            self.wait("exposure", lambda before=before: self.brightness() > 1.1 * before)
            self.assertEqual(self.text("#exposure-value"), "+1")
            self.press("0")
            self.wait("as it was", lambda before=before: self.brightness() < 1.02 * before)
        # A slider that was moved keeps the focus, and leaves the page its keys.
        self.browser.click("#exposure")
        self.assertEqual(self.browser.run("return document.activeElement.id"), "exposure")
        self.browser.press("1")
        self.wait("1:1", lambda: self.text("#zoom") == "100 %")
        self.browser.point(*box)
        for layer in ("direct", "indirect", "albedo", "N", "P", "Z"):
            self.choose("#layer", layer)
            self.wait(layer, lambda layer=layer: self.text("#value-a").startswith(layer + " "))

    def test_compares(self):
        self.compare()
        self.choose(self.control("estimator") + " select", "ambient")
        self.wait("two methods", lambda: self.text(".name.b") == "B · ambient")
        self.assertNotIn("ambient", self.text(".name.a"))
        self.rest()
        self.press("e")
        self.wait("metrics", lambda: "rel_rmse" in self.text("#metrics"))
        self.assertNotRegex(self.text("#metrics"), "NaN|undefined")
        for mode in ("slider", "difference", "flip"):
            before = self.canvas_sum("a")
            self.press("m")
            self.wait(mode, lambda before=before: self.canvas_sum("a") not in (0, before))
            self.assertFalse(self.is_seen(".pane.b canvas"))
        self.assertIn("FLIP", self.text("#legend-text"))
        self.choose("#mode", "slider")
        x, y = self.middle("a")
        self.browser.drag((x, y), (x + 100, y))
        self.wait("the divider", lambda: self.browser.run("return document.querySelector('#split').value > 0.55"))
        self.press("c")
        self.wait("A alone", lambda: not self.is_seen(".pane.b canvas") and not self.is_seen(".name.b"))

    def test_second_view_comes_back(self):
        """Compare, pressed again, makes B anew; a change of B that is under way when it is closed does not."""
        self.compare()
        self.choose(self.control("estimator") + " select", "ambient")
        self.wait("B's method", lambda: self.text(".name.b") == "B · ambient")
        for is_sent in (False, True):
            if is_sent:
                self.hold("view/b", "PUT")
            self.set_at_once(seed="5")
            if is_sent:
                self.wait_for_held()
            self.press("c")
            if is_sent:
                self.let_go()
            self.wait("A alone", lambda: not self.is_seen(".pane.b canvas") and not self.server.state()["views"]["b"])
            time.sleep(0.5)
            self.assertIsNone(self.server.state()["views"]["b"], "B stays closed")
            self.compare()
            self.assertEqual(self.text(".name.b")[1:], self.text(".name.a")[1:], "a copy of A")

    def test_refused_second_view(self):
        self.enter("lamp", "3")
        self.wait("the command", lambda: "lamp=3" in self.command())
        self.server.write(SCENE.replace("lamp", "bulb"))
        self.wait("the error", lambda: self.is_seen("#problem"))
        # It is the option that is wrong, not the scene.
        self.assertIn("does not take the options", self.text("#problem-title"))
        self.assertIn("unknown parameter 'lamp'", self.text("#problem-text"))
        self.press("c")
        self.wait("a refusal", lambda: "View B can't be made" in self.text("#problem-title"))
        self.assertIn("unknown parameter 'lamp'", self.text("#problem-text"))
        self.browser.click("#reset-all")
        self.wait("none", lambda: not self.is_seen("#problem"))
        self.compare()

    def test_layer_of_one_view(self):
        """The layer `error` is made by one denoiser alone, and by no preview."""
        self.put_options("a", ("plugin", "denoiser=regression"))
        self.wait("the layer", lambda: self.browser.run(
            "return Array.from(document.querySelectorAll('#layer option'), (o) => o.value).includes('error')"))
        self.choose("#layer", "error")
        self.compare()
        self.assertNotIn("no layer", self.text("figcaption[data-view=b]"))
        self.put_options("b")
        self.wait("word of it", lambda: "has no layer error" in self.text("figcaption[data-view=b]"))
        self.wait("no picture of before", lambda: self.canvas_sum("b") == 0)
        self.assertNotEqual(self.canvas_sum("a"), 0)
        self.choose("#mode", "difference")
        self.wait("word of it", lambda: self.text("#legend-text") == "View B has no layer error.")
        self.choose("#mode", "side")
        self.put_options("a", ("plugin", "denoiser=regression"), ("seed", "8"))
        self.rest()
        self.assertEqual(self.browser.run("return document.querySelector('#layer').value"), "error")
        self.put_options("a")
        self.put_options("b", ("plugin", "denoiser=regression"))
        self.wait("word of it", lambda: "has no layer error" in self.text("figcaption[data-view=a]"))
        self.rest()
        self.assertEqual(self.browser.run("return document.querySelector('#layer').value"), "error")
        self.assertNotEqual(self.canvas_sum("b"), 0)

    def test_maps_and_metrics_are_of_what_is_shown(self):
        self.compare()
        self.put_options("b", ("seed", "9"))
        self.press("e")
        self.choose("#mode", "flip")
        self.rest()
        self.wait("a map", lambda: "rel_rmse" in self.text("#metrics") and self.canvas_sum("a") > 0)
        self.hold("^compare")
        self.choose("#layer", "indirect")
        self.wait("no map of before", lambda: self.canvas_sum("a") == 0)
        self.assertEqual(self.text("#metrics"), "")
        self.assertEqual(self.text("#metrics-empty"), "Measuring.")
        self.let_go()
        self.wait("the new", lambda: "rel_rmse" in self.text("#metrics") and self.canvas_sum("a") > 0)

    def test_reference(self):
        self.press("e")
        self.enter_reference("16")
        self.wait("a plot", lambda: self.browser.run("return document.querySelectorAll('#plot .dot.a').length") > 0)
        self.assertRegex(self.text("#plot"), "CPU seconds")
        self.assertRegex(self.text("#plot"), "%")
        self.wait("metrics", lambda: "rel_rmse" in self.text("#metrics"))
        self.choose("#reference-kind", "file")
        self.browser.type("#reference-file", "no.exr" + KEYS["enter"])
        self.wait("a refusal", lambda: "no.exr" in self.text("#reference-error"))
        self.browser.click("#reference-drop")
        self.wait("no reference", lambda: self.text("#reference-state") == "none")

    def enter_reference(self, samples):
        self.browser.run("document.querySelector('#reference-samples').select()")
        self.browser.type("#reference-samples", samples + KEYS["enter"])
        self.wait("a reference", lambda: "path tracer" in self.text("#reference-state"))

    def test_scene_errors(self):
        self.rest()
        before, picture = self.canvas_sum("a"), self.server.state()["views"]["a"]["picture"]
        self.server.write(SCENE.replace("diffuse", "difuse", 1))
        self.wait("the error", lambda: self.is_seen("#problem"))
        self.assertRegex(self.text("#problem"), r"scene\.psd:\d+:\d+")
        self.assertIn("^", self.text("#problem-text"))
        self.assertNotEqual(self.canvas_sum("a"), 0, "the picture from before, in less room")
        self.assertEqual(self.server.state()["views"]["a"]["picture"], picture)
        self.server.write(SCENE.replace("default: 2,", "default: 4,"))
        self.wait("it is mended", lambda: not self.is_seen("#problem"))
        self.wait("another picture", lambda: self.canvas_sum("a") not in (0, before))
        self.wait("the parameter's value", lambda: self.browser.run(
            "return document.querySelector(arguments[0]).value", self.control("lamp") + " input") == "4")

    def test_probe(self):
        """One place in pictures of two sizes; what there is during a preview."""
        self.compare()
        self.put_options("b", ("size", "32x18"))
        self.rest()
        self.browser.drag(self.middle("a"), self.middle("a"))
        self.wait("both", lambda: re.search("B 1[56], [89]", self.text("#probe-values")))
        self.assertRegex(self.text("#probe-title"), "Pixel 3[12], 1[78]")
        self.assertEqual(self.text("#probe-values").count("indirect"), 2)
        self.wait("no more", lambda: self.text("#probe-note") == "")
        self.press("c")
        self.put_options("a", ("plugin", "estimator=pathtrace:samples=1000"), ("size", "1280x360"))
        self.wait("a preview", lambda: self.text(".pane.a .progress").startswith("preview"))
        self.browser.click("#probe-close")
        self.assertFalse(self.is_seen("#probe"))
        self.browser.drag(self.middle("a"), self.middle("a"))
        self.wait("word of it", lambda: self.is_seen("#probe-note"))
        self.assertEqual(self.text("#probe-note"), "The first pass brings its values.")
        self.assertEqual(self.text("#probe-values"), "")

    def test_light(self):
        """Lines from the photons to the pixel that is probed."""
        self.rest()
        self.browser.drag(self.middle("a"), self.middle("a"))
        self.wait("the pixel", lambda: self.is_seen("#probe") and "indirect" in self.text("#probe-values"))
        plain = self.canvas_sum("a")
        self.browser.click("#probe-light")
        self.wait("the light", lambda: "photons of the first pass" in self.text("#probe-light-text"))
        self.assertRegex(self.text("#probe-light-text"), r"^[\d.e-]+ W/m² by \d+ of \d+ photons")
        self.wait("lines", lambda: self.canvas_sum("a") != plain)
        self.browser.click("#probe-light")
        self.wait("no lines", lambda: self.canvas_sum("a") == plain)
        self.assertEqual(self.text("#probe-light-text"), "")
        self.browser.click("#probe-light")
        self.wait("lines again", lambda: self.canvas_sum("a") != plain)
        self.browser.click("#probe-close")
        self.wait("no pixel, no lines", lambda: self.canvas_sum("a") == plain)

    def test_colours(self):
        """An exposure of what is encoded already: 0.5 is 0.214 in linear light, and 0.428 is 0.686. Dithered."""
        found = self.browser.run("""
            const samples = new Float32Array(3 * 64 * 64).map((_, i) => [0.5, 0, 1][i % 3]);
            return import("./colour.js").then(({paintLayer}) => [0, 1, -1].map((exposure) => {
                const {data} = paintLayer({width: 64, height: 64, channels: 3, samples}, "display", exposure);
                return [0, 1, 2, 3].map((c) => {
                    const bytes = data.filter((_, i) => i % 4 === c);
                    return [Math.min(...bytes), bytes.reduce((a, b) => a + b, 0) / bytes.length, Math.max(...bytes)];
                });
            }));
            """)
        expected = [[127.5, 0, 255, 255], [174.9, 0, 255, 255], [92, 0, 187.5, 255]]
        for channels, means in zip(found, expected):
            for (least, mean, largest), value in zip(channels, means):
                self.assertAlmostEqual(mean, value, delta=0.1)
                self.assertEqual((least, largest), (math.floor(value), math.ceil(value)))

    def test_options(self):
        """The page's reading and writing of options, without the program."""
        self.assertEqual(self.browser.run("""
            return import("./options.js").then((o) => {
                const list = [["size", "8x8"], ["plugin", "estimator=splat:at=[1,2,3],samples=4"],
                    ["param", "lamp=3=4"]];
                const stated = o.statedPlugin(list, "estimator");
                return [stated.name, [...stated.parameters], o.statedAssignment(list, "param", "lamp"),
                    o.withParameter(list, "estimator", "splat", "samples", "9")[1][1],
                    o.withParameter(list, "estimator", "gather", "samples", "9")[1][1],
                    o.withParameter([], "estimator", "gather", "samples", null),
                    o.withPlugin(list, "estimator", null).length, o.withOption(list, "seed", "1").pop(),
                    o.statedPlugin([...list, ["plugin", "estimator=splat:samples=7"]], "estimator").parameters.size];
            });"""), [
                "splat", [["at", "[1,2,3]"], ["samples", "4"]], "3=4", "estimator=splat:at=[1,2,3],samples=9",
                "estimator=gather:samples=9", [], 2, ["seed", "1"], 2])

    def test_numbers(self):
        """Sliders reach all of their range, the default at a third where that is wide; ticks lie inside."""
        found = self.browser.run("""
            return import("./numbers.js").then(({sliderOf, logTicks, short}) => {
                const row = {type: "integer", minimum: 1, maximum: 65536, default: "8"}, slider = sliderOf(row);
                return [slider.position(8), slider.value(0), slider.value(1), slider.value(slider.position(500)),
                    sliderOf({type: "number", minimum: 0, maximum: 1, default: "0.5"}).value(0.25),
                    sliderOf({type: "number", minimum: 0, default: "1"}), logTicks(0.02, 0.3),
                    [0, 1234.5, 1.23456, 1e-9, NaN].map((value) => short(value)),
                    [[7.3, 9.6], [1.05, 1.4], [0.31, 0.45], [1e-5, 1e3]].map(([low, high]) => logTicks(low, high).filter(
                        (tick) => tick >= low && tick <= high).length >= 2)];
            });""")
        self.assertAlmostEqual(found[0], 1 / 3)
        self.assertEqual(found[1:], [1, 65536, 500, 0.25, None, [0.02, 0.05, 0.1, 0.2],
                                     ["0", "1235", "1.23", "1.00e-9", "nan"], [True] * 4])

    def test_two_tabs(self):
        first = self.browser.tab()
        second = self.browser.new_tab()
        self.browser.turn_to(second)
        self.browser.open(self.server.address)
        self.wait("a picture in the second tab", lambda: self.canvas_sum("a") > 0)
        self.choose(self.control("estimator") + " select", "ambient")
        self.wait("the change", lambda: "ambient" in self.command())
        self.browser.turn_to(first)
        self.wait("the change in the first tab", lambda: "ambient" in self.command())
        self.browser.turn_to(second)
        self.browser.close_tab()
        self.browser.turn_to(first)
        self.enter("seed", "7")
        self.wait("a change in the first tab", lambda: "ambient" in self.command() and "--seed 7" in self.command())

    def test_reload(self):
        self.press("c")
        self.wait("view B", lambda: self.is_seen(".pane.b canvas"))
        self.choose("#layer", "indirect")
        self.choose("#mode", "slider")
        self.enter("seed", "7")
        self.wait("the seed", lambda: "--seed 7" in self.command())
        time.sleep(0.5)  # the look is stored when it has been quiet for 0.3 s
        self.browser.reload()
        self.wait("the picture", lambda: self.canvas_sum("a") > 0)
        looks = "return ['layer', 'mode'].map((id) => document.getElementById(id).value).join()"
        self.wait("the same look", lambda: self.browser.run(looks) == "indirect,slider")
        self.browser.click("#edited [value=b]")
        self.wait("the same settings", lambda: "--seed 7" in self.command())

    def test_small_window(self):
        self.browser.resize(800, 600)
        self.press("ce")
        self.wait("view B", lambda: self.is_seen(".pane.b canvas"))
        try:
            self.assertEqual(self.browser.run("""
                return Array.from(document.querySelectorAll("body *:not(#controls *)"))
                    .filter((element) => element.checkVisibility())
                    .filter((element) => {
                        const {right, bottom} = element.getBoundingClientRect();
                        return right > innerWidth + 1 || bottom > innerHeight + 1;
                    }).map((element) => `${element.tagName} ${element.id} ${element.className}`);"""), [],
                "nothing lies outside of the window")
            sizes = self.browser.run("""
                return ["a", "b"].map((view) => {
                    const {clientWidth, clientHeight} = document.querySelector(`.pane.${view} canvas`);
                    return Math.min(clientWidth, clientHeight);
                });""")
            self.assertGreater(min(sizes), 150, "pictures have room")
        finally:
            self.browser.resize(1280, 720)

    def test_names(self):
        """Each control has a name for those who do not see it."""
        nameless = self.browser.run("""
            return Array.from(document.querySelectorAll("button, input, select, canvas, [role=img]"))
                .filter((element) => !(element.textContent.trim() && element.tagName === "BUTTON") &&
                    !element.ariaLabel && !(element.labels && element.labels.length > 0))
                .map((element) => element.outerHTML);""")
        self.assertEqual(nameless, [])

    def test_slow_reader(self):
        """Who asks for events and reads none delays nobody."""
        host, port, token = re.fullmatch(r"http://([^:]+):(\d+)/(\w+)/", self.server.address).groups()
        readers = []
        for _ in range(8):
            reader = socket.create_connection((host, int(port)))
            reader.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
            reader.sendall(("GET /%s/events HTTP/1.1\r\nHost: %s:%s\r\n\r\n" % (token, host, port)).encode())
            readers.append(reader)
        for seed in range(2, 12):
            self.enter("seed", str(seed))
            self.wait("seed %d" % seed, lambda seed=seed: "--seed %d" % seed in self.command())
        for reader in readers:
            reader.close()
        self.enter("seed", "99")
        self.wait("a change after that", lambda: "--seed 99" in self.command())

    def page_memory(self):
        """What the page holds, in bytes, after a collection; and its nodes."""
        self.browser.command("HeapProfiler.collectGarbage")
        usage = self.browser.command("Runtime.getHeapUsage")
        counters = self.browser.command("Memory.getDOMCounters")
        return usage["usedSize"] + usage.get("backingStorageSize", 0), counters["nodes"] + counters["jsEventListeners"]

    def change_often(self, count, first_seed):
        field = self.control("seed") + " input"
        for seed in range(first_seed, first_seed + count):
            self.browser.run("""
                const field = document.querySelector(arguments[0]);
                field.value = arguments[1];
                field.dispatchEvent(new Event("change"));""", field, str(seed))
            self.wait("seed %d" % seed, lambda seed=seed: "--seed %d" % seed in self.command())
            if seed % 10 == 0:  # let a picture come through, and another strategy's controls
                self.choose(self.control("estimator") + " select", "splat" if seed % 20 else "ambient")
                picture = self.server.state()["views"]["a"]["picture"]
                self.wait("a picture", lambda picture=picture: self.server.state()["views"]["a"]["picture"] > picture)

    def test_memory(self):
        self.change_often(20, 1000)  # until what is kept for good is there
        server, (page, nodes) = self.server.memory(), self.page_memory()
        self.change_often(CHANGES, 2000)
        server_after, (page_after, nodes_after) = self.server.memory(), self.page_memory()
        print("%d changes: server %+.1f MB, page %+.2f MB, %+d nodes and listeners" % (
            CHANGES, (server_after - server) / 1e6, (page_after - page) / 1e6, nodes_after - nodes))
        # A picture with its layers is 180 kB in the server, and one layer 27 kB in the page.
        self.assertLess(server_after - server, 1e6 + 30e3 * CHANGES, "the server's growth")
        self.assertLess(page_after - page, 0.5e6 + 8e3 * CHANGES, "the page's growth")
        self.assertLess(nodes_after - nodes, 200, "the page's growth in nodes and listeners")


if __name__ == "__main__":
    unittest.main(verbosity=2)
