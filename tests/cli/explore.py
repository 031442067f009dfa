"""explore.py: starts `psplat explore` and asks it for things, well-meant and hostile; for test_explore.sh.

Prints what is wrong, a line each; the exit status says whether anything was.
"""
import contextlib
import errno
import http.client
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import time

for name in ("DISPLAY", "WAYLAND_DISPLAY"):
    os.environ.pop(name, None)
os.environ["MALLOC_ARENA_MAX"] = "1"  # glibc: memory that is measured goes by what is kept, not by how many threads there were
PSPLAT = os.environ["PSPLAT"]
SLOW = float(os.environ.get("EXPLORE_PATIENCE", "60"))  # seconds that a busy machine may take
failures = 0

SCENE = """psd: 1
parameters:
  lamp: {default: 10, help: how bright}
cameras:
  left: {location: [-1, 1, -4], look_at: [0, 1, 0], vertical_angle: 40}
  front: {location: [0, 1, -4], look_at: [0, 1, 0], vertical_angle: 40}
image: {width: 64, height: 36}
materials: {white: {diffuse: [0.7, 0.6, 0.5]}}
lights:
  - spotlight: {location: [0, 3, -1], point_at: [0, 0, 0], radius: 40, falloff: 50, intensity: [=lamp, =lamp, =lamp]}
include: [part.psd]
"""
PART = """psd: 1
objects:
  - quad: {corners: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: white}
  - box: {corners: [[-0.5, 0, -0.5], [0.5, 1, 0.5]], material: white}
"""


def check(good, what):
    global failures
    if not good:
        failures += 1
        print("FAILED:", what)


def check_same(value, expected, what):
    check(value == expected, f"{what}: {value!r}, expected {expected!r}")


def wait_for(condition, what, seconds=SLOW):
    """What the condition returns once that is true; None, a failure, after so many seconds."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.05)
    check(False, f"waited {seconds} s for {what}")
    return None


class Server:
    """The program under test, and requests to it."""

    def __init__(self, *words):
        self.err = open("err", "ab")
        self.process = subprocess.Popen([PSPLAT, "explore", "--no-browser", *words], stdout=subprocess.PIPE,
                                        stderr=self.err, stdin=subprocess.DEVNULL, text=True)
        self.address = self.process.stdout.readline().strip()
        match = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/([0-9a-f]{32})/", self.address)
        if not match:
            self.kill()
            raise AssertionError(f"address: {self.address!r}")
        self.port, self.token = int(match[1]), match[2]

    def ask(self, method, path, body=None, headers=None, whole=None):
        """Status, headers and body of the answer to a path below the token, or `whole`."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=SLOW)
        given = dict(headers or {})
        if body is not None:
            given.setdefault("Content-Type", "application/json")
        try:
            connection.request(method, whole or f"/{self.token}/{path}", body, given)
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            connection.close()

    def get(self, path):
        status, _, body = self.ask("GET", path)
        check_same(status, 200, f"GET {path}")
        return body

    def json(self, path):
        return json.loads(self.get(path))

    def put(self, path, value, expected=204):
        status, _, body = self.ask("PUT", path, json.dumps(value))
        check_same(status, expected, f"PUT {path} {value} {body[:300]}")
        return json.loads(body) if body else None

    def view(self, name):
        return self.json("state")["views"][name]

    def finished(self, name="a"):
        """The state of a view when all its passes are shown."""
        def done():
            view = self.view(name)
            return view if view and not view["stage"] and view["passes"] == view["passes_wanted"] else None
        return wait_for(done, f"view {name} to be finished")

    def picture(self, layer, view="a"):
        """Width, height, channels, number and samples."""
        body = self.get(f"picture/{view}?layer={layer}")
        width, height, channels, number = struct.unpack_from("<4I", body)
        check_same(len(body), 16 + 4 * width * height * channels, f"length of {layer}")
        return width, height, channels, number, struct.unpack_from(f"<{width * height * channels}f", body, 16)

    def metrics(self, query):
        return {row["name"]: row["value"] for row in self.json("compare?" + query)["metrics"]}

    def kilobytes(self):
        with open(f"/proc/{self.process.pid}/status") as status:
            return int(re.search(r"VmRSS:\s*(\d+)", status.read())[1])

    def cpu_seconds(self):
        with open(f"/proc/{self.process.pid}/stat") as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return sum(int(ticks) for ticks in fields[11:13]) / os.sysconf("SC_CLK_TCK")

    def stop(self, number=signal.SIGINT):
        start = time.monotonic()
        self.process.send_signal(number)
        status = self.process.wait(SLOW)
        check_same(status, 0, "exit status after a signal")
        check_same(self.process.stdout.read(), "", "what follows the address")
        return time.monotonic() - start

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()
        self.err.close()


