// Experiments with one free body against closed forms, in both engines.
#include "sim/body_experiments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::sim {
namespace {

constexpr double kGravity = 9.81;

RigidBody Box(const Eigen::Vector3d& size, double mass, double friction) {
  RigidBody body;
  body.name = "box";
  body.parts = {assets::BoxMesh(size)};
  body.inertial.mass = mass;
  const Eigen::Vector3d squares = size.cwiseAbs2();
  body.inertial.inertia =
      (mass / 12.0 * (Eigen::Vector3d::Constant(squares.sum()) - squares)).asDiagonal();
  body.friction = friction;
  return body;
}

// The body as an MJCF file of its own, as exported assets are: meshes of the parts.
std::string Mjcf(const RigidBody& body) {
  std::ostringstream out;
  out.precision(17);
  out << "<mujoco><asset><mesh name=\"part\" vertex=\"";
  for (const Eigen::Vector3d& v : body.parts[0].vertices) out << v.transpose() << ' ';
  const Eigen::Vector3d moments = body.inertial.inertia.diagonal();
  out << "\"/></asset><worldbody><body name=\"box\"><freejoint/><inertial pos=\"0 0 0\" mass=\""
      << body.inertial.mass << "\" diaginertia=\"" << moments.transpose()
      << "\"/><geom type=\"mesh\" mesh=\"part\" condim=\"4\" solref=\"0.005 1\" friction=\""
      << body.friction << " 1e-4 1e-4\"/></body></worldbody></mujoco>";
  return out.str();
}

struct Engine {
  const char* name;
  bool mujoco;
};

class BodyExperiment : public ::testing::TestWithParam<Engine> {
 protected:
  BodyRigFactory Rigs(const RigidBody& body) {
    if (!GetParam().mujoco) {
      return [body](const Eigen::Isometry3d& pose, const std::vector<RigBox>& boxes) {
        return BulletBodyRig(body, pose, boxes);
      };
    }
    const auto file = folder_.path() / "box.xml";
    core::WriteFile(file, Mjcf(body));
    return [body, file](const Eigen::Isometry3d& pose, const std::vector<RigBox>& boxes) {
      return MujocoBodyRig(file, body, pose, boxes);
    };
  }
  const core::TemporaryFolder folder_;
};

Eigen::Isometry3d At(double z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = z;
  return pose;
}

TEST_P(BodyExperiment, ABoxStaysBelowItsFrictionAngleAndSlidesAsCoulombSays) {
  const RigidBody body = Box({0.1, 0.1, 0.04}, 0.3, 0.4);
  SlopeOptions options;
  options.angle = 0.8 * std::atan(0.4);
  EXPECT_LT(StandOnSlope(body, At(0.02), options, Rigs(body)).displacement, 1e-3);
  options.angle = 1.4 * std::atan(0.4);
  const SlopeResult slide = StandOnSlope(body, At(0.02), options, Rigs(body));
  const double exact = kGravity * (std::sin(options.angle) - 0.4 * std::cos(options.angle));
  EXPECT_NEAR(slide.acceleration, exact, 0.1 * exact);
  EXPECT_LT(slide.tilt, 0.02);
}

TEST_P(BodyExperiment, ATallBoxTipsBeyondItsTippingAngle) {
  const RigidBody body = Box({0.04, 0.04, 0.12}, 0.3, 0.9);
  const double tipping = std::atan(0.04 / 0.12);
  SlopeOptions options;
  options.direction = 0.5 * M_PI;
  options.angle = 0.8 * tipping;
  EXPECT_LT(StandOnSlope(body, At(0.06), options, Rigs(body)).tilt, 0.01);
  options.angle = 1.2 * tipping;
  EXPECT_GT(StandOnSlope(body, At(0.06), options, Rigs(body)).tilt, 0.2);
}

TEST_P(BodyExperiment, AStackStaysAndAnOverhangFalls) {
  const RigidBody body = Box({0.1, 0.1, 0.05}, 0.4, 0.5);
  RigBox crate{{0.2, 0.2, 0.1}, 1.0, At(0.05)};
  RigBox plate{{0.08, 0.08, 0.01}, 0.2, At(0.155)};
  const StackResult stack = StandInStack(body, At(0.125), {crate, plate}, 1.0, Rigs(body));
  ASSERT_EQ(stack.displacements.size(), 3u);
  for (const double displacement : stack.displacements) EXPECT_LT(displacement, 1e-3);
  EXPECT_LT(stack.penetration, 1e-3);
  EXPECT_LT(stack.settling, 1e-3);
  Eigen::Isometry3d beside = At(0.125);
  beside.translation().x() = 0.11;  // its centre is a centimetre beyond the crate's edge
  EXPECT_GT(StandInStack(body, beside, {crate}, 1.0, Rigs(body)).settling, 0.05);
}

TEST_P(BodyExperiment, ADropRestsAsHighAsTheBody) {
  const RigidBody body = Box({0.1, 0.08, 0.06}, 0.4, 0.5);
  DropOptions options;
  options.height = 0.1;
  options.settle_time = 3.0;
  const DropResult drop = DropBody(body, options, Rigs(body));
  EXPECT_TRUE(drop.rests);
  EXPECT_NEAR(drop.final_pose.translation().z(), 0.03, 1e-3);
  EXPECT_LT(drop.tilt, 0.02);
}

TEST_P(BodyExperiment, InvalidSlopesAreRefused) {
  const RigidBody body = Box({0.1, 0.1, 0.04}, 0.3, 0.4);
  SlopeOptions options;
  options.angle = 2.0;
  EXPECT_THROW(StandOnSlope(body, At(0.02), options, Rigs(body)), core::Error);
  options.angle = 0.1;
  options.watch = 0.0;
  EXPECT_THROW(StandOnSlope(body, At(0.02), options, Rigs(body)), core::Error);
}

INSTANTIATE_TEST_SUITE_P(Engines, BodyExperiment,
                         ::testing::Values(Engine{"Bullet", false}, Engine{"MuJoCo", true}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace simwright::sim
