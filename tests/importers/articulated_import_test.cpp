// `import` of PartNet-Mobility and GAPartNet folders and of other URDFs with joints. Resulting
// positions are compared with positions computed by hand.
#include "importers/articulated_import.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "assets/articulated_folder.h"
#include "assets/joint_poses.h"
#include "assets/semantic_model.h"
#include "core/error.h"
#include "core/files.h"
#include "geometry/weld.h"
#include "importers/collision_trimming.h"
#include "importers/link_folding.h"
#include "library/articulated/articulated_kinds.h"
#include "partnet_cabinet.h"
#include "tests/workflows/program.h"
#include "validation/joint_clearance.h"

namespace simwright::importers {
namespace {
namespace fs = std::filesystem;

using assets::ArticulatedAsset;

constexpr double kHeight = 0.8;                   // m
const Eigen::Vector3d kHandle(0.41, -0.2, 0.49);  // centre of the door's, in the files' frame

size_t LinkIndex(const ArticulatedAsset& asset, const std::string& name) {
  for (size_t i = 0; i < asset.links.size(); ++i) {
    if (asset.links[i].name == name) return i;
  }
  throw core::Error("no such link", name);
}

int Count(const core::Findings& findings, const std::string& code) {
  return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                        [&](const auto& f) { return f.code == code; }));
}

// Returns the poses with the door opened to the fraction `share` of its range.
std::vector<Eigen::Isometry3d> PosesAt(const ArticulatedAsset& asset, double share) {
  const double upper = asset.joints[LinkIndex(asset, "link_0") - 1].upper;
  return assets::LinkPoses(assets::ModelOf(asset), {{"joint_0", share * upper}});
}

double NearestVertex(const core::TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double nearest = 1e9;
  for (const Eigen::Vector3d& v : mesh.vertices) nearest = std::min(nearest, (v - point).norm());
  return nearest;
}

class ImportedCabinet : public ::testing::Test {
 protected:
  ArticulatedAsset Import(bool gapartnet) {
    const fs::path source = folder_.path() / "45267";
    PartnetCabinet(source).Write(gapartnet);
    const std::string out = (folder_.path() / "out").string();
    const Outcome made =
        RunProgram("import " + source.string() + " --height 0.8 --quiet -o " + out);
    EXPECT_EQ(made.code, 0) << made.text;
    const Outcome checked = RunProgram("check --quiet " + out + "/45267");
    EXPECT_EQ(checked.code, 0) << checked.text;
    check_ = checked.text;
    return assets::ReadArticulatedAsset(fs::path(out) / "45267");
  }
  // Corners of the door's and the drawer's handles, against the hand computation.
  static void ExpectCorners(const ArticulatedAsset& asset, const std::string& holder,
                            double share) {
    const auto poses = PosesAt(asset, share);
    const double angle = share * std::numbers::pi / 2.0;
    const size_t link = LinkIndex(asset, holder);
    for (const Eigen::Vector3d& corner :
         {Eigen::Vector3d(.42, -.3, .50), Eigen::Vector3d(.40, -.1, .48)}) {
      const Eigen::Vector3d wanted =
          PartnetCabinet::InRoot(PartnetCabinet::OnDoor(corner, angle), kHeight);
      EXPECT_LT(NearestVertex(asset.links[link].visual.mesh, poses[link].inverse() * wanted), 1e-6)
          << share;
    }
  }
  core::TemporaryFolder folder_;
  std::string check_;
};

