#include "assets/kinematic_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "assets/joint_gravity_load.h"
#include "assets/joint_poses.h"
#include "core/error.h"
#include "core/random.h"

namespace simwright::assets {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Joint MakeTreeJoint(const std::string& name, const std::string& parent, const std::string& child,
                    JointType type, const Vector3d& origin, const Vector3d& axis) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.child = child;
  joint.type = type;
  joint.parent_from_joint.translation() = origin;
  joint.axis = axis;
  return joint;
}

std::vector<KinematicLink> LinksNamed(const std::vector<std::string>& names) {
  std::vector<KinematicLink> links;
  for (const std::string& name : names) links.push_back({name, Inertial()});
  return links;
}

// A cart that slides along x, a pole on a hinge about y, a flag fixed to the pole, and a wheel on
// the cart that mimics the slide.
KinematicModel Cart() {
  Joint wheel = MakeTreeJoint("spin", "cart", "wheel", JointType::kContinuous, {0, 0.1, 0},
                              Vector3d::UnitY());
  wheel.mimic = {"slide", 5.0, 0.25};
  return KinematicModel(
      "cart", LinksNamed({"rail", "cart", "pole", "flag", "wheel"}),
      {MakeTreeJoint("slide", "rail", "cart", JointType::kPrismatic, {0, 0, 0.2},
                     Vector3d::UnitX()),
       MakeTreeJoint("hinge", "cart", "pole", JointType::kRevolute, {0, 0, 0.05},
                     Vector3d::UnitY()),
       MakeTreeJoint("mount", "pole", "flag", JointType::kFixed, {0, 0, 0.8}, Vector3d::UnitX()),
       wheel},
      {{"wheel", "rail"}, {"pole", "elsewhere"}});
}

TEST(KinematicModel, PosesFollowTheClosedForm) {
  const KinematicModel cart = Cart();
  for (const double slide : {-0.4, 0.0, 0.7}) {
    for (const double angle : {-1.0, 0.0, 0.5}) {
      const auto poses = cart.LinkPoses({slide, angle, 99.0, -3.0});
      const Vector3d flag(slide + 0.8 * std::sin(angle), 0.0, 0.25 + 0.8 * std::cos(angle));
      EXPECT_LT((poses[3].translation() - flag).norm(), 1e-12);
      // The wheel's own entry is ignored: it follows 5 slide + 0.25.
      const Eigen::AngleAxisd turn(5.0 * slide + 0.25, Vector3d::UnitY());
      EXPECT_LT((poses[4].linear() - turn.toRotationMatrix()).norm(), 1e-12);
      EXPECT_LT((poses[4].translation() - Vector3d(slide, 0.1, 0.2)).norm(), 1e-12);
    }
  }
  EXPECT_THROW(cart.LinkPoses({0.0, 0.0}), core::Error);
}

