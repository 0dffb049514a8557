// Objects that grammars put on furniture stand on a surface of the library's furniture.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "library/rigid/rigid_kinds.h"
#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"
#include "scene/scene_types/breakfast.h"
#include "scene/scene_types/dimsum.h"
#include "scene/scene_types/living_room_shelf.h"
#include "scene/scene_types/pantry_shelf.h"
#include "scene/scene_types/restaurant.h"

namespace simwright::scene {
namespace {

AssetSet Furniture() {
  AssetSet asset_set;
  for (const library::RigidKind& kind : library::FurnitureKinds()) {
    sim::RigidBody body;
    body.name = kind.name;
    body.parts = library::MakeRigidObject(kind, 1).parts;
    body.inertial.mass = 1.0;
    asset_set.Add(kind.name, body);
  }
  return asset_set;
}

// Returns the height in m of the highest part of `asset` under the point, at most a tenth of a
// millimetre above it.
double SurfaceUnder(const SceneAsset& asset, const Eigen::Vector3d& point) {
  double highest = -1.0;
  for (const core::TriangleMesh& part : asset.body.parts) {
    const Eigen::AlignedBox3d box = core::Bounds(part);
    const bool over = (box.min().head<2>().array() <= point.head<2>().array()).all() &&
                      (box.max().head<2>().array() >= point.head<2>().array()).all();
    if (over && box.max().z() <= point.z() + 1e-4) highest = std::max(highest, box.max().z());
  }
  return highest;
}

TEST(FurnitureInGrammars, ThingsStandOnItsSurfaces) {
  const AssetSet asset_set = Furniture();
  const CategorySizes sizes = asset_set.Sizes();
  for (const Grammar& grammar :
       {DimsumTable(sizes), BreakfastTableLow(sizes), BreakfastTableHigh(sizes), PantryShelf(sizes),
        LivingRoomShelf(sizes), RestaurantHigh(sizes), RestaurantLow(sizes)}) {
    core::Rng rng = core::StreamRng(5, 0);
    int standing = 0;
    for (int scene = 0; scene < 3; ++scene) {
      const SceneSample sample = SampleGrammar(grammar, rng);
      for (const SceneObject& object : sample.objects) {
        if (object.parent < 0 || !sample.objects[static_cast<size_t>(object.parent)].welded)
          continue;
        const SceneObject& furniture = sample.objects[static_cast<size_t>(object.parent)];
        const Eigen::Vector3d at =
            furniture.world_from_object.inverse() * object.world_from_object.translation();
        EXPECT_NEAR(SurfaceUnder(asset_set.At(furniture.category), at), at.z(), 1e-9)
            << grammar.name() << ": " << object.category;
        ++standing;
      }
    }
    EXPECT_GE(standing, 6) << grammar.name();
  }
}

TEST(FurnitureInGrammars, IsOfTheSizesThatGrammarsStartFrom) {
  const CategorySizes sizes = Furniture().Sizes();
  for (const library::RigidKind& kind : library::FurnitureKinds()) {
    const CategorySize& expected = SizeOf(DefaultCategorySizes(), kind.name);
    const CategorySize& found = sizes.at(kind.name);
    EXPECT_LT((found.half_size - expected.half_size).norm(), 1e-9) << kind.name;
    EXPECT_NEAR(found.height, expected.height, 1e-9) << kind.name;
  }
}

}  // namespace
}  // namespace simwright::scene
