#include "capture/capture_doubts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "core/parallel.h"
#include "geometry/mesh_validity.h"
#include "geometry/weld.h"
#include "render/forward.h"

namespace simwright::capture {
namespace {

using Eigen::Vector3d;

constexpr double kBodyShare = 0.05;  // of the largest body's volume, from which another counts
constexpr double kMatEdge = 0.93;    // of the half mat, from which a hull reaches its edge
constexpr int kSurfacePoints = 2500;
constexpr double kFacing = 0.45;        // least cosine between normal and line of sight
constexpr double kDepthReach = 0.015;   // of the hull's diagonal, for a point to be visible
constexpr double kColorRadius = 0.012;  // of the diagonal, over which colours are averaged
constexpr float kSureOpacity = 0.95f;
constexpr int kLeastViews = 3;
constexpr int kLeastPoints = 100;
// CIELAB: the offsets that a camera's automatic exposure and white balance explain.
const Vector3d kLargestOffset(15.0, 6.0, 6.0);
constexpr double kSpread = 16.0;         // CIELAB, from which colours contradict each other
constexpr double kDoubtfulShare = 0.35;  // of the points, from which the capture is doubted
constexpr int kCommonPoints = 25;        // of two views that are compared

struct SurfacePoint {
  Vector3d at;
  Vector3d normal;
};

// A surface point's colour in each view that shows it.
struct PointColors {
  std::vector<std::pair<int, Vector3d>> seen;  // (view, CIELAB)
};

std::vector<SurfacePoint> SurfacePointsOf(const core::TriangleMesh& hull) {
  std::vector<SurfacePoint> points;
  const double step = std::max(1.0, static_cast<double>(hull.triangles.size()) / kSurfacePoints);
  for (double next = 0.0; next < static_cast<double>(hull.triangles.size()); next += step) {
    const int t = static_cast<int>(next);
    const Vector3d normal = core::TriangleAreaVector(hull, t).normalized();
    if (!normal.allFinite() || normal.z() < -0.5) continue;  // the underside is not seen
    const Eigen::Vector3i& f = hull.triangles[t];
    points.push_back(
        {(hull.vertices[f[0]] + hull.vertices[f[1]] + hull.vertices[f[2]]) / 3.0, normal});
  }
  return points;
}

// The smoothed colours of a view, and the depths of the hull in it.
class ViewColors {
 public:
  ViewColors(const CaptureView& view, const render::Scene& scene, double diagonal)
      : view_(view), reach_(kDepthReach * diagonal) {
    depth_ = render::RenderForward(scene, view.camera).depth;
    const core::Image& photo = view.photo;
    const cv::Mat source(photo.height, photo.width, CV_8UC(photo.channels),
                         const_cast<std::uint8_t*>(photo.pixels.data()));
    cv::Mat rgb;
    cv::cvtColor(source, rgb, photo.channels == 4 ? cv::COLOR_RGBA2BGR : cv::COLOR_RGB2BGR);
    rgb.convertTo(rgb, CV_32F, 1.0 / 255.0);
    const double pixels = kColorRadius * diagonal * view.camera.fx / MeanDepth();
    const int side = 2 * std::max(1, static_cast<int>(std::lround(pixels))) + 1;
    cv::blur(rgb, rgb, {side, side});
    cv::cvtColor(rgb, lab_, cv::COLOR_BGR2Lab);
  }

  // Returns true if the view shows the point; `*color` receives its CIELAB colour.
  bool See(const SurfacePoint& point, Vector3d* color) const {
    const Vector3d sight = (view_.camera.position() - point.at).normalized();
    if (sight.dot(point.normal) < kFacing) return false;
    const Vector3d at = view_.camera.Project(point.at);
    const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
    if (at.z() <= 0.0 || x < 0 || y < 0 || x >= lab_.cols || y >= lab_.rows) return false;
    const float hit = depth_[static_cast<std::size_t>(y) * lab_.cols + x];
    if (hit <= 0.0f || std::abs(hit - at.z()) > reach_) return false;
    if (*view_.opacity.At(x, y) < kSureOpacity) return false;
    const cv::Vec3f& lab = lab_.at<cv::Vec3f>(y, x);
    *color = Vector3d(lab[0], lab[1], lab[2]);
    return true;
  }

 private:
  double MeanDepth() const {
    double sum = 0.0;
    int count = 0;
    for (const float depth : depth_) {
      if (depth <= 0.0f) continue;
      sum += depth;
      ++count;
    }
    return count > 0 ? sum / count : 1.0;
  }

