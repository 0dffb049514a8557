#include "physics_params/stated_interval.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "physics_params/log_normal_mixture.h"
#include "physics_params/rounded_text.h"
#include "physics_params/word_forms.h"

namespace simwright::physics_params {
namespace data {
std::string_view calibration_txt();
}  // namespace data
namespace {

// The unit of inflation is the width of a range in logarithms, cut at this much, plus a floor, so
// that a wide range is not inflated by far more than others and a narrow one is inflated too. Of
// seven such units, this one had nearly the least interval score on the tuning half, each kind left
// out in turn (docs/physics.md).
constexpr double kWidthCap = 1.0, kWidthFloor = 0.1;

double InflationUnit(const Interval& range) {
  return std::min(std::log(range.max / range.min), kWidthCap) + kWidthFloor;
}

void AddRow(const Category& row, const KnowledgeBase& base, Quantity quantity, double weight,
            std::vector<LogNormal>* components) {
  if (quantity == Quantity::kMass) {
    components->push_back(LogNormalOf(row.mass, weight));
  } else if (quantity == Quantity::kLongestSide) {
    const Interval longest{std::max({row.length.min, row.width.min, row.height.min}),
                           std::max({row.length.max, row.width.max, row.height.max})};
    components->push_back(LogNormalOf(longest, weight));
  } else {
    double total = 0.0;
    for (size_t i = 0; i < row.materials.size(); ++i) total += 1.0 / static_cast<double>(i + 1);
    for (size_t i = 0; i < row.materials.size(); ++i) {
      const Material& material = *base.FindMaterial(row.materials[i]);
      components->push_back(
          LogNormalOf(material.friction, weight / (total * static_cast<double>(i + 1))));
    }
  }
}

double TableNumber(const std::string& text, const std::string& where) {
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) {
    throw core::Error("'" + text + "' is not a number", where);
  }
  return value;
}

}  // namespace

Interval MixtureInterval(const Category& category, const KnowledgeBase& base, Quantity quantity,
                         double probability) {
  if (!(probability > 0.0 && probability < 1.0)) {
    throw core::Error("a stated probability must lie between 0 and 1", category.name);
  }
  std::vector<LogNormal> components;
  double own = 1.0;
  for (const Variant& variant : category.variants) {
    AddRow(*base.FindCategory(variant.category), base, quantity, variant.weight, &components);
    own -= variant.weight;
  }
  AddRow(category, base, quantity, own, &components);
  return CentralInterval(components, probability);
}

double RelativeMiss(const Interval& range, double truth) {
  return std::max(std::log(range.min / truth), std::log(truth / range.max)) / InflationUnit(range);
}

Interval Inflated(const Interval& range, double inflation) {
  const double added = inflation * InflationUnit(range);
  const double low = std::log(range.min) - added, high = std::log(range.max) + added;
  if (low <= high) return {std::exp(low), std::exp(high)};
  return {std::exp(0.5 * (low + high)), std::exp(0.5 * (low + high))};  // shrunk to its centre
}

IntervalCalibration::IntervalCalibration(std::string_view table) {
  int number = 0;
  while (!table.empty()) {
    const size_t end = std::min(table.find('\n'), table.size());
    const std::string line(table.substr(0, end));
    table.remove_prefix(std::min(end + 1, table.size()));
    const std::string where = "calibration line " + std::to_string(++number);
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> words = WordsOf(line);
    if (words.size() != 3 || (words[0] != "mass" && words[0] != "longest_side")) {
      throw core::Error("is not 'mass|longest_side PROBABILITY INFLATION'", where);
    }
    entries_.push_back({words[0] == "mass" ? Quantity::kMass : Quantity::kLongestSide,
                        TableNumber(words[1], where), TableNumber(words[2], where)});
  }
}

const IntervalCalibration& IntervalCalibration::Shipped() {
  static const IntervalCalibration shipped(data::calibration_txt());
  return shipped;
}

double IntervalCalibration::Inflation(Quantity quantity, double probability) const {
  if (quantity == Quantity::kFriction) return 0.0;
  for (const Entry& entry : entries_) {
    if (entry.quantity == quantity && std::abs(entry.probability - probability) < 1e-9) {
      return entry.inflation;
    }
  }
  throw core::Error("intervals are calibrated for 0.9 and 0.95 alone",
                    "probability " + RoundedText(probability));
}

Interval StatedInterval(const Category& category, const KnowledgeBase& base, Quantity quantity,
                        double probability) {
  return Inflated(MixtureInterval(category, base, quantity, probability),
                  IntervalCalibration::Shipped().Inflation(quantity, probability));
}

StatedIntervals StateIntervals(const Category& category, const KnowledgeBase& base) {
  StatedIntervals stated;
  stated.probability = kStatedProbability;
  stated.longest_side = StatedInterval(category, base, Quantity::kLongestSide);
  stated.mass = StatedInterval(category, base, Quantity::kMass);
  stated.friction = StatedInterval(category, base, Quantity::kFriction);
  stated.basis = "of '" + category.name + "'";
  for (size_t i = 0; i < category.variants.size(); ++i) {
    stated.basis += (i == 0 ? " with " : ", ") + RoundedText(100.0 * category.variants[i].weight) +
                    " % '" + category.variants[i].category + "'";
  }
  return stated;
}

}  // namespace simwright::physics_params
