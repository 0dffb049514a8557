// TreeDynamics against Bullet's articulated-body algorithm and closed forms.
#include "sim/tree_dynamics.h"

#include <cmath>

#include <gtest/gtest.h>

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include "core/random.h"

namespace simwright::sim {
namespace {

btVector3 RandomVector(core::Rng& rng, double scale) {
  return {scale * core::Normal(rng), scale * core::Normal(rng), scale * core::Normal(rng)};
}

btQuaternion RandomTurn(core::Rng& rng) {
  btQuaternion turn(core::Normal(rng), core::Normal(rng), core::Normal(rng), core::Normal(rng));
  return turn.normalize();
}

// A random branching tree of revolute, prismatic and fixed joints, in a random state.
std::unique_ptr<btMultiBody> RandomTree(core::Rng& rng, int links, bool fixed) {
  const auto inertia = [&] {
    return btVector3(0.011, 0.012, 0.013) * core::Uniform(rng, 0.5, 2.0);
  };
  auto body = std::make_unique<btMultiBody>(links, 2.0, inertia(), fixed, false);
  for (int i = 0; i < links; ++i) {
    const int parent = i == 0 ? -1 : static_cast<int>(core::UniformIndex(rng, i + 1)) - 1;
    const btVector3 axis = RandomVector(rng, 1.0).normalized();
    const btVector3 to_pivot = RandomVector(rng, 0.3), to_center = RandomVector(rng, 0.2);
    const double mass = core::Uniform(rng, 0.5, 2.0);
    if (i % 4 == 3) {
      body->setupFixed(i, mass, inertia(), parent, RandomTurn(rng), to_pivot, to_center);
    } else if (i % 4 == 1) {
      body->setupPrismatic(i, mass, inertia(), parent, RandomTurn(rng), axis, to_pivot, to_center,
                           false);
    } else {
      body->setupRevolute(i, mass, inertia(), parent, RandomTurn(rng), axis, to_pivot, to_center,
                          false);
    }
  }
  body->finalizeMultiDof();
  body->setLinearDamping(0.0);
  body->setAngularDamping(0.0);
  btTransform pose(RandomTurn(rng), RandomVector(rng, 1.0));
  body->setBaseWorldTransform(pose);
  if (!fixed) {
    body->setBaseVel(RandomVector(rng, 1.0));
    body->setBaseOmega(RandomVector(rng, 1.0));
  }
  for (int i = 0; i < links; ++i) {
    if (body->getLink(i).m_dofCount == 0) continue;
    body->setJointPos(i, core::Normal(rng));
    body->setJointVel(i, core::Normal(rng));
    body->addJointTorque(i, core::Normal(rng));
  }
  return body;
}

struct BulletScratch {
  btAlignedObjectArray<btScalar> r;
  btAlignedObjectArray<btVector3> v;
  btAlignedObjectArray<btMatrix3x3> m;
};

constexpr double kStep = 1.0 / 240.0;

class TreeDynamicsTest : public testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  TreeDynamicsTest()
      : rng_(static_cast<core::Rng::result_type>(17 + std::get<0>(GetParam()))),
        body_(RandomTree(rng_, std::get<0>(GetParam()), std::get<1>(GetParam()))),
        offset_(body_->hasFixedBase() ? 6 : 0) {}

