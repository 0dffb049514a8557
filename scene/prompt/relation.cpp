#include "scene/prompt/relation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "scene/scene_types/shelf_boards.h"

namespace simwright::scene {
namespace {

constexpr double kOrdinalStep = 0.01;  // m
constexpr double kTopSpace = 1.0;      // m, over the uppermost board of a shelf
constexpr double kAligned = 0.9999;    // least cosine between an axis of a shelf and of the world
const double kCosFacing = std::cos(kFacingAngle);

constexpr std::array<const char*, kRelationCount> kRelationTexts = {
    "on",          "above",  "below",   "inside", "to the left of", "to the right of",
    "in front of", "behind", "next to", "facing"};
constexpr std::array<const char*, kShelfTierCount> kShelfTierTexts = {
    "on the top shelf", "on the second shelf", "on the third shelf", "on the bottom shelf"};

// Returns true if the centre of a is over the footprint of b.
bool IsOver(const PlacedBox& a, const PlacedBox& b) {
  const Eigen::Array2d offset =
      (a.center - b.center).head<2>().array().abs() / b.half.head<2>().array();
  return b.round ? offset.square().sum() <= 1.0 : offset.maxCoeff() <= 1.0;
}

bool IsOn(const PlacedBox& a, const PlacedBox& b) {
  const double base = a.Base();
  return (std::abs(base - b.Top()) <= kContactHeight ||
          std::abs(base - b.rest) <= kContactHeight) &&
         base >= b.Base() && IsOver(a, b);
}

bool IsInside(const PlacedBox& a, const PlacedBox& b) {
  const double base = a.Base();
  return base < b.Top() - kSunkDepth && base >= b.Base() && IsOver(a, b);
}

bool IsAbove(const PlacedBox& a, const PlacedBox& b) {
  const double gap = a.Base() - b.Top();
  return gap > kContactHeight && gap < kNearDistance && (IsOver(a, b) || IsOver(b, a));
}

bool IsLevel(const PlacedBox& a, const PlacedBox& b) {
  const double overlap = std::min(a.Top(), b.Top()) - std::max(a.Base(), b.Base());
  return overlap > kLevelOverlap || std::abs(a.Base() - b.Base()) < kContactHeight;
}

bool IsStacked(const PlacedBox& a, const PlacedBox& b) {
  return IsOn(a, b) || IsOn(b, a) || IsInside(a, b) || IsInside(b, a);
}

// Returns the direction from b to a if they are near, level and not stacked.
std::optional<Relation> DirectionOf(const PlacedBox& a, const PlacedBox& b) {
  const double x = a.center.x() - b.center.x(), y = a.center.y() - b.center.y();
  if (std::max(std::abs(x), std::abs(y)) < kLeastOffset || !IsLevel(a, b) ||
      BoxDistance(a, b) >= kNearDistance || IsStacked(a, b)) {
    return std::nullopt;
  }
  if (std::abs(y) >= std::abs(x)) return y > 0.0 ? Relation::kLeftOf : Relation::kRightOf;
  return x < 0.0 ? Relation::kInFrontOf : Relation::kBehind;
}

bool IsFacing(const PlacedBox& a, const PlacedBox& b) {
  const Eigen::Vector2d to_b = (b.center - a.center).head<2>();
  const double length = to_b.norm(), forward = a.forward.norm();
  if (length < kLevelOverlap || forward < 0.5) return false;
  return a.forward.dot(to_b) >= kCosFacing * length * forward;
}

}  // namespace

const char* RelationText(Relation relation) {
  return kRelationTexts[static_cast<size_t>(relation)];
}

std::optional<Relation> RelationNamed(std::string_view text) {
  for (int i = 0; i < kRelationCount; ++i) {
    const auto relation = static_cast<Relation>(i);
    if (text == RelationText(relation)) return relation;
  }
  return std::nullopt;
}

PlacedBox BoxOf(const CategorySize& size, const Eigen::Isometry3d& world_from_object) {
  const Eigen::Matrix3d rotation = world_from_object.linear();
  PlacedBox box;
  box.center = world_from_object.translation() + 0.5 * size.height * rotation.col(2);
  box.round = size.half_size.x() == size.half_size.y();
  if (box.round) {
    // A disc of radius r with normal n reaches r sqrt(1 - n_i^2) along axis i.
    const Eigen::Array3d normal = rotation.col(2).array();
    box.half = 0.5 * size.height * normal.abs() +
               size.half_size.x() * (1.0 - normal.square()).max(0.0).sqrt();
  } else {
    box.half = rotation.cwiseAbs() *
               Eigen::Vector3d(size.half_size.x(), size.half_size.y(), 0.5 * size.height);
  }
  box.rest = world_from_object.translation().z() + size.rest_height * rotation(2, 2);
  if (size.rest_height == 0.0) box.rest = box.Top();
  box.forward = rotation.col(0).head<2>();
  return box;
}

double BoxDistance(const PlacedBox& a, const PlacedBox& b) {
  return ((a.center - b.center).cwiseAbs() - a.half - b.half).cwiseMax(0.0).norm();
}

bool Holds(Relation relation, const PlacedBox& a, const PlacedBox& b) {
  switch (relation) {
    case Relation::kOn:
      return IsOn(a, b);
    case Relation::kAbove:
      return IsAbove(a, b);
    case Relation::kBelow:
      return IsAbove(b, a);
    case Relation::kInside:
      return IsInside(a, b);
    case Relation::kNextTo:
      return DirectionOf(a, b).has_value();
    case Relation::kFacing:
      return IsFacing(a, b);
    default:
      return DirectionOf(a, b) == relation;
  }
}

std::vector<Relation> RelationsBetween(const PlacedBox& a, const PlacedBox& b) {
  std::vector<Relation> relations;
  for (int i = 0; i < kRelationCount; ++i) {
    const auto relation = static_cast<Relation>(i);
    if (relation != Relation::kFacing && Holds(relation, a, b)) relations.push_back(relation);
  }
  return relations;
}

const char* ShelfTierText(ShelfTier tier) {
  return kShelfTierTexts[static_cast<size_t>(tier)];
}

Shelves::Shelves(const std::vector<SceneObject>& objects, const CategorySizes& sizes) {
  for (size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].welded || !objects[i].category.starts_with("shelf")) continue;
    Add(SizeOf(sizes, objects[i].category), objects[i].world_from_object, static_cast<int>(i));
  }
}

