#pragma once

#include <filesystem>
#include <string>

namespace simwright::workflows {

// The paths of the files that the stages of a photo run write (docs/run.md).
struct PhotoRunFolder {
  std::filesystem::path root;
  std::string asset_name;

  std::filesystem::path Asset() const { return root / asset_name; }
  std::filesystem::path Check() const { return root / "check.json"; }
  std::filesystem::path Furniture() const { return root / "furniture"; }
  std::filesystem::path Scene() const { return root / "scene.json"; }
  std::filesystem::path Tasks() const { return root / "tasks.json"; }
  std::filesystem::path Skill() const { return root / "skill"; }
  std::filesystem::path Rollout() const { return root / "rollout.json"; }
  std::filesystem::path Strip() const { return root / "rollout.png"; }
  std::filesystem::path Poses() const { return root / "poses.jsonl"; }
  std::filesystem::path Trajectory() const { return root / "trajectory.yaml"; }
  std::filesystem::path Export() const { return root / "export.json"; }
  std::filesystem::path Replay() const { return root / "replay.json"; }
  std::filesystem::path Report() const { return root / "report.json"; }
  std::filesystem::path Page() const { return root / "index.html"; }
  // The page in 3D, to which the other one links; written by the command line (viewer/).
  std::filesystem::path Viewer() const { return root / "viewer.html"; }
};

}  // namespace simwright::workflows
