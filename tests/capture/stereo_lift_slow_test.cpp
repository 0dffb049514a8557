// The lift of photos with stereo and without, on rendered photos on a mat.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "capture/capture.h"
#include "capture/capture_lift.h"
#include "geometry/surface_distance.h"
#include "tests/capture/mat_photos.h"

namespace simwright::capture {
namespace {

constexpr double kWallOfTray = 0.006;  // m

// Returns the mean height of the surface's samples in the middle of the hollow, m.
double FloorHeight(const core::TriangleMesh& mesh) {
  double sum = 0.0;
  int count = 0;
  for (const geometry::OuterHit& hit : geometry::SampleOuterHits(mesh, 20000, 1)) {
    if (hit.point.head<2>().cwiseAbs().maxCoeff() > 0.025 || hit.normal.z() < 0.5) continue;
    sum += hit.point.z();
    ++count;
  }
  return sum / std::max(1, count);
}

asset_lift::LiftedMesh Lift(const Capture& capture) {
  CaptureLiftOptions options;
  options.fit_side = 240;
  options.fit.mesh.steps_per_round = 40;
  options.fit.mesh.last_edge_ratio = 0.03;
  options.texture_size = 256;
  core::Progress silent;
  return LiftCapture(capture, options, &silent);
}

TEST(StereoLift, MeasuresAHollow) {
  const core::TexturedMesh tray = PaintedTray({0.09, 0.08, 0.04}, kWallOfTray, 5);
  MatPhotoOptions photo;
  photo.lens = PhoneLens(900, 675, 65 * std::numbers::pi / 180);
  photo.samples_per_side = 2;
  const std::vector<double> rings = {0.26, 0.66, 1.08};
  const auto photos = RenderMatPhotos(tray, OrbitPoses(15, rings, 0.13, photo.lens, 7), photo);
  CaptureSource source;
  for (std::size_t i = 0; i < photos.size(); ++i) source.photos.push_back({std::to_string(i), 0.0});
  source.read = [&](int i) { return photos[static_cast<std::size_t>(i)].photo; };
  core::Progress silent;
  const Capture capture = CaptureOnMat(source, {}, &silent);
  const StartShape start = MakeStartShape(capture, 240, {}, &silent);
  std::printf("hull %.1f mm wide, start %.1f mm, its floor %.1f mm too high\n",
              1e3 * core::Bounds(capture.hull).sizes().x(),
              1e3 * core::Bounds(start.mesh).sizes().x(),
              1e3 * (FloorHeight(start.mesh) - kWallOfTray));
  const asset_lift::LiftedMesh after = Lift(capture);
  // No outline shows the hollow: without stereo the lift starts from the hull.
  const double without = FloorHeight(capture.hull) - kWallOfTray;
  const double with = FloorHeight(after.mesh.mesh) - kWallOfTray;
  std::printf(
      "the hollow's floor is %.1f mm too high in the hull, %.1f mm after the lift; size %.1f mm\n",
      1e3 * without, 1e3 * with, 1e3 * core::Bounds(after.mesh.mesh).sizes().x());
  EXPECT_GT(without, 0.01);
  EXPECT_LT(std::abs(with), 0.002);
  EXPECT_LT(core::Bounds(after.mesh.mesh).sizes().x(), core::Bounds(capture.hull).sizes().x());
  const auto is_stereo = [](const core::Finding& f) { return f.code == "stereo"; };
  const auto said = std::find_if(after.findings.begin(), after.findings.end(), is_stereo);
  ASSERT_NE(said, after.findings.end());
  EXPECT_GT(said->figure, 0.25);
}

}  // namespace
}  // namespace simwright::capture