void Shelves::Add(const CategorySize& size, const Eigen::Isometry3d& world_from_shelf, int object) {
  const double scale = size.height / ShelfBoardHeights().back();
  shelves_.push_back({world_from_shelf.inverse(), size.half_size, scale, object});
}

std::optional<ShelfTier> Shelves::TierOf(const PlacedBox& box) const {
  for (const Shelf& shelf : shelves_) {
    const Eigen::Vector3d center = shelf.shelf_from_world * box.center;
    if (std::abs(center.x()) > shelf.half_size.x() || std::abs(center.y()) > shelf.half_size.y()) {
      continue;
    }
    const double base = center.z() - box.half.z();
    const auto& heights = ShelfBoardHeights();
    for (size_t i = heights.size(); i-- > 0;) {
      if (base < heights[i] * shelf.scale - kContactHeight) continue;
      return static_cast<ShelfTier>(heights.size() - 1 - i);
    }
  }
  return std::nullopt;
}

std::vector<Shelves::TierSpace> Shelves::SpacesOf(ShelfTier tier) const {
  const auto& heights = ShelfBoardHeights();
  const size_t board = heights.size() - 1 - static_cast<size_t>(tier);
  std::vector<TierSpace> spaces;
  for (const Shelf& shelf : shelves_) {
    const Eigen::Isometry3d world_from_shelf = shelf.shelf_from_world.inverse();
    const Eigen::Matrix3d turned = world_from_shelf.linear().cwiseAbs();
    if (turned.col(0).maxCoeff() < kAligned || turned(2, 2) < kAligned) continue;
    const double low = heights[board] * shelf.scale;
    const double high =
        board + 1 < heights.size() ? heights[board + 1] * shelf.scale : low + kTopSpace;
    TierSpace one;
    one.object = shelf.object;
    one.space.center = world_from_shelf * Eigen::Vector3d(0.0, 0.0, 0.5 * (low + high));
    one.space.half =
        turned * Eigen::Vector3d(shelf.half_size.x(), shelf.half_size.y(), 0.5 * (high - low));
    one.space.rest = one.space.Base();
    spaces.push_back(one);
  }
  return spaces;
}

std::vector<int> OrdinalOrder(const std::vector<const PlacedBox*>& boxes) {
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int index) {
    const PlacedBox& box = *boxes[static_cast<size_t>(index)];
    const double base = box.Base();
    return std::tuple(-std::floor(box.center.y() / kOrdinalStep + 0.5),
                      std::floor(box.center.x() / kOrdinalStep + 0.5), base, index);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  return order;
}

}  // namespace simwright::scene
