"""Makes the pictures of docs/viewer.md.

    doc_pictures.py SIMWRIGHT FOLDER PICTURES

FOLDER has what the page's commands made: kitchen/microwave_1, mugs/mug_1 with its grasps.json, dimsum,
and apple_run of `simwright run`.
"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import chromium  # noqa: E402

SIMWRIGHT, FOLDER, PICTURES = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])


def main():
    with tempfile.TemporaryDirectory() as folder, chromium.Chromium() as browser:
        def show(name, *arguments):
            page = pathlib.Path(folder) / "page.html"
            subprocess.run([SIMWRIGHT, "view", str(FOLDER / name), "--html", str(page), "--quiet", "--force",
                            *arguments], check=True, stdout=subprocess.DEVNULL)
            browser.size(1200, 720)
            browser.leave()
            browser.open(page.as_uri() + "#full")

        def world(name, group=None):
            wanted = f"w.name === '{name}'" + (f" && w.group === '{group}'" if group else "")
            browser.run(f"simwright.open(simwright.manifest.worlds.findIndex((w) => {wanted}))")
            browser.wait("simwright.ready")

        def press(label):
            browser.run(f"document.querySelector('[aria-label=\"{label}\"]').click()")

        def keep(name):
            (PICTURES / f"viewer_{name}.png").write_bytes(browser.screenshot())

        show("kitchen/microwave_1")
        browser.run("simwright.setPosition(0, 'door_joint', 1.2)")
        browser.run("simwright.showLayer('joints', true)")
        browser.key("f")
        keep("asset")
        browser.run("simwright.showLayer('joints', false)")
        for layer, shown in (("visual", "false"), ("parts", "true"), ("mass", "true"), ("box", "true")):
            browser.run(f"simwright.showLayer('{layer}', {shown})")
        browser.key("d")
        keep("layers")
        browser.key("d")
        show("mugs/mug_1")
        browser.run("simwright.showLayer('grasps', true)")
        browser.mouse("mouseWheel", 400, 300, deltaX=0, deltaY=450)
        keep("grasps")
        show("dimsum", "--most", "4")
        browser.drag((450, 300), (330, 330))
        browser.run("simwright.select(simwright.bodies().findIndex((body) => body.name.startsWith('teapot')))")
        keep("scenes")
        press("Show: drop")
        browser.wait("simwright.player")
        browser.run("simwright.seek(4)")
        browser.run("document.getElementById('panel').scrollTop = 260")
        keep("drop")
        show("apple_run")
        world("put_apple_into_drawer_unit_1", "put_apple_into_drawer_unit_1_and_close_it")
        browser.drag((450, 300), (520, 330))
        keep("tasks")
        world("pick_up_apple", "trained")
        press("Show: episode")
        browser.wait("simwright.player")
        browser.run("simwright.seek(95)")
        browser.run("document.getElementById('panel').scrollTop = 420")
        keep("rollout")
        browser.run("document.querySelector('[aria-label=Training]').scrollIntoView()")
        browser.key("c")
        keep("run")
        browser.size(390, 720, mobile=True)
        world("asset apple")
        browser.run("document.getElementById('panel').scrollTop = 0")
        keep("phone")
        if browser.errors:
            raise SystemExit("\n".join(browser.errors))


if __name__ == "__main__":
    main()
