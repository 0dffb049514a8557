// Zips with a mesh from anywhere: core::Error or a mesh inside the folder, nothing else.
#include <cstdint>
#include <cstdlib>

#include "assets/mesh_archive.h"
#include "core/error.h"
#include "temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const simwright::fuzz::TemporaryFile file("input.zip");
  const std::filesystem::path& path = file.Write(data, size);
  const std::filesystem::path folder = path.parent_path() / "unpacked";
  std::filesystem::create_directories(folder);
  try {
    const std::filesystem::path mesh = simwright::assets::ExtractMeshArchive(path, folder);
    if (mesh.lexically_relative(folder).string().rfind("..", 0) == 0) std::abort();
  } catch (const simwright::core::Error&) {
  }
  std::filesystem::remove_all(folder);
  return 0;
}
