#include "capture/turned_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "capture/object_masks.h"
#include "capture/outline_alignment.h"
#include "capture/view_agreement.h"
#include "core/error.h"
#include "core/parallel.h"
#include "geometry/surface_distance.h"
#include "geometry/triangle_tree.h"

namespace simwright::capture {
namespace {

constexpr int kPoses = 24;                 // whose outlines are refined
constexpr std::size_t kColorPoses = 12;    // whose colours are compared
constexpr double kEqualMismatch = 0.0025;  // diagonals: outlines do not distinguish these poses
constexpr int kPoseCells = 56;             // of the common hull of a pose
constexpr int kColorRays = 700;            // chords that sample its surface
constexpr double kFacing = 0.4;            // cosine, of a view that shows a point's colour
constexpr std::size_t kLeastPoints = 40;   // that both sets show
constexpr double kLeastOutlines = 0.88;    // agreement from which a pose is trusted
constexpr double kSameColors = 0.08;       // difference under which colours are equal
constexpr double kClearlyBetter = 1.25;    // factor between the differences of two poses
constexpr double kColorReach = 0.03;       // hull diagonals, of the surroundings of a point whose
                                           // mean colour is compared: poses are not that exact
constexpr double kColorFloor = 12.0;       // of 255, added before the logarithm

Eigen::Hyperplane<double, 3> TableOf(const Eigen::Isometry3d& first_from_second) {
  return {first_from_second.linear().col(2), first_from_second.translation()};
}

std::vector<CaptureView> Moved(std::vector<CaptureView> views, const Eigen::Isometry3d& pose) {
  for (CaptureView& view : views) {
    view.camera.world_from_camera = pose * view.camera.world_from_camera;
  }
  return views;
}

core::TriangleMesh CommonHull(const std::vector<CaptureView>& first,
                              const std::vector<CaptureView>& second, const Capture& of,
                              const Eigen::Isometry3d& pose, double tolerated, int cells) {
  VotingHullOptions options;
  options.cells = cells;
  options.planes = {TableOf(pose)};
  const std::vector<HullVote> votes = {VoteOf(first, tolerated, {}), VoteOf(second, tolerated, {})};
  return VotingHull(votes, Grown(core::Bounds(of.hull)), options);
}

// Returns the mean colour around a pixel where the mask is full; negative where it is not.
Eigen::Vector3d MeanColor(const CaptureView& view, const Eigen::Vector2d& at, double reach) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (double dy = -reach; dy <= reach; dy += 0.5 * reach) {
    for (double dx = -reach; dx <= reach; dx += 0.5 * reach) {
      const int x = static_cast<int>(std::floor(at.x() + dx));
      const int y = static_cast<int>(std::floor(at.y() + dy));
      if (x < 0 || y < 0 || x >= view.photo.width || y >= view.photo.height) continue;
      if (*view.opacity.At(x, y) < 0.98f) continue;
      const std::uint8_t* pixel = view.photo.At(x, y);
      sum += Eigen::Vector3d(pixel[0], pixel[1], pixel[2]);
      ++count;
    }
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : Eigen::Vector3d::Constant(-1.0);
}

// Returns the logarithm of the colour that the views show at a point, by their median.
std::optional<Eigen::Vector3d> ColorAt(const std::vector<CaptureView>& views,
                                       const geometry::TriangleTree& tree,
                                       const geometry::OuterHit& hit, double diagonal) {
  std::array<std::vector<double>, 3> seen;
  for (const CaptureView& view : views) {
    const Eigen::Vector3d to_eye = view.camera.position() - hit.point;
    if (to_eye.normalized().dot(hit.normal) < kFacing) continue;
    const Eigen::Vector3d at = view.camera.Project(hit.point);
    if (at.z() <= 0.0) continue;
    const double reach = std::max(1.0, kColorReach * diagonal * view.camera.fx / at.z());
    const Eigen::Vector3d color = MeanColor(view, at.head<2>(), reach);
    if (color.x() < 0.0) continue;
    const Eigen::Vector3d start = hit.point + 2e-3 * diagonal * hit.normal;
    if (tree.SegmentMeets(start, view.camera.position())) continue;
    for (int c = 0; c < 3; ++c) {
      seen[static_cast<std::size_t>(c)].push_back(std::log(color[c] + kColorFloor));
    }
  }
  if (seen[0].empty()) return std::nullopt;
  Eigen::Vector3d color;
  for (int c = 0; c < 3; ++c) {
    std::vector<double>& values = seen[static_cast<std::size_t>(c)];
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    color[c] = *middle;
  }
  return color;
}

// Returns the root mean square difference of both sets' colours on the surface, but for white
// balance, and for light whose brightness is linear in the normal: turned in the same light, a side
// is lit differently. Nothing if hardly any point is seen by both.
std::optional<double> ColorDifference(const core::TriangleMesh& hull,
                                      const std::vector<CaptureView>& first,
                                      const std::vector<CaptureView>& second) {
  const std::vector<geometry::OuterHit> hits = geometry::SampleOuterHits(hull, kColorRays, 1);
  const geometry::TriangleTree tree(hull);
  const double diagonal = core::Bounds(hull).diagonal().norm();
  std::vector<std::optional<Eigen::Vector3d>> differences(hits.size());
  core::ParallelFor(static_cast<int>(hits.size()), [&](int i) {
    const geometry::OuterHit& hit = hits[static_cast<std::size_t>(i)];
    const auto a = ColorAt(first, tree, hit, diagonal);
    if (!a) return;
    const auto b = ColorAt(second, tree, hit, diagonal);
    if (b) differences[static_cast<std::size_t>(i)] = *b - *a;
  });
  std::vector<Eigen::Vector3d> known, normals;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!differences[i]) continue;
    known.push_back(*differences[i]);
    normals.push_back(hits[i].normal);
  }
  if (known.size() < kLeastPoints) return std::nullopt;
  const auto rows = static_cast<Eigen::Index>(known.size());
  Eigen::MatrixXd light(rows, 4), chroma(rows, 2);
  Eigen::VectorXd brightness(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::Vector3d& color = known[static_cast<std::size_t>(i)];
    light.row(i) << 1.0, normals[static_cast<std::size_t>(i)].transpose();
    chroma.row(i) << color[0] - color[1], color[2] - color[1];
    brightness[i] = color.mean();
  }
  chroma.rowwise() -= chroma.colwise().mean().eval();
  brightness -= light * light.colPivHouseholderQr().solve(brightness);
  return std::sqrt((chroma.squaredNorm() + brightness.squaredNorm()) /
                   static_cast<double>(3 * rows));
}

