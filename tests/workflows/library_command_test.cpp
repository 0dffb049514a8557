// `simwright library` and the check of its assets; broken copies fail the right check.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "assets/articulated_folder.h"
#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "core/files.h"
#include "library/articulated/articulated_kinds.h"
#include "program.h"
#include "validation/check.h"
#include "validation/grasp_search.h"
#include "validation/joint_clearance.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

using assets::ArticulatedAsset;

// Writes the asset again and returns the failed checks.
std::vector<std::string> Failures(const ArticulatedAsset& asset) {
  const core::TemporaryFolder folder;
  assets::WriteArticulatedAsset(asset, folder.path());
  std::vector<std::string> failed;
  for (const core::Finding& row : validation::CheckAsset(folder.path()).results) {
    if (row.severity == core::Severity::kError) failed.push_back(row.code);
  }
  return failed;
}

bool Holds(const std::vector<std::string>& rows, const std::string& code) {
  return std::find(rows.begin(), rows.end(), code) != rows.end();
}

size_t IndexOf(const ArticulatedAsset& asset, const std::string& joint) {
  for (size_t i = 0; i < asset.joints.size(); ++i) {
    if (asset.joints[i].name == joint) return i;
  }
  throw core::Error("no such joint", joint);
}

TEST(LibraryCommand, MakesAssetsThatPassTheirCheck) {
  const core::TemporaryFolder folder;
  const std::string out = (folder.path() / "lib").string();
  for (const char* kind : {"light_switch", "toaster"}) {
    const Outcome made =
        RunProgram(std::string("library --kind ") + kind + " --seed 7 --quiet -o " + out);
    EXPECT_EQ(made.code, 0) << made.text;
    const fs::path asset = fs::path(out) / (std::string(kind) + "_7");
    for (const char* file : {"asset.json", "semantics.txt", "preview.png"}) {
      EXPECT_TRUE(fs::exists(asset / file)) << file;
    }
    const Outcome checked = RunProgram("check --quiet " + asset.string());
    EXPECT_EQ(checked.code, 0) << checked.text;
    EXPECT_NE(checked.text.find("swings-mujoco-"), std::string::npos);
  }
  // An existing output is not replaced without --force.
  const Outcome again = RunProgram("library --kind toaster --seed 7 --quiet -o " + out);
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.text.find("--force"), std::string::npos);
}

TEST(LibraryCommand, WrongUseIsOneLine) {
  const Outcome unknown = RunProgram("library --kind sofa --quiet -o /nowhere/lib");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_NE(unknown.text.find("microwave"), std::string::npos);
  EXPECT_EQ(std::count(unknown.text.begin(), unknown.text.end(), '\n'), 1);
  EXPECT_EQ(RunProgram("library --kind toaster").code, 1);
  const Outcome list = RunProgram("library --list");
  EXPECT_EQ(list.code, 0);
  EXPECT_GE(std::count(list.text.begin(), list.text.end(), '\n'), 12);
}

TEST(ArticulatedCheck, ADoorInItsBodyFails) {
  ArticulatedAsset asset = library::KindNamed("microwave").make({3, ""});
  asset.joints[IndexOf(asset, "door_joint")].parent_from_joint.translation().x() += 0.02;
  const auto failed = Failures(asset);
  EXPECT_TRUE(Holds(failed, "clearance-door_joint"));
  EXPECT_TRUE(Holds(failed, "swings-bullet-door_joint") ||
              Holds(failed, "swings-mujoco-door_joint"));
}

TEST(ArticulatedCheck, AJammedJointFails) {
  ArticulatedAsset asset = library::KindNamed("toaster").make({3, ""});
  asset.joints[IndexOf(asset, "lever_joint")].friction = 1000.0;  // a human exerts 200 N
  const auto failed = Failures(asset);
  EXPECT_TRUE(Holds(failed, "swings-bullet-lever_joint"));
  EXPECT_TRUE(Holds(failed, "swings-mujoco-lever_joint"));
  EXPECT_FALSE(Holds(failed, "swings-bullet-knob_joint"));
}

