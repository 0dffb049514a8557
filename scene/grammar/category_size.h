#pragma once

#include <map>
#include <string>

#include <Eigen/Core>

namespace simwright::scene {

// The dimensions of an asset that a grammar needs: metres, in its rest pose, with the origin at the
// centre of its base (z = 0) and long objects along x, their head at +x.
struct CategorySize {
  Eigen::Vector2d half_size = Eigen::Vector2d::Zero();  // in x and y
  double height = 0.0;                                  // height of the next object of a stack
  double rest_height = 0.0;  // height of an object in or on it: the floor of a plate or bowl

  // Returns the radius of the keep-out circle: the larger half size.
  double Radius() const { return half_size.maxCoeff(); }

  bool IsValid(std::string* error) const;
};

CategorySize RoundSize(double radius, double height, double rest_height = 0.0);
CategorySize BoxSize(double half_x, double half_y, double height, double rest_height = 0.0);

// Sizes by category.
using CategorySizes = std::map<std::string, CategorySize>;

// Returns all categories of the grammars of this folder, at the size of common household objects;
// the furniture and the steamers as in Pfaff et al., Steerable Scene Generation. Real assets
// replace the entries.
const CategorySizes& DefaultCategorySizes();

// Returns the entry of the category. Throws core::Error if there is none or it is invalid.
const CategorySize& SizeOf(const CategorySizes& sizes, const std::string& category);

}  // namespace simwright::scene
