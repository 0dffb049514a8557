#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace simwright::steering {

// An arithmetic expression of counts of objects: "count(apple) + 2*count(can)". Grammar:
//   sum      product { (+ | -) product }
//   product  factor { (* | /) factor }
//   factor   number | -factor | ( sum ) | count(NAME) | feasible(NAME) | count() | feasible()
//            | min(sum, sum) | max(sum, sum)
// NAME is a name of objects in prompts, in singular or plural; without a name, all objects count,
// furniture excluded. feasible() counts the objects that physics accepts.
class CountExpression {
 public:
  // The numbers of objects that an expression is evaluated on, in the order of its names.
  struct Counts {
    std::vector<double> there, feasible;  // by name
    double all = 0.0, all_feasible = 0.0;
  };

  // Parses an expression. `known_names`: of scene::NameOfCategory. Throws core::Error with the
  // position for a text that does not parse, a name that is not known (naming the known ones), more
  // than 1000 characters, or parentheses nested more than 50 deep.
  static CountExpression Parse(const std::string& text,
                               const std::vector<std::string>& known_names);

  // Returns the value. Division by zero, as every result that is not finite, gives 0.
  double Evaluate(const Counts& counts) const;

  const std::string& text() const { return text_; }
  const std::vector<std::string>& names() const { return names_; }  // each once
  bool UsesFeasible() const { return uses_feasible_; }
  // Returns the largest value when each count is between 0 and `most`, by interval arithmetic.
  double UpperBound(double most) const;

 private:
  friend class CountParser;

  enum class Kind {
    kNumber,
    kCount,
    kFeasible,
    kNegate,
    kAdd,
    kSubtract,
    kMultiply,
    kDivide,
    kMin,
    kMax
  };
  struct Node {
    Kind kind = Kind::kNumber;
    double number = 0.0;
    int name = -1;              // an index into names_; -1: all objects
    int left = -1, right = -1;  // nodes before this one
  };
  struct Range {
    double low, high;
  };
  Range RangeOf(const Node& node, const std::vector<Range>& ranges, double most) const;

  std::string text_;
  std::vector<std::string> names_;
  std::vector<Node> nodes_;  // operands before their operators; the last is the result
  bool uses_feasible_ = false;
};

}  // namespace simwright::steering
