// The painting loop with endpoints that return known pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/error.h"
#include "tests/texture/ball.h"
#include "texture/painting/painting.h"
#include "texture/painting/seam_step.h"
#include "texture/painting/surface_fill.h"
#include "texture/uv_atlas.h"

namespace simwright::texture {
namespace {

constexpr int kTextureSize = 256, kViewSize = 400;

core::TriangleMesh PaintedCube() {
  core::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

core::TexturedMesh WithAtlas(const core::TriangleMesh& mesh) {
  core::TexturedMesh textured;
  textured.mesh = mesh;
  AtlasOptions atlas;
  atlas.size = kTextureSize;
  textured.corner_uvs = UnwrapToAtlas(mesh, atlas);
  return textured;
}

// Paints the n-th view in one colour of its own.
class ColorPerView : public ImageGenerator {
 public:
  std::string name() const override { return "a colour per view"; }
  core::Image Generate(const ImageRequest& request) override {
    std::string error;
    EXPECT_TRUE(request.IsValid(&error)) << error;
    core::Image picture(request.camera.width, request.camera.height, 3);
    const Eigen::Vector3i color = ColorOf(views_++);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
      picture.pixels[i] = static_cast<std::uint8_t>(color[static_cast<int>(i % 3)]);
    }
    return picture;
  }
  static Eigen::Vector3i ColorOf(int view) { return {20 * view + 10, 250 - 20 * view, 40 + view}; }

 private:
  int views_ = 0;
};

// Paints each pixel in the colour that a function of space has at the surface there.
class SolidColor : public ImageGenerator {
 public:
  std::string name() const override { return "a solid texture"; }
  core::Image Generate(const ImageRequest& request) override {
    core::Image picture(request.camera.width, request.camera.height, 3);
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const float depth = *request.depth.At(x, y);
        if (depth == 0.0f) continue;
        const Eigen::Vector3d point =
            request.camera.position() + depth * request.camera.Ray({x + 0.5, y + 0.5});
        for (int c = 0; c < 3; ++c) {
          picture.At(x, y)[c] = static_cast<std::uint8_t>(std::lround(255 * At(point)[c]));
        }
      }
    }
    return picture;
  }
  static Eigen::Vector3d At(const Eigen::Vector3d& p) {
    return {0.5 + 0.3 * std::sin(2 * p.x()), 0.5 + 0.3 * std::sin(2 * p.y() + 1),
            0.5 + 0.3 * std::cos(2 * p.z())};
  }
};

PaintingOptions Options() {
  PaintingOptions options;
  options.prompt = "known colours";
  options.view_size = kViewSize;
  return options;
}

// Replays the rule on a convex body for one texel from the trimaps alone, with its own geometry:
// returns the views that may have painted it last. There is one, but where the border between what
// a view keeps and what it repaints is near: there the colours blend.
struct Expectation {
  std::set<int> owners;
  bool blended = false;
  bool at_threshold = false;  // of a cosine: the last digits decide
};

bool TrimapIsUniform(const core::Image& trimap, int x, int y, int reach) {
  const bool keep = *trimap.At(x, y) == kTrimapKeep;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int px = x + dx, py = y + dy;
      if (px < 0 || py < 0 || px >= trimap.width || py >= trimap.height) continue;
      if ((*trimap.At(px, py) == kTrimapKeep) != keep) return false;
    }
  }
  return true;
}

Expectation Replay(const Painting& painting, const Eigen::Vector3d& point,
                   const Eigen::Vector3d& normal, const PaintingOptions& options) {
  Expectation expected;
  expected.owners = {kUnseenTexel};
  double best = 0.0;
  for (std::size_t v = 0; v < painting.views.size(); ++v) {
    const PaintedView& view = painting.views[v];
    const double facing = normal.dot((view.camera.position() - point).normalized());
    // The normals of the mesh are those of the sphere up to this.
    expected.at_threshold |= std::abs(facing - options.least_facing) < 0.004 ||
                             std::abs(facing + options.refine_gain - best) < 0.004;
    const bool painted = !expected.owners.contains(kUnseenTexel);
    if (facing < options.least_facing) continue;
    if (painted && !expected.blended && facing + options.refine_gain < best) continue;
    const Eigen::Vector3d at = view.camera.Project(point);
    const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
    // In single precision the pixel may be the next one.
    expected.at_threshold |= !TrimapIsUniform(view.trimap, x, y, 1);
    if (*view.trimap.At(x, y) == kTrimapKeep) continue;
    // The Gaussian of the blend has a standard deviation of 5.3 pixels here.
    const bool uniform = TrimapIsUniform(view.trimap, x, y, 16);
    if (!painted || (uniform && !expected.blended)) {
      expected.owners = {static_cast<int>(v)};
      best = facing;
      continue;
    }
    expected.blended = true;
    expected.owners.insert(static_cast<int>(v));
  }
  return expected;
}

