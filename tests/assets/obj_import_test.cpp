// OBJ and MTL as other programs write them: names of another machine, odd numbers, odd statements.
#include "mesh_files.h"

#include "assets/mtl_file.h"
#include "assets/obj_file.h"
#include "assets/primitive_meshes.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

class ObjImport : public MeshFolder {
 protected:
  // A square whose left half shows the left half of its texture.
  fs::path WriteSquare(const std::string& mtl, const std::string& name = "a.obj") {
    Write("a.mtl", mtl);
    return Write(name,
                 "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                 "vt 0 1\nusemtl wood\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  }
  static bool ShowsRedAndBlue(const core::TexturedMesh& mesh) {
    const Eigen::Vector4f right = Shown(mesh, 0, {0.1f, 0.8f, 0.1f});  // near (1, 0)
    const Eigen::Vector4f left = Shown(mesh, 1, {0.1f, 0.1f, 0.8f});   // near (0, 1)
    return right[2] > 0.9f && right[0] < 0.1f && left[0] > 0.9f && left[2] < 0.1f;
  }
};

struct Naming {
  const char* written;
  const char* place;  // below the mesh's folder
  bool elsewhere;     // a finding reports another location
};

TEST_F(ObjImport, TexturesAreFoundByNamesOfOtherMachines) {
  const Naming cases[] = {
      {"wood.png", "wood.png", false},
      {"tex\\wood.png", "tex/wood.png", false},
      {"..\\textures\\wood.png", "../textures/wood.png", false},
      {"../Textures/wood.png", "../textures/wood.png", false},
      {"WOOD.PNG", "wood.png", false},
      {"Tex/Wood.png", "tex/wood.png", false},
      {"C:\\Users\\me\\Desktop\\wood.png", "wood.png", true},
      {"/home/me/wood.png", "textures/wood.png", true},
      {"wood.png", "textures/wood.png", true},
      {"wood.png", "../textures/wood.png", true},
      {"my fine wood.png", "my fine wood.png", false},
      {"-s 1 1 1 -o 0 0 0 -clamp off -mm 0 1 -bm 1 my wood.png", "my wood.png", false},
      {"wood%201.png", "wood 1.png", false},
      {"./wood.png  ", "wood.png", false},
      {"wood#1.png", "wood#1.png", false},
  };
  for (const Naming& naming : cases) {
    WriteRedBlue(naming.place);
    const MeshFile file = ReadMeshFile(
        WriteSquare("newmtl wood\nKd 1 1 1\nmap_Kd " + std::string(naming.written) + "\r\n"));
    ASSERT_EQ(file.mesh.textures.size(), 1u) << naming.written;
    EXPECT_TRUE(ShowsRedAndBlue(file.mesh)) << naming.written;
    EXPECT_EQ(CountOf(file, "texture-elsewhere"), naming.elsewhere ? 1 : 0) << naming.written;
    EXPECT_EQ(file.findings.size(), naming.elsewhere ? 1u : 0u) << naming.written;
    fs::remove(folder_ / naming.place);
  }
}

TEST_F(ObjImport, TexturesOutsideAreNotRead) {
  WriteRedBlue("../secret.png");
  WriteRedBlue("../private/wood.png");
  fs::create_directories(folder_ / "tex");
  fs::create_symlink(root_ / "secret.png", folder_ / "tex" / "link.png");
  for (const char* name : {"../secret.png", "..\\private\\wood.png", "tex/link.png",
                           "textures/../../secret.png", "../textures/../secret.png"}) {
    const MeshFile file =
        ReadMeshFile(WriteSquare("newmtl wood\nKd 1 1 1\nmap_Kd " + std::string(name) + "\n"));
    EXPECT_TRUE(file.mesh.textures.empty()) << name;
    ASSERT_EQ(CountOf(file, "texture-missing"), 1) << name;
    EXPECT_FALSE(file.findings[0].remedy.empty());
  }
}

TEST_F(ObjImport, TextureThatIsNoPictureIsNamed) {
  const auto finding = [&](const std::string& bytes) {
    Write("wood.png", bytes);
    const MeshFile file = ReadMeshFile(WriteSquare("newmtl wood\nmap_Kd wood.png\n"));
    EXPECT_EQ(CountOf(file, "texture-unreadable"), 1);
    return file.findings.empty() ? "" : file.findings[0].sentence;
  };
  using namespace std::literals;
  EXPECT_NE(finding("version https://git-lfs.github.com/spec/v1\n").find("LFS"), std::string::npos);
  EXPECT_NE(finding("\0\0\0\x18"s + "ftypheic" + std::string(20, '\0')).find("HEIC"),
            std::string::npos);
  EXPECT_NE(finding("\xabKTX 20\xbb\r\n"s).find("KTX2"), std::string::npos);
  EXPECT_NE(finding("DDS |").find("DDS"), std::string::npos);
  EXPECT_NE(finding("").find("empty"), std::string::npos);
}

TEST(MtlFile, OptionsOpacityAndNamesAreRead) {
  const std::vector<MtlMaterial> materials = ReadMtl(
      "\xef\xbb\xbf# comment\r\nnewmtl my wood\r\nKd 0.5\r\nd 0.25\r\nTr 0.1\r\n"
      "map_Kd -s 2 3 1 -o 0.5 0.25 -clamp on -t 0 0 0 a b.png\r\n"
      "newmtl glass\nTr 0.75\nmap_Bump n.png\nnorm n2.png\n"
      "newmtl halo\nd -halo 0.5\nmap_Ka only.png\n"
      "newmtl glass\nKd 1 0 0\nTr 0.5\n");
  ASSERT_EQ(materials.size(), 3u);
  EXPECT_EQ(materials[0].name, "my wood");
  EXPECT_FLOAT_EQ(materials[0].diffuse.x(), 0.5f);
  EXPECT_FLOAT_EQ(materials[0].diffuse.z(), 0.5f);  // one number applies to all channels
  EXPECT_FLOAT_EQ(materials[0].opacity, 0.25f);     // d before Tr
  EXPECT_EQ(materials[0].texture, "a b.png");
  EXPECT_EQ(materials[0].uv_scale, Eigen::Vector2f(2, 3));
  EXPECT_EQ(materials[0].uv_offset, Eigen::Vector2f(0.5f, 0.25f));
  EXPECT_TRUE(materials[0].clamp);
  EXPECT_FLOAT_EQ(materials[1].opacity, 0.5f);  // the later of two
  EXPECT_FLOAT_EQ(materials[1].diffuse.x(), 1.0f);
  EXPECT_FLOAT_EQ(materials[2].opacity, 0.5f);
  EXPECT_EQ(materials[2].texture, "only.png");
}

TEST_F(ObjImport, TextureOptionsMoveCoordinates) {
  WriteRedBlue("w.png");
  const core::TexturedMesh mesh =
      ReadMesh(WriteSquare("newmtl wood\nKd 1 1 1\nmap_Kd -s 2 3 -o 0.5 0.25 w.png\n"));
  // The square's corner (1, 1): 1 * 2 + 0.5, 1 * 3 + 0.25.
  EXPECT_NEAR((mesh.corner_uvs[2] - Eigen::Vector2f(2.5f, 3.25f)).norm(), 0.0, 1e-6);
}

// Shells complete "./a.obj": the textures beside its folder must be found.
TEST_F(ObjImport, PathsWithDotsFindTheSameTextures) {
  WriteRedBlue("../textures/wood.png");
  WriteSquare("newmtl wood\nKd 1 1 1\nmap_Kd ..\\textures\\wood.png\n");
  for (const fs::path& path : {folder_ / "." / "a.obj", folder_ / ".." / "source" / "a.obj"}) {
    const MeshFile file = ReadMeshFile(path);
    EXPECT_EQ(file.mesh.textures.size(), 1u) << path;
    EXPECT_TRUE(file.findings.empty()) << path;
  }
}

TEST_F(ObjImport, ClampedTexturesThatRepeatAreSaid) {
  WriteRedBlue("w.png");
  EXPECT_EQ(
      CountOf(ReadMeshFile(WriteSquare("newmtl wood\nmap_Kd -clamp on w.png\n")), "texture-wraps"),
      0);
  EXPECT_EQ(CountOf(ReadMeshFile(WriteSquare("newmtl wood\nmap_Kd -s 2 2 -clamp on w.png\n")),
                    "texture-wraps"),
            1);
}

TEST_F(ObjImport, WhollyTransparentMaterialsAreShownAndSaid) {
  for (const char* line : {"d 0", "Tr 1"}) {
    const MeshFile file =
        ReadMeshFile(WriteSquare("newmtl wood\nKd 1 0 0\n" + std::string(line) + "\n"));
    EXPECT_EQ(CountOf(file, "material-invisible"), 1) << line;
    EXPECT_FLOAT_EQ(Shown(file.mesh, 0)[3], 1.0f) << line;
  }
  // An unused invisible material is not reported.
  EXPECT_TRUE(
      ReadMeshFile(WriteSquare("newmtl air\nd 0\nnewmtl wood\nKd 1 0 0\n")).findings.empty());
}

TEST_F(ObjImport, MaterialsThatAreMissingAreSaid) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl my paint\nf 1 2 3\n";
  MeshFile file = ReadMeshFile(Write("none.obj", "mtllib gone.mtl\n" + square));
  EXPECT_EQ(CountOf(file, "mtl-missing"), 1);
  EXPECT_EQ(CountOf(file, "material-missing"), 1);
  EXPECT_EQ(file.mesh.materials[static_cast<size_t>(file.mesh.triangle_material[0])].name,
            "my paint");
  // A library with the mesh's own name is used and reported.
  Write("own.mtl", "newmtl my paint\nKd 0 1 0\n");
  file = ReadMeshFile(Write("own.obj", square));
  EXPECT_EQ(CountOf(file, "mtl-guessed"), 1);
  EXPECT_FLOAT_EQ(Shown(file.mesh, 0)[1], 1.0f);
  // Names with spaces, in another case, or several on one line.
  Write("two words.mtl", "newmtl my paint\nKd 0 0 1\n");
  for (const char* name : {"two words.mtl", "TWO Words.MTL", ".\\two words.mtl"}) {
    file = ReadMeshFile(Write("two.obj", "mtllib " + std::string(name) + "\n" + square));
    EXPECT_TRUE(file.findings.empty()) << name;
    EXPECT_FLOAT_EQ(Shown(file.mesh, 0)[2], 1.0f) << name;
  }
  file = ReadMeshFile(Write("list.obj", "mtllib nothing.mtl own.mtl\n" + square));
  EXPECT_FLOAT_EQ(Shown(file.mesh, 0)[1], 1.0f);
  EXPECT_EQ(CountOf(file, "mtl-missing"), 1);
}

