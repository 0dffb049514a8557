#pragma once

#include <string>

#include <Eigen/Geometry>

namespace simwright::assets {

// An asset's own MJCF has neither <option> nor <size>, so that it can be attached to any model; its
// scene, a file beside it, includes it and has them.

// "scene.xml", or where the asset itself is called so another name.
std::string MjcfSceneFileName(const std::string& asset);

// The scene: NAME.xml over a ground, a light, a camera's view of `bounds` (m), and what
// MjcfPhysicsText gives. `parts` is how many convex parts the asset has.
std::string MjcfSceneText(const std::string& asset, int parts, const Eigen::AlignedBox3d& bounds);

// <option> with `multiccd`, so that meshes touch in more than one point, and <size>, for a model of
// `parts` convex parts.
std::string MjcfPhysicsText(int parts);
// The floor z = 0, <geom> of the world's body. MuJoCo takes the greater friction of two: the
// asset's own counts.
std::string MjcfGroundText();

}  // namespace simwright::assets
