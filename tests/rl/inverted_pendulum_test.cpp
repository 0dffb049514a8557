// A known task in Bullet: the pole is balanced.
#include "tests/rl/inverted_pendulum.h"

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "rl/ppo.h"
#include "tests/sanitized.h"

namespace simwright::rl {
namespace {

// An unforced pole that leans by a falls with a'' = m g l a / I, faster because the cart recoils:
// the linearized equations of cart and pole (Barto, Sutton and Anderson 1983, without friction)
// have one growing solution, e^(k t).
TEST(InvertedPendulum, FallsAsTheEquationsOfMotionSay) {
  InvertedPendulum environment(1);
  Rows observations;
  environment.Reset(4, &observations);
  StepBatch batch;
  const Rows none = Rows::Zero(1, 1);
  // The damped, linearized equations: [x, a, x', a']' = A [x, a, x', a'].
  const double cart = 10.472, pole = 5.0186, l = 0.3, g = 9.81, inertia = 0.18875 + pole * l * l;
  const Eigen::Matrix2d mass{{cart + pole, pole * l}, {pole * l, inertia}};
  const Eigen::Matrix2d lean{{0.0, 0.0}, {0.0, pole * g * l}};
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a.topRightCorner<2, 2>().setIdentity();
  a.bottomLeftCorner<2, 2>() = mass.inverse() * lean;
  a.bottomRightCorner<2, 2>() = -mass.inverse();  // damping 1 on both joints
  Eigen::Vector4d state = observations.row(0).cast<double>().transpose();
  for (int step = 0; step < 20; ++step) {
    environment.Step(none, &batch);
    ASSERT_EQ(batch.terminated[0], 0);
    for (int i = 0; i < 4000; ++i) state += 1e-5 * (a * state);
    // Bullet's step of 0.02 s is of first order.
    EXPECT_NEAR(batch.observations(0, 1), state[1], 0.02 * std::abs(state[1]) + 2e-4) << step;
  }
  EXPECT_GT(std::abs(state[1]), 3.0 * std::abs(observations(0, 1)));
}

TEST(Ppo, KeepsAPoleUpright) {
  SKIP_UNDER_SANITIZERS();
  core::SetThreadCount(2);
  InvertedPendulum environment(16);
  PpoOptions options;
  options.hidden = {64, 64};
  options.horizon = 128;
  options.minibatch = 512;
  Ppo ppo(&environment, options);
  std::vector<Outcome> outcomes;
  while (ppo.samples() < 50000) {
    ppo.Collect(&outcomes);
    ppo.Update();
  }
  const Policy policy = ppo.CurrentPolicy();
  const double mean = MeanStepsUpright(
      20, 7, [&](const Rows& observations, Rows* actions) { policy.Act(observations, actions); });
  EXPECT_GE(mean, 950.0);
  core::SetThreadCount(0);
}

}  // namespace
}  // namespace simwright::rl
