#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Looks at a run in a real browser (headless Chromium): image, map, pose, pause, a landmark, a keyframe, a
slow connection, a run that begins anew.

  page_test.py PROGRAM SEQUENCE FOLDER

leaves screenshots in FOLDER. Exit status: 0 passed, 1 failed, 77 where there is no browser.
"""
import pathlib
import shutil
import socket
import subprocess
import sys
import time

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
except ImportError:
    sys.exit(77)

PATIENCE = 120  # seconds until something is to be seen


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def start(program, sequence, port, out, *more):
    return subprocess.Popen([program, "run", sequence, "--view", str(port), "--out", str(out), *more],
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def open_browser():
    options = webdriver.ChromeOptions()
    for flag in ("--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--use-gl=angle",
                 "--use-angle=swiftshader", "--window-size=1440,900", "--disable-dev-shm-usage"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


def wait(what, condition):
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until:
        value = condition()
        if value:
            return value
        time.sleep(0.1)
    sys.exit(f"page_test: waited in vain until {what}")


# How many pixels of the camera's canvas have a colour, and how many are grey but not black: the image
# is grey, features are not.
PIXELS = """
const canvas = document.querySelector("#camera canvas");
const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
let coloured = 0, grey = 0;
for (let i = 0; i < data.length; i += 4) {
  const low = Math.min(data[i], data[i + 1], data[i + 2]);
  const difference = Math.max(data[i], data[i + 1], data[i + 2]) - low;
  if (difference > 60) ++coloured;
  if (difference < 5 && low > 20) ++grey;
}
return {coloured, grey, all: data.length / 4};
"""
STATE = """
const s = window.plumbline;
return {updates: s.updates, session: s.session, frame: s.frame && (s.frame.number || 0),
        pose: s.frame && s.frame.pose && s.frame.pose.position, points: s.map.points.count,
        lines: s.map.lineEnds.size, keyframes: s.map.keyframes.size, paused: Boolean(s.run && s.run.paused),
        state: document.getElementById("state").textContent};
"""


def check_growth(browser, shot):
    state = lambda: browser.execute_script(STATE)
    wait("there is an image", lambda: state()["frame"] is not None)
    pixels = lambda: browser.execute_script(PIXELS)
    coloured = wait("features are drawn", lambda: pixels()["coloured"])
    assert coloured > 500, coloured
    wait("the image is drawn", lambda: pixels()["grey"] > 0.3 * pixels()["all"])
    first = wait("there is a map", lambda: state()["keyframes"] > 2 and state())
    shot("begin")
    later = wait("the map grows", lambda: state()["keyframes"] > first["keyframes"] + 3 and state())
    assert later["points"] > first["points"], (first, later)
    assert later["lines"] > 0 and later["pose"] != first["pose"], (first, later)
    assert later["state"].startswith("tracked"), later


def check_pause(browser, shot):
    state = lambda: browser.execute_script(STATE)
    press = lambda text: browser.execute_script(
        "[...document.querySelectorAll('button')].find((b) => b.textContent === arguments[0]).click()",
        text)
    press("Pause")
    wait("the run is paused", lambda: state()["paused"])
    time.sleep(1)  # what is on its way
    before = state()["frame"]
    press("Step")
    wait("one more frame", lambda: state()["frame"] == before + 1)
    time.sleep(0.5)
    assert state()["frame"] == before + 1
    # A point that the frame shows, clicked in the image.
    browser.execute_script("""
      const {frame} = window.plumbline, i = frame.pointIds.findIndex((id) => id >= 0);
      choose({point: frame.pointIds[i]});""")
    wait("somebody sees the point",
         lambda: browser.execute_script("return document.querySelectorAll('#sight .strip canvas').length"))
    shot("landmark")
    browser.execute_script("openKeyframe([...window.plumbline.map.keyframes.keys()][1])")
    wait("the keyframe has a picture", lambda: browser.execute_script(
        "return document.querySelector('#keyframe .empty') && document.querySelector('#keyframe .empty').hidden"))
    shot("keyframe")
    browser.execute_script("document.getElementById('keyframe').close(); forget()")
    press("Resume")
    wait("the run goes on", lambda: state()["frame"] > before + 3)


def check_slow_connection(browser):
    # Bytes a second: less than the images need.
    browser.set_network_conditions(offline=False, latency=200, upload_throughput=100_000,
                                   download_throughput=100_000)
    before = browser.execute_script(STATE)["updates"]
    wait("updates come over a slow connection",
         lambda: browser.execute_script(STATE)["updates"] > before + 3)
    browser.delete_network_conditions()


# Draws keyframes of an earlier run (0, 1), of one that has a map of several runs with them (5 to 7), and
# of one that came later (8, 9); returns how many steps from keyframe to keyframe are drawn.
STEPS_OF_RUNS = """
    const {map} = window.plumbline, drawn = map.keyframes, ofAnotherRun = 0xFFFFFFFF;
    const frames = [[7, 4], [0, ofAnotherRun], [1, ofAnotherRun], [5, 0], [6, 2], [8, 1], [9, 3]];
    map.keyframes = new Map(frames.map(
        ([id, frame]) => [id, {place: [id, 0, 0], turn: [0, 0, 0, 1], frame}]));
    let floats = 0;
    map.view.place = (name, data, size, count) => {
      if (name === "trajectory") floats = count;
    };
    map.uploadKeyframes();
    delete map.view.place;
    map.keyframes = drawn;
    map.uploadKeyframes();
    return floats / map.segments([[[0, 0, 0], [1, 0, 0]]])[2];
