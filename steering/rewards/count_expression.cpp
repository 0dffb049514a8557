#include "steering/rewards/count_expression.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "scene/prompt/object_names.h"

namespace simwright::steering {
namespace {

constexpr size_t kMostCharacters = 1000;
constexpr int kDeepest = 50;

std::string ListOfNames(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

double FiniteOrZero(double value) {
  return std::isfinite(value) ? value : 0.0;
}

}  // namespace

// A recursive descent over the text, one function per rule of the grammar.
class CountParser {
 public:
  CountParser(const std::string& text, const std::vector<std::string>& known)
      : text_(text), known_(known) {}

  CountExpression Run() {
    if (text_.size() > kMostCharacters) {
      throw core::Error("an expression of counts has at most 1000 characters");
    }
    result_.text_ = text_;
    Sum();
    if (Peek() != '\0') Fail("an operator is expected");
    return std::move(result_);
  }

 private:
  using Kind = CountExpression::Kind;

  [[noreturn]] void Fail(const std::string& what) const {
    const std::string there =
        position_ < text_.size() ? "\"" + text_.substr(position_, 12) + "\"" : "the end";
    throw core::Error("the expression does not parse: " + what,
                      "character " + std::to_string(position_ + 1) + ", at " + there,
                      "as in count(apple) + 2*count(can)");
  }

  char Peek() {
    while (position_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[position_]))) {
      ++position_;
    }
    return position_ < text_.size() ? text_[position_] : '\0';
  }
  bool Takes(char wanted) {
    if (Peek() != wanted) return false;
    ++position_;
    return true;
  }
  void Expect(char wanted) {
    if (!Takes(wanted)) Fail(std::string("'") + wanted + "' is expected");
  }

  int Append(const CountExpression::Node& node) {
    result_.nodes_.push_back(node);
    return static_cast<int>(result_.nodes_.size()) - 1;
  }
  int Join(Kind kind, int left, int right) { return Append({kind, 0.0, -1, left, right}); }

  int Sum() {
    if (++depth_ > kDeepest) Fail("it is nested too deep");
    int left = Product();
    for (;;) {
      if (Takes('+')) {
        left = Join(Kind::kAdd, left, Product());
      } else if (Takes('-')) {
        left = Join(Kind::kSubtract, left, Product());
      } else {
        --depth_;
        return left;
      }
    }
  }

  int Product() {
    int left = Factor();
    for (;;) {
      if (Takes('*')) {
        left = Join(Kind::kMultiply, left, Factor());
      } else if (Takes('/')) {
        left = Join(Kind::kDivide, left, Factor());
      } else {
        return left;
      }
    }
  }

  int Factor() {
    const char next = Peek();
    if (Takes('-')) {
      if (++depth_ > kDeepest) Fail("it is nested too deep");
      const int operand = Factor();
      --depth_;
      return Append({Kind::kNegate, 0.0, -1, operand, -1});
    }
    if (Takes('(')) {
      const int inner = Sum();
      Expect(')');
      return inner;
    }
    if (std::isdigit(static_cast<unsigned char>(next)) || next == '.') return Number();
    if (std::isalpha(static_cast<unsigned char>(next))) return Function();
    Fail("a number, count(NAME) or feasible(NAME) is expected");
  }

  int Number() {
    size_t end = position_;
    while (end < text_.size() &&
           (std::isdigit(static_cast<unsigned char>(text_[end])) || text_[end] == '.')) {
      ++end;
    }
    const std::string digits = text_.substr(position_, end - position_);
    if (digits == "." || std::count(digits.begin(), digits.end(), '.') > 1)
      Fail("a number is wrong");
    const int node = Append({Kind::kNumber, std::stod(digits), -1, -1, -1});
    position_ = end;
    return node;
  }

  int Function() {
    const size_t start = position_;
    size_t end = start;
    while (end < text_.size() && std::isalpha(static_cast<unsigned char>(text_[end]))) ++end;
    const std::string word = text_.substr(start, end - start);
    position_ = end;
    if (word == "min" || word == "max") {
      Expect('(');
      const int left = Sum();
      Expect(',');
      const int right = Sum();
      Expect(')');
      return Join(word == "min" ? Kind::kMin : Kind::kMax, left, right);
    }
    if (word != "count" && word != "feasible") {
      position_ = start;
      Fail("\"" + word + "\" is no function");
    }
    Expect('(');
    const int name = Name();
    Expect(')');
    result_.uses_feasible_ = result_.uses_feasible_ || word == "feasible";
    return Append({word == "count" ? Kind::kCount : Kind::kFeasible, 0.0, name, -1, -1});
  }

