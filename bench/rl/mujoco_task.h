#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/random.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

enum class KnownTask {
  kReacher,  // Gymnasium's Reacher-v5: a planar arm of two joints reaches a point
  kPusher,   // Gymnasium's Pusher-v5: an arm of seven joints pushes a cylinder to its goal
};

// A known task in MuJoCo with the model file, observations, rewards and starts of Gymnasium's
// environment. Episodes are truncated, never terminated. Its state
// cannot be saved.
class MujocoTask : public VectorEnvironment {
 public:
  // `mjcf`: Gymnasium's reacher.xml or pusher_v5.xml. Throws core::Error if MuJoCo cannot read it.
  MujocoTask(KnownTask task, const std::filesystem::path& mjcf, int count);
  ~MujocoTask() override;
  MujocoTask(const MujocoTask&) = delete;
  MujocoTask& operator=(const MujocoTask&) = delete;

  int steps() const { return task_ == KnownTask::kReacher ? 50 : 100; }  // of an episode
  int size() const override { return static_cast<int>(worlds_.size()); }
  int observation_size() const override { return task_ == KnownTask::kReacher ? 10 : 23; }
  int action_size() const override { return model_->nu; }
  void Reset(std::uint64_t seed, Rows* observations) override;
  void Step(const Rows& actions, StepBatch* batch) override;
  std::string SaveState() const override;
  void RestoreState(std::string_view state, Rows* observations) override;

 private:
  struct World {
    mjData* data = nullptr;
    core::Rng rng;
    int steps = 0;
  };
  void Start(World* world) const;
  Eigen::RowVectorXf Observe(const World& world) const;
  double RewardOf(const World& world) const;
  Eigen::Vector3d BodyAt(const World& world, const char* name) const;

  KnownTask task_;
  mjModel* model_ = nullptr;
  std::vector<World> worlds_;
};

}  // namespace simwright::rl
