// Captures on a mat that give a wrong shape or texture although they give one: each is said.
#include "capture/capture_doubts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <opencv2/imgproc.hpp>

#include "capture/mat_sharpness.h"
#include "core/error.h"
#include "tests/capture/mat_photos.h"

namespace simwright::capture {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kPhotos = 12;

MatPhotoOptions PhotoSettings() {
  MatPhotoOptions options;
  options.samples_per_side = 1;
  options.lens = PhoneLens(800, 600, 65 * kDegree);
  return options;
}

std::vector<Eigen::Isometry3d> Poses() {
  return OrbitPoses(kPhotos, {20 * kDegree, 40 * kDegree, 60 * kDegree}, 0.13, PhotoSettings().lens,
                    4);
}

std::vector<core::Image> Photograph(const core::TexturedMesh& object) {
  std::vector<core::Image> photos;
  for (MatPhoto& photo : RenderMatPhotos(object, Poses(), PhotoSettings())) {
    photos.push_back(std::move(photo.photo));
  }
  return photos;
}

Capture CaptureOf(const std::vector<core::Image>& photos) {
  CaptureSource source;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    source.photos.push_back({"photo" + std::to_string(i) + ".jpg", 0.0});
  }
  source.read = [&](int i) { return photos[static_cast<std::size_t>(i)]; };
  CaptureOptions options;
  options.first_side = 240;
  options.crop_side = 320;
  options.hull_cells = 64;
  core::Progress progress;
  return CaptureOnMat(source, options, &progress);
}

const core::Finding* FindingNamed(const Capture& capture, const std::string& code) {
  for (const core::Finding& finding : capture.findings) {
    if (finding.code == code) return &finding;
  }
  return nullptr;
}

core::TexturedMesh MovedMesh(core::TexturedMesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& v : mesh.mesh.vertices) v += by;
  return mesh;
}

// A ball on the mat whose facets have the colours of `color_of` a facet's middle and normal.
template <typename ColorOf>
core::TexturedMesh Ball(double radius, const ColorOf& color_of) {
  constexpr int kRings = 24, kSectors = 48;
  core::TexturedMesh ball;
  const Eigen::Vector3d center(0, 0, radius);
  for (int i = 0; i <= kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      const double polar = std::numbers::pi * i / kRings;
      const double azimuth = 2.0 * std::numbers::pi * j / kSectors;
      ball.mesh.vertices.push_back(
          center + radius * Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                            std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  }
  const auto add = [&](int a, int b, int c) {
    const auto& v = ball.mesh.vertices;
    const Eigen::Vector3d middle =
        (v[static_cast<std::size_t>(a)] + v[static_cast<std::size_t>(b)] +
         v[static_cast<std::size_t>(c)]) /
        3.0;
    core::Material material;
    material.base_color << color_of(middle, (middle - center).normalized()), 1.0f;
    ball.mesh.triangles.emplace_back(a, b, c);
    ball.triangle_material.push_back(static_cast<int>(ball.materials.size()));
    ball.materials.push_back(material);
  };
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      const int a = i * kSectors + j, b = i * kSectors + (j + 1) % kSectors;
      if (i + 1 < kRings) add(a, a + kSectors, b + kSectors);
      if (i > 0) add(a, b + kSectors, b);
    }
  }
  return ball;
}

// The light that reaches a mirror from a direction: windows and walls of a room.
Eigen::Vector3f RoomColor(const Eigen::Vector3d& direction) {
  const double azimuth = std::atan2(direction.y(), direction.x());
  const double wall = 0.5 + 0.5 * std::sin(3.0 * azimuth);
  if (direction.z() > 0.75) return {0.95f, 0.95f, 0.9f};
  if (direction.z() < -0.1) return {0.3f, 0.22f, 0.15f};
  return wall > 0.6 ? Eigen::Vector3f(0.75f, 0.85f, 1.0f)
                    : Eigen::Vector3f(0.35f, 0.15f + 0.3f * static_cast<float>(wall), 0.12f);
}