TEST_F(ImportedCabinet, StandsAtItsHeightWithItsJointsWhereTheyBelong) {
  const ArticulatedAsset asset = Import(false);
  const Eigen::AlignedBox3d box = assets::BoundsAtZero(asset);
  EXPECT_NEAR(box.sizes().z(), kHeight, 1e-6);
  EXPECT_NEAR(box.min().z(), 0.0, 1e-6);
  EXPECT_NEAR(box.center().x(), 0.0, 1e-6);
  EXPECT_NEAR(box.center().y(), 0.0, 1e-6);
  ASSERT_EQ(asset.links.size(), 3u);
  EXPECT_EQ(asset.links[0].name, "link_2");
  EXPECT_FALSE(asset.fixed);

  const assets::Joint& door = asset.joints[LinkIndex(asset, "link_0") - 1];
  EXPECT_EQ(door.type, assets::JointType::kRevolute);
  EXPECT_LT(
      (door.parent_from_joint.translation() - PartnetCabinet::InRoot({-.5, 0, .4}, kHeight)).norm(),
      1e-9);
  EXPECT_LT((door.axis - Eigen::Vector3d(0, 0, -1)).norm(), 1e-9);
  EXPECT_NEAR(door.upper, std::numbers::pi / 2.0, 1e-12);
  const assets::Joint& drawer = asset.joints[LinkIndex(asset, "link_1") - 1];
  EXPECT_LT((drawer.axis - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-9);
  EXPECT_NEAR(drawer.upper, 0.48 * kHeight / 1.2, 1e-9);  // metres, not the file's units
  for (const double share : {0.0, 0.5, 1.0}) ExpectCorners(asset, "link_0", share);
}

TEST_F(ImportedCabinet, WeighsWhatItsKindDoesAndKeepsItsMeaning) {
  const ArticulatedAsset asset = Import(false);
  double mass = 0.0, volume = 0.0;
  for (const assets::ArticulatedLink& link : asset.links) {
    mass += link.inertial.mass;
    volume += link.volume;
  }
  EXPECT_GE(mass, 8.0);  // physics_params/data/categories.txt: cabinet
  EXPECT_LE(mass, 70.0);
  for (const assets::ArticulatedLink& link : asset.links) {  // split by volume
    EXPECT_NEAR(link.inertial.mass / mass, link.volume / volume, 1e-9) << link.name;
  }
  EXPECT_EQ(asset.parameters.category, "cabinet");
  const assets::SemanticModel model = assets::ReadSemanticModel(folder_.path() / "out" / "45267");
  EXPECT_EQ(model.semantics.at("link_0").joint, "hinge");
  EXPECT_EQ(model.semantics.at("link_0").label, "door");
  EXPECT_EQ(model.semantics.at("link_1").joint, "slider");
  EXPECT_EQ(model.semantics.at("link_1").label, "drawer");
  EXPECT_EQ(model.semantics.at("link_2").label, "body");
  for (const assets::Joint& joint : asset.joints) {
    EXPECT_GT(joint.friction, 0.0);
    EXPECT_GT(joint.damping, 0.0);
  }
  EXPECT_EQ(Count(asset.findings, "urdf-missing-mesh"), 1);
  // The door's rear face lay 0.002 units inside the body: it was trimmed to a gap of 3 mm.
  EXPECT_EQ(Count(asset.findings, "trimmed"), 1);
  const double deepest =
      std::find_if(asset.findings.begin(), asset.findings.end(), [](const auto& f) {
        return f.code == "trimmed";
      })->figure;
  EXPECT_NEAR(deepest, 1e3 * 0.002 * kHeight / 1.2, 0.05);
  const int joint = static_cast<int>(LinkIndex(asset, "link_0")) - 1;
  EXPECT_NEAR(validation::SweptClearance(assets::ModelOf(asset), joint).distance, 3e-3, 1e-5);
}

TEST_F(ImportedCabinet, OfGapartnetKeepsItsHandleAsALink) {
  const ArticulatedAsset asset = Import(true);
  ASSERT_EQ(asset.links.size(), 4u);
  const size_t handle = LinkIndex(asset, "link_3");
  EXPECT_EQ(asset.links[handle].label, "handle");
  EXPECT_EQ(asset.links[LinkIndex(asset, "link_0")].label, "door");
  EXPECT_EQ(asset.joints[handle - 1].type, assets::JointType::kFixed);
  EXPECT_EQ(asset.joints[handle - 1].parent, "link_0");
  EXPECT_NE(check_.find("grasp-link_3"), std::string::npos);
  // Its frame lies at the centre of its bounding box; posts reach back to z = 0.44.
  const Eigen::Vector3d middle(kHandle.x(), kHandle.y(), 0.47);
  for (const double share : {0.0, 0.5}) {
    const Eigen::Vector3d wanted = PartnetCabinet::InRoot(
        PartnetCabinet::OnDoor(middle, share * std::numbers::pi / 2.0), kHeight);
    EXPECT_LT((PosesAt(asset, share)[handle].translation() - wanted).norm(), 1e-9);
    ExpectCorners(asset, "link_3", share);
  }
}

TEST_F(ImportedCabinet, TakesItsCategorysSizeWhereNoHeightIsGiven) {
  const fs::path source = folder_.path() / "45267";
  PartnetCabinet(source).Write(false);
  const fs::path urdf = ArticulatedUrdfIn(source);
  core::Progress progress;
  const ArticulatedAsset a =
      ImportArticulated(urdf, {.name = "a", .category = "", .seed = 3}, &progress);
  const ArticulatedAsset b =
      ImportArticulated(urdf, {.name = "a", .category = "", .seed = 3}, &progress);
  const ArticulatedAsset c =
      ImportArticulated(urdf, {.name = "a", .category = "", .seed = 4}, &progress);
  const Eigen::Vector3d size = assets::BoundsAtZero(a).sizes();
  const double box = std::cbrt(size.prod());
  EXPECT_GT(box, std::cbrt(0.28 * 0.28 * 0.42));  // the category's extreme sizes
  EXPECT_LT(box, std::cbrt(1.35 * 0.85 * 2.20));
  EXPECT_EQ(a.links[1].inertial.mass, b.links[1].inertial.mass);
  EXPECT_NE(size.z(), assets::BoundsAtZero(c).sizes().z());
}

// URDFs of boxes in metres, stacked above the body.
class BoxUrdf : public ::testing::Test {
 protected:
  static std::string Link(const std::string& name, double z) {
    const std::string shape = "<origin xyz='0 0 " + std::to_string(z) +
                              "'/><geometry><box size='0.2 0.2 0.1'/></geometry>";
    return "<link name='" + name + "'><visual>" + shape + "</visual></link>";
  }
  static std::string Joint(const std::string& type, const std::string& parent,
                           const std::string& child, const std::string& more) {
    return "<joint name='j_" + child + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><axis xyz='0 0 1'/>" + more + "</joint>";
  }
  fs::path Write(const std::string& body) const {
    const fs::path file = folder_.path() / "thing.urdf";
    std::ofstream(file) << "<robot name='thing'>" << body << "</robot>";
    return file;
  }
  ArticulatedAsset Import(const std::string& body) const {
    core::Progress progress;
    return ImportArticulated(Write(body), {.name = "thing", .category = "box"}, &progress);
  }
  // One line, exit 1, nothing written.
  void ExpectRefused(const std::string& body, const std::string& words) const {
    const fs::path out = folder_.path() / "out";
    const Outcome outcome =
        RunProgram("import --quiet " + Write(body).string() + " -o " + out.string());
    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << outcome.text;
    EXPECT_FALSE(fs::exists(out));
  }
  static std::string Range(double lower, double upper) {
    return "<limit lower='" + std::to_string(lower) + "' upper='" + std::to_string(upper) + "'/>";
  }
  core::TemporaryFolder folder_;
};

TEST_F(BoxUrdf, WhatCannotBeAnAssetIsOneLine) {
  const std::string two = Link("a", 0.05) + Link("b", 0.2);
  ExpectRefused(two + Joint("floating", "a", "b", ""), "floating");
  ExpectRefused(two + Joint("planar", "a", "b", ""), "planar");
  ExpectRefused(two + Joint("revolute", "a", "b", ""), "limits");
  ExpectRefused(Link("a", 0.05) + "<link name='b'/>" + Joint("continuous", "a", "b", ""), "'b'");
  ExpectRefused("<link name='a'/><link name='b'/>" + Joint("continuous", "a", "b", ""), "shape");
  std::string chain = Link("l0", 0.05);
  for (int i = 1; i <= 500; ++i) {
    chain += Link("l" + std::to_string(i), 0.05 + 0.12 * i) +
             Joint("revolute", "l" + std::to_string(i - 1), "l" + std::to_string(i), Range(0, 1));
  }
  ExpectRefused(chain, "500 moving joints");
}

// Files attach an asset to an empty "world" by its first joint: it is fixed at that joint.
TEST_F(BoxUrdf, ARootWithoutShapeIsMarkedAndHeld) {
  const ArticulatedAsset asset = Import("<link name='world'/>" + Link("b", 0.2) +
                                        Joint("continuous", "world", "b", "<origin xyz='0 0 1'/>"));
  ASSERT_EQ(asset.links.size(), 2u);
  EXPECT_EQ(asset.links[0].name, "world_link");  // MuJoCo reserves "world"
  EXPECT_TRUE(asset.fixed);
  EXPECT_EQ(Count(asset.findings, "root-marked"), 1);
  // One cube, small relative to the box, around the file's origin, 1 m below the joint.
  const Eigen::AlignedBox3d cube = core::Bounds(asset.links[0].parts.at(0));
  const Eigen::AlignedBox3d box = core::Bounds(asset.links[1].parts.at(0));
  EXPECT_LT(cube.sizes().maxCoeff(), 0.1 * box.diagonal().norm());
  const double joint_height = asset.joints[0].parent_from_joint.translation().z();
  EXPECT_NEAR(joint_height - cube.center().z(), 1.0, 1e-9);
}

// The author's collision meshes become the parts, unless they repeat the visuals.
TEST_F(BoxUrdf, CollisionsOfTheirOwnAreTheParts) {
  const std::string seen =
      "<link name='b'><visual><origin xyz='0 0 0.2'/><geometry><box size='0.1 0.1 0.1'/></geometry>"
      "</visual>";
  const auto volume = [&](const std::string& collision) {
    const ArticulatedAsset asset =
        Import(Link("a", 0.05) + seen + collision + "</link>" + Joint("continuous", "a", "b", ""));
    double sum = 0.0;
    for (const auto& part : asset.links[1].parts) sum += geometry::SignedVolume(part);
    return sum;
  };
  EXPECT_NEAR(volume(""), 1e-3, 1e-6);
  EXPECT_NEAR(volume("<collision><origin xyz='0 0 0.2'/><geometry><box size='0.08 0.05 0.1'/>"
                     "</geometry></collision>"),
              4e-4, 1e-6);
}

TEST_F(BoxUrdf, JointsFollowOurConventions) {
  const ArticulatedAsset asset =
      Import(Link("a", 0.05) + Link("down", 0.16) + Link("wheel", 0.28) + Link("mime", 0.40) +
             Link("late", 0.52) + Joint("revolute", "a", "down", Range(-1.5, 0)) +
             Joint("prismatic", "a", "late", "<origin xyz='0 0 0'/>" + Range(0.1, 0.3)) +
             Joint("revolute", "a", "mime", "<mimic joint='j_down'/>" + Range(0, 1)) +
             Joint("continuous", "a", "wheel", ""));
  const auto joint = [&](const std::string& link) {
    return asset.joints[LinkIndex(asset, link) - 1];
  };
  EXPECT_EQ(joint("down").axis, -Eigen::Vector3d::UnitZ());
  EXPECT_DOUBLE_EQ(joint("down").lower, 0.0);
  EXPECT_DOUBLE_EQ(joint("down").upper, 1.5);
  EXPECT_DOUBLE_EQ(joint("late").lower, 0.0);
  EXPECT_NEAR(joint("late").upper, 0.2, 1e-12);
  EXPECT_NEAR(joint("late").parent_from_joint.translation().z(), 0.1, 1e-12);
  EXPECT_FALSE(joint("mime").mimic);
  EXPECT_EQ(joint("wheel").type, assets::JointType::kContinuous);
  for (const char* code : {"joint-turned", "joint-zero", "joint-mimic"}) {
    EXPECT_EQ(Count(asset.findings, code), 1) << code;
  }
}

// A chain of empty frames between shapes: the visuals do not move.
TEST_F(BoxUrdf, FramesWithoutShapesAreFoldedAway) {
  const std::string lift = "<origin xyz='0.1 0 0.3' rpy='0 0 0.5'/>";
  const fs::path file =
      Write("<link name='world'/>" + Link("a", 0.05) + "<link name='f1'/><link name='f2'/>" +
            Link("b", 0.3) + "<link name='tip'/>" + Joint("fixed", "world", "a", lift) +
            Joint("fixed", "a", "f1", lift) + Joint("revolute", "f1", "f2", lift + Range(0, 1)) +
            Joint("fixed", "f2", "b", lift) + Joint("fixed", "b", "tip", lift));
  assets::UrdfModel model = assets::ReadUrdf(file);
  const auto before = assets::LinkPosesAtZero(model);
  Eigen::Vector3d corner;
  for (size_t i = 0; i < model.links.size(); ++i) {
    if (model.links[i].name == "b") corner = before[i] * model.links[i].visuals[0].mesh.vertices[0];
  }
  FoldEmptyLinks(&model);
  ASSERT_EQ(model.links.size(), 2u);
  EXPECT_EQ(model.links[0].name, "a");
  EXPECT_EQ(model.links[1].name, "b");
  EXPECT_EQ(model.joints[0].parent, "a");
  const auto after = assets::LinkPosesAtZero(model);
  EXPECT_LT((after[1] * model.links[1].visuals[0].mesh.vertices[0] - corner).norm(), 1e-12);
  // The axis stays where f2 has it: three offsets from the world, each rotated by the previous
  // ones.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    pose =
        pose * Eigen::Translation3d(0.1, 0, 0.3) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  }
  EXPECT_LT((after[1].translation() - pose.translation()).norm(), 1e-12);
}

