// The initiation set of a skill, estimated from examples with a known truth.
#include "rl/initiation_set.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "skills/next_skill.h"
#include "skills/skill_environment.h"
#include "tests/skills/skill_scene.h"

namespace simwright::skills {
namespace {

// Start states of four numbers: the third is irrelevant, the last constant.
struct Tried {
  rl::Rows observations;
  std::vector<bool> succeeded;
};

double Truth(float a, float b) {
  return 1.0 / (1.0 + std::exp(-(2.0 * a - 3.0 * b + 0.5)));
}

Tried Draw(int count, core::Rng& rng) {
  Tried tried;
  tried.observations.resize(count, 4);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < 3; ++j) tried.observations(i, j) = static_cast<float>(core::Normal(rng));
    tried.observations(i, 3) = 7.0f;
    const double chance = Truth(tried.observations(i, 0), tried.observations(i, 1));
    tried.succeeded.push_back(core::Uniform(rng) < chance);
  }
  return tried;
}

TEST(InitiationSet, FindsTheChancesThatStartsWereDrawnWith) {
  core::Rng rng(4);
  const Tried tried = Draw(20000, rng);
  const rl::InitiationSet set(tried.observations, tried.succeeded);
  const Tried others = Draw(500, rng);
  double off = 0.0;
  for (int i = 0; i < 500; ++i) {
    const float* row = others.observations.row(i).data();
    off = std::max(off, std::abs(set.SuccessProbability(row) - Truth(row[0], row[1])));
  }
  EXPECT_LT(off, 0.03);  // 20000 examples give a weight to 0.03, a probability to a quarter of that
}

TEST(InitiationSet, StartsThatCanBeToldApartAreAndStayFinite) {
  rl::Rows observations(40, 1);
  std::vector<bool> succeeded;
  for (int i = 0; i < 40; ++i) {
    observations(i, 0) = i < 20 ? -1.0f : 1.0f;
    succeeded.push_back(i >= 20);
  }
  const rl::InitiationSet set(observations, succeeded);
  const float bad = -1.0f, good = 1.0f;
  EXPECT_LT(set.SuccessProbability(&bad), 0.1);
  EXPECT_GT(set.SuccessProbability(&bad), 0.0);
  EXPECT_GT(set.SuccessProbability(&good), 0.9);
  EXPECT_LT(set.SuccessProbability(&good), 1.0);
  const std::vector<bool> always(40, true);
  EXPECT_GT(rl::InitiationSet(observations, always).SuccessProbability(&bad), 0.9);
  EXPECT_THROW(rl::InitiationSet(rl::Rows(0, 1), {}), core::Error);
  EXPECT_THROW(rl::InitiationSet(observations, {true}), core::Error);
}

// A cup where it was seen to be picked up successfully is worth more than elsewhere.
TEST(NextSkill, EndsAreWorthWhatWasSeenFromTheirLike) {
  const auto skill = MakeSkill(robot::Panda(false), {PickUpCup()}, SkillOptions().ForEvaluation());
  std::vector<EvaluatedEpisode> tried;
  for (const StartState& start : SampleStarts(*skill, 480, 6)) {
    EvaluatedEpisode episode;
    episode.start = start;
    episode.success = start.state.roots[0].translation().y() > 0.0;  // as if the left was easy
    tried.push_back(episode);
  }
  const NextSkill successor(skill, tried);
  int right = 0;
  for (const StartState& end : SampleStarts(*skill, 60, 7)) {
    const bool easy = end.state.roots[0].translation().y() > 0.0;
    right += (successor.SuccessProbability(end) > 0.5) == easy;
  }
  EXPECT_GE(right, 48);  // 30 by chance
}

// The share of an end state scales only the reward of the success that ends an episode.
TEST(SkillEnvironment, PaysEndsTheirShare) {
  SkillSubtask scene = PickUpCup();
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    thing = env.get_position(\"cup\")\n"
      "    return 0.0 * thing[:, 0] + 1.0, thing[:, 2] > -1.0\n";  // done from the start
  SkillOptions options = SkillOptions().ForEvaluation();
  const auto skill = MakeSkill(robot::Panda(false), {scene}, options);
  for (const double share : {1.0, 0.25}) {
    SkillEnvironment environment(skill, 1);
    environment.ScaleTerminalRewards([&](const StartState&) { return share; });
    rl::Rows observations;
    environment.Reset(3, &observations);
    rl::StepBatch batch;
    const rl::Rows action = rl::Rows::Zero(1, environment.action_size());
    do {
      environment.Step(action, &batch);
      const double whole = 2.0;  // the program's and the bonus
      const double expected =
          batch.terminated[0] ? share * whole / (1.0 - options.discount) : whole;
      EXPECT_NEAR(batch.rewards[0], expected, 1e-4 * expected);
    } while (!batch.terminated[0]);
  }
}

}  // namespace
}  // namespace simwright::skills
