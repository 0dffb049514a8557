#pragma once

#include <filesystem>
#include <memory>

#include "viewer/content.h"
#include "viewer/contents/task_view.h"
#include "workflows/skills/skill_recording.h"
#include "workflows/skills/skill_rollout.h"

namespace simwright::viewer {

// The poses of a rollout (docs/formats.md), read from their file.
struct RolloutPoseFile {
  std::string robot, task;
  Timeline timeline;  // track 0 is the robot, track i + 1 object i
  std::vector<std::string> objects;
};

// Reads a file of `rollout --poses`. Throws core::Error, naming the line, if it is damaged.
RolloutPoseFile ReadRolloutPoses(const std::filesystem::path& file);

// Returns the entry of a rollout: the bodies of its task's start, and its timeline. Throws
// core::Error if `set` lacks its task or an object.
core::OrderedJson RolloutWorld(const RolloutPoseFile& poses, const tasks::TaskSet& set,
                               TaskModels* models, DocumentBuilder* builder);

// Returns the content of a file of poses with the tasks.json beside it. Throws core::Error if
// either is missing or damaged.
std::unique_ptr<Content> ReadRolloutView(const std::filesystem::path& file);

// Returns a recorded episode as a timeline over the bodies of TaskModels::BodiesAtStart of its
// first subtask: poses and joints, the reward of each decision, the opening of the gripper, and
// contacts of the fingertips (strength 1: a finger touches, 2: both hold an object).
Timeline EpisodeTimeline(const workflows::TrainedTask& task,
                         const workflows::ChainRecording& recording);

}  // namespace simwright::viewer
