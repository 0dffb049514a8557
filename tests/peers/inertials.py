"""Mass, centre and inertia of an asset's links: as asset.json has them, and compared."""

import json
import pathlib

import numpy as np

TOLERANCE = 1e-6  # of the mass, of the inertia's norm; of the centre in m


def of_asset(folder):
    """{link: (mass, centre [3], inertia about the centre [3][3])}, and the asset's name."""
    text = json.loads((pathlib.Path(folder) / "asset.json").read_text())
    links = text["links"] if text.get("articulated") else [text]
    return text, {
        link["name"]: (
            link["mass"],
            np.array(link["center_of_mass"]),
            np.array(link["inertia"]),
        )
        for link in links
    }


def require_same(found, wanted, place):
    mass, centre, inertia = found
    assert abs(mass - wanted[0]) <= TOLERANCE * wanted[0], (place, "mass", mass, wanted[0])
    off = np.linalg.norm(np.asarray(centre) - wanted[1])
    assert off <= TOLERANCE, (place, "centre", centre, wanted[1])
    off = np.linalg.norm(np.asarray(inertia) - wanted[2]) / np.linalg.norm(wanted[2])
    assert off <= TOLERANCE, (place, "inertia", off)


def turn_of(w, x, y, z):
    """The rotation matrix of a unit quaternion."""
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


class Stillness:
    """How far bodies move from where they first were."""

    def __init__(self):
        self.first = {}
        self.moved = 0.0  # m
        self.turned = 0.0  # degrees
        self.worst = ""

    def see(self, name, place, turn):
        place, turn = np.array(place), np.array(turn)
        if name not in self.first:
            self.first[name] = (place, turn)
            return
        at, was = self.first[name]
        cosine = (np.trace(was.T @ turn) - 1.0) / 2.0
        moved = float(np.linalg.norm(place - at))
        turned = float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
        if moved > self.moved:
            self.worst = name
        self.moved = max(self.moved, moved)
        self.turned = max(self.turned, turned)

    def require(self, place, metres=1e-3, degrees=1.0):
        assert self.moved < metres and self.turned < degrees, (
            "%s: %s moved by %.3f mm, turned by %.3f degrees"
            % (place, self.worst, 1e3 * self.moved, self.turned)
        )

    def __str__(self):
        return "%.4f mm %.4f deg" % (1e3 * self.moved, self.turned)
