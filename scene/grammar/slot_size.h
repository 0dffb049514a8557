#pragma once

#include <map>
#include <string>

#include <Eigen/Core>

namespace simwright::scene {

// What a grammar needs to know of an asset before it is placed: metres, in the pose in which it
// stands, its origin at the middle of its foot (z = 0), a long thing along x with its head at +x.
struct SlotSize {
  Eigen::Vector2d half_size = Eigen::Vector2d::Zero();  // in x and y
  double height = 0.0;                                  // where the next one of a stack stands
  double rest_height = 0.0;  // where a thing put in or on it stands: a plate's or bowl's floor

  // Of the circle that keeps others away: the larger half size.
  double Radius() const { return half_size.maxCoeff(); }

  bool IsValid(std::string* error) const;
};

SlotSize RoundSize(double radius, double height, double rest_height = 0.0);
SlotSize BoxSize(double half_x, double half_y, double height, double rest_height = 0.0);

// By the name of a slot.
using SlotSizes = std::map<std::string, SlotSize>;

// Every slot that the grammars of this folder name, at the size of a common household thing; the
// furniture and the steamers as Pfaff et al., Steerable Scene Generation, have them. Real assets
// replace entries.
const SlotSizes& DefaultSlotSizes();

// The slot's entry. Throws core::Error where there is none, or an invalid one.
const SlotSize& SizeOf(const SlotSizes& sizes, const std::string& slot);

}  // namespace simwright::scene
