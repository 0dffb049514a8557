#pragma once

#include <string>
#include <vector>

#include "core/random.h"
#include "geometry/mass_properties.h"
#include "manipulation/reach_plan.h"
#include "robot/panda_model.h"
#include "skills/episode.h"
#include "skills/skill.h"
#include "tests/tasks/household.h"

namespace simwright::skills {

// Returns the household model with the inertia of its shapes at its masses.
inline assets::SemanticModel WithInertia(assets::SemanticModel model) {
  for (assets::UrdfLink& link : model.model.links) {
    geometry::MassProperties total;
    for (const assets::UrdfShape& shape : link.collisions) {
      const auto one = geometry::SolidMassProperties(shape.mesh, 1.0);
      total = total.mass > 0.0 ? geometry::Combined(total, one) : one;
    }
    const double scale = link.inertial->mass / total.mass;
    link.inertial->center_of_mass = total.center_of_mass;
    link.inertial->inertia = scale * total.inertia;
  }
  for (assets::Joint& joint : model.model.joints) joint.friction = 0.3;
  return model;
}

// Returns a subtask that lifts a cup in front of the robot to 20 cm above the floor.
inline SkillSubtask PickUpCup(const std::string& name = "cup", double radius = 0.03) {
  SkillSubtask scene;
  scene.assets = {WithInertia(tasks::Cup(name, radius))};
  scene.subtask.name = "pick_up_" + name;
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    thing = env.get_position(\"" +
      name +
      "\")\n"
      "    gripper = env.get_robot_gripper_pose()\n"
      "    grasped = env.check_grasped(\"" +
      name +
      "\")\n"
      "    missing = torch.norm(env.get_goal_pose() - thing, dim=-1)\n"
      "    reward = grasped.float() - torch.norm(gripper - thing, dim=-1) - 2.0 * missing\n"
      "    return reward, torch.logical_and(grasped, missing <= 0.03)\n";
  tasks::AssetPlacement placement;
  placement.asset = name;
  placement.world_from_asset.translation() = Eigen::Vector3d(0.5, 0.0, 0.0);
  scene.subtask.start.placements = {placement};
  scene.subtask.goal = Eigen::Vector3d(0.5, 0.0, 0.2);
  return scene;
}

// Returns a subtask that opens the door of a microwave in front of the robot.
inline SkillSubtask OpenDoor(const std::string& name = "microwave") {
  SkillSubtask scene;
  scene.assets = {WithInertia(tasks::Microwave(name))};
  scene.subtask.name = "open_" + name;
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    handle = env.get_pose_by_link_name(\"" +
      name +
      "\", \"handle\")\n"
      "    reach = torch.norm(env.get_robot_gripper_pose() - handle, dim=-1)\n"
      "    moved = env.get_state_by_joint_name(\"" +
      name +
      "\", \"door_joint\") / 1.7\n"
      "    return 2.0 * moved - reach, moved >= 0.7\n";
  tasks::AssetPlacement placement;
  placement.asset = name;
  placement.fixed = true;
  placement.world_from_asset.translation() = Eigen::Vector3d(0.75, 0.15, 0.0);
  scene.subtask.start.placements = {placement};
  return scene;
}

// Returns the same scene with the door wide open, to be closed.
inline SkillSubtask CloseDoor(const std::string& name = "microwave") {
  SkillSubtask scene = OpenDoor(name);
  scene.subtask.name = "close_" + name;
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    moved = env.get_state_by_joint_name(\"" +
      name +
      "\", \"door_joint\") / 1.7\n"
      "    return -moved, moved <= 0.05\n";
  scene.subtask.start.joints = {{name, "door_joint", 1.3}};
  return scene;
}

}  // namespace simwright::skills
