#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/scene_stream.h"
#include "scene/model/scene_diffusion.h"
#include "scene/model/scene_model.h"
#include "scene/model/training.h"

namespace simwright::scene {

// The scenes of one type in a training.
struct TrainingType {
  const SceneDataset* dataset = nullptr;
  int training = 0, held_out = 0;  // scenes 0 .. training - 1 are trained on, the next held out
  PoseRange range;
  torch::Tensor class_of;  // (C + 1) int64: the dataset's classes in the model's vocabulary
  std::vector<std::string> present;  // categories that its scenes may have

  const Vocabulary& vocabulary() const { return dataset->vocabulary(); }
};

// The datasets of a training, one for each scene type. Classes are those of a common vocabulary;
// each type keeps its number of entries and its range of poses.
class TrainingData {
 public:
  // The datasets must outlive this. Throws core::Error for datasets of the same type, or a category
  // that is furniture in one of them only.
  TrainingData(const std::vector<const SceneDataset*>& datasets,
               const SceneTrainingOptions& options);

  // Sets vocabulary, ranges, types and numbers of scenes.
  void Describe(SceneModelMetadata* metadata) const;
  const std::vector<TrainingType>& types() const { return types_; }
  int ClassCount() const { return vocabulary_.ClassCount(); }
  int training() const;
  int held_out() const;

  // Starts the streams of random scenes.
  void Start(std::uint64_t seed, int buffer);
  // Returns the tokens of the next `count` scenes of a type. Requires Start.
  std::vector<float> Next(int type, int count);
  // Returns scenes of a type as the model's tensors. `tokens`: of the type's vocabulary.
  CleanScenes Tensors(int type, const std::vector<float>& tokens) const;

 private:
  std::vector<TrainingType> types_;
  Vocabulary vocabulary_;
  std::vector<SceneStream> streams_;
};

}  // namespace simwright::scene
