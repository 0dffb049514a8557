#include "tests/capture/mat_photos.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "render/forward.h"

namespace simwright::capture {
namespace {

constexpr double kMargin = 1.12;  // of the pinhole image's sides over those of the distorted one

// Adds a rectangle with a texture: `corners` counter-clockwise from the lower left.
void AddQuad(const std::array<Eigen::Vector3d, 4>& corners, core::Image texture,
             core::TexturedMesh* mesh) {
  const int first = static_cast<int>(mesh->mesh.vertices.size());
  for (const Eigen::Vector3d& corner : corners) mesh->mesh.vertices.push_back(corner);
  const Eigen::Vector2f uvs[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const Eigen::Vector3i& t : {Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(0, 2, 3)}) {
    mesh->mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first));
    for (int k = 0; k < 3; ++k) mesh->corner_uvs.push_back(uvs[t[k]]);
    mesh->triangle_material.push_back(static_cast<int>(mesh->materials.size()));
  }
  core::Material material;
  material.base_color = Eigen::Vector4f::Ones();
  material.texture = static_cast<int>(mesh->textures.size());
  mesh->materials.push_back(material);
  mesh->textures.push_back(std::move(texture));
}

// Returns a blotchy texture around a colour.
core::Image Blotches(int side, int cell, const Eigen::Vector3d& color, double contrast,
                     core::Rng* rng) {
  const int nodes = side / cell + 2;
  std::vector<double> value(static_cast<std::size_t>(nodes) * nodes);
  for (double& v : value) v = core::Uniform(*rng, -1.0, 1.0);
  core::Image image(side, side, 3);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int i = x / cell, j = y / cell;
      const double u = static_cast<double>(x % cell) / cell;
      const double v = static_cast<double>(y % cell) / cell;
      const auto node = [&](int a, int b) {
        return value[static_cast<std::size_t>(b) * nodes + a];
      };
      const double blend = (1 - v) * ((1 - u) * node(i, j) + u * node(i + 1, j)) +
                           v * ((1 - u) * node(i, j + 1) + u * node(i + 1, j + 1));
      for (int c = 0; c < 3; ++c) {
        image.At(x, y)[c] =
            static_cast<std::uint8_t>(std::clamp(color[c] * (1.0 + contrast * blend), 0.0, 255.0));
      }
    }
  }
  return image;
}

// Returns a texture with blotches of several sizes, the smallest of `cell` pixels.
core::Image FineBlotches(int side, int cell, const Eigen::Vector3d& color, core::Rng* rng) {
  const core::Image layers[] = {Blotches(side, 12 * cell, color, 0.5, rng),
                                Blotches(side, 3 * cell, color, 0.5, rng),
                                Blotches(side, cell, color, 0.6, rng)};
  core::Image image(side, side, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double mean = color[static_cast<int>(i % 3)];
    double value = mean;
    for (const core::Image& layer : layers) value += layer.pixels[i] - mean;
    image.pixels[i] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
  }
  return image;
}

core::TexturedMesh Surroundings(const MatPhotoOptions& options) {
  core::Rng rng(options.seed);
  core::TexturedMesh room;
  constexpr double kTable = 0.9, kWall = 2.0;
  AddQuad({Eigen::Vector3d(-kTable, -kTable, -0.001),
           {kTable, -kTable, -0.001},
           {kTable, kTable, -0.001},
           {-kTable, kTable, -0.001}},
          options.fine_table ? FineBlotches(2048, 8, {140, 105, 75}, &rng)
                             : Blotches(512, 16, {140, 105, 75}, 0.35, &rng),
          &room);
  for (int side = 0; side < 4; ++side) {
    const Eigen::AngleAxisd turn(side * std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d color(core::Uniform(rng, 80, 200), core::Uniform(rng, 80, 200),
                                core::Uniform(rng, 80, 200));
    AddQuad(
        {turn * Eigen::Vector3d(-kWall, kWall, -1.5), turn * Eigen::Vector3d(kWall, kWall, -1.5),
         turn * Eigen::Vector3d(kWall, kWall, 1.5), turn * Eigen::Vector3d(-kWall, kWall, 1.5)},
        Blotches(512, 40, color, 0.3, &rng), &room);
  }
  if (!options.mat) return room;
  const CaptureMat& mat = CaptureMatOf(options.paper);
  const core::Image grey = MatPicture(mat, 8000.0);
  core::Image page(grey.width, grey.height, 3);
  const Eigen::AlignedBox2d printed = mat.Printed();
  for (int y = 0; y < grey.height; ++y) {
    for (int x = 0; x < grey.width; ++x) {
      const Eigen::Vector2d at((x + 0.5) / 8000.0 - 0.5 * mat.width,
                               0.5 * mat.height - (y + 0.5) / 8000.0);
      const double light = grey.At(x, y)[0] / 255.0;
      for (int c = 0; c < 3; ++c) {
        // Paper is not white, and ink on it paler than on a screen.
        const double ink =
            printed.contains(at) ? (1 - light) * kMatDark[c] + light * kMatLight[c] : 1.0;
        page.At(x, y)[c] = static_cast<std::uint8_t>(25 + 205 * ink);
      }
    }
  }
  const double w = 0.5 * mat.width, h = 0.5 * mat.height;
  AddQuad({Eigen::Vector3d(-w, -h, 0), {w, -h, 0}, {w, h, 0}, {-w, h, 0}}, std::move(page), &room);
  return room;
}

// Returns the direction (x, y) = (X / Z, Y / Z) that the lens shows at a pixel, by fixed-point
// iteration.
Eigen::Vector2d DirectionAt(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d wanted((pixel.x() - lens.cx) / lens.fx, (pixel.y() - lens.cy) / lens.fy);
  Eigen::Vector2d at = wanted;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d shown = lens.Project({at.x(), at.y(), 1.0});
    at +=
        wanted - Eigen::Vector2d((shown.x() - lens.cx) / lens.fx, (shown.y() - lens.cy) / lens.fy);
  }
  return at;
}