TEST_F(ObjImport, UnreadMapsAndSurfacesAreSaid) {
  Write("a.mtl", "newmtl wood\nKd 1 1 1\nmap_Bump n.png\nmap_d cut.png\n");
  const MeshFile file =
      ReadMeshFile(Write("a.obj",
                         "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl wood\nf 1 2 3\n"
                         "cstype bezier\nsurf 0 1 0 1 1 2 3\nend\n"));
  EXPECT_EQ(CountOf(file, "mtl-not-read"), 1);
  EXPECT_EQ(CountOf(file, "obj-surfaces"), 1);
}

// Statements as they occur: negative indices, continued lines, polygons, a concave one, weights.
TEST_F(ObjImport, OddStatementsKeepTheShape) {
  const std::string corners = "v 0 0 0 1.0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const MeshFile negative = ReadMeshFile(Write(
      "n.obj", corners + "s 1\ng a b\nf -4 -2 -3\nf -4 -3 \\\n-1 # comment\nf 2 3 4\nf 1 4 3\n"));
  EXPECT_NEAR(Volume(negative.mesh.mesh), 1.0 / 6.0, 1e-9);
  EXPECT_EQ(negative.mesh.mesh.vertices.size(), 4u);
  // An L of area 3 out of one polygon.
  const core::TexturedMesh concave = ReadMesh(
      Write("l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n"));
  double area = 0.0;
  for (size_t t = 0; t < concave.mesh.triangles.size(); ++t) {
    area += 0.5 * core::TriangleAreaVector(concave.mesh, static_cast<int>(t)).z();
  }
  EXPECT_NEAR(area, 3.0, 1e-9);
}

