#include "tasks/verification/path_search.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/progress.h"
#include "tasks/layout.h"
#include "tasks/verification/program_trial.h"
#include "tasks/verification/rank_correlation.h"

namespace simwright::tasks {
namespace {

constexpr double kGoodEnough = 0.5;
// A part of the way counts where the reward changes by this share of its change over the whole.
constexpr double kChanges = 0.03;
constexpr std::size_t kShortest = 3;  // states
constexpr double kStep = 0.2;         // of the whole change, between two states

double Spread(std::span<const double> values) {
  if (values.empty()) return 0.0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

double Agreement(std::span<const double> reward) {
  std::vector<double> progress(reward.size());
  for (std::size_t i = 0; i < progress.size(); ++i) progress[i] = static_cast<double>(i);
  return RankCorrelation(reward, progress, 1e-6 * Spread(reward));
}

// Where the parts of a way end: at the hand's arrival, where it starts to turn things over, and
// behind a step of the reward (a bonus), which would outweigh all that happens between two of them.
std::vector<std::size_t> PartEnds(const Motion& motion, std::span<const double> reward,
                                  double spread) {
  std::vector<std::size_t> ends;
  const auto kind = [&](std::size_t i) {
    const MotionPhase phase = motion.phases[i];
    return phase == MotionPhase::kRelease ? MotionPhase::kMove : phase;
  };
  for (std::size_t i = 1; i < reward.size(); ++i) {
    const bool step = std::abs(reward[i] - reward[i - 1]) > kStep * spread;
    if (step || kind(i) != kind(i - 1)) ends.push_back(i);
  }
  ends.push_back(reward.size());
  return ends;
}

// Fills agreement.
void Judge(const std::vector<float>& rewards, SuccessPath* path) {
  const std::vector<double> values(rewards.begin(),
                                   rewards.begin() + static_cast<std::ptrdiff_t>(path->first) + 1);
  const std::span<const double> reward(values);
  const double spread = Spread(reward);
  path->agreement = Agreement(reward);
  std::size_t begin = 0;
  for (std::size_t end : PartEnds(path->motion, reward, spread)) {
    const std::span<const double> part = reward.subspan(begin, end - begin);
    begin = end;
    if (part.size() < kShortest || Spread(part) < kChanges * spread) continue;
    path->agreement = std::min(path->agreement, Agreement(part));
  }
}

bool WithinReach(const Motion& motion, std::size_t first, const Eigen::Isometry3d& robot) {
  constexpr std::size_t kSamples = 5;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const std::size_t at = first - i * first / (2 * kSamples);
    if (!Reaches(robot, motion.states[at].gripper.translation())) return false;
  }
  return true;
}

}  // namespace

void RewardRange::Add(float reward, bool success) {
  finite = finite && std::isfinite(reward);
  lowest = any ? std::min<double>(lowest, reward) : reward;
  highest = any ? std::max<double>(highest, reward) : reward;
  any = true;
  always_success = always_success && success;
  ever_success = ever_success || success;
}

std::optional<SuccessPath> FindSuccessPath(const RewardProgram& program, const SceneModel& model,
                                           const SceneState& start,
                                           const Eigen::Isometry3d& world_from_robot,
                                           const std::vector<std::vector<Action>>& sequences,
                                           bool stop_early, RewardRange* range) {
  std::optional<SuccessPath> best;
  for (const std::vector<Action>& sequence : sequences) {
    core::CheckCancelled();
    SuccessPath path;
    path.motion = MakeMotion(model, start, sequence);
    const TrialResult trial = RunOnStates(program, model, path.motion.states, true);
    for (std::size_t i = 0; range != nullptr && i < trial.reward.size(); ++i) {
      range->Add(trial.reward[i], trial.success[i] != 0);
    }
    const auto success = std::find(trial.success.begin(), trial.success.end(), 1);
    if (success == trial.success.end()) continue;
    path.first = static_cast<std::size_t>(success - trial.success.begin());
    if (path.first == 0) continue;
    Judge(trial.reward, &path);
    if (best && best->reachable && path.agreement <= best->agreement) continue;
    path.reachable = WithinReach(path.motion, path.first, world_from_robot);
    const bool better = !best || std::make_pair(path.reachable, path.agreement) >
                                     std::make_pair(best->reachable, best->agreement);
    if (better) best = std::move(path);
    if (stop_early && best->reachable && best->agreement >= kGoodEnough) break;
  }
  return best;
}

}  // namespace simwright::tasks
