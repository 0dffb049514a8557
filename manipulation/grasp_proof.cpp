#include "manipulation/grasp_proof.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kBatch = 16;  // candidates between two looks at the number of proved grasps
// Knobs with sloping sides have few grasps at the sampler's angle: with fewer candidates than this,
// a part is sampled again with closing axes up to this angle (rad) from the normals.
constexpr size_t kFewCandidates = 50;
constexpr double kWideAngle = 0.45;
constexpr std::uint64_t kSamplerStream = 0, kFirstPerturbationStream = 1;

// Returns a reason without its figures: "slipped in the lift".
std::string KindOf(const std::string& reason) {
  std::string kind;
  for (size_t i = 0; i < reason.size(); ++i) {
    const auto is_digit = [&](size_t at) {
      return at < reason.size() && std::isdigit(static_cast<unsigned char>(reason[at])) != 0;
    };
    if (!is_digit(i)) {
      kind += reason[i];
      continue;
    }
    while (is_digit(i) || (reason[i] == '.' && is_digit(i + 1))) ++i;  // the figure
    ++i;                                                               // the blank
    while (i < reason.size() && reason[i] != ' ') ++i;                 // the unit
    if (!kind.empty() && kind.back() == ' ') kind.pop_back();
    --i;
  }
  if (kind.ends_with(':')) kind.pop_back();
  return kind;
}

// The outcome of one candidate.
struct Proof {
  bool in_bullet = false, in_mujoco = false;
  double quality = 0.0;
  std::string reason;
};

class GraspProver {
 public:
  GraspProver(const GraspObject& object, const sim::GripperModel& gripper,
              const GraspProofOptions& options, double friction, std::uint64_t seed)
      : options_(options),
        seed_(seed),
        trial_(WithFriction(options.trial, friction)),
        perturbed_(trial_),
        bullet_(TrialsOf(sim::GraspEngine::kBullet, gripper, object,
                         WithMargin(trial_, options.margin_share))),
        mujoco_(TrialsOf(sim::GraspEngine::kMujoco, gripper, object, trial_)) {
    perturbed_.shake = false;
    perturbed_.hold_time = options.perturbed_hold_time;
  }

  // `index`: of the candidate, for its perturbations.
  Proof Prove(const Grasp& grasp, int index) const {
    Proof proof;
    const sim::GraspTrialInput input{grasp.object_from_tool, grasp.opening};
    const sim::GraspTrialResult result = bullet_.Run(input);
    proof.reason = result.reason;
    if (!result.held) return proof;
    proof.quality = QualityOf(grasp, index);
    proof.in_bullet = proof.quality >= options_.least_quality;
    if (!proof.in_bullet) {
      proof.reason = "lost when perturbed";
      return proof;
    }
    proof.in_mujoco = mujoco_.Run(input).held;
    return proof;
  }

 private:
  static sim::GraspTrials TrialsOf(sim::GraspEngine engine, const sim::GripperModel& gripper,
                                   const GraspObject& object,
                                   const sim::GraspTrialOptions& options) {
    if (object.part) return sim::GraspTrials(engine, gripper, *object.part, options);
    return sim::GraspTrials(engine, gripper, object.body, options);
  }

  static sim::GraspTrialOptions WithFriction(sim::GraspTrialOptions trial, double friction) {
    trial.friction = friction;
    return trial;
  }

  static sim::GraspTrialOptions WithMargin(sim::GraspTrialOptions trial, double share) {
    trial.slip_limit *= share;
    trial.turn_limit *= share;
    return trial;
  }

  double QualityOf(const Grasp& grasp, int index) const {
    core::Rng rng =
        core::StreamRng(seed_, kFirstPerturbationStream + static_cast<std::uint64_t>(index));
    int held = 0;
    for (int i = 0; i < options_.perturbations; ++i) {
      Isometry3d tool = grasp.object_from_tool;
      const Vector3d shift = options_.perturbation_distance * core::UniformDirection(rng);
      const Eigen::AngleAxisd turn(options_.perturbation_angle, core::UniformDirection(rng));
      tool.translate(shift);
      tool.rotate(turn);
      if (bullet_.Run({tool, grasp.opening}, perturbed_).held) ++held;
      // The rest cannot reach the least quality.
      const int most = held + options_.perturbations - 1 - i;
      if (most < options_.least_quality * options_.perturbations) break;
    }
    return options_.perturbations > 0 ? static_cast<double>(held) / options_.perturbations : 1.0;
  }

  const GraspProofOptions& options_;
  std::uint64_t seed_;
  sim::GraspTrialOptions trial_, perturbed_;
  sim::GraspTrials bullet_, mujoco_;
};

// Throws if the fingers cannot carry the weight: two contacts of force F hold 2 mu F at most.
void RequireLiftable(const GraspObject& object, const sim::GripperModel& gripper, double friction,
                     double gravity) {
  const double weight = object.body.inertial.mass * gravity;
  const double limit = 2.0 * friction * gripper.force;
  if (weight <= limit) return;
  char text[200];
  std::snprintf(text, sizeof(text),
                "it is too heavy: %.2f kg weigh %.1f N, two fingers of %.0f N hold %.1f N at a "
                "friction coefficient of %.2f",
                object.body.inertial.mass, weight, gripper.force, limit, friction);
  throw core::Error(std::string("no grasp: ") + text, object.name, "use a stronger gripper");
}

