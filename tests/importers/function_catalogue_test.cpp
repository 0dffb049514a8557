// Affordances survive the conversion to the simulator: cups hold a ball in both engines, and a rod
// passes through a mug's handle.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "assets/asset_folder.h"
#include "geometry/distance.h"
#include "sim/mujoco.h"
#include "sim/world.h"
#include "tests/importers/openings.h"
#include "workflows/import/import.h"

namespace simwright::importers {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFurniture = "/usr/share/sweethome3d/furniture/";
constexpr double kBall = 0.005;  // m, radius

struct Piece {
  const char* catalogue;
  const char* name;
};

class Function : public ::testing::TestWithParam<Piece> {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("simwright_function_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    const fs::path catalogue = std::string(kFurniture) + GetParam().catalogue + ".sh3f";
    if (!fs::exists(catalogue)) GTEST_SKIP() << "run ./setup.sh --catalogue";
    workflows::ImportOptions options;
    options.only = GetParam().name;
    options.limit = 1;
    core::Progress progress;
    const auto outcomes = workflows::ImportAll(workflows::ListImports({catalogue}, options),
                                               folder_, options, &progress);
    ASSERT_EQ(outcomes.size(), 1u);
    ASSERT_EQ(outcomes[0].refusal, "");
    asset_ = assets::ReadAsset(outcomes[0].folder);
    mjcf_ = outcomes[0].folder / (asset_.name + ".xml");
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_, mjcf_;
  assets::Asset asset_;
};

class Holds : public Function {};
class LetsThrough : public Function {};

// Expects that a ball at `world` lies in the cavity of an asset at `world_from_asset`: its lowest
// point is half a radius below the brim, and the floor is where the solid has it, up to half the
// depth (collision parts raise floors by up to their tolerance, that of the coffee cup by 1.2 mm of
// its 6 mm).
void ExpectInside(const Hollow& hollow, const Eigen::Isometry3d& world_from_asset,
                  const Eigen::Vector3d& world, const std::string& engine) {
  const Eigen::Vector3d ball = world_from_asset.inverse() * world;
  EXPECT_LT(ball.z(), hollow.brim + 0.5 * kBall) << engine << ": lies on the brim";
  EXPECT_GT(ball.z(), hollow.floor + 0.5 * kBall) << engine << ": sunk into the floor";
  EXPECT_LT(ball.z(), hollow.floor + 0.5 * hollow.depth() + kBall) << engine << ": held too high";
}

TEST_P(Holds, ABall) {
  const Hollow hollow = HeightMap(asset_.solid, 0.0015).DeepestHollow();
  // The coffee cup is full: 6 mm are left above the coffee.
  ASSERT_GT(hollow.depth(), 1.2 * kBall) << "nothing is hollow here";
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.translation() << hollow.place, hollow.brim + 2.0 * kBall;
  constexpr double kSeconds = 3.0;

  const sim::RigidBody body = sim::BodyFromAsset(asset_);
  const double mass = 1000.0 * 4.0 / 3.0 * M_PI * kBall * kBall * kBall;
  const sim::RigidBody ball = sim::SphereBody(kBall, mass);
  sim::World world;
  const int cup = world.Add(body, Eigen::Isometry3d::Identity());
  const int probe = world.Add(ball, start);
  while (world.time() < kSeconds) world.Step();
  ExpectInside(hollow, world.Pose(cup), world.Pose(probe).translation(), "Bullet");

  sim::MujocoWorld mujoco(mjcf_, {kBall});
  mujoco.SetPose(0, Eigen::Isometry3d::Identity());
  mujoco.SetPose(1, start);
  while (mujoco.time() < kSeconds) mujoco.Step();
  ExpectInside(hollow, mujoco.Pose(0), mujoco.Pose(1).translation(), "MuJoCo");
  EXPECT_TRUE(mujoco.warnings().empty());
}

TEST_P(LetsThrough, ARodThroughTheHandle) {
  constexpr double kRod = 0.003;  // m, radius
  const ThroughHole hole = WidestHole(asset_.visual.mesh);
  ASSERT_GT(hole.clearance, kRod) << "no handle is seen";
  const double reach = core::Bounds(asset_.solid).diagonal().norm();
  const geometry::ConvexShape rod = {
      {hole.middle - reach * hole.direction, hole.middle + reach * hole.direction}, kRod};
  EXPECT_GT(geometry::SignedDistanceToParts(asset_.parts, rod).distance, 0.0);
}

std::string NameOf(const ::testing::TestParamInfo<Piece>& info) {
  std::string name = info.param.name;
  std::erase(name, ' ');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Holds,
                         ::testing::Values(Piece{"BlendSwap-CC-0", "Coffee cup"},
                                           Piece{"BlendSwap-CC-0", "Plastic cup"},
                                           Piece{"BlendSwap-CC-0", "Beer glass"},
                                           Piece{"KatorLegaz", "Coffee mug"},
                                           Piece{"KatorLegaz", "Bowl"}),
                         NameOf);
INSTANTIATE_TEST_SUITE_P(Catalogue, LetsThrough,
                         ::testing::Values(Piece{"KatorLegaz", "Coffee mug"}), NameOf);

}  // namespace
}  // namespace simwright::importers
