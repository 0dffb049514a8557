#include "capture/object_frame.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/Eigenvalues>

#include "core/error.h"
#include "core/random.h"

namespace simwright::capture {
namespace {

// Lengths are relative to the cameras' median distance from the object.
constexpr double kNearTable = 1.2;         // reach of the points that may belong to the table
constexpr double kPlaneTolerance = 0.006;  // of a point of the table
constexpr int kPlaneTries = 600;           // of RANSAC
constexpr double kTiltCosine = 0.42;       // between the plane's normal and the cameras' up: 65 deg
constexpr double kTableShare = 0.06;       // of the points near, from which a plane is the table
constexpr double kLeastHeight = 0.015;     // above the table, of a point of the object
constexpr double kReach = 0.75;            // of the object's points around the focus
constexpr double kLink = 0.07;             // between neighbouring points of an object
constexpr double kUsualSize = 0.3;         // half side of an object without points
constexpr std::size_t kLeastObjectPoints = 12;

struct TablePlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;  // normal . p = offset
  int inliers = 0;
  double Height(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
};

class TableFinder {
 public:
  explicit TableFinder(const Structure& structure) : structure_(structure) {
    for (const Structure::View& view : structure.views) {
      if (view.registered) cameras_.push_back(view.world_from_camera);
    }
    if (cameras_.size() < 3) {
      throw core::Error(
          std::to_string(cameras_.size()) + " photos are placed, but an object needs 3", "cameras");
    }
    FindFocus();
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
    for (const Eigen::Isometry3d& camera : cameras_) up -= camera.linear().col(1);
    up_ = up.norm() > 1e-9 ? up.normalized() : Eigen::Vector3d(-cameras_[0].linear().col(1));
    for (const Structure::Point& point : structure.points) {
      if ((point.position - focus_).norm() < kNearTable * radius_) near_.push_back(point.position);
    }
  }

  const Eigen::Vector3d& focus() const { return focus_; }
  double radius() const { return radius_; }

  std::optional<TablePlane> Table(std::uint64_t seed) const;
  // Returns the plane under the lowest points along the cameras' up direction.
  TablePlane GuessedTable() const;

 private:
  // Finds the point nearest to the optical axes; parallel axes leave it near the points.
  void FindFocus();
  double Score(TablePlane* plane) const;
  TablePlane Refined(TablePlane plane) const;

  const Structure& structure_;
  std::vector<Eigen::Isometry3d> cameras_;
  std::vector<Eigen::Vector3d> near_;
  Eigen::Vector3d focus_, up_;
  double radius_ = 1.0;
};

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void TableFinder::FindFocus() {
  Eigen::Vector3d median;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const Structure::Point& point : structure_.points) values.push_back(point.position[k]);
    median[k] = Quantile(std::move(values), 0.5);
  }
  const double ridge = 0.05 * static_cast<double>(cameras_.size());
  Eigen::Matrix3d sum = ridge * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = ridge * median;
  for (const Eigen::Isometry3d& camera : cameras_) {
    const Eigen::Vector3d axis = camera.linear().col(2);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    sum += across;
    right += across * camera.translation();
  }
  focus_ = sum.ldlt().solve(right);
  std::vector<double> distances;
  for (const Eigen::Isometry3d& camera : cameras_) {
    distances.push_back((camera.translation() - focus_).norm());
  }
  radius_ = Quantile(std::move(distances), 0.5);
  if (!(radius_ > 0.0)) throw core::Error("all photos are from one place", "cameras");
}

// Counts a plane's points; returns the count less the points below it, which a table has not.
double TableFinder::Score(TablePlane* plane) const {
  const double tolerance = kPlaneTolerance * radius_;
  if (plane->normal.dot(up_) < 0.0) {
    plane->normal = -plane->normal;
    plane->offset = -plane->offset;
  }
  if (plane->normal.dot(up_) < kTiltCosine) return -1.0;
  for (const Eigen::Isometry3d& camera : cameras_) {
    if (plane->Height(camera.translation()) < 0.0) return -1.0;
  }
  int inliers = 0, below = 0;
  for (const Eigen::Vector3d& point : near_) {
    const double height = plane->Height(point);
    inliers += std::abs(height) < tolerance;
    below += height < -3.0 * tolerance;
  }
  plane->inliers = inliers;
  return inliers - 2.0 * below;
}

TablePlane TableFinder::Refined(TablePlane plane) const {
  for (int round = 0; round < 3; ++round) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    std::vector<Eigen::Vector3d> on_it;
    for (const Eigen::Vector3d& point : near_) {
      if (std::abs(plane.Height(point)) >= kPlaneTolerance * radius_) continue;
      on_it.push_back(point);
      mean += point;
    }
    if (on_it.size() < 3) break;
    mean /= static_cast<double>(on_it.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& point : on_it) {
      spread += (point - mean) * (point - mean).transpose();
    }
    Eigen::Vector3d normal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
    if (normal.dot(plane.normal) < 0.0) normal = -normal;
    plane = {normal, normal.dot(mean), static_cast<int>(on_it.size())};
  }
  return plane;
}

