#include "physics_params/physics_answer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "physics_params/answer_lines.h"
#include "physics_params/measure_text.h"

namespace simwright::physics_params {
namespace {

constexpr double kGram = 1e-3, kCentimetre = 1e-2;  // the default units

enum class AnswerQuantity { kMass, kLength, kWidth, kHeight, kSides, kDimensions };

struct Keyword {
  std::size_t begin, end;
  AnswerQuantity quantity;
  bool follows;  // "10 cm long": the value precedes the word
};

struct Word {
  const char* text;
  AnswerQuantity quantity;
  bool follows;
};
constexpr std::array<Word, 24> kWords = {{{"mass", AnswerQuantity::kMass, false},
                                          {"masses", AnswerQuantity::kMass, false},
                                          {"weight", AnswerQuantity::kMass, false},
                                          {"weighs", AnswerQuantity::kMass, false},
                                          {"weigh", AnswerQuantity::kMass, false},
                                          {"weighing", AnswerQuantity::kMass, false},
                                          {"length", AnswerQuantity::kLength, false},
                                          {"width", AnswerQuantity::kWidth, false},
                                          {"depth", AnswerQuantity::kWidth, false},
                                          {"height", AnswerQuantity::kHeight, false},
                                          {"diameter", AnswerQuantity::kSides, false},
                                          {"dimensions", AnswerQuantity::kDimensions, false},
                                          {"dimension", AnswerQuantity::kDimensions, false},
                                          {"size", AnswerQuantity::kDimensions, false},
                                          {"sizes", AnswerQuantity::kDimensions, false},
                                          {"measures", AnswerQuantity::kDimensions, false},
                                          {"measuring", AnswerQuantity::kDimensions, false},
                                          {"long", AnswerQuantity::kLength, true},
                                          {"wide", AnswerQuantity::kWidth, true},
                                          {"deep", AnswerQuantity::kWidth, true},
                                          {"tall", AnswerQuantity::kHeight, true},
                                          {"high", AnswerQuantity::kHeight, true},
                                          {"thick", AnswerQuantity::kHeight, true},
                                          {"across", AnswerQuantity::kSides, true}}};

bool IsAnswerLetter(char c) {
  return c >= 'a' && c <= 'z';
}

std::vector<Keyword> FindKeywords(std::string_view line) {
  std::vector<Keyword> found;
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = at;
    while (end < line.size() && IsAnswerLetter(line[end])) ++end;
    for (const Word& word : kWords) {
      if (line.substr(at, end - at) == word.text) {
        found.push_back({at, end, word.quantity, word.follows});
      }
    }
    at = std::max(end, at + 1);
  }
  return found;
}

Dimension DimensionOf(AnswerQuantity quantity) {
  return quantity == AnswerQuantity::kMass ? Dimension::kMass : Dimension::kLength;
}

// Returns the last unit of `dimension` in a label such as "mass of mug in grams (g)"; single
// letters count only in brackets or after "in".
std::optional<Unit> LabelUnit(std::string_view label, Dimension dimension) {
  std::optional<Unit> unit;
  for (std::size_t at = 0; at < label.size();) {
    std::size_t end = at;
    while (end < label.size() && IsAnswerLetter(label[end])) ++end;
    const std::string_view word = label.substr(at, end - at);
    const std::string_view before = label.substr(0, at);
    const bool marked = before.ends_with("(") || before.ends_with(" in ");
    const std::optional<Unit> named = FindUnit(word);
    if (named && named->dimension == dimension && (marked || (word.size() > 1 && word != "in"))) {
      unit = named;
    }
    at = std::max(end, at + 1);
  }
  return unit;
}

// Removes bracketed conversions as in "200-300 g (0.44-0.66 lb)" if there is a value outside.
std::string WithoutConversions(const std::string& line) {
  std::string kept = line;
  const auto has_digit = [](std::string_view text) {
    return std::any_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  };
  for (std::size_t open = kept.find('('); open != std::string::npos; open = kept.find('(', open)) {
    const std::size_t close = kept.find(')', open);
    if (close == std::string::npos) break;
    const std::string_view inside(&kept[open], close - open);
    if (has_digit(inside) && has_digit(std::string_view(kept).substr(0, open))) {
      kept.erase(open, close + 1 - open);
    } else {
      open = close;
    }
  }
  return kept;
}

// A quantity and its values.
struct Statement {
  AnswerQuantity quantity;
  Interval value;  // SI, as written
};

// Reads the statements of one line for one meaning of commas.
class LineReading {
 public:
  LineReading(std::string_view line, Comma comma) : line_(line) {
    const std::vector<Keyword> keywords = FindKeywords(line);
    const std::vector<TextRange> ranges = ReadRanges(line, comma);
    std::size_t k = 0;
    for (const TextRange& range : ranges) {
      while (k < keywords.size() && keywords[k].begin < range.begin) Take(keywords[k++]);
      values_.push_back(range);
    }
    while (k < keywords.size()) Take(keywords[k++]);
    Flush();
  }

