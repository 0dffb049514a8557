// Catalogues from anywhere: core::Error or pieces, nothing else; nothing unpacked outside.
#include <cstdint>
#include <cstdlib>

#include "assets/furniture_catalogue.h"
#include "core/error.h"
#include "temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const simwright::fuzz::TemporaryFile file("input.sh3f");
  try {
    const std::filesystem::path& path = file.Write(data, size);
    const simwright::assets::FurnitureCatalogue catalogue(path);
    const std::filesystem::path folder = path.parent_path() / "unpacked";
    std::filesystem::create_directories(folder);
    for (const simwright::assets::CataloguePiece& piece : catalogue.pieces()) {
      try {
        const std::filesystem::path model = catalogue.Extract(piece, folder);
        if (model.lexically_relative(folder).string().rfind("..", 0) == 0) std::abort();
      } catch (const simwright::core::Error&) {
      }
    }
    std::filesystem::remove_all(folder);
  } catch (const simwright::core::Error&) {
  }
  return 0;
}