std::optional<TablePlane> TableFinder::Table(std::uint64_t seed) const {
  if (near_.size() < 20) return std::nullopt;
  core::Rng rng(seed);
  TablePlane best;
  double best_score = 0.0;
  const auto any = [&] {
    return near_[static_cast<std::size_t>(
        core::UniformIndex(rng, static_cast<std::int64_t>(near_.size())))];
  };
  for (int i = 0; i < kPlaneTries; ++i) {
    const Eigen::Vector3d a = any(), b = any(), c = any();
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-6 * radius_ * radius_) continue;
    TablePlane plane{normal.normalized(), normal.normalized().dot(a), 0};
    const double score = Score(&plane);
    if (score <= best_score) continue;
    best = plane;
    best_score = score;
  }
  if (best_score < std::max(20.0, kTableShare * static_cast<double>(near_.size()))) {
    return std::nullopt;
  }
  return Refined(best);
}

TablePlane TableFinder::GuessedTable() const {
  std::vector<double> heights;
  for (const Eigen::Vector3d& point : near_) {
    if ((point - focus_).norm() < kReach * radius_) heights.push_back(up_.dot(point));
  }
  return {up_, heights.empty() ? up_.dot(focus_) - kUsualSize * radius_ : Quantile(heights, 0.01),
          0};
}

void MoveStructure(const Eigen::Isometry3d& turned, double scale, Structure* structure) {
  const auto moved = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return scale * (turned * p);
  };
  for (Structure::Point& point : structure->points) point.position = moved(point.position);
  for (Structure::View& view : structure->views) {
    const Eigen::Vector3d position = moved(view.world_from_camera.translation());
    view.world_from_camera.linear() = turned.linear() * view.world_from_camera.linear();
    view.world_from_camera.translation() = position;
  }
}

// Returns the group of each point: points nearer to each other than the link are in one group.
std::vector<int> LinkedGroups(const std::vector<Eigen::Vector3d>& points, double link) {
  std::vector<int> group(points.size(), -1);
  int groups = 0;
  for (std::size_t start = 0; start < points.size(); ++start) {
    if (group[start] >= 0) continue;
    std::vector<std::size_t> open = {start};
    group[start] = groups;
    while (!open.empty()) {
      const std::size_t from = open.back();
      open.pop_back();
      for (std::size_t to = 0; to < points.size(); ++to) {
        if (group[to] >= 0 || (points[to] - points[from]).squaredNorm() > link * link) continue;
        group[to] = groups;
        open.push_back(to);
      }
    }
    ++groups;
  }
  return group;
}

// Marks the points of the object in a structure that stands on z = 0 with the focus over the
// origin, and counts those of other groups.
void MarkObject(const Structure& structure, ObjectFrame* frame) {
  std::vector<Eigen::Vector3d> above;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < structure.points.size(); ++i) {
    const Structure::Point& point = structure.points[i];
    const Eigen::Vector3d& p = point.position;
    if (std::abs(p.z()) < kPlaneTolerance) frame->is_table[i] = 1;
    if (p.z() < kLeastHeight || p.head<2>().norm() > kReach || p.z() > 1.2) continue;
    if (structure.tracks[static_cast<std::size_t>(point.track)].photos.size() < 3) continue;
    above.push_back(p);
    index.push_back(i);
  }
  const std::vector<int> group = LinkedGroups(above, kLink);
  std::vector<double> weight(above.size() + 1, 0.0);
  for (std::size_t i = 0; i < above.size(); ++i) {
    weight[static_cast<std::size_t>(group[i])] +=
        std::exp(-above[i].head<2>().squaredNorm() / 0.09);
  }
  const auto best =
      static_cast<int>(std::max_element(weight.begin(), weight.end()) - weight.begin());
  for (std::size_t i = 0; i < above.size(); ++i) {
    if (group[i] != best) continue;
    frame->is_object[index[i]] = 1;
    frame->box.extend(above[i]);
  }
  if (frame->box.isEmpty()) return;
  // A few points between groups do not make another thing.
  Eigen::AlignedBox3d around = frame->box;
  around.min().array() -= 2.0 * kLink;
  around.max().array() += 2.0 * kLink;
  for (const Eigen::Vector3d& point : above) frame->others += !around.contains(point);
}

}  // namespace

ObjectFrame PlaceOnTable(std::uint64_t seed, Structure* structure) {
  const TableFinder finder(*structure);
  ObjectFrame frame;
  const std::optional<TablePlane> table = finder.Table(seed);
  frame.table_found = table.has_value();
  const TablePlane plane = table ? *table : finder.GuessedTable();
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.linear() =
      Eigen::Quaterniond::FromTwoVectors(plane.normal, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d foot = finder.focus() - plane.Height(finder.focus()) * plane.normal;
  turned.translation() = -(turned.linear() * foot);
  MoveStructure(turned, 1.0 / finder.radius(), structure);
  frame.is_object.assign(structure->points.size(), 0);
  frame.is_table.assign(structure->points.size(), 0);
  MarkObject(*structure, &frame);
  const auto count =
      static_cast<std::size_t>(std::accumulate(frame.is_object.begin(), frame.is_object.end(), 0));
  if (count < kLeastObjectPoints) {
    frame.box = Eigen::AlignedBox3d(Eigen::Vector3d(-kUsualSize, -kUsualSize, 0.0),
                                    Eigen::Vector3d(kUsualSize, kUsualSize, 2.0 * kUsualSize));
    return frame;
  }
  frame.box.min().z() = 0.0;
  const Eigen::Vector3d base(frame.box.center().x(), frame.box.center().y(), 0.0);
  MoveStructure(Eigen::Isometry3d(Eigen::Translation3d(-base)), 1.0, structure);
  frame.box.translate(-base);
  return frame;
}

}  // namespace simwright::capture