TEST(ArticulatedCheck, ALidWithoutFrictionFails) {
  ArticulatedAsset asset = library::KindNamed("laptop").make({3, ""});
  asset.joints[IndexOf(asset, "lid_joint")].friction = 0.0;
  const auto failed = Failures(asset);
  EXPECT_TRUE(Holds(failed, "holds-bullet-lid_joint"));
  EXPECT_TRUE(Holds(failed, "holds-mujoco-lid_joint"));
}

TEST(ArticulatedCheck, AForgedInertialFails) {
  ArticulatedAsset asset = library::KindNamed("toaster").make({3, ""});
  asset.links[0].inertial.inertia *= 1.01;
  EXPECT_TRUE(Holds(Failures(asset), "inertia-exact"));
}

// A single URDF of any origin: its joints are swept too, and a jammed one fails.
TEST(ArticulatedCheck, AUrdfWithJointsIsSwung) {
  ArticulatedAsset asset = library::KindNamed("laptop").make({4, ""});
  for (const bool jammed : {false, true}) {
    if (jammed) asset.joints[IndexOf(asset, "lid_joint")].friction = 1000.0;
    const core::TemporaryFolder folder;
    assets::WriteArticulatedAsset(asset, folder.path());
    const validation::CheckReport report = validation::CheckUrdf(folder.path() / "laptop.urdf", {});
    const auto row =
        std::find_if(report.results.begin(), report.results.end(),
                     [](const auto& finding) { return finding.code == "swings-bullet-lid_joint"; });
    ASSERT_NE(row, report.results.end());
    EXPECT_EQ(row->severity == core::Severity::kError, jammed);
    EXPECT_EQ(report.passed(), !jammed);
  }
}

// A bar 2 cm in front of a wall can be grasped from the front; one in a slot 4 cm wide cannot.
TEST(GraspSearch, FindsTheBarAndNotTheSlot) {
  const auto box = [](const Eigen::Vector3d& size, const Eigen::Vector3d& at) {
    core::TriangleMesh mesh = assets::BoxMesh(size);
    core::Transform(Eigen::Affine3d(Eigen::Translation3d(at)), &mesh);
    return mesh;
  };
  const std::vector<core::TriangleMesh> bar{box({0.012, 0.012, 0.15}, {0, 0, 0})};
  std::vector<core::TriangleMesh> walls{box({0.02, 1.0, 1.0}, {0.036, 0, 0})};
  EXPECT_GT(validation::SearchGrasps(bar, walls).found, 0);
  for (const double side : {-1.0, 1.0}) {
    walls.push_back(box({0.2, 0.5, 1.0}, {-0.075, side * 0.27, 0}));
  }
  for (const double side : {-1.0, 1.0}) {
    walls.push_back(box({0.2, 0.04, 0.5}, {-0.075, 0.0, side * 0.33}));
  }
  EXPECT_EQ(validation::SearchGrasps(bar, walls).found, 0);
}

// A door hinged at its rear face's outer edge keeps its gap of 3 mm to the body; hinged 3 cm
// further in, with the same closed pose, its edge swings into the body.
TEST(SweptClearance, TellsGoodHingesFromBad) {
  ArticulatedAsset asset = library::KindNamed("cabinet").make({2, ""});
  const size_t joint =
      IndexOf(asset, asset.features.at("doors") == "two" ? "door_0_joint" : "door_joint");
  const validation::Clearance good =
      validation::SweptClearance(assets::ModelOf(asset), static_cast<int>(joint));
  EXPECT_NEAR(good.distance, 0.003, 2e-4);
  const double in = asset.joints[joint].axis.z() < 0.0 ? -0.03 : 0.03;  // from +y, or from -y
  asset.joints[joint].parent_from_joint.translation().y() += in;
  for (core::TriangleMesh& part : asset.links[joint + 1].parts) {
    core::Transform(Eigen::Affine3d(Eigen::Translation3d(0, -in, 0)), &part);
  }
  EXPECT_LT(validation::SweptClearance(assets::ModelOf(asset), static_cast<int>(joint)).distance,
            -0.001);
}

}  // namespace
}  // namespace simwright::workflows
