// Steamers of one kind, stacked in contact as a grammar places them, are stable in both engines,
// with a lid and without.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <tinyxml2.h>

#include "assets/asset_folder.h"
#include "assets/model_writer.h"
#include "assets/xml_element.h"
#include "core/files.h"
#include "sim/mujoco.h"
#include "sim/settling.h"
#include "workflows/library/library.h"

namespace simwright::validation {
namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;

constexpr int kTallest = 5;

class SteamerStack : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    workflows::LibraryOptions options;
    options.kind = "steamer,steamer_lid";
    options.seed = static_cast<std::uint64_t>(GetParam());
    options.check = false;
    core::Progress silent;
    const auto made = workflows::MakeLibrary(options, folder_.path(), &silent);
    ASSERT_EQ(made.size(), 2u);
    steamer_ = assets::ReadAsset(made[0].folder);
    lid_ = assets::ReadAsset(made[1].folder);
  }

  // Upright on the floor, each rotated differently, with a lid of the same seed on top.
  std::vector<Isometry3d> Poses(int count, bool lid) const {
    const double high = core::Bounds(steamer_.solid).max().z();
    std::vector<Isometry3d> poses;
    for (int i = 0; i < count + (lid ? 1 : 0); ++i) {
      Isometry3d pose(Eigen::Translation3d(0.0, 0.0, i * high));
      pose.rotate(Eigen::AngleAxisd(2.4 * i, Eigen::Vector3d::UnitZ()));
      poses.push_back(pose);
    }
    return poses;
  }

  // Returns the largest displacement of one within two seconds, after half a second of settling, m.
  double DriftInBullet(int count, bool lid, double time_step) const {
    const sim::RigidBody steamer = sim::BodyFromAsset(steamer_), top = sim::BodyFromAsset(lid_);
    std::vector<sim::SettlingBody> bodies;
    for (const Isometry3d& pose : Poses(count, lid)) bodies.push_back({&steamer, pose, false});
    if (lid) bodies.back().body = &top;
    sim::SettlingOptions options;
    options.duration = 0.5;
    options.watch = 2.0;
    options.time_step = time_step;
    double drift = 0.0;
    for (const sim::SettledBody& one : sim::Settle(bodies, options)) {
      EXPECT_LT(one.moved, 2e-3);
      drift = std::max(drift, one.drift);
    }
    return drift;
  }

  double DriftInMujoco(int count, bool lid) const;

  core::TemporaryFolder folder_;
  assets::Asset steamer_, lid_;
};

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// Returns the text between two marks of an asset's MJCF, with files relative to the parent folder.
std::string Section(const assets::Asset& asset, const std::string& from, const std::string& to) {
  const std::string text = assets::MjcfText(asset);
  const size_t first = text.find(from) + from.size();
  return Replaced(text.substr(first, text.find(to) - first), "file=\"",
                  "file=\"" + asset.name + "/");
}

double SteamerStack::DriftInMujoco(int count, bool lid) const {
  std::string meshes = Section(steamer_, "<asset>", "</asset>"), bodies;
  if (lid) meshes += Section(lid_, "<asset>", "</asset>");
  for (int i = 0; i < count; ++i) {
    const std::string body = Section(steamer_, "<worldbody>", "</worldbody>");
    bodies += Replaced(body, "name=\"", "name=\"of_" + std::to_string(i) + "_");
  }
  if (lid) bodies += Section(lid_, "<worldbody>", "</worldbody>");
  const fs::path file = folder_.path() / "stack.xml";
  tinyxml2::XMLPrinter option(nullptr, true);
  assets::MjcfOption(&option);
  core::WriteFile(file, std::string("<mujoco><compiler angle=\"radian\"/>") + option.CStr() +
                            "<size njmax=\"5000\" nconmax=\"800\"/><asset>" + meshes +
                            "</asset><worldbody>" + bodies + "</worldbody></mujoco>");
  sim::MujocoWorld world(file);
  const std::vector<Isometry3d> start = Poses(count, lid);
  for (size_t i = 0; i < start.size(); ++i) world.SetPose(static_cast<int>(i), start[i]);
  while (world.time() < 0.5) world.Step();
  std::vector<Isometry3d> settled;
  for (size_t i = 0; i < start.size(); ++i) settled.push_back(world.Pose(static_cast<int>(i)));
  double drift = 0.0;
  while (world.time() < 2.5) {
    world.Step();
    for (size_t i = 0; i < start.size(); ++i) {
      const Isometry3d now = world.Pose(static_cast<int>(i));
      drift = std::max(drift, (now.translation() - settled[i].translation()).norm());
      EXPECT_LT((now.translation() - start[i].translation()).norm(), 3e-3);
    }
  }
  EXPECT_TRUE(world.warnings().empty()) << world.warnings()[0];
  return drift;
}

TEST_P(SteamerStack, StandsStillInBullet) {
  for (const bool lid : {false, true}) {
    EXPECT_LT(DriftInBullet(2, lid, 1.0 / 240.0), 1e-3) << lid;
    // The top of five creeps by a millimetre at 240 Hz.
    EXPECT_LT(DriftInBullet(kTallest, lid, 1e-3), 5e-4) << lid;
  }
}

TEST_P(SteamerStack, StandsStillInMujoco) {
  EXPECT_LT(DriftInMujoco(2, true), 1e-3);
  EXPECT_LT(DriftInMujoco(3, false), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Pipeline, SteamerStack, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace simwright::validation