  // Reads a name up to the closing parenthesis and returns its index; -1 without a name.
  int Name() {
    Peek();
    const size_t start = position_, end = std::min(text_.find_first_of("()", start), text_.size());
    std::string spelling;
    for (size_t i = start; i < end; ++i) {
      const char c = text_[i] == '_' ? ' ' : text_[i];
      spelling += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    while (!spelling.empty() && spelling.back() == ' ') spelling.pop_back();
    if (spelling.empty()) return -1;
    for (const std::string& name : known_) {
      const std::vector<std::string> spellings = scene::SpellingsOf(name);
      if (std::find(spellings.begin(), spellings.end(), spelling) == spellings.end()) continue;
      position_ = end;
      std::vector<std::string>& names = result_.names_;
      const auto found = std::find(names.begin(), names.end(), name);
      if (found != names.end()) return static_cast<int>(found - names.begin());
      names.push_back(name);
      return static_cast<int>(names.size()) - 1;
    }
    throw core::Error("no object has this name", "\"" + spelling + "\"",
                      "the names are " + ListOfNames(known_));
  }

  const std::string& text_;
  const std::vector<std::string>& known_;
  size_t position_ = 0;
  int depth_ = 0;
  CountExpression result_;
};

CountExpression CountExpression::Parse(const std::string& text,
                                       const std::vector<std::string>& known_names) {
  return CountParser(text, known_names).Run();
}

double CountExpression::Evaluate(const Counts& counts) const {
  std::vector<double> values;
  values.reserve(nodes_.size());
  for (const Node& node : nodes_) {
    const double a = node.left < 0 ? 0.0 : values[static_cast<size_t>(node.left)];
    const double b = node.right < 0 ? 0.0 : values[static_cast<size_t>(node.right)];
    const auto name = static_cast<size_t>(std::max(0, node.name));
    double value = 0.0;
    switch (node.kind) {
      case Kind::kNumber:
        value = node.number;
        break;
      case Kind::kCount:
        value = node.name < 0 ? counts.all : counts.there[name];
        break;
      case Kind::kFeasible:
        value = node.name < 0 ? counts.all_feasible : counts.feasible[name];
        break;
      case Kind::kNegate:
        value = -a;
        break;
      case Kind::kAdd:
        value = a + b;
        break;
      case Kind::kSubtract:
        value = a - b;
        break;
      case Kind::kMultiply:
        value = a * b;
        break;
      case Kind::kDivide:
        value = b == 0.0 ? 0.0 : a / b;
        break;
      case Kind::kMin:
        value = std::min(a, b);
        break;
      case Kind::kMax:
        value = std::max(a, b);
        break;
    }
    values.push_back(FiniteOrZero(value));
  }
  return values.back();
}

CountExpression::Range CountExpression::RangeOf(const Node& node, const std::vector<Range>& ranges,
                                                double most) const {
  const Range a = node.left < 0 ? Range{0, 0} : ranges[static_cast<size_t>(node.left)];
  const Range b = node.right < 0 ? Range{0, 0} : ranges[static_cast<size_t>(node.right)];
  switch (node.kind) {
    case Kind::kNumber:
      return {node.number, node.number};
    case Kind::kCount:
    case Kind::kFeasible:
      return {0.0, most};
    case Kind::kNegate:
      return {-a.high, -a.low};
    case Kind::kAdd:
      return {a.low + b.low, a.high + b.high};
    case Kind::kSubtract:
      return {a.low - b.high, a.high - b.low};
    case Kind::kMin:
      return {std::min(a.low, b.low), std::min(a.high, b.high)};
    case Kind::kMax:
      return {std::max(a.low, b.low), std::max(a.high, b.high)};
    case Kind::kMultiply: {
      const double products[] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
      return {*std::min_element(products, products + 4), *std::max_element(products, products + 4)};
    }
    case Kind::kDivide:
      break;
  }
  // A count is 0 or at least 1, but a difference of products may be as small as one likes.
  if (b.low > 0.0 || b.high < 0.0) {
    const double quotients[] = {a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high};
    return {*std::min_element(quotients, quotients + 4),
            *std::max_element(quotients, quotients + 4)};
  }
  const double largest = std::numeric_limits<double>::max();
  return {-largest, largest};
}

double CountExpression::UpperBound(double most) const {
  std::vector<Range> ranges;
  for (const Node& node : nodes_) {
    Range range = RangeOf(node, ranges, most);
    // An operation may overflow, and Evaluate gives 0 for it.
    const double largest = std::numeric_limits<double>::max();
    if (!std::isfinite(range.low)) range.low = -largest;
    if (!std::isfinite(range.high)) range.high = largest;
    ranges.push_back(range);
  }
  return ranges.back().high;
}

}  // namespace simwright::steering
