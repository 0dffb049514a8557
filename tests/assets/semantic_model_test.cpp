#include "assets/semantic_model.h"

#include <gtest/gtest.h>

#include <fstream>

#include "assets/articulated_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "tests/assets/sample_articulated.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

void Write(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

// A URDF of three bare links: a body with a hinged and a fixed one.
std::string ThreeLinks() {
  return "<robot name='r'><link name='base'/><link name='link_0'/><link name='lid_2'/>"
         "<joint name='a' type='revolute'><parent link='base'/><child link='link_0'/>"
         "<axis xyz='0 0 1'/><limit lower='0' upper='1' effort='1' velocity='1'/></joint>"
         "<joint name='b' type='fixed'><parent link='link_0'/><child link='lid_2'/></joint>"
         "</robot>";
}

TEST(SemanticModel, ReadsOurOwnFolder) {
  const core::TemporaryFolder parent;
  const fs::path folder = parent.path() / "sample_chest";
  fs::create_directory(folder);
  WriteArticulatedAsset(SampleArticulated(), folder);
  const SemanticModel model = ReadSemanticModel(folder);
  EXPECT_EQ(model.name, "sample_chest");
  EXPECT_EQ(model.category, "chest");
  EXPECT_EQ(model.semantics.at("door").joint, "hinge");
  EXPECT_EQ(model.semantics.at("handle_0").label, "handle");
  EXPECT_EQ(model.semantics.at("body").joint, "free");
  EXPECT_TRUE(model.model.findings.empty());
}

TEST(SemanticModel, ReadsPartNetMobilitysFolder) {
  const core::TemporaryFolder folder;
  Write(folder.path() / "mobility.urdf", ThreeLinks());
  Write(folder.path() / "other.urdf", ThreeLinks());
  Write(folder.path() / "meta.json", "{\"model_cat\": \"Microwave\"}");
  Write(folder.path() / "semantics.txt", "link_0 slider+ drawer\n\nlid_2 heavy furniture_body\n");
  const SemanticModel model = ReadSemanticModel(folder.path());
  EXPECT_EQ(model.urdf.filename(), "mobility.urdf");
  EXPECT_EQ(model.category, "microwave");
  EXPECT_EQ(model.semantics.at("link_0").joint, "slider+");
  EXPECT_EQ(model.semantics.at("lid_2").label, "furniture_body");
}

TEST(SemanticModel, WhatNoFileTellsComesFromNames) {
  const core::TemporaryFolder folder;
  Write(folder.path() / "thing.urdf", ThreeLinks());
  const SemanticModel model = ReadSemanticModel(folder.path() / "thing.urdf");
  EXPECT_EQ(model.name, "thing");
  EXPECT_EQ(model.category, "");
  EXPECT_EQ(model.semantics.at("lid_2").label, "lid");
  EXPECT_EQ(model.semantics.at("lid_2").joint, "fixed");
  EXPECT_FALSE(model.semantics.contains("link_0"));  // a number is no label
}

TEST(SemanticModel, DamagedLinesAreReportedAndPassedOver) {
  const core::TemporaryFolder folder;
  Write(folder.path() / "mobility.urdf", ThreeLinks());
  Write(folder.path() / "semantics_gapartnet.txt",
        "link_0 hinge\nghost hinge door\nlid_2 twisty lid\nlink_0 hinge door\n"
        "link_0 slider drawer\n\xff\xfe\n");
  const SemanticModel model = ReadSemanticModel(folder.path());
  int reported = 0;
  for (const core::Finding& finding : model.model.findings) {
    reported += finding.code == "semantics-line";
  }
  EXPECT_EQ(reported, 5);  // two words, a ghost, no kind, twice, one word
  EXPECT_EQ(model.semantics.at("link_0").label, "door");
  EXPECT_EQ(model.semantics.at("lid_2").label, "lid");
}

TEST(SemanticModel, ADamagedCategoryIsReported) {
  const core::TemporaryFolder folder;
  Write(folder.path() / "mobility.urdf", ThreeLinks());
  Write(folder.path() / "meta.json", "{\"model_cat\": 7");
  const SemanticModel model = ReadSemanticModel(folder.path());
  EXPECT_EQ(model.category, "");
  ASSERT_FALSE(model.model.findings.empty());
  EXPECT_EQ(model.model.findings.back().code, "semantics-category");
}

TEST(UrdfIn, WantsOneAlone) {
  const core::TemporaryFolder folder;
  EXPECT_THROW(UrdfIn(folder.path()), core::Error);
  Write(folder.path() / "a.urdf", ThreeLinks());
  EXPECT_EQ(UrdfIn(folder.path()).filename(), "a.urdf");
  Write(folder.path() / "b.urdf", ThreeLinks());
  EXPECT_THROW(UrdfIn(folder.path()), core::Error);
  EXPECT_THROW(ReadSemanticModel(folder.path() / "none"), core::Error);
}

}  // namespace
}  // namespace simwright::assets
