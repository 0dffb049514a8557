#include <charconv>
#include <string_view>
#include <vector>

#include "assets/mesh_format.h"
#include "assets/mesh_import.h"
#include "assets/polygon_triangles.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace {

std::string_view NextToken(std::string_view* line) {
  const size_t start = line->find_first_not_of(" \t\r");
  if (start == std::string_view::npos) return {};
  const size_t end = std::min(line->find_first_of(" \t\r", start), line->size());
  const std::string_view token = line->substr(start, end - start);
  line->remove_prefix(end);
  return token;
}

template <typename T>
bool Parse(std::string_view token, T* value) {
  const auto result = std::from_chars(token.data(), token.data() + token.size(), *value);
  return result.ec == std::errc();
}

bool ReadVertex(std::string_view line, core::TriangleMesh* mesh) {
  Eigen::Vector3d v;
  for (int k = 0; k < 3; ++k) {
    if (!Parse(NextToken(&line), &v[k])) return false;
  }
  mesh->vertices.push_back(v);
  return true;
}

bool ReadFace(std::string_view line, core::TriangleMesh* mesh) {
  std::vector<int> indices;
  std::vector<Eigen::Vector3d> corners;
  const int count = static_cast<int>(mesh->vertices.size());
  for (std::string_view token = NextToken(&line); !token.empty(); token = NextToken(&line)) {
    int index = 0;
    if (!Parse(token, &index) || index == 0) return false;
    index = index > 0 ? index - 1 : count + index;
    indices.push_back(index);
    // Indices out of range are rejected at the end.
    if (index >= 0 && index < count) corners.push_back(mesh->vertices[static_cast<size_t>(index)]);
  }
  if (indices.size() < 3) return !indices.empty();  // Blender writes loose edges as faces of two
  if (indices.size() == 3 || corners.size() != indices.size()) {
    for (size_t i = 1; i + 1 < indices.size(); ++i) {
      mesh->triangles.emplace_back(indices[0], indices[i], indices[i + 1]);
    }
    return true;
  }
  for (const Eigen::Vector3i& t : PolygonTriangles(corners)) {
    mesh->triangles.emplace_back(indices[static_cast<size_t>(t[0])],
                                 indices[static_cast<size_t>(t[1])],
                                 indices[static_cast<size_t>(t[2])]);
  }
  return true;
}

}  // namespace

core::TriangleMesh ReadBareObj(const std::filesystem::path& path) {
  RequireMeshFile(path);
  const std::string text = core::ReadFile(path);
  core::TriangleMesh mesh;
  std::string_view rest = text;
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::string_view keyword = NextToken(&line);
    const bool good = keyword == "v"   ? ReadVertex(line, &mesh)
                      : keyword == "f" ? ReadFace(line, &mesh)
                                       : true;
    if (!good) {
      throw core::Error("line " + std::to_string(line_number) + " is not understood", path.string(),
                        "make the file again");
    }
  }
  if (mesh.triangles.empty()) throw core::Error("the mesh has no faces", path.string());
  core::RequireValid(mesh, path.string());
  return mesh;
}

}  // namespace simwright::assets
