// Worlds in MuJoCo: they have the assets' numbers, and moving bodies are detected.
#include "sim/mujoco_stability.h"

#include <cmath>

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "assets/articulated_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "sim/max_displacement.h"
#include "sim/mujoco_scene.h"
#include "tests/assets/sample_articulated.h"
#include "tests/assets/sample_world.h"

namespace simwright::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d Upright(double x, double z) {
  return Isometry3d(Eigen::Translation3d(x, 0.0, z));
}

class MujocoWorlds : public testing::Test {
 protected:
  std::filesystem::path Write(const std::vector<assets::WorldObject>& objects) const {
    const auto path = folder_.path() / "scene" / "scene.xml";
    core::WriteFile(path, assets::WorldMjcf("room", objects));
    return path;
  }
  // Returns a world of boxes of 10 cm at the given poses.
  std::vector<assets::WorldObject> Boxes(const std::vector<Isometry3d>& poses) const {
    std::vector<assets::WorldObject> boxes;
    for (const Isometry3d& pose : poses) {
      const std::string name = "box_" + std::to_string(boxes.size());
      boxes.push_back({name, sample_.objects[1].asset, pose, false});
    }
    return boxes;
  }

  const core::TemporaryFolder folder_;
  const assets::SampleWorld sample_{folder_.path()};
};

TEST(MujocoTextures, AnArticulatedAssetKeepsItsTexture) {
  const core::TemporaryFolder folder;
  assets::WriteArticulatedAsset(assets::TexturedArticulated(), folder.path());
  char error[500] = "";
  mjModel* model =
      mj_loadXML((folder.path() / "sample_chest.xml").c_str(), nullptr, error, sizeof error);
  ASSERT_NE(model, nullptr) << error;
  EXPECT_STREQ(error, "");
  EXPECT_EQ(model->ntex, 1);
  ASSERT_EQ(model->nmat, 1);
  EXPECT_EQ(model->mat_texid[0], 0);
  int textured = 0;
  for (int i = 0; i < model->ngeom; ++i) {
    if (model->geom_matid[i] != 0) continue;
    ++textured;
    EXPECT_GE(model->mesh_texcoordadr[model->geom_dataid[i]], 0);
  }
  EXPECT_EQ(textured, 3);  // one look of each link
  mj_deleteModel(model);
}

TEST_F(MujocoWorlds, LoadWithTheAssetsNumbers) {
  const MujocoScene scene(Write(sample_.objects), {}, MujocoScene::Ground::kOwn);
  EXPECT_TRUE(scene.warnings().empty()) << scene.warnings()[0];
  const mjModel& model = *scene.model();
  mj_forward(scene.model(), scene.data());
  ASSERT_EQ(model.nbody, 4);
  EXPECT_EQ(model.nmesh, 4);  // two per kind, shared by all of it
  EXPECT_EQ(model.njnt, 2);
  for (const assets::WorldObject& object : sample_.objects) {
    const int body = mj_name2id(&model, mjOBJ_BODY, object.name.c_str());
    ASSERT_GT(body, 0) << object.name;
    EXPECT_EQ(model.body_jntnum[body], object.welded ? 0 : 1);
    const assets::Inertial& inertial = object.asset->asset.inertial;
    EXPECT_NEAR(model.body_mass[body], inertial.mass, 1e-12);
    const double* const q = model.body_iquat + 4 * body;
    const Eigen::Matrix3d axes = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    const Eigen::Matrix3d inertia =
        axes * Eigen::Map<const Vector3d>(model.body_inertia + 3 * body).asDiagonal() *
        axes.transpose();
    EXPECT_LT((inertia - inertial.inertia).norm(), 1e-6 * inertia.norm());
    EXPECT_LT(
        (Eigen::Map<const Vector3d>(model.body_ipos + 3 * body) - inertial.center_of_mass).norm(),
        1e-12);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> turn(scene.data()->xmat +
                                                                              9 * body);
    EXPECT_LT((turn - object.world_from_object.linear()).norm(), 1e-12) << object.name;
    const Eigen::Map<const Vector3d> place(scene.data()->xpos + 3 * body);
    EXPECT_LT((place - object.world_from_object.translation()).norm(), 1e-12) << object.name;
  }
}

// The same as in the asset's own file, which has its own test.
TEST_F(MujocoWorlds, HaveTheOptionsOfOneAsset) {
  const MujocoScene world(Write(sample_.objects), {}, MujocoScene::Ground::kOwn);
  const MujocoScene alone(folder_.path() / "assets" / "box" / "sample_box.xml");
  const mjModel &a = *world.model(), &b = *alone.model();
  EXPECT_NE(a.opt.enableflags & mjENBL_MULTICCD, 0);
  EXPECT_EQ(a.opt.enableflags, b.opt.enableflags);
  EXPECT_EQ(a.opt.cone, mjCONE_ELLIPTIC);
  EXPECT_EQ(a.opt.timestep, 1e-3);  // half: stacks creep otherwise
  EXPECT_EQ(a.opt.impratio, b.opt.impratio);
  EXPECT_EQ(a.opt.tolerance, b.opt.tolerance);
  const auto geom_of = [](const mjModel& model, const char* body) {
    return model.body_geomadr[mj_name2id(&model, mjOBJ_BODY, body)] + 1;  // after the visual geom
  };
  const int geom = geom_of(a, "box_1"), other = geom_of(b, "sample_box");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(a.geom_friction[3 * geom + i], b.geom_friction[3 * other + i]);
  }
  for (int i = 0; i < 2; ++i) EXPECT_EQ(a.geom_solref[2 * geom + i], b.geom_solref[2 * other + i]);
  EXPECT_EQ(a.geom_condim[geom], b.geom_condim[other]);
  EXPECT_GT(a.geom_contype[geom], 0);
}

