"""Reads a ROS trajectory with Python's own YAML or JSON and prints its numbers, exactly: a line of
joint names, then for each point the time in nanoseconds, positions, velocities, accelerations and
efforts."""
import json
import sys

import yaml

with open(sys.argv[1]) as file:
    message = json.load(file) if sys.argv[1].endswith(".json") else yaml.safe_load(file)
assert set(message) == {"header", "joint_names", "points"}, message.keys()
assert message["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
print(*message["joint_names"])
for point in message["points"]:
    time = point["time_from_start"]
    numbers = (point["positions"] + point["velocities"] + point["accelerations"]
               + point["effort"])
    assert all(isinstance(number, float) for number in numbers)
    print(time["sec"] * 10**9 + time["nanosec"], *(number.hex() for number in numbers))
