// Small URDFs with the faults of real ones: overlap at the hinge, a lid that swings below the
// floor, a handle inside its door, drawers inside each other, assets that fall over in their given
// pose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/joint_poses.h"
#include "assets/obj_file.h"
#include "assets/primitive_meshes.h"
#include "core/files.h"
#include "importers/articulated_import.h"
#include "importers/joint_friction.h"
#include "sim/articulated_world.h"
#include "sim/joint_rig.h"
#include "tests/workflows/program.h"
#include "validation/joint_clearance.h"

namespace simwright::importers {
namespace {
namespace fs = std::filesystem;

using assets::ArticulatedAsset;

class UrdfFaults : public ::testing::Test {
 protected:
  static std::string Box(double x, double y, double z, const std::string& size) {
    char origin[120];
    std::snprintf(origin, sizeof(origin), "<visual><origin xyz='%g %g %g'/>", x, y, z);
    return origin + ("<geometry><box size='" + size + "'/></geometry></visual>");
  }
  static std::string Link(const std::string& name, const std::string& shapes) {
    return "<link name='" + name + "'>" + shapes + "</link>";
  }
  static std::string Joint(const std::string& type, const std::string& child,
                           const std::string& origin, const std::string& axis, double lower,
                           double upper, const std::string& parent = "body") {
    return "<joint name='" + child + "_joint' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='" + origin + "'/><axis xyz='" + axis +
           "'/><limit lower='" + std::to_string(lower) + "' upper='" + std::to_string(upper) +
           "'/></joint>";
  }
  ArticulatedAsset Import(const std::string& body, const std::string& category = "box") const {
    const fs::path file = folder_.path() / "thing.urdf";
    std::ofstream(file) << "<robot name='thing'>" << body << "</robot>";
    core::Progress progress;
    return ImportArticulated(file, {.name = "thing", .category = category}, &progress);
  }
  // Imports and checks it with the program, and returns the asset.
  ArticulatedAsset Pass(const std::string& body, const std::string& category = "box") const {
    Import(body, category);
    const std::string file = (folder_.path() / "thing.urdf").string();
    const std::string out = (folder_.path() / "out").string();
    const Outcome made =
        RunProgram("import --force --category " + category + " " + file + " -o " + out);
    EXPECT_EQ(made.code, 0) << made.text;
    const Outcome checked = RunProgram("check " + out + "/thing");
    EXPECT_EQ(checked.code, 0) << checked.text;
    return assets::ReadArticulatedAsset(fs::path(out) / "thing");
  }
  static int Count(const core::Findings& findings, const std::string& code) {
    return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                          [&](const auto& f) { return f.code == code; }));
  }
  static double Figure(const core::Findings& findings, const std::string& code) {
    const auto found = std::find_if(findings.begin(), findings.end(),
                                    [&](const auto& f) { return f.code == code; });
    return found == findings.end() ? std::nan("") : found->figure;
  }
  core::TemporaryFolder folder_;
};

// A cube whose door penetrates it by `depth` at the hinge.
std::string SunkDoor(double depth) {
  return "<link name='body'><visual><origin xyz='0 0 0.15'/><geometry><box size='0.3 0.3 0.3'/>"
         "</geometry></visual></link><link name='door'><visual><origin xyz='0 0.15 0'/><geometry>"
         "<box size='0.02 0.29 0.28'/></geometry></visual></link><joint name='door_joint' "
         "type='revolute'><parent link='body'/><child link='door'/><origin xyz='" +
         std::to_string(-0.16 + depth) +
         " -0.15 0.15'/><axis xyz='0 0 1'/><limit lower='0' upper='1.5'/></joint>";
}

TEST_F(UrdfFaults, OverlapAtTheHingeIsExcludedAndSaid) {
  const ArticulatedAsset asset = Pass(SunkDoor(0.012));
  ASSERT_EQ(asset.excluded_pairs.size(), 1u);
  EXPECT_EQ(Count(asset.findings, "contact-excluded"), 1);
  EXPECT_NEAR(Figure(asset.findings, "contact-excluded"), 12.0, 0.01);  // mm, as built
  EXPECT_FALSE(std::isfinite(validation::SweptClearance(assets::ModelOf(asset), 0).distance));
  // A door that only touches keeps its contacts.
  EXPECT_TRUE(Import(SunkDoor(-0.004)).excluded_pairs.empty());
}