@contextlib.contextmanager
def serving(*words):
    """Stopped at the end as a user stops it, if nothing has stopped it before."""
    server = Server(*words)
    try:
        yield server
        if server.process.poll() is None:
            server.stop()
    finally:
        server.kill()


def write(path, text):
    with open(path + ".new", "w") as file:
        file.write(text)
    os.replace(path + ".new", path)


def options(*pairs, passes=2):
    return {"options": [list(pair) for pair in pairs], "passes": passes}


SPLAT = ("plugin", "estimator=splat:gather_rays=0")
FEW = ("plugin", "injection=photon:count=500")
RAW = ("plugin", "denoiser=none")
SMALL = options(SPLAT, FEW, RAW)


# --- what it shows ---------------------------------------------------------------------------------------

def test_page(server):
    status, headers, body = server.ask("GET", "")
    check_same(status, 200, "the page")
    check(b"<html" in body, "the page is HTML")
    check_same(headers["Content-Type"], "text/html; charset=utf-8", "its type")
    check("default-src 'none'" in headers["Content-Security-Policy"], "a policy")
    check_same(headers["X-Content-Type-Options"], "nosniff", "nosniff")
    check_same(headers["Referrer-Policy"], "no-referrer", "no referrer")
    check_same(headers["Cache-Control"], "no-store", "no cache")
    check_same(headers["Access-Control-Allow-Origin"], None, "no other origins")
    folder = os.path.join(os.environ["PSPLAT_SOURCE"], "src/explore/page")
    types = {"html": "text/html; charset=utf-8", "css": "text/css; charset=utf-8",
             "js": "text/javascript; charset=utf-8", "svg": "image/svg+xml"}
    for name in os.listdir(folder):
        status, headers, body = server.ask("GET", name)
        with open(os.path.join(folder, name), "rb") as file:
            check(status == 200 and body == file.read(), f"{name} is the page's own")
        check_same(headers["Content-Type"], types[name.rpartition(".")[2]], f"type of {name}")


def test_catalogue(server):
    catalogue = server.json("catalogue")
    listed = subprocess.run([PSPLAT, "plugins"], capture_output=True, text=True, check=True).stdout
    names = re.findall(r"^  (\w+) ", listed, re.MULTILINE)
    check_same([plugin["name"] for kind in catalogue["kinds"] for plugin in kind["plugins"]], names, "plugins")
    gather = next(plugin for kind in catalogue["kinds"] if kind["kind"] == "estimator"
                  for plugin in kind["plugins"] if plugin["name"] == "gather")
    rows = {row["name"]: row for row in gather["parameters"]}
    check_same([rows["samples"][key] for key in ("type", "minimum", "by_quality", "expert")],
               ["integer", 1, True, False], "gather's samples")
    check(rows["surfels"]["expert"], "gather's surfels are for experts")
    check_same(catalogue["cameras"], ["left", "front"], "cameras")
    check_same([(row["name"], row["value"], row["help"]) for row in catalogue["parameters"]],
               [("lamp", "10", "how bright")], "parameters of the scene")
    check({"size", "quality", "bounces", "seed", "exposure"} <= {row["name"] for row in catalogue["options"]},
          "options")
    check("render.aa_samples" in {row["name"] for row in catalogue["sets"]}, "sets")


