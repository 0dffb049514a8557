// Messages about files that the program cannot use: one line with what, where and what to do.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "assets/asset_folder.h"
#include "core/files.h"
#include "program.h"
#include "tests/assets/sample_asset.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

class Messages : public testing::Test {
 protected:
  std::string At(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string Write(const std::string& name, const std::string& text) const {
    core::WriteFile(At(name), text);
    return At(name);
  }
  std::string SampleAsset(const std::string& name) const {
    fs::create_directories(At(name));
    assets::WriteAsset(assets::SampleAsset(), At(name));
    return At(name);
  }
  static void ExpectLine(const std::string& arguments, const std::string& line) {
    const Outcome refused = RunProgram(arguments);
    EXPECT_EQ(refused.code, 1) << arguments;
    EXPECT_EQ(refused.text, "error: " + line + "\n") << arguments;
  }
  core::TemporaryFolder folder_;
};

TEST_F(Messages, ANameThatNamesNoFile) {
  const fs::path file = fs::path(SampleAsset("box")) / "asset.json";
  std::string text = core::ReadFile(file);
  const std::string name = "\"name\": \"" + assets::SampleAsset().name + "\"";
  ASSERT_NE(text.find(name), std::string::npos);
  text.replace(text.find(name), name.size(), "\"name\": \"../my box\"");
  core::WriteFile(file, text);
  ExpectLine("export " + At("box") + " --format usd -o " + At("usd"),
             file.string() +
                 ": 'name' is '../my box', which cannot name the asset's files (use "
                 "letters, digits, '_' and '-', as in '" +
                 assets::FileSafeName("../my box") + "')");
}

TEST_F(Messages, AUrdfIsImportedBeforeItIsExported) {
  const std::string urdf = Write("arm.urdf", "<robot name='arm'><link name='a'/></robot>");
  ExpectLine("export " + urdf + " --format usd -o " + At("usd"),
             urdf + ": is a file, not the folder of an asset (import it first: simwright import " +
                 urdf + " -o out)");
}

TEST_F(Messages, AnEmptyMesh) {
  const std::string mesh = Write("empty.obj", "");
  ExpectLine("import " + mesh + " --category box --quiet -o " + At("out"),
             mesh + ": the mesh file is empty (copy or download it again)");
  ExpectLine("check " + mesh, mesh + ": is a mesh, not an asset or a URDF (import it first: " +
                                  "simwright import " + mesh + " -o out)");
  EXPECT_FALSE(fs::exists(At("out")));
}

TEST_F(Messages, ATruncatedMjcf) {
  const fs::path mjcf = fs::path(SampleAsset("box")) / (assets::SampleAsset().name + ".xml");
  const std::string text = core::ReadFile(mjcf);
  core::WriteFile(mjcf, text.substr(0, text.size() / 2));
  const Outcome checked = RunProgram("check " + At("box"));
  EXPECT_EQ(checked.code, 1) << checked.text;
  const size_t row = checked.text.find("loads-mujoco");
  ASSERT_NE(row, std::string::npos) << checked.text;
  const std::string line = checked.text.substr(row, checked.text.find('\n', row) - row);
  EXPECT_NE(line.find(mjcf.string() + ": is not whole XML: line "), std::string::npos) << line;
  EXPECT_NE(line.find("(it was cut off or edited: make it again, or correct it there)"),
            std::string::npos)
      << line;
}

}  // namespace
}  // namespace simwright