"""


def check_runs_apart(browser):
    steps = browser.execute_script(STEPS_OF_RUNS)
    assert steps == 4, f"expected steps 0-1, 5-6, 6-7 and 8-9, found {steps} steps"


# A run that is shown after its end, and its last state when the program is gone; then its saved map.
def check_end(browser, program, sequence, folder, shot):
    state = lambda: browser.execute_script(STATE)["state"]
    open_page = lambda port: (wait("somebody listens", lambda: not socket.socket().connect_ex(("127.0.0.1", port))),
                              browser.get(f"http://127.0.0.1:{port}/"))
    out, port = folder / "finished", free_port()
    run = start(program, sequence, port, out, "--to", "40", "--stay")
    try:
        open_page(port)
        wait("the run is finished", lambda: state() == "finished")
        wait("the results are there", (out / "summary.json").exists)
        assert run.poll() is None, "expected the view to stay, found the program ended"
        run.terminate()
        assert run.wait(PATIENCE) == 0, run.returncode
        time.sleep(1)
        assert state() == "finished", state()
        shot("finished")
    finally:
        run.kill()
        run.wait()
    port = free_port()
    saved = subprocess.Popen([program, "map", "view", str(out / "map.plb"), "--view", str(port)],
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        open_page(port)
        wait("the saved map is there", lambda: browser.execute_script(STATE)["keyframes"] > 2)
        assert state() == "saved map", state()
        assert not browser.find_element("id", "camera").is_displayed()
        assert "frames/s" not in browser.find_element("id", "figures").text
        shot("saved_map")
    finally:
        saved.kill()
        saved.wait()


def main(program, sequence, folder):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    if not shutil.which("chromedriver"):
        return 77
    port = free_port()
    run = start(program, sequence, port, folder / "out")
    browser = open_browser()
    shot = lambda name: browser.save_screenshot(str(folder / f"page_{name}.png"))
    try:
        wait("the run listens", lambda: not socket.socket().connect_ex(("127.0.0.1", port)))
        browser.get(f"http://127.0.0.1:{port}/")
        check_growth(browser, shot)
        check_pause(browser, shot)
        check_slow_connection(browser)
        session = browser.execute_script(STATE)["session"]
        run.kill()
        run.wait()
        wait("the page notices", lambda: browser.execute_script(STATE)["state"] == "not connected")
        run = start(program, sequence, port, folder / "out")
        wait("the page shows the next run",
             lambda: browser.execute_script(STATE)["session"] not in (None, session)
             and browser.execute_script(STATE)["keyframes"] > 2)
        shot("again")
        check_runs_apart(browser)
        check_end(browser, program, sequence, folder, shot)
        errors = [entry for entry in browser.get_log("browser")
                  if entry["level"] == "SEVERE" and "WebSocket" not in entry["message"]]
        assert not errors, errors
    finally:
        browser.quit()
        run.kill()
        run.wait()
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