void ExpectTexelsFollowTheTrimaps(const core::TriangleMesh& mesh, bool round) {
  const core::TexturedMesh textured = WithAtlas(mesh);
  const TexelMap map = MakeTexelMap(mesh, textured.corner_uvs, kTextureSize);
  const PaintingOptions options = Options();
  ColorPerView endpoint;
  core::Progress silent;
  const Painting painting = PaintTexture(textured, map, options, &endpoint, &silent);
  ASSERT_EQ(painting.views.size(), 10u);
  int inside = 0, exact = 0;
  for (std::size_t i = 0; i < map.count(); ++i) {
    if (!map.inside[i]) continue;
    ++inside;
    const Eigen::Vector3d point = map.Position(mesh, i);
    const Eigen::Vector3d normal =
        round ? point.normalized()
              : core::TriangleAreaVector(mesh, map.triangle[i]).normalized().eval();
    const int painter = painting.painted_by[i];
    const Expectation expected = Replay(painting, point, normal, options);
    if (expected.at_threshold) continue;
    if (expected.owners.size() > 1) {
      EXPECT_TRUE(expected.owners.contains(painter)) << i;
      continue;
    }
    ASSERT_EQ(painter, *expected.owners.begin()) << point.transpose();
    if (expected.blended || painter < 0) continue;
    ++exact;
    for (int c = 0; c < 3; ++c) {
      ASSERT_EQ(painting.texture.pixels[3 * i + c], ColorPerView::ColorOf(painter)[c])
          << point.transpose();
    }
  }
  EXPECT_GT(exact, 0.5 * inside);
  EXPECT_LT(painting.unseen_share, 0.07);  // of a sphere below and behind
}

TEST(Painting, EachTexelOfACubeIsPaintedByTheViewThatTheTrimapSays) {
  ExpectTexelsFollowTheTrimaps(PaintedCube(), false);
}

TEST(Painting, EachTexelOfASphereIsPaintedByTheViewThatTheTrimapSays) {
  ExpectTexelsFollowTheTrimaps(Ball(48), true);
}

// The views that see the middle of each face squarest: the closed form of the rule for a cube. A
// view 45 degrees aside sees a face at a cosine of 0.61, the one in front of it at 0.87.
TEST(Painting, FacesOfACubeEndWithTheViewInFrontOfThem) {
  const core::TriangleMesh cube = PaintedCube();
  const core::TexturedMesh textured = WithAtlas(cube);
  const TexelMap map = MakeTexelMap(cube, textured.corner_uvs, kTextureSize);
  ColorPerView endpoint;
  core::Progress silent;
  const Painting painting = PaintTexture(textured, map, Options(), &endpoint, &silent);
  int checked = 0;
  for (std::size_t i = 0; i < map.count(); ++i) {
    if (!map.inside[i]) continue;
    const Eigen::Vector3d p = map.Position(cube, i);
    const Eigen::Vector3d n = core::TriangleAreaVector(cube, map.triangle[i]).normalized();
    if ((p - n).norm() > 0.5) continue;  // the middle of a face
    ++checked;
    // The front is -x, and azimuths grow counter-clockwise seen from above.
    const int expected = n.x() < -0.5   ? 0
                         : n.y() < -0.5 ? 3
                         : n.y() > 0.5  ? 4
                         : n.x() > 0.5  ? 7
                         : n.z() > 0.5  ? 8
                                        : 9;
    ASSERT_EQ(painting.painted_by[i], expected) << p.transpose();
  }
  EXPECT_GT(checked, 1000);
}