TEST_F(ObjImport, ColoursAtVerticesAreKept) {
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string fractions = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 1 1 1 0\n";
  const std::string bytes =
      "v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 0 0 255\nv 0 0 1 255 255 0\n";
  for (const std::string& vertices : {fractions, bytes}) {
    const MeshFile file = ReadMeshFile(Write("c.obj", vertices + faces));
    ASSERT_EQ(file.mesh.textures.size(), 1u);
    EXPECT_NEAR(Volume(file.mesh.mesh), 1.0 / 6.0, 1e-9);
    // Face 1 is red, blue, green; its middle is their mean.
    EXPECT_NEAR((Shown(file.mesh, 0, {1, 0, 0}).head<3>() - Eigen::Vector3f(1, 0, 0)).norm(), 0,
                0.01);
    EXPECT_NEAR((Shown(file.mesh, 0, {0, 1, 0}).head<3>() - Eigen::Vector3f(0, 0, 1)).norm(), 0,
                0.01);
    EXPECT_NEAR((Shown(file.mesh, 0, {0, 0, 1}).head<3>() - Eigen::Vector3f(0, 1, 0)).norm(), 0,
                0.01);
  }
  // One vertex without a colour: the others keep theirs.
  const MeshFile mixed = ReadMeshFile(
      Write("m.obj", "v 0 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 1 0\nv 0 0 1 0 1 0\n" + faces));
  EXPECT_NEAR((Shown(mixed.mesh, 2).head<3>() - Eigen::Vector3f(0, 1, 0)).norm(), 0, 0.01);
  EXPECT_NEAR((Shown(mixed.mesh, 0, {1, 0, 0}).head<3>() - Eigen::Vector3f(1, 1, 1)).norm(), 0,
              0.01);
}

