#include "scene/dataset/scene_dataset.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"

namespace simwright::scene {
namespace fs = std::filesystem;
namespace {

std::vector<fs::path> PartPaths(const fs::path& path) {
  if (fs::is_regular_file(path)) return {path};
  std::vector<fs::path> paths;
  if (fs::is_directory(path)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
      const std::string name = entry.path().filename().string();
      if (name.rfind("part_", 0) == 0 && entry.path().extension() == ".h5") {
        paths.push_back(entry.path());
      }
    }
  }
  if (paths.empty()) {
    throw core::Error("there are no scenes", path.string(),
                      "make some with `simwright scene generate`");
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

std::string ShardName(int part) {
  char name[32];
  std::snprintf(name, sizeof name, "part_%05d.h5", part);
  return name;
}

SceneDataset::SceneDataset(const fs::path& path) {
  for (const fs::path& one : PartPaths(path)) {
    parts_.emplace_back(one);
    const SceneShardFile& part = parts_.back();
    if (!(part.vocabulary() == vocabulary()) ||
        !part.origin().SameDataset(parts_.front().origin())) {
      throw core::Error(
          "its scenes differ in type, seed, asset set or settings from those "
          "of the previous shards",
          one.string(), "keep each dataset in its own folder");
    }
    first_.push_back(scenes_);
    scenes_ += part.SceneCount();
  }
}

std::vector<SceneAttempt> SceneDataset::Attempts() const {
  std::vector<SceneAttempt> attempts;
  for (const SceneShardFile& part : parts_) {
    attempts.insert(attempts.end(), part.attempts().begin(), part.attempts().end());
  }
  return attempts;
}

void SceneDataset::CheckRange(int first, int count) const {
  if (first < 0 || count < 0 || first > scenes_ - count) {
    throw core::Error("there are " + std::to_string(scenes_) + " scenes, not scene " +
                      std::to_string(first + count - 1));
  }
}

std::vector<std::string> SceneDataset::ReadPrompts(int first, int count) const {
  CheckRange(first, count);
  std::vector<std::string> prompts;
  for (size_t i = 0; i < parts_.size(); ++i) {
    const int from = std::max(first - first_[i], 0);
    const int to = std::min(first + count - first_[i], parts_[i].SceneCount());
    if (from >= to) continue;
    const std::vector<std::string> some = parts_[i].Prompts(from, to - from);
    if (some.empty()) return {};
    prompts.insert(prompts.end(), some.begin(), some.end());
  }
  return prompts;
}

std::vector<float> SceneDataset::Read(int first, int count) const {
  CheckRange(first, count);
  std::vector<float> tokens;
  for (size_t i = 0; i < parts_.size(); ++i) {
    const int from = std::max(first - first_[i], 0);
    const int to = std::min(first + count - first_[i], parts_[i].SceneCount());
    if (from >= to) continue;
    const std::vector<float> some = parts_[i].Read(from, to - from);
    tokens.insert(tokens.end(), some.begin(), some.end());
  }
  return tokens;
}

}  // namespace simwright::scene
