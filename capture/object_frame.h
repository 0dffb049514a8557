#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "capture/structure_from_motion.h"

namespace simwright::capture {

// The object's place in a structure that was moved so that the object stands on z = 0 at the
// origin, with the cameras at a median distance of 1 from it.
struct ObjectFrame {
  Eigen::AlignedBox3d box;              // of the object's points, or of where the cameras look
  std::vector<std::uint8_t> is_object;  // per structure point, 1: on the object
  std::vector<std::uint8_t> is_table;   // per structure point, 1: on the table
  bool table_found = false;             // false: up and table are guessed
  int others = 0;                       // points of other things that stand beside the object
};

// Finds the table and the object among a structure's points and moves the structure into the
// object's frame. The table is the plane with most points under all cameras and under all points
// (RANSAC), within 65 degrees of the cameras' mean up direction; without one, that direction and
// the lowest points decide. The object is the group of points above the table nearest to where the
// optical axes meet. Throws core::Error for fewer than three placed photos.
ObjectFrame PlaceOnTable(std::uint64_t seed, Structure* structure);

}  // namespace simwright::capture
