// The gripper's affordances by the shapes of an object, and the reasons why it has none.
#include "tasks/rules/affordances.h"

#include <gtest/gtest.h>

#include <memory>

namespace simwright::tasks {
namespace {

Eigen::AlignedBox3d Aabb(const Eigen::Vector3d& middle, const Eigen::Vector3d& sides) {
  return {middle - 0.5 * sides, middle + 0.5 * sides};
}

ArticulatedObject ThingOfParts(const std::string& category, double mass,
                               const std::vector<Eigen::AlignedBox3d>& parts) {
  ArticulatedObject object;
  object.name = object.category = category;
  object.mass = mass;
  object.kinematics = std::make_shared<assets::KinematicModel>(
      category, std::vector<assets::KinematicLink>{{"body", {}}}, std::vector<assets::Joint>());
  ObjectLink link;
  for (const Eigen::AlignedBox3d& part : parts) {
    link.box.extend(part);
    for (int corner = 0; corner < 8; ++corner) {
      link.extreme_points.push_back(
          part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    }
  }
  link.parts = parts;
  object.box = link.box;
  object.links.push_back(link);
  return object;
}

// Returns a hammer: a shaft of 30 cm with a head of 12 x 3 x 3 cm across its end, lying.
ArticulatedObject Hammer() {
  return ThingOfParts(
      "hammer", 0.7,
      {Aabb({0, 0, 0.015}, {0.30, 0.03, 0.03}), Aabb({0.15, 0, 0.015}, {0.03, 0.12, 0.03})});
}

// Returns a teapot: a body of 15 cm with a handle of 2 cm at one side and a spout at the other.
ArticulatedObject Teapot() {
  return ThingOfParts(
      "teapot", 0.8,
      {Aabb({0, 0, 0.06}, {0.15, 0.15, 0.12}), Aabb({-0.10, 0, 0.07}, {0.05, 0.02, 0.08}),
       Aabb({0.09, 0, 0.07}, {0.04, 0.025, 0.05})});
}

TEST(Affordances, AHammerAndATeapotAreTakenByTheirHandles) {
  for (const ArticulatedObject& object : {Hammer(), Teapot()}) {
    EXPECT_GT(object.box.sizes().head<2>().minCoeff(), kMaxGraspWidth);
    EXPECT_TRUE(HasHandle(object)) << object.name;
    EXPECT_TRUE(CanBeLifted(object)) << object.name;
    EXPECT_EQ(ExplainUnusable(object).sentence, "") << object.name;
  }
  EXPECT_TRUE(CanPour(Teapot()));
  EXPECT_FALSE(CanPour(Hammer()));
}

TEST(Affordances, WhatHasNoHandleIsNotTakenByOne) {
  const ArticulatedObject block = ThingOfParts("box", 1.0, {Aabb({0, 0, 0.1}, {0.2, 0.2, 0.2})});
  EXPECT_FALSE(HasHandle(block));
  EXPECT_FALSE(CanBeLifted(block));
  EXPECT_TRUE(CanBePushed(block));
  // A knob within the outline of the other shapes does not protrude.
  const ArticulatedObject knob = ThingOfParts(
      "box", 1.0, {Aabb({0, 0, 0.1}, {0.2, 0.2, 0.2}), Aabb({0, 0, 0.21}, {0.03, 0.03, 0.02})});
  EXPECT_FALSE(HasHandle(knob));
  ArticulatedObject heavy = Hammer();
  heavy.mass = 5.0;
  EXPECT_FALSE(CanBeLifted(heavy));
}

TEST(Affordances, ProvedGraspsDecideWhatCanBeLifted) {
  ArticulatedObject pen = ThingOfParts("pen", 0.01, {Aabb({0, 0, 0.004}, {0.14, 0.008, 0.008})});
  EXPECT_FALSE(CanBeLifted(pen));  // too low for a guess
  pen.graspable = true;
  EXPECT_TRUE(CanBeLifted(pen));
  ArticulatedObject plate = ThingOfParts("plate", 0.4, {Aabb({0, 0, 0.009}, {0.07, 0.2, 0.018})});
  EXPECT_TRUE(CanBeLifted(plate));
  plate.graspable = false;
  EXPECT_FALSE(CanBeLifted(plate));
  EXPECT_NE(ExplainUnusable(plate).sentence.find("clears the plane"), std::string::npos);
  pen.mass = 3.0;
  EXPECT_FALSE(CanBeLifted(pen));  // heavier than the payload
}

TEST(Affordances, TheReasonOfNoUseIsSaidWithItsFigure) {
  const ArticulatedObject heavy = ThingOfParts("stone", 30.0, {Aabb({0, 0, 0.1}, {0.2, 0.2, 0.2})});
  EXPECT_NE(ExplainUnusable(heavy).sentence.find("30 kg"), std::string::npos);
  const ArticulatedObject flat = ThingOfParts("mat", 0.3, {Aabb({0, 0, 0.002}, {0.3, 0.3, 0.004})});
  EXPECT_NE(ExplainUnusable(flat).sentence.find("0.004 m high"), std::string::npos);
  const ArticulatedObject wide = ThingOfParts("table", 5.0, {Aabb({0, 0, 0.4}, {1.6, 0.8, 0.8})});
  EXPECT_NE(ExplainUnusable(wide).sentence.find("1.6 m"), std::string::npos);
  for (const ArticulatedObject& object : {heavy, flat, wide})
    EXPECT_FALSE(ExplainUnusable(object).remedy.empty());
}

}  // namespace
}  // namespace simwright::tasks