TEST_F(UrdfFaults, JointsWithoutDynamicsAreSaidWithTheirValues) {
  const ArticulatedAsset asset = Import(SunkDoor(-0.004));
  ASSERT_EQ(Count(asset.findings, "joint-guessed"), 1);
  EXPECT_EQ(Figure(asset.findings, "joint-guessed"), 1.0);
  EXPECT_EQ(Count(asset.findings, "joint-friction-raised"), 0);
  const auto said = std::find_if(asset.findings.begin(), asset.findings.end(),
                                 [](const auto& f) { return f.code == "joint-guessed"; });
  char friction[48], velocity[48];
  std::snprintf(friction, sizeof friction, "'door_joint': friction %.3g N m, damping",
                asset.joints[0].friction);
  std::snprintf(velocity, sizeof velocity, "velocity %.3g rad/s", asset.joints[0].velocity);
  EXPECT_NE(said->sentence.find(friction), std::string::npos) << said->sentence;
  EXPECT_NE(said->sentence.find(velocity), std::string::npos) << said->sentence;
  EXPECT_NE(said->remedy.find("<dynamics"), std::string::npos);
}

TEST_F(UrdfFaults, StatedDynamicsAreKeptOrTheirRaiseIsSaid) {
  const auto with = [](const std::string& friction, const std::string& axis) {
    std::string urdf = SunkDoor(-0.004);
    const std::string limit = "<limit lower='0' upper='1.5'/>", z = "<axis xyz='0 0 1'/>";
    urdf.replace(urdf.find(limit), limit.size(),
                 "<dynamics damping='0.1' friction='" + friction +
                     "'/><limit lower='0' upper='1.5' effort='9' velocity='2'/>");
    urdf.replace(urdf.find(z), z.size(), "<axis xyz='" + axis + "'/>");
    return urdf;
  };
  const ArticulatedAsset stated = Import(with("0.4", "0 0 1"));
  EXPECT_EQ(Count(stated.findings, "joint-guessed"), 0);
  EXPECT_EQ(Count(stated.findings, "joint-friction-raised"), 0);
  EXPECT_EQ(stated.joints[0].friction, 0.4);
  EXPECT_EQ(stated.joints[0].effort, 9.0);
  // The flap lies on a level hinge: the file's friction does not hold it.
  const ArticulatedAsset raised = Import(with("0.001", "1 0 0"));
  EXPECT_EQ(Count(raised.findings, "joint-friction-raised"), 1);
  EXPECT_GT(raised.joints[0].friction, 0.001);
}

// In both engines the excluded pair has no contact, and all other contacts remain.
TEST_F(UrdfFaults, EnginesHeedTheExclusion) {
  const ArticulatedAsset asset = Pass(SunkDoor(0.012));
  const fs::path mjcf = folder_.path() / "out" / "thing" / "thing.xml";
  for (const bool excluded : {true, false}) {
    assets::UrdfModel model = assets::ModelOf(asset);
    if (!excluded) model.excluded_pairs.clear();
    const sim::ArticulatedBody body = sim::ArticulatedBodyFrom(model);
    const auto rig = sim::BulletRig(body);
    rig->Step();
    EXPECT_EQ(rig->Touching().empty(), excluded);
  }
  const auto mujoco = sim::MujocoRig(sim::ArticulatedBodyFrom(assets::ModelOf(asset)), mjcf);
  mujoco->Step();
  EXPECT_TRUE(mujoco->Touching().empty());
}

