// The gripper's affordances by the shapes of an object, and the reasons why it has none.
#include "tasks/rules/affordances.h"

#include <gtest/gtest.h>

namespace simwright::tasks {
namespace {

Eigen::AlignedBox3d Box(const Eigen::Vector3d& middle, const Eigen::Vector3d& sides) {
  return {middle - 0.5 * sides, middle + 0.5 * sides};
}

Thing ThingOfParts(const std::string& category, double mass,
                   const std::vector<Eigen::AlignedBox3d>& parts) {
  Thing thing;
  thing.name = thing.category = category;
  thing.mass = mass;
  ThingLink link;
  link.name = "body";
  for (const Eigen::AlignedBox3d& part : parts) {
    link.box.extend(part);
    for (int corner = 0; corner < 8; ++corner) {
      link.outline.push_back(part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    }
  }
  link.parts = parts;
  thing.box = link.box;
  thing.links.push_back(link);
  return thing;
}

// Returns a hammer: a shaft of 30 cm with a head of 12 x 3 x 3 cm across its end, lying.
Thing Hammer() {
  return ThingOfParts("hammer", 0.7,
                      {Box({0, 0, 0.015}, {0.30, 0.03, 0.03}),
                       Box({0.15, 0, 0.015}, {0.03, 0.12, 0.03})});
}

// Returns a teapot: a body of 15 cm with a handle of 2 cm at one side and a spout at the other.
Thing Teapot() {
  return ThingOfParts("teapot", 0.8,
                      {Box({0, 0, 0.06}, {0.15, 0.15, 0.12}),
                       Box({-0.10, 0, 0.07}, {0.05, 0.02, 0.08}),
                       Box({0.09, 0, 0.07}, {0.04, 0.025, 0.05})});
}

TEST(Affordances, AHammerAndATeapotAreTakenByTheirHandles) {
  for (const Thing& thing : {Hammer(), Teapot()}) {
    EXPECT_GT(thing.box.sizes().head<2>().minCoeff(), kHandOpening);
    EXPECT_TRUE(HasHandle(thing)) << thing.name;
    EXPECT_TRUE(CanBeLifted(thing)) << thing.name;
    EXPECT_EQ(WhyOfNoUse(thing).sentence, "") << thing.name;
  }
  EXPECT_TRUE(CanPour(Teapot()));
  EXPECT_FALSE(CanPour(Hammer()));
}

TEST(Affordances, WhatHasNoHandleIsNotTakenByOne) {
  const Thing block = ThingOfParts("box", 1.0, {Box({0, 0, 0.1}, {0.2, 0.2, 0.2})});
  EXPECT_FALSE(HasHandle(block));
  EXPECT_FALSE(CanBeLifted(block));
  EXPECT_TRUE(CanBePushed(block));
  // A knob within the outline of the other shapes does not protrude.
  const Thing knob = ThingOfParts(
      "box", 1.0, {Box({0, 0, 0.1}, {0.2, 0.2, 0.2}), Box({0, 0, 0.21}, {0.03, 0.03, 0.02})});
  EXPECT_FALSE(HasHandle(knob));
  Thing heavy = Hammer();
  heavy.mass = 5.0;
  EXPECT_FALSE(CanBeLifted(heavy));
}

TEST(Affordances, TheReasonOfNoUseIsSaidWithItsFigure) {
  const Thing heavy = ThingOfParts("stone", 30.0, {Box({0, 0, 0.1}, {0.2, 0.2, 0.2})});
  EXPECT_NE(WhyOfNoUse(heavy).sentence.find("30 kg"), std::string::npos);
  const Thing flat = ThingOfParts("mat", 0.3, {Box({0, 0, 0.002}, {0.3, 0.3, 0.004})});
  EXPECT_NE(WhyOfNoUse(flat).sentence.find("0.004 m high"), std::string::npos);
  const Thing wide = ThingOfParts("table", 5.0, {Box({0, 0, 0.4}, {1.6, 0.8, 0.8})});
  EXPECT_NE(WhyOfNoUse(wide).sentence.find("1.6 m"), std::string::npos);
  for (const Thing& thing : {heavy, flat, wide}) EXPECT_FALSE(WhyOfNoUse(thing).remedy.empty());
}

}  // namespace
}  // namespace simwright::tasks