TEST(KinematicModel, KnowsItsTree) {
  const KinematicModel cart = Cart();
  EXPECT_EQ(cart.parents(), (std::vector<int>{0, 1, 2, 1}));
  EXPECT_EQ(cart.ParentLink(0), -1);
  EXPECT_EQ(cart.ParentLink(4), 1);
  EXPECT_EQ(cart.moving_joints(), (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(cart.Subtree(2), (std::vector<bool>{false, false, true, true, false}));
  EXPECT_EQ(cart.Subtree(1), (std::vector<bool>{false, true, true, true, true}));
  EXPECT_TRUE(cart.RigidlyJoined(2, 3));
  EXPECT_FALSE(cart.RigidlyJoined(1, 2));
  EXPECT_EQ(cart.excluded_pairs(), (std::set<std::pair<int, int>>{{0, 4}}));
  EXPECT_EQ(cart.LinkIndex("flag"), 3);
  EXPECT_EQ(cart.FindJoint("hinge"), 1);
  EXPECT_EQ(cart.FindLink("mast"), -1);
  EXPECT_THROW(cart.JointIndex("knee"), core::Error);
}

// The same tree as an editable description, whose poses are computed by name.
TEST(KinematicModel, AgreesWithTheDescriptionOnRandomTrees) {
  core::Rng rng(7);
  const auto unit = [&] { return core::Uniform(rng, -1.0, 1.0); };
  const auto vector = [&] { return Vector3d(unit(), unit(), unit()); };
  for (int trial = 0; trial < 50; ++trial) {
    UrdfModel description;
    description.name = "tree";
    description.links.resize(8);
    JointPositions by_name;
    std::vector<double> positions;
    for (size_t i = 0; i < 8; ++i) {
      description.links[i].name = "link_" + std::to_string(i);
      if (i == 0) continue;
      const auto type = static_cast<JointType>(rng() % 4);
      Joint joint = MakeTreeJoint("joint_" + std::to_string(i), "link_" + std::to_string(rng() % i),
                                  description.links[i].name, type, vector(), vector().normalized());
      joint.parent_from_joint.linear() =
          Eigen::AngleAxisd(unit(), vector().normalized()).toRotationMatrix();
      description.joints.push_back(joint);
      positions.push_back(unit());
      by_name[joint.name] = positions.back();
    }
    const auto model = MakeKinematicModel(description);
    const auto expected = LinkPoses(description, by_name);
    const auto poses = model->LinkPoses(positions);
    for (size_t i = 0; i < 8; ++i) {
      ASSERT_LT((poses[i].matrix() - expected[i].matrix()).norm(), 1e-13) << trial << ' ' << i;
    }
  }
}

// A frame without mass beyond a joint adds nothing to the joint's load.
TEST(KinematicModel, LoadsIgnoreLinksWithoutMass) {
  std::vector<KinematicLink> links = LinksNamed({"base", "arm", "tool"});
  links[1].inertial.mass = 2.0;
  links[1].inertial.center_of_mass = {0.3, 0.0, 0.0};
  links[1].inertial.inertia = Vector3d(0.01, 0.02, 0.03).asDiagonal();
  const KinematicModel model(
      "arm", links,
      {MakeTreeJoint("shoulder", "base", "arm", JointType::kRevolute, {0, 0, 1}, Vector3d::UnitY()),
       MakeTreeJoint("tip", "arm", "tool", JointType::kFixed, {0.6, 0, 0}, Vector3d::UnitX())});
  const JointLoad load = LoadOn(model, 0, 0.4);
  EXPECT_DOUBLE_EQ(load.mass, 2.0);
  EXPECT_NEAR(load.inertia, 0.02 + 2.0 * 0.3 * 0.3, 1e-12);
  EXPECT_NEAR(load.gravity, 2.0 * 9.81 * 0.3 * std::cos(0.4), 1e-9);
}

TEST(KinematicModel, RefusesWhatIsNoTree) {
  const auto error = [](const std::function<void()>& make) -> std::string {
    try {
      make();
    } catch (const core::Error& e) {
      return e.what();
    }
    return "";
  };
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child) {
    return MakeTreeJoint(name, parent, child, JointType::kFixed, Vector3d::Zero(),
                         Vector3d::UnitX());
  };
  const auto make = [&](const std::vector<std::string>& links, const std::vector<Joint>& joints) {
    return error([&] { KinematicModel("it", LinksNamed(links), joints); });
  };
  EXPECT_EQ(make({"a", "b"}, {joint("j", "a", "b")}), "");
  EXPECT_NE(make({}, {}).find("0 links"), std::string::npos);
  EXPECT_NE(make({"a", "b"}, {}).find("one joint fewer"), std::string::npos);
  EXPECT_NE(make({"a", "a"}, {joint("j", "a", "a")}).find("link 'a'"), std::string::npos);
  EXPECT_NE(make({"a", "b", "c"}, {joint("j", "a", "b"), joint("j", "a", "c")}).find("joint 'j'"),
            std::string::npos);
  EXPECT_NE(make({"a", "b", "c"}, {joint("j", "c", "b"), joint("k", "a", "c")}).find("joint 'j'"),
            std::string::npos);
  EXPECT_NE(make({"a", "b"}, {joint("j", "a", "x")}).find("to 'x'"), std::string::npos);
}

}  // namespace
}  // namespace simwright::assets
