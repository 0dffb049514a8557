// PLY and STL as scanners and CAD programs write them.
#include "mesh_files.h"

#include "assets/polygon_triangles.h"

namespace simwright::assets {
namespace {

class PlyImport : public MeshFolder {
 protected:
  // Bytes of values, of either byte order.
  class Bytes {
   public:
    explicit Bytes(bool big) : big_(big) {}
    template <typename Value>
    Bytes& Add(Value value) {
      char bytes[sizeof(Value)];
      std::memcpy(bytes, &value, sizeof(Value));
      if (big_) std::reverse(bytes, bytes + sizeof(Value));
      text_.append(bytes, sizeof(Value));
      return *this;
    }
    const std::string& text() const { return text_; }

   private:
    bool big_;
    std::string text_;
  };

  static std::string Header(const std::string& format, const std::string& vertex,
                            const std::string& face, const std::string& comments = "") {
    return "ply\nformat " + format + " 1.0\n" + comments + "element vertex 4\n" + vertex +
           "element face 4\n" + face + "end_header\n";
  }
  static std::string Ascii(const std::string& vertex, const std::string& face,
                           const std::vector<std::string>& vertex_tails,
                           const std::vector<std::string>& face_tails,
                           const std::string& comments = "") {
    std::string text = Header("ascii", kXyz + vertex, kList + face, comments);
    for (size_t i = 0; i < 4; ++i) {
      for (const float x : kTetrahedron[i]) text += std::to_string(x) + " ";
      text += (vertex_tails.empty() ? "" : vertex_tails[i]) + "\n";
    }
    for (size_t i = 0; i < 4; ++i) {
      text += "3";
      for (const int index : kTetrahedronFaces[i]) text += " " + std::to_string(index);
      text += (face_tails.empty() ? "" : " " + face_tails[i]) + "\n";
    }
    return text;
  }
  static void ExpectCorners(const MeshFile& file) {
    // Face 0 has corners 0, 2, 1: red, blue, green.
    const Eigen::Vector3f truth[3] = {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR((Shown(file.mesh, 0, Eigen::Vector3f::Unit(k)).head<3>() - truth[k]).norm(), 0.0,
                  0.01);
    }
    EXPECT_NEAR(Volume(file.mesh.mesh), 1.0 / 6.0, 1e-9);
    EXPECT_TRUE(file.findings.empty());
  }

