#pragma once

#include <string>
#include <string_view>

namespace simwright::tasks::reward {

// What reward functions of other simulators read from their environment, and what reads the same
// here. A path is what stands behind `env` or `self`: "scene[\"cube\"].data.root_pos_w" (Isaac
// Lab), "cube.pose.p" (ManiSkill), "root_states" (Isaac Gym), "sim.data.body_xpos" (robosuite,
// Gymnasium).

// How a handle of another simulator is held: an opaque value whose text begins so, then the path;
// and Isaac Lab's SceneEntityCfg, then the asset's name.
constexpr std::string_view kForeignPrefix = "foreign ", kEntityPrefix = "entity ";

// True for an attribute that leads on to others: "scene", "data", "pose".
bool IsForeignHandle(std::string_view attribute);

// What to write instead of the path, whose last part is an attribute of another simulator; empty
// where it is none that is known.
std::string ForeignRemedy(std::string_view path);

}  // namespace simwright::tasks::reward
