#include "assets/mesh_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string_view>

#include "core/error.h"
#include "core/foreign_content.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr const char* kReadFormats = "use OBJ, PLY, STL, glTF, GLB or DAE";
constexpr const char* kByBlender = "open it in Blender and export it as GLB";
constexpr const char* kByCad = "open it in a CAD program (FreeCAD) and export it as STL or OBJ";

struct UnreadFormat {
  const char* ending;
  const char* name;
  const char* remedy;
};

constexpr UnreadFormat kUnreadFormats[] = {
    {".fbx", "FBX", kByBlender},
    {".xacro", "a xacro that was not expanded",
     "expand it first: xacro FILE.xacro > FILE.urdf (ROS 2: ros2 run xacro xacro)"},
    {".blend", "a Blender file", "export it from Blender as GLB"},
    {".usd", "USD", kByBlender},
    {".usda", "USD", kByBlender},
    {".usdc", "USD", kByBlender},
    {".usdz", "USD", kByBlender},
    {".3ds", "3DS", kByBlender},
    {".max", "a 3ds Max file", "export it from 3ds Max as OBJ or glTF"},
    {".ma", "a Maya file", "export it from Maya as OBJ"},
    {".mb", "a Maya file", "export it from Maya as OBJ"},
    {".c4d", "a Cinema 4D file", "export it from Cinema 4D as glTF"},
    {".skp", "a SketchUp file", "export it from SketchUp as DAE or GLB"},
    {".off", "OFF", "convert it to PLY or OBJ (MeshLab)"},
    {".3mf", "3MF", "export it as STL or OBJ"},
    {".amf", "AMF", "export it as STL or OBJ"},
    {".wrl", "VRML", kByBlender},
    {".x3d", "X3D", kByBlender},
    {".step", "STEP", kByCad},
    {".stp", "STEP", kByCad},
    {".iges", "IGES", kByCad},
    {".igs", "IGES", kByCad},
    {".brep", "BREP", kByCad},
    {".sldprt", "a SolidWorks part", "export it from SolidWorks as STL"},
    {".ipt", "an Inventor part", "export it from Inventor as STL"},
    {".drc", "a bare Draco file", "decode it with draco_decoder to OBJ or PLY"},
    {".vrm", "VRM", "it is a GLB: rename it to .glb"},
    {".mtl", "an OBJ's materials", "import the .obj beside it"},
    {".bin", "a glTF's buffer", "import the .gltf beside it"},
};

const UnreadFormat* FindUnread(const fs::path& path) {
  const std::string ending = LowerCaseExtension(path);
  const auto* found = std::find_if(std::begin(kUnreadFormats), std::end(kUnreadFormats),
                                   [&](const auto& format) { return ending == format.ending; });
  return found == std::end(kUnreadFormats) ? nullptr : found;
}

std::string HeadOf(const fs::path& path) {
  std::array<char, 1024> head{};
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), head.size());
  return {head.data(), static_cast<size_t>(in.gcount())};
}

std::string FirstWord(std::string_view head) {
  const size_t start = std::min(head.find_first_not_of(" \t\r\n"), head.size());
  const size_t end = std::min(head.find_first_of(" \t\r\n", start), head.size());
  return std::string(head.substr(start, end - start));
}

// Returns the format that the first bytes identify with certainty, otherwise kUnknown.
MeshFormat FormatByContent(std::string_view head) {
  if (head.starts_with("glTF")) return MeshFormat::kGlb;
  if (FirstWord(head) == "ply") return MeshFormat::kPly;
  if (head.find("<COLLADA") != std::string_view::npos) return MeshFormat::kDae;
  return MeshFormat::kUnknown;
}

const char* EndingOf(MeshFormat format) {
  switch (format) {
    case MeshFormat::kGlb:
      return ".glb";
    case MeshFormat::kPly:
      return ".ply";
    case MeshFormat::kDae:
      return ".dae";
    default:
      return "";
  }
}

}  // namespace

std::string LowerCaseExtension(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

MeshFormat MeshFormatOf(const fs::path& path) {
  const std::string ending = LowerCaseExtension(path);
  if (ending == ".obj") return MeshFormat::kObj;
  if (ending == ".ply") return MeshFormat::kPly;
  if (ending == ".stl") return MeshFormat::kStl;
  if (ending == ".glb") return MeshFormat::kGlb;
  if (ending == ".gltf") return MeshFormat::kGltf;
  if (ending == ".dae") return MeshFormat::kDae;
  return MeshFormat::kUnknown;
}

std::string UnreadMeshFormat(const fs::path& path) {
  const UnreadFormat* unread = FindUnread(path);
  return unread == nullptr ? "" : unread->name;
}

void RequireMeshFile(const fs::path& path) {
  if (!fs::exists(path)) throw core::Error("no such file", path.string());
  if (!fs::is_regular_file(path)) throw core::Error("this is not a file", path.string());
  if (fs::file_size(path) == 0) {
    throw core::Error("the mesh file is empty", path.string(), "copy or download it again");
  }
  const std::string head = HeadOf(path);
  if (const auto foreign = core::FindForeignContent(head)) {
    throw core::Error(foreign->what, path.string(), foreign->remedy);
  }
  const MeshFormat format = MeshFormatOf(path);
  if (format == MeshFormat::kUnknown) {
    if (const UnreadFormat* unread = FindUnread(path)) {
      throw core::Error(std::string("this is ") + unread->name + ", which is not read",
                        path.string(), unread->remedy);
    }
    throw core::Error("this is not a mesh that can be read", path.string(), kReadFormats);
  }
  if (head.starts_with("Kaydara FBX Binary")) {
    throw core::Error("this is FBX by its content, which is not read", path.string(), kByBlender);
  }
  const MeshFormat found = FormatByContent(head);
  if (found != MeshFormat::kUnknown && found != format) {
    throw core::Error("the format does not match the file's extension", path.string(),
                      std::string("rename it to ") + EndingOf(found));
  }
}

}  // namespace simwright::assets
