#include "certificate/goal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "certificate/obstacles.h"

namespace simwright::certificate {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kBoardGap = 0.1;         // m between two boards of a shelf
constexpr double kBoardShare = 0.5;       // of the footprint that a board covers
constexpr double kFrontShare = 0.25;      // of the depth of a table
constexpr double kPlaceStep = 0.04;       // m between places
constexpr double kPlaceClearance = 0.02;  // m between a place and other objects
constexpr double kReleaseHeight = 0.002;  // m above the surface
constexpr double kRim = 0.01;             // m that a place keeps from the edge of its surface
constexpr int kDirections = 16;           // of places beside an object
constexpr size_t kMostPlaces = 12;

std::vector<Eigen::AlignedBox3d> PartBoxes(const PlacedBody& body) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const geometry::ConvexShape& part : body.model->parts) {
    Eigen::AlignedBox3d& box = boxes.emplace_back();
    for (const Vector3d& vertex : part.vertices) box.extend(body.world_from_body * vertex);
  }
  return boxes;
}

double Footprint(const Eigen::AlignedBox3d& box) {
  return box.sizes().x() * box.sizes().y();
}

// Finds places where the target can stand.
class Places {
 public:
  Places(const PlacedScene& scene, int target, int support)
      : scene_(scene),
        target_(scene.bodies[static_cast<size_t>(target)]),
        support_(scene.bodies[static_cast<size_t>(support)]),
        box_(BoundsOf(target_)),
        obstacles_(scene) {
    obstacles_.Ignore(target, true);
  }