  const std::vector<Statement>& statements() const { return statements_; }
  bool clear() const { return clear_; }  // every value had its quantity

 private:
  void Take(const Keyword& keyword) {
    if (keyword.follows) {
      // Without a value before it the word means something else ("high quality").
      if (!values_.empty()) {
        Add(keyword.quantity, values_.back(), std::nullopt);
        values_.pop_back();
      }
      return;
    }
    if (!values_.empty()) Flush();
    group_.push_back(keyword);
  }

  void Flush() {
    const std::vector<Keyword> group = std::exchange(group_, {});
    const std::vector<TextRange> values = std::exchange(values_, {});
    if (group.empty() || values.empty()) return;
    Assign(group, values, Dimension::kMass);
    Assign(group, values, Dimension::kLength);
  }

  void Assign(const std::vector<Keyword>& group, const std::vector<TextRange>& values,
              Dimension dimension) {
    const std::vector<AnswerQuantity> quantities = QuantitiesOf(group, dimension);
    if (quantities.empty()) return;
    const bool mixed = std::any_of(group.begin(), group.end(), [&](const Keyword& keyword) {
      return DimensionOf(keyword.quantity) != dimension;
    });
    std::vector<TextRange> mine;
    for (std::size_t i = 0; i < values.size(); ++i) {
      // In "mass, length, width, height: 300, 10, 8, 7" bare numbers are matched by position.
      const bool bare_mine =
          !mixed || (values.size() == group.size() && DimensionOf(group[i].quantity) == dimension);
      if (values[i].unit ? values[i].unit->dimension == dimension : bare_mine) {
        mine.push_back(values[i]);
      }
    }
    if (mine.empty()) return;
    const std::string_view label =
        line_.substr(group.front().begin, values.front().begin - group.front().begin);
    std::optional<Unit> unit = mine.back().unit;
    if (!unit) unit = LabelUnit(label, dimension);
    const bool each = mine.size() == 1;
    // "20,100,300" for three sizes is not an eight-digit number.
    const std::string_view first = line_.substr(mine[0].begin, mine[0].end - mine[0].begin);
    if (each && quantities.size() > 1 && first.find(',') != std::string_view::npos) clear_ = false;
    if (!each && mine.size() != quantities.size()) clear_ = false;
    if (!each && mine.size() < quantities.size()) return;  // ambiguous: which one is missing?
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      Add(quantities[i], mine[each ? 0 : i], unit);
    }
  }

  // Returns the group's quantities of one dimension; "dimensions" means three if none is named.
  static std::vector<AnswerQuantity> QuantitiesOf(const std::vector<Keyword>& group,
                                                  Dimension dimension) {
    std::vector<AnswerQuantity> quantities;
    bool whole = false;
    for (const Keyword& keyword : group) {
      if (DimensionOf(keyword.quantity) != dimension) continue;
      if (keyword.quantity == AnswerQuantity::kDimensions) {
        whole = true;
      } else if (std::find(quantities.begin(), quantities.end(), keyword.quantity) ==
                 quantities.end()) {
        quantities.push_back(keyword.quantity);
      }
    }
    if (whole && quantities.empty()) {
      quantities = {AnswerQuantity::kLength, AnswerQuantity::kWidth, AnswerQuantity::kHeight};
    }
    return quantities;
  }

  void Add(AnswerQuantity quantity, const TextRange& range, std::optional<Unit> unit) {
    if (range.unit) unit = range.unit;
    const bool mass = quantity == AnswerQuantity::kMass;
    if (unit && (unit->dimension == Dimension::kMass) != mass) return;
    const double factor = unit ? unit->factor : mass ? kGram : kCentimetre;
    statements_.push_back({quantity, {range.value.min * factor, range.value.max * factor}});
  }

  std::string_view line_;
  std::vector<Keyword> group_;
  std::vector<TextRange> values_;
  std::vector<Statement> statements_;
  bool clear_ = true;
};

LineReading ReadLine(std::string_view line) {
  LineReading first(line, Comma::kThousands);
  for (const Comma comma : {Comma::kDecimal, Comma::kSeparator}) {
    if (first.clear()) break;
    LineReading other(line, comma);
    if (other.clear() && !other.statements().empty()) return other;
  }
  return first;
}

std::string TrimmedAnswer(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\"'.";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(kBlanks) - first + 1));
}

// Reads "object: red mug" into `name`; returns false for every other line.
bool IsNamingAnswer(const std::string& line, std::string* name) {
  for (const std::string_view label : {"object:", "name:", "item:", "category:"}) {
    if (line.starts_with(label)) {
      *name = NormaliseName(TrimmedAnswer(std::string_view(line).substr(label.size())));
      return true;
    }
  }
  return false;
}

// Returns "red mug" for "average mass of red mug in grams: ..."; empty if no object is named.
std::string NameInLabel(std::string_view line) {
  std::string_view label = line.substr(0, line.find(':'));
  const std::size_t of = label.find(" of ");
  if (of == std::string_view::npos || FindKeywords(label.substr(0, of)).empty()) return "";
  label.remove_prefix(of + 4);
  for (const std::string_view end : {" in ", " (", " is ", " are ", " ranges ", " would "}) {
    label = label.substr(0, label.find(end));
  }
  for (const std::string_view article : {"a ", "an ", "the ", "one "}) {
    if (label.starts_with(article)) label.remove_prefix(article.size());
  }
  return NormaliseName(TrimmedAnswer(label));
}