// Returns the direction that the lens shows at each pixel's centre, row by row.
std::vector<Eigen::Vector2d> PixelDirections(const Lens& lens) {
  std::vector<Eigen::Vector2d> directions(static_cast<std::size_t>(lens.width) * lens.height);
  core::ParallelFor(lens.height, [&](int y) {
    for (int x = 0; x < lens.width; ++x) {
      directions[static_cast<std::size_t>(y) * lens.width + x] =
          DirectionAt(lens, {x + 0.5, y + 0.5});
    }
  });
  return directions;
}

// Samples the pinhole image where the lens shows it.
core::Image Distort(const core::Image& straight, const core::Camera& camera, const Lens& lens,
                    const std::vector<Eigen::Vector2d>& directions) {
  core::Image photo(lens.width, lens.height, 3);
  core::ParallelFor(lens.height, [&](int y) {
    for (int x = 0; x < lens.width; ++x) {
      const Eigen::Vector2d& at = directions[static_cast<std::size_t>(y) * lens.width + x];
      const double u = std::clamp(camera.fx * at.x() + camera.cx - 0.5, 0.0, camera.width - 1.001);
      const double v = std::clamp(camera.fy * at.y() + camera.cy - 0.5, 0.0, camera.height - 1.001);
      const int i = static_cast<int>(u), j = static_cast<int>(v);
      const double a = u - i, b = v - j;
      for (int c = 0; c < 3; ++c) {
        photo.At(x, y)[c] = static_cast<std::uint8_t>(
            (1 - b) * ((1 - a) * straight.At(i, j)[c] + a * straight.At(i + 1, j)[c]) +
            b * ((1 - a) * straight.At(i, j + 1)[c] + a * straight.At(i + 1, j + 1)[c]) + 0.5);
      }
    }
  });
  return photo;
}

}  // namespace

core::TexturedMesh PlainBox(const Eigen::Vector3d& sides, const Eigen::Vector3f& color) {
  core::TexturedMesh box;
  for (int i = 0; i < 8; ++i) {
    box.mesh.vertices.emplace_back(sides.x() * ((i & 1) - 0.5), sides.y() * ((i >> 1 & 1) - 0.5),
                                   sides.z() * (i >> 2));
  }
  for (const Eigen::Vector3i& t : {Eigen::Vector3i(0, 2, 1),
                                   {1, 2, 3},
                                   {4, 5, 6},
                                   {5, 7, 6},
                                   {0, 1, 4},
                                   {1, 5, 4},
                                   {2, 6, 3},
                                   {3, 6, 7},
                                   {0, 4, 2},
                                   {2, 4, 6},
                                   {1, 3, 5},
                                   {3, 7, 5}}) {
    box.mesh.triangles.push_back(t);
  }
  core::Material paint;
  paint.base_color << color, 1.0f;
  box.materials.push_back(paint);
  box.triangle_material.assign(12, 0);
  return box;
}

core::TexturedMesh PaintedBox(const Eigen::Vector3d& sides, std::uint64_t seed) {
  core::Rng rng(seed);
  const auto corner = [&](int i) {
    return Eigen::Vector3d(sides.x() * ((i & 1) - 0.5), sides.y() * ((i >> 1 & 1) - 0.5),
                           sides.z() * (i >> 2));
  };
  core::TexturedMesh box;
  for (const auto& [a, b, c, d] :
       {std::array{0, 1, 5, 4}, std::array{1, 3, 7, 5}, std::array{3, 2, 6, 7},
        std::array{2, 0, 4, 6}, std::array{4, 5, 7, 6}, std::array{2, 3, 1, 0}}) {
    const Eigen::Vector3d color(core::Uniform(rng, 60, 200), core::Uniform(rng, 60, 200),
                                core::Uniform(rng, 60, 200));
    AddQuad({corner(a), corner(b), corner(c), corner(d)}, FineBlotches(384, 6, color, &rng), &box);
  }
  return box;
}

