// The locations of meshes beside a URDF in common package layouts, and the forbidden ones.
#include "assets/urdf_meshes.h"

#include <gtest/gtest.h>

#include <fstream>

#include "assets/semantic_model.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

class UrdfMeshes : public ::testing::Test {
 protected:
  // Makes a file, and the folders above it.
  fs::path Touch(const std::string& name) const {
    const fs::path file = folder_.path() / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "<robot name='r'><link name='a'/></robot>";
    return file;
  }
  // Returns the file that `name` refers to in `urdf`, relative to the temporary folder; "none" or
  // "refused".
  std::string Found(const std::string& urdf, const std::string& name,
                    const std::string& root = "") const {
    const fs::path file = folder_.path() / urdf;
    const MeshFinder finder(file, root.empty() ? PackageRootOf(file) : folder_.path() / root);
    try {
      const auto found = finder.Find(name);
      return found ? found->file.lexically_relative(fs::canonical(folder_.path())).string()
                   : "none";
    } catch (const core::Error&) {
      return "refused";
    }
  }
  core::TemporaryFolder folder_;
};

TEST_F(UrdfMeshes, PackagesInTheirLayouts) {
  Touch("p_description/package.xml");
  Touch("p_description/meshes/body.stl");
  for (const char* urdf :
       {"p_description/robots/r.urdf", "p_description/urdf/r.urdf", "p_description/urdf/arm/r.urdf",
        "p_description/r.urdf", "p_description/config/deep/r.urdf"}) {
    Touch(urdf);
    EXPECT_EQ(Found(urdf, "package://p_description/meshes/body.stl"),
              "p_description/meshes/body.stl")
        << urdf;
    EXPECT_EQ(Found(urdf, "package://other_name/meshes/body.stl"), "p_description/meshes/body.stl")
        << urdf;
  }
}

TEST_F(UrdfMeshes, WithoutAPackageFile) {
  Touch("cab/meshes/body.stl");
  Touch("cab/urdf/r.urdf");
  Touch("cab/model/r.urdf");
  Touch("cab/xyz/r.urdf");
  EXPECT_EQ(Found("cab/urdf/r.urdf", "package://meshes/body.stl"), "cab/meshes/body.stl");
  EXPECT_EQ(Found("cab/urdf/r.urdf", "package://cab/meshes/body.stl"), "cab/meshes/body.stl");
  EXPECT_EQ(Found("cab/model/r.urdf", "../meshes/body.stl"), "cab/meshes/body.stl");
  EXPECT_EQ(Found("cab/xyz/r.urdf", "../meshes/body.stl"), "cab/meshes/body.stl");
  Touch("cab/secret/body.stl");
  EXPECT_EQ(Found("cab/xyz/r.urdf", "../secret/body.stl"), "refused");
  EXPECT_EQ(Found("cab/xyz/r.urdf", "../meshes/../secret/body.stl"), "refused");
}

TEST_F(UrdfMeshes, NamesAsOtherSystemsWriteThem) {
  Touch("cab/my meshes/Body.STL");
  Touch("cab/meshes/visual/link.stl");
  Touch("cab/a%20b.stl");
  Touch("cab/r.urdf");
  EXPECT_EQ(Found("cab/r.urdf", "my%20meshes/Body.STL"), "cab/my meshes/Body.STL");
  EXPECT_EQ(Found("cab/r.urdf", "a%20b.stl"), "cab/a%20b.stl");  // the exact name comes first
  EXPECT_EQ(Found("cab/r.urdf", "meshes\\visual\\link.stl"), "cab/meshes/visual/link.stl");
  EXPECT_EQ(Found("cab/r.urdf", ".\\meshes/visual\\link.stl"), "cab/meshes/visual/link.stl");
  EXPECT_EQ(Found("cab/r.urdf", "Meshes/Visual/LINK.stl"), "cab/meshes/visual/link.stl");
  EXPECT_EQ(Found("cab/r.urdf", "model://cab/meshes/visual/link.stl"),
            "cab/meshes/visual/link.stl");
  EXPECT_EQ(Found("cab/r.urdf", "file://meshes/visual/link.stl"), "cab/meshes/visual/link.stl");
  EXPECT_EQ(Found("cab/r.urdf", "file://" + (folder_.path() / "cab/a%20b.stl").string()),
            "cab/a%20b.stl");
  EXPECT_EQ(Found("cab/r.urdf", "https://example.org/link.stl"), "none");
  EXPECT_EQ(Found("cab/r.urdf", ""), "none");
}

TEST_F(UrdfMeshes, PathsOfAnotherMachineEndInTheFolder) {
  Touch("cab/meshes/body.stl");
  Touch("cab/r.urdf");
  for (const char* name :
       {"file:///home/user/ws/install/cab/share/cab/meshes/body.stl",
        "/home/user/ws/src/cab/meshes/body.stl", "C:\\robots\\cab\\meshes\\body.stl",
        "file:///home/user/cab/../cab/meshes/body.stl"}) {
    EXPECT_EQ(Found("cab/r.urdf", name), "cab/meshes/body.stl") << name;
    const MeshFinder finder(folder_.path() / "cab/r.urdf", folder_.path() / "cab");
    EXPECT_NE(finder.Find(name)->resolution_note.find("meshes/body.stl"), std::string::npos)
        << name;
  }
  EXPECT_EQ(Found("cab/r.urdf", "/home/user/elsewhere.stl"), "none");
  const MeshFinder finder(folder_.path() / "cab/r.urdf", folder_.path() / "cab");
  EXPECT_EQ(finder.Find("meshes/body.stl")->resolution_note, "");
}

TEST_F(UrdfMeshes, NothingOutsideIsRead) {
  Touch("outside.stl");
  Touch("cab/meshes/body.stl");
  Touch("cab/r.urdf");
  fs::create_symlink(folder_.path() / "outside.stl", folder_.path() / "cab/link.stl");
  fs::create_directory_symlink(folder_.path(), folder_.path() / "cab/up");
  for (const char* name :
       {"../outside.stl", "link.stl", "up/outside.stl", "/etc/passwd", "file:///etc/passwd",
        "package://x/../../outside.stl", "model://cab/../../outside.stl", "..\\outside.stl",
        "%2e%2e/outside.stl", "meshes/../../outside.stl"}) {
    EXPECT_EQ(Found("cab/r.urdf", name, "cab"), "refused") << name;
  }
  // A link beside the folder, called like a folder of meshes.
  fs::create_directory_symlink("/etc", folder_.path() / "meshes");
  EXPECT_EQ(Found("cab/r.urdf", "../meshes/passwd"), "refused");
}

TEST_F(UrdfMeshes, AFolderIsItsOnlyUrdfOrNamesThemAll) {
  const fs::path only = Touch("one/urdf/r.urdf");
  Touch("one/meshes/body.stl");
  EXPECT_EQ(UrdfIn(folder_.path() / "one"), only);
  Touch("two/package.xml");
  Touch("two/robots/left.urdf");
  Touch("two/robots/right.urdf");
  const auto error_of = [&](const char* name) -> std::string {
    try {
      UrdfIn(folder_.path() / name);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string several = error_of("two");
  for (const char* word : {"2 URDFs", "robots/left.urdf", "robots/right.urdf"}) {
    EXPECT_NE(several.find(word), std::string::npos) << several;
  }
  Touch("x/package.xml");
  Touch("x/urdf/r.urdf.xacro");
  EXPECT_NE(error_of("x").find("xacro"), std::string::npos) << error_of("x");
}

}  // namespace
}  // namespace simwright::assets
