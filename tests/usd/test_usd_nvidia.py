"""NVIDIA's validator, which knows the requirements of SimReady, judges exported USD."""

import re

import pytest

from judges import KINDS

nvidia = pytest.importorskip("usd_validation_nvidia",
                             reason="usd-validation-nvidia is missing (./setup.sh --usd)")

# Layers are text, which this validator finds slow. Visual meshes of several boxes share edges and
# points, as the look of the object has them; solids and convex parts do not.
TEXT, VISUAL = "UsdAsciiPerformanceChecker", {"ManifoldChecker", "WeldChecker"}


def issues(layer):
    """Returns the rule and the place of everything that the validator finds."""
    results = nvidia.ValidationEngine(init_rules=True).validate(str(layer))
    return [(issue.rule.__name__, str(issue.at)) for issue in results.issues()]


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_but_text_layers_and_visual_meshes_is_found(exported, kind):
    for rule, place in issues(exported[kind][1]):
        assert rule == TEXT or (rule in VISUAL and "/visual" in place), (rule, place)


def test_scenes_have_no_other_finding_either(scenes):
    for layer in sorted(scenes.glob("scene_*/scene.usda")):
        assert {rule for rule, _ in issues(layer)} <= {TEXT}


def test_a_fault_is_found(exported, tmp_path):
    text = exported["mug"][1].read_text()
    damaged = tmp_path / "damaged.usda"
    damaged.write_text(re.sub(r"(float physics:mass) = \S+", r"\1 = -1", text))
    assert "MassChecker" in {rule for rule, _ in issues(damaged)}