  // Adds the place with the middle of the target's box at (x, y), on the support's surface below
  // the height `below`, if it is free.
  void Try(double x, double y, double below, Goal* goal) const {
    if (goal->places.size() >= kMostPlaces) return;
    const Vector3d half = 0.5 * box_.sizes();
    double top = 0.0;
    for (const auto& [dx, dy] :
         {std::pair{0.0, 0.0}, {1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) {
      const double height =
          SurfaceAt(x + dx * (half.x() + kRim), y + dy * (half.y() + kRim), below);
      if (dx == 0.0 && dy == 0.0) top = height;
      if (!(std::abs(height - top) < 1e-3)) return;  // beyond the edge
    }
    Isometry3d place = target_.world_from_body;
    place.translation() += Vector3d(x, y, top + kReleaseHeight) -
                           Vector3d(box_.center().x(), box_.center().y(), box_.min().z());
    PlacedShape shape;
    Isometry3d raised = place;
    raised.translation().z() += kPlaceClearance;  // free of its support
    for (const geometry::ConvexShape& part : target_.model->parts) {
      shape.Place(part, raised);
      if (obstacles_.Hit(shape, kPlaceClearance - kReleaseHeight) >= 0) return;
    }
    goal->places.push_back(place);
  }

  const Eigen::AlignedBox3d& box() const { return box_; }

 private:
  // Returns the height of the support's surface at (x, y) below `below`; NaN beyond its edge.
  double SurfaceAt(double x, double y, double below) const {
    double top = std::numeric_limits<double>::quiet_NaN();
    for (const geometry::ConvexShape& part : support_.model->parts) {
      Eigen::AlignedBox3d part_box;
      for (const Vector3d& v : part.vertices) part_box.extend(support_.world_from_body * v);
      const double height = part_box.max().z();
      if (height > below || (top > height)) continue;
      PlacedShape probe;  // a vertical needle through the upper side
      probe.Place({{{x, y, height - 2e-4}, {x, y, height + 2e-4}}, 0.0}, Isometry3d::Identity());
      PlacedShape solid;
      solid.Place(part, support_.world_from_body);
      if (!geometry::AreApart(probe.shape, solid.shape, 1e-9)) top = height;
    }
    return top;
  }

  const PlacedScene& scene_;
  const PlacedBody& target_;
  const PlacedBody& support_;
  Eigen::AlignedBox3d box_;
  Obstacles obstacles_;
};

}  // namespace

bool Goal::IsReached(const BodyModel& target, const Isometry3d& start,
                     const Isometry3d& now) const {
  if (!now.matrix().allFinite()) return false;
  const Eigen::AlignedBox3d box = BoundsOf(target, now);
  switch (kind) {
    case GoalKind::kLift:
      return box.min().z() >= BoundsOf(target, start).min().z() + lift;
    case GoalKind::kInFront:
      return box.max().x() <= front;
    case GoalKind::kPlace:
      break;
  }
  const Vector3d middle = now * target.box.center();
  return std::any_of(places.begin(), places.end(), [&](const Isometry3d& place) {
    const double cosine = now.linear().col(2).dot(place.linear().col(2));
    return (middle - place * target.box.center()).norm() <= place_tolerance &&
           cosine >= std::cos(place_tilt);
  });
}

bool IsShelf(const PlacedBody& furniture) {
  const std::vector<Eigen::AlignedBox3d> boxes = PartBoxes(furniture);
  const double least = kBoardShare * Footprint(BoundsOf(furniture));
  for (const Eigen::AlignedBox3d& low : boxes) {
    for (const Eigen::AlignedBox3d& high : boxes) {
      if (Footprint(low) < least || Footprint(high) < least) continue;
      if (high.min().z() - low.max().z() >= kBoardGap) return true;
    }
  }
  return false;
}

std::optional<Goal> FrontGoal(const PlacedScene& scene, int target) {
  const int support = SupportOf(scene, target);
  if (support < 0) return std::nullopt;
  const PlacedBody& furniture = scene.bodies[static_cast<size_t>(support)];
  const Eigen::AlignedBox3d box = BoundsOf(furniture);
  Goal goal;
  if (IsShelf(furniture)) {
    goal.kind = GoalKind::kInFront;
    goal.front = box.min().x();
    return goal;
  }
  goal.kind = GoalKind::kPlace;
  const Places places(scene, target, support);
  const double last = box.min().x() + kFrontShare * box.sizes().x();
  const double below = places.box().center().z();
  for (double x = box.min().x() + kRim; x <= last; x += kPlaceStep) {
    std::vector<double> across;
    for (double y = box.min().y(); y <= box.max().y(); y += kPlaceStep) across.push_back(y);
    const double own = places.box().center().y();
    std::sort(across.begin(), across.end(),
              [&](double a, double b) { return std::abs(a - own) < std::abs(b - own); });
    for (const double y : across) places.Try(x, y, below, &goal);
  }
  if (goal.places.empty()) return std::nullopt;
  return goal;
}

std::optional<Goal> BesideGoal(const PlacedScene& scene, int target, int other) {
  const int support = SupportOf(scene, other);
  if (support < 0 || target == other) return std::nullopt;
  Goal goal;
  goal.kind = GoalKind::kPlace;
  const Places places(scene, target, support);
  const Eigen::AlignedBox3d box = BoundsOf(scene.bodies[static_cast<size_t>(other)]);
  const double reach =
      0.5 * (box.sizes().head<2>().maxCoeff() + places.box().sizes().head<2>().maxCoeff());
  for (const double gap : {kPlaceClearance, 2.0 * kPlaceClearance}) {
    std::vector<Vector3d> directions;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kDirections;
      directions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    }
    std::stable_sort(directions.begin(), directions.end(),
                     [](const Vector3d& a, const Vector3d& b) { return a.x() < b.x(); });
    for (const Vector3d& direction : directions) {
      const Vector3d at = box.center() + (reach + gap) * direction;
      places.Try(at.x(), at.y(), box.center().z(), &goal);
    }
  }
  if (goal.places.empty()) return std::nullopt;
  return goal;
}

Goal LiftGoal() {
  return {};
}

}  // namespace simwright::certificate
