#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "asset_lift/priors/shape_example.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

// The objects prepared for rendering: stretched catalogue meshes and parametric shapes. They are
// exchanged gradually, since preparing one costs as much as many renderings of it.
class TrainingPool {
 public:
  // `meshes` must outlive the pool. Deterministic for a seed, regardless of the number of threads.
  TrainingPool(const std::vector<core::TexturedMesh>* meshes, int size, double parametric_share,
               std::uint64_t seed);

  // Replaces the `count` oldest objects.
  void Exchange(int count);
  const TrainingObject& object(int index) const { return *objects_[static_cast<size_t>(index)]; }
  int size() const { return static_cast<int>(objects_.size()); }

 private:
  std::unique_ptr<TrainingObject> Make(std::uint64_t number) const;

  const std::vector<core::TexturedMesh>* meshes_;
  double parametric_share_;
  std::uint64_t seed_;
  std::uint64_t made_ = 0;
  std::vector<std::unique_ptr<TrainingObject>> objects_;
};

}  // namespace simwright::asset_lift
