#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// Returns the factor between the longest side of an object (`size`, m, along x, y and z) and its
// category's range of longest sides: 1 within the range, 3 if it is three times the maximum, 1/3 if
// it is a third of the minimum.
double SizeFactor(const Category& category, const Eigen::Vector3d& size);

// The factor beyond which an object's category or unit must be wrong: chairs in feet read as metres
// are 3.3 times too large.
constexpr double kAbsurdFactor = 2.5;

bool IsAbsurdSize(const Category& category, const Eigen::Vector3d& size);

// Returns how far the proportions of an object with horizontal sides `size`.x and .y and height .z
// deviate from its category's, independent of scale: the sum of the logarithms by which its length,
// width and height leave the category's ranges at the best scale. 0 if they fit.
double ProportionMisfit(const Category& category, const Eigen::Vector3d& size);

// Formats a size: "0.382 x 0.41 x 0.895 m".
std::string SizeText(const Eigen::Vector3d& size);

// Describes an implausible size: "its size of 38.2 x 41 x 89.5 m is 73 times that of a chair, whose
// longest side is 0.72 to 1.22 m".
std::string SizeSentence(const Category& category, const Eigen::Vector3d& size);

// Returns the units among m, cm, mm, in, ft in which an object whose sides are these numbers of a
// file has a size of its category: metric ones first, then those nearest to the middle of the
// range.
std::vector<std::string> UnitsThatFit(const Category& category, const Eigen::Vector3d& numbers);

// Returns the length in metres of one of these units. Throws core::Error for another name.
double MetresOfUnit(const std::string& unit);

}  // namespace simwright::physics_params
