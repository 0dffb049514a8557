#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "assets/tree_world.h"
#include "core/mesh.h"
#include "skills/episode_start.h"
#include "tasks/task.h"

namespace simwright::skills {

// A mesh file of a world.
struct WorldMesh {
  std::string file;  // relative to the world's folder: "meshes/cup_1_collision_000.obj"
  core::TriangleMesh mesh;
};

// The world of one task at its start, ready to be written: the robot first, then the objects that
// the task places.
struct TaskWorld {
  std::string task;
  std::vector<assets::TreeBody> bodies;
  std::vector<WorldMesh> meshes;
};

// Returns the world of the subtask `name` that `skill`, with one variant, trains in, with objects
// and arm as in `start` and the gripper open; masses, frictions and joints are without
// randomization. The motors follow the simulator's own (sim/driven_robot.h): servos of the same
// ratio of stiffness and damping, with the joints' effort limits, so stiff that the full effort
// corresponds to 2 mrad. The friction of a finger in a contact is the product of the robot's and
// the objects' mean.
TaskWorld MakeTaskWorld(const std::string& name, const Skill& skill,
                        const std::vector<tasks::TaskAsset>& assets, const StartState& start);

}  // namespace simwright::skills
