// Furniture passes its check, and its files contain the surfaces that scenes rely on.
#include <gtest/gtest.h>

#include "assets/asset_folder.h"
#include "core/files.h"
#include "geometry/mass_properties.h"
#include "library/rigid/rigid_kinds.h"
#include "workflows/library/library.h"

namespace simwright::workflows {
namespace {

TEST(FurnitureLibrary, AllOfItPasses) {
  const core::TemporaryFolder folder;
  LibraryOptions options;
  options.kind = "furniture";
  core::Progress silent;
  const std::vector<LibraryOutcome> outcomes = MakeLibrary(options, folder.path(), &silent);
  ASSERT_EQ(outcomes.size(), library::FurnitureKinds().size());
  for (const LibraryOutcome& outcome : outcomes) {
    ASSERT_EQ(outcome.refusal, "") << outcome.name;
    const assets::Asset asset = assets::ReadAsset(outcome.folder);
    const double volume = geometry::SolidMassProperties(asset.solid, 1.0).volume;
    EXPECT_EQ(asset.wall_thickness, 0.0) << outcome.name;  // full
    EXPECT_NEAR(asset.inertial.mass, asset.density * volume, 1e-6 * asset.inertial.mass);
    // Its collision parts match the modelled surfaces that support objects.
    const library::RigidKind& kind = *library::FindRigidKind(outcome.kind);
    EXPECT_EQ(asset.parts.size(), library::MakeRigidObject(kind, 1).parts.size()) << kind.name;
    Eigen::AlignedBox3d box;
    for (const core::TriangleMesh& part : asset.parts) box.extend(core::Bounds(part));
    EXPECT_LT((box.sizes() - kind.size).norm(), 1e-7) << kind.name;
    EXPECT_NEAR(box.max().z(), kind.size.z(), 1e-7) << kind.name;
  }
}

}  // namespace
}  // namespace simwright::workflows
