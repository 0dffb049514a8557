"""Ctrl-C in long calls, in a process of its own."""

import os
import signal
import subprocess
import sys
import time

import pytest

LONG = """
import sys, simwright as sw
print("ready", flush=True)
try:
    sw.scenes.generate("dimsum", sys.argv[1], count=100000, assets=sys.argv[2], progress=False)
except KeyboardInterrupt:
    print("stopped", flush=True)
# Work after the interruption goes on as usual.
print(sw.physics.sample("mug")["category"], len(sw.assets.library("apple", sys.argv[1] + "_assets",
      check=False, progress=False)), flush=True)
"""


def test_ctrl_c_stops_a_long_call(tmp_path, dimsum_assets):
    child = subprocess.Popen([sys.executable, "-c", LONG, str(tmp_path / "out"),
                              str(dimsum_assets)],
                             text=True, stdout=subprocess.PIPE, env=dict(os.environ))
    assert child.stdout.readline().strip() == "ready"
    time.sleep(3.0)
    start = time.monotonic()
    child.send_signal(signal.SIGINT)
    assert child.stdout.readline().strip() == "stopped"
    assert time.monotonic() - start < 20.0
    assert child.stdout.readline().split() == ["mug", "1"]
    assert child.wait(timeout=60) == 0


TWO = """
import sys, threading, time, simwright as sw
ended = []

def work(name, count):
    try:
        sw.scenes.generate("dimsum", f"{sys.argv[1]}_{name}", count=count, assets=sys.argv[2],
                           progress=False)
        ended.append(f"{name} done")
    except KeyboardInterrupt:
        ended.append(f"{name} stopped")

# The first call, which ends by itself, is in progress when the second begins.
first = threading.Thread(target=work, args=("first", 2))
second = threading.Thread(target=work, args=("second", 100000))
first.start()
time.sleep(0.05)
second.start()
first.join()
print("ready", flush=True)
while len(ended) < 2:  # Ctrl-C in join() marks the thread as ended
    try:
        time.sleep(0.05)
    except KeyboardInterrupt:
        pass
print(", ".join(ended), flush=True)
"""


def test_ctrl_c_stops_the_call_that_outlives_another(tmp_path, dimsum_assets):
    child = subprocess.Popen([sys.executable, "-c", TWO, str(tmp_path / "out"),
                              str(dimsum_assets)],
                             text=True, stdout=subprocess.PIPE, env=dict(os.environ))
    assert child.stdout.readline().strip() == "ready"
    time.sleep(0.5)
    child.send_signal(signal.SIGINT)
    try:
        assert child.stdout.readline().strip() == "first done, second stopped"
        assert child.wait(timeout=60) == 0
    finally:
        child.kill()


STOPPED = """
import sys, simwright as sw
calls = {
    "evaluate": lambda: sw.skills.evaluate("open_drawer", 100000, progress=False),
    "library": lambda: sw.assets.library("microwave", sys.argv[2], count=200, progress=True),
    "render": lambda: sw.render.render(
        sw.mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]]),
        sw.render.orbit_camera((0, 0, 0), 2.0, 0.5, 0.0, 1.0, 2000, 2000), samples_per_side=8,
        occlusion_rays=1000),
}
if sys.argv[1] == "evaluate":
    sw.skills.evaluate("open_drawer", 1, progress=False)  # makes the objects
print("ready", flush=True)
try:
    calls[sys.argv[1]]()
    print("went on", flush=True)
except KeyboardInterrupt:
    print("stopped", flush=True)
"""


@pytest.mark.parametrize("call", ["evaluate", "library", "render"])
def test_ctrl_c_stops_within_seconds(call, tmp_path):
    child = subprocess.Popen([sys.executable, "-c", STOPPED, call, str(tmp_path / "out")], text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=dict(os.environ))
    try:
        assert child.stdout.readline().strip() == "ready"
        time.sleep(2.0)
        child.send_signal(signal.SIGINT)
        start = time.monotonic()
        printed, errors = child.communicate(timeout=60)
        assert printed.strip() == "stopped" and child.returncode == 0
        assert time.monotonic() - start < 20.0
        assert "Exception ignored" not in errors
    finally:
        child.kill()
