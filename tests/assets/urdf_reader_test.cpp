#include "assets/urdf_reader.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "assets/joint_poses.h"
#include "assets/obj_file.h"
#include "assets/primitive_meshes.h"
#include "core/error.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

class Urdf : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() /
            (std::string("simwright_urdf_") +
             ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(root_);
    fs::create_directories(root_ / "pkg" / "urdf");
    fs::create_directories(root_ / "pkg" / "meshes");
    std::ofstream(root_ / "pkg" / "meshes" / "box.obj") << ObjText(BoxMesh({1, 1, 1}));
    std::ofstream(root_ / "outside.obj") << ObjText(BoxMesh({1, 1, 1}));
  }
  void TearDown() override { fs::remove_all(root_); }

  fs::path Write(const std::string& body) {
    const fs::path path = root_ / "pkg" / "urdf" / "robot.urdf";
    std::ofstream(path) << "<?xml version=\"1.0\"?><robot name=\"r\">" << body << "</robot>";
    return path;
  }
  static std::string Link(const std::string& name, const std::string& mesh, double mass = 1.0) {
    return "<link name=\"" + name + "\"><inertial><mass value=\"" + std::to_string(mass) +
           "\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>"
           "<collision><geometry><mesh filename=\"" +
           mesh + "\"/></geometry></collision></link>";
  }
  // The error's text, empty when there was none.
  std::string ErrorOf(const fs::path& path) {
    try {
      ReadUrdf(path);
      return "";
    } catch (const core::Error& error) {
      return error.what();
    }
  }
  fs::path root_;
};

TEST_F(Urdf, FindsMeshesInsideThePackage) {
  for (const char* mesh : {"../meshes/box.obj", "package://pkg/meshes/box.obj"}) {
    const UrdfModel model = ReadUrdf(Write(Link("a", mesh)));
    EXPECT_TRUE(model.findings.empty()) << mesh;
    ASSERT_EQ(model.links[0].collisions.size(), 1u) << mesh;
    EXPECT_EQ(model.links[0].collisions[0].mesh.triangles.size(), 12u);
  }
}

TEST_F(Urdf, WarnsOfMissingMeshesAndInertialsAndGoesOn) {
  const UrdfModel model = ReadUrdf(
      Write("<link name=\"a\"><visual><geometry><mesh filename=\"none.obj\"/></geometry></visual>"
            "<collision><geometry><box size=\"1 2 3\"/></geometry></collision></link>"));
  std::set<std::string> codes;
  for (const core::Finding& f : model.findings) codes.insert(f.code);
  EXPECT_TRUE(codes.contains("urdf-missing-mesh"));
  EXPECT_TRUE(codes.contains("urdf-no-inertial"));
  EXPECT_EQ(model.links[0].collisions.size(), 1u);
}

TEST_F(Urdf, RefusesMeshesBeyondItsRoot) {
  EXPECT_NE(ErrorOf(Write(Link("a", "../../outside.obj"))).find("outside"), std::string::npos);
  EXPECT_NE(ErrorOf(Write(Link("a", "/etc/passwd"))).find("outside"), std::string::npos);
  UrdfReadOptions wider;
  wider.root = root_;
  EXPECT_EQ(ReadUrdf(Write(Link("a", "../../outside.obj")), wider).links[0].collisions.size(), 1u);
}

TEST_F(Urdf, RefusesLoopsMissingLinksAndImpossibleMasses) {
  const std::string box = "../meshes/box.obj";
  const std::string joint =
      "<joint name=\"%\" type=\"fixed\"><parent link=\"@\"/><child link=\"#\"/></joint>";
  const auto joined = [&](std::string name, std::string parent, std::string child) {
    std::string text = joint;
    text.replace(text.find('%'), 1, name);
    text.replace(text.find('@'), 1, parent);
    text.replace(text.find('#'), 1, child);
    return text;
  };
  EXPECT_NE(ErrorOf(Write(Link("a", box) + Link("b", box) + joined("j", "a", "b") +
                          joined("k", "b", "a")))
                .find("loop"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Write(Link("a", box) + joined("j", "a", "ghost"))).find("ghost"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Write(Link("a", box, -1.0))).find("mass"), std::string::npos);
  EXPECT_NE(ErrorOf(Write("")).find("no link"), std::string::npos);
}

TEST_F(Urdf, RefusesEntityBombsAndWhatIsNoUrdf) {
  const fs::path path = root_ / "bomb.urdf";
  std::ofstream(path)
      << "<?xml version=\"1.0\"?><!DOCTYPE lolz [<!ENTITY a \"ha\">"
         "<!ENTITY b \"&a;&a;&a;&a;\">]><robot name=\"&b;\"><link name=\"l\"/></robot>";
  EXPECT_NE(ErrorOf(path).find("DOCTYPE"), std::string::npos);
  std::ofstream(path) << "not xml at all";
  EXPECT_NE(ErrorOf(path).find("XML"), std::string::npos);
  std::ofstream(path) << "";
  EXPECT_FALSE(ErrorOf(path).empty());
}