def test_picture_is_the_command_s(server):
    server.put("view/a", options(SPLAT, FEW, ("param", "lamp=5"), ("camera", "front"), passes=3))
    view = server.finished()
    check_same(view["strategies"]["estimator"], "splat", "the estimator")
    check_same(view["parameters"]["injection"], {"count": "500"}, "parameters that are given")
    check_same([view["values"][name] for name in ("size", "camera")], ["64x36", "front"], "values")
    check(view["cpu_seconds"] >= 0 and view["seconds"] > 0, "times")
    subprocess.run(view["command"].replace("psplat", PSPLAT, 1) + " -q -o again.exr", shell=True, check=True)
    server.put("reference", {"file": "again.exr"})
    for layer in ("picture", "indirect", "direct", "N"):
        check_same(server.metrics(f"layer={layer}&against=reference")["max"], 0, f"difference of {layer}")
    check_same(server.ask("DELETE", "reference")[0], 204, "DELETE reference")
    width, height, channels, number, samples = server.picture("display")
    check_same((width, height, channels, number), (64, 36, 3, view["picture"]), "the head of a picture")
    check(0 <= min(samples) < max(samples) <= 1, "display is 0..1")
    check_same(server.picture("weight")[2], 1, "channels of a layer")
    names = {layer["name"]: layer["channels"] for layer in view["layers"]}
    check_same([names.get(name) for name in ("picture", "indirect", "N", "Z", "display")], [3, 3, 3, 1, 3], "layers")
    pixel = server.json("pixel/a?x=32&y=30")["layers"]
    check_same(pixel["picture"], list(server.picture("picture")[4][3 * (30 * 64 + 32):][:3]), "a pixel")
    check_same(server.ask("GET", "pixel/a?x=64&y=30")[0], 404, "a pixel beyond")
    light = server.json("light/a?x=32&y=30")
    check(light["photons"] >= light["count"] > 0, "photons light the floor")
    check_same(len(light["sources"]), min(light["count"], 500), "sources")
    brought = [sum(source["irradiance"]) for source in light["sources"]]
    check(all(a >= 0.99 * b for a, b in zip(brought, brought[1:])), "sources by brightness")
    if light["count"] <= 500:
        check(abs(sum(brought) / sum(light["irradiance"]) - 1) < 1e-3, "the sources make the light")
    check(any("place" in source and source["seen"] for source in light["sources"]), "some are seen")
    check_same(server.ask("GET", "light/a?x=64&y=30")[0], 422, "the light of a pixel beyond")
    check_same(server.ask("GET", "light/a?x=32&y=0")[0], 422, "the light of nothing")
    check_same(server.ask("GET", "light/b?x=32&y=30")[0], 422, "the light of a view that is not there")
    check_same(server.ask("GET", "light/c?x=32&y=30")[0], 404, "the light of no view")
    check_same(server.ask("GET", "light/a?x=1.5&y=30")[0], 404, "the light of no pixel")
    check_same(server.ask("GET", "picture/a?layer=none")[0], 404, "no such layer")
    check_same(server.ask("GET", "picture/a")[0], 404, "no layer")


