// Reads an asset folder and prints its mass and its collision parts: read_asset FOLDER
#include <cstdio>

#include <simwright/assets/asset_folder.h>
#include <simwright/core/error.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const simwright::assets::Asset asset = simwright::assets::ReadAsset(argv[1]);
    std::printf("%s %.17g kg, %zu parts\n", asset.name.c_str(), asset.inertial.mass,
                asset.parts.size());
    return asset.inertial.mass > 0.0 && !asset.parts.empty() ? 0 : 1;
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
