// Compares our stereo with OpenCV's semi-global matching of rectified neighbours (StereoSGBM) on
// rendered views, against the renderer's depths.
//   bench_stereo_quality [--views N] [--kinds N]
// Objects: a painted box and tray, and library kinds of development seeds. Per object and method:
// the share of the object's pixels that have a depth, the median and the ninth decile of the error
// (percent of the diagonal), and seconds. A depth of semi-global matching counts where two of three
// neighbours agree within the distance within which ours must agree.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/stereo_depth.h"
#include "core/error.h"
#include "core/parallel.h"
#include "library/rigid/rigid_kinds.h"
#include "tests/capture/mat_photos.h"
#include "tests/capture/rendered_views.h"

namespace simwright::bench {
namespace {

constexpr int kDisparities = 192, kPairs = 3;

using Views = std::vector<asset_lift::ObservedView>;

// A view turned so that its rows run along the line between two cameras.
struct RectifiedView {
  cv::Mat grey;
  Eigen::Matrix3d rectified_from_camera;
  double fx = 0.0, cx = 0.0, cy = 0.0;
};

RectifiedView Rectify(const asset_lift::ObservedView& view, const Eigen::Matrix3d& turn,
                      const Eigen::Vector3d& object) {
  const core::Camera& camera = view.camera;
  const int side = 3 * std::max(camera.width, camera.height) / 2;
  RectifiedView rectified;
  rectified.rectified_from_camera = turn * camera.world_from_camera.linear();
  const Eigen::Vector3d at = turn * (object - camera.position());
  rectified.fx = camera.fx;
  rectified.cx = 0.5 * side - camera.fx * at.x() / at.z();
  rectified.cy = 0.5 * side - camera.fx * at.y() / at.z();
  cv::Mat grey(camera.height, camera.width, CV_8U), map_x(side, side, CV_32F),
      map_y(side, side, CV_32F);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const float* rgb = view.color.At(x, y);
      const bool inside = *view.opacity.At(x, y) > 0.5f;
      grey.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(
          inside ? 255.0f * (0.3f * rgb[0] + 0.59f * rgb[1] + 0.11f * rgb[2]) : 0.0f);
    }
  }
  const Eigen::Matrix3d back = rectified.rectified_from_camera.transpose();
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Eigen::Vector3d ray =
          back * Eigen::Vector3d((x + 0.5 - rectified.cx) / rectified.fx,
                                 (y + 0.5 - rectified.cy) / rectified.fx, 1.0);
      const bool before = ray.z() > 1e-6;
      map_x.at<float>(y, x) =
          before ? static_cast<float>(camera.fx * ray.x() / ray.z() + camera.cx - 0.5) : -1.0f;
      map_y.at<float>(y, x) =
          before ? static_cast<float>(camera.fy * ray.y() / ray.z() + camera.cy - 0.5) : -1.0f;
    }
  }
  cv::remap(grey, rectified.grey, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return rectified;
}

// Returns the first view's depths from one pair; 0: unknown.
core::FloatImage PairDepths(const asset_lift::ObservedView& first,
                            const asset_lift::ObservedView& second, const Eigen::Vector3d& object) {
  const Eigen::Vector3d base = second.camera.position() - first.camera.position();
  const Eigen::Vector3d along = base.normalized();
  const Eigen::Vector3d looking = first.camera.world_from_camera.linear().col(2) +
                                  second.camera.world_from_camera.linear().col(2);
  Eigen::Matrix3d turn;
  turn.row(0) = along;
  turn.row(1) = looking.cross(along).normalized();
  turn.row(2) = turn.row(0).cross(turn.row(1));
  const RectifiedView left = Rectify(first, turn, object), right = Rectify(second, turn, object);
  const auto matcher = cv::StereoSGBM::create(-kDisparities / 2, kDisparities, 5, 8 * 25, 32 * 25,
                                              1, 31, 10, 50, 2, cv::StereoSGBM::MODE_SGBM);
  cv::Mat disparities;
  matcher->compute(left.grey, right.grey, disparities);
  const core::Camera& camera = first.camera;
  core::FloatImage depths(camera.width, camera.height, 1);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      if (*first.opacity.At(x, y) < 0.5f) continue;
      const Eigen::Vector3d ray = turn * camera.Ray({x + 0.5, y + 0.5});
      const int u = static_cast<int>(left.fx * ray.x() / ray.z() + left.cx);
      const int v = static_cast<int>(left.fx * ray.y() / ray.z() + left.cy);
      if (u < 0 || v < 0 || u >= disparities.cols || v >= disparities.rows) continue;
      const int raw = disparities.at<std::int16_t>(v, u);
      if (raw < -16 * kDisparities / 2) continue;
      const double shift = raw / 16.0 - (left.cx - right.cx);
      if (shift > 0.0) {
        *depths.At(x, y) = static_cast<float>(left.fx * base.norm() / shift / ray.z());
      }
    }
  }
  return depths;
}

