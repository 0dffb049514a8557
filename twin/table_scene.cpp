#include "twin/table_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "asset_lift/priors/shape_example.h"
#include "core/error.h"

namespace simwright::twin {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kShortest = 0.04, kLongest = 0.55;  // m, of the mean longest side of a kind
constexpr int kSizedInstances = 6;                   // whose mean that is
constexpr int kPlaces = 60;                          // tries of a place for an object
constexpr double kLeastGap = 0.005;                  // m between the circles around objects

float Random(core::Rng* rng, double low, double high) {
  return static_cast<float>(core::Uniform(*rng, low, high));
}

Eigen::Vector3f RandomColor(core::Rng* rng) {
  // Colours of objects: often pale, dark or greyish, seldom saturated.
  const float value = Random(rng, 0.08, 0.97);
  const float spread = core::Uniform(*rng) < 0.4 ? 0.05f : 0.45f;
  Eigen::Vector3f color;
  for (int c = 0; c < 3; ++c) {
    color[c] = std::clamp(value + spread * Random(rng, -1.0, 1.0), 0.02f, 0.98f);
  }
  return color;
}

SurfaceLook RandomSurfaceLook(core::Rng* rng, double least_scale, double most_scale) {
  SurfaceLook look;
  look.pattern = static_cast<SurfacePattern>(core::UniformIndex(*rng, 6));
  look.color = RandomColor(rng);
  look.other = core::Uniform(*rng) < 0.5 ? RandomColor(rng)
                                         : Eigen::Vector3f(look.color * Random(rng, 0.5, 0.9));
  look.scale = least_scale * std::pow(most_scale / least_scale, core::Uniform(*rng));
  look.strength = Random(rng, 0.2, 1.0);
  look.seed = static_cast<std::uint32_t>((*rng)());
  return look;
}

bool IsOnTables(int kind) {
  const library_fit::FitKind& of = library_fit::FitKinds()[static_cast<size_t>(kind)];
  for (const char* built_in : {"light_switch", "faucet", "baseball_bat"}) {
    if (of.name == built_in) return false;
  }
  double longest = 0.0;
  for (std::uint64_t seed = 1; seed <= kSizedInstances; ++seed) {
    longest += library_fit::SampleInstance(kind, seed).size.maxCoeff() / kSizedInstances;
  }
  return longest > kShortest && longest < kLongest;
}

Eigen::Isometry3d Placed(const Eigen::Vector2d& at, double yaw) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation().head<2>() = at;
  return pose;
}

TableObject RandomObject(const TableSceneSources& sources, const TableSceneOptions& options,
                         core::Rng* rng) {
  TableObject object;
  if (!sources.meshes.empty() && core::Uniform(*rng) < options.mesh_share) {
    object.mesh = static_cast<int>(
        core::UniformIndex(*rng, static_cast<std::int64_t>(sources.meshes.size())));
    object.visual = sources.meshes[static_cast<size_t>(object.mesh)];
  } else {
    const std::vector<int>& kinds = TableKinds();
    const int kind = kinds[static_cast<size_t>(
        core::UniformIndex(*rng, static_cast<std::int64_t>(kinds.size())))];
    const std::uint64_t seed =
        options.first_seed + static_cast<std::uint64_t>(core::UniformIndex(
                                 *rng, static_cast<std::int64_t>(options.seeds)));
    object.instance = library_fit::SampleInstance(kind, seed);
    object.visual = library_fit::InstanceMesh(object.instance);
  }
  if (core::Uniform(*rng) < options.recolored) {
    object.look = RandomSurfaceLook(rng, 0.008, 0.08);
    if (core::Uniform(*rng) < 0.5) object.look.strength = 0.0f;
    const float share = Random(rng, 0.2, 1.0);
    for (core::Material& material : object.visual.materials) {
      const Eigen::Vector3f color = material.base_color.head<3>();
      const Eigen::Vector3f changed =
          core::Uniform(*rng) < 0.7 ? object.look.color : RandomColor(rng);
      material.base_color.head<3>() = (1.0f - share) * color + share * changed;
    }
  }
  object.gloss = core::Uniform(*rng) < 0.5 ? 0.0f : Random(rng, 0.0, 0.6);
  return object;
}

