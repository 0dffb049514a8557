"""The viewer's page in Chromium.

    test_browser.py SIMWRIGHT VIEWER_REFERENCE SOURCE_FOLDER

Ends with 77 (skipped) if chromium is missing, unless SIMWRIGHT_REQUIRE_BROWSER is set.
"""
import contextlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import chromium  # noqa: E402

SIMWRIGHT, REFERENCE, SOURCE = sys.argv[1:4] if len(sys.argv) > 3 else ("", "", "")
SIZE = 512  # pixels of the compared silhouettes

HOSTILE = "&lt;img src=x onerror=window.attacked=1&gt;"
HOSTILE_URDF = f"""<robot name="{HOSTILE}"><link name="{HOSTILE}">
  <visual><geometry><box size="0.1 0.2 0.3"/></geometry></visual></link>
  <link name="flap"><visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link>
  <joint name="{HOSTILE}" type="revolute"><parent link="{HOSTILE}"/><child link="flap"/>
  <axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""


def reference(*arguments):
    done = subprocess.run([REFERENCE, *map(str, arguments)], check=True, capture_output=True, text=True)
    return json.loads(done.stdout) if done.stdout else None


@contextlib.contextmanager
def serving(path):
    """Runs `simwright view` and yields the address of its page; the browser leaves it at the end."""
    process = subprocess.Popen([SIMWRIGHT, "view", str(path), "--json"], stdout=subprocess.PIPE, text=True)
    try:
        text = ""
        for line in process.stdout:
            text += line
            if line.startswith("}"):
                break
        yield json.loads(text)["url"]
    finally:
        Viewer.browser.leave()
        process.send_signal(signal.SIGINT)
        if process.wait(20) != 0:
            raise AssertionError(f"simwright view ended with {process.returncode}")
        process.stdout.close()


def write_page(path, file):
    subprocess.run([SIMWRIGHT, "view", str(path), "--html", str(file), "--quiet", "--force"], check=True,
                   stdout=subprocess.DEVNULL)
    return pathlib.Path(file).as_uri()


def read_mask(file):
    """Returns the rows of a PGM as lists of bools."""
    magic, size, _, data = pathlib.Path(file).read_bytes().split(b"\n", 3)
    assert magic == b"P5"
    width, height = map(int, size.split())
    return [[value > 127 for value in data[y * width:(y + 1) * width]] for y in range(height)]


def mask_of(png):
    _, _, channels, rows = chromium.decode_png(png)
    return [[row[i] > 127 for i in range(0, len(row), channels)] for row in rows]


def overlap(a, b):
    """Returns the intersection over the union of two masks."""
    both = sum(p and q for x, y in zip(a, b) for p, q in zip(x, y))
    either = sum(p or q for x, y in zip(a, b) for p, q in zip(x, y))
    return both / either


class Viewer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="simwright-view-"))
        cls.microwave = cls.folder / "microwave"
        reference("microwave", cls.microwave)
        cls.hostile = cls.folder / "hostile.urdf"
        cls.hostile.write_text(HOSTILE_URDF)
        cls.browser = chromium.Chromium()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        shutil.rmtree(cls.folder)

    def setUp(self):
        self.browser.errors.clear()
        self.browser.requests.clear()
        self.browser.size(1000, 700)

    def tearDown(self):
        self.assertEqual(self.browser.errors, [], "errors in the console")

    def test_a_drag_orbits_and_the_wheel_zooms(self):
        with serving(self.microwave) as url:
            self.browser.open(url)
            before = self.browser.run("simwright.camera")
            frames = self.browser.run("simwright.frames")
            self.browser.drag((200, 300), (300, 300))
            self.browser.settle()
            after = self.browser.run("simwright.camera")
            self.assertAlmostEqual(after["azimuth"], before["azimuth"] - 0.8, places=6)
            self.assertEqual(after["elevation"], before["elevation"])
            self.assertGreater(self.browser.run("simwright.frames"), frames)
            self.browser.mouse("mouseWheel", 300, 300, deltaX=0, deltaY=-200)
            self.browser.settle()
            self.assertLess(self.browser.run("simwright.camera.distance"), 0.9 * before["distance"])
            # Nothing is rendered while nothing moves.
            self.browser.run("new Promise((done) => setTimeout(done, 600))")
            still = self.browser.run("simwright.frames")
            self.browser.run("new Promise((done) => setTimeout(done, 600))")
            self.assertEqual(self.browser.run("simwright.frames"), still)
            outside = [one for one in self.browser.requests if not one.startswith((url, "data:"))]
            self.assertEqual(outside, [], "requests to other servers")

    def test_a_slider_moves_links_as_forward_kinematics(self):
        with serving(self.microwave) as url:
            self.browser.open(url)
            names = self.browser.run("[...document.querySelectorAll('[data-joint]')].map((s) => s.dataset.joint)")
            self.assertIn("door_joint", names)
            for share in (0.0, 0.37, 1.0):
                positions = self.browser.run(
                    "Object.fromEntries([...document.querySelectorAll('[data-joint]')].map((slider) => {"
                    f"  slider.value = Number(slider.min) + {share} * (slider.max - slider.min);"
                    "  slider.dispatchEvent(new Event('input'));"
                    "  return [slider.dataset.joint, Number(slider.value)];"
                    "}))")
                truth = reference("poses", self.microwave,
                                  *(f"{name}={value!r}" for name, value in positions.items()))
                self.browser.settle()
                shown = self.browser.run("simwright.links(0)")
                drawn = self.browser.run("simwright.drawn(0)")
                self.assertEqual(sorted(shown), sorted(truth))
                for link, pose in truth.items():
                    for k in range(12):
                        self.assertAlmostEqual(shown[link][k], pose[k], delta=1e-9, msg=link)
                        self.assertAlmostEqual(drawn[link][4 * (k % 4) + k // 4], pose[k], delta=1e-6,
                                               msg=link)

    def test_silhouettes_agree_with_the_renderer(self):
        cases = (
            (self.microwave, {"door_joint": 1.1}),
            (pathlib.Path(SOURCE) / "robots/panda/panda.urdf", {"panda_joint2": 0.5, "panda_joint4": -1.9}),
            (pathlib.Path(SOURCE) / "examples/chair.obj", {}),
        )
        for path, positions in cases:
            mask_file = self.folder / "mask.pgm"
            # Joints that are not named: at zero, or at the position nearest to it.
            with serving(path) as url:
                self.browser.size(SIZE, SIZE)
                self.browser.open(url)
                for joint, position in positions.items():
                    self.browser.run(f"simwright.setPosition(0, {json.dumps(joint)}, {position})")
                body = self.browser.run("simwright.bodies()[0]")
                all_positions = dict(zip(body["joints"], body["positions"]))
                camera = reference("silhouette", path, SIZE, SIZE, mask_file,
                                   *(f"{name}={value!r}" for name, value in all_positions.items()))
                self.browser.run("simwright.setSilhouette(true)")
                self.browser.run(f"simwright.setCamera({json.dumps(camera)})")
                shown = mask_of(self.browser.screenshot())
            truth = read_mask(mask_file)
            self.assertGreater(sum(map(sum, truth)), 0.05 * SIZE * SIZE)
            same = overlap(truth, shown)
            print(f"silhouette of {path.name}: IoU {same:.4f}")
            self.assertGreaterEqual(same, 0.97, path.name)

    def test_names_from_data_are_texts(self):
        for address in ("served", "file"):
            with contextlib.ExitStack() as stack:
                if address == "served":
                    url = stack.enter_context(serving(self.hostile))
                else:
                    url = write_page(self.hostile, self.folder / "hostile.html")
                self.browser.open(url)
                self.browser.settle()
                self.assertIsNone(self.browser.run("window.attacked ?? null"), address)
                self.assertEqual(self.browser.run("document.querySelectorAll('img').length"), 0)
                self.assertIn("<img src=x", self.browser.run("document.getElementById('panel').textContent"))
                # The page's policy refuses scripts that are not its own, even in its markup.
                self.browser.run("document.body.insertAdjacentHTML('beforeend',"
                                 " '<b onclick=\"window.attacked=1\" id=b>b</b>')")
                self.browser.run("document.getElementById('b').click()")
                self.assertIsNone(self.browser.run("window.attacked ?? null"), address)
                self.browser.settle()
                self.assertTrue(any("Content Security Policy" in error for error in self.browser.errors))
                self.browser.errors.clear()

    def test_one_file_shows_the_same_without_a_server(self):
        with serving(self.microwave) as url:
            self.browser.open(url)
            links = self.browser.run("simwright.links(0)")
            panel = self.browser.run("document.getElementById('panel').innerText")
            served = self.browser.screenshot()
        self.browser.requests.clear()
        self.browser.open(write_page(self.microwave, self.folder / "microwave.html"))
        self.assertEqual(self.browser.run("simwright.links(0)"), links)
        self.assertEqual(self.browser.run("document.getElementById('panel').innerText"), panel)
        self.assertEqual(mask_of(self.browser.screenshot()), mask_of(served))
        self.assertEqual([one for one in self.browser.requests if one.startswith("http")], [])

    def test_keys_switch_layers_theme_and_panel(self):
        with serving(self.microwave) as url:
            self.browser.open(url)
            self.browser.key("3")
            self.browser.wait("simwright.layers.parts")
            self.browser.key("1")
            self.browser.wait("!simwright.layers.visual")
            theme = self.browser.run("document.documentElement.dataset.theme")
            self.browser.key("d")
            self.assertNotEqual(self.browser.run("document.documentElement.dataset.theme"), theme)
            self.browser.key("m")
            self.assertTrue(self.browser.run("document.body.classList.contains('folded')"))
            self.browser.key("?")
            self.assertTrue(self.browser.run("document.getElementById('help').open"))

    def test_a_change_is_shown_and_a_truncated_file_is_reported(self):
        changing = self.folder / "changing.urdf"
        text = HOSTILE_URDF.replace(HOSTILE, "box")
        changing.write_text(text)
        with serving(changing) as url:
            self.browser.open(url)
            changing.write_text(text[:200])
            self.browser.wait("document.getElementById('message').classList.contains('bad')")
            self.assertIn("changing.urdf", self.browser.run("document.getElementById('message').textContent"))
            self.assertEqual(self.browser.run("simwright.bodies().length"), 1, "the last good one stays")
            changing.write_text(text.replace("flap", "lid"))
            self.browser.wait("simwright.ready && 'lid' in simwright.links(0)")
            self.browser.wait("document.getElementById('message').textContent === ''")

    def test_objects_are_picked_hidden_and_moved_by_a_timeline(self):
        # Two boxes that a file of poses places 0.4 m apart, and their drop.
        reference("box", self.folder / "assets" / "box")
        poses = self.folder / "poses.json"
        poses.write_text(json.dumps([
            {"asset": "assets/box", "name": "left", "translation": [-0.2, 0, 0]},
            {"asset": "assets/box", "name": "right", "translation": [0.2, 0, 0]}]))
        self.browser.open(write_page(poses, self.folder / "poses.html"))
        # The canvas' centre of each box, by the page's own camera.
        for body, name in enumerate(("left", "right")):
            x, y = self.browser.run(f"simwright.project(simwright.bodies()[{body}].pose.filter((_, i) => i % 4 === 3)"
                                    ".map((v, i) => v + (i === 2 ? 0.05 : 0)))")
            self.browser.click(x, y)
            self.browser.wait(f"document.querySelector('#panel [aria-current=true]')?.textContent === '{name}'")
        self.browser.key("h")
        self.browser.wait("!simwright.bodies()[1].visible")
        self.assertTrue(self.browser.run("simwright.bodies()[0].visible"))
        self.browser.key("H")
        self.browser.run("document.querySelector('[aria-label=\"Show: drop\"]').click()")
        self.browser.wait("simwright.player")
        for frame in range(5):  # 0.08 s: still in free fall
            self.browser.run(f"simwright.seek({frame})")
            height = self.browser.run("simwright.bodies()[0].pose[11]")
            self.assertAlmostEqual(height, 0.05 - 0.5 * 9.81 * (frame / 50) ** 2, delta=6e-4)
        self.browser.key(" ")
        self.browser.wait("!simwright.player.playing && simwright.player.frame >= simwright.player.last - 1")
        self.assertAlmostEqual(self.browser.run("simwright.bodies()[1].pose[11]"), 0.0, delta=5e-4)

    def test_grasps_are_drawn(self):
        grasp = [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0.08], [0, 0, 0, 1]]
        (self.microwave / "grasps.json").write_text(json.dumps(
            {"grasps": {"tool_transforms": [grasp], "quality": [0.5], "opening_m": [0.06]}}))
        try:
            self.browser.open(write_page(self.microwave, self.folder / "grasps.html"))
        finally:
            (self.microwave / "grasps.json").unlink()
        self.browser.key("7")
        self.browser.wait("simwright.layers.grasps")
        # The fingertips lie 6 cm apart along y, at the tool's origin.
        points = self.browser.run("simwright.glyph(0, 'grasps')")
        self.assertEqual(len(points), 8)
        tips = sorted(points[0][1:2] + points[2][1:2])
        self.assertAlmostEqual(tips[0], -0.03, places=6)
        self.assertAlmostEqual(tips[1], 0.03, places=6)
        self.assertAlmostEqual(points[0][2], 0.08, places=6)
        self.assertAlmostEqual(points[7][2], 0.08 + 0.09, places=6, msg="the stem points back, upwards")

    def test_a_phone_has_the_panel_below(self):
        self.browser.size(390, 780, mobile=True)
        self.browser.open(write_page(self.microwave, self.folder / "phone.html"))
        canvas, panel = self.browser.run(
            "['canvas', 'panel'].map((id) => document.getElementById(id).getBoundingClientRect().toJSON())")
        self.assertGreaterEqual(panel["top"], canvas["bottom"] - 1)
        self.assertEqual(self.browser.run("document.documentElement.scrollWidth"), 390)
        small = self.browser.run("[...document.querySelectorAll('#panel button')].filter("
                                 "(b) => b.offsetHeight > 0 && b.offsetHeight < 32).length")
        self.assertEqual(small, 0, "buttons too small for a finger")


if __name__ == "__main__":
    if chromium.find() is None:
        print("chromium is missing: ./setup.sh --tests installs it")
        sys.exit(1 if os.environ.get("SIMWRIGHT_REQUIRE_BROWSER") else 77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
