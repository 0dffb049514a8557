// The defects that other readers tolerate and urdfdom alone rejects: each file here loads with its
// author's intended meaning.
#include "assets/urdf_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "assets/urdf_reader.h"
#include "core/error.h"
#include "core/files.h"
#include "geometry/mass_properties.h"
#include "geometry/weld.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

int Count(const core::Findings& findings, const std::string& code) {
  return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                        [&](const auto& f) { return f.code == code; }));
}

class UrdfText : public ::testing::Test {
 protected:
  UrdfModel ReadWhole(const std::string& text, bool repair_inertials = false) const {
    const fs::path file = folder_.path() / "thing.urdf";
    std::ofstream(file, std::ios::binary) << text;
    return ReadUrdf(file, {.root = {}, .repair_inertials = repair_inertials});
  }
  UrdfModel Read(const std::string& body, bool repair_inertials = false) const {
    return ReadWhole("<robot name='thing'>" + body + "</robot>", repair_inertials);
  }
  std::string ErrorOf(const std::string& body) const {
    try {
      Read(body);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  }
  static std::string Box(const std::string& material, const std::string& link = "a") {
    return "<link name='" + link + "'><visual><geometry><box size='0.1 0.2 0.3'/></geometry>" +
           material + "</visual></link>";
  }
  static std::string Joint(const std::string& type, const std::string& more) {
    return "<joint name='j' type='" + type + "'><parent link='a'/><child link='b'/>" + more +
           "</joint>";
  }
  core::TemporaryFolder folder_;
};

TEST_F(UrdfText, ByteOrderMarksCommentsAndNamelessRobots) {
  const UrdfModel model = ReadWhole(
      "\xef\xbb\xbf<?xml version='1.0' encoding='utf-8'?>\n"
      "<!-- made by hand -->\n<robot><!-- x -->" +
      Box("") + "</robot>");
  EXPECT_EQ(model.name, "thing");
  ASSERT_EQ(model.links.size(), 1u);
  EXPECT_EQ(model.links[0].visuals.size(), 1u);
}

TEST_F(UrdfText, ADeclarationMayStandTooLate) {
  EXPECT_EQ(
      ReadWhole("\n<!-- licence -->\n<?xml version='1.0'?><robot name='r'>" + Box("") + "</robot>")
          .links.size(),
      1u);
}

TEST_F(UrdfText, JointsOfUnknownTypesAreNamed) {
  const std::string error = ErrorOf(Box("") + Box("", "b") + Joint("spherical", ""));
  EXPECT_NE(error.find("'j'"), std::string::npos) << error;
  EXPECT_NE(error.find("spherical"), std::string::npos) << error;
}

TEST_F(UrdfText, Utf16IsNamed) {
  std::string wide = "\xff\xfe";
  for (const char c : std::string("<robot name='r'><link name='a'/></robot>")) {
    wide += c;
    wide += '\0';
  }
  try {
    ReadWhole(wide);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("UTF-8"), std::string::npos) << error.what();
  }
}

TEST_F(UrdfText, MaterialsMeanTheirFirstDefinition) {
  const std::string red = "<material name='m'><color rgba='1 0 0 1'/></material>";
  const std::string blue = "<material name='m'><color rgba='0 0 1 1'/></material>";
  const Eigen::Vector4f is_red(1, 0, 0, 1), is_blue(0, 0, 1, 1);
  const auto color = [](const UrdfModel& model, size_t link) {
    return model.links[link].visuals[0].color.value_or(Eigen::Vector4f::Zero());
  };
  const UrdfModel same = Read(red + red + Box("<material name='m'/>"));
  EXPECT_EQ(color(same, 0), is_red);
  EXPECT_TRUE(Count(same.findings, "urdf-material-twice") == 0);
  const UrdfModel differing = Read(red + blue + Box("<material name='m'/>"));
  EXPECT_EQ(color(differing, 0), is_red);
  EXPECT_EQ(Count(differing.findings, "urdf-material-twice"), 1);
  // Each visual that gives its own colour has it, whatever others call theirs.
  const UrdfModel own = Read(Box(red) + Box(blue, "b") + Joint("fixed", ""));
  EXPECT_EQ(color(own, 0), is_red);
  EXPECT_EQ(color(own, 1), is_blue);
  // Defined in one link, used in an earlier one.
  const UrdfModel later = Read(Box("<material name='m'/>") + Box(blue, "b") + Joint("fixed", ""));
  EXPECT_EQ(color(later, 0), is_blue);
  const UrdfModel nameless = Read(Box("<material><color rgba='1 0 0'/></material>"));
  EXPECT_EQ(color(nameless, 0), is_red);
  const UrdfModel unknown = Read(Box("<material name='nowhere'/>"));
  EXPECT_FALSE(unknown.links[0].visuals[0].color);
  EXPECT_EQ(Count(unknown.findings, "urdf-unknown-material"), 1);
}

