#include "asset_lift/priors/training_pool.h"

#include <cmath>
#include <utility>

#include "asset_lift/priors/training_shapes.h"
#include "core/error.h"
#include "core/parallel.h"

namespace simwright::asset_lift {

TrainingPool::TrainingPool(TrainingSources sources, int size, std::uint64_t seed)
    : sources_(std::move(sources)), seed_(seed) {
  objects_.resize(static_cast<size_t>(size));
  core::ParallelFor(
      size, [&](int i) { objects_[static_cast<size_t>(i)] = Make(static_cast<std::uint64_t>(i)); });
  made_ = static_cast<std::uint64_t>(size);
}

std::vector<std::unique_ptr<TrainingObject>> TrainingPool::Prepare(int count) const {
  std::vector<std::unique_ptr<TrainingObject>> objects(static_cast<size_t>(count));
  core::ParallelFor(count, [&](int i) {
    objects[static_cast<size_t>(i)] = Make(made_ + static_cast<std::uint64_t>(i));
  });
  return objects;
}

void TrainingPool::Exchange(std::vector<std::unique_ptr<TrainingObject>> objects) {
  for (std::unique_ptr<TrainingObject>& object : objects) {
    objects_[static_cast<size_t>(made_ % objects_.size())] = std::move(object);
    ++made_;
  }
}

std::unique_ptr<TrainingObject> TrainingPool::Make(std::uint64_t number) const {
  // A mesh without extent is replaced by another sample.
  for (int attempt = 0; attempt < 10; ++attempt) {
    core::Rng rng = core::StreamRng(seed_, number * 16 + static_cast<std::uint64_t>(attempt));
    Eigen::Vector3d stretch;
    for (int axis = 0; axis < 3; ++axis) stretch[axis] = std::exp(0.18 * core::Normal(rng));
    const double source = core::Uniform(rng);
    const double sampled = sources_.sampler ? sources_.sampler_share : 0.0;
    try {
      if (source < sampled) {
        return std::make_unique<TrainingObject>(sources_.sampler(&rng), stretch);
      }
      if (sources_.meshes->empty() || source < sampled + sources_.parametric_share) {
        return std::make_unique<TrainingObject>(MakeTrainingShape(&rng), stretch);
      }
      const auto at = core::UniformIndex(rng, static_cast<std::int64_t>(sources_.meshes->size()));
      return std::make_unique<TrainingObject>((*sources_.meshes)[static_cast<size_t>(at)], stretch);
    } catch (const core::Error&) {
      if (attempt == 9) throw;
    }
  }
  return nullptr;
}

}  // namespace simwright::asset_lift
