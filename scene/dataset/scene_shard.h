#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/dataset/vocabulary.h"
#include "scene/feasibility/feasible_scene.h"

namespace simwright::core {
class Hdf5Group;
}

namespace simwright::scene {

// The result of one sample of the grammar after physics.
struct SceneAttempt {
  int sampled = 0;           // objects of the sample, furniture included
  int kept = 0;              // objects that remain after physics
  int dropped = 0;           // objects that fell, toppled or did not come to rest
  bool projected = false;    // true if all penetrations were resolved
  bool valid = false;        // true if valid: a scene of the dataset
  double moved = 0.0;        // m, mean displacement
  double penetration = 0.0;  // m, the deepest
  double drift = 0.0;        // m, largest drift during the stability check

  bool operator==(const SceneAttempt&) const = default;
};

// Returns the record of a scene that was sampled with `drawn` objects.
SceneAttempt AttemptOf(const FeasibleScene& scene, int sampled);

// The provenance of scenes. Shards of one dataset differ in `part` only.
struct ShardOrigin {
  std::uint64_t seed = 0;
  int part = 0;
  std::string assets;    // JSON: the assets of the categories and the hashes of their files
  std::string settings;  // JSON: of sampling, depenetration and settling
  std::string program;   // version

  bool SameDataset(const ShardOrigin& other) const {
    return seed == other.seed && assets == other.assets && settings == other.settings;
  }
};

// A shard of a dataset: a sequence of attempts, and the valid scenes among them. In a file
// (docs/formats.md) its tokens are compressed in chunks of a few scenes.
struct SceneShard {
  Vocabulary vocabulary;
  ShardOrigin origin;
  std::vector<float> tokens;  // (scenes x entries x TokenWidth)
  std::vector<SceneAttempt> attempts;
  // A prompt (scene/prompt) for each scene, in the same order; empty if the shard has none.
  std::vector<std::string> prompts = {};

  int SceneCount() const;
};

// Writes a shard atomically: to a temporary file that is renamed to `path`. Throws core::Error,
// also for prompts whose number is neither 0 nor that of the scenes.
void WriteShard(const SceneShard& part, const std::filesystem::path& path);

// Returns the number of scenes in a shard's file, without verifying the file. Throws core::Error if
// it is no HDF5 file with scenes.
int SceneCountIn(const std::filesystem::path& path);

// A shard in its file; scenes are read on demand. Every member throws core::Error, naming the file,
// if it is missing, truncated, of another version, or inconsistent. Not thread-safe, not even for
// different shards (core/hdf5).
class SceneShardFile {
 public:
  explicit SceneShardFile(const std::filesystem::path& path);

  const Vocabulary& vocabulary() const { return vocabulary_; }
  const ShardOrigin& origin() const { return origin_; }
  const std::vector<SceneAttempt>& attempts() const { return attempts_; }
  int SceneCount() const { return scenes_; }

  // Returns the tokens of scenes first .. first + count - 1, each validated with ValidateTokens.
  std::vector<float> Read(int first, int count) const;
  // Returns the prompts of scenes first .. first + count - 1; empty if the file has none.
  std::vector<std::string> Prompts(int first, int count) const;
  SceneShard ReadAll() const;

 private:
  void ReadOrigin(const core::Hdf5Group& root);
  void ReadAttempts(const core::Hdf5Group& root);

  std::filesystem::path path_;
  Vocabulary vocabulary_;
  ShardOrigin origin_;
  std::vector<SceneAttempt> attempts_;
  int scenes_ = 0;
};

}  // namespace simwright::scene
