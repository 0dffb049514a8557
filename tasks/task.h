#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/finding.h"

namespace simwright::tasks {

// An object that tasks may name.
struct TaskAsset {
  std::string name;      // name in programs: a letter, then letters, digits, '_', '-'
  std::string path;      // its folder or URDF
  std::string category;  // "microwave"; may be empty
};

// The position of a joint.
struct JointCondition {
  std::string asset, joint;
  double position = 0.0;  // rad or m
};

// The pose of an asset.
struct AssetPlacement {
  std::string asset;
  Eigen::Isometry3d world_from_asset = Eigen::Isometry3d::Identity();
  bool fixed = false;  // its root is fixed to the world, as a cupboard's is to a wall
};

// The state that an episode starts from. World frame: z up, floor z = 0.
struct InitialState {
  Eigen::Isometry3d world_from_robot = Eigen::Isometry3d::Identity();  // the robot's base
  std::vector<AssetPlacement> placements;
  std::vector<JointCondition> joints;  // joints not named are at the position nearest zero
  std::string held;                    // the asset that the gripper holds; empty: none
};

// An answer of a language model that was replaced, and its findings.
struct Attempt {
  std::string program;
  core::Findings findings;
};

// The unit of work that one policy learns.
struct Subtask {
  std::string name;         // unique within its task: letters, digits, '_', '-'
  std::string description;  // a sentence
  std::string program;      // source of the reward program (docs/rewards.md)
  std::string success;      // the success condition, as an expression of the program or a sentence
  InitialState start;
  std::optional<Eigen::Vector3d> goal;  // m, world; the value of get_goal_pose
  core::Findings findings;              // findings of the verification; place: "line:column" or
                                        // empty
  std::vector<Attempt> attempts;        // earlier programs, in order

  bool sound() const {
    for (const core::Finding& finding : findings) {
      if (finding.severity == core::Severity::kError) return false;
    }
    return !program.empty();
  }
};

struct Task {
  std::string name;         // unique within its set
  std::string description;  // a sentence
  std::string source;       // "rules", or the language model's name
  std::vector<std::string> assets;
  std::vector<Subtask> subtasks;  // in order: each starts in the state where its predecessor ended
  core::Findings findings;        // of the task as a whole

  bool sound() const {
    for (const core::Finding& finding : findings) {
      if (finding.severity == core::Severity::kError) return false;
    }
    for (const Subtask& subtask : subtasks) {
      if (!subtask.sound()) return false;
    }
    return !subtasks.empty();
  }
};

struct TaskSet {
  std::vector<TaskAsset> assets;
  std::vector<Task> tasks;
};

}  // namespace simwright::tasks
