// Files of grasps, read by other programs: h5py, PyYAML and MuJoCo.
#include "manipulation/grasp_formats.h"

#include <array>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "core/hdf5.h"
#include "sim/mujoco_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

GraspSet TwoGrasps() {
  GraspSet set;
  set.object = "mug";
  set.mesh = "solid.obj";
  set.gripper = "panda";
  set.base_link = "panda_hand";
  set.tool_from_base = Eigen::Translation3d(0.0, 0.0, -0.1034);
  set.max_opening = 0.08;
  set.force = 30.0;
  set.friction = 0.6;
  set.joints = {{"panda_finger_joint1", 0.04, -1.0}, {"panda_finger_joint2", 0.04, -1.0}};
  Grasp grasp;
  // From above: the tool's z points down, its y along the object's y.
  grasp.object_from_tool.linear() << -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0;
  grasp.object_from_tool.translation() = Vector3d(0.01, 0.02, 0.05);
  grasp.width = 0.03;
  grasp.opening = 0.05;
  grasp.quality = 0.75;
  set.grasps = {grasp, grasp};
  set.grasps[1].object_from_tool.translation().z() = 0.06;
  return set;
}

GraspInertials MugInertials() {
  assets::Inertial inertial;
  inertial.mass = 0.25;
  return {{"", inertial}};
}

// Returns the words of the line that begins with `name`.
std::vector<std::string> WordsOf(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first != name) continue;
    std::vector<std::string> rest;
    for (std::string word; words >> word;) rest.push_back(word);
    return rest;
  }
  return {};
}

