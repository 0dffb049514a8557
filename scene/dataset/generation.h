#pragma once

#include <string>

#include "core/progress.h"
#include "scene/asset_set/asset_set.h"
#include "scene/dataset/scene_shard.h"
#include "scene/feasibility/feasible_scene.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

// The settings shared by all shards of a dataset that is sampled from a grammar.
struct Generation {
  Grammar grammar;
  const AssetSet* asset_set = nullptr;  // not null; must outlive this
  FeasibilityOptions feasibility;
  // The largest number of attempts per valid scene, over a shard; beyond it generation fails.
  int attempts_per_scene = 50;
  // True: scenes stay as the grammar samples them, without physics: a thousand times faster, with
  // small penetrations, and with objects upright that would topple.
  bool raw = false;
};

// Samples scenes, resolves their penetrations and settles them until `part` has `scenes` valid
// ones. Continues from the contents of `part`, runs in parallel, and gives the same result for any
// number of threads and interruptions. `part` must have its vocabulary and origin. Attempt k of
// shard p samples from stream p 2^32 + k of the seed. Draws a prompt for every scene without one,
// from the same stream of another seed; scenes do not depend on prompts. Advances `progress` by one
// per new scene; if that throws core::Cancelled, the shard keeps the scenes that were finished
// before. Throws core::Error for a category without an asset, and, with counts of the failures, if
// valid scenes are too rare.
void ExtendShard(const Generation& generation, int scenes, SceneShard* part,
                 core::Progress* progress);

// Returns the settings as JSON: equal settings give equal scenes.
std::string SettingsText(const Generation& generation);

}  // namespace simwright::scene
