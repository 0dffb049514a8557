#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "core/progress.h"
#include "scene/dataset/pose_range.h"
#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_draw.h"
#include "scene/model/model_options.h"

namespace simwright::scene {

struct SampleOptions {
  int steps = 0;  // of the diffusion's, evenly left out; 0: all of them
  // Share of the posterior's noise that poses keep (1: as trained; 0: none, DDIM).
  double eta = 1.0;
  int batch = 64;  // scenes at once
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

// What a weights file says of where it comes from.
struct SceneModelFacts {
  Vocabulary vocabulary;
  SceneModelOptions options;
  PoseRange range;
  int training_scenes = 0;  // scenes 0 .. training_scenes - 1 of the dataset; the rest held out
  std::uint64_t data_seed = 0;
  std::int64_t parameters = 0;
  int steps = 0;  // of the training
};

// A trained model of scenes. Constant; may be shared by threads.
class SceneModel {
 public:
  // Throws core::Error where the file is missing or no such model.
  static SceneModel Load(const std::filesystem::path& weights);
  ~SceneModel();
  SceneModel(SceneModel&&) noexcept;
  SceneModel& operator=(SceneModel&&) noexcept;

  const SceneModelFacts& facts() const;

  // One thing more that it may place, free, known by its surface alone (ShapeOf, of
  // facts().options.shape_points). Throws core::Error where the model does not know classes by
  // their shape, the slot is there already, or points are missing or not finite.
  void AddAsset(const std::string& slot, const std::vector<Eigen::Vector3d>& surface);

  // Tokens of `count` new scenes (count x entries x TokenWidth), classes one-hot, matrices as the
  // network has them (DecodeScene turns them to rotations). Advances `progress` by one a scene.
  // Throws core::Error for options that are not valid.
  std::vector<float> Sample(int count, const SampleOptions& options,
                            core::Progress* progress) const;

 private:
  struct Network;
  explicit SceneModel(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace simwright::scene