// A lid 0.2 m long whose hinge is 0.1 m above the floor and whose file lets it swing straight down:
// it may rotate from level until its far lower edge touches the floor.
TEST_F(UrdfFaults, ALidEndsAtTheFloor) {
  const ArticulatedAsset asset = Pass(Link("body", Box(0, 0, 0.05, "0.3 0.3 0.1")) +
                                      Link("lid", Box(0.11, 0, 0.005, "0.18 0.2 0.01")) +
                                      Joint("revolute", "lid", "0.16 0 0.11", "0 1 0", 0.0, 1.5));
  ASSERT_EQ(Count(asset.findings, "joint-cut"), 1);
  EXPECT_FALSE(asset.fixed);
  // The lower edge at radius 0.2 and the hinge's height of 0.11: sin(angle) = 0.11 / 0.2, and a
  // little more for the trimmed overlap (at most 5 mm).
  const double touch = std::asin(0.11 / 0.2);
  EXPECT_GT(asset.joints[0].upper, touch - 0.02);
  EXPECT_LT(asset.joints[0].upper, touch + 0.06);
  EXPECT_GT(validation::LowestOnSweep(assets::ModelOf(asset), 0), 0.0);
}

// Its only joint would penetrate the floor immediately: the asset is mounted.
TEST_F(UrdfFaults, WhatCannotStandIsHeld) {
  const ArticulatedAsset asset =
      Import(Link("body", Box(0, 0, 0.05, "0.3 0.3 0.1")) +
             Link("drop", Box(0, 0, 0.0, "0.05 0.05 0.08")) +
             Joint("prismatic", "drop", "0.2 0 0.045", "0 0 -1", 0.0, 0.5));
  EXPECT_TRUE(asset.fixed);
  EXPECT_EQ(Count(asset.findings, "held"), 1);
  EXPECT_NEAR(asset.joints[0].upper, 0.5, 1e-12);
}

// The handle's bar lies 8 mm inside the door that it is fixed to and moves with: no fault.
TEST_F(UrdfFaults, AHandleInsideItsDoorIsNoOverlap) {
  const ArticulatedAsset asset =
      Pass(Link("body", Box(0, 0, 0.15, "0.3 0.3 0.3")) +
           Link("door", Box(0, 0.15, 0, "0.02 0.29 0.28")) +
           Link("handle", Box(0, 0, 0, "0.04 0.02 0.1")) +
           Joint("revolute", "door", "-0.165 -0.15 0.15", "0 0 1", 0.0, 1.5) +
           "<joint name='h' type='fixed'><parent link='door'/><child link='handle'/>"
           "<origin xyz='-0.022 0.25 0'/></joint>");
  EXPECT_TRUE(asset.excluded_pairs.empty());
}

// Two drawers, the lower one 9 mm inside the upper: neither is the other's parent.
TEST_F(UrdfFaults, NestedDrawersAreExcludedByName) {
  const std::string shell = Box(0.14, 0, 0.2, "0.02 0.4 0.4") + Box(0, 0.19, 0.2, "0.26 0.02 0.4") +
                            Box(0, -0.19, 0.2, "0.26 0.02 0.4");
  const ArticulatedAsset asset =
      Pass(Link("body", shell) + Link("upper", Box(0, 0, 0, "0.24 0.3 0.1")) +
               Link("lower", Box(0, 0, 0, "0.24 0.3 0.1")) +
               Joint("prismatic", "upper", "0 0 0.25", "-1 0 0", 0.0, 0.2) +
               Joint("prismatic", "lower", "0 0 0.159", "-1 0 0", 0.0, 0.2),
           "cabinet");
  EXPECT_EQ(Count(asset.findings, "overlap-excluded"), 1);
  EXPECT_NEAR(Figure(asset.findings, "overlap-excluded"), 9.0, 0.01);
  ASSERT_EQ(asset.excluded_pairs.size(), 1u);
}

