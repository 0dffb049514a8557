#pragma once

#include <filesystem>
#include <vector>

#include "scene/dataset/scene_part.h"

namespace simwright::scene {

// "part_00012.h5"
std::string PartName(int part);

// The scenes of a folder of parts, or of one part's file, numbered through in order of the parts'
// names. Holds what the parts say of themselves, no scenes. One thread at a time.
class SceneDataset {
 public:
  // Throws core::Error where there is no part, one is damaged, or two do not belong together.
  explicit SceneDataset(const std::filesystem::path& path);

  const Vocabulary& vocabulary() const { return parts_.front().vocabulary(); }
  const std::vector<ScenePartFile>& parts() const { return parts_; }
  int SceneCount() const { return scenes_; }
  std::vector<SceneAttempt> Attempts() const;

  // Tokens of scenes first .. first + count - 1 (count x entries x TokenWidth). Throws core::Error
  // where they are not all there, or one is damaged.
  std::vector<float> Read(int first, int count) const;

 private:
  std::vector<ScenePartFile> parts_;
  std::vector<int> first_;  // scene of each part
  int scenes_ = 0;
};

}  // namespace simwright::scene