// Removes numbers in the label, as in "mass of 2-liter bottle: 2000": they are not values.
std::string WithoutLabelNumbers(std::string line) {
  const std::size_t of = line.find(" of "), colon = line.find(':');
  const bool valued =
      colon != std::string::npos && line.find_first_of("0123456789", colon) != std::string::npos;
  if (of == std::string::npos || !valued || of > colon) return line;
  for (std::size_t i = of; i < colon; ++i) {
    if (line[i] >= '0' && line[i] <= '9') line[i] = '#';
  }
  return line;
}

std::string MaterialIn(const std::string& line) {
  const std::size_t word = line.find("material");
  const std::size_t colon = word == std::string::npos ? word : line.find(':', word);
  return colon == std::string::npos ? "" : TrimmedAnswer(std::string_view(line).substr(colon + 1));
}

// Collects the statements of all lines into objects.
class AnswerReading {
 public:
  PhysicsAnswer Read(std::string_view answer) {
    for (const std::string& line : AnswerLines(answer)) {
      std::string name;
      if (IsNamingAnswer(line, &name)) {
        Begin(name);
      } else {
        ReadStatements(line);
      }
    }
    Begin("");
    return std::move(result_);
  }

 private:
  static bool Says(const ObjectAnswer& object) {
    return object.mass || object.length || object.width || object.height ||
           !object.material.empty();
  }

  // Starts another object, unless the current one is still empty.
  void Begin(const std::string& name) {
    if (Says(object_)) result_.objects.push_back(object_);
    object_ = {};
    object_.name = name;
  }

  void ReadStatements(const std::string& whole) {
    const std::string line = WithoutConversions(whole);
    const std::string values = WithoutLabelNumbers(line);
    const LineReading reading = ReadLine(values);
    if (!reading.statements().empty()) {
      const std::string name = NameInLabel(line);
      if (!name.empty() && name != object_.name) {
        // A name in a label overrides that of a heading without data.
        if (object_.name.empty() && Says(object_)) {
          object_.name = name;
        } else {
          Begin(name);
        }
      }
    }
    if (!reading.clear()) {
      Report("answer-unclear",
             "'" + line.substr(0, 80) + "' has another number of values than of quantities");
    }
    for (const Statement& statement : reading.statements()) Set(statement, line);
    const std::string material = MaterialIn(line);
    if (!material.empty() && object_.material.empty()) object_.material = material;
  }

  void Set(const Statement& statement, const std::string& line) {
    Interval value = statement.value;
    if (!(value.min > 0.0) || !(value.max > 0.0) || !std::isfinite(value.min + value.max)) {
      Report("answer-negative", "'" + line.substr(0, 80) + "' is not a positive size or mass");
      return;
    }
    if (value.min > value.max) {
      Report("answer-swapped", "'" + line.substr(0, 80) + "' starts with its larger end");
      std::swap(value.min, value.max);
    }
    const auto set = [&](std::optional<Interval>* quantity) {
      if (!*quantity) *quantity = value;  // the first value counts; more are conversions
    };
    if (statement.quantity == AnswerQuantity::kMass) set(&object_.mass);
    if (statement.quantity == AnswerQuantity::kHeight) set(&object_.height);
    const bool sides = statement.quantity == AnswerQuantity::kSides;
    if (statement.quantity == AnswerQuantity::kLength || sides) set(&object_.length);
    if (statement.quantity == AnswerQuantity::kWidth || sides) set(&object_.width);
  }

  void Report(const std::string& code, const std::string& sentence) {
    result_.findings.push_back(
        {code, core::Severity::kWarning, object_.name, "of the answer, " + sentence, 0.0});
  }

  ObjectAnswer object_;
  PhysicsAnswer result_;
};

}  // namespace

PhysicsAnswer ReadPhysicsAnswer(std::string_view answer) {
  return AnswerReading().Read(answer);
}

const ObjectAnswer* FindObject(const PhysicsAnswer& answer, std::string_view name) {
  const std::string wanted = NormaliseName(name);
  const auto first = [&](const auto& fits) -> const ObjectAnswer* {
    const auto found = std::find_if(answer.objects.begin(), answer.objects.end(), fits);
    return found == answer.objects.end() ? nullptr : &*found;
  };
  if (const ObjectAnswer* same = first([&](const auto& o) { return o.name == wanted; })) {
    return same;
  }
  const ObjectAnswer* near = first([&](const ObjectAnswer& o) {
    return !o.name.empty() &&
           (o.name.find(wanted) != std::string::npos || wanted.find(o.name) != std::string::npos);
  });
  if (near != nullptr) return near;
  return answer.objects.size() == 1 ? &answer.objects[0] : nullptr;
}

}  // namespace simwright::physics_params