def test_changes(server):
    server.put("view/a", SMALL)
    before = server.finished()
    for pairs, message in (
            ([("plugin", "estimator=none_such")], "none_such"),
            ([("plugin", "estimator=splat:radius=x")], "radius"),
            ([("size", "0x9")], "--size"),
            ([("size", "65536x65536")], "memory"),
            ([("param", "lamp=[")], "lamp"),
            ([("param", "none=1")], "none"),
            ([("camera", "back")], "back"),
            ([("threads", "1")], "threads"),
            ([("allow-scene-plugins", "")], "allow-scene-plugins"),
            ([("plugin", "estimator=./mine.so")], "file")):
        answer = server.put("view/a", options(*pairs), 422)
        check(answer and message in answer["message"], f"{pairs}: {answer}")
    for body in ("", "{", "[]", "{}", '{"options": [], "passes": 02}', '{"options": [["size"]]}', '{"options": [["size", 3]]}', '{"options": {}}',
                 '{"options": [], "passes": 0}', '{"options": [], "passes": "2"}', '{"options": [["a\\u0000", ""]]}',
                 '{"options": [["seed", "\\ud800"]]}', "[" * 60000):
        status, _, _ = server.ask("PUT", "view/a", body)
        check_same(status, 422, f"PUT {body[:40]}")
    after = server.view("a")
    check_same((after["options"], after["picture"]), (before["options"], before["picture"]), "the view is as it was")
    check_same(server.ask("PUT", "view/c", "{}")[0], 404, "no such view")
    check_same(server.ask("DELETE", "view/a")[0], 404, "the first view stays")
    check_same(server.ask("POST", "view/a", "{}")[0], 405, "another method")
    check_same(server.ask("DELETE", "catalogue")[0], 405, "another method")


def test_cancels(server):
    """A picture that takes minutes gives way to another."""
    server.put("view/a", options(("plugin", "estimator=pathtrace:samples=1000"), RAW, ("size", "1280x360")))
    wait_for(lambda: server.view("a")["stage"] not in ("", "loading", "preview"), "a long render to begin")
    view = server.view("a")
    check_same(view["preview"], True, "the preview")
    check(9000 < view["width"] * view["height"] <= 230400, f"a preview of {view['width']}x{view['height']}")
    check(abs(view["width"] / view["height"] * 360 / 1280 - 1) < 0.02, f"a preview of {view['width']}x{view['height']}")
    start = time.monotonic()
    server.put("view/a", SMALL)
    view = server.finished()
    check(time.monotonic() - start < SLOW / 4, f"{time.monotonic() - start:.1f} s until another picture")
    check_same((view["width"], view["height"], view["strategies"]["estimator"]), (64, 36, "splat"), "the other picture")
    used = server.cpu_seconds()
    time.sleep(0.5)
    check(server.cpu_seconds() - used < 0.1, f"{server.cpu_seconds() - used:.2f} s of work when all is done")


# --- a scene that is edited -----------------------------------------------------------------------------

def test_scene_errors(server):
    server.put("view/a", SMALL)
    server.finished()
    before = server.json("state")
    write("scene.psd", SCENE.replace("lights:", "lihgts:"))
    error = wait_for(lambda: server.json("state")["scene_error"], "the scene's error")
    check_same((error["file"], error["line"], error["column"]), ("scene.psd", 9, 1), "its place")
    check("did you mean 'lights'?" in error["message"] and "^~~~~~" in error["message"], "its text")
    check_same(server.view("a")["picture"], before["views"]["a"]["picture"], "the last picture")
    check(server.picture("picture"), "which can be had")
    server.put("view/a", options(SPLAT, FEW, RAW, ("seed", "3")))  # can't be judged now
    write("scene.psd", SCENE)
    wait_for(lambda: not server.json("state")["scene_error"], "the scene to be mended")
    view = server.finished()
    check(view["picture"] > before["views"]["a"]["picture"], "a new picture")
    check_same(view["values"]["seed"], "3", "with what was asked for meanwhile")
    check(server.json("state")["catalogue"] > before["catalogue"], "a new catalogue")
    write("part.psd", PART.replace("[0.5, 1, 0.5]", "[0.5, 1]"))
    error = wait_for(lambda: server.json("state")["scene_error"], "the error of a part")
    check_same((error["file"], error["line"]), ("part.psd", 4), "its place")
    write("part.psd", PART)
    wait_for(lambda: not server.json("state")["scene_error"], "the part to be mended")
    server.finished()


# --- two views and a reference ---------------------------------------------------------------------------