// Masses of a file in metres apply; the lid's 3 kg load its hinge.
TEST_F(BoxUrdf, MassesOfTheFileCountAndWeightIsHeld) {
  const auto inertial = [](double mass) {
    return "<inertial><mass value='" + std::to_string(mass) +
           "'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>";
  };
  const auto with = [&](std::string link, double mass) {
    return link.substr(0, link.size() - 7) + inertial(mass);
  };
  const ArticulatedAsset asset =
      Import(with(Link("a", 0.05), 5.0) + with(Link("lid", 0.051), 3.0) +
             "<joint name='j' type='revolute'><origin xyz='0.1 0 0.101'/><parent link='a'/>"
             "<child link='lid'/><axis xyz='0 1 0'/><limit lower='0' upper='1.5'/></joint>");
  EXPECT_NEAR(asset.links[0].inertial.mass, 5.0, 1e-9);
  EXPECT_NEAR(asset.links[1].inertial.mass, 3.0, 1e-6);
  // The lid's centre lies 0.051 above its hinge at x: the lever arm is greatest at 1.5.
  const double most = 3.0 * 9.81 * 0.051 * std::sin(1.5);
  EXPECT_NEAR(asset.joints[0].friction, std::max(1.3 * most, asset.joints[0].friction), 1e-9);
  EXPECT_GE(asset.joints[0].friction, 1.3 * most * 0.999);
}

