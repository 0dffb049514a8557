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
  std::string name;      // its name in reward programs: a letter, then letters, digits, '_', '-'
  std::string path;      // its asset folder or URDF file
  std::string category;  // such as "microwave"; may be empty
};

// The position of a joint at the start.
struct JointCondition {
  std::string asset, joint;
  double position = 0.0;  // rad or m
};

// The pose of an asset at the start.
struct AssetPlacement {
  std::string asset;
  Eigen::Isometry3d world_from_asset = Eigen::Isometry3d::Identity();
  bool fixed = false;  // the root link is fixed to the world, as a cupboard's is to a wall
};

// The state that an episode starts from. World frame: z up, floor at z = 0; poses are in m.
struct InitialState {
  Eigen::Isometry3d world_from_robot = Eigen::Isometry3d::Identity();  // the robot's base
  std::vector<AssetPlacement> placements;
  std::vector<JointCondition> joints;  // other joints are at the position nearest to zero
  std::string held;                    // the asset that the gripper holds; empty: none
};

// An earlier reward program of a language model (or its answer, if that held no program), and the
// findings for which it was replaced.
struct Attempt {
  std::string program;
  core::Findings findings;
};

// The part of a task that one policy learns.
struct Subtask {
  std::string name;         // unique within its task: letters, digits, '_', '-'
  std::string description;  // a sentence
  std::string program;      // source of the reward program (docs/rewards.md)
  std::string success;      // the success condition: an expression of the program, or a sentence
  InitialState start;
  std::optional<Eigen::Vector3d> goal;  // the value of get_goal_pose: a position, m, world
  core::Findings findings;              // of the verification; each place is "line:column" in the
                                        // program, or empty
  std::vector<Attempt> attempts;        // earlier programs, oldest first

  // Returns true if there is a program and no finding is an error.
  bool valid() const {
    for (const core::Finding& finding : findings) {
      if (finding.severity == core::Severity::kError) return false;
    }
    return !program.empty();
  }
};

// A task that a person would want done, as a sequence of subtasks.
struct Task {
  std::string name;                 // unique within its task set
  std::string description;          // a sentence
  std::string source;               // "rules", or the language model's name
  std::vector<std::string> assets;  // names of the assets that the task uses
  std::vector<Subtask> subtasks;  // in order: each starts in the state where its predecessor ended
  core::Findings findings;        // findings on the task as a whole, not on one subtask

  // Returns true if there is a subtask, every subtask is valid, and no finding is an error.
  bool valid() const {
    for (const core::Finding& finding : findings) {
      if (finding.severity == core::Severity::kError) return false;
    }
    for (const Subtask& subtask : subtasks) {
      if (!subtask.valid()) return false;
    }
    return !subtasks.empty();
  }
};

// The contents of a tasks.json.
struct TaskSet {
  std::vector<TaskAsset> assets;
  std::vector<Task> tasks;
};

}  // namespace simwright::tasks
