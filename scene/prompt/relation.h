#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "scene/grammar/category_size.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

// The spatial relations of prompts (Pfaff et al., Steerable Scene Generation, appendix), and
// facing, which is ours. Frame: the world, seen by a viewer at -x who looks along +x, z up. Left is
// +y, right is -y, in front is smaller x, behind is larger x.
enum class Relation {
  kOn,
  kAbove,
  kBelow,
  kInside,
  kLeftOf,
  kRightOf,
  kInFrontOf,
  kBehind,
  kNextTo,
  kFacing
};
inline constexpr int kRelationCount = 10;

// Returns the words of a relation in a prompt, between "is" and its object: "on", "above", "below",
// "inside", "to the left of", "to the right of", "in front of", "behind", "next to", "facing".
const char* RelationText(Relation relation);

// Returns the relation of such words, unset for others.
std::optional<Relation> RelationNamed(std::string_view text);

// Two objects are near if their boxes are closer than this, m: the published limit, which does not
// say between which points.
inline constexpr double kNearDistance = 0.2;

// Further limits of relations, m (Holds).
inline constexpr double kContactHeight = 0.02;  // of a base to what it rests on
inline constexpr double kSunkDepth = 0.01;      // of an inner object's base below the rim
inline constexpr double kLevelOverlap = 0.001;  // of two level boxes in height
inline constexpr double kLeastOffset = 0.01;    // horizontal, with a direction
inline constexpr double kFacingAngle = 0.5235987755982988;  // rad, 30 degrees

// The axis-aligned bounding box of an object in the world frame, m.
struct PlacedBox {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  // half of its extents
  double rest = 0.0;   // height of an object that lies in it or on it: of a plate's floor
  bool round = false;  // its footprint is the ellipse in the box, not the box
  Eigen::Vector2d forward = Eigen::Vector2d::UnitX();  // horizontal part of the object's x axis

  double Base() const { return center.z() - half.z(); }
  double Top() const { return center.z() + half.z(); }
};

// Returns the box of an asset of that size at that pose. The asset is the box or, for equal half
// sizes, the upright cylinder of its size, with its base at z = 0 of its frame.
PlacedBox BoxOf(const CategorySize& size, const Eigen::Isometry3d& world_from_object);

// Returns the distance between two boxes, m; 0 if they overlap.
double BoxDistance(const PlacedBox& a, const PlacedBox& b);

// Returns true if a is in this relation to b. All limits in m:
//   on          the centre of a is over the footprint of b, and the base of a is within 0.02 of the
//               top of b or of its rest height, and not below the base of b
//   inside      the centre of a is over the footprint of b, the base of a is more than 0.01 below
//               the top of b and not below the base of b
//   above       the centre of a is over the footprint of b or the reverse, and the base of a is
//               more than 0.02 above the top of b, but less than kNearDistance
//   below       b is above a
//   left, right, in front, behind
//               a and b are near and level, neither is on or inside the other, and the larger of
//               the horizontal offsets between their centres is 0.01 or more in this direction
//               (for equal offsets: left or right)
//   next to     one of the last four holds
//   facing      the x axis of a points to the centre of b within 30 degrees, seen from above; false
//               for an x axis within 30 degrees of vertical, and if the centres coincide
// Near: BoxDistance is below kNearDistance. Level: the boxes overlap in height by more than 0.001,
// or their bases differ by less than 0.02.
bool Holds(Relation relation, const PlacedBox& a, const PlacedBox& b);

// Returns all relations of a to b except facing, in the order of the enumeration.
std::vector<Relation> RelationsBetween(const PlacedBox& a, const PlacedBox& b);

// The boards of a shelf by name, from its uppermost board down.
enum class ShelfTier { kTop, kSecond, kThird, kBottom };
inline constexpr int kShelfTierCount = 4;

// Returns "on the top shelf", "on the second shelf", "on the third shelf", "on the bottom shelf".
const char* ShelfTierText(ShelfTier tier);

// The shelves of a scene: welded objects of a category whose name begins with "shelf".
class Shelves {
 public:
  // Boards are at ShelfBoardHeights, scaled by the height of the category's size. Throws
  // core::Error for a shelf without a size.
  Shelves(const std::vector<SceneObject>& objects, const CategorySizes& sizes);

  // Adds a shelf of that size at that pose; `object` is its index in the scene.
  void Add(const CategorySize& size, const Eigen::Isometry3d& world_from_shelf, int object = -1);
  Shelves() = default;

  bool empty() const { return shelves_.empty(); }

  // Returns the tier of the board that carries the object, directly or in a stack: the highest
  // board that is at most 0.02 m above the object's base. Unset if the object's centre is over no
  // shelf's footprint or its base is lower than the lowest board.
  std::optional<ShelfTier> TierOf(const PlacedBox& box) const;

  // The space over a board: the shelf's footprint, from the board up to the next one.
  struct TierSpace {
    int object = -1;  // the index of the shelf in the scene
    PlacedBox space;
  };
  // Returns the spaces of that tier, one for each shelf; the uppermost is 1 m high. Leaves out
  // shelves that lean or are turned by other than multiples of 90 degrees.
  std::vector<TierSpace> SpacesOf(ShelfTier tier) const;

 private:
  struct Shelf {
    Eigen::Isometry3d shelf_from_world;
    Eigen::Vector2d half_size;
    double scale;
    int object;
  };
  std::vector<Shelf> shelves_;
};

// Returns the indices of `boxes` (objects of one name) in the order of their ordinals: from left to
// right (falling y), then from front to back (rising x), both in steps of 0.01 m, then from the
// lowest base up. So the first steamer of a stack is its lowest, whatever its small offset.
std::vector<int> OrdinalOrder(const std::vector<const PlacedBox*>& boxes);

}  // namespace simwright::scene
