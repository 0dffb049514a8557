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
// The smallest change of the reward over a segment, as a share of its change over the whole path,
// for which the segment counts.
constexpr double kMinChange = 0.03;
constexpr std::size_t kMinStates = 3;  // states
constexpr double kRewardStep = 0.2;    // share of the whole change, between two states

double Range(std::span<const double> values) {
  if (values.empty()) return 0.0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

double Agreement(std::span<const double> reward) {
  std::vector<double> progress(reward.size());
  for (std::size_t i = 0; i < progress.size(); ++i) progress[i] = static_cast<double>(i);
  return RankCorrelation(reward, progress, 1e-6 * Range(reward));
}

// Returns the ends of a path's segments: the end of the approach, the start of turning over, and
// each step of the reward (a bonus), which would outweigh all changes between two steps.
std::vector<std::size_t> SegmentEnds(const Motion& motion, std::span<const double> reward,
                                     double range_of_reward) {
  std::vector<std::size_t> ends;
  const auto kind = [&](std::size_t i) {
    const MotionPhase phase = motion.phases[i];
    return phase == MotionPhase::kRelease ? MotionPhase::kMove : phase;
  };
  for (std::size_t i = 1; i < reward.size(); ++i) {
    const bool step = std::abs(reward[i] - reward[i - 1]) > kRewardStep * range_of_reward;
    if (step || kind(i) != kind(i - 1)) ends.push_back(i);
  }
  ends.push_back(reward.size());
  return ends;
}

// Computes the agreement of `path`.
void ComputeAgreement(const std::vector<float>& rewards, SuccessPath* path) {
  const std::vector<double> values(rewards.begin(),
                                   rewards.begin() + static_cast<std::ptrdiff_t>(path->first) + 1);
  const std::span<const double> reward(values);
  const double range_of_reward = Range(reward);
  path->agreement = Agreement(reward);
  std::size_t begin = 0;
  for (std::size_t end : SegmentEnds(path->motion, reward, range_of_reward)) {
    const std::span<const double> segment = reward.subspan(begin, end - begin);
    begin = end;
    if (segment.size() < kMinStates || Range(segment) < kMinChange * range_of_reward) continue;
    path->agreement = std::min(path->agreement, Agreement(segment));
  }
}

bool IsReachable(const Motion& motion, std::size_t first, const Eigen::Isometry3d& robot) {
  constexpr std::size_t kSamples = 5;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const std::size_t at = first - i * first / (2 * kSamples);
    if (!IsPointReachable(robot, motion.states[at].gripper.translation())) return false;
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

std::optional<SuccessPath> FindSuccessPath(const reward::RewardProgram& program,
                                           const WorldModel& model, const WorldState& start,
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
    ComputeAgreement(trial.reward, &path);
    if (best && best->reachable && path.agreement <= best->agreement) continue;
    path.reachable = IsReachable(path.motion, path.first, world_from_robot);
    const bool better = !best || std::make_pair(path.reachable, path.agreement) >
                                     std::make_pair(best->reachable, best->agreement);
    if (better) best = std::move(path);
    if (stop_early && best->reachable && best->agreement >= kGoodEnough) break;
  }
  return best;
}

}  // namespace simwright::tasks