// A handle without an <inertial> does not discard the masses of the others, and a mass in the
// body's base that its shape does not explain is reported.
TEST_F(BoxUrdf, AMassThatIsMissingIsGuessedAlone) {
  const auto with = [](std::string link, double mass, const char* origin) {
    return link.substr(0, link.size() - 7) + "<inertial><origin xyz='" + origin +
           "'/><mass value='" + std::to_string(mass) +
           "'/><inertia ixx='.1' iyy='.1' izz='.1' ixy='0' ixz='0' iyz='0'/></inertial></link>";
  };
  const ArticulatedAsset asset = Import(
      with(Link("a", 0.05), 12.0, "0 0 0.01") + with(Link("b", 0.16), 4.0, "0 0 0.16") +
      Link("c", 0.27) + Joint("continuous", "a", "b", "") + Joint("continuous", "b", "c", ""));
  EXPECT_NEAR(asset.links[0].inertial.mass, 12.0, 1e-9);
  EXPECT_NEAR(asset.links[1].inertial.mass, 4.0, 1e-9);
  EXPECT_NEAR(asset.links[2].inertial.mass, 8.0, 1e-6);  // the mean of equal boxes
  EXPECT_EQ(Count(asset.findings, "urdf-mass-guessed"), 1);
  ASSERT_EQ(Count(asset.findings, "inertial-replaced"), 1);
  for (const core::Finding& finding : asset.findings) {
    if (finding.code != "inertial-replaced") continue;
    EXPECT_NEAR(finding.figure, 40.0, 0.5);
  }
}