TEST(GraspFormats, AreReadByOtherPrograms) {
  const core::TemporaryFolder folder;
  const auto h5 = folder.path() / "mug.h5", yaml = folder.path() / "mug.yaml";
  WriteGrasps(TwoGrasps(), MugInertials(), GraspFormat::kAcronym, h5);
  WriteGrasps(TwoGrasps(), MugInertials(), GraspFormat::kIsaac, yaml);
  const std::string command = "/usr/bin/python3 " + std::string(SIMWRIGHT_TEST_DATA) +
                              "/read_grasps.py " + h5.string() + " " + yaml.string() + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string text;
  std::array<char, 4096> buffer;
  for (size_t count; (count = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    text.append(buffer.data(), count);
  }
  ASSERT_EQ(pclose(pipe), 0) << text;
  const std::vector<std::string> acronym = WordsOf(text, "acronym");
  ASSERT_EQ(acronym.size(), 21u) << text;
  EXPECT_EQ(acronym[0], "solid.obj");
  EXPECT_EQ(std::stod(acronym[1]), 1.0);
  EXPECT_EQ(std::stod(acronym[2]), 0.25);
  EXPECT_EQ(acronym[3], "2");
  EXPECT_EQ(acronym[4], "2");
  // x along the closing axis, which is the object's y; z down; the base 103.4 mm above the tips.
  const std::array<double, 16> expected = {0, 1, 0,  0.01,   1, 0, 0, 0.02,
                                           0, 0, -1, 0.1534, 0, 0, 0, 1};
  for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(std::stod(acronym[5 + i]), expected[i], 1e-9) << i;
  const std::vector<std::string> isaac = WordsOf(text, "isaac");
  // Two grasps, the confidence, the pose of panda_hand (a half turn about y), and joints: closed on
  // 30 mm, open to 50 mm.
  const std::array<double, 13> numbers = {2, 0.75, 0.01,  0.02,  0.1534, 0,    0,
                                          1, 0,    0.015, 0.015, 0.025,  0.025};
  ASSERT_EQ(isaac.size(), numbers.size()) << text;
  for (size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_NEAR(std::abs(std::stod(isaac[i])), numbers[i], 1e-9) << i;
  }
}

TEST(GraspFormats, AcronymIsReadBack) {
  const core::TemporaryFolder folder;
  WriteGrasps(TwoGrasps(), MugInertials(), GraspFormat::kAcronym, folder.path() / "mug.h5");
  const core::Hdf5Reader reader(folder.path() / "mug.h5");
  EXPECT_EQ(reader.root().Open("object").ReadTexts("file"), std::vector<std::string>{"solid.obj"});
  EXPECT_TRUE(reader.root().Open("object").Shape("scale").empty());
  const auto quality =
      reader.root().Open("grasps").Open("qualities").Open("simwright").Read<double>("perturbed");
  EXPECT_EQ(quality.values, (std::vector<double>{0.75, 0.75}));
}

TEST(GraspFormats, MujocoLoadsTheSites) {
  const core::TemporaryFolder folder;
  const auto file = folder.path() / "mug.xml";
  WriteGrasps(TwoGrasps(), MugInertials(), GraspFormat::kMjcf, file);
  const sim::MujocoScene scene(file, {}, sim::MujocoScene::Ground::kOwn);
  EXPECT_TRUE(scene.warnings().empty());
  EXPECT_NE(scene.model(), nullptr);
  const std::string text = core::ReadFile(file);
  EXPECT_NE(text.find("name=\"grasp_1\" type=\"box\" size=\"0.002 0.015 0.002\" pos=\"0.01 0.02 "
                      "0.06\" quat=\"0 0 1 0\""),
            std::string::npos)
      << text;
}

TEST(GraspFormats, UsdHasACurveForEachGrasp) {
  const std::string text = UsdGraspText(TwoGrasps());
  EXPECT_EQ(text.rfind("#usda 1.0", 0), 0u);
  size_t curves = 0;
  for (size_t at = text.find("BasisCurves"); at != std::string::npos;
       at = text.find("BasisCurves", at + 1)) {
    ++curves;
  }
  EXPECT_EQ(curves, 2u);
  EXPECT_NE(text.find("custom double simwright:quality = 0.75"), std::string::npos) << text;
}

TEST(GraspFormats, FollowTheNameOrTheExtension) {
  EXPECT_EQ(GraspFormatOf("", "a.json"), GraspFormat::kJson);
  EXPECT_EQ(GraspFormatOf("", "a.yml"), GraspFormat::kIsaac);
  EXPECT_EQ(GraspFormatOf("usd", "a.usda"), GraspFormat::kUsd);
  EXPECT_THROW(GraspFormatOf("usd", "a.json"), core::Error);
  EXPECT_EQ(GraspExtension(GraspFormat::kAcronym), ".h5");
  EXPECT_THROW(GraspFormatOf("", "a.txt"), core::Error);
}

// Two grasps at the handles of two drawers.
GraspSet DrawerGrasps() {
  GraspSet set = TwoGrasps();
  set.object = "drawers";
  set.mesh = "drawers.urdf";
  set.grasps[0].link = "handle_1";
  set.grasps[0].joint = "slide_1";
  set.grasps[1].link = "handle_0";
  set.grasps[1].joint = "slide_0";
  return set;
}

GraspInertials DrawerInertials() {
  GraspInertials inertials;
  inertials["handle_0"].mass = 0.1;
  inertials["handle_1"].mass = 0.2;
  return inertials;
}

TEST(GraspFormats, EachLinkHasAFileWhereOneFrameIsKnown) {
  const core::TemporaryFolder folder;
  const std::vector<std::filesystem::path> files =
      WriteGrasps(DrawerGrasps(), DrawerInertials(), GraspFormat::kIsaac, folder.path() / "g.yaml");
  ASSERT_EQ(files, (std::vector<std::filesystem::path>{folder.path() / "g_handle_0.yaml",
                                                       folder.path() / "g_handle_1.yaml"}));
  for (const std::string link : {"handle_0", "handle_1"}) {
    const std::string text = core::ReadFile(folder.path() / ("g_" + link + ".yaml"));
    EXPECT_NE(text.find("object_frame_link: \"" + link + "\""), std::string::npos) << text;
    EXPECT_NE(text.find("\"grasp_0\""), std::string::npos);
    EXPECT_EQ(text.find("\"grasp_1\""), std::string::npos);
    // The base link of each link's own grasp, 103.4 mm above the tool.
    EXPECT_NE(text.find(link == "handle_1" ? "[0.01, 0.02, 0.1534]" : "[0.01, 0.02, 0.1634]"),
              std::string::npos)
        << text;
  }
  const std::vector<std::filesystem::path> hdf5 =
      WriteGrasps(DrawerGrasps(), DrawerInertials(), GraspFormat::kAcronym, folder.path() / "g.h5");
  ASSERT_EQ(hdf5.size(), 2u);
  const core::Hdf5Reader reader(hdf5[1]);
  EXPECT_EQ(reader.root().Open("object").ReadTexts("link"), std::vector<std::string>{"handle_1"});
  EXPECT_EQ(reader.root().Open("object").Read<double>("mass").values, std::vector<double>{0.2});
  EXPECT_EQ(reader.root().Open("grasps").ReadTexts("joint"), std::vector<std::string>{"slide_1"});
  EXPECT_THROW(WriteGrasps(DrawerGrasps(), {}, GraspFormat::kAcronym, folder.path() / "h.h5"),
               core::Error);
}

TEST(GraspFormats, MjcfAndUsdHaveAGroupForEachLink) {
  const core::TemporaryFolder folder;
  const auto file = folder.path() / "drawers.xml";
  EXPECT_EQ(WriteGrasps(DrawerGrasps(), DrawerInertials(), GraspFormat::kMjcf, file).size(), 1u);
  const sim::MujocoScene scene(file, {}, sim::MujocoScene::Ground::kOwn);
  EXPECT_TRUE(scene.warnings().empty());
  const std::string text = core::ReadFile(file);
  const size_t first = text.find("<body name=\"drawers_handle_0_grasps\">");
  const size_t second = text.find("<body name=\"drawers_handle_1_grasps\">");
  ASSERT_NE(second, std::string::npos) << text;
  ASSERT_LT(first, second);
  EXPECT_LT(first, text.find("name=\"grasp_1\""));
  EXPECT_LT(second, text.find("name=\"grasp_0\""));
  const std::string usd = UsdGraspText(DrawerGrasps());
  EXPECT_NE(usd.find("custom string simwright:link = \"handle_0\""), std::string::npos) << usd;
  EXPECT_NE(usd.find("custom string simwright:joint = \"slide_1\""), std::string::npos);
}

TEST(GraspFormats, JsonOfAnArticulatedAssetIsReadBack) {
  GraspSet set = DrawerGrasps();
  set.joint_proofs = {{.joint = "slide_0",
                       .link = "handle_0",
                       .grasps = 1,
                       .friction = 0.6,
                       .tried = 5,
                       .held_in_bullet = 3,
                       .held_in_both = 2,
                       .coverage = 0.5},
                      {.joint = "button", .link = "button", .reason = "the gripper collides"}};
  const core::TemporaryFolder folder;
  const auto file = folder.path() / "grasps.json";
  WriteGrasps(set, {}, GraspFormat::kJson, file);
  const GraspSet read = ReadGraspSet(file);
  ASSERT_EQ(read.grasps.size(), 2u);
  EXPECT_EQ(read.grasps[0].link, "handle_1");
  EXPECT_EQ(read.grasps[1].joint, "slide_0");
  ASSERT_EQ(read.joint_proofs.size(), 2u);
  EXPECT_EQ(read.joint_proofs[0].held_in_bullet, 3);
  EXPECT_EQ(read.joint_proofs[1].reason, "the gripper collides");
  ASSERT_EQ(GraspsOfJoint(read, "slide_0").size(), 1u);
  EXPECT_TRUE(GraspsOfJoint(read, "slide_0")[0].object_from_tool.isApprox(
      set.grasps[1].object_from_tool, 1e-12));
  EXPECT_TRUE(GraspsOfJoint(read, "button").empty());
  EXPECT_TRUE(GraspsOfJoint(read, "").empty());
  EXPECT_EQ(GraspedLinks(read), (std::vector<std::string>{"handle_0", "handle_1"}));
  // A rigid asset has neither.
  WriteGrasps(TwoGrasps(), MugInertials(), GraspFormat::kJson, file);
  EXPECT_EQ(core::ReadFile(file).find("\"joint\""), std::string::npos);
  EXPECT_TRUE(GraspedLinks(ReadGraspSet(file)).empty());
}

}  // namespace
}  // namespace simwright::manipulation
