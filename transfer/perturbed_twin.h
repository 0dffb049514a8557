#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/random.h"
#include "skills/skill_options.h"
#include "transfer/transfer_world.h"
#include "workflows/twin/twin_record.h"

namespace simwright::transfer {

// The ranges of what a photo does not tell, as factors; those of a training (skills::SkillOptions).
struct PhysicsRanges {
  skills::FactorRange mass, friction;
  skills::FactorRange finger_friction;  // coefficients
  double own_finger_friction = 2.0;     // the robot's
};

// Samples the worlds that agree with a twin within its own uncertainty.
class PerturbedTwin {
 public:
  // `described`: the twin's objects as a task places them. Throws core::Error, naming the object,
  // if the twin has none of that name or has it elsewhere; `where` names the twin.
  PerturbedTwin(const workflows::TwinRecord& record, TransferWorld described,
                const PhysicsRanges& physics, const std::filesystem::path& where);

  // Returns world `index` of `seed`, a pure function of the arguments. With `scale` s, each object
  // moves by s position_error times a normal number along x and y, turns about its vertical middle
  // line by s yaw_error times another, and grows by exp(s e n), e^2 = size_error^2 -
  // log_scale_error^2; then all lengths, from below the camera, grow by exp(s log_scale_error n).
  // Masses and frictions are sampled uniformly in their logarithm, with their ranges' powers of
  // min(s, 1). Draws in which objects interpenetrate that do not do so in the twin are drawn again,
  // up to 20 times.
  TransferWorld World(double scale, std::uint64_t seed, std::uint64_t index) const;

 private:
  struct Uncertainty {
    double position = 0.0, yaw = 0.0, size = 0.0;
    bool metric = false;  // its size does not depend on the scale of the photo
  };
  struct Draw;
  bool IsValid(const std::vector<Draw>& draws) const;
  std::vector<Draw> Sample(double scale, double common, core::Rng& rng) const;

  TransferWorld described_;
  PhysicsRanges physics_;
  double log_scale_error_ = 0.0;
  std::vector<Uncertainty> uncertainty_;                    // by object
  std::vector<std::vector<geometry::ConvexShape>> shapes_;  // by object, its own frame
  std::vector<std::vector<bool>> touches_;                  // by pair of objects: in the twin
};

}  // namespace simwright::transfer
