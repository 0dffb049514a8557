#include "scene/feasibility/kept_relation.h"

#include <algorithm>
#include <cmath>

namespace simwright::scene {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRelationMargin = 1e-3;  // m, kept from the limits of Holds
const double kFacingSlope = std::tan(kFacingAngle);
constexpr int kCorners = 12;  // of the polygon in a round footprint
constexpr double kLeastCavityShare = 0.25;
constexpr double kLeastCorner = 0.35;  // rad, of the direction to a corner of the box of nearness

// Returns the horizontal axis, with its sign, along which an offset is largest.
Vector3d NearestSide(const Vector3d& offset) {
  const int axis = std::abs(offset.y()) >= std::abs(offset.x()) ? 1 : 0;
  return std::copysign(1.0, offset[axis]) * Vector3d::Unit(axis);
}

// Returns the height of b's top or of its rest height, whichever is nearer to the base of a, m.
double SupportNearest(const PlacedBox& a, const PlacedBox& b) {
  const double base = a.Base();
  return std::abs(base - b.Top()) <= std::abs(base - b.rest) ? b.Top() : b.rest;
}

// Returns true if a is over the board of the space b, and under the next one (Shelves::TierOf).
bool IsInSpace(const PlacedBox& a, const PlacedBox& b) {
  const Vector2d offset = (a.center - b.center).head<2>().cwiseAbs() - b.half.head<2>();
  return offset.maxCoeff() <= 0.0 && a.Base() >= b.Base() - kContactHeight &&
         a.Base() < b.Top() - kContactHeight;
}

// The constraints of one relation: half-spaces of d = center of a - center of b.
class RelationPlanes {
 public:
  RelationPlanes(int subject, int object, const PlacedBox& a, const PlacedBox& b)
      : subject_(subject), object_(object), a_(a), b_(b), start_(a.center - b.center) {}

  // Returns the constraints that keep a in the space b over a board, or bring it onto the board.
  std::vector<SeparationConstraint> InSpace() {
    Over(b_);
    const double board = a_.half.z() - b_.half.z();  // d.z where a stands on it
    const double highest =
        IsInSpace(a_, b_) ? a_.half.z() + b_.half.z() - kContactHeight : board + kContactHeight;
    Require(Vector3d::UnitZ(), board + kRelationMargin);
    Require(-Vector3d::UnitZ(), kRelationMargin - highest);
    return std::move(rows_);
  }

  std::vector<SeparationConstraint> Of(Relation relation) {
    switch (relation) {
      case Relation::kOn:
        On();
        break;
      case Relation::kInside:
        Over(b_, CavityShare(Relation::kInside));
        Require(-Vector3d::UnitZ(), kSunkDepth + kRelationMargin - a_.half.z() - b_.half.z());
        AboveBase();
        break;
      case Relation::kAbove:
        Over(a_.half.head<2>().prod() > b_.half.head<2>().prod() ? a_ : b_);
        Require(Vector3d::UnitZ(), a_.half.z() + b_.half.z() + kContactHeight + kRelationMargin);
        Require(-Vector3d::UnitZ(), kRelationMargin - kNearDistance - a_.half.z() - b_.half.z());
        break;
      case Relation::kLeftOf:
        Beside(Vector3d::UnitY());
        break;
      case Relation::kRightOf:
        Beside(-Vector3d::UnitY());
        break;
      case Relation::kInFrontOf:
        Beside(-Vector3d::UnitX());
        break;
      case Relation::kBehind:
        Beside(Vector3d::UnitX());
        break;
      case Relation::kNextTo:
        Beside(NearestSide(start_));
        break;
      case Relation::kFacing:
        Facing();
        break;
      case Relation::kBelow:  // the caller exchanges the bodies
        break;
    }
    return std::move(rows_);
  }

 private:
  // Adds the constraint direction . d >= least.
  void Require(const Vector3d& direction, double least) {
    const double length = direction.norm();
    rows_.push_back(
        {subject_, object_, -direction / length, (least - direction.dot(start_)) / length, 0.0});
  }

  // Returns the share of b's footprint in which the centre of a has to be if a is in the cavity of
  // b: there a fits without touching the rim; or as far out as it is already.
  double CavityShare(Relation relation) const {
    const Eigen::Array2d inner = b_.half.head<2>().array() - a_.half.head<2>().array();
    const double fits =
        std::clamp((inner / b_.half.head<2>().array()).minCoeff(), kLeastCavityShare, 1.0);
    if (!Holds(relation, a_, b_)) return fits;
    const Eigen::Array2d offset = start_.head<2>().array() / b_.half.head<2>().array();
    return std::clamp(b_.round ? offset.matrix().norm() : offset.abs().maxCoeff(), fits, 1.0);
  }

  // Keeps the base of a above the base of b.
  void AboveBase() { Require(Vector3d::UnitZ(), a_.half.z() - b_.half.z() + kRelationMargin); }

  // Keeps the centre of the other box over that share of the footprint of `box`.
  void Over(const PlacedBox& box, double share = 1.0) {
    const Vector2d half =
        (share * box.half.head<2>().array() - kRelationMargin).max(kRelationMargin);
    for (int i = 0; box.round && i < kCorners; ++i) {
      const double angle = 2.0 * M_PI * i / kCorners;
      Require({-std::cos(angle) / half.x(), -std::sin(angle) / half.y(), 0.0},
              -std::cos(M_PI / kCorners));
    }
    if (box.round) return;
    for (int axis = 0; axis < 2; ++axis) {
      Require(Vector3d::Unit(axis), -half[axis]);
      Require(-Vector3d::Unit(axis), -half[axis]);
    }
  }