double CircleRadius(const core::TexturedMesh& mesh, Eigen::Vector2d* middle) {
  const Eigen::AlignedBox3d bounds = core::Bounds(mesh.mesh);
  *middle = bounds.center().head<2>();
  return 0.5 * bounds.sizes().head<2>().norm();
}

// Places the objects from the largest on, each near the middle where it touches none.
void PlaceObjects(core::Rng* rng, std::vector<TableObject>* objects) {
  std::vector<std::pair<Eigen::Vector2d, double>> circles;
  std::vector<TableObject> placed;
  std::sort(objects->begin(), objects->end(), [](const TableObject& a, const TableObject& b) {
    return core::Bounds(a.visual.mesh).diagonal().norm() >
           core::Bounds(b.visual.mesh).diagonal().norm();
  });
  const double spread = core::Uniform(*rng, 0.1, 0.26);
  for (TableObject& object : *objects) {
    Eigen::Vector2d middle;
    // A circle through the corners is too wide for long objects.
    const double radius = 0.85 * CircleRadius(object.visual, &middle);
    const bool frontal =
        object.mesh < 0 &&
        library_fit::FitKinds()[static_cast<size_t>(object.instance.kind)].articulated != nullptr;
    for (int attempt = 0; attempt < kPlaces; ++attempt) {
      const double reach = spread * (1.0 + attempt / 20.0);
      const Eigen::Vector2d at(reach * core::Normal(*rng), 0.8 * reach * core::Normal(*rng));
      const bool is_free = std::all_of(circles.begin(), circles.end(), [&](const auto& other) {
        return (other.first - at).norm() > other.second + radius + kLeastGap;
      });
      if (!is_free) continue;
      // The camera stands at -y: fronts (-x) face it within some 60 degrees.
      const double yaw = frontal ? 0.5 * M_PI + std::clamp(0.5 * core::Normal(*rng), -1.2, 1.2)
                                 : core::Uniform(*rng, 0.0, 2.0 * M_PI);
      object.world_from_object = Placed(at, yaw);
      object.world_from_object.translate(Eigen::Vector3d(-middle.x(), -middle.y(), 0.0));
      circles.emplace_back(at, radius);
      placed.push_back(std::move(object));
      break;
    }
  }
  *objects = std::move(placed);
}

// Returns a camera that sees the middle of all objects, and nearly all of them whole.
core::Camera RandomTableCamera(const std::vector<TableObject>& objects,
                               const TableSceneOptions& options, core::Rng* rng) {
  Eigen::AlignedBox3d all;
  for (const TableObject& object : objects) {
    const Eigen::AlignedBox3d box = core::Bounds(object.visual.mesh);
    all.extend(box.transformed(object.world_from_object));
  }
  const double fov = core::Uniform(*rng, 32.0, 62.0) * kDegree;  // vertical
  const double elevation = std::clamp(34.0 + 13.0 * core::Normal(*rng), 12.0, 65.0) * kDegree;
  const double azimuth = -0.5 * M_PI + 0.25 * core::Normal(*rng);
  const double radius = 0.5 * all.diagonal().norm();
  const double distance = radius / std::sin(0.5 * fov) * core::Uniform(*rng, 0.6, 1.15);
  Eigen::Vector3d target = all.center();
  for (int i = 0; i < 3; ++i) target[i] += 0.12 * radius * core::Normal(*rng);
  core::Camera camera = core::OrbitCamera(target, std::max(distance, 0.35), elevation, azimuth, fov,
                                          options.width, options.height);
  const double roll = 1.8 * kDegree * core::Normal(*rng);
  camera.world_from_camera.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));
  return camera;
}

