"""Ctrl-C in long calls, in a process of its own."""

import os
import signal
import subprocess
import sys
import time

LONG = """
import sys, simwright as sw
print("ready", flush=True)
try:
    sw.scenes.generate("pantry_shelf", sys.argv[1], count=100000, progress=False)
except KeyboardInterrupt:
    print("stopped", flush=True)
# Work after the interruption goes on as usual.
print(sw.physics.sample("mug")["category"], len(sw.assets.library("apple", sys.argv[1] + "_assets",
      check=False, progress=False)), flush=True)
"""


def test_ctrl_c_stops_a_long_call(tmp_path):
    child = subprocess.Popen([sys.executable, "-c", LONG, str(tmp_path / "out")], text=True,
                             stdout=subprocess.PIPE, env=dict(os.environ))
    assert child.stdout.readline().strip() == "ready"
    time.sleep(3.0)
    start = time.monotonic()
    child.send_signal(signal.SIGINT)
    assert child.stdout.readline().strip() == "stopped"
    assert time.monotonic() - start < 20.0
    assert child.stdout.readline().split() == ["mug", "1"]
    assert child.wait(timeout=60) == 0
