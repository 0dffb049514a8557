#include "workflows/scenes/solvable_reward.h"

#include <optional>

#include "certificate/scene_bodies.h"
#include "core/error.h"
#include "robot/panda_model.h"
#include "workflows/scenes/certify_targets.h"

namespace simwright::workflows {
namespace {

constexpr double kSolved = 0.5;  // the reward of a scene that is solvable without any difficulty

class Solvable : public steering::SceneReward {
 public:
  Solvable(const CertifyTask& task, Solvability solvability, const scene::AssetSet& asset_set,
           std::uint64_t seed)
      : task_(task),
        solvability_(solvability),
        sizes_(asset_set.Sizes()),
        bodies_(asset_set),
        planner_(robot::Panda(false), {}, seed),
        bases_(planner_, std::nullopt) {
    options_.motion.seed = seed;
  }

  bool NeedsPhysics() const override { return true; }

  double Evaluate(const steering::JudgedScene& scene) const override {
    if (!scene.IsJudged()) throw core::Error("this reward needs a judged scene");
    std::vector<scene::SceneObject> feasible;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
      if (scene.IsFeasible(i)) feasible.push_back(scene.objects[i]);
    }
    const certificate::PlacedScene placed = bodies_.SceneOf(feasible);
    const std::vector<certificate::TargetTask> targets =
        CertifyTargets(task_, feasible, sizes_, placed, &bases_);
    if (targets.empty()) return 0.0;
    const std::optional<double> difficulty = certificate::PlannedDifficulty(
        planner_, placed, certificate::EasiestFirst(planner_, placed, targets), options_);
    if (!difficulty) return 0.0;
    if (solvability_ == Solvability::kSolvable) return 1.0;
    return kSolved + (1.0 - kSolved) * *difficulty;
  }

  double Goal() const override { return 1.0; }

  std::string Name() const override {
    const char* const name =
        solvability_ == Solvability::kSolvable ? "solvable: " : "hard but solvable: ";
    return name + task_.Text();
  }

 private:
  CertifyTask task_;
  Solvability solvability_;
  scene::CategorySizes sizes_;
  certificate::SceneBodies bodies_;
  certificate::Planner planner_;
  mutable RobotBases bases_;
  certificate::CertificateOptions options_;
};

}  // namespace

std::unique_ptr<steering::SceneReward> SolvableReward(const CertifyTask& task,
                                                      Solvability solvability,
                                                      const scene::AssetSet& asset_set,
                                                      std::uint64_t seed) {
  return std::make_unique<Solvable>(task, solvability, asset_set, seed);
}

}  // namespace simwright::workflows
