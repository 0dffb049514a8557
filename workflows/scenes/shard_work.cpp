#include "workflows/scenes/shard_work.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/error.h"
#include "core/free_memory.h"
#include "core/log.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/shard_claim.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr std::chrono::milliseconds kShardWait{200};

// Returns the shard in its current state, or an empty one.
scene::SceneShard ShardAt(const fs::path& path, const scene::Vocabulary& vocabulary,
                          const scene::ShardOrigin& origin) {
  if (!fs::exists(path)) return {vocabulary, origin, {}, {}};
  scene::SceneShard shard = scene::SceneShardFile(path).ReadAll();
  if (!(shard.vocabulary == vocabulary) || !shard.origin.SameDataset(origin)) {
    throw core::Error("it contains scenes of another type, seed, asset set or settings",
                      path.string(), "generate into a new folder");
  }
  return shard;
}

// Extends the shard, and writes it, incomplete after core::Cancelled.
void ExtendAndWrite(const scene::Generation& generation, int scenes, const fs::path& path,
                    scene::SceneShard shard, core::Progress* progress) {
  const size_t before = shard.attempts.size();
  try {
    scene::ExtendShard(generation, scenes, &shard, progress);
  } catch (const core::Cancelled&) {
    if (shard.attempts.size() > before) scene::WriteShard(shard, path);
    throw;
  }
  scene::WriteShard(shard, path);
}

// Returns where the share of this worker begins, with `next` 1 that of the next one. Workers begin
// at equal distances, so that they seldom meet.
int FirstOfShare(int shards, const core::RankPlace& place, int next) {
  return static_cast<int>(static_cast<std::int64_t>(shards) * (place.worker() + next) /
                          place.workers());
}

}  // namespace

int ShardedDataset::ScenesOf(int shard) const {
  return std::min(scenes_per_shard, scenes - shard * scenes_per_shard);
}

fs::path ShardedDataset::PathOf(int shard) const {
  return folder / scene::ShardName(shard);
}

ShardWork::ShardWork(const ShardedDataset& dataset, const core::RankPlace& place,
                     core::Progress* progress)
    : dataset_(dataset),
      place_(place),
      first_(FirstOfShare(dataset.shards(), place, 0)),
      last_(FirstOfShare(dataset.shards(), place, 1)),
      progress_(*progress),
      complete_(static_cast<size_t>(dataset.shards()), 0) {}

void ShardWork::Complete(int shard, int counted) {
  complete_[static_cast<size_t>(shard)] = 1;
  ++complete_count_;
  for (int i = counted; i < dataset_.ScenesOf(shard); ++i) progress_.Advance();
}

bool ShardWork::Make(int shard) {
  const bool own = first_ <= shard && shard < last_;
  if (!own && IsThere(shard)) {
    Complete(shard, 0);
    return true;
  }
  const fs::path path = dataset_.PathOf(shard);
  const scene::ShardClaim claim(path);
  if (!claim.held()) return false;
  scene::ShardOrigin origin = dataset_.origin;
  origin.part = shard;
  const int scenes = dataset_.ScenesOf(shard);
  scene::SceneShard present = ShardAt(path, dataset_.vocabulary, origin);
  const int found = std::min(scenes, present.SceneCount());
  for (int i = 0; i < found; ++i) progress_.Advance();
  // A shard of an earlier version lacks prompts; they are added.
  const bool has_prompts = present.prompts.size() == static_cast<size_t>(present.SceneCount());
  if (found < scenes || !has_prompts) {
    ExtendAndWrite(dataset_.generation, scenes, path, std::move(present), &progress_);
    core::ReturnFreeMemory();
    core::Log(core::LogLevel::kInfo, "workflows", "wrote shard ", shard, " of ", dataset_.folder);
  }
  Complete(shard, scenes);
  return true;
}

bool ShardWork::IsThere(int shard) const {
  const fs::path path = dataset_.PathOf(shard);
  // A file appears as a whole, but one of an interrupted run has fewer scenes.
  return fs::exists(path) && scene::SceneCountIn(path) >= dataset_.ScenesOf(shard);
}

void ShardWork::MakeUnclaimed() {
  const int shards = dataset_.shards();
  for (bool made = true; made && complete_count_ < shards;) {
    made = false;
    for (int k = 0; k < shards; ++k) {
      const int shard = (first_ + k) % shards;
      if (complete_[static_cast<size_t>(shard)] || !Make(shard)) continue;
      made = true;
      if (place_.leads() && place_.world_size > 1) LookAtOthers();
    }
  }
}

void ShardWork::LookAtOthers() {
  for (int shard = 0; shard < dataset_.shards(); ++shard) {
    if (!complete_[static_cast<size_t>(shard)] && IsThere(shard)) Complete(shard, 0);
  }
}

void ShardWork::WaitForOthers() {
  while (complete_count_ < dataset_.shards()) {
    MakeUnclaimed();
    if (complete_count_ == dataset_.shards()) return;
    core::CheckCancelled();
    std::this_thread::sleep_for(kShardWait);
  }
}

}  // namespace simwright::workflows
