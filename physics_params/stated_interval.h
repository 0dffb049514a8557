#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// The probability with which the intervals of assets and commands are stated to hold.
inline constexpr double kStatedProbability = 0.9;

enum class Quantity { kLongestSide, kMass, kFriction };

// The intervals of an object that has a name alone. `probability` is 0 in folders of versions that
// stated none.
struct StatedIntervals {
  double probability = 0.0;
  Interval longest_side;  // m
  Interval mass;          // kg
  Interval friction;      // Coulomb coefficient against wood or plastic; not calibrated
  std::string basis;      // a sentence
};

// Returns the central interval of the mixture of a row and its variants, before calibration. Each
// row's range is the central 90 % of a normal distribution of the logarithm; the friction of a row
// mixes its materials with weights 1, 1/2, 1/3 ... in their order. Units: m, kg, 1. Throws
// core::Error unless 0 < probability < 1.
Interval MixtureInterval(const Category& category, const KnowledgeBase& base, Quantity quantity,
                         double probability);

// Returns how far `truth` lies outside `range` in logarithms, relative to min(width, 1) + 0.1 with
// the range's width in logarithms; negative inside. These are the conformity scores that
// calibrations are fitted to.
double RelativeMiss(const Interval& range, double truth);

// Returns `range`, widened on both sides by `inflation` (RelativeMiss at its new ends).
Interval Inflated(const Interval& range, double inflation);

// The inflations that were fitted on the tuning half of measured objects (docs/physics.md).
class IntervalCalibration {
 public:
  // Parses data/calibration.txt. Throws core::Error, with the line, for a malformed table.
  explicit IntervalCalibration(std::string_view table);

  static const IntervalCalibration& Shipped();

  // Returns the inflation; 0 for friction, for which there is too little truth. Throws core::Error
  // for a probability that the table lacks.
  double Inflation(Quantity quantity, double probability) const;

 private:
  struct Entry {
    Quantity quantity;
    double probability;
    double inflation;
  };
  std::vector<Entry> entries_;
};

// Returns the calibrated interval of one quantity. `probability` is 0.9 or 0.95.
Interval StatedInterval(const Category& category, const KnowledgeBase& base, Quantity quantity,
                        double probability = kStatedProbability);

// Returns the calibrated intervals of an object of `category` (ChosenVariant, where a material or a
// size class is stated).
StatedIntervals StateIntervals(const Category& category, const KnowledgeBase& base);

}  // namespace simwright::physics_params