// Returns the order in which candidates are tried: diverse ones, those that clear the support and
// the others in turn, so that an object can be grasped where it stands.
std::vector<int> TrialOrder(const std::vector<Grasp>& candidates, int count) {
  std::array<std::vector<int>, 2> orders;
  for (const bool clears : {true, false}) {
    std::vector<Grasp> some;
    std::vector<int> indices;
    for (size_t i = 0; i < candidates.size(); ++i) {
      if (candidates[i].clears_support != clears) continue;
      some.push_back(candidates[i]);
      indices.push_back(static_cast<int>(i));
    }
    for (const int index : FarthestGrasps(some, count)) {
      orders[clears ? 0 : 1].push_back(indices[static_cast<size_t>(index)]);
    }
  }
  std::vector<int> order;
  for (size_t i = 0; i < std::max(orders[0].size(), orders[1].size()); ++i) {
    for (const std::vector<int>& one : orders) {
      if (i < one.size() && static_cast<int>(order.size()) < count) order.push_back(one[i]);
    }
  }
  return order;
}

GraspSampling SampleCandidates(const GraspObject& object, const sim::GripperModel& gripper,
                               GraspSamplerOptions options, std::uint64_t seed) {
  core::Rng rng = core::StreamRng(seed, kSamplerStream);
  GraspSampling sampling = SampleAntipodalGrasps(object, gripper, options, rng);
  if (!object.part || sampling.grasps.size() >= kFewCandidates ||
      options.largest_angle >= kWideAngle) {
    return sampling;
  }
  options.largest_angle = kWideAngle;
  return SampleAntipodalGrasps(object, gripper, options, rng);
}

}  // namespace

bool GraspProofOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* text) {
    if (error != nullptr) *error = text;
    return false;
  };
  if (count < 1 || count > 100000) return fail("count must be 1 to 100000");
  if (tries_per_grasp < 1) return fail("tries_per_grasp must be positive");
  if (perturbations < 0 || perturbations > 1000) return fail("perturbations must be 0 to 1000");
  if (!(perturbation_distance >= 0.0) || !(perturbation_angle >= 0.0)) {
    return fail("a perturbation must not be negative");
  }
  if (!(margin_share > 0.0) || margin_share > 1.0) return fail("margin_share must be 0 to 1");
  if (!(least_quality >= 0.0) || least_quality > 1.0) return fail("least_quality must be 0 to 1");
  if (!(perturbed_hold_time >= 0.0)) return fail("perturbed_hold_time must not be negative");
  return sampler.IsValid(error) && trial.IsValid(error);
}

std::string ProvedGrasps::WhyNone(const sim::GripperModel& gripper) const {
  if (!grasps.empty()) return "";
  if (sampling.grasps.empty()) return sampling.WhyNone(gripper);
  std::string most = held_in_bullet > 0 ? "some hold in Bullet alone" : "none held";
  int count = 0;
  for (const auto& [reason, times] : failures) {
    if (held_in_bullet > 0 || times <= count) continue;
    count = times;
    most = "most often: " + reason;
  }
  return "none of " + std::to_string(tried) + " candidates holds in both engines; " + most;
}

double ProvedGrasps::EngineAgreement() const {
  return held_in_bullet > 0 ? static_cast<double>(held_in_both) / held_in_bullet : 0.0;
}

ProvedGrasps ProveGrasps(const GraspObject& object, const sim::GripperModel& gripper,
                         const GraspProofOptions& options, std::uint64_t seed,
                         core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("grasps: " + error);
  ProvedGrasps result;
  result.friction = object.friction * gripper.friction;
  if (!object.part) RequireLiftable(object, gripper, result.friction, options.trial.gravity);
  result.sampling = SampleCandidates(object, gripper, options.sampler, seed);
  if (result.sampling.grasps.empty()) {
    if (object.part) return result;
    throw core::Error("no grasp: " + result.sampling.WhyNone(gripper), object.name,
                      "use another gripper");
  }
  const std::vector<Grasp>& candidates = result.sampling.grasps;
  const std::vector<int> order = TrialOrder(candidates, options.count * options.tries_per_grasp);
  const GraspProver prover(object, gripper, options, result.friction, seed);
  if (progress != nullptr) progress->Stage("grasps of " + object.name, options.count);
  for (size_t first = 0; first < order.size(); first += kBatch) {
    const size_t size = std::min<size_t>(kBatch, order.size() - first);
    std::vector<Proof> proofs(size);
    core::ParallelFor(static_cast<int>(size), [&](int i) {
      const int candidate = order[first + static_cast<size_t>(i)];
      proofs[static_cast<size_t>(i)] =
          prover.Prove(candidates[static_cast<size_t>(candidate)], candidate);
    });
    for (size_t i = 0; i < size; ++i) {
      const Proof& proof = proofs[i];
      ++result.tried;
      if (!proof.in_bullet) ++result.failures[KindOf(proof.reason)];
      result.held_in_bullet += proof.in_bullet ? 1 : 0;
      result.held_in_both += proof.in_mujoco ? 1 : 0;
      if (!proof.in_mujoco || static_cast<int>(result.grasps.size()) >= options.count) continue;
      Grasp grasp = candidates[static_cast<size_t>(order[first + i])];
      grasp.quality = proof.quality;
      result.grasps.push_back(grasp);
      if (progress != nullptr) progress->Advance();
    }
    if (static_cast<int>(result.grasps.size()) >= options.count) break;
  }
  if (progress != nullptr) progress->Finish();
  result.coverage = GraspCoverage(candidates, result.grasps);
  std::stable_sort(result.grasps.begin(), result.grasps.end(),
                   [](const Grasp& a, const Grasp& b) { return a.quality > b.quality; });
  return result;
}

}  // namespace simwright::manipulation
