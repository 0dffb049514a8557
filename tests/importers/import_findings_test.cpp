// Findings of import: implausible sizes, names, axes, and the precedence of stated values.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "assets/asset_folder.h"
#include "assets/obj_file.h"
#include "assets/primitive_meshes.h"
#include "core/files.h"
#include "tests/workflows/program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

class ImportFindings : public ::testing::Test {
 protected:
  std::string Mesh(const std::string& name, const core::TriangleMesh& mesh) const {
    core::WriteFile(folder_.path() / name, assets::ObjText(mesh));
    return (folder_.path() / name).string();
  }
  // A box with its height along y, as in OBJ.
  std::string Box(const std::string& name, double length, double height, double width) const {
    return Mesh(name, assets::BoxMesh({length, height, width}));
  }
  Outcome Import(const std::string& arguments, const std::string& errors_to = "&1") const {
    return RunProgram("import " + arguments + " --force -o " + (folder_.path() / "out").string(),
                      errors_to);
  }
  assets::Asset Read(const std::string& name) const {
    return assets::ReadAsset(folder_.path() / "out" / name);
  }
  static Eigen::Vector3d SizeOf(const assets::Asset& asset) {
    return core::Bounds(asset.visual.mesh).sizes();
  }
  const core::TemporaryFolder folder_;
};

TEST_F(ImportFindings, AnAbsurdSizeGetsTheUnitThatFits) {
  const std::string mesh = Box("crate.obj", 40, 30, 30);
  const Outcome guessed = Import(mesh + " --category crate");
  EXPECT_EQ(guessed.code, 0) << guessed.text;
  EXPECT_NE(guessed.text.find("40 x 30 x 30 m"), std::string::npos) << guessed.text;
  EXPECT_NE(guessed.text.find("[unit-guessed]"), std::string::npos) << guessed.text;
  EXPECT_NEAR(SizeOf(Read("crate")).z(), 0.3, 1e-6);
  const Outcome stated = Import(mesh + " --category crate --unit cm");
  EXPECT_EQ(stated.code, 0) << stated.text;
  EXPECT_EQ(stated.text.find("[unit-guessed]"), std::string::npos) << stated.text;
  EXPECT_NEAR(SizeOf(Read("crate")).z(), 0.3, 1e-6);
}

TEST_F(ImportFindings, AFarNameIsRefusedOrSaid) {
  const std::string mesh = Box("duck.obj", 0.2, 0.15, 0.1);
  const Outcome refused = Import(mesh + " --category duck");
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.text.find("chicken"), std::string::npos) << refused.text;
  EXPECT_NE(refused.text.find("'object'"), std::string::npos) << refused.text;
  const Outcome taken = Import(mesh);
  EXPECT_EQ(taken.code, 0) << taken.text;
  EXPECT_NE(taken.text.find("[category-unknown]"), std::string::npos) << taken.text;
  EXPECT_EQ(Read("duck").parameters.category, "object");
}

TEST_F(ImportFindings, WhatIsStatedWins) {
  const std::string mesh = Box("box.obj", 0.3, 0.2, 0.2);
  ASSERT_EQ(Import(mesh + " --category box --mass 1.25 --friction 0.9").code, 0);
  assets::Asset asset = Read("box");
  EXPECT_NEAR(asset.inertial.mass, 1.25, 1e-6);
  EXPECT_EQ(asset.friction, 0.9);
  EXPECT_EQ(asset.parameters.mass.source, "stated");
  ASSERT_EQ(Import(mesh + " --category box --density 500").code, 0);
  asset = Read("box");
  EXPECT_NEAR(asset.inertial.mass, 500 * 0.3 * 0.2 * 0.2, 1e-3);
  ASSERT_EQ(Import(mesh + " --category box --mass 60 --size 0.6").code, 0);
  asset = Read("box");
  EXPECT_NEAR(asset.inertial.mass, 60.0, 1e-6);  // far heavier than any cardboard box
  EXPECT_NEAR(SizeOf(asset).maxCoeff(), 0.6, 1e-6);
  const Outcome stretched = Import(mesh + " --category box --size 0.5,0.2,0.4");
  ASSERT_EQ(stretched.code, 0) << stretched.text;
  EXPECT_NE(stretched.text.find("[stretched]"), std::string::npos) << stretched.text;
  EXPECT_TRUE(SizeOf(Read("box")).isApprox(Eigen::Vector3d(0.5, 0.2, 0.4), 1e-6));
  EXPECT_EQ(Import(mesh + " --category box --mass 60 --density 100").code, 1);  // does not fit
  EXPECT_EQ(Import(mesh + " --category box --mass -1").code, 2);
}

