#pragma once

#include <string>
#include <string_view>

namespace simwright::reward {

// Names that reward functions of other simulators read from their environment, and their
// equivalents here. A path is the text after `env` or `self`: "scene[\"cube\"].data.root_pos_w"
// (Isaac Lab), "cube.pose.p" (ManiSkill), "root_states" (Isaac Gym), "sim.data.body_xpos"
// (robosuite, Gymnasium).

// The text prefixes of opaque values that stand for handles of another simulator (followed by the
// path) and for Isaac Lab's SceneEntityCfg (followed by the asset's name).
constexpr std::string_view kForeignPrefix = "foreign ", kEntityPrefix = "entity ";

// Returns true for an attribute that leads to further attributes: "scene", "data", "pose".
bool IsForeignHandle(std::string_view attribute);

// Returns the replacement for the path, whose last part is an attribute of another simulator; empty
// if the attribute is unknown.
std::string ForeignRemedy(std::string_view path);

}  // namespace simwright::reward