TEST_F(UrdfText, AxesOfJoints) {
  const std::string two = Box("") + Box("", "b");
  EXPECT_EQ(Read(two + Joint("fixed", "<axis xyz='0 0 0'/>")).joints.size(), 1u);
  const std::string limit = "<limit lower='0' upper='1'/>";
  const UrdfModel longer = Read(two + Joint("revolute", "<axis xyz='0 3 4'/>" + limit));
  EXPECT_LT((longer.joints[0].axis - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 1e-12);
  ASSERT_EQ(Count(longer.findings, "urdf-axis"), 1);
  EXPECT_DOUBLE_EQ(longer.findings[0].figure, 5.0);
  const std::string error = ErrorOf(two + Joint("revolute", "<axis xyz='0 0 0'/>" + limit));
  EXPECT_NE(error.find("'j'"), std::string::npos) << error;
  EXPECT_NE(error.find("axis"), std::string::npos) << error;
}

TEST_F(UrdfText, ContinuousJointsTurnFreely) {
  const UrdfModel model =
      Read(Box("") + Box("", "b") +
           Joint("continuous", "<axis xyz='1 0 0'/><limit lower='-1' upper='2' effort='5'/>"));
  EXPECT_EQ(model.joints[0].type, JointType::kContinuous);
  EXPECT_EQ(model.joints[0].lower, 0.0);
  EXPECT_EQ(model.joints[0].upper, 0.0);
  EXPECT_EQ(model.joints[0].effort, 5.0);
  EXPECT_EQ(Count(model.findings, "urdf-continuous-limits"), 1);
}

TEST_F(UrdfText, ControllersAndEmptyDynamicsArePassedOver) {
  const UrdfModel model = Read(Box("") + Box("", "b") +
                               Joint("revolute",
                                     "<limit lower='0' upper='1'/><dynamics/><calibration/>"
                                     "<safety_controller/>"));
  EXPECT_EQ(model.joints[0].damping, 0.0);
  EXPECT_EQ(model.joints[0].upper, 1.0);
}

// The capsule's volume and inertia are known in closed form; its pieces overlap, so that volumes
// are compared by their hull.
TEST_F(UrdfText, CapsulesAreACylinderAndTwoBalls) {
  const UrdfModel model = Read(
      "<link name='a'><collision><origin xyz='1 2 3' rpy='0 1.5707963267948966 0'/>"
      "<geometry><capsule radius='0.1' length='0.4'/></geometry></collision></link>");
  ASSERT_EQ(model.links[0].collisions.size(), 3u);
  Eigen::AlignedBox3d box;
  for (const UrdfShape& shape : model.links[0].collisions) box.extend(core::Bounds(shape.mesh));
  // Rotated about y by 90 degrees, z lies along x: 0.4 + 2 * 0.1 long.
  EXPECT_NEAR(box.sizes().x(), 0.6, 1e-9);
  EXPECT_NEAR(box.sizes().y(), 0.2, 2e-3);  // meshed balls
  EXPECT_LT((box.center() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-9);
}

TEST_F(UrdfText, UnknownGeometryIsLeftOutAndSaid) {
  const UrdfModel model = Read(
      "<link name='a'><visual><geometry><plane normal='0 0 1'/></geometry></visual>"
      "<visual/><collision><geometry><mesh/></geometry></collision>"
      "<visual><geometry><box size='1 1 1'/></geometry></visual></link>");
  EXPECT_EQ(model.links[0].visuals.size(), 1u);
  EXPECT_TRUE(model.links[0].collisions.empty());
  EXPECT_EQ(Count(model.findings, "urdf-unknown-geometry"), 3);
}

TEST_F(UrdfText, UnexpandedXacroSaysHowToExpandIt) {
  for (const std::string& text :
       {std::string("<xacro:property name='w' value='1'/><link name='a'/>"),
        std::string("<link name='a'><inertial><mass value='${m}'/></inertial></link>"),
        std::string("<link name='a'><visual><geometry><mesh filename='$(find p)/x.stl'/>"
                    "</geometry></visual></link>")}) {
    const std::string error = ErrorOf(text);
    EXPECT_NE(error.find("xacro"), std::string::npos) << error;
    EXPECT_NE(error.find("expand"), std::string::npos) << error;
    EXPECT_NE(error.find("line"), std::string::npos) << error;
  }
  // An expanded xacro may keep the namespace.
  EXPECT_EQ(ReadWhole("<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>" + Box("") +
                      "</robot>")
                .links.size(),
            1u);
}

std::string WithInertial(const std::string& inertial, bool shape) {
  return "<link name='a'>" + inertial +
         (shape ? "<collision><geometry><box size='0.1 0.2 0.4'/></geometry></collision>" : "") +
         "</link>";
}

std::string InertialElement(double mass, double ixx, double iyy, double izz) {
  return "<inertial><mass value='" + std::to_string(mass) + "'/><inertia ixx='" +
         std::to_string(ixx) + "' iyy='" + std::to_string(iyy) + "' izz='" + std::to_string(izz) +
         "' ixy='0' ixz='0' iyz='0'/></inertial>";
}

TEST_F(UrdfText, FramesMayWeighNothing) {
  const UrdfModel model = Read(WithInertial(InertialElement(0, 0, 0, 0), false));
  EXPECT_FALSE(model.links[0].inertial);
  EXPECT_TRUE(model.findings.empty());
  const std::string error = ErrorOf(WithInertial(InertialElement(0, 0, 0, 0), true));
  EXPECT_NE(error.find("'a'"), std::string::npos) << error;
}

TEST_F(UrdfText, ImpossibleInertiasAreThoseOfABox) {
  const UrdfModel model = Read(WithInertial(InertialElement(3, 0.01, 0.01, 5), true), true);
  ASSERT_TRUE(model.links[0].inertial);
  EXPECT_EQ(Count(model.findings, "urdf-impossible-inertial"), 1);
  EXPECT_EQ(model.links[0].inertial->mass, 3.0);
  // m (y^2 + z^2) / 12 of 0.1 x 0.2 x 0.4 m.
  EXPECT_NEAR(model.links[0].inertial->inertia(0, 0), 3.0 * (0.04 + 0.16) / 12.0, 1e-12);
  EXPECT_NEAR(model.links[0].inertial->inertia(2, 2), 3.0 * (0.01 + 0.04) / 12.0, 1e-12);
  const UrdfModel weightless = Read(WithInertial(InertialElement(-1, 1, 1, 1), true), true);
  EXPECT_FALSE(weightless.links[0].inertial);
  EXPECT_EQ(Count(weightless.findings, "urdf-impossible-inertial"), 1);
  EXPECT_NE(ErrorOf(WithInertial(InertialElement(3, 0.01, 0.01, 5), true)).find("'a'"),
            std::string::npos);
}

TEST_F(UrdfText, InertiaOfALargerBodyIsSaid) {
  const UrdfModel unit = Read(WithInertial(InertialElement(3, 1, 1, 1), true), true);
  EXPECT_EQ(Count(unit.findings, "urdf-implausible-inertia"), 1);
  const UrdfModel box =
      Read(WithInertial(InertialElement(3, 0.05, 0.0425, 0.0125), true), true);  // its own
  EXPECT_TRUE(box.findings.empty());
}

// Bullet's files have commas between numbers, and "-1.57." for -1.57.
TEST_F(UrdfText, NumbersThatOtherReadersTakeAreMended) {
  const UrdfModel model = Read(
      "<link name='a'><visual><origin xyz='0.1, 0.2,0.3'/><geometry><box size='1f 1 1'/></geometry>"
      "</visual></link>" +
      Box("", "b") +
      Joint("revolute",
            "<axis xyz='0 0 1'/><limit lower='-1.57.' upper='1' effort='1' "
            "velocity='1'/>"));
  EXPECT_NEAR(core::Bounds(model.links[0].visuals[0].mesh).center().y(), 0.2, 1e-12);
  EXPECT_NEAR(core::Bounds(model.links[0].visuals[0].mesh).sizes().x(), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(model.joints[0].lower, -1.57);
  EXPECT_EQ(Count(model.findings, "urdf-numbers"), 3);
}

TEST_F(UrdfText, WhatIsNoNumberIsRefused) {
  for (const char* lower : {"0.5m", "-1.57.1", "90deg", "one", "1,5x"}) {
    EXPECT_FALSE(ErrorOf(Box("", "a") + Box("", "b") +
                         Joint("revolute", std::string("<axis xyz='0 0 1'/><limit lower='") +
                                               lower + "' upper='2' effort='1' velocity='1'/>"))
                     .empty())
        << lower;
  }
}

TEST_F(UrdfText, HalfAnInertialIsLeftOut) {
  const UrdfModel model = Read(WithInertial("<inertial><mass value='2'/></inertial>", true));
  EXPECT_FALSE(model.links[0].inertial);
  EXPECT_EQ(Count(model.findings, "urdf-bad-inertial"), 1);
  const UrdfModel diagonal = Read(WithInertial(
      "<inertial><mass value='3'/><inertia ixx='0.05' iyy='0.0425' izz='0.0125'/></inertial>",
      true));
  ASSERT_TRUE(diagonal.links[0].inertial);
  EXPECT_EQ(diagonal.links[0].inertial->inertia(0, 1), 0.0);
}

}  // namespace
}  // namespace simwright::assets
