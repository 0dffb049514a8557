// `simwright library` makes rigid assets as `import` does, checked before they are kept.
#include <gtest/gtest.h>

#include <filesystem>

#include "assets/asset_folder.h"
#include "core/files.h"
#include "library/rigid/rigid_kinds.h"
#include "program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

TEST(RigidLibrary, MakesThingsThatPassTheirCheck) {
  const core::TemporaryFolder folder;
  const std::string out = (folder.path() / "lib").string();
  for (const char* kind : {"jar", "book", "pear", "pen"}) {
    const Outcome made =
        RunProgram(std::string("library --kind ") + kind + " --seed 1 --quiet -o " + out);
    ASSERT_EQ(made.code, 0) << made.text;
    const fs::path place = fs::path(out) / (std::string(kind) + "_1");
    const Outcome checked = RunProgram("check --quiet " + place.string());
    EXPECT_EQ(checked.code, 0) << checked.text;
    EXPECT_TRUE(fs::exists(place / "preview.png"));
    // It has its modelled size and a mass of its kind.
    const assets::Asset asset = assets::ReadAsset(place);
    const library::RigidObject object = library::MakeRigidObject(*library::FindRigidKind(kind), 1);
    const Eigen::Vector3d size = core::Bounds(asset.visual.mesh).sizes();
    EXPECT_LT((size - object.size).norm(), 2e-3 * object.size.norm()) << kind;
    EXPECT_GE(asset.inertial.mass, 0.99 * object.parameters.mass.min) << kind;
    EXPECT_LE(asset.inertial.mass, 1.01 * object.parameters.mass.max) << kind;
  }
}

TEST(RigidLibrary, IsListedUnderAHeadingOfItsOwn) {
  const Outcome list = RunProgram("library --list");
  EXPECT_EQ(list.code, 0);
  const size_t heading = list.text.find("\nrigid:\n");
  ASSERT_NE(heading, std::string::npos);
  EXPECT_LT(list.text.find("  microwave"), heading);
  EXPECT_GT(list.text.find("  mug "), heading);
}

}  // namespace
}  // namespace simwright
