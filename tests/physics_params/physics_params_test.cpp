#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "physics_params/category_resolution.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/physical_parameters.h"

namespace simwright::physics_params {
namespace {

const KnowledgeBase& PhysicsParamsBase() {
  return KnowledgeBase::Shipped();
}

TEST(KnowledgeBase, KnowsThreeHundredKindsEachWithASource) {
  EXPECT_GE(PhysicsParamsBase().categories().size(), 300u);
  for (const Category& category : PhysicsParamsBase().categories()) {
    EXPECT_FALSE(category.source.empty()) << category.name;
    EXPECT_LE(category.width.min, category.length.max) << category.name;
  }
}

// An independent bound: nothing is denser over its bounding box than its densest material.
TEST(KnowledgeBase, MassesArePossibleForTheirSizes) {
  for (const Category& c : PhysicsParamsBase().categories()) {
    double densest = 0.0;
    for (const std::string& name : c.materials) {
      densest = std::max(densest, PhysicsParamsBase().FindMaterial(name)->density.max);
    }
    const double largest_box = c.length.max * c.width.max * c.height.max;
    const double smallest_box = c.length.min * c.width.min * c.height.min;
    EXPECT_LE(c.mass.max, 1.05 * densest * largest_box) << c.name;
    EXPECT_LE(c.mass.min, densest * smallest_box * 1.3) << c.name;
    EXPECT_GE(c.mass.max, 0.5 * smallest_box) << c.name;  // half of air's density is impossible
  }
}

TEST(KnowledgeBase, RefusesMalformedRowsByLine) {
  const char* sources = "s|someone\n";
  const char* materials = "wood|400-800|0.3-0.5|0.2-0.4|handbook\n";
  EXPECT_NO_THROW(KnowledgeBase("cube|1-2|1-2|1-2|1-2|wood|solid|box|s\n", materials, sources));
  for (const char* row :
       {"cube|1-2|1-2|1-2|1-2|wood|solid|box\n", "cube|2-1|1-2|1-2|1-2|wood|solid|box|s\n",
        "cube|1-2|1-2|1-2|x-2|wood|solid|box|s\n", "cube|1-2|1-2|1-2|1-2|gold|solid|box|s\n",
        "cube|1-2|1-2|1-2|1-2|wood|liquid|box|s\n", "cube|1-2|1-2|1-2|1-2|wood|solid|box|t\n"}) {
    EXPECT_THROW(KnowledgeBase(row, materials, sources), core::Error) << row;
  }
}

TEST(Resolution, ExactPluralAndCompoundNames) {
  EXPECT_EQ(RequireCategory("Mug").category->name, "mug");
  EXPECT_EQ(RequireCategory("mugs").category->name, "mug");
  EXPECT_EQ(RequireCategory("wine_glass").category->name, "wine glass");
  EXPECT_EQ(RequireCategory("my red coffee mug").category->name, "coffee mug");
}

TEST(Resolution, WordNetLeadsToTheNearestKind) {
  if (WordNet::Installed() == nullptr) GTEST_SKIP() << "wordnet-base is not installed";
  const std::string demitasse = RequireCategory("demitasse").category->name;
  EXPECT_TRUE(demitasse.ends_with("cup")) << demitasse;
  const Resolution loveseat = RequireCategory("loveseat");
  EXPECT_TRUE(loveseat.category->name == "sofa" || loveseat.category->name == "couch");
  EXPECT_FALSE(loveseat.exact);
  EXPECT_NE(loveseat.sentence.find("WordNet"), std::string::npos);
  EXPECT_EQ(RequireCategory("tangerine").category->name, "mandarin");
}

TEST(Resolution, UnknownNameNamesTheClosest) {
  try {
    RequireCategory("mugg");
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("mug"), std::string::npos);
  }
  EXPECT_THROW(RequireCategory(""), core::Error);
  EXPECT_THROW(RequireCategory("democracy"), core::Error);
  const Resolution alone = ResolveCategory("demitasse", PhysicsParamsBase(), nullptr);
  EXPECT_EQ(alone.category, nullptr);
  EXPECT_FALSE(alone.closest.empty());
}

TEST(Sampling, StaysInItsRangesAndRepeats) {
  for (const Category& category : PhysicsParamsBase().categories()) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const PhysicalParameters p = SampleParameters(category, PhysicsParamsBase(), seed);
      for (const Estimate* e :
           {&p.length, &p.width, &p.height, &p.mass, &p.density, &p.friction, &p.restitution}) {
        EXPECT_GE(e->sample, e->min) << category.name;
        EXPECT_LE(e->sample, e->max) << category.name;
      }
      EXPECT_GE(p.length.sample + 1e-12, p.width.sample) << category.name;
      EXPECT_EQ(p.mass.sample, SampleParameters(category, PhysicsParamsBase(), seed).mass.sample);
    }
  }
}

TEST(Reconciliation, MassVolumeAndDensityAlwaysAgree) {
  for (const Category& category : PhysicsParamsBase().categories()) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const PhysicalParameters p = SampleParameters(category, PhysicsParamsBase(), seed);
      const double box = p.length.sample * p.width.sample * p.height.sample;
      const double area = 2 * (p.length.sample * p.width.sample +
                               (p.length.sample + p.width.sample) * p.height.sample);
      for (double filling : {0.02, 0.3, 1.0}) {
        const MassModel m = ReconcileMass(p, category, PhysicsParamsBase(), filling * box, area);
        const Material& material = *PhysicsParamsBase().FindMaterial(m.material);
        // A hollow body's cavity is the body scaled by 1 - wall A / (3 V).
        const double cavity =
            m.wall_thickness > 0 ? 1.0 - m.wall_thickness * area / (3.0 * filling * box) : 0.0;
        const double matter = filling * box * (1.0 - std::pow(cavity, 3));
        EXPECT_NEAR(m.density * matter, m.mass, 1e-9 * m.mass) << category.name;
        EXPECT_TRUE(m.density >= material.density.min * (1 - 1e-12) &&
                    m.density <= material.density.max * (1 + 1e-12))
            << category.name;
      }
    }
  }
  const Category& mug = *PhysicsParamsBase().FindCategory("mug");
  // A flat sheet's bounding box has no volume, so that its scaled mass is zero: its matter counts.
  PhysicalParameters flat = SampleParameters(mug, PhysicsParamsBase(), 1);
  flat.mass.sample = 0.0;
  const MassModel sheet = ReconcileMass(flat, mug, PhysicsParamsBase(), 1e-6, 0.01);
  EXPECT_EQ(sheet.wall_thickness, 0.0);
  EXPECT_NEAR(sheet.mass, 1e-6 * sheet.density, 1e-15);
  EXPECT_THROW(ReconcileMass(SampleParameters(mug, PhysicsParamsBase(), 1), mug,
                             PhysicsParamsBase(), 0.0, 1.0),
               core::Error);
}

}  // namespace
}  // namespace simwright::physics_params
