#include "twin/depth_agreement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "library_fit/fit_kinds.h"
#include "render/forward.h"
#include "render/scene.h"

namespace simwright::twin {
namespace {

constexpr int kComparedWidth = 320;       // pixels of the render
constexpr double kLargestDepthOff = 0.1;  // of the distance
constexpr int kVisibleAlpha = 128;
constexpr size_t kFewestShared = 8;

// Returns the ratios of the fitted to the measured depth over an object's pixels.
std::vector<double> DepthRatios(const ReconstructedObject& object, const TableCamera& numbers,
                                const Detection& detection, const core::FloatImage& depth) {
  const int width = std::min(kComparedWidth, depth.width);
  const int height = std::max(1, width * depth.height / depth.width);
  const core::TexturedMesh mesh = library_fit::InstanceMesh(object.fit.instance);
  render::Scene scene;
  scene.Add(&mesh, object.fit.pose.WorldFromObject());
  scene.Commit();
  const render::ForwardBuffers seen = render::RenderForward(scene, numbers.At(width, height));
  std::vector<double> ratios;
  for (int y = 0; y < height; ++y) {
    const int py = std::min(depth.height - 1, (2 * y + 1) * depth.height / (2 * height));
    for (int x = 0; x < width; ++x) {
      const float fitted = seen.depth[seen.Index(x, y)];
      const int px = std::min(depth.width - 1, (2 * x + 1) * depth.width / (2 * width));
      const float measured = *depth.At(px, py);
      if (fitted <= 0.0f || measured <= 0.0f || *detection.alpha.At(px, py) < kVisibleAlpha) {
        continue;
      }
      ratios.push_back(static_cast<double>(fitted) / measured);
    }
  }
  return ratios;
}

}  // namespace

core::Findings CompareWithDepth(const TableReconstruction& table, const Detections& detections,
                                const core::FloatImage& depth) {
  core::Findings findings;
  for (const ReconstructedObject& object : table.objects) {
    std::vector<double> ratios = DepthRatios(
        object, table.camera, detections.objects[static_cast<size_t>(object.detection)], depth);
    if (ratios.size() < kFewestShared) continue;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    const double off = *middle - 1.0;
    if (std::abs(off) <= kLargestDepthOff) continue;
    char sentence[160];
    std::snprintf(
        sentence, sizeof sentence, "object %d, taken for a %s, is %.0f %% %s than the depth says",
        object.detection + 1,
        library_fit::FitKinds()[static_cast<size_t>(object.fit.instance.kind)].name.c_str(),
        100.0 * std::abs(off), off > 0.0 ? "farther" : "nearer");
    findings.push_back({"twin-depth-disagrees", core::Severity::kWarning, "", sentence, off,
                        "--objects states its box and category"});
  }
  return findings;
}

}  // namespace simwright::twin
