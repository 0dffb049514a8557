// Reconstructs a photo of a fruit without learned priors and writes it as OBJ:
// lift_photo PHOTO OUTPUT.obj
#include <cstdio>

#include <simwright/asset_lift/lift.h>
#include <simwright/core/error.h>
#include <simwright/core/files.h>
#include <simwright/core/image.h>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    simwright::asset_lift::CategoryPrior fruit;
    fruit.length_min = fruit.width_min = fruit.height_min = 0.06;
    fruit.length_max = fruit.width_max = fruit.height_max = 0.09;
    fruit.round = true;
    simwright::asset_lift::LiftOptions options;
    options.effort = simwright::asset_lift::LiftEffort::kOutline;
    simwright::core::Progress progress;
    const auto lifted = simwright::asset_lift::LiftPhoto(simwright::core::ReadImage(argv[1]), fruit,
                                                         {}, options, &progress);
    std::string obj;
    for (const auto& v : lifted.mesh.mesh.vertices) {
      obj += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
             std::to_string(v.z()) + "\n";
    }
    for (const auto& t : lifted.mesh.mesh.triangles) {
      obj += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
             std::to_string(t[2] + 1) + "\n";
    }
    simwright::core::WriteFile(argv[2], obj);
    std::printf("%s: %zu triangles, silhouette overlap %.3f\n", argv[2],
                lifted.mesh.mesh.triangles.size(), lifted.silhouette_iou);
    return lifted.silhouette_iou > 0.9 ? 0 : 1;
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
