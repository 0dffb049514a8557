#include "physics_params/size_plausibility.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/error.h"
#include "physics_params/rounded_text.h"

namespace simwright::physics_params {
namespace {

constexpr struct {
  const char* name;
  double metres;
} kUnits[] = {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};

Interval LongestSide(const Category& category) {
  return {std::max({category.length.min, category.width.min, category.height.min}),
          std::max({category.length.max, category.width.max, category.height.max})};
}

}  // namespace

double SizeFactor(const Category& category, const Eigen::Vector3d& size) {
  const Interval usual = LongestSide(category);
  const double longest = size.maxCoeff();
  if (longest > usual.max) return longest / usual.max;
  return longest < usual.min ? longest / usual.min : 1.0;
}

bool IsAbsurdSize(const Category& category, const Eigen::Vector3d& size) {
  const double factor = SizeFactor(category, size);
  return factor > kAbsurdFactor || factor < 1.0 / kAbsurdFactor;
}

double ProportionMisfit(const Category& category, const Eigen::Vector3d& size) {
  const Interval ranges[] = {category.length, category.width, category.height};
  const double sides[] = {std::max(size.x(), size.y()), std::min(size.x(), size.y()), size.z()};
  double least = HUGE_VAL;
  // The sum is piecewise linear in the logarithm of the scale: its minimum is where a side meets an
  // end.
  for (int i = 0; i < 6; ++i) {
    const double end = i % 2 == 0 ? ranges[i / 2].min : ranges[i / 2].max;
    const double scale = end / sides[i / 2];
    if (!(scale > 0.0) || !std::isfinite(scale)) continue;
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double side = std::max(scale * sides[k], 1e-9);
      sum += std::max({0.0, std::log(ranges[k].min / side), std::log(side / ranges[k].max)});
    }
    least = std::min(least, sum);
  }
  return std::isfinite(least) ? least : 0.0;
}

std::string SizeText(const Eigen::Vector3d& size) {
  return RoundedText(size.x()) + " x " + RoundedText(size.y()) + " x " + RoundedText(size.z()) +
         " m";
}

std::string SizeSentence(const Category& category, const Eigen::Vector3d& size) {
  const Interval usual = LongestSide(category);
  const double factor = SizeFactor(category, size);
  const std::string times = factor > 1.0
                                ? RoundedText(factor) + " times that of the largest"
                                : "1/" + RoundedText(1.0 / factor) + " of that of the smallest";
  return "its size of " + SizeText(size) + " is " + times + " '" + category.name +
         "', whose longest side is " + RoundedText(usual.min) + " to " + RoundedText(usual.max) +
         " m";
}

std::vector<std::string> UnitsThatFit(const Category& category, const Eigen::Vector3d& numbers) {
  const Interval usual = LongestSide(category);
  const double middle = std::sqrt(usual.min * usual.max);
  std::vector<std::tuple<bool, double, std::string>> fitting;
  for (const auto& unit : kUnits) {
    const double side = unit.metres * numbers.maxCoeff();
    // A tenth beyond the range is still the same category.
    if (side > 1.1 * usual.max || side < 0.9 * usual.min) continue;
    const std::string name = unit.name;
    fitting.emplace_back(name == "in" || name == "ft", std::abs(std::log(side / middle)), name);
  }
  std::sort(fitting.begin(), fitting.end());
  std::vector<std::string> names;
  for (const auto& one : fitting) names.push_back(std::get<2>(one));
  return names;
}

double MetresOfUnit(const std::string& unit) {
  for (const auto& one : kUnits) {
    if (unit == one.name) return one.metres;
  }
  throw core::Error("unknown unit", unit, "one of m, cm, mm, in, ft");
}

}  // namespace simwright::physics_params