  const CaptureView& view_;
  const double reach_;
  std::vector<float> depth_;
  cv::Mat lab_;
};

Vector3d MeanOf(const PointColors& point) {
  Vector3d mean = Vector3d::Zero();
  for (const auto& [view, color] : point.seen) mean += color;
  return mean / static_cast<double>(point.seen.size());
}

// Takes the offsets of exposure and white balance out of the colours.
void BalanceViews(std::size_t views, std::vector<PointColors>* points) {
  for (int pass = 0; pass < 4; ++pass) {
    std::vector<std::vector<double>> off[3];
    for (auto& channel : off) channel.resize(views);
    for (const PointColors& point : *points) {
      const Vector3d mean = MeanOf(point);
      for (const auto& [view, color] : point.seen) {
        for (int k = 0; k < 3; ++k) {
          off[k][static_cast<std::size_t>(view)].push_back(color[k] - mean[k]);
        }
      }
    }
    std::vector<Vector3d> offset(views, Vector3d::Zero());
    for (std::size_t v = 0; v < views; ++v) {
      for (int k = 0; k < 3; ++k) {
        std::vector<double>& values = off[k][v];
        if (values.empty()) continue;
        std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
        offset[v][k] = std::clamp(values[values.size() / 2], -kLargestOffset[k] / 4.0,
                                  kLargestOffset[k] / 4.0);
      }
    }
    for (PointColors& point : *points) {
      for (auto& [view, color] : point.seen) color -= offset[static_cast<std::size_t>(view)];
    }
  }
}

// Returns the largest distance of a view's colour from the median of the others', with the view
// that differs most left out: one view may have a highlight.
double SpreadOf(const PointColors& point) {
  Vector3d median;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const auto& [view, color] : point.seen) values.push_back(color[k]);
    std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
    median[k] = values[values.size() / 2];
  }
  std::vector<double> distances;
  for (const auto& [view, color] : point.seen) distances.push_back((color - median).norm());
  std::sort(distances.begin(), distances.end());
  return distances[distances.size() - 2];
}

// Returns the smaller of two groups into which the views fall, or none: each view agrees with one
// of the two that differ most, and the groups differ by more than views within them do.
std::vector<int> GroupOf(int views, const std::vector<PointColors>& points) {
  const auto n = static_cast<std::size_t>(views);
  std::vector<double> sum(n * n, 0.0);
  std::vector<int> count(n * n, 0);
  for (const PointColors& point : points) {
    for (const auto& [a, color_a] : point.seen) {
      for (const auto& [b, color_b] : point.seen) {
        sum[static_cast<std::size_t>(a) * n + static_cast<std::size_t>(b)] +=
            (color_a - color_b).norm();
        ++count[static_cast<std::size_t>(a) * n + static_cast<std::size_t>(b)];
      }
    }
  }
  // A spanning tree of the most alike views; its longest link separates the groups.
  std::vector<int> group(n);
  for (std::size_t v = 0; v < n; ++v) group[v] = static_cast<int>(v);
  std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> links;
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      if (count[a * n + b] >= kCommonPoints) {
        links.push_back({sum[a * n + b] / count[a * n + b], {a, b}});
      }
    }
  }
  std::sort(links.begin(), links.end());
  int groups = views;
  double within = 0.0, between = 0.0;
  for (const auto& [distance, pair] : links) {
    const int from = group[pair.second], to = group[pair.first];
    if (from == to) continue;
    if (groups == 2) {
      between = distance;
      break;
    }
    within = distance;
    for (int& g : group) g = g == from ? to : g;
    --groups;
  }
  if (groups != 2 || between < kSpread || between < 2.0 * within) return {};
  std::vector<int> first, second;
  for (int v = 0; v < views; ++v) {
    (group[static_cast<std::size_t>(v)] == group[0] ? first : second).push_back(v);
  }
  return first.size() < second.size() ? first : second;
}

void AddOtherBodies(const Capture& capture, core::Findings* findings) {
  int count = 0;
  const std::vector<int> body = geometry::EdgeComponents(capture.hull, &count);
  std::vector<core::TriangleMesh> bodies(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < body.size(); ++t) {
    bodies[static_cast<std::size_t>(body[t])].triangles.push_back(capture.hull.triangles[t]);
  }
  std::vector<double> volumes;
  for (core::TriangleMesh& one : bodies) {
    one.vertices = capture.hull.vertices;
    volumes.push_back(std::abs(geometry::SignedVolume(one)));
  }
  if (volumes.empty()) return;
  const double largest = *std::max_element(volumes.begin(), volumes.end());
  const auto separate = std::count_if(volumes.begin(), volumes.end(),
                                      [&](double volume) { return volume > kBodyShare * largest; });
  if (separate < 2) return;
  findings->push_back({"other-objects", core::Severity::kWarning, "",
                       std::to_string(separate) +
                           " bodies that do not touch stand beside each other: they become one "
                           "rigid asset",
                       static_cast<double>(separate),
                       "photograph one object at a time, and clear the mat around it"});
}

