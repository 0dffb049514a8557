#include "asset_lift/outline/missing_parts.h"

#include <algorithm>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "asset_lift/camera/depth_map.h"
#include "render/forward.h"
#include "render/scene.h"

namespace simwright::asset_lift {
namespace {

render::ForwardBuffers DepthFrom(const core::TriangleMesh& mesh, const core::Camera& camera) {
  core::TexturedMesh textured;
  textured.mesh = mesh;
  render::Scene scene;
  scene.Add(&textured);
  scene.Commit();
  return render::RenderForward(scene, camera);
}

// Returns the median depth of the mesh where it borders on a part: there its surface turns away, so
// that the depth is the middle of its thickness. 0 where they do not touch.
double DepthBeside(const cv::Mat& part, const cv::Mat& body,
                   const render::ForwardBuffers& buffers) {
  cv::Mat ring;
  cv::dilate(part & ~body, ring, cv::Mat::ones(5, 5, CV_8U));
  ring &= body;
  std::vector<float> depths;
  for (int y = 0; y < ring.rows; ++y) {
    for (int x = 0; x < ring.cols; ++x) {
      const float depth = buffers.depth[buffers.Index(x, y)];
      if (ring.at<uchar>(y, x) != 0 && depth > 0.0f) depths.push_back(depth);
    }
  }
  if (depths.empty()) return 0.0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

}  // namespace

cv::Mat MaskOfMatte(const Matte& matte) {
  cv::Mat mask(matte.alpha.height, matte.alpha.width, CV_8U);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      mask.at<uchar>(y, x) = matte.alpha.At(x, y)[0] > 127 ? 255 : 0;
    }
  }
  return mask;
}

cv::Mat UncoveredParts(const cv::Mat& mask, const cv::Mat& body, double width) {
  cv::Mat rest = mask & ~body;
  cv::Mat opened;
  cv::morphologyEx(rest, opened, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(opened, labels, stats, centroids, 8);
  cv::Mat kept = cv::Mat::zeros(mask.size(), CV_8U);
  const double smallest = 0.001 * cv::countNonZero(mask);
  for (int label = 1; label < count; ++label) {
    if (stats.at<int>(label, cv::CC_STAT_AREA) > smallest) kept.setTo(255, labels == label);
  }
  if (cv::countNonZero(kept) == 0) return kept;
  const int reach = std::max(3, static_cast<int>(0.07 * width));
  cv::Mat grown;
  cv::dilate(kept, grown,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(2 * reach + 1, 2 * reach + 1)));
  return grown & mask;
}

OutlineField MissingParts(const core::TriangleMesh& mesh, const Matte& matte,
                          const core::Camera& camera) {
  const cv::Mat mask = MaskOfMatte(matte);
  OutlineField field(camera, mask);
  const render::ForwardBuffers buffers = DepthFrom(mesh, camera);
  cv::Mat body(mask.size(), CV_8U);
  for (int y = 0; y < body.rows; ++y) {
    for (int x = 0; x < body.cols; ++x) {
      body.at<uchar>(y, x) = buffers.mask[buffers.Index(x, y)] > 0.5f ? 255 : 0;
    }
  }
  const cv::Mat rest = UncoveredParts(mask, body, matte.right - matte.left);
  cv::Mat labels;
  const int count = cv::connectedComponents(rest, labels, 8);
  for (int label = 1; label < count; ++label) {
    const cv::Mat part = labels == label;
    const double depth = DepthBeside(part, body, buffers);
    if (depth <= 0.0) continue;
    const Eigen::Vector2d center(camera.cx, camera.cy);
    field.AddDepthMap(PoissonDepth(part), camera.position() + depth * camera.Ray(center));
  }
  return field;
}

}  // namespace simwright::asset_lift
