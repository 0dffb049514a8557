#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "asset_lift/priors/prior_training.h"
#include "asset_lift/priors/shape_example.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

// The sources of training objects and their shares, as in PriorTrainingOptions.
struct TrainingSources {
  const std::vector<core::TexturedMesh>* meshes = nullptr;  // must outlive the pool
  double parametric_share = 0.4;
  TrainingMeshSampler sampler;  // may be empty
  double sampler_share = 0.0;
};

// The objects prepared for rendering, each from a random source and stretched. They are exchanged
// gradually, since preparing one costs as much as many renderings of it.
class TrainingPool {
 public:
  // Deterministic for a seed, regardless of the number of threads.
  TrainingPool(TrainingSources sources, int size, std::uint64_t seed);

  // Prepares the next `count` objects, without changing the pool; may run in another thread.
  std::vector<std::unique_ptr<TrainingObject>> Prepare(int count) const;
  // Replaces the oldest objects by those that Prepare() returned.
  void Exchange(std::vector<std::unique_ptr<TrainingObject>> objects);
  const TrainingObject& object(int index) const { return *objects_[static_cast<size_t>(index)]; }
  int size() const { return static_cast<int>(objects_.size()); }

 private:
  std::unique_ptr<TrainingObject> Make(std::uint64_t number) const;

  TrainingSources sources_;
  std::uint64_t seed_;
  std::uint64_t made_ = 0;
  std::vector<std::unique_ptr<TrainingObject>> objects_;
};

}  // namespace simwright::asset_lift