// Warns of a hull that reaches the mat's edge: a sheet that lies on the mat is a part of it.
void AddCoveredMat(const Capture& capture, double print_scale, core::Findings* findings) {
  if (!capture.paper || capture.hull.empty()) return;
  const CaptureMat& mat = CaptureMatOf(*capture.paper);
  const Eigen::Vector2d half =
      0.5 * kMatEdge * print_scale * mat.square * Eigen::Vector2d(mat.columns, mat.rows);
  const Eigen::AlignedBox3d box = core::Bounds(capture.hull);
  const Eigen::Vector2d reach = box.max().head<2>().cwiseMax(-box.min().head<2>());
  const double share = reach.cwiseQuotient(half).maxCoeff() * kMatEdge;
  if (share < kMatEdge) return;
  findings->push_back({"mat-covered", core::Severity::kWarning, "",
                       "what was taken for the object reaches the edge of the mat: it is too large "
                       "for the mat, or something else covers a part of it, so its size may be "
                       "wrong",
                       share, "clear the mat, lay the object in its middle, or use a larger one"});
}

std::string NamesOf(const std::vector<int>& views, const CaptureSource& source,
                    const Capture& capture) {
  constexpr std::size_t kMostNames = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(views.size(), kMostNames); ++i) {
    const CaptureView& view = capture.views[static_cast<std::size_t>(views[i])];
    names += (i > 0 ? ", " : "") + source.photos[static_cast<std::size_t>(view.index)].name;
  }
  if (views.size() > kMostNames) {
    names += " and " + std::to_string(views.size() - kMostNames) + " more";
  }
  return names;
}

}  // namespace

ColorContradiction MeasureContradiction(const Capture& capture) {
  ColorContradiction result;
  if (capture.hull.empty() || capture.views.empty()) return result;
  core::TexturedMesh object;
  object.mesh = capture.hull;
  render::Scene scene;
  scene.Add(&object);
  scene.Commit();
  const double diagonal = core::Bounds(capture.hull).diagonal().norm();
  const std::vector<SurfacePoint> surface = SurfacePointsOf(capture.hull);
  std::vector<PointColors> points(surface.size());
  for (std::size_t v = 0; v < capture.views.size(); ++v) {
    const ViewColors colors(capture.views[v], scene, diagonal);
    for (std::size_t p = 0; p < surface.size(); ++p) {
      Vector3d color;
      if (colors.See(surface[p], &color)) {
        points[p].seen.emplace_back(static_cast<int>(v), color);
      }
    }
  }
  std::erase_if(points, [](const PointColors& point) {
    return static_cast<int>(point.seen.size()) < kLeastViews;
  });
  result.points = static_cast<int>(points.size());
  if (points.empty()) return result;
  BalanceViews(capture.views.size(), &points);
  std::vector<double> spreads;
  for (const PointColors& point : points) spreads.push_back(SpreadOf(point));
  result.share = static_cast<double>(std::count_if(spreads.begin(), spreads.end(),
                                                   [](double s) { return s > kSpread; })) /
                 static_cast<double>(spreads.size());
  std::nth_element(spreads.begin(), spreads.begin() + std::ssize(spreads) / 2, spreads.end());
  result.median_spread = spreads[spreads.size() / 2];
  result.group = GroupOf(static_cast<int>(capture.views.size()), points);
  return result;
}

core::Findings CaptureDoubts(const CaptureSource& source, const Capture& capture,
                             double print_scale) {
  core::Findings findings;
  AddCoveredMat(capture, print_scale, &findings);
  AddOtherBodies(capture, &findings);
  const ColorContradiction contradiction = MeasureContradiction(capture);
  if (contradiction.points < kLeastPoints || contradiction.share < kDoubtfulShare) return findings;
  const std::string share = std::to_string(std::lround(100.0 * contradiction.share));
  std::string sentence =
      "photos show different colours of the same place on " + share + " % of the surface: ";
  if (contradiction.group.empty()) {
    sentence +=
        "the object reflects its surroundings like a mirror, is transparent, or changed "
        "between the photos, so its shape and texture are not to be trusted";
  } else {
    sentence += NamesOf(contradiction.group, source, capture) +
                " show another object, or another side of it, than the others";
  }
  findings.push_back({"colors-contradict", core::Severity::kWarning, "", sentence,
                      contradiction.share,
                      contradiction.group.empty()
                          ? "dull a glossy or clear object with removable powder or spray, or "
                            "model it by --shape fitted from one photo"
                          : "lift the photos of each object by themselves"});
  return findings;
}

}  // namespace simwright::capture
