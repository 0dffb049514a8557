"""The renderers against closed forms and finite differences."""

import threading

import numpy as np
import pytest

import simwright as sw


def look_down(size=64, height=5.0, focal=64.0):
    pose = np.diag([1.0, -1.0, -1.0, 1.0])
    pose[2, 3] = height
    return sw.render.camera(size, size, focal, focal, size / 2, size / 2, pose)


def test_depth_of_a_square(cube):
    image = sw.render.render(cube, look_down())
    depth, mask = image["depth"], image["mask"]
    # The top at z = 1 is 4 m away: 1 m covers 16 pixels, from the image's middle to the right and up.
    assert mask[24, 40] == 1.0 and depth[24, 40] == pytest.approx(4.0, abs=1e-6)
    assert mask.sum() == pytest.approx(256, abs=1)
    # Normals are those of the vertices where faces meet at less than 40 degrees.
    assert image["normal"][24, 40, 2] > 0.9
    np.testing.assert_allclose(np.linalg.norm(image["normal"][24, 40]), 1.0, atol=1e-6)
    assert image["color"].shape == (64, 64, 4) and image["color"].dtype == np.uint8
    assert set(np.unique(image["label"])) == {-1, 0}


def test_gradients_match_finite_differences():
    vertices = np.array([[-1.1, -0.9, 0.0], [1.2, -1.0, 0.1], [0.1, 1.1, -0.1]])
    mesh = sw.mesh(vertices, [[0, 1, 2]])
    renderer = sw.render.DifferentiableRenderer(mesh, samples_per_side=8, edge_samples=40000)
    camera = look_down()

    def area(points):
        renderer.set_vertices(points)
        return float(renderer.render(camera)["mask"].sum())

    renderer.set_vertices(vertices)
    images = renderer.render(camera)
    gradient = renderer.backward(mask=np.ones_like(images["mask"]))["vertices"]
    # The covered area in pixels is half the cross product of the projected corners.
    def exact(points):
        u = 64.0 * points[:, :2] / (5.0 - points[:, 2:])
        a, b = u[1] - u[0], u[2] - u[0]
        return 0.5 * (a[0] * b[1] - a[1] * b[0])

    assert area(vertices) == pytest.approx(exact(vertices), rel=2e-3)
    step = 1e-6
    for i in range(3):
        for k in range(3):
            shift = np.zeros((3, 3))
            shift[i, k] = step
            difference = (exact(vertices + shift) - exact(vertices - shift)) / (2 * step)
            assert gradient[i, k] == pytest.approx(difference, abs=0.02 * np.abs(gradient).max())


def test_a_torch_fit_moves_a_triangle_to_its_target():
    torch = pytest.importorskip("torch")
    from simwright import autograd

    target = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
    camera = look_down()
    renderer = sw.render.DifferentiableRenderer(sw.mesh(target, [[0, 1, 2]]))
    wanted = autograd.render(renderer, camera, torch.tensor(target))[1].detach()
    # In the plane alone: a tilt would change the outline only a little.
    corners = torch.tensor(target[:, :2] + [0.3, -0.2], requires_grad=True)
    optimizer = torch.optim.Adam([corners], lr=0.02)
    for step in range(150):
        optimizer.zero_grad()
        vertices = torch.cat([corners, torch.zeros(3, 1)], dim=1)
        loss = ((autograd.render(renderer, camera, vertices, seed=step)[1] - wanted) ** 2).mean()
        loss.backward()
        optimizer.step()
        if step == 100:
            optimizer.param_groups[0]["lr"] = 0.004
    assert np.abs(corners.detach().numpy() - target[:, :2]).max() < 0.02


def test_two_images_before_their_gradients():
    torch = pytest.importorskip("torch")
    from simwright import autograd

    base = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
    renderer = sw.render.DifferentiableRenderer(sw.mesh(base, [[0, 1, 2]]))
    camera = look_down()
    gradients = []
    for together in (False, True):
        one = torch.tensor(base, requires_grad=True)
        two = torch.tensor(base * 0.5, requires_grad=True)
        if together:
            total = (autograd.render(renderer, camera, one)[1].sum()
                     + autograd.render(renderer, camera, two)[1].sum())
            total.backward()
        else:
            autograd.render(renderer, camera, one)[1].sum().backward()
            autograd.render(renderer, camera, two)[1].sum().backward()
        gradients.append((one.grad.numpy(), two.grad.numpy()))
    np.testing.assert_array_equal(gradients[0][0], gradients[1][0])
    np.testing.assert_array_equal(gradients[0][1], gradients[1][1])


