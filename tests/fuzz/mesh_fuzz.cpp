// Meshes from anywhere: core::Error or a valid mesh, nothing else. The first byte picks the format:
// 'A' OBJ, 'B' STL, 'C' PLY, 'D' GLB, 'E' DAE, 'F' glTF, 'G' a material library.
#include <cstdint>
#include <string_view>

#include "assets/mesh_import.h"
#include "assets/mtl_file.h"
#include "core/error.h"
#include "temporary_file.h"

namespace {

using simwright::fuzz::TemporaryFile;

void ReadBoth(const std::filesystem::path& path, bool obj) {
  try {
    simwright::core::RequireValid(simwright::assets::ReadMesh(path), "input");
  } catch (const simwright::core::Error&) {
  }
  if (!obj) return;
  try {
    simwright::core::RequireValid(simwright::assets::ReadBareObj(path), "input");
  } catch (const simwright::core::Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const TemporaryFile files[] = {TemporaryFile("input.obj"), TemporaryFile("input.stl"),
                                        TemporaryFile("input.ply"), TemporaryFile("input.glb"),
                                        TemporaryFile("input.dae"), TemporaryFile("input.gltf")};
  if (size < 1) return 0;
  const int kind = static_cast<std::uint8_t>(data[0] - 'A') % 7;
  if (kind == 6) {
    simwright::assets::ReadMtl({reinterpret_cast<const char*>(data) + 1, size - 1});
    return 0;
  }
  ReadBoth(files[kind].Write(data + 1, size - 1), kind == 0);
  return 0;
}
