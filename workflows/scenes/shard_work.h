#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "core/progress.h"
#include "core/ranks.h"
#include "scene/dataset/generation.h"
#include "scene/dataset/scene_shard.h"

namespace simwright::workflows {

// The shards of a dataset that is made by any number of workers.
struct ShardedDataset {
  std::filesystem::path folder;
  scene::Generation generation;
  scene::Vocabulary vocabulary;
  scene::ShardOrigin origin;  // of the first shard
  int scenes = 0;             // of the dataset
  int scenes_per_shard = 1;

  int shards() const { return (scenes + scenes_per_shard - 1) / scenes_per_shard; }
  int ScenesOf(int shard) const;
  std::filesystem::path PathOf(int shard) const;
};

// One worker on a dataset: it makes the shards that are neither complete nor claimed by another
// worker, beginning with its own share. It verifies the complete files of its share alone.
// `progress` (its stage has begun) advances by one for each scene of the whole dataset that this
// worker makes or finds.
class ShardWork {
 public:
  // Both must outlive this.
  ShardWork(const ShardedDataset& dataset, const core::RankPlace& place, core::Progress* progress);

  // Makes shards until each is complete or claimed by another worker. Throws core::Error for a
  // shard of other scenes and as scene::ExtendShard does; and core::Cancelled, keeping the scenes
  // that were finished before.
  void MakeUnclaimed();
  // Waits until all shards are complete, and makes those that other workers leave behind.
  void WaitForOthers();

  // Returns the number of shards that other workers were making when they were last looked at.
  int elsewhere() const { return dataset_.shards() - complete_count_; }

 private:
  // Makes a shard, unless it is complete or claimed. Returns true if it is complete now.
  bool Make(int shard);
  // Returns true if a file has all scenes of the shard.
  bool IsThere(int shard) const;
  // Counts shards that others have completed since.
  void LookAtOthers();
  void Complete(int shard, int counted);

  const ShardedDataset& dataset_;
  core::RankPlace place_;
  int first_, last_;  // its own share of the shards: first_ <= shard < last_
  core::Progress& progress_;
  std::vector<char> complete_;  // (shards)
  int complete_count_ = 0;
};

}  // namespace simwright::workflows