def test_compares(server):
    server.put("view/a", SMALL)
    check_same(server.view("b"), None, "no second view")
    check_same(server.ask("GET", "compare?layer=picture")[0], 404, "nothing to compare with")
    check_same(server.ask("GET", "picture/b?layer=picture")[0], 404, "nor to see")
    server.put("view/b", options(("plugin", "estimator=pathtrace:samples=4"), RAW))
    server.finished("a")
    server.finished("b")
    metrics = server.metrics("layer=display")
    check(0 < metrics["rel_rmse"] < 1 and {"flip", "psnr", "ssim", "bias R"} <= set(metrics), f"metrics {metrics}")
    for metric, value in (("flip", "flip"), ("difference", "max")):
        body = server.get(f"compare_map?layer=display&metric={metric}")
        check_same(struct.unpack_from("<3I", body), (64, 36, 1), "the head of a map")
        pixels = struct.unpack_from(f"<{64 * 36}f", body, 16)
        found = max(pixels) if value == "max" else sum(pixels) / len(pixels)
        check(abs(found - metrics[value]) < 1e-4, f"map of {metric}: {found}, not {metrics[value]}")
    check_same(server.ask("GET", "compare_map?layer=display&metric=x")[0], 422, "no such map")
    check_same(server.ask("GET", "compare?layer=x")[0], 422, "no such layer")
    check_same(server.ask("DELETE", "view/b")[0], 204, "DELETE view/b")
    check_same(server.view("b"), None, "no second view again")


def test_reference(server):
    os.mkfifo("fifo.exr")
    server.put("view/a", SMALL)
    server.finished()
    check_same(server.json("history"), {"a": [], "b": []}, "no history")
    for value in ({}, {"file": "none.exr"}, {"file": 3}, {"view": "b"}, {"view": "c"}, {"path_tracer": {"samples": 0}},
                  {"view": "a", "file": "again.exr"}, {"file": "fifo.exr"}):
        server.put("reference", value, 422)
    check_same(server.json("state")["reference"], None, "no reference")
    server.put("reference", {"view": "a"})
    points = server.json("history")["a"]
    check_same([point["passes"] for point in points], [1, 2], "what was shown before there was a reference")
    check(points[0]["error"] > 0 and points[1]["error"] == 0, f"what is measured by itself: {points}")
    server.put("reference", {"path_tracer": {"samples": 64}})

    def finished():
        reference = server.json("state")["reference"]
        return reference["passes"] == 16 and not reference["stage"] and reference
    reference = wait_for(finished, "the reference")
    check_same(reference and reference["kind"], "path_tracer", "its kind")
    server.put("view/a", options(("plugin", "estimator=pathtrace:samples=1"), RAW, passes=16))
    server.finished()
    points = wait_for(lambda: (server.json("history")["a"] or [{"passes": 0}])[-1]["passes"] == 16
                      and server.json("history")["a"], "the history") or [{"passes": 0, "error": 0}]
    check_same([point["passes"] for point in points], [1, 2, 4, 8, 16], "pictures that are kept")
    check(points[-1]["error"] < points[0]["error"] / 2, f"history {points}")
    check(points[-1]["cpu_seconds"] >= points[0]["cpu_seconds"], f"history {points}")
    last = reference["picture"]
    server.put("view/a", options(SPLAT, FEW, RAW, ("size", "32x18")))
    wait_for(lambda: finished() and finished()["picture"] > last, "the reference to follow")
    server.finished()
    check(server.metrics("layer=indirect&against=reference")["rel_rmse"] > 0, "sizes are the same")
    check_same(server.ask("DELETE", "reference")[0], 204, "DELETE reference")


# --- many, slow and hostile ones -------------------------------------------------------------------------

