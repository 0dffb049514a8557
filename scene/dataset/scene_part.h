#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/hdf5.h"
#include "scene/dataset/vocabulary.h"
#include "scene/feasible_scene.h"

namespace simwright::scene {

// What became of one draw from the grammar: what physics made of it, and whether it was kept.
struct SceneAttempt {
  int drawn = 0;             // objects of the draw, furniture included
  int kept = 0;              // that physics left
  int dropped = 0;           // that fell, tipped or did not rest
  bool projected = false;    // all could be moved apart
  bool sound = false;        // is a scene of the dataset
  double moved = 0.0;        // m, the mean
  double penetration = 0.0;  // m, the deepest
  double drift = 0.0;        // m, the farthest while it was watched

  bool operator==(const SceneAttempt&) const = default;
};

// Of a scene that had `drawn` objects.
SceneAttempt AttemptOf(const FeasibleScene& scene, int drawn);

// Where scenes come from. Parts of one dataset differ in `part` alone.
struct PartOrigin {
  std::uint64_t seed = 0;
  int part = 0;
  std::string assets;    // JSON: the slots' assets and the hashes of their files
  std::string settings;  // JSON: of drawing, moving apart and settling
  std::string program;   // version

  bool SameDataset(const PartOrigin& other) const {
    return seed == other.seed && assets == other.assets && settings == other.settings;
  }
};

// A piece of a dataset: a run of attempts, and the scenes among them that are sound. In a file
// (docs/formats.md) its tokens lie compressed in chunks of a few scenes.
struct ScenePart {
  Vocabulary vocabulary;
  PartOrigin origin;
  std::vector<float> tokens;  // (scenes x entries x TokenWidth)
  std::vector<SceneAttempt> attempts;

  int SceneCount() const;
};

// Written beside `path` and renamed in. Throws core::Error.
void WritePart(const ScenePart& part, const std::filesystem::path& path);

// A part in its file; scenes are read as they are asked for. Everything throws core::Error, naming
// the file, where it is missing, cut off, of another version, or at odds with itself. One thread
// at a time, whatever the part (core/hdf5).
class ScenePartFile {
 public:
  explicit ScenePartFile(const std::filesystem::path& path);

  const Vocabulary& vocabulary() const { return vocabulary_; }
  const PartOrigin& origin() const { return origin_; }
  const std::vector<SceneAttempt>& attempts() const { return attempts_; }
  int SceneCount() const { return scenes_; }

  // Tokens of scenes first .. first + count - 1, each looked at (FaultOfTokens).
  std::vector<float> Read(int first, int count) const;
  ScenePart ReadAll() const;

 private:
  void ReadOrigin(const core::Hdf5Group& root);
  void ReadAttempts(const core::Hdf5Group& root);

  std::filesystem::path path_;
  Vocabulary vocabulary_;
  PartOrigin origin_;
  std::vector<SceneAttempt> attempts_;
  int scenes_ = 0;
};

}  // namespace simwright::scene
