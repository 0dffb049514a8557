#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// By how much the longest side of a thing (`size`, m, along x, y and z) leaves the longest sides
// that its category knows: 1 within them, 3 where it is three times the longest, 1/3 where it is a
// third of the shortest.
double SizeFactor(const Category& category, const Eigen::Vector3d& size);

// A thing that is more than this times too large or too small is none of its category, or its unit
// is not what was taken: chairs in feet read as metres come out 3.3 times too large.
constexpr double kAbsurdFactor = 2.5;

bool IsAbsurdSize(const Category& category, const Eigen::Vector3d& size);

// How far the proportions of a thing whose sides on the ground are `size`.x and .y and whose height
// is .z are from those of its category, whatever its scale: the sum of the logarithms by which its
// length, width and height leave the category's ranges at the best scale. 0 where they fit.
double ProportionMisfit(const Category& category, const Eigen::Vector3d& size);

// "0.382 x 0.41 x 0.895 m"
std::string SizeText(const Eigen::Vector3d& size);

// "its size of 38.2 x 41 x 89.5 m is 73 times that of a chair, whose longest side is 0.72 to
// 1.22 m"
std::string SizeSentence(const Category& category, const Eigen::Vector3d& size);

// The units of m, cm, mm, in, ft in which a thing whose sides are these numbers of a file has a
// size of its category: metric ones first, then those that bring it nearest to the middle.
std::vector<std::string> UnitsThatFit(const Category& category, const Eigen::Vector3d& numbers);

// Metres of one of these units. Throws core::Error for another name.
double MetresOfUnit(const std::string& unit);

}  // namespace simwright::physics_params
