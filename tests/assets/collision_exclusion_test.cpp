// The excluded collision pairs in each output format.
#include "assets/collision_exclusion.h"

#include <gtest/gtest.h>

#include <fstream>

#include <tinyxml2.h>
#include <sdf/sdf.hh>

#include "assets/articulated_folder.h"
#include "assets/articulated_writer.h"
#include "core/files.h"
#include "sample_articulated.h"

namespace simwright::assets {
namespace {

using Pairs = std::vector<ExcludedPair>;

class CollisionExclusion : public ::testing::Test {
 protected:
  void SetUp() override {
    asset_.excluded_pairs = {{"door", "body"}, {"handle_0", "body"}};
    WriteArticulatedAsset(asset_, folder_.path());
  }
  static Pairs Sorted(Pairs pairs) {
    for (ExcludedPair& pair : pairs) {
      if (pair.second < pair.first) std::swap(pair.first, pair.second);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }
  core::TemporaryFolder folder_;
  ArticulatedAsset asset_ = SampleArticulated();
};

TEST_F(CollisionExclusion, ComesBackFromTheFolderAndTheUrdf) {
  const Pairs wanted = Sorted(asset_.excluded_pairs);
  EXPECT_EQ(Sorted(ReadArticulatedAsset(folder_.path()).excluded_pairs), wanted);
  const UrdfModel model = ReadUrdf(folder_.path() / "sample_chest.urdf");
  EXPECT_TRUE(model.findings.empty());
  EXPECT_EQ(Sorted(model.excluded_pairs), wanted);
  EXPECT_EQ(Sorted(ModelOf(asset_).excluded_pairs), wanted);
}

TEST_F(CollisionExclusion, StandsInMjcfAsMujocoReadsIt) {
  tinyxml2::XMLDocument document;
  const std::string text = ArticulatedMjcfText(asset_);
  ASSERT_EQ(document.Parse(text.c_str()), tinyxml2::XML_SUCCESS);
  const auto* contact = document.RootElement()->FirstChildElement("contact");
  ASSERT_NE(contact, nullptr);
  Pairs pairs;
  for (auto* e = contact->FirstChildElement("exclude"); e; e = e->NextSiblingElement("exclude")) {
    pairs.emplace_back(e->Attribute("body1"), e->Attribute("body2"));
  }
  EXPECT_EQ(Sorted(pairs), Sorted(asset_.excluded_pairs));
}

TEST_F(CollisionExclusion, LibsdformatTakesDrakesGroups) {
  sdf::Root root;
  const sdf::Errors errors = root.Load((folder_.path() / "sample_chest.sdf").string());
  EXPECT_TRUE(errors.empty()) << (errors.empty() ? "" : errors[0].Message());
  const sdf::ElementPtr model = root.Model()->Element();
  int groups = 0, ignored = 0;
  for (auto group = model->GetElement("drake:collision_filter_group"); group;
       group = group->GetNextElement("drake:collision_filter_group")) {
    ++groups;
    for (auto other = group->FindElement("drake:ignored_collision_filter_group"); other;
         other = other->GetNextElement("drake:ignored_collision_filter_group")) {
      ++ignored;
    }
  }
  EXPECT_EQ(groups, 3);   // a link each
  EXPECT_EQ(ignored, 2);  // a pair each
}

TEST_F(CollisionExclusion, NothingIsWrittenWhereThereAreNone) {
  asset_.excluded_pairs.clear();
  EXPECT_EQ(ArticulatedUrdfText(asset_).find("collision_filter_group"), std::string::npos);
  EXPECT_EQ(ArticulatedMjcfText(asset_).find("exclude"), std::string::npos);
}

}  // namespace
}  // namespace simwright::assets
