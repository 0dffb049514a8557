#pragma once

#include <string>

#include <Eigen/Geometry>

namespace simwright::assets {

// An asset's own MJCF has neither <option> nor <size>, so that it can be attached to any model; its
// scene, a file beside it, includes it and defines them.

// Returns "scene.xml", or another name if the asset itself has that name.
std::string MjcfSceneFileName(const std::string& asset);

// Returns the scene: NAME.xml over a ground, a light, a camera's view of `bounds` (m), and the
// elements of MjcfPhysicsText. `parts` is the asset's number of convex parts.
std::string MjcfSceneText(const std::string& asset, int parts, const Eigen::AlignedBox3d& bounds);

// Returns <option> with `multiccd`, so that meshes touch in more than one point, and <size>, for a
// model of `parts` convex parts.
std::string MjcfPhysicsText(int parts);
// Returns the floor z = 0, a <geom> of the world's body. MuJoCo uses the greater friction of two,
// so the asset's own applies.
std::string MjcfGroundText();

}  // namespace simwright::assets