// Returns a table on which all objects stand.
Table RandomTable(const TableSceneSources& sources, const std::vector<TableObject>& objects,
                  core::Rng* rng) {
  Table table;
  Eigen::AlignedBox3d all;
  for (const TableObject& object : objects) {
    all.extend(core::Bounds(object.visual.mesh).transformed(object.world_from_object));
  }
  Eigen::Vector2d least = Eigen::Vector2d::Zero();
  if (!objects.empty()) least = all.min().cwiseAbs().cwiseMax(all.max().cwiseAbs()).head<2>();
  const double choice = core::Uniform(*rng);
  table.endless = choice < 0.35;
  table.round = choice > 0.85;
  table.half = {core::Uniform(*rng, 0.35, 1.0), core::Uniform(*rng, 0.3, 0.7)};
  table.half = table.half.cwiseMax(least * core::Uniform(*rng, 1.1, 1.3));
  if (table.round) table.half.x() = std::max(table.half.x(), 1.05 * least.norm());
  table.yaw = 0.1 * core::Normal(*rng);
  table.thickness = core::Uniform(*rng, 0.015, 0.08);
  table.look = RandomSurfaceLook(rng, 0.01, 0.4);
  table.look.strength = core::Uniform(*rng) < 0.4 ? 0.0f : 0.7f * table.look.strength;
  if (!sources.photos.empty() && core::Uniform(*rng) < 0.25) {
    table.photo = static_cast<int>(
        core::UniformIndex(*rng, static_cast<std::int64_t>(sources.photos.size())));
    table.photo_width = core::Uniform(*rng, 0.3, 2.5);
  }
  return table;
}

void RandomSurroundings(const TableSceneSources& sources, core::Rng* rng, TableScene* scene) {
  scene->light = asset_lift::RandomLight(rng);
  scene->light.radiance *= Random(rng, 0.55, 1.15);
  if (core::Uniform(*rng) < 0.65) {
    scene->sun = Random(rng, 0.15, 0.9);
    const double height = core::Uniform(*rng, 25.0, 80.0) * kDegree;
    const double turn = core::Uniform(*rng, 0.0, 2.0 * M_PI);
    scene->sun_direction = Eigen::Vector3d(std::cos(height) * std::cos(turn),
                                           std::cos(height) * std::sin(turn), std::sin(height))
                               .cast<float>();
    scene->sun_radius = Random(rng, 0.01, 0.2);
  }
  scene->background_color = RandomColor(rng);
  if (!sources.photos.empty() && core::Uniform(*rng) < 0.8) {
    scene->background = static_cast<int>(
        core::UniformIndex(*rng, static_cast<std::int64_t>(sources.photos.size())));
    const double side = core::Uniform(*rng, 0.3, 1.0);
    const Eigen::Vector2d low(core::Uniform(*rng, 0.0, 1.0 - side),
                              core::Uniform(*rng, 0.0, 1.0 - side));
    scene->background_crop = {low, low + Eigen::Vector2d::Constant(side)};
  }
}

}  // namespace

bool TableSceneOptions::IsValid(std::string* error) const {
  const auto fail = [error](const char* reason) {
    if (error) *error = reason;
    return false;
  };
  if (least_objects < 1 || most_objects < least_objects || most_objects > 60) {
    return fail("the number of objects must be a range within 1 to 60");
  }
  if (width < 64 || height < 64 || width > 4096 || height > 4096) {
    return fail("the picture's sides must be 64 to 4096 pixels");
  }
  if (first_seed < 1 || seeds < 1) return fail("the seeds must be at least 1");
  return true;
}

const std::vector<int>& TableKinds() {
  static const std::vector<int> kinds = [] {
    std::vector<int> found;
    for (int kind = 0; kind < static_cast<int>(library_fit::FitKinds().size()); ++kind) {
      if (IsOnTables(kind)) found.push_back(kind);
    }
    return found;
  }();
  return kinds;
}

TableScene SampleTableScene(const TableSceneSources& sources, const TableSceneOptions& options,
                            core::Rng* rng) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "table scene");
  TableScene scene;
  const int count =
      options.least_objects +
      static_cast<int>(core::UniformIndex(*rng, options.most_objects - options.least_objects + 1));
  for (int i = 0; i < count; ++i) scene.objects.push_back(RandomObject(sources, options, rng));
  PlaceObjects(rng, &scene.objects);
  scene.camera = RandomTableCamera(scene.objects, options, rng);
  scene.table = RandomTable(sources, scene.objects, rng);
  RandomSurroundings(sources, rng, &scene);
  return scene;
}

}  // namespace simwright::twin
