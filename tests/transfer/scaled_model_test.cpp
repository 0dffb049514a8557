#include "transfer/scaled_model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/mass_properties.h"
#include "tests/skills/skill_scene.h"

namespace simwright::transfer {
namespace {

TEST(ScaledModel, KeepsTheDensityOfEachLink) {
  const assets::SemanticModel microwave = skills::WithInertia(tasks::Microwave("microwave"));
  const assets::SemanticModel scaled = ScaledModel(microwave, 1.25);
  ASSERT_EQ(scaled.model.links.size(), microwave.model.links.size());
  for (size_t l = 0; l < scaled.model.links.size(); ++l) {
    // The mass properties of the scaled shapes at the density of the original.
    geometry::MassProperties before, after;
    for (const assets::UrdfShape& shape : microwave.model.links[l].collisions) {
      const auto one = geometry::SolidMassProperties(shape.mesh, 1.0);
      before = before.mass > 0.0 ? geometry::Combined(before, one) : one;
    }
    for (const assets::UrdfShape& shape : scaled.model.links[l].collisions) {
      const auto one = geometry::SolidMassProperties(shape.mesh, 1.0);
      after = after.mass > 0.0 ? geometry::Combined(after, one) : one;
    }
    const double density = microwave.model.links[l].inertial->mass / before.mass;
    const assets::Inertial& inertial = *scaled.model.links[l].inertial;
    EXPECT_NEAR(inertial.mass, density * after.mass, 1e-9);
    EXPECT_TRUE(inertial.center_of_mass.isApprox(after.center_of_mass, 1e-9));
    EXPECT_TRUE(inertial.inertia.isApprox(density * after.inertia, 1e-9));
  }
  for (size_t j = 0; j < scaled.model.joints.size(); ++j) {
    const assets::Joint& was = microwave.model.joints[j];
    const assets::Joint& is = scaled.model.joints[j];
    EXPECT_TRUE(is.parent_from_joint.translation().isApprox(
        1.25 * was.parent_from_joint.translation(), 1e-12));
    const double range = was.type == assets::JointType::kPrismatic ? 1.25 : 1.0;
    EXPECT_NEAR(is.upper, range * was.upper, 1e-12);
  }
}

}  // namespace
}  // namespace simwright::transfer