// An asset's MJCF has no options of its own: it leaves those of the including model. Its own scene
// has multiccd and is stable.
TEST_F(MujocoWorlds, AnAssetCanBePartOfAnyModelAndHasASceneOfItsOwn) {
  const std::filesystem::path box = folder_.path() / "assets" / "box";
  core::WriteFile(box / "mine.xml",
                  "<mujoco><option timestep=\"0.005\" cone=\"pyramidal\"/><size nconmax=\"77\"/>"
                  "<include file=\"sample_box.xml\"/><worldbody><geom name=\"ground\" "
                  "type=\"plane\" size=\"1 1 1\"/></worldbody></mujoco>");
  const MujocoScene mine(box / "mine.xml", {}, MujocoScene::Ground::kOwn);
  EXPECT_TRUE(mine.warnings().empty());
  EXPECT_EQ(mine.model()->opt.timestep, 0.005);
  EXPECT_EQ(mine.model()->opt.cone, mjCONE_PYRAMIDAL);
  EXPECT_EQ(mine.model()->opt.enableflags & mjENBL_MULTICCD, 0);
  EXPECT_EQ(mine.model()->nconmax, 77);
  EXPECT_GT(mj_name2id(mine.model(), mjOBJ_BODY, "sample_box"), 0);

  const MujocoScene own(box / "scene.xml", {}, MujocoScene::Ground::kOwn);
  EXPECT_TRUE(own.warnings().empty());
  EXPECT_NE(own.model()->opt.enableflags & mjENBL_MULTICCD, 0);
  EXPECT_EQ(own.model()->nlight, 1);
  const MujocoStability watched = CheckStabilityInMujoco(box / "scene.xml");
  ASSERT_EQ(watched.bodies.size(), 1u);
  EXPECT_LT(watched.bodies[0].settled, 2e-4);
  EXPECT_LT(watched.bodies[0].drift, 1e-4);
}

TEST_F(MujocoWorlds, WhatStandsStandsAndWhatFallsFalls) {
  const MujocoStability watched = CheckStabilityInMujoco(
      Write(Boxes({Upright(0.0, 0.0), Upright(0.0, 0.1), Upright(1.0, 1.0)})));
  EXPECT_TRUE(watched.warnings.empty());
  ASSERT_EQ(watched.bodies.size(), 3u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_LT(watched.bodies[i].settled, 2e-4) << i;
    EXPECT_LT(watched.bodies[i].drift, 1e-4) << i;
  }
  // g t^2 / 2 in the first quarter of a second, to the integrator's step of g t dt / 2, then at
  // least the rest of its fall.
  const double fallen = 0.5 * 9.81 * 0.25 * 0.25;
  EXPECT_NEAR(watched.bodies[2].settled, fallen, 9.81 * 0.25 * 0.002);
  EXPECT_GT(watched.bodies[2].drift, 0.99 * (1.0 - fallen) - 0.01);
  ASSERT_NE(watched.Farthest(), nullptr);
  EXPECT_EQ(watched.Farthest()->name, "box_2");
  EXPECT_GE(watched.contacts, 8);
}

TEST_F(MujocoWorlds, ATopplingBoxMoves) {
  const Isometry3d pose =
      Upright(0.0, 0.03) * Isometry3d(Eigen::AngleAxisd(0.8, Vector3d::UnitY()));
  EXPECT_GT(CheckStabilityInMujoco(Write(Boxes({pose})), {0.05, 1.0}).bodies[0].drift, 0.02);
  // A point 10 cm from the centre turns by a quarter: a chord of sqrt(2) radii.
  const Isometry3d turned(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()));
  EXPECT_NEAR(MaxDisplacement(Vector3d::Zero(), 0.1, Isometry3d::Identity(), turned),
              0.1 * std::sqrt(2.0), 1e-12);
}

TEST_F(MujocoWorlds, SayWhatIsWrong) {
  EXPECT_THROW(CheckStabilityInMujoco(folder_.path() / "gone.xml"), core::Error);
  core::WriteFile(folder_.path() / "bad.xml", "<mujoco><worldbody><body/></worldbody>");
  EXPECT_THROW(CheckStabilityInMujoco(folder_.path() / "bad.xml"), core::Error);
  EXPECT_THROW(CheckStabilityInMujoco(Write(sample_.objects), {-1.0, 2.0}), core::Error);
  EXPECT_EQ(CheckStabilityInMujoco(Write({sample_.objects[0]}), {0.0, 0.01}).Farthest(), nullptr);
}

}  // namespace
}  // namespace simwright::sim