// The library's own drawer unit, imported as a foreign URDF: boards touch along their edges, and
// frames and masses do not change.
TEST(ImportedLibrary, ADrawerUnitComesBack) {
  const core::TemporaryFolder folder;
  const ArticulatedAsset before = library::KindNamed("drawer_unit").make({1, "unit"});
  assets::WriteArticulatedAsset(before, folder.path());
  core::Progress progress;
  const ArticulatedAsset after =
      ImportArticulated(folder.path() / "unit.urdf", {.name = "unit", .category = ""}, &progress);
  ASSERT_EQ(after.links.size(), before.links.size());
  for (const assets::ArticulatedLink& link : before.links) {
    const size_t i = LinkIndex(after, link.name), k = LinkIndex(before, link.name);
    EXPECT_NEAR(after.links[i].inertial.mass, link.inertial.mass, 1e-6) << link.name;
    EXPECT_EQ(after.links[i].label, link.label);
    if (k == 0 || !before.joints[k - 1].Moves()) continue;
    EXPECT_LT((after.joints[i - 1].axis - before.joints[k - 1].axis).norm(), 1e-9);
    EXPECT_NEAR(after.joints[i - 1].upper, before.joints[k - 1].upper, 1e-9);
    EXPECT_GT(validation::SweptClearance(assets::ModelOf(after), static_cast<int>(i) - 1).distance,
              2e-3);
  }
}

// A slab 3 mm deep in the body is trimmed; one 20 mm deep is excluded from contact.
TEST_F(BoxUrdf, OnlyLittleOverlapsAreTrimmed) {
  for (const auto& [z, trimmed] : {std::pair{0.147, 1}, {0.13, 0}}) {
    const ArticulatedAsset asset =
        Import(Link("a", 0.05) + Link("b", z) + Joint("revolute", "a", "b", Range(0, 1)));
    EXPECT_EQ(Count(asset.findings, "trimmed"), trimmed);
    EXPECT_EQ(Count(asset.findings, "contact-excluded"), 1 - trimmed);
    EXPECT_EQ(asset.excluded_pairs.size(), trimmed ? 0u : 1u);
    const double clearance = validation::SweptClearance(assets::ModelOf(asset), 0).distance;
    if (trimmed) {
      EXPECT_NEAR(clearance, 3e-3, 1e-6);
    }
  }
}

}  // namespace
}  // namespace simwright::importers
