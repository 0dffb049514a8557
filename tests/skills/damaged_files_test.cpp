// Damaged files of a training are refused in one line, or read as valid data; never a crash, and
// never non-finite numbers. Under the sanitizers too.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "rl/policy_file.h"
#include "skills/skill_evaluation.h"
#include "skills/start_pool.h"
#include "tests/skills/skill_scene.h"

namespace simwright::skills {
namespace {

// Returns `text` with one to four random edits: changed, cut, duplicated or renumbered pieces.
std::string Damaged(const std::string& text, core::Rng& rng) {
  static const std::vector<std::string> pieces = {
      "-1", "1e308", "1e999", "null", "[]", "{}", "\"x\"", "0", "4294967296", ",", "true", "\xff"};
  std::string damaged = text;
  const auto count = 1 + core::UniformIndex(rng, 4);
  for (std::int64_t i = 0; i < count && !damaged.empty(); ++i) {
    const auto size = static_cast<std::int64_t>(damaged.size());
    const auto at = static_cast<size_t>(core::UniformIndex(rng, size));
    const auto length = static_cast<size_t>(core::UniformIndex(rng, 12));
    switch (core::UniformIndex(rng, 5)) {
      case 0:
        damaged[at] = static_cast<char>(core::UniformIndex(rng, 256));
        break;
      case 1:
        damaged.erase(at, length);
        break;
      case 2:
        damaged.insert(at, damaged.substr(at, length));
        break;
      case 3:
        damaged.resize(at);
        break;
      default: {
        const auto piece = core::UniformIndex(rng, static_cast<std::int64_t>(pieces.size()));
        damaged.replace(at, length, pieces[static_cast<size_t>(piece)]);
      }
    }
  }
  return damaged;
}

TEST(DamagedFiles, AStartIsRefusedOrCanBeBegun) {
  const auto skill = MakeSkill(robot::Panda(false), {PickUpCup()}, SkillOptions().ForEvaluation());
  const std::string text = StartText(SampleStarts(*skill, 1, 3).front());
  core::Rng rng(1);
  Episode episode(*skill);
  int read = 0, refused = 0;
  for (int i = 0; i < 4000; ++i) {
    try {
      const StartState start = ParseStart(Damaged(text, rng), *skill, "ends.jsonl:1");
      if (++read % 20 != 1) continue;
      episode.Begin(start);
      const float action[7] = {};
      EXPECT_TRUE(std::isfinite(episode.Step(action).reward));
    } catch (const core::Error& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("ends.jsonl:1"), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(read, 100);  // one digit more or less is another valid start state
  EXPECT_GT(refused, 1000);
}

TEST(DamagedFiles, APolicyIsRefusedOrActsWithinItsRange) {
  const core::TemporaryFolder folder;
  const auto path = folder.path() / "policy.pt";
  core::Rng rng(2);
  const std::vector<rl::Mlp::Layer> layers = {
      {Eigen::MatrixXf::Random(5, 8), Eigen::RowVectorXf::Random(8)},
      {Eigen::MatrixXf::Random(8, 2), Eigen::RowVectorXf::Random(2)}};
  const rl::ObservationScale scale(Eigen::RowVectorXf::Zero(5), Eigen::RowVectorXf::Ones(5));
  rl::WritePolicy(
      rl::Policy(scale, rl::Mlp(layers, rl::Activation::kElu), Eigen::RowVectorXf::Ones(2)), path);
  const std::string bytes = core::ReadFile(path);
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    core::WriteFile(path, Damaged(bytes, rng));
    try {
      const rl::Policy policy = rl::ReadPolicy(path);
      rl::Rows actions;
      policy.Act(rl::Rows::Ones(1, policy.observation_size()), &actions);
      EXPECT_TRUE((actions.array().abs() <= 1.0f).all());
    } catch (const core::Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace simwright::skills
