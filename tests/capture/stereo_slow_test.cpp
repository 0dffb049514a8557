// Stereo on rendered views, against the renderer's depths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "capture/depth_carving.h"
#include "capture/hull_field.h"
#include "capture/stereo_depth.h"
#include "core/error.h"
#include "geometry/surface_distance.h"
#include "tests/capture/mat_photos.h"
#include "tests/capture/rendered_views.h"

namespace simwright::capture {
namespace {

struct DepthErrors {
  double share = 0.0, median = 0.0, ninth_decile = 0.0;  // errors in percent of the diagonal
};

DepthErrors Compare(const StereoDepths& found, const RenderedViews& rendered) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < rendered.views.size(); ++i) {
    for (std::size_t p = 0; p < rendered.depths[i].size(); ++p) {
      const float depth = found.depths[i].values[p];
      if (depth > 0.0f && rendered.depths[i][p] > 0.0f) {
        errors.push_back(100.0 * std::abs(depth - rendered.depths[i][p]) / rendered.diagonal);
      }
    }
  }
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const DepthErrors result{found.share, errors[errors.size() / 2], errors[errors.size() * 9 / 10]};
  std::printf("depths at %.3f of the pixels, error %.3f %%, ninth decile %.3f %%\n", result.share,
              result.median, result.ninth_decile);
  return result;
}

StereoDepths DepthsOf(RenderedViews* rendered) {
  core::Progress silent;
  StereoDepths found = FindStereoDepths(rendered->views, rendered->hull, {}, &silent);
  for (std::size_t i = 0; i < rendered->views.size(); ++i) {
    rendered->views[i].depth = found.depths[i];
  }
  return found;
}

core::TriangleMesh CarvedHull(const RenderedViews& rendered) {
  geometry::ScalarGrid field = HullField(rendered.hull, {});
  CarveByDepth(rendered.views, {}, &field);
  return geometry::ExtractIsosurface(field, 0.0f);
}

double MeanDistance(const core::TriangleMesh& from, const core::TriangleMesh& to) {
  double sum = 0.0;
  const std::vector<double> distances =
      geometry::DistancesToSurface(geometry::SampleOuterSurface(from, 5000, 1), to);
  for (const double d : distances) sum += d;
  return 100.0 * sum / static_cast<double>(distances.size()) / core::Bounds(to).diagonal().norm();
}

TEST(Stereo, MeasuresAPaintedBox) {
  const core::TexturedMesh box = PaintedBox({0.09, 0.07, 0.05}, 4);
  RenderedViews rendered = RenderViews(box, 18);
  const DepthErrors errors = Compare(DepthsOf(&rendered), rendered);
  EXPECT_GT(errors.share, 0.5);
  EXPECT_LT(errors.median, 0.25);
  EXPECT_LT(errors.ninth_decile, 0.8);
  const core::TriangleMesh carved = CarvedHull(rendered);
  const double before = MeanDistance(rendered.hull, box.mesh);
  const double after = MeanDistance(carved, box.mesh);
  std::printf("distance of the hull %.3f %%, carved %.3f %%\n", before, after);
  EXPECT_LT(after, 0.5 * before);
}

TEST(Stereo, FindsAHollowThatOutlinesDoNotShow) {
  const core::TexturedMesh tray = PaintedTray({0.09, 0.08, 0.04}, 0.006, 5);
  RenderedViews rendered = RenderViews(tray, 18);
  const DepthErrors errors = Compare(DepthsOf(&rendered), rendered);
  EXPECT_GT(errors.share, 0.4);
  EXPECT_LT(errors.median, 0.3);
  const core::TriangleMesh carved = CarvedHull(rendered);
  const double before = MeanDistance(tray.mesh, rendered.hull);
  const double after = MeanDistance(tray.mesh, carved);
  std::printf("distance to the hull %.3f %%, carved %.3f %%\n", before, after);
  EXPECT_LT(after, 0.3 * before);
}

TEST(Stereo, FindsNothingOnAPlainBox) {
  const core::TexturedMesh box = PlainBox({0.09, 0.07, 0.05}, {0.7f, 0.3f, 0.2f});
  RenderedViews rendered = RenderViews(box, 12);
  const StereoDepths found = DepthsOf(&rendered);
  const DepthErrors errors = Compare(found, rendered);
  EXPECT_LT(found.share, 0.05);
  EXPECT_LT(errors.median, 1.0);
}

TEST(Stereo, KeepsTheHullWithoutDepths) {
  const core::TexturedMesh box = PlainBox({0.09, 0.07, 0.05}, {0.7f, 0.3f, 0.2f});
  RenderedViews rendered = RenderViews(box, 12);
  const core::TriangleMesh same = CarvedHull(rendered);
  EXPECT_LT(MeanDistance(same, rendered.hull), 0.05);
  EXPECT_THROW(HullField({}, {}), core::Error);
  core::Progress silent;
  EXPECT_THROW(FindStereoDepths(rendered.views, {}, {}, &silent), core::Error);
}

}  // namespace
}  // namespace simwright::capture