def test_strangers(server):
    state = f"/{server.token}/state"
    check_same(server.ask("GET", "state", headers={"Host": f"localhost:{server.port}"})[0], 200, "localhost")
    own = {"Origin": f"http://127.0.0.1:{server.port}"}
    check_same(server.ask("GET", "state", headers=own)[0], 200, "the page's own origin")
    for headers in ({"Host": "evil.example"}, {"Host": f"evil.example:{server.port}"}, {"Host": "127.0.0.1"},
                    {"Origin": "http://evil.example"}, {"Origin": "null"},
                    {"Origin": f"https://127.0.0.1:{server.port}"}):
        check_same(server.ask("GET", "state", headers=headers)[0], 403, f"{headers}")
    for path in ("/", "/state", "//state", f"/{'0' * 32}/state", f"/{server.token}", f"/{server.token[:-1]}/state",
                 state.upper() if server.token.upper() != server.token else "/x"):
        check_same(server.ask("GET", "", whole=path)[0], 404, path)
    for path in ("../../etc/passwd", "..%2f..%2fetc%2fpasswd", "page/index.html", "index.html/", "./index.html",
                 "/etc/passwd", "view/a", "picture/../../a"):
        status, _, body = server.ask("GET", path)
        check(status in (404, 405) and b"root:" not in body, f"{path}: {status}")
    check_same(server.ask("PUT", "view/a", "{}", {"Content-Type": "text/plain"})[0], 415, "not JSON")
    check_same(server.ask("PUT", "view/a", "{}", {"Content-Type": "application/jsonx"})[0], 415, "not JSON")


def raw(server, text, ends=False):
    """What a request of these bytes is answered; `ends`: nothing will follow them."""
    with socket.create_connection(("127.0.0.1", server.port), timeout=SLOW) as connection:
        answer = b""
        try:  # the server may hang up before it has read all
            connection.sendall(text)
            if ends:
                connection.shutdown(socket.SHUT_WR)
            while block := connection.recv(4096):
                answer += block
        except OSError as error:
            check(isinstance(error, ConnectionError) or error.errno == errno.ENOTCONN, f"it hangs up: {error}")
        return answer


def test_bodies(server):
    head = f"PUT /{server.token}/view/a HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n" \
           "Content-Type: application/json\r\n"
    for length in (65537, 1 << 30, 1 << 62, 1 << 70):
        answer = raw(server, f"{head}Content-Length: {length}\r\n\r\n{{".encode())
        check(b" 413 " in answer[:20] or b" 400 " in answer[:20], f"a body of {length}: {answer[:20]}")
    answer = raw(server, f"{head}Transfer-Encoding: chunked\r\n\r\n5\r\n".encode())
    check(b" 411 " in answer[:20], f"a body of unknown length: {answer[:20]}")
    status, _, _ = server.ask("PUT", "view/a", b'{"options": [], "passes": 2}' + b" " * 60000)
    check_same(status, 204, "a body that is just short enough")
    for text in (b"\r\n\r\n", b"GET\r\n\r\n", b"\x00" * 100, b"GET /" + b"a" * 100000):
        raw(server, text + b" HTTP/1.1\r\n\r\n", True)
    check(server.json("state"), "it still answers")


def listening(server):
    """Addresses, in hexadecimal, at which something listens on the server's port."""
    found = []
    for table in ("tcp", "tcp6"):
        with contextlib.suppress(FileNotFoundError), open(f"/proc/net/{table}") as lines:
            for line in list(lines)[1:]:
                address, port = line.split()[1].rsplit(":", 1)
                if int(port, 16) == server.port and line.split()[3] == "0A":
                    found.append(address)
    return found


def test_many_connections(server):
    check_same(listening(server), ["0100007F"], "where it listens")
    crowd = []
    with contextlib.suppress(OSError):
        for _ in range(1000):
            crowd.append(socket.socket())
            crowd[-1].setblocking(False)
            with contextlib.suppress(BlockingIOError):
                crowd[-1].connect(("127.0.0.1", server.port))
    check(len(crowd) > 100, f"only {len(crowd)} connections could be made")
    time.sleep(0.5)
    threads = len(os.listdir(f"/proc/{server.process.pid}/task"))
    check(threads < 64 + 60, f"{threads} threads")
    for connection in crowd:
        connection.close()
    check(wait_for(lambda: server.json("state"), "an answer after the crowd"), "it still answers")