// A thick drop-down door of a cabinet with thin walls gets most of a mass that is split by volume:
// a human could not lift it. The total mass is kept.
TEST_F(UrdfFaults, ADoorThatNoHandCouldLiftIsLightened) {
  const std::string file =
      Link("body", Box(-0.3, 0, 0.4, "0.02 0.6 0.8") + Box(0, 0, 0.01, "0.6 0.6 0.02")) +
      Link("door", Box(0.05, 0, 0.35, "0.1 0.6 0.7")) +
      Joint("revolute", "door", "0.35 0 0.12", "0 1 0", 0.0, 1.4);
  const ArticulatedAsset asset = Import(file, "dishwasher");
  ASSERT_EQ(Count(asset.findings, "lightened"), 1);
  const double moved = Figure(asset.findings, "lightened");
  EXPECT_GT(moved, 1.0);
  // 60 N m lift it with a tenth to spare: its weight, and friction of 1.3 times that.
  EXPECT_NEAR(GreatestLoad(asset, 0), 0.9 * 60.0 / 2.3, 0.01);
  const double whole = asset.links[0].inertial.mass + asset.links[1].inertial.mass;
  EXPECT_NEAR(whole, asset.parameters.mass.sample, 1e-6);
  // Split by volume, the door had this share of the same total.
  const double share = 0.042 / (0.042 + 0.0096 + 0.0072);
  EXPECT_NEAR(asset.links[1].inertial.mass + moved, share * whole, 0.02 * whole);
}

// A slider whose range reaches into another free-standing link: the range ends before it.
TEST_F(UrdfFaults, ASliderEndsBeforeWhatIsInItsWay) {
  const ArticulatedAsset asset = Import(
      Link("body", Box(0, 0, 0.01, "0.6 0.3 0.02")) +
      Link("button", Box(0, 0, 0, "0.04 0.04 0.04")) + Link("stop", Box(0, 0, 0, "0.04 0.1 0.1")) +
      Joint("prismatic", "button", "0 0 0.05", "1 0 0", 0.0, 0.25) +
      Joint("prismatic", "stop", "0.2 0 0.08", "0 1 0", 0.0, 0.05));
  EXPECT_EQ(Count(asset.findings, "joint-cut"), 1);
  const auto& joint = asset.joints[asset.links[1].name == "button" ? 0 : 1];
  EXPECT_NEAR(joint.upper, 0.16, 0.006);  // the gap, and what is trimmed
}

// A light box whose heavy door moves the centre of mass beyond its front when it opens.
TEST_F(UrdfFaults, WhatTipsWhenOpenedIsHeld) {
  const auto cabinet = [&](const std::string& door) {
    return Import(Link("body", Box(0, 0, 0.2, "0.1 0.3 0.4")) +
                  Link("door", Box(0, 0.14, 0, door)) +
                  Joint("revolute", "door", "-0.075 -0.14 0.2", "0 0 1", 0.0, 1.5));
  };
  // The total volume is 0.012 m3, and the open door moves the centre beyond x = -0.05.
  const ArticulatedAsset heavy = cabinet("0.04 0.28 0.38");
  EXPECT_TRUE(heavy.fixed);
  EXPECT_EQ(Count(heavy.findings, "held"), 1);
  EXPECT_LT(Figure(heavy.findings, "held"), 5.5);
  EXPECT_FALSE(cabinet("0.01 0.28 0.38").fixed);
}

TEST_F(UrdfFaults, AFloatingBaseIsTheRoot) {
  const ArticulatedAsset asset = Import(
      "<link name='world'/>" + Link("body", Box(0, 0, 0.1, "0.2 0.2 0.2")) +
      Link("lid", Box(0, 0, 0, "0.1 0.1 0.02")) +
      "<joint name='free' type='floating'><parent link='world'/><child link='body'/></joint>" +
      Joint("prismatic", "lid", "0 0 0.22", "0 0 1", 0, 0.1));
  EXPECT_EQ(asset.links.size(), 2u);
  EXPECT_EQ(asset.links[0].name, "body");
  EXPECT_EQ(Count(asset.findings, "floating-base"), 1);
}

// A gallows whose arm moves its centre of mass outside its support polygon: it falls over, and is
// imported lying.
TEST_F(UrdfFaults, WhatFallsOverLies) {
  const ArticulatedAsset asset =
      Import(Link("body", Box(0, 0, 0.25, "0.02 0.02 0.5") + Box(0.15, 0, 0.49, "0.3 0.02 0.02")) +
             Link("ring", Box(0, 0, 0, "0.03 0.01 0.05")) +
             Joint("prismatic", "ring", "0 0.02 0.3", "0 0 1", 0, 0.1));
  EXPECT_EQ(Count(asset.findings, "does-not-stand"), 1);
  EXPECT_LT(assets::BoundsAtZero(asset).sizes().z(), 0.45);
}

