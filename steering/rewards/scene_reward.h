#pragma once

#include <string>

#include "steering/rewards/judged_scene.h"

namespace simwright::steering {

// A reward of scenes: a search looks for the scene with the largest one, and post-training raises
// its mean.
class SceneReward {
 public:
  virtual ~SceneReward() = default;

  // Returns true if Evaluate needs a judged scene.
  virtual bool NeedsPhysics() const = 0;
  // Returns the reward. Thread-safe. Throws core::Error for a scene that is not judged though
  // NeedsPhysics() is true.
  virtual double Evaluate(const JudgedScene& scene) const = 0;
  // Returns the reward beyond which a search need not look: the largest possible one, or a goal.
  virtual double Goal() const = 0;
  // Returns the reward in words for reports: "feasible objects".
  virtual std::string Name() const = 0;
};

}  // namespace simwright::steering