std::vector<core::FloatImage> SemiGlobalDepths(const capture::RenderedViews& rendered,
                                               const capture::StereoOptions& options) {
  const Views& views = rendered.views;
  const Eigen::Vector3d object = core::Bounds(rendered.hull).center();
  std::vector<core::FloatImage> depths(views.size());
  core::ParallelFor(static_cast<int>(views.size()), [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    std::vector<std::pair<double, std::size_t>> nearest;
    for (std::size_t j = 0; j < views.size(); ++j) {
      const Eigen::Vector3d a = (views[i].camera.position() - object).normalized();
      const Eigen::Vector3d b = (views[j].camera.position() - object).normalized();
      if (j != i) nearest.emplace_back(-a.dot(b), j);
    }
    std::sort(nearest.begin(), nearest.end());
    std::vector<core::FloatImage> pairs;
    for (std::size_t k = 0; k < kPairs && k < nearest.size(); ++k) {
      pairs.push_back(PairDepths(views[i], views[nearest[k].second], object));
    }
    depths[i] = core::FloatImage(views[i].camera.width, views[i].camera.height, 1);
    for (std::size_t p = 0; p < depths[i].values.size(); ++p) {
      for (std::size_t a = 0; a < pairs.size(); ++a) {
        for (std::size_t b = a + 1; b < pairs.size(); ++b) {
          const float one = pairs[a].values[p], other = pairs[b].values[p];
          if (one > 0.0f && other > 0.0f &&
              std::abs(one - other) < options.agreement * rendered.diagonal) {
            depths[i].values[p] = 0.5f * (one + other);
          }
        }
      }
    }
  });
  return depths;
}

void PrintErrors(const std::string& object, const char* method,
                 const capture::RenderedViews& rendered,
                 const std::vector<core::FloatImage>& depths, double seconds) {
  std::vector<double> errors;
  double all = 0.0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    for (std::size_t p = 0; p < depths[i].values.size(); ++p) {
      if (!(rendered.depths[i][p] > 0.0f)) continue;
      all += 1.0;
      const float depth = depths[i].values[p];
      if (!(depth > 0.0f)) continue;
      errors.push_back(100.0 * std::abs(depth - rendered.depths[i][p]) / rendered.diagonal);
    }
  }
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double share) {
    if (errors.empty()) return 0.0;
    return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  std::printf("%-16s %-12s %6.1f %6.2f %6.2f %6.1f\n", object.c_str(), method,
              100.0 * static_cast<double>(errors.size()) / all, at(0.5), at(0.9), seconds);
  std::fflush(stdout);
}

void MeasureBoth(const std::string& name, const core::TexturedMesh& object, int count) {
  const capture::RenderedViews rendered = capture::RenderViews(object, count);
  const capture::StereoOptions options;
  const auto timed = [](const auto& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  core::Progress silent;
  std::vector<core::FloatImage> depths;
  double seconds = timed([&] {
    depths = capture::FindStereoDepths(rendered.views, rendered.hull, options, &silent).depths;
  });
  PrintErrors(name, "patch match", rendered, depths, seconds);
  seconds = timed([&] { depths = SemiGlobalDepths(rendered, options); });
  PrintErrors(name, "semi-global", rendered, depths, seconds);
}

int Main(int count, char** arguments) {
  int views = 24, kinds = 4;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string flag = arguments[i];
    (flag == "--kinds" ? kinds : views) = std::stoi(arguments[i + 1]);
  }
  std::printf("%-16s %-12s %6s %6s %6s %6s\n", "object", "method", "share", "error", "90 %", "s");
  MeasureBoth("painted box", capture::PaintedBox({0.09, 0.07, 0.05}, 4), views);
  MeasureBoth("painted tray", capture::PaintedTray({0.09, 0.08, 0.04}, 0.006, 5), views);
  const std::vector<library::RigidKind>& all = library::RigidKinds();
  for (int i = 0; i < kinds; ++i) {
    const library::RigidKind& kind =
        all[static_cast<std::size_t>(i) * all.size() / static_cast<std::size_t>(kinds)];
    MeasureBoth(kind.name,
                library::MakeRigidObject(kind, 7001 + static_cast<std::uint64_t>(i)).visual, views);
  }
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int count, char** arguments) {
  try {
    return simwright::bench::Main(count, arguments);
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
