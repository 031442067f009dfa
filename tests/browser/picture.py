"""picture.py: draws docs/pictures/explore.png: PSPLAT=build/bin/psplat python3 tests/browser/picture.py FILE.png

A comparison of two methods against a path-traced reference, when all passes are done: minutes.
"""

import json
import os
import signal
import subprocess
import sys
import time
import urllib.request

from webdriver import Browser

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
COMMON = [["size", "320x180"], ["plugin", "denoiser=none"]]
PATIENCE = 3600  # seconds that all passes may take
VIEWS = {"a": [*COMMON, ["plugin", "estimator=gather"]], "b": [*COMMON, ["plugin", "estimator=photonmap"]]}


def ask(address, method, path, body=None):
    request = urllib.request.Request(address + path, None if body is None else json.dumps(body).encode(),
                                     {"Content-Type": "application/json"}, method=method)
    with urllib.request.urlopen(request, timeout=60) as answer:
        return answer.read()


def is_done(address):
    state = json.loads(ask(address, "GET", "state"))
    reference = state["reference"]
    for failure in (state["scene_error"], reference["error"], *(view["error"] for view in state["views"].values())):
        if failure:
            sys.exit("psplat explore: %s" % failure)
    return reference["passes"] == reference["passes_wanted"] and all(
        view["passes"] == view["passes_wanted"] for view in state["views"].values())


def take(address, path):
    for view, options in VIEWS.items():
        ask(address, "PUT", "view/" + view, {"options": options, "passes": 64})
    ask(address, "PUT", "reference", {"path_tracer": {"samples": 1024}})
    end = time.monotonic() + PATIENCE
    while not is_done(address):
        if time.monotonic() > end:
            sys.exit("not done in %d s" % PATIENCE)
        time.sleep(1)
    with Browser() as browser:
        browser.resize(1280, 720)
        browser.open(address + "#layer=picture&errors=1")
        browser.run("setTimeout(() => document.querySelector('#edited [value=b]').click(), 2000)")
        time.sleep(5)
        browser.screenshot(path)


def main():
    server = subprocess.Popen([os.path.abspath(os.environ["PSPLAT"]), "explore", "--no-browser", "scenes/cornell.psd"],
                              stdout=subprocess.PIPE, text=True, cwd=ROOT)
    try:
        take(server.stdout.readline().strip(), sys.argv[1])
    finally:
        server.send_signal(signal.SIGINT)
        try:
            server.wait(60)
        finally:
            server.kill()


main()