  inline static const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
  inline static const std::string kList = "property list uchar int vertex_indices\n";
  inline static const std::vector<std::string> kBytes{"255 0 0", "0 255 0", "0 0 255", "255 255 0"};
  inline static const std::vector<std::string> kFractions{"1 0 0", "0 1 0", "0 0 1", "1 1 0"};
};

TEST_F(PlyImport, ColoursOfVerticesUnderAllTheirNames) {
  const auto colors = [](const std::string& type, const std::string& prefix) {
    return "property " + type + " " + prefix + "red\nproperty " + type + " " + prefix +
           "green\nproperty " + type + " " + prefix + "blue\n";
  };
  ExpectCorners(ReadMeshFile(Write("u.ply", Ascii(colors("uchar", ""), "", kBytes, {}))));
  ExpectCorners(ReadMeshFile(Write("d.ply", Ascii(colors("uint8", "diffuse_"), "", kBytes, {}))));
  ExpectCorners(ReadMeshFile(Write("f.ply", Ascii(colors("float", ""), "", kFractions, {}))));
  ExpectCorners(ReadMeshFile(Write("g.ply", Ascii(colors("float", ""), "", kBytes, {}))));
  ExpectCorners(ReadMeshFile(Write(
      "r.ply", Ascii("property uchar r\nproperty uchar g\nproperty uchar b\n", "", kBytes, {}))));
}

TEST_F(PlyImport, BinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string text = Header(big ? "binary_big_endian" : "binary_little_endian",
                              "property double x\nproperty double y\nproperty double z\n"
                              "property ushort red\nproperty ushort green\nproperty ushort blue\n",
                              "property list uint uint vertex_index\nproperty short flags\n");
    Bytes bytes(big);
    const std::uint16_t colors[4][3] = {{65535, 0, 0}, {0, 65535, 0}, {0, 0, 65535}, {9, 9, 9}};
    for (size_t i = 0; i < 4; ++i) {
      for (const float x : kTetrahedron[i]) bytes.Add(static_cast<double>(x));
      for (const std::uint16_t c : colors[i]) bytes.Add(c);
    }
    for (const auto& face : kTetrahedronFaces) {
      bytes.Add(std::uint32_t{3});
      for (const int index : face) bytes.Add(static_cast<std::uint32_t>(index));
      bytes.Add(std::int16_t{7});
    }
    ExpectCorners(ReadMeshFile(Write("b.ply", text + bytes.text())));
    for (const size_t cut : {1u, 5u, 60u, 120u}) {
      const std::string whole = text + bytes.text();
      EXPECT_NE(Refusal(Write("cut.ply", whole.substr(0, whole.size() - cut))).find("cut short"),
                std::string::npos);
    }
  }
}

TEST_F(PlyImport, ColoursOfFacesBecomeMaterials) {
  const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const MeshFile file = ReadMeshFile(Write("f.ply", Ascii("", colors, {}, kBytes)));
  EXPECT_TRUE(file.mesh.textures.empty());
  const Eigen::Vector3f truth[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
  for (size_t t = 0; t < 4; ++t) {
    EXPECT_NEAR((Shown(file.mesh, t).head<3>() - truth[t]).norm(), 0.0, 1e-6) << t;
  }
}

TEST_F(PlyImport, TexturesByVertexAndByCorner) {
  WriteRedBlue("skin.png");
  const std::string comment = "comment TextureFile skin.png\n";
  // By vertex: only vertex 1 is on the right.
  for (const char* names : {"s t", "u v", "texture_u texture_v"}) {
    std::string first(names), second;
    second = first.substr(first.find(' ') + 1);
    first.resize(first.find(' '));
    const MeshFile file = ReadMeshFile(
        Write("v.ply", Ascii("property float " + first + "\nproperty float " + second + "\n", "",
                             {"0.25 0", "0.75 0", "0.25 1", "0.25 1"}, {}, comment)));
    ASSERT_EQ(file.mesh.textures.size(), 1u) << names;
    EXPECT_GT(Shown(file.mesh, 0, {0, 0, 1})[2], 0.9f) << names;  // vertex 1
    EXPECT_GT(Shown(file.mesh, 0, {1, 0, 0})[0], 0.9f) << names;
  }
  // By corner, as MeshLab and Metashape write it: face 1 is blue, the others red, though they
  // share vertices.
  const std::string red = "6 0.25 0 0.25 0 0.25 0", blue = "6 0.75 0 0.75 0 0.75 0";
  const MeshFile file =
      ReadMeshFile(Write("w.ply", Ascii("", "property list uchar float texcoord\n", {},
                                        {red, blue, red, red}, comment)));
  EXPECT_GT(Shown(file.mesh, 0)[0], 0.9f);
  EXPECT_GT(Shown(file.mesh, 1)[2], 0.9f);
  EXPECT_GT(Shown(file.mesh, 2)[0], 0.9f);
  EXPECT_EQ(
      CountOf(ReadMeshFile(Write("m.ply", Ascii("", "", {}, {}, "comment TextureFile gone.png\n"))),
              "texture-missing"),
      1);
}

TEST_F(PlyImport, StripsAndPolygons) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 4\n" + kXyz +
                     "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                     "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 3\n";
  const core::TexturedMesh strips = ReadMesh(Write("s.ply", text));
  ASSERT_EQ(strips.mesh.triangles.size(), 3u);
  for (int t = 0; t < 3; ++t) EXPECT_GT(core::TriangleAreaVector(strips.mesh, t).z(), 0.9) << t;
}

TEST_F(PlyImport, WhatHasNoSurfaceIsNamed) {
  EXPECT_NE(Refusal(Write("cloud.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + kXyz +
                                           "end_header\n0 0 0\n"))
                .find("point cloud"),
            std::string::npos);
  EXPECT_NE(Refusal(Write("splat.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + kXyz +
                                           "property float f_dc_0\nproperty float rot_0\n"
                                           "end_header\n0 0 0 1 1\n"))
                .find("Gaussian splats"),
            std::string::npos);
  EXPECT_NE(Refusal(Write("index.ply",
                          Ascii("", "", {}, {})
                              .replace(Ascii("", "", {}, {}).rfind("3 0 3 2"), 7, "3 0 3 9")))
                .find("vertex 9"),
            std::string::npos);
  EXPECT_NE(Refusal(Write("huge.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\n" + kXyz +
                                          "end_header\n0 0 0\n")),
            "");
}

TEST(PolygonTriangles, CoverConcavePolygonsOnce) {
  const auto area = [](const std::vector<Eigen::Vector3d>& corners) {
    double sum = 0.0, absolute = 0.0;
    for (const Eigen::Vector3i& t : PolygonTriangles(corners)) {
      const Eigen::Vector3d &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
      const double z = 0.5 * (b - a).cross(c - a).z();
      sum += z;
      absolute += std::abs(z);
    }
    EXPECT_NEAR(sum, absolute, 1e-12);
    return sum;
  };
  EXPECT_NEAR(area({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}), 3.0, 1e-12);
  EXPECT_NEAR(area({{0, 0, 0}, {2, 2, 0}, {0, 1, 0}, {-2, 2, 0}}), 2.0, 1e-12);  // an arrow head
  EXPECT_NEAR(area({{1, 1, 0},
                    {0, 4, 0},
                    {-1, 1, 0},
                    {-4, 0, 0},
                    {-1, -1, 0},
                    {0, -4, 0},
                    {1, -1, 0},
                    {4, 0, 0}}),
              16.0, 1e-12);  // a star
}

class StlImport : public MeshFolder {
 protected:
  static std::string Binary(const std::string& head, const std::vector<std::uint16_t>& attributes) {
    std::string bytes = head;
    bytes.resize(80, '\0');
    const std::uint32_t count = 4;
    bytes.append(reinterpret_cast<const char*>(&count), 4);
    for (size_t f = 0; f < 4; ++f) {
      float values[12] = {};
      for (int k = 0; k < 3; ++k) {
        std::copy_n(kTetrahedron[kTetrahedronFaces[f][k]], 3, values + 3 + 3 * k);
      }
      bytes.append(reinterpret_cast<const char*>(values), sizeof(values));
      bytes.append(reinterpret_cast<const char*>(&attributes[f]), 2);
    }
    return bytes;
  }
};

TEST_F(StlImport, BinaryBehindTheWordSolidAndAsciiAreOne) {
  EXPECT_NEAR(Volume(ReadMesh(Write("s.stl", Binary("solid part", {0, 0, 0, 0}))).mesh), 1.0 / 6.0,
              1e-9);
  std::string text = "solid part\n";
  for (const auto& face : kTetrahedronFaces) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const int i : face) {
      text += "  vertex " + std::to_string(kTetrahedron[i][0]) + " " +
              std::to_string(kTetrahedron[i][1]) + " " + std::to_string(kTetrahedron[i][2]) + "\n";
    }
    text += " endloop\nendfacet\n";
  }
  EXPECT_NEAR(Volume(ReadMesh(Write("a.stl", text + "endsolid part\n")).mesh), 1.0 / 6.0, 1e-9);
  EXPECT_NE(Refusal(Write("cut.stl", Binary("", {0, 0, 0, 0}).substr(0, 150))), "");
}

// VisCAM: bit 15 set, five bits each of red, green, blue. Magics: "COLOR=" in the header.
TEST_F(StlImport, ColoursOfFacetsBecomeMaterials) {
  const MeshFile file = ReadMeshFile(Write(
      "c.stl", Binary("made", {0x8000 | 31 << 10, 0x8000 | 31 << 5, 0x8000 | 31, 0x8000 | 31})));
  const Eigen::Vector3f truth[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}};
  for (size_t t = 0; t < 4; ++t) {
    EXPECT_NEAR((Shown(file.mesh, t).head<3>() - truth[t]).norm(), 0.0, 0.05) << t;
  }
  const MeshFile magics = ReadMeshFile(
      Write("m.stl", Binary("COLOR=\xff\x00\x00\xff rest", {0x8000, 0x8000, 31, 0x8000})));
  EXPECT_GT(magics.mesh.materials.size(), 0u);
}

}  // namespace
}  // namespace simwright::assets