def events(server):
    connection = socket.create_connection(("127.0.0.1", server.port), timeout=SLOW)
    connection.sendall(f"GET /{server.token}/events HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n\r\n".encode())
    return connection


def test_events(server):
    server.put("view/a", SMALL)
    server.finished()
    with events(server) as connection, connection.makefile("rb") as lines:
        def next_state():
            for line in lines:
                if line.startswith(b"data: "):
                    return json.loads(line[6:])
            return None
        state = next_state()
        check_same(state["views"]["a"]["stage"], "", "the state at once")
        server.put("view/a", options(SPLAT, FEW, RAW, ("seed", "7"), passes=4))
        serials = [state["serial"]]
        while state and (state["views"]["a"]["stage"] or state["views"]["a"]["values"]["seed"] != "7"
                         or state["views"]["a"]["passes"] < 4):
            state = next_state()
            serials.append(state["serial"] if state else 0)
        check(state and serials == sorted(set(serials)), f"states in their order: {serials}")


def test_memory(server):
    """Changes, while one reader of events takes nothing, and others go away in the middle."""
    changes = 20 if "PSPLAT_QUICK" in os.environ else 60
    used = []
    with events(server):
        for i in range(changes):
            server.put("view/a", options(SPLAT, FEW, RAW, ("seed", str(i)), ("size", "40x24" if i % 2 else "64x36")))
            server.finished()
            with socket.create_connection(("127.0.0.1", server.port)) as gone:
                gone.sendall(f"GET /{server.token}/picture/a?layer=picture HTTP/1.1\r\n"
                             f"Host: 127.0.0.1:{server.port}\r\n\r\n".encode())
            used.append(server.kilobytes())
    grown = used[-1] - used[len(used) // 3]
    print(f"memory: {used[0]} KiB after a change, {used[len(used) // 3]} after a third, {used[-1]} after {changes}")
    if "EXPLORE_NO_MEMORY_CHECK" not in os.environ:
        check(grown < 2048 + 16 * changes, f"memory grew by {grown} KiB")  # a picture with its layers is 180 KiB


# --- its begin and end -----------------------------------------------------------------------------------

def run(status, message, *words):
    done = subprocess.run([PSPLAT, "explore", *words], capture_output=True, text=True, timeout=SLOW, check=False)
    check_same(done.returncode, status, f"exit status of {words}: {done.stderr}")
    check(message in done.stderr and done.stdout == "", f"{words}: {done.stderr!r}")


def test_begin():
    run(2, "which scene?")
    run(2, "one scene at a time", "scene.psd", "part.psd")
    run(1, "none.psd", "none.psd")
    run(2, "none_such", "scene.psd", "--plugin", "estimator=none_such")
    run(2, "--size", "scene.psd", "--size", "0x0")
    run(2, "--port", "scene.psd", "--port", "70000")
    with serving("scene.psd") as server:
        run(1, f"127.0.0.1:{server.port}", "scene.psd", "--port", str(server.port))


def test_faulty_begin():
    """A scene with an error is shown as such, and may be mended."""
    write("scene.psd", SCENE.replace("lights:", "lihgts:"))
    with serving("scene.psd", "--size", "32x18", "--passes", "2") as server:
        wait_for(lambda: server.json("state")["scene_error"], "the scene's error")
        check_same(server.json("catalogue")["cameras"], [], "no cameras")
        write("scene.psd", SCENE)
        view = server.finished()
        check_same((view["width"], view["passes"]), (32, 2), "options of the command line")
    with open("err") as err:
        check("did you mean 'lights'?" in err.read(), "the error on stderr")


def test_restricted():
    """A reference is no way out of the folder of --restrict."""
    os.makedirs("inside/deep", exist_ok=True)
    write("inside/scene.psd", SCENE)
    write("inside/part.psd", PART)
    for folder in ("inside", "."):
        subprocess.run([PSPLAT, "-q", "--size", "32x18", "--plugin", "estimator=ambient", "-o", f"{folder}/reference.exr",
                        "inside/scene.psd"], check=True)
    if not os.path.islink("inside/link.exr"):
        os.symlink("../reference.exr", "inside/link.exr")
    with serving("inside/scene.psd", "--restrict", "inside", "--size", "32x18", "--passes", "1") as server:
        server.finished()
        server.put("reference", {"file": "reference.exr"})
        for path in ("../reference.exr", os.path.abspath("reference.exr"), "link.exr", "deep/../../reference.exr",
                     "/etc/passwd", "none.exr"):
            answer = server.put("reference", {"file": path}, 422)
            check("no file in the folder that --restrict names" in answer["message"], f"{path}: {answer}")


def test_names():
    """The command to copy works for scenes that have the name of another command, or look like an option."""
    for name in ("check", "-x.psd"):
        write(name, SCENE)
        with serving(f"./{name}" if name[0] == "-" else name, "--size", "32x18", "--passes", "1") as server:
            server.finished()
            command = server.view("a")["command"].replace("psplat", PSPLAT, 1)
            check_same(subprocess.run(f"{command} -q -o named.exr", shell=True).returncode, 0, command)


def test_browser():
    """The page is opened where there is a desktop."""
    os.mkdir("bin")
    write("bin/xdg-open", "#!/bin/sh\necho noise\necho \"$@\" >opened.new\nmv opened.new opened\n")
    os.chmod("bin/xdg-open", 0o755)
    path = os.environ["PATH"]
    os.environ.update(PATH=f"{os.getcwd()}/bin:{path}", DISPLAY=":99")
    with serving("scene.psd"):
        time.sleep(0.2)
        check(not os.path.exists("opened"), "--no-browser opens nothing")
    process = subprocess.Popen([PSPLAT, "explore", "scene.psd"], stdout=subprocess.PIPE, text=True)
    try:
        address = process.stdout.readline()
        page = None
        if wait_for(lambda: os.path.exists("opened"), "the browser"):
            with open("opened") as opened:
                page = opened.read().strip()
            with open(page) as opened:
                check(f"url={address.strip()}" in opened.read(), "what is opened leads to the address")
            check_same(os.stat(page).st_mode & 0o777, 0o600, "who can read it")
        process.send_signal(signal.SIGINT)
        check_same((process.wait(SLOW), process.stdout.read()), (0, ""), "status and output")
        check(page and not os.path.exists(page), "it is gone at the end")
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
    os.environ["PATH"] = path
    del os.environ["DISPLAY"]


def test_end():
    """In the middle of a render, with readers."""
    words = ("scene.psd", "--plugin", "estimator=pathtrace:samples=1000", "--size", "320x180")
    with serving(*words) as server, events(server):
        server.put("reference", {"path_tracer": {"samples": 100000}})
        wait_for(lambda: server.view("a")["stage"] not in ("", "loading", "preview"), "a long render to begin")
        seconds = server.stop(signal.SIGTERM)
    check(seconds < SLOW / 4, f"{seconds:.1f} s to the end")


def main():
    write("scene.psd", SCENE)
    write("part.psd", PART)
    with serving("scene.psd", "--passes", "2", "--plugin", "denoiser=none") as server:
        for test in (test_page, test_catalogue, test_strangers, test_picture_is_the_command_s, test_changes,
                     test_scene_errors, test_compares, test_reference, test_bodies, test_events, test_cancels,
                     test_many_connections, test_memory):
            start = time.monotonic()
            test(server)
            print(f"{test.__name__}: {time.monotonic() - start:.1f} s")
    for test in (test_begin, test_faulty_begin, test_restricted, test_names, test_browser, test_end):
        start = time.monotonic()
        test()
        print(f"{test.__name__}: {time.monotonic() - start:.1f} s")
    return failures


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