  core::Rng rng_;
  std::unique_ptr<btMultiBody> body_;
  int offset_;  // of the coordinates in Bullet's vectors
  BulletScratch scratch_;
};

// The response to the unit impulse of each coordinate, and to an impulse at a point of each link,
// equals Bullet's.
TEST_P(TreeDynamicsTest, RespondsAsBulletDoes) {
  TreeDynamics dynamics(body_.get());
  dynamics.UpdatePoses();
  dynamics.UpdateInverseInertia();
  body_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(0.0, scratch_.r, scratch_.v,
                                                              scratch_.m, false, false, false);
  const int n = dynamics.size(), numbers = 6 + body_->getNumDofs();
  std::vector<double> force(static_cast<size_t>(numbers)), response(force);
  for (int i = 0; i < n; ++i) {
    std::fill(force.begin(), force.end(), 0.0);
    force[static_cast<size_t>(offset_ + i)] = 1.0;
    body_->calcAccelerationDeltasMultiDof(force.data(), response.data(), scratch_.r, scratch_.v);
    for (int j = 0; j < n; ++j) {
      const double expected = response[static_cast<size_t>(offset_ + j)];
      ASSERT_NEAR(dynamics.InverseInertia(i)[j], expected, 1e-10 * std::max(1.0, expected));
    }
  }
  std::vector<double> row(static_cast<size_t>(dynamics.stride())), answer(row);
  for (int link = -1; link < body_->getNumLinks(); ++link) {
    const btVector3 point = RandomVector(rng_, 1.0), direction = RandomVector(rng_, 1.0);
    body_->fillConstraintJacobianMultiDof(link, point, btVector3(0, 0, 0), direction, force.data(),
                                          scratch_.r, scratch_.v, scratch_.m);
    body_->calcAccelerationDeltasMultiDof(force.data(), response.data(), scratch_.r, scratch_.v);
    std::fill(row.begin(), row.end(), 0.0);
    std::fill(answer.begin(), answer.end(), 0.0);
    const Span span =
        dynamics.Jacobian(link, {point.x(), point.y(), point.z()},
                          {direction.x(), direction.y(), direction.z()}, {0, 0, 0}, row.data());
    dynamics.Respond(link, row.data(), span, answer.data());
    for (int j = 0; j < n; ++j) {
      ASSERT_NEAR(row[static_cast<size_t>(j)], force[static_cast<size_t>(offset_ + j)], 1e-10);
      ASSERT_NEAR(answer[static_cast<size_t>(j)], response[static_cast<size_t>(offset_ + j)],
                  1e-10 * std::max(1.0, std::abs(answer[static_cast<size_t>(j)])));
    }
  }
}

// The velocities after a free step, with gravity, torques and gyroscopic forces, equal Bullet's,
// and so do positions and poses after it.
TEST_P(TreeDynamicsTest, FallsAsBulletDoes) {
  core::Rng same(static_cast<core::Rng::result_type>(17 + std::get<0>(GetParam())));
  const auto other = RandomTree(same, std::get<0>(GetParam()), std::get<1>(GetParam()));
  TreeDynamics dynamics(other.get());
  const btVector3 gravity(0.3, -0.2, -9.81);
  for (int step = 0; step < 10; ++step) {
    body_->addBaseForce(gravity * body_->getBaseMass());
    for (int i = 0; i < body_->getNumLinks(); ++i) {
      body_->addLinkForce(i, gravity * body_->getLinkMass(i));
    }
    body_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(kStep, scratch_.r, scratch_.v,
                                                                scratch_.m, false, false, false);
    body_->stepPositionsMultiDof(kStep);
    body_->clearForcesAndTorques();
    dynamics.UpdatePoses();
    dynamics.UpdateInverseInertia();
    dynamics.StepFreely({gravity.x(), gravity.y(), gravity.z()}, kStep);
    dynamics.Integrate(kStep);
    for (int i = offset_; i < 6 + body_->getNumDofs(); ++i) {
      ASSERT_NEAR(other->getVelocityVector()[i], body_->getVelocityVector()[i], 1e-8) << step;
    }
  }
  dynamics.UpdatePoses();
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> origins;
  body_->forwardKinematics(turns, origins);
  for (int i = 0; i < body_->getNumLinks(); ++i) {
    const btTransform& pose = body_->getLink(i).m_cachedWorldTransform;
    for (int r = 0; r < 3; ++r) {
      ASSERT_NEAR(dynamics.Center(i)[r], pose.getOrigin()[r], 1e-9);
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(dynamics.Rotation(i)(r, c), pose.getBasis()[r][c], 1e-9);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Trees, TreeDynamicsTest,
                         testing::Combine(testing::Values(0, 1, 3, 8, 13), testing::Bool()));

// A torque-free symmetric top precesses: its spin axis turns about the angular momentum L at the
// rate |L| / I, I the inertia across its axis.
TEST(TreeDynamics, PrecessesLikeASymmetricTop) {
  btMultiBody body(0, 1.0, btVector3(0.02, 0.02, 0.01), false, false);
  body.finalizeMultiDof();
  body.setBaseOmega(btVector3(0.3, 0.0, 2.0));
  TreeDynamics dynamics(&body);
  const Eigen::Vector3d momentum(0.02 * 0.3, 0.0, 0.01 * 2.0);
  const double rate = momentum.norm() / 0.02, dt = 1e-4;
  const int steps = 10000;  // 1 s
  for (int i = 0; i < steps; ++i) {
    dynamics.UpdatePoses();
    dynamics.UpdateInverseInertia();
    dynamics.StepFreely(Eigen::Vector3d::Zero(), dt);
    dynamics.Integrate(dt);
  }
  dynamics.UpdatePoses();
  const Eigen::Vector3d expected =
      Eigen::AngleAxisd(rate * steps * dt, momentum.normalized()) * Eigen::Vector3d::UnitZ();
  EXPECT_LT((dynamics.Rotation(-1).col(2) - expected).norm(), 2e-4);
}

}  // namespace
}  // namespace simwright::sim
