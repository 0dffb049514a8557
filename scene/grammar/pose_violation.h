#pragma once

#include <string>
#include <vector>

#include "scene/grammar/derivation.h"

namespace simwright::scene {

// The violation of a grammar's keep-out and rim constraints of one Decision by the poses of a
// derivation. The constrained pairs and radii are collected once, so that many sets of poses can be
// evaluated.
class PoseViolation {
 public:
  PoseViolation(const Grammar& grammar, const Derivation& derivation, Decision decision);

  // Returns the sum of all violations, m.
  double Sum(const Derivation& derivation) const;
  // Returns the sum of the violations of nodes `first` to `last` (exclusive), among themselves and
  // with others, m.
  double SumOf(const Derivation& derivation, int first, int last) const;
  // Returns the objects that violate a constraint, as indices into the derivation.
  std::vector<int> ViolatingObjects(const Derivation& derivation) const;
  // Returns the description of the largest violation; empty if there is none.
  std::string Worst(const Derivation& derivation) const;

 private:
  struct Pair {
    int a = -1, b = -1;  // nodes
    double apart = 0.0;  // m, smallest distance
    int keep_out = -1;   // into Grammar::keep_outs()
  };
  struct Inside {
    int node = -1;
    int rim = -1;  // into Grammar::rims()
  };

  double Violation(const Derivation& derivation, const Pair& pair) const;
  double Violation(const Derivation& derivation, const Inside& inside) const;
  void FindPairs(const Derivation& derivation, int keep_out);
  void FindInside(const Derivation& derivation, int rim);

  const Grammar& grammar_;
  std::vector<Pair> pairs_;
  std::vector<Inside> insides_;
};

}  // namespace simwright::scene