// The files in an asset's folder, visual.obj with its materials and image, show the same colours.
TEST_F(ObjImport, ColoursAtVerticesSurviveInVisualObj) {
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  // The first triangle's corners differ; the second is red all over.
  for (const char* last : {" 1 1 0", " 1 0 0"}) {
    const bool plain = std::string(last) == " 1 0 0";
    std::string vertices = "v 0 0 0 1 0 0\n";
    vertices += plain ? "v 1 0 0 1 0 0\nv 0 1 0 1 0 0\n" : "v 1 0 0 0 1 0\nv 0 1 0 0 0 1\n";
    const MeshFile file = ReadMeshFile(Write("c.obj", vertices + "v 0 0 1" + last + "\n" + faces));
    EXPECT_EQ(file.mesh.textures.size(), plain ? 0u : 1u);
    fs::create_directories(folder_ / "asset");
    WriteVisual(file.mesh, folder_ / "asset");
    const MeshFile back = ReadMeshFile(folder_ / "asset" / "visual.obj");
    EXPECT_TRUE(back.findings.empty());
    ASSERT_EQ(back.mesh.mesh.triangles.size(), 4u);
    for (size_t t = 0; t < 4; ++t) {
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3f weights = Eigen::Vector3f::Unit(k);
        EXPECT_NEAR((Shown(back.mesh, t, weights) - Shown(file.mesh, t, weights)).norm(), 0.0,
                    0.01);
      }
    }
  }
}

}  // namespace
}  // namespace simwright::assets
