#pragma once

#include <string>
#include <vector>

#include "scene/grammar/derivation.h"

namespace simwright::scene {

// By how much the poses of a derivation miss those of its grammar's keep-outs and rims that are
// decided one way. What stands on what, and whose radius is whose, is found once: poses may then be
// drawn as often as need be.
class PoseViolation {
 public:
  PoseViolation(const Grammar& grammar, const Derivation& derivation, Decision decision);

  // m, the sum of all that is missing.
  double Sum(const Derivation& derivation) const;
  // The same of what nodes `first` to before `last` miss, among themselves and with the others.
  double SumOf(const Derivation& derivation, int first, int last) const;
  // The objects that violate something, as indices into the derivation.
  std::vector<int> Offenders(const Derivation& derivation) const;
  // What is missed most, in words; empty where nothing is.
  std::string Worst(const Derivation& derivation) const;

 private:
  struct Pair {
    int a = -1, b = -1;  // nodes
    double apart = 0.0;  // m, at least
    int keep_out = -1;   // into Grammar::keep_outs()
  };
  struct Inside {
    int node = -1;
    int rim = -1;  // into Grammar::rims()
  };

  double Missing(const Derivation& derivation, const Pair& pair) const;
  double Missing(const Derivation& derivation, const Inside& inside) const;
  void FindPairs(const Derivation& derivation, int keep_out);
  void FindInside(const Derivation& derivation, int rim);

  const Grammar& grammar_;
  std::vector<Pair> pairs_;
  std::vector<Inside> insides_;
};

}  // namespace simwright::scene