// A vessel whose base bulges by 1 mm gets a flat support face.
TEST_F(UrdfFaults, ARoundedBaseIsLevelled) {
  core::TriangleMesh mesh = assets::CylinderMesh(0.03, 0.2);
  for (Eigen::Vector3d& v : mesh.vertices) {
    v.z() += 0.1;
    if (v.z() < 1e-9 && v.head<2>().norm() > 0.01 && v.x() > 0.0) v.z() += 0.001;
  }
  std::ofstream(folder_.path() / "vessel.obj") << assets::ObjText(mesh);
  const ArticulatedAsset asset = Import(
      "<link name='body'><visual><geometry><mesh filename='vessel.obj'/></geometry></visual>"
      "</link>" +
          Link("cap", Box(0, 0, 0, "0.04 0.04 0.02")) +
          Joint("prismatic", "cap", "0 0 0.22", "0 0 1", 0, 0.05),
      "bottle");
  int on_floor = 0;
  double lowest = 1.0;
  for (const core::TriangleMesh& part : asset.links[0].parts) {
    for (const Eigen::Vector3d& v : part.vertices) {
      lowest = std::min(lowest, v.z());
      on_floor += std::abs(v.z()) < 1e-9;
    }
  }
  EXPECT_NEAR(lowest, 0.0, 1e-9);
  EXPECT_GE(on_floor, 12);
}

TEST_F(UrdfFaults, ARigidUrdfBecomesARigidAsset) {
  const fs::path file = folder_.path() / "stool.urdf";
  std::ofstream(file) << "<robot name='stool'>" + Link("seat", Box(0, 0, 0.4, "0.3 0.3 0.03")) +
                             Link("leg", Box(0, 0, 0.2, "0.05 0.05 0.4")) +
                             Link("base", Box(0, 0, 0.01, "0.3 0.3 0.02")) +
                             "<joint name='a' type='fixed'><parent link='seat'/><child link='leg'/>"
                             "</joint><joint name='b' type='fixed'><parent link='leg'/><child "
                             "link='base'/></joint></robot>";
  const std::string out = (folder_.path() / "out").string();
  const Outcome made = RunProgram("import --category stool " + file.string() + " -o " + out);
  EXPECT_EQ(made.code, 0) << made.text;
  const assets::Asset asset = assets::ReadAsset(fs::path(out) / "stool");
  const Eigen::Vector3d size = core::Bounds(asset.visual.mesh).sizes();
  EXPECT_LT((size - Eigen::Vector3d(0.3, 0.3, 0.415)).norm(), 1e-6);
  const std::string json = core::ReadFile(fs::path(out) / "stool" / "asset.json", 16 << 20);
  EXPECT_NE(json.find("urdf-rigid"), std::string::npos);
}

// check: every fault is a result, and the last is found as well as the first.
TEST_F(UrdfFaults, CheckListsAllFaultsOfAUrdf) {
  const auto link = [](const std::string& name, const std::string& inertia) {
    return "<link name='" + name + "'><inertial><mass value='1'/><inertia " + inertia +
           " ixy='0' ixz='0' iyz='0'/></inertial><collision><geometry><box size='0.1 0.1 0.1'/>"
           "</geometry></collision></link>";
  };
  const fs::path file = folder_.path() / "faulty.urdf";
  std::ofstream(file) << "<robot name='r'>" + link("a", "ixx='1' iyy='1' izz='9'") +
                             link("b", "ixx='9' iyy='1' izz='1'") +
                             "<joint name='j' type='fixed'><parent link='a'/><child link='b'/>"
                             "</joint></robot>";
  const Outcome outcome = RunProgram("check " + file.string());
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.text.find("'a'"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("'b'"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("collision-shapes"), std::string::npos) << outcome.text;
}

}  // namespace
}  // namespace simwright::importers