TEST(CaptureDoubts, AMirrorIsSaid) {
  std::vector<core::Image> photos;
  for (const Eigen::Isometry3d& pose : Poses()) {
    const core::TexturedMesh mirror =
        Ball(0.045, [&](const Eigen::Vector3d& at, const Eigen::Vector3d& normal) {
          const Eigen::Vector3d sight = (at - pose.translation()).normalized();
          return RoomColor(sight - 2.0 * sight.dot(normal) * normal);
        });
    photos.push_back(RenderMatPhotos(mirror, {pose}, PhotoSettings()).front().photo);
  }
  // It has no outline of its own where it shows the mat: either its outlines contradict each other,
  // or its colours do.
  std::string sentence;
  try {
    const Capture capture = CaptureOf(photos);
    const core::Finding* const said = FindingNamed(capture, "colors-contradict");
    ASSERT_NE(said, nullptr);
    sentence = said->sentence;
  } catch (const core::Error& error) {
    sentence = error.what();
  }
  EXPECT_NE(sentence.find("mirror"), std::string::npos) << sentence;
}

// The same ball with the room painted on it.
TEST(CaptureDoubts, APaintedBallAndABoxAreNotDoubted) {
  const core::TexturedMesh painted =
      Ball(0.045,
           [](const Eigen::Vector3d&, const Eigen::Vector3d& normal) { return RoomColor(normal); });
  for (const core::TexturedMesh& object : {painted, PaintedBox({0.07, 0.09, 0.06}, 3)}) {
    const Capture capture = CaptureOf(Photograph(object));
    EXPECT_EQ(FindingNamed(capture, "colors-contradict"), nullptr);
    EXPECT_EQ(FindingNamed(capture, "other-objects"), nullptr);
    EXPECT_EQ(FindingNamed(capture, "photo-blurred"), nullptr);
    const ColorContradiction contradiction = MeasureContradiction(capture);
    EXPECT_GT(contradiction.points, 500);
    EXPECT_LT(contradiction.share, 0.2);
    EXPECT_TRUE(contradiction.group.empty());
  }
}

TEST(CaptureDoubts, AnExchangedObjectIsSaidWithItsPhotos) {
  const Eigen::Vector3d sides(0.07, 0.07, 0.08);
  std::vector<core::Image> photos = Photograph(PlainBox(sides, {0.8f, 0.3f, 0.15f}));
  const std::vector<core::Image> others = Photograph(PlainBox(sides, {0.2f, 0.35f, 0.75f}));
  for (const std::size_t i : {1u, 4u, 7u, 10u}) photos[i] = others[i];
  const Capture capture = CaptureOf(photos);
  const core::Finding* const said = FindingNamed(capture, "colors-contradict");
  ASSERT_NE(said, nullptr);
  EXPECT_NE(said->sentence.find("photo1.jpg, photo4.jpg, photo7.jpg, photo10.jpg"),
            std::string::npos)
      << said->sentence;
}

TEST(CaptureDoubts, TwoObjectsBesideEachOtherAreSaid) {
  core::TexturedMesh two = MovedMesh(PlainBox({0.04, 0.04, 0.06}, {0.8f, 0.3f, 0.15f}),
                                     Eigen::Vector3d(-0.04, 0.0, 0.0));
  const core::TexturedMesh second = MovedMesh(PlainBox({0.035, 0.05, 0.05}, {0.8f, 0.7f, 0.15f}),
                                              Eigen::Vector3d(0.045, 0.01, 0.0));
  core::Append(second.mesh, &two.mesh);
  two.materials.push_back(second.materials[0]);
  two.triangle_material.resize(24, 1);
  const Capture capture = CaptureOf(Photograph(two));
  const core::Finding* const said = FindingNamed(capture, "other-objects");
  ASSERT_NE(said, nullptr);
  EXPECT_EQ(said->figure, 2.0);
}

