// The hydroelastic contact of assets in Drake: the written values, and the resulting penetration
// depth.
#include "assets/hydroelastic.h"

#include <gtest/gtest.h>

#include <tinyxml2.h>
#include <sdf/sdf.hh>

#include "assets/articulated_sdf.h"
#include "assets/articulated_writer.h"
#include "assets/model_writer.h"
#include "tests/assets/sample_articulated.h"
#include "tests/assets/sample_asset.h"

namespace simwright::assets {
namespace {

const Eigen::Vector3d kExtents(0.1, 0.2, 0.04);

TEST(HydroelasticContact, IsSoftWhereTheMaterialIs) {
  const double wood = HydroelasticContactOf("wood", 0.1, kExtents, 0.5).modulus;
  const double rubber = HydroelasticContactOf("rubber", 0.05, kExtents, 0.5).modulus;
  const double cushion = HydroelasticContactOf("upholstery", 0.001, kExtents, 0.5).modulus;
  EXPECT_EQ(wood, 5e7);
  EXPECT_LT(rubber, wood);
  EXPECT_LT(cushion, rubber);
  EXPECT_EQ(HydroelasticContactOf("wood", 0.1, kExtents, 0.5).resolution_hint, 0.02);
  EXPECT_EQ(HydroelasticContactOf("", 0.1, {}, 0.5).modulus, 5e7);
}

// Returns the depth at which a ball on a rigid floor bears its weight, with its pressure E * depth
// / r integrated over the patch in rings.
TEST(HydroelasticContact, ARoundBodySinksInByATenthOfAMillimetre) {
  for (const double mass : {0.02, 0.1, 0.3}) {
    const double radius = 0.05;
    const double modulus = HydroelasticContactOf("fruit flesh", mass, kExtents, 0.5).modulus;
    const auto force = [&](double depth) {
      double sum = 0.0;
      const double edge = std::sqrt(radius * radius - (radius - depth) * (radius - depth));
      const int rings = 2000;
      for (int i = 0; i < rings; ++i) {
        const double rho = edge * (i + 0.5) / rings;
        const double inside = radius - std::hypot(rho, radius - depth);
        sum += modulus * inside / radius * 2.0 * M_PI * rho * edge / rings;
      }
      return sum;
    };
    double low = 0.0, high = 0.01;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (force(middle) < mass * 9.81 ? low : high) = middle;
    }
    EXPECT_LT(low, 1.5e-4) << mass;
  }
}

// libsdformat keeps Drake's elements, and URDF's text has the same numbers.
TEST(HydroelasticContact, IsWrittenForEveryPartOfSdfAndUrdf) {
  sdf::Root root;
  const sdf::Errors errors = root.LoadSdfString(SdfText(SampleAsset()));
  for (const auto& error : errors) ADD_FAILURE() << error.Message();
  const HydroelasticContact contact = ContactOf(SampleAsset());
  const sdf::Collision& collision = *root.Model()->LinkByIndex(0)->CollisionByIndex(0);
  const sdf::ElementPtr drake = collision.Element()->FindElement("drake:proximity_properties");
  ASSERT_NE(drake, nullptr);
  EXPECT_TRUE(drake->HasElement("drake:compliant_hydroelastic"));
  EXPECT_EQ(std::stod(drake->FindElement("drake:hydroelastic_modulus")->GetValue()->GetAsString()),
            contact.modulus);

  tinyxml2::XMLDocument urdf;
  ASSERT_EQ(urdf.Parse(ArticulatedUrdfText(SampleArticulated()).c_str()), tinyxml2::XML_SUCCESS);
  EXPECT_STREQ(urdf.RootElement()->Attribute("xmlns:drake"), "http://drake.mit.edu");
  int parts = 0;
  for (const auto* link = urdf.RootElement()->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    for (const auto* one = link->FirstChildElement("collision"); one != nullptr;
         one = one->NextSiblingElement("collision")) {
      const auto* properties = one->FirstChildElement("drake:proximity_properties");
      ASSERT_NE(properties, nullptr);
      ASSERT_NE(properties->FirstChildElement("drake:compliant_hydroelastic"), nullptr);
      EXPECT_EQ(properties->FirstChildElement("drake:mu_dynamic")->DoubleAttribute("value"),
                SampleArticulated().links[0].friction);
      ++parts;
    }
  }
  EXPECT_EQ(parts, 3);
  sdf::Root articulated;
  EXPECT_TRUE(articulated.LoadSdfString(ArticulatedSdfText(SampleArticulated())).empty());
}

}  // namespace
}  // namespace simwright::assets