// A rigid URDF keeps its own mass if the density is possible, and a stated mass takes precedence.
TEST_F(ImportFindings, ARigidUrdfKeepsItsMass) {
  const auto urdf = [&](double mass) {
    const fs::path file = folder_.path() / "brick.urdf";
    std::ofstream(file) << "<robot name='brick'><link name='b'><inertial><mass value='" << mass
                        << "'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/>"
                           "</inertial><visual><geometry><box size='0.2 0.1 0.06'/></geometry>"
                           "</visual></link></robot>";
    return file.string() + " --category object";
  };
  ASSERT_EQ(Import(urdf(2.5)).code, 0);
  EXPECT_NEAR(Read("brick").inertial.mass, 2.5, 1e-6);
  const Outcome heavy = Import(urdf(300.0));  // 250 t/m3
  ASSERT_EQ(heavy.code, 0) << heavy.text;
  EXPECT_NE(heavy.text.find("no material of its size has"), std::string::npos) << heavy.text;
  EXPECT_LT(Read("brick").inertial.mass, 10.0);
  ASSERT_EQ(Import(urdf(2.5) + " --mass 3").code, 0);
  EXPECT_NEAR(Read("brick").inertial.mass, 3.0, 1e-6);
}

TEST_F(ImportFindings, TheUpAxisIsGuessedAndSaid) {
  // A bottle that stands along z in a format whose usual axis is y.
  core::TriangleMesh bottle = assets::BoxMesh({0.07, 0.07, 0.3});
  const Outcome turned = Import(Mesh("bottle.obj", bottle) + " --category bottle");
  ASSERT_EQ(turned.code, 0) << turned.text;
  EXPECT_NE(turned.text.find("z was used"), std::string::npos) << turned.text;
  EXPECT_NEAR(SizeOf(Read("bottle")).z(), 0.3, 1e-6);
  const Outcome usual = Import(Box("tall.obj", 0.07, 0.3, 0.07) + " --category bottle");
  ASSERT_EQ(usual.code, 0) << usual.text;
  EXPECT_NE(usual.text.find("y was used, the usual one"), std::string::npos) << usual.text;
  EXPECT_NEAR(SizeOf(Read("tall")).z(), 0.3, 1e-6);
}

TEST_F(ImportFindings, JsonHasOneArrayOfFindings) {
  const Outcome outcome = Import(Box("duck.obj", 0.2, 0.15, 0.1) + " --json", "/dev/null");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const auto json = nlohmann::json::parse(outcome.text);
  ASSERT_EQ(json["assets"].size(), 1u);
  EXPECT_EQ(json["assets"][0]["name"], "duck");
  bool said = false;
  for (const auto& finding : json["findings"]) {
    for (const char* key : {"code", "severity", "place", "sentence", "remedy", "figure"}) {
      EXPECT_TRUE(finding.contains(key)) << finding;
    }
    said = said || finding["code"] == "category-unknown";
  }
  EXPECT_TRUE(said) << json;
  const Outcome refused = RunProgram("import none.obj -o x --json", "/dev/null");
  EXPECT_EQ(refused.code, 1);
  EXPECT_EQ(nlohmann::json::parse(refused.text)["findings"][0]["severity"], "error");
}

}  // namespace
}  // namespace simwright