TEST(Painting, ASolidTextureComesBackAtEachPointWithoutSeams) {
  for (const bool round : {false, true}) {
    core::TexturedMesh textured = WithAtlas(round ? Ball(32) : PaintedCube());
    const TexelMap map = MakeTexelMap(textured.mesh, textured.corner_uvs, kTextureSize);
    SolidColor endpoint;
    core::Progress silent;
    const Painting painting = PaintTexture(textured, map, Options(), &endpoint, &silent);
    double worst = 0.0;
    for (std::size_t i = 0; i < map.count(); ++i) {
      if (!map.inside[i] || painting.painted_by[i] < 0) continue;
      const Eigen::Vector3d expected = SolidColor::At(map.Position(textured.mesh, i));
      for (int c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(painting.texture.pixels[3 * i + c] / 255.0 - expected[c]));
      }
    }
    EXPECT_LT(worst, 4.0 / 255.0);
    textured.textures = {painting.texture};
    const SeamSteps steps = MeasureSeamSteps(textured, M_PI);
    EXPECT_GT(steps.seam_samples, 100);
    // The steps are of one grey level, and so is the rounding.
    EXPECT_LT(steps.Ratio(), 1.1);
  }
}

TEST(Painting, RefusesAPictureOfAnotherSizeAndAnEmptyRequest) {
  class Small : public ImageGenerator {
   public:
    std::string name() const override { return "small"; }
    core::Image Generate(const ImageRequest&) override { return core::Image(64, 64, 3); }
  };
  const core::TexturedMesh textured = WithAtlas(PaintedCube());
  const TexelMap map = MakeTexelMap(textured.mesh, textured.corner_uvs, kTextureSize);
  Small endpoint;
  core::Progress silent;
  EXPECT_THROW(PaintTexture(textured, map, Options(), &endpoint, &silent), core::Error);
  PaintingOptions empty = Options();
  empty.prompt.clear();
  EXPECT_THROW(PaintTexture(textured, map, empty, &endpoint, &silent), core::Error);
}

TEST(TexelMap, GutterTexelsContinueTheSurface) {
  const core::TexturedMesh textured = WithAtlas(PaintedCube());
  const TexelMap map = MakeTexelMap(textured.mesh, textured.corner_uvs, kTextureSize);
  EXPECT_TRUE(UvsAreUnique(textured.mesh, textured.corner_uvs));
  int gutter = 0;
  for (std::size_t i = 0; i < map.count(); ++i) {
    if (map.triangle[i] < 0 || map.inside[i]) continue;
    ++gutter;
    // Extrapolated on the plane of its face, at most kGutter texels (of 2 / 60 m) beyond it.
    const Eigen::Vector3d p = map.Position(textured.mesh, i);
    const Eigen::Vector3d n = core::TriangleAreaVector(textured.mesh, map.triangle[i]).normalized();
    EXPECT_NEAR(p.dot(n), 1.0, 1e-4);
    EXPECT_LT(p.cwiseAbs().maxCoeff(), 1.4);
  }
  EXPECT_GT(gutter, 500);
}

TEST(TexelMap, KnowsCoordinatesThatOverlapOrTile) {
  const core::TriangleMesh cube = PaintedCube();
  std::vector<Eigen::Vector2f> same, tiled = UnwrapToAtlas(cube, {});
  for (std::size_t t = 0; t < cube.triangles.size(); ++t) {
    same.insert(same.end(), {{0, 0}, {1, 0}, {0, 1}});
  }
  EXPECT_FALSE(UvsAreUnique(cube, same));
  tiled[0].x() += 1.0f;
  EXPECT_FALSE(UvsAreUnique(cube, tiled));
  EXPECT_FALSE(UvsAreUnique(cube, {}));
}

TEST(SurfaceFill, UnknownPointsTakeTheColoursAround) {
  std::vector<Eigen::Vector3f> points, colors;
  std::vector<std::uint8_t> known;
  for (int i = 0; i <= 100; ++i) {
    const float x = 0.01f * static_cast<float>(i);
    points.emplace_back(x, 0, 0);
    known.push_back(i < 40 || i > 60);
    colors.push_back(known.back() ? Eigen::Vector3f(x, 0.5f, 0) : Eigen::Vector3f(9, 9, 9));
  }
  FillUnknownColors(points, known, 0.01f, &colors);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LE(colors[i].maxCoeff(), 1.0f);
    EXPECT_NEAR(colors[i].y(), 0.5f, 1e-5f);
    if (known[i]) {
      EXPECT_EQ(colors[i].x(), points[i].x());
    }
    if (i > 0) {
      EXPECT_LT(std::abs(colors[i].x() - colors[i - 1].x()), 0.12f);
    }
  }
  EXPECT_NEAR(colors[50].x(), 0.5f, 0.1f);
}

}  // namespace
}  // namespace simwright::texture