// A sheet of paper over half of the mat is refused or leaves the object's size as it is.
TEST(CaptureDoubts, AHalfCoveredMatGivesNoOtherSize) {
  const Eigen::Vector3d sides(0.06, 0.05, 0.07);
  core::TexturedMesh covered = PlainBox(sides, {0.8f, 0.3f, 0.15f});
  const core::TexturedMesh paper = MovedMesh(PlainBox({0.1, 0.3, 0.0004}, {0.92f, 0.92f, 0.9f}),
                                             Eigen::Vector3d(0.09, 0.0, 0.0));
  core::Append(paper.mesh, &covered.mesh);
  covered.materials.push_back(paper.materials[0]);
  covered.triangle_material.resize(24, 1);
  try {
    const Capture capture = CaptureOf(Photograph(covered));
    const Eigen::Vector3d found = core::Bounds(capture.hull).sizes();
    if (FindingNamed(capture, "mat-covered") == nullptr) {
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], sides[k], 0.15 * sides.maxCoeff()) << k;
    }
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("mat"), std::string::npos) << error.what();
  }
}

TEST(CaptureDoubts, PhotosFromOneSideAreSaid) {
  const MatPhotoOptions settings = PhotoSettings();
  const auto all =
      OrbitPoses(36, {20 * kDegree, 40 * kDegree, 60 * kDegree}, 0.13, settings.lens, 4);
  std::vector<core::Image> photos;
  for (MatPhoto& photo : RenderMatPhotos(PaintedBox({0.07, 0.09, 0.06}, 3),
                                         {all.begin(), all.begin() + 9}, settings)) {
    photos.push_back(std::move(photo.photo));
  }
  const Capture capture = CaptureOf(photos);
  const core::Finding* const said = FindingNamed(capture, "more-photos");
  ASSERT_NE(said, nullptr);
  EXPECT_EQ(said->severity, core::Severity::kWarning);
  EXPECT_GT(said->figure, 180.0);
}

TEST(MatSharpness, BlurredPhotosAreSaid) {
  std::vector<core::Image> photos = Photograph(PaintedBox({0.07, 0.09, 0.06}, 3));
  const auto blur = [](core::Image* photo, double sigma) {
    cv::Mat pixels(photo->height, photo->width, CV_8UC3, photo->pixels.data());
    cv::GaussianBlur(pixels, pixels, {0, 0}, sigma);
  };
  const auto findings_of = [&] {
    std::vector<double> widths;
    std::vector<std::string> names;
    for (const core::Image& photo : photos) {
      const auto mat = DetectMat(photo);
      widths.push_back(mat ? EdgeWidthOnMat(photo, *mat) : 0.0);
      names.push_back("photo" + std::to_string(names.size()) + ".jpg");
    }
    return BlurredPhotos(widths, names);
  };
  EXPECT_TRUE(findings_of().empty());
  // A Gaussian of sigma smears a step over sqrt(2 pi) sigma pixels.
  constexpr double kSigma = 1.4;  // pixels; markers are not recognised from 2 on
  const MatObservation sharp = *DetectMat(photos[5]);
  const double before = EdgeWidthOnMat(photos[5], sharp);
  blur(&photos[5], kSigma);
  const double after = EdgeWidthOnMat(photos[5], sharp);
  const CaptureMat& page = CaptureMatOf(sharp.paper);
  double side = 0.0;  // pixels
  for (std::size_t i = 0; i + 1 < sharp.corners.size(); ++i) {
    if (sharp.corners[i + 1] != sharp.corners[i] + 1) continue;
    if (sharp.corners[i + 1] % (page.columns - 1) == 0) continue;  // begins a row
    side = std::max(side, (sharp.pixels[i + 1] - sharp.pixels[i]).norm());
  }
  EXPECT_GT(after, 1.5 * before);
  EXPECT_NEAR(after / (std::sqrt(2.0 * std::numbers::pi) * kSigma * page.square / side), 1.0, 0.4);
  const core::Findings one = findings_of();
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].code, "photo-blurred");
  EXPECT_EQ(one[0].place, "photo5.jpg");
  const core::Findings all = BlurredPhotos({0.003, 0.004, 0.0035, 0.0}, {"a", "b", "c", "d"});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].place.empty());
}

}  // namespace
}  // namespace simwright::capture