double MeanIou(const core::TriangleMesh& hull, const std::vector<CaptureView>& first,
               const std::vector<CaptureView>& second) {
  const std::size_t count = first.size() + second.size();
  std::vector<double> iou(count);
  core::ParallelFor(static_cast<int>(count), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const CaptureView& view = at < first.size() ? first[at] : second[at - first.size()];
    iou[at] = MaskIou(view.opacity, SilhouetteOf(hull, view.camera));
  });
  double sum = 0.0;
  for (const double v : iou) sum += v;
  return sum / static_cast<double>(count);
}

std::string TwoDigits(double value) {
  return std::to_string(std::lround(100.0 * value)) + " %";
}

}  // namespace

TurnedPose FindTurnedPose(const Capture& first, const Capture& second, std::uint64_t seed,
                          core::Progress* progress) {
  if (first.hull.empty() || second.hull.empty()) {
    throw core::Error("a set of photos has no hull", "turned object");
  }
  progress->Stage("pose of the turned object");
  const OutlineSet a = OutlinesOf(first), b = OutlinesOf(second);
  const std::vector<OutlinePose> poses = AlignOutlines(a, b, kPoses, seed);
  TurnedPose best;
  double best_color = 1e9;
  std::optional<double> rival;
  core::TriangleMesh best_hull;
  std::size_t compared = 0;
  for (const OutlinePose& pose : poses) {
    if (pose.mismatch > poses[0].mismatch + kEqualMismatch || compared++ >= kColorPoses) break;
    core::CheckCancelled();
    const std::vector<CaptureView> views = Moved(second.views, pose.first_from_second);
    core::TriangleMesh hull =
        CommonHull(first.views, views, first, pose.first_from_second, 0.05, kPoseCells);
    if (hull.empty()) continue;
    const double color = ColorDifference(hull, first.views, views).value_or(1.0);
    if (color < best_color) {
      if (best_color < 1e9) rival = best_color;
      best_color = color;
      best.first_from_second = pose.first_from_second;
      best_hull = std::move(hull);
    } else {
      rival = std::min(rival.value_or(color), color);
    }
  }
  if (best_hull.empty()) {
    best.doubt = "no pose makes the two sets one object";
    return best;
  }
  best.color_difference = best_color;
  best.rival_difference = rival;
  best.agreement = MeanIou(best_hull, first.views, Moved(second.views, best.first_from_second));
  if (best.agreement < kLeastOutlines) {
    best.doubt = "the outlines of both sets agree to " + TwoDigits(best.agreement) + " only, not " +
                 TwoDigits(kLeastOutlines);
  } else if (rival && best_color > kSameColors && *rival < kClearlyBetter * best_color) {
    best.doubt =
        "several poses agree equally well, and the colours do not decide (differences of " +
        TwoDigits(best_color) + " and " + TwoDigits(*rival) + ")";
  }
  return best;
}

void MergeTurned(const Capture& second, const Eigen::Isometry3d& first_from_second, int first_photo,
                 const CaptureOptions& options, Capture* first) {
  std::vector<CaptureView> views = Moved(second.views, first_from_second);
  first->hull = CommonHull(first->views, views, *first, first_from_second, options.tolerated_views,
                           options.hull_cells);
  const int lenses = static_cast<int>(first->calibration.lenses.size());
  for (CaptureView& view : views) {
    view.index += first_photo;
    first->views.push_back(std::move(view));
  }
  first->calibration.lenses.insert(first->calibration.lenses.end(),
                                   second.calibration.lenses.begin(),
                                   second.calibration.lenses.end());
  double squares = 0.0;
  for (MatCalibration::View view : second.calibration.views) {
    view.lens += lenses;
    view.world_from_camera = first_from_second * view.world_from_camera;
    first->calibration.views.push_back(view);
  }
  for (const MatCalibration::View& view : first->calibration.views) {
    squares += view.error * view.error;
  }
  first->calibration.error =
      std::sqrt(squares / static_cast<double>(first->calibration.views.size()));
}

}  // namespace simwright::capture