def test_bad_arguments(cube):
    with pytest.raises(sw.Error, match="focal"):
        sw.render.camera(4, 4, 0.0, 1.0, 2, 2, np.eye(4))
    with pytest.raises(sw.Error, match="finite"):
        sw.render.orbit_camera((0, 0, np.nan), 4, 0.5, 0, 0.8, 64, 64)
    renderer = sw.render.DifferentiableRenderer(cube)
    with pytest.raises(sw.Error):
        renderer.backward(mask=np.ones((4, 4, 1)))
    with pytest.raises(sw.Error):
        renderer.set_vertices(np.zeros((3, 3)))
    with pytest.raises(sw.Error, match="colors"):
        sw.render.DifferentiableRenderer(cube, colors=np.zeros((3, 3)))
    with pytest.raises(sw.Error, match="mesh.*NoneType"):
        sw.render.DifferentiableRenderer(None)
    with pytest.raises(sw.Error, match="no direction"):
        sw.render.studio_light([0, 0, 0])
    with pytest.raises(sw.Error, match="width"):
        sw.render.camera(64.5, 4, 1.0, 1.0, 2, 2, np.eye(4))


@pytest.mark.parametrize("arguments, word", [
    (dict(meshes="cube.obj"), "meshes.*read_mesh"), (dict(meshes=3), "meshes"),
    (dict(meshes=["cube.obj"]), "meshes.*read_mesh"), (dict(camera=None), "camera.*NoneType"),
    (dict(samples_per_side=1.5), "samples_per_side"), (dict(samples_per_side=np.nan), "samples_per_side"),
    (dict(samples_per_side=0), "samples_per_side"), (dict(occlusion_rays=-1), "occlusion_rays"),
])
def test_render_refuses(cube, arguments, word):
    with pytest.raises(sw.Error, match=word):
        sw.render.render(**{"meshes": cube, "camera": look_down(), **arguments})


def test_torch_is_given_tensors(cube):
    torch = pytest.importorskip("torch")
    renderer = sw.render.DifferentiableRenderer(cube)
    vertices = torch.tensor(cube.vertices)
    with pytest.raises(sw.Error, match="vertices.*ndarray.*torch.Tensor"):
        sw.autograd.render(renderer, look_down(), cube.vertices)
    with pytest.raises(sw.Error, match="light.*torch.Tensor"):
        sw.autograd.render(renderer, look_down(), vertices, light=sw.render.studio_light())
    with pytest.raises(sw.Error, match="renderer"):
        sw.autograd.render(cube, look_down(), vertices)


@pytest.mark.parametrize("change, says", [
    (dict(pose=np.diag([2.0, 2.0, 2.0, 1.0])), "rotation"),
    (dict(pose=np.diag([1.0, 1.0, -1.0, 1.0])), "rotation"),
    (dict(pose=np.zeros((4, 4))), "rotation"),
    (dict(width=10**6), "8192"),
    (dict(fx=float("nan")), "focal"),
])
def test_bad_cameras(change, says):
    told = dict(dict(width=8, height=8, fx=8.0, fy=8.0, cx=4.0, cy=4.0, pose=np.eye(4)), **change)
    with pytest.raises(sw.Error, match=says):
        sw.render.camera(**told)


def test_limits_of_samples():
    mesh = sw.mesh([[-1, -1, 1], [1, -1, 1], [0, 1, 1]], [[0, 1, 2]])
    camera = sw.render.camera(8, 8, 8.0, 8.0, 4.0, 4.0, np.eye(4))
    with pytest.raises(sw.Error, match="samples_per_side"):
        sw.render.render(mesh, camera, samples_per_side=1000)
    with pytest.raises(sw.Error, match="occlusion_rays"):
        sw.render.render(mesh, camera, occlusion_rays=10**6)
    with pytest.raises(sw.Error, match="samples_per_side"):
        sw.render.DifferentiableRenderer(mesh, samples_per_side=1024)
    with pytest.raises(sw.Error, match="finite"):
        sw.render.orbit_camera((0, 0, 0), 1.0, 0.2, float("inf"), 1.0, 8, 8)


def test_a_renderer_is_for_one_thread_at_a_time():
    mesh = sw.mesh([[-1, -1, 1], [1, -1, 1], [0, 1, 1]], [[0, 1, 2]])
    renderer = sw.render.DifferentiableRenderer(mesh)
    camera = sw.render.camera(256, 256, 256.0, 256.0, 128.0, 128.0, np.eye(4))
    refused, rendered = [], []

    def work():
        for _ in range(50):
            try:
                renderer.set_vertices(mesh.vertices)
                rendered.append(renderer.render(camera)["mask"].sum())
                renderer.backward(mask=np.ones((256, 256, 1), np.float32))
            except sw.Error as error:
                refused.append(str(error))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert rendered and len(set(np.round(rendered, 3))) == 1
    assert all("another thread" in text or "before" in text for text in refused), set(refused)
