#include "made_photos.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "assets/furniture_catalogue.h"
#include "core/error.h"
#include "core/image.h"
#include "importers/catalogue_meshes.h"
#include "physics_params/category_resolution.h"
#include "render/forward.h"
#include "workflows/lift/lift.h"

namespace simwright::bench {
namespace fs = std::filesystem;
namespace {

constexpr int kSide = 400;
constexpr double kFieldOfView = 35.0 * M_PI / 180.0;

core::Image Cropped(const core::Image& image, int x0, int y0, int width, int height) {
  core::Image crop(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        crop.At(x, y)[c] = image.At(x0 + x, y0 + y)[image.channels >= 3 ? c : 0];
      }
    }
  }
  return crop;
}

void Dye(const Eigen::Vector3f& color, core::Image* image) {
  for (size_t i = 0; i < image->pixels.size(); ++i) {
    image->pixels[i] = static_cast<std::uint8_t>(
        std::min(255.0f, color[static_cast<long>(i % 3)] * image->pixels[i]));
  }
}

core::Image RandomBackground(const std::vector<core::Image>& backgrounds, core::Rng* rng) {
  const core::Image& whole = backgrounds[static_cast<size_t>(
      core::UniformIndex(*rng, static_cast<std::int64_t>(backgrounds.size())))];
  const int least = std::min(whole.width, whole.height);
  const int side = static_cast<int>(least * core::Uniform(*rng, 0.6, 1.0));
  const int x = static_cast<int>(core::UniformIndex(*rng, whole.width - side + 1));
  const int y = static_cast<int>(core::UniformIndex(*rng, whole.height - side + 1));
  core::Image crop = Cropped(whole, x, y, side, side);
  // Blurs: half the size and back.
  crop = core::Resize(core::Resize(crop, kSide / 2, kSide / 2), kSide, kSide);
  if (core::Uniform(*rng) < 0.5) {
    for (int row = 0; row < kSide; ++row) {
      for (int col = 0; col < kSide / 2; ++col) {
        std::swap_ranges(crop.At(col, row), crop.At(col, row) + 3, crop.At(kSide - 1 - col, row));
      }
    }
  }
  return crop;
}

// Returns the orbit camera at which the projected vertices' longer side is `fill` of the image.
core::Camera CameraThatFills(const core::TriangleMesh& mesh, double elevation, double azimuth,
                             double fill) {
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  double near = 0.6 * box.diagonal().norm(), far = 40.0 * box.diagonal().norm();
  for (int i = 0; i < 40; ++i) {
    const double distance = 0.5 * (near + far);
    const core::Camera camera =
        core::OrbitCamera(box.center(), distance, elevation, azimuth, kFieldOfView, kSide, kSide);
    Eigen::AlignedBox2d seen;
    for (const Eigen::Vector3d& v : mesh.vertices) seen.extend(camera.Project(v).head<2>().eval());
    (seen.sizes().maxCoeff() > fill * kSide ? near : far) = distance;
  }
  return core::OrbitCamera(box.center(), far, elevation, azimuth, kFieldOfView, kSide, kSide);
}

asset_lift::Matte MatteOf(const render::ForwardBuffers& buffers) {
  asset_lift::Matte matte;
  matte.method = "rendered";
  matte.alpha = core::Image(buffers.width, buffers.height, 1);
  matte.left = buffers.width;
  matte.top = buffers.height;
  for (int y = 0; y < buffers.height; ++y) {
    for (int x = 0; x < buffers.width; ++x) {
      const float share = buffers.mask[buffers.Index(x, y)];
      matte.alpha.At(x, y)[0] = static_cast<std::uint8_t>(std::lround(255.0f * share));
      matte.area += share / static_cast<double>(buffers.mask.size());
      if (share < 0.5f) continue;
      matte.left = std::min(matte.left, x);
      matte.right = std::max(matte.right, x + 1);
      matte.top = std::min(matte.top, y);
      matte.bottom = std::max(matte.bottom, y + 1);
    }
  }
  return matte;
}

}  // namespace

std::vector<CatalogueObject> HouseholdObjects(const std::vector<fs::path>& catalogues, int limit) {
  std::vector<CatalogueObject> objects;
  std::set<std::string> taken;
  const auto& base = physics_params::KnowledgeBase::Shipped();
  for (const fs::path& path : catalogues) {
    const assets::FurnitureCatalogue catalogue(path);
    for (const assets::CataloguePiece& piece : catalogue.pieces()) {
      if (static_cast<int>(objects.size()) >= limit) return objects;
      const double longest = piece.size_m.maxCoeff();
      if (longest < 0.03 || longest > 0.9) continue;
      const physics_params::Resolution found =
          physics_params::ResolveCategory(piece.name, base, physics_params::WordNet::Installed());
      if (found.category == nullptr || !taken.insert(piece.name).second) continue;
      try {
        objects.push_back({piece.name, found.category->name,
                           importers::ReadCataloguePiece(catalogue, piece, nullptr),
                           workflows::PriorOf(*found.category)});
      } catch (const core::Error& error) {
        std::fprintf(stderr, "skipped: %s\n", error.what());
      }
    }
  }
  return objects;
}

std::vector<core::Image> Backgrounds(const fs::path& folder) {
  const core::Image coffee =
      core::ReadImage(fs::path(SIMWRIGHT_SOURCE_DIR) / "examples" / "coffee.png");
  std::vector<core::Image> backgrounds = {Cropped(coffee, 485, 110, 115, 220),
                                          Cropped(coffee, 440, 0, 160, 125)};
  const std::pair<const char*, Eigen::Vector3f> dyed[] = {{"brick.png", {1.0f, 0.72f, 0.6f}},
                                                          {"grass.png", {0.75f, 1.0f, 0.5f}},
                                                          {"gravel.png", {1.0f, 0.94f, 0.84f}}};
  for (const auto& [name, color] : dyed) {
    if (!fs::exists(folder / name)) continue;
    const core::Image photo = core::ReadImage(folder / name);
    backgrounds.push_back(Cropped(photo, 0, 0, photo.width, photo.height));
    Dye(color, &backgrounds.back());
  }
  return backgrounds;
}

MadePhoto MakePhoto(const CatalogueObject& object, const std::vector<core::Image>& backgrounds,
                    core::Rng* rng) {
  MadePhoto made;
  made.elevation = core::Uniform(*rng, 5.0, 45.0) * M_PI / 180.0;
  const double azimuth = core::Uniform(*rng, 0.0, 2.0 * M_PI);
  made.camera =
      CameraThatFills(object.visual.mesh, made.elevation, azimuth, core::Uniform(*rng, 0.6, 0.75));
  made.focal = made.camera.fx;
  render::Scene scene;
  scene.Add(&object.visual);
  scene.Commit();
  render::ForwardOptions options;
  options.samples_per_side = 3;
  options.shaded = true;
  options.occlusion_rays = 8;
  const render::ForwardBuffers buffers = render::RenderForward(scene, made.camera, options);
  made.matte = MatteOf(buffers);
  if (made.matte.right <= made.matte.left) {
    throw core::Error("the object is not visible", object.name);
  }
  made.photo = RandomBackground(backgrounds, rng);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const std::uint8_t* front = buffers.color.At(x, y);
      std::uint8_t* pixel = made.photo.At(x, y);
      for (int c = 0; c < 3; ++c) {
        pixel[c] =
            static_cast<std::uint8_t>((front[3] * front[c] + (255 - front[3]) * pixel[c]) / 255);
      }
    }
  }
  return made;
}

}  // namespace simwright::bench