core::TexturedMesh PaintedTray(const Eigen::Vector3d& sides, double wall, std::uint64_t seed) {
  core::Rng rng(seed);
  // Corners 0 to 7 outside, 8 to 15 of the hollow.
  const auto corner = [&](int i) {
    const bool hollow = i >= 8;
    const double x = sides.x() - (hollow ? 2 * wall : 0.0);
    const double y = sides.y() - (hollow ? 2 * wall : 0.0);
    const double base = hollow ? wall : 0.0;
    return Eigen::Vector3d(x * ((i & 1) - 0.5), y * ((i >> 1 & 1) - 0.5),
                           (i >> 2 & 1) != 0 ? sides.z() : base);
  };
  core::TexturedMesh tray;
  for (const auto& [a, b, c, d] :
       {std::array{0, 1, 5, 4}, std::array{1, 3, 7, 5}, std::array{3, 2, 6, 7},
        std::array{2, 0, 4, 6}, std::array{2, 3, 1, 0}, std::array{4, 5, 13, 12},
        std::array{5, 7, 15, 13}, std::array{7, 6, 14, 15}, std::array{6, 4, 12, 14},
        std::array{12, 13, 9, 8}, std::array{13, 15, 11, 9}, std::array{15, 14, 10, 11},
        std::array{14, 12, 8, 10}, std::array{8, 9, 11, 10}}) {
    const Eigen::Vector3d color(core::Uniform(rng, 60, 200), core::Uniform(rng, 60, 200),
                                core::Uniform(rng, 60, 200));
    AddQuad({corner(a), corner(b), corner(c), corner(d)}, FineBlotches(384, 6, color, &rng), &tray);
  }
  return tray;
}

Lens PhoneLens(int width, int height, double longer_fov) {
  Lens lens;
  lens.width = width;
  lens.height = height;
  const double longer = std::max(width, height);
  lens.fx = lens.fy = 0.5 * longer / std::tan(0.5 * longer_fov);
  lens.cx = 0.5 * width + 0.006 * longer;
  lens.cy = 0.5 * height - 0.004 * longer;
  lens.k1 = -0.08;
  lens.k2 = 0.03;
  lens.p1 = 0.0006;
  lens.p2 = -0.0004;
  return lens;
}

std::vector<Eigen::Isometry3d> OrbitPoses(int count, const std::vector<double>& elevations,
                                          double radius, const Lens& lens, std::uint64_t seed) {
  core::Rng rng(seed);
  std::vector<Eigen::Isometry3d> poses;
  const double shorter = std::min(lens.width, lens.height);
  for (int i = 0; i < count; ++i) {
    const double elevation = elevations[static_cast<std::size_t>(i) % elevations.size()] +
                             core::Uniform(rng, -0.05, 0.05);
    const double azimuth = 2.0 * std::numbers::pi * (i + core::Uniform(rng, -0.2, 0.2)) / count;
    const double distance =
        radius / std::sin(std::atan(0.5 * shorter / lens.fx)) * core::Uniform(rng, 0.95, 1.1);
    const core::Camera camera = core::OrbitCamera(
        {core::Uniform(rng, -0.01, 0.01), core::Uniform(rng, -0.01, 0.01), 0.3 * radius}, distance,
        elevation, azimuth, 0.5, lens.width, lens.height);
    poses.push_back(camera.world_from_camera);
  }
  return poses;
}

std::vector<MatPhoto> RenderMatPhotos(const core::TexturedMesh& object,
                                      const std::vector<Eigen::Isometry3d>& poses,
                                      const MatPhotoOptions& options) {
  const core::TexturedMesh room = Surroundings(options);
  render::Scene scene;
  scene.Add(&room);
  scene.Add(&object);
  scene.Commit();
  render::ForwardOptions forward;
  forward.shaded = true;
  forward.samples_per_side = options.samples_per_side;
  forward.occlusion_rays = 1;
  forward.occlusion_reach = 0.005f;  // of the room: 2 cm
  const Lens& lens = options.lens;
  core::Camera camera;
  camera.width = static_cast<int>(kMargin * lens.width);
  camera.height = static_cast<int>(kMargin * lens.height);
  camera.fx = lens.fx;
  camera.fy = lens.fy;
  camera.cx = lens.cx + 0.5 * (camera.width - lens.width);
  camera.cy = lens.cy + 0.5 * (camera.height - lens.height);
  const std::vector<Eigen::Vector2d> directions = PixelDirections(lens);
  std::vector<MatPhoto> photos;
  core::Rng rng(options.seed + 1);
  for (const Eigen::Isometry3d& pose : poses) {
    camera.world_from_camera = pose;
    const render::ForwardBuffers buffers = render::RenderForward(scene, camera, forward);
    MatPhoto photo{Distort(buffers.color, camera, lens, directions), pose};
    for (std::uint8_t& value : photo.photo.pixels) {
      value = static_cast<std::uint8_t>(
          std::clamp(std::lround(value + options.noise * core::Normal(rng)), 0l, 255l));
    }
    photo.photo =
        core::DecodeImage(core::EncodeJpeg(photo.photo, options.jpeg_quality), "rendered photo");
    photos.push_back(std::move(photo));
  }
  return photos;
}

}  // namespace simwright::capture
