// Worlds of several objects as SDF, read by libsdformat; names that would clash.
#include "assets/world_writer.h"

#include <gtest/gtest.h>

#include <sdf/sdf.hh>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "tests/assets/sample_world.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

Eigen::Isometry3d PoseOf(const ignition::math::Pose3d& pose) {
  Eigen::Isometry3d result(
      Eigen::Quaterniond(pose.Rot().W(), pose.Rot().X(), pose.Rot().Y(), pose.Rot().Z()));
  result.translation() = Eigen::Vector3d(pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z());
  return result;
}

TEST(WorldSdf, LibsdformatFindsTheSameWorld) {
  const core::TemporaryFolder folder;
  const SampleWorld sample(folder.path());
  core::WriteFile(folder.path() / "scene" / "world.sdf", WorldSdf("room", sample.objects));
  sdf::Root root;
  const sdf::Errors errors = root.Load((folder.path() / "scene" / "world.sdf").string());
  for (const auto& error : errors) ADD_FAILURE() << error.Message();
  ASSERT_EQ(root.WorldCount(), 1u);
  const sdf::World& world = *root.WorldByIndex(0);
  EXPECT_EQ(world.ModelCount(), sample.objects.size() + 1);  // and the ground
  for (const WorldObject& object : sample.objects) {
    const sdf::Model* const model = world.ModelByName(object.name);
    ASSERT_NE(model, nullptr) << object.name;
    EXPECT_EQ(model->Static(), object.welded);
    ignition::math::Pose3d pose;
    EXPECT_TRUE(model->SemanticPose().Resolve(pose).empty());
    EXPECT_TRUE(PoseOf(pose).isApprox(object.world_from_object, 1e-12)) << object.name;
    const sdf::Link& link = *model->LinkByIndex(0);
    const Asset& asset = object.asset->asset;
    EXPECT_NEAR(link.Inertial().MassMatrix().Mass(), asset.inertial.mass, 1e-9);
    EXPECT_NEAR(link.Inertial().Moi()(0, 1), asset.inertial.inertia(0, 1), 1e-9);
    ASSERT_EQ(link.CollisionCount(), asset.parts.size());
    const std::string uri = link.CollisionByIndex(0)->Geom()->MeshShape()->Uri();
    EXPECT_TRUE(fs::exists(folder.path() / "scene" / uri)) << uri;
    const sdf::ElementPtr surface = link.CollisionByIndex(0)->Element()->GetElement("surface");
    const sdf::ElementPtr ode = surface->GetElement("friction")->GetElement("ode");
    EXPECT_NEAR(ode->Get<double>("mu"), asset.friction, 1e-12);
  }
}

// The ground's top is at z = 0; it is rigid, beside compliant objects.
TEST(WorldSdf, TheGroundIsABoxForDrake) {
  const core::TemporaryFolder folder;
  const SampleWorld sample(folder.path());
  for (const std::string& text : {WorldSdf("room", sample.objects), GroundSdf(),
                                  WorldSdf("room", sample.objects, SdfReader::kGazebo)}) {
    sdf::Root root;
    EXPECT_TRUE(root.LoadSdfString(text).empty());
    const sdf::Model* const ground =
        root.WorldCount() > 0 ? root.WorldByIndex(0)->ModelByName("ground") : root.Model();
    ASSERT_NE(ground, nullptr);
    EXPECT_TRUE(ground->Static());
    const sdf::Collision& collision = *ground->LinkByIndex(0)->CollisionByIndex(0);
    ASSERT_NE(collision.Geom()->BoxShape(), nullptr);
    EXPECT_EQ(collision.RawPose().Pos().Z() + 0.5 * collision.Geom()->BoxShape()->Size().Z(), 0.0);
    const sdf::ElementPtr drake = collision.Element()->FindElement("drake:proximity_properties");
    ASSERT_NE(drake, nullptr);
    EXPECT_TRUE(drake->HasElement("drake:rigid_hydroelastic"));
  }
  // Gazebo needs a light; Drake warns of it.
  EXPECT_EQ(WorldSdf("room", sample.objects).find("<light"), std::string::npos);
  EXPECT_NE(WorldSdf("room", sample.objects, SdfReader::kGazebo).find("<light"), std::string::npos);
}

TEST(WorldWriter, RefusesNamesThatClash) {
  const core::TemporaryFolder folder;
  const SampleWorld sample(folder.path());
  std::vector<WorldObject> twice = {sample.objects[0], sample.objects[0]};
  EXPECT_THROW(WorldSdf("room", twice), core::Error);
  EXPECT_THROW(WorldMjcf("room", twice), core::Error);
  // Another asset of the same key.
  const WorldAsset other = *sample.objects[0].asset;
  twice[1].name = "other";
  EXPECT_NO_THROW(WorldMjcf("room", twice));
  twice[1].asset = &other;
  EXPECT_THROW(WorldMjcf("room", twice), core::Error);
  twice[1] = sample.objects[1];
  twice[1].name = "../outside";
  EXPECT_THROW(WorldMjcf("room", twice), core::Error);
  twice[1].name = "ground";
  EXPECT_THROW(WorldMjcf("room", twice), core::Error);
}

}  // namespace
}  // namespace simwright::assets
