#include "twin/table_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "render/scene.h"

namespace simwright::twin {
namespace {

constexpr float kOcclusionReach = 0.25f;  // m
constexpr int kMostSamples = 16;          // a pixel

// Returns a hash of three integers in [0, 1).
float Hashed(int x, int y, int z, std::uint32_t seed) {
  std::uint32_t h = seed * 2654435761u;
  for (const int value : {x, y, z}) {
    h ^= static_cast<std::uint32_t>(value) + 0x9e3779b9u + (h << 6) + (h >> 2);
    h *= 0x85ebca6bu;
    h ^= h >> 13;
  }
  h *= 0xc2b2ae35u;
  return static_cast<float>(h >> 8) * 0x1.0p-24f;
}

// Returns trilinear value noise of period 1, in [0, 1).
float ValueNoise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const Eigen::Vector3f floor = p.array().floor();
  const Eigen::Vector3i cell = floor.cast<int>();
  const Eigen::Vector3f t = p - floor;
  float sum = 0.0f;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = (corner >> 1) & 1, dz = corner >> 2;
    const float weight =
        (dx ? t.x() : 1.0f - t.x()) * (dy ? t.y() : 1.0f - t.y()) * (dz ? t.z() : 1.0f - t.z());
    sum += weight * Hashed(cell.x() + dx, cell.y() + dy, cell.z() + dz, seed);
  }
  return sum;
}

float Turbulence(const Eigen::Vector3f& p, std::uint32_t seed) {
  return 0.55f * ValueNoise(p, seed) + 0.28f * ValueNoise(2.03f * p, seed + 1) +
         0.17f * ValueNoise(4.1f * p, seed + 2);
}

// Returns the share of the second colour, in [0, 1].
float PatternAt(const SurfaceLook& look, const Eigen::Vector3f& point) {
  const Eigen::Vector3f p = point / static_cast<float>(look.scale);
  switch (look.pattern) {
    case SurfacePattern::kPlain:
      return 0.0f;
    case SurfacePattern::kNoise:
      return std::clamp(2.0f * Turbulence(p, look.seed) - 0.5f, 0.0f, 1.0f);
    case SurfacePattern::kStripes:
      return std::fmod(std::abs(p.x() + 100.0f), 1.0f) < 0.5f ? 1.0f : 0.0f;
    case SurfacePattern::kDots: {
      const Eigen::Vector3f off = p.array() - p.array().round();
      return off.squaredNorm() < 0.09f ? 1.0f : 0.0f;
    }
    case SurfacePattern::kChecks: {
      const Eigen::Vector3i cell = p.array().floor().cast<int>();
      return ((cell.x() + cell.y()) & 1) != 0 ? 1.0f : 0.0f;
    }
    case SurfacePattern::kGrain: {
      const Eigen::Vector3f along(0.15f * p.x(), 2.0f * p.y(), 2.0f * p.z());
      return 0.5f + 0.5f * std::sin(12.0f * Turbulence(along, look.seed) + 3.0f * p.y());
    }
  }
  return 0.0f;
}

Eigen::Vector3f PhotoColor(const core::Image& photo, double u, double v) {
  // Mirrored beyond its sides.
  const auto at = [](double share, int size) {
    const double turn = std::fmod(std::abs(share), 2.0);
    const double inside = turn <= 1.0 ? turn : 2.0 - turn;
    return std::clamp(static_cast<int>(inside * size), 0, size - 1);
  };
  const std::uint8_t* pixel = photo.At(at(u, photo.width), at(v, photo.height));
  return Eigen::Vector3f(pixel[0], pixel[1], pixel[2]) / 255.0f;
}

Eigen::Vector3f LinearColor(const Eigen::Vector3f& srgb) {
  return {render::LinearFromSrgb(srgb[0]), render::LinearFromSrgb(srgb[1]),
          render::LinearFromSrgb(srgb[2])};
}

// A mesh of the table's board, its top at z = 0.
core::TexturedMesh BoardMesh(const Table& table) {
  core::TexturedMesh board;
  const int sides = table.round && !table.endless ? 48 : 4;
  const double reach = table.endless ? 40.0 : 1.0;
  for (const double z : {0.0, -table.thickness}) {
    for (int i = 0; i < sides; ++i) {
      Eigen::Vector2d p;
      if (sides == 4) {
        const std::array<Eigen::Vector2d, 4> corners{
            Eigen::Vector2d(-1, -1), {1, -1}, {1, 1}, {-1, 1}};
        p = reach * corners[static_cast<size_t>(i)].cwiseProduct(table.half);
      } else {
        const double angle = 2.0 * M_PI * i / sides;
        p = table.half.x() * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      }
      p = Eigen::Rotation2Dd(table.yaw) * p;
      board.mesh.vertices.emplace_back(p.x(), p.y(), z);
    }
  }
  for (int i = 1; i + 1 < sides; ++i) {
    board.mesh.triangles.emplace_back(0, i, i + 1);
    board.mesh.triangles.emplace_back(sides, sides + i + 1, sides + i);
  }
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    board.mesh.triangles.emplace_back(i, sides + i, next);
    board.mesh.triangles.emplace_back(next, sides + i, sides + next);
  }
  return board;
}