  void On() {
    const bool in_cavity = SupportNearest(a_, b_) < b_.Top();
    Over(b_, in_cavity ? CavityShare(Relation::kOn) : 1.0);
    AboveBase();
    const double support = SupportNearest(a_, b_) - b_.center.z();
    Require(Vector3d::UnitZ(), a_.half.z() + support - kContactHeight + kRelationMargin);
    Require(-Vector3d::UnitZ(), kRelationMargin - kContactHeight - a_.half.z() - support);
  }

  void Beside(const Vector3d& along) {
    const Vector3d across(along.y(), along.x(), 0.0);
    // Neither centre may be over the footprint of the other: that would be on or inside.
    const double half = along.cwiseAbs().dot(a_.half.cwiseMax(b_.half));
    Require(along, std::max(kLeastOffset, half) + kRelationMargin);
    Require(along + across, kRelationMargin);
    Require(along - across, kRelationMargin);
    Level();
    Near();
  }

  // Keeps the boxes overlapping in height or, for thin ones, their bases together.
  void Level() {
    const double room = a_.half.z() + b_.half.z() - 2.0 * kRelationMargin;
    const double bases = a_.half.z() - b_.half.z();  // d.z where the bases are level
    const double low = room > kContactHeight ? -room : bases - kContactHeight + kRelationMargin;
    const double high = room > kContactHeight ? room : bases + kContactHeight - kRelationMargin;
    Require(Vector3d::UnitZ(), low);
    Require(-Vector3d::UnitZ(), -high);
  }

  // Keeps the gaps between the boxes in a rectangle whose corner is at the limit, in the direction
  // of the initial gaps. Level boxes have a gap in height of at most kContactHeight.
  void Near() {
    const Vector2d gap = (start_.cwiseAbs() - a_.half - b_.half).cwiseMax(0.0).head<2>();
    const double angle =
        std::clamp(std::atan2(gap.y(), gap.x()), kLeastCorner, 0.5 * M_PI - kLeastCorner);
    const double limit = kNearDistance - kContactHeight - kRelationMargin;
    const Vector2d most = limit * Vector2d(std::cos(angle), std::sin(angle));
    for (int axis = 0; axis < 2; ++axis) {
      const double reach = most[axis] + a_.half[axis] + b_.half[axis];
      Require(Vector3d::Unit(axis), -reach);
      Require(-Vector3d::Unit(axis), -reach);
    }
  }

  void Facing() {
    const double length = a_.forward.norm();
    if (length == 0.0) return;
    const Vector3d forward(a_.forward.x() / length, a_.forward.y() / length, 0.0);
    const Vector3d side(-forward.y(), forward.x(), 0.0);
    Require(-kFacingSlope * forward + side, kRelationMargin);
    Require(-kFacingSlope * forward - side, kRelationMargin);
  }

  int subject_, object_;
  const PlacedBox &a_, &b_;
  Vector3d start_;  // m, the initial offset
  std::vector<SeparationConstraint> rows_;
};

PlacedBox Displaced(PlacedBox box, const Vector3d& shift) {
  box.center += shift;
  box.rest += shift.z();
  return box;
}

}  // namespace

std::optional<Vector3d> SeparatingDirection(const KeptRelation& kept) {
  if (kept.tier) return std::nullopt;
  switch (kept.relation) {
    case Relation::kOn:
    case Relation::kAbove:
      return Vector3d::UnitZ();
    case Relation::kBelow:
      return -Vector3d::UnitZ();
    case Relation::kLeftOf:
      return Vector3d::UnitY();
    case Relation::kRightOf:
      return -Vector3d::UnitY();
    case Relation::kInFrontOf:
      return -Vector3d::UnitX();
    case Relation::kBehind:
      return Vector3d::UnitX();
    case Relation::kNextTo:
      return NearestSide(kept.subject_box.center - kept.object_box.center);
    case Relation::kInside:
    case Relation::kFacing:
      break;
  }
  return std::nullopt;
}

bool IsInCavity(const KeptRelation& kept) {
  if (kept.tier || kept.relation == Relation::kInside) return true;
  return kept.relation == Relation::kOn &&
         SupportNearest(kept.subject_box, kept.object_box) < kept.object_box.Top();
}

bool HoldsAfter(const KeptRelation& kept, const std::vector<Vector3d>& shifts) {
  const PlacedBox subject = Displaced(kept.subject_box, shifts[static_cast<size_t>(kept.subject)]);
  const PlacedBox object = Displaced(kept.object_box, shifts[static_cast<size_t>(kept.object)]);
  return kept.tier ? IsInSpace(subject, object) : Holds(kept.relation, subject, object);
}

std::vector<SeparationConstraint> LinearizeRelation(const KeptRelation& kept) {
  KeptRelation one = kept;
  if (one.tier) {
    return RelationPlanes(one.subject, one.object, one.subject_box, one.object_box).InSpace();
  }
  if (one.relation == Relation::kBelow) {
    std::swap(one.subject, one.object);
    std::swap(one.subject_box, one.object_box);
    one.relation = Relation::kAbove;
  }
  return RelationPlanes(one.subject, one.object, one.subject_box, one.object_box).Of(one.relation);
}

}  // namespace simwright::scene
