#include "assets/mesh_archive.h"

#include <zip.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "assets/mesh_format.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr zip_int64_t kMostEntries = 1000;
constexpr zip_uint64_t kMostBytes = 1ull << 30;  // of all entries

struct ArchiveCloser {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
using Archive = std::unique_ptr<zip_t, ArchiveCloser>;

// Returns true for a mesh, its materials or a picture.
bool BelongsToMesh(const fs::path& entry) {
  static const std::set<std::string> endings = {".glb", ".gltf", ".bin",  ".obj",  ".mtl", ".ply",
                                                ".png", ".jpg",  ".jpeg", ".webp", ".bmp", ".tga"};
  return endings.contains(LowerCaseExtension(entry));
}

bool StaysInside(const std::string& name) {
  const fs::path path = fs::path(name).lexically_normal();
  return !name.empty() && name[0] != '/' && name.find('\\') == std::string::npos &&
         name.find('\0') == std::string::npos && !path.empty() && *path.begin() != "..";
}

std::string ReadEntry(zip_t* archive, zip_uint64_t index, zip_uint64_t size,
                      const std::string& where) {
  zip_file_t* file = zip_fopen_index(archive, index, 0);
  if (file == nullptr) throw core::Error("an entry of the zip is damaged or encrypted", where);
  std::string bytes(size, '\0');
  const zip_int64_t count = zip_fread(file, bytes.data(), size);
  if (zip_fclose(file) != 0 || count != static_cast<zip_int64_t>(size)) {
    throw core::Error("an entry of the zip is damaged", where);
  }
  return bytes;
}

// Returns the only path with the first ending that occurs.
fs::path OnlyMesh(const std::vector<fs::path>& files, const std::string& where) {
  for (const char* ending : {".glb", ".obj", ".ply"}) {
    std::vector<fs::path> meshes;
    std::copy_if(files.begin(), files.end(), std::back_inserter(meshes),
                 [&](const fs::path& file) { return LowerCaseExtension(file) == ending; });
    if (meshes.size() == 1) return meshes.front();
    if (meshes.size() > 1) {
      throw core::Error("the zip has several meshes: '" + meshes[0].filename().string() +
                            "' and '" + meshes[1].filename().string() + "'",
                        where, "it must have one");
    }
  }
  throw core::Error("the zip has no GLB, OBJ or PLY", where);
}

}  // namespace

fs::path ExtractMeshArchive(const fs::path& archive, const fs::path& folder) {
  const std::string where = archive.string();
  int code = 0;
  const Archive zip(zip_open(archive.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &code));
  if (zip == nullptr) throw core::Error("is not a zip, or a damaged one", where);
  const zip_int64_t count = zip_get_num_entries(zip.get(), 0);
  if (count > kMostEntries) throw core::Error("the zip has more than 1000 entries", where);
  zip_uint64_t total = 0;
  std::vector<fs::path> files;
  for (zip_int64_t i = 0; i < count; ++i) {
    const auto index = static_cast<zip_uint64_t>(i);
    const char* text = zip_get_name(zip.get(), index, 0);
    const std::string name = text == nullptr ? "" : text;
    if (!StaysInside(name)) {
      throw core::Error("an entry of the zip leads outside its folder: '" + name + "'", where);
    }
    if (name.back() == '/' || !BelongsToMesh(name)) continue;
    zip_stat_t stat;
    if (zip_stat_index(zip.get(), index, 0, &stat) != 0 || !(stat.valid & ZIP_STAT_SIZE)) {
      throw core::Error("an entry of the zip is damaged", where);
    }
    if (stat.size > kMostBytes - total) {
      throw core::Error("the zip unpacks to more than 1 GiB", where);
    }
    total += stat.size;
    const fs::path file = folder / fs::path(name).lexically_normal();
    std::error_code failed;
    fs::create_directories(file.parent_path(), failed);
    if (failed) {
      throw core::Error("an entry of the zip is both a file and a folder: " + name, where);
    }
    core::WriteFile(file, ReadEntry(zip.get(), index, stat.size, where));
    files.push_back(file);
  }
  return OnlyMesh(files, where);
}

}  // namespace simwright::assets
