// Writes a MuJoCo world with two instances of an asset: export_world ASSET_FOLDER WORLD.xml
#include <cstdio>
#include <filesystem>

#include <simwright/assets/asset_folder.h>
#include <simwright/assets/world_writer.h>
#include <simwright/core/error.h>
#include <simwright/core/files.h>

namespace assets = simwright::assets;

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    assets::WorldAsset kind;
    kind.asset = assets::ReadAsset(argv[1]);
    kind.key = kind.asset.name;
    kind.folder = std::filesystem::absolute(argv[1]).string() + "/";
    std::vector<assets::WorldObject> objects(2);
    for (int i = 0; i < 2; ++i) {
      objects[i].name = kind.key + "_" + std::to_string(i);
      objects[i].asset = &kind;
      objects[i].world_from_object.translation().x() = 0.5 * i;
    }
    simwright::core::WriteFile(argv[2], assets::WorldMjcf("two", objects));
    std::printf("%s: two of %s\n", argv[2], kind.key.c_str());
    return 0;
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
