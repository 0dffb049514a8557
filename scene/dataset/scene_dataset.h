#pragma once

#include <filesystem>
#include <vector>

#include "scene/dataset/scene_shard.h"

namespace simwright::scene {

// Returns the file name of a shard: "part_00012.h5".
std::string ShardName(int part);

// The scenes of a folder of shards, or of one shard file, numbered consecutively in the order of
// the shards' names. Holds the metadata of the shards, not the scenes. Not thread-safe.
class SceneDataset {
 public:
  // Throws core::Error if there is no shard, one is damaged, or two belong to different datasets.
  explicit SceneDataset(const std::filesystem::path& path);

  const Vocabulary& vocabulary() const { return parts_.front().vocabulary(); }
  const std::vector<SceneShardFile>& parts() const { return parts_; }
  int SceneCount() const { return scenes_; }
  std::vector<SceneAttempt> Attempts() const;

  // Returns the tokens of scenes first .. first + count - 1 (count x entries x TokenWidth). Throws
  // core::Error if the dataset has fewer scenes, or a shard is damaged.
  std::vector<float> Read(int first, int count) const;

  // Returns the prompts of the same scenes, one each; empty if one of their shards has none, which
  // was written by an earlier version or sampled from a model. Throws core::Error as Read does.
  std::vector<std::string> ReadPrompts(int first, int count) const;

 private:
  void CheckRange(int first, int count) const;

  std::vector<SceneShardFile> parts_;
  std::vector<int> first_;  // first scene of each shard
  int scenes_ = 0;
};

}  // namespace simwright::scene