TEST_F(Urdf, PlacesLinksByTheirJoints) {
  const UrdfModel model = ReadUrdf(Write(
      Link("a", "../meshes/box.obj") + Link("b", "../meshes/box.obj") +
      "<joint name=\"j\" type=\"revolute\"><origin xyz=\"1 2 3\" rpy=\"0 0 1.5707963267948966\"/>"
      "<parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 2\"/>"
      "<limit lower=\"-1\" upper=\"2\" effort=\"1\" velocity=\"1\"/></joint>"));
  const auto poses = LinkPosesAtZero(model);
  EXPECT_NEAR((poses[1].translation() - Eigen::Vector3d(1, 2, 3)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((poses[1].linear().col(0) - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-9);
  EXPECT_NEAR((model.joints[0].axis - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_EQ(model.joints[0].upper, 2.0);
}

TEST_F(Urdf, ReadsDynamicsAndMimics) {
  const auto joint = [](const std::string& name, const std::string& child,
                        const std::string& more) {
    return "<joint name=\"" + name + "\" type=\"prismatic\"><parent link=\"a\"/><child link=\"" +
           child +
           "\"/><axis xyz=\"0 1 0\"/><limit lower=\"0\" upper=\"0.04\" effort=\"20\" "
           "velocity=\"0.2\"/>" +
           more + "</joint>";
  };
  const std::string links = Link("a", "../meshes/box.obj") + Link("b", "../meshes/box.obj") +
                            Link("c", "../meshes/box.obj");
  const UrdfModel model = ReadUrdf(
      Write(links + joint("left", "b", "<dynamics damping=\"1.5\" friction=\"0.25\"/>") +
            joint("right", "c", "<mimic joint=\"left\" multiplier=\"-1\" offset=\"0.01\"/>")));
  ASSERT_EQ(model.joints.size(), 2u);
  EXPECT_EQ(model.joints[0].damping, 1.5);
  EXPECT_EQ(model.joints[0].friction, 0.25);
  EXPECT_EQ(model.joints[0].effort, 20.0);
  EXPECT_EQ(model.joints[0].velocity, 0.2);
  EXPECT_FALSE(model.joints[0].mimic);
  ASSERT_TRUE(model.joints[1].mimic);
  EXPECT_EQ(model.joints[1].mimic->joint, "left");
  EXPECT_EQ(model.joints[1].mimic->multiplier, -1.0);
  EXPECT_EQ(model.joints[1].mimic->offset, 0.01);
  ASSERT_EQ(model.findings.size(), 1u);
  EXPECT_EQ(model.findings[0].code, "urdf-mimic");
  EXPECT_NE(ErrorOf(Write(links + joint("left", "b", "<dynamics damping=\"-1\"/>") +
                          joint("right", "c", ""))),
            "");
}

// PartNet-Mobility's limits have neither; urdfdom alone would refuse them.
TEST_F(Urdf, ALimitMayLackEffortAndVelocity) {
  const UrdfModel model =
      ReadUrdf(Write(Link("a", "../meshes/box.obj") + Link("b", "../meshes/box.obj") +
                     "<joint name=\"j\" type=\"prismatic\"><parent link=\"a\"/><child link=\"b\"/>"
                     "<limit lower=\"-0.25\" upper=\"0.5\"/></joint>"));
  EXPECT_EQ(model.joints[0].lower, -0.25);
  EXPECT_EQ(model.joints[0].upper, 0.5);
  EXPECT_EQ(model.joints[0].effort, 0.0);
  EXPECT_EQ(model.joints[0].velocity, 0.0);
}

TEST_F(Urdf, SaysWhereAVisualCameFromAndItsColour) {
  const UrdfModel model = ReadUrdf(
      Write("<link name=\"a\"><visual><origin xyz=\"1 2 3\" rpy=\"0 0 1.5707963267948966\"/>"
            "<geometry><mesh filename=\"../meshes/box.obj\" scale=\"2 4 6\"/></geometry>"
            "<material name=\"m\"><color rgba=\"0.25 0.5 0.75 1\"/></material></visual></link>"));
  ASSERT_EQ(model.links[0].visuals.size(), 1u);
  const UrdfShape& shape = model.links[0].visuals[0];
  EXPECT_TRUE(shape.color->isApprox(Eigen::Vector4f(0.25f, 0.5f, 0.75f, 1.0f)));
  // A corner of the file's unit cube: scaled, then rotated by 90 degrees, then translated.
  const Eigen::Vector3d corner(0.5, 0.5, 0.5), wanted(1.0 - 2.0, 2.0 + 1.0, 3.0 + 3.0);
  EXPECT_LT((shape.link_from_file * corner - wanted).norm(), 1e-12);
  double nearest = 1.0;
  for (const Eigen::Vector3d& v : shape.mesh.vertices) {
    nearest = std::min(nearest, (v - wanted).norm());
  }
  EXPECT_LT(nearest, 1e-9);
}

}  // namespace
}  // namespace simwright::assets