// One of the samples of a pixel.
struct PixelSample {
  int index = 0, count = 1;
  float turn = 0.0f;  // of the pixel, share of a full turn
};

// Draws the rows of one picture.
class TableRenderer {
 public:
  TableRenderer(const TableScene& scene, const TableSceneSources& sources,
                const TablePictureRays& rays, std::uint64_t seed)
      : scene_(scene),
        sources_(sources),
        count_(rays),
        seed_(seed),
        board_(BoardMesh(scene.table)) {
    for (const TableObject& object : scene.objects) {
      rays_.Add(&object.visual, object.world_from_object);
      object_from_world_.push_back(object.world_from_object.inverse().cast<float>());
    }
    rays_.Add(&board_);
    rays_.Commit();
  }

  void DrawRow(int y, TablePicture* picture) const {
    const core::Camera& camera = scene_.camera;
    const int side = count_.samples;
    const Eigen::Vector3f origin = camera.position().cast<float>();
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      std::array<std::int16_t, kMostSamples> labels{};
      std::array<float, kMostSamples> depths{};
      const int count = side * side;
      const float turn = Hashed(x, y, 0, static_cast<std::uint32_t>(seed_));
      for (int k = 0; k < count; ++k) {
        const Eigen::Vector2d pixel(x + (k % side + 0.5) / side, y + (k / side + 0.5) / side);
        const Eigen::Vector3f ray = camera.Ray(pixel).cast<float>();
        const render::Hit hit = rays_.Intersect(origin, ray, 1e-3f);
        const auto at = static_cast<size_t>(k);
        depths[at] = hit.instance < 0 ? 0.0f : hit.depth;
        labels[at] = Label(hit);
        sum += hit.instance < 0 ? BackgroundColor(pixel)
                                : SurfaceColor(hit, origin, ray, {k, count, turn});
      }
      Keep(x, y, sum / static_cast<float>(count), labels, depths, count, picture);
    }
  }

 private:
  std::int16_t Label(const render::Hit& hit) const {
    if (hit.instance < 0) return kBackgroundLabel;
    if (hit.instance == static_cast<int>(scene_.objects.size())) return kTableLabel;
    return static_cast<std::int16_t>(hit.instance);
  }

  static void Keep(int x, int y, const Eigen::Vector3f& linear,
                   const std::array<std::int16_t, kMostSamples>& labels,
                   const std::array<float, kMostSamples>& depths, int count,
                   TablePicture* picture) {
    int best = 0, most = 0;
    for (int k = 0; k < count; ++k) {
      const auto end = labels.begin() + count;
      const int same =
          static_cast<int>(std::count(labels.begin(), end, labels[static_cast<size_t>(k)]));
      if (same > most) {
        most = same;
        best = k;
      }
    }
    const size_t at = static_cast<size_t>(y) * picture->color.width + x;
    picture->label[at] = labels[static_cast<size_t>(best)];
    picture->depth[at] = depths[static_cast<size_t>(best)];
    std::uint8_t* pixel = picture->color.At(x, y);
    for (int c = 0; c < 3; ++c) {
      const float value = render::SrgbFromLinear(std::clamp(linear[c], 0.0f, 1.0f));
      pixel[c] = static_cast<std::uint8_t>(std::lround(255.0f * value));
    }
  }

  Eigen::Vector3f BackgroundColor(const Eigen::Vector2d& pixel) const {
    if (scene_.background < 0) return LinearColor(scene_.background_color);
    const core::Image& photo = sources_.photos[static_cast<size_t>(scene_.background)];
    const Eigen::Vector2d share(pixel.x() / scene_.camera.width, pixel.y() / scene_.camera.height);
    const Eigen::Vector2d at =
        scene_.background_crop.min() + share.cwiseProduct(scene_.background_crop.sizes());
    return LinearColor(PhotoColor(photo, at.x(), at.y()));
  }

  Eigen::Vector3f TableColor(const Eigen::Vector3f& point) const {
    const Table& table = scene_.table;
    const float share = table.look.strength * PatternAt(table.look, point);
    Eigen::Vector3f color = (1.0f - share) * table.look.color + share * table.look.other;
    if (table.photo >= 0) {
      const core::Image& photo = sources_.photos[static_cast<size_t>(table.photo)];
      const double height = table.photo_width * photo.height / photo.width;
      color = PhotoColor(photo, point.x() / table.photo_width + 10.5, point.y() / height + 10.5);
    }
    return color;
  }

  Eigen::Vector3f SurfaceColor(const render::Hit& hit, const Eigen::Vector3f& origin,
                               const Eigen::Vector3f& ray, const PixelSample& sample) const {
    const Eigen::Vector3f point = origin + hit.depth * ray;
    Eigen::Vector3f normal = rays_.ShadingNormal(hit);
    if (normal.dot(ray) > 0.0f) normal = -normal;
    const bool is_table = hit.instance == static_cast<int>(scene_.objects.size());
    Eigen::Vector3f albedo;
    float gloss = 0.0f;
    if (is_table) {
      albedo = LinearColor(TableColor(point));
    } else {
      const TableObject& object = scene_.objects[static_cast<size_t>(hit.instance)];
      Eigen::Vector3f color = rays_.Albedo(hit).head<3>();
      if (object.look.strength > 0.0f) {
        const Eigen::Vector3f local = object_from_world_[static_cast<size_t>(hit.instance)] * point;
        const float share = object.look.strength * PatternAt(object.look, local);
        color += share * (object.look.other - color);
      }
      albedo = LinearColor(color);
      gloss = object.gloss;
    }
    const Eigen::Vector3f start = point + 2e-4f * normal;
    Eigen::Vector3f light = Openness(start, normal, sample) * scene_.light.Shade(normal);
    float shine = 0.0f;
    const float facing = normal.dot(scene_.sun_direction);
    if (scene_.sun > 0.0f && facing > 0.0f) {
      const float sun = scene_.sun * SunShare(start, sample);
      light.array() += sun * facing;
      const Eigen::Vector3f half = (scene_.sun_direction - ray.normalized()).normalized();
      shine = gloss * sun * std::pow(std::max(0.0f, half.dot(normal)), 60.0f);
    }
    return albedo.cwiseProduct(light).array() + shine;
  }

  // Returns point `ray` of `rays` of the pixel's samples on the unit disc: a Fibonacci disc, turned
  // by a hash of the pixel, so that the samples of a pixel share it evenly.
  static Eigen::Vector2f DiscPoint(const PixelSample& sample, int ray, int rays) {
    const auto index = static_cast<float>(ray * sample.count + sample.index);
    const float radius = std::sqrt((index + 0.5f) / static_cast<float>(rays * sample.count));
    const float angle = 6.2831853f * (sample.turn + 0.618034f * index);
    return radius * Eigen::Vector2f(std::cos(angle), std::sin(angle));
  }

  // Returns the share of cosine-weighted directions that are not occluded nearby.
  float Openness(const Eigen::Vector3f& start, const Eigen::Vector3f& normal,
                 const PixelSample& sample) const {
    const Eigen::Vector3f tangent = normal.unitOrthogonal(), bitangent = normal.cross(tangent);
    int open = 0;
    for (int i = 0; i < count_.sky; ++i) {
      const Eigen::Vector2f at = DiscPoint(sample, i, count_.sky);
      const Eigen::Vector3f direction = at.x() * tangent + at.y() * bitangent +
                                        std::sqrt(std::max(0.0f, 1.0f - at.squaredNorm())) * normal;
      open += rays_.Occluded(start, direction, 0.0f, kOcclusionReach) ? 0 : 1;
    }
    return static_cast<float>(open) / static_cast<float>(count_.sky);
  }

  float SunShare(const Eigen::Vector3f& start, const PixelSample& sample) const {
    const Eigen::Vector3f axis = scene_.sun_direction;
    const Eigen::Vector3f tangent = axis.unitOrthogonal(), bitangent = axis.cross(tangent);
    int open = 0;
    for (int i = 0; i < count_.sun; ++i) {
      const Eigen::Vector2f at = scene_.sun_radius * DiscPoint(sample, i, count_.sun);
      open +=
          rays_.Occluded(start, axis + at.x() * tangent + at.y() * bitangent, 0.0f, 1e3f) ? 0 : 1;
    }
    return static_cast<float>(open) / static_cast<float>(count_.sun);
  }

  const TableScene& scene_;
  const TableSceneSources& sources_;
  TablePictureRays count_;
  std::uint64_t seed_;
  core::TexturedMesh board_;
  render::Scene rays_;
  std::vector<Eigen::Isometry3f> object_from_world_;
};

}  // namespace

TablePicture RenderTable(const TableScene& scene, const TableSceneSources& sources,
                         const TablePictureRays& rays, std::uint64_t seed) {
  if (rays.samples < 1 || rays.samples * rays.samples > kMostSamples || rays.sky < 1 ||
      rays.sun < 1) {
    throw core::Error("a picture needs 1 to 4 samples a side, and rays to the sky and the sun");
  }
  const int width = scene.camera.width, height = scene.camera.height;
  TablePicture picture;
  picture.color = core::Image(width, height, 3);
  picture.label.assign(static_cast<size_t>(width) * height, kBackgroundLabel);
  picture.depth.assign(picture.label.size(), 0.0f);
  const TableRenderer renderer(scene, sources, rays, seed);
  core::ParallelFor(height, [&](int y) { renderer.DrawRow(y, &picture); });
  return picture;
}

}  // namespace simwright::twin
