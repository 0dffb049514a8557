#include "tests/rl/inverted_pendulum.h"

#include <algorithm>
#include <cmath>

#include "assets/urdf_reader.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"

namespace simwright::rl {
namespace {

constexpr int kSlider = 0, kHinge = 1;
constexpr double kTimeStep = 0.02, kStrongest = 300.0, kFurthest = 0.2;  // s, N, rad

// Masses and inertias of the original's capsules (radius 0.1 m and length 0.2 m between the caps'
// centres, 0.049 m and 0.6 m) at 1000 kg/m^3.
constexpr char kUrdf[] = R"(<robot name="inverted_pendulum">
  <link name="rail"/>
  <link name="cart"><inertial><mass value="10.472"/>
    <inertia ixx="0.0966" iyy="0.0482" izz="0.0966" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="pole"><inertial><origin xyz="0 0 0.3"/><mass value="5.0186"/>
    <inertia ixx="0.18875" iyy="0.18875" izz="0.0059065" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slider" type="prismatic"><parent link="rail"/><child link="cart"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="300" velocity="100"/>
    <dynamics damping="1"/></joint>
  <joint name="hinge" type="revolute"><parent link="cart"/><child link="pole"/>
    <axis xyz="0 1 0"/><limit lower="-1.5708" upper="1.5708" effort="0" velocity="100"/>
    <dynamics damping="1"/></joint>
</robot>)";

sim::ArticulatedBody ReadBody() {
  const core::TemporaryFolder folder;
  core::WriteFile(folder.path() / "pendulum.urdf", kUrdf);
  return sim::ArticulatedBodyFrom(assets::ReadUrdf(folder.path() / "pendulum.urdf"));
}

}  // namespace

InvertedPendulum::InvertedPendulum(int count)
    : body_(ReadBody()), carts_(static_cast<std::size_t>(count)) {}

void InvertedPendulum::Start(Cart* cart) const {
  sim::WorldOptions options;
  options.time_step = kTimeStep;
  cart->world = std::make_unique<sim::ArticulatedWorld>(options);
  sim::Placement placement;
  placement.world_from_root.translation().z() = 2.0;
  cart->world->Add(body_, placement);
  cart->world->SetPosition(0, kSlider, core::Uniform(cart->rng, -0.01, 0.01));
  cart->world->SetPosition(0, kHinge, core::Uniform(cart->rng, -0.01, 0.01));
  cart->steps = 0;
}

Eigen::RowVectorXf InvertedPendulum::Observe(const Cart& cart) const {
  const sim::ArticulatedWorld& world = *cart.world;
  return Eigen::RowVector4d(world.Position(0, kSlider), world.Position(0, kHinge),
                            world.Velocity(0, kSlider), world.Velocity(0, kHinge))
      .cast<float>();
}

void InvertedPendulum::Reset(std::uint64_t seed, Rows* observations) {
  observations->resize(size(), 4);
  for (std::size_t i = 0; i < carts_.size(); ++i) {
    carts_[i].rng = core::StreamRng(seed, i);
    Start(&carts_[i]);
    observations->row(static_cast<Eigen::Index>(i)) = Observe(carts_[i]);
  }
}

void InvertedPendulum::Step(const Rows& actions, StepBatch* batch) {
  batch->observations.resize(size(), 4);
  batch->last_observations.resize(size(), 4);
  batch->rewards.assign(carts_.size(), 1.0f);
  batch->terminated.assign(carts_.size(), 0);
  batch->truncated.assign(carts_.size(), 0);
  batch->success.assign(carts_.size(), 0);
  core::ParallelFor(size(), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    Cart& cart = carts_[at];
    const double force = kStrongest * std::clamp(static_cast<double>(actions(i, 0)), -1.0, 1.0);
    for (int frame = 0; frame < 2; ++frame) {
      cart.world->Push(0, kSlider, force);
      cart.world->Step();
    }
    ++cart.steps;
    batch->terminated[at] = std::abs(cart.world->Position(0, kHinge)) > kFurthest;
    batch->truncated[at] = !batch->terminated[at] && cart.steps >= kLongest;
    if (batch->terminated[at] || batch->truncated[at]) {
      batch->last_observations.row(i) = Observe(cart);
      batch->success[at] = batch->truncated[at];
      Start(&cart);
    }
    batch->observations.row(i) = Observe(cart);
  });
}

std::string InvertedPendulum::SaveState() const {
  throw core::Error("cannot be saved", "inverted pendulum");
}

void InvertedPendulum::RestoreState(std::string_view, Rows*) {
  throw core::Error("cannot be restored", "inverted pendulum");
}

double MeanStepsUpright(int count, std::uint64_t seed,
                        const std::function<void(const Rows& observations, Rows* actions)>& act) {
  InvertedPendulum environment(count);
  Rows observations, actions;
  environment.Reset(seed, &observations);
  StepBatch batch;
  std::vector<int> lasted(static_cast<std::size_t>(count), 0);
  for (int step = 1; step <= InvertedPendulum::kLongest; ++step) {
    act(observations, &actions);
    environment.Step(actions, &batch);
    for (std::size_t i = 0; i < lasted.size(); ++i) {
      if (lasted[i] == 0 && (batch.terminated[i] || batch.truncated[i])) lasted[i] = step;
    }
    observations = batch.observations;
  }
  double sum = 0.0;
  for (const int steps : lasted) sum += steps;
  return sum / count;
}

}  // namespace simwright::rl
