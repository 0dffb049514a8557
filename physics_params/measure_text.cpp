#include "physics_params/measure_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>

namespace simwright::physics_params {
namespace {

constexpr double kPound = 0.45359237, kOunce = kPound / 16.0;  // kg
constexpr double kInch = 0.0254, kFoot = 0.3048;               // m

bool IsMeasureDigit(char c) {
  return c >= '0' && c <= '9';
}
bool IsUnitLetter(char c) {
  return c >= 'a' && c <= 'z';
}

// A number with its unit.
struct NumberIn {
  std::size_t begin, end;
  double value;
  bool minus;  // a '-' before it: a sign, unless it joins two numbers
  std::optional<Unit> unit;
};

std::string_view TrimmedMeasure(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::string_view WordAt(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && IsUnitLetter(text[end])) ++end;
  return text.substr(at, end - at);
}

// Reads digits with a decimal point, an exponent, and commas as `comma` says. Returns the end.
std::size_t NumberEnd(std::string_view text, std::size_t at, Comma comma, std::string* digits) {
  const auto digits_from = [&](std::size_t from) {
    std::size_t end = from;
    while (end < text.size() && IsMeasureDigit(text[end])) ++end;
    return end - from;
  };
  bool point = false;
  while (at < text.size()) {
    if (IsMeasureDigit(text[at])) {
      *digits += text[at++];
      continue;
    }
    const std::size_t behind = digits_from(at + 1);
    const bool thousands = text[at] == ',' && comma == Comma::kThousands && behind == 3 && !point &&
                           !digits->empty() && *digits != "0";
    const bool decimal = comma == Comma::kDecimal && text[at] == ',' && behind > 0;
    if (thousands) {
      ++at;
    } else if (!point && behind > 0 && (text[at] == '.' || decimal)) {
      point = true;
      *digits += '.';
      ++at;
    } else {
      break;
    }
  }
  if (at + 1 < text.size() && text[at] == 'e' && digits_from(at + 1) > 0) {
    const std::size_t count = digits_from(at + 1);
    *digits += text.substr(at, count + 1);
    at += count + 1;
  }
  return at;
}

// Returns true if "in" is a preposition: "10 in" is ten inches; "10 in height" and "in grams" are
// not.
bool IsPreposition(std::string_view text, std::size_t behind) {
  const std::size_t next = text.find_first_not_of(' ', behind);
  if (next == std::string_view::npos) return false;
  constexpr std::array kOthers = {"length", "width",  "height", "diameter", "depth",
                                  "mass",   "weight", "size",   "total",    "the"};
  const std::string_view word = WordAt(text, next);
  return std::find(kOthers.begin(), kOthers.end(), word) != kOthers.end() ||
         FindUnit(word).has_value();
}

void ReadUnit(std::string_view text, NumberIn* number) {
  const std::size_t at = text.find_first_not_of(' ', number->end);
  if (at == std::string_view::npos || at > number->end + 2) return;
  if (text[at] == '"' && at == number->end) {
    number->unit = Unit{Dimension::kLength, kInch};
    number->end = at + 1;
    return;
  }
  const std::string_view word = WordAt(text, at);
  number->unit = FindUnit(word);
  if (word == "in" && IsPreposition(text, at + 2)) number->unit.reset();
  if (number->unit) number->end = at + word.size();
}

std::vector<NumberIn> ReadNumbers(std::string_view text, Comma comma) {
  std::vector<NumberIn> numbers;
  for (std::size_t at = 0; at < text.size();) {
    if (IsUnitLetter(text[at])) {
      // A word; 'x' may be between numbers.
      const bool cross = text[at] == 'x' && WordAt(text, at).size() == 1;
      ++at;
      if (!cross) {
        while (at < text.size() && (IsUnitLetter(text[at]) || IsMeasureDigit(text[at]))) ++at;
      }
      continue;
    }
    const bool begins = IsMeasureDigit(text[at]) ||
                        (text[at] == '.' && at + 1 < text.size() && IsMeasureDigit(text[at + 1]));
    if (!begins) {
      ++at;
      continue;
    }
    std::string digits;
    NumberIn number{at, at, 0.0, at > 0 && text[at - 1] == '-', std::nullopt};
    number.end = NumberEnd(text, at, comma, &digits);
    const auto [end, code] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number.value);
    at = number.end;
    if (code != std::errc() || end != digits.data() + digits.size()) continue;
    ReadUnit(text, &number);
    at = std::max(at, number.end);
    numbers.push_back(number);
  }
  return numbers;
}

bool Joins(std::string_view text, const NumberIn& first, const NumberIn& second) {
  const std::string_view between = TrimmedMeasure(text.substr(first.end, second.begin - first.end));
  constexpr std::array kJoints = {"-", "--", "to", "~", "..", "...", "up to", "- about"};
  if (std::find(kJoints.begin(), kJoints.end(), between) != kJoints.end()) return true;
  const std::size_t before = text.substr(0, first.begin).rfind("between");
  return between == "and" && before != std::string_view::npos && first.begin - before < 24;
}

}  // namespace

std::optional<Unit> FindUnit(std::string_view word) {
  static const std::map<std::string, Unit, std::less<>> units = [] {
    std::map<std::string, Unit, std::less<>> table;
    const auto add = [&](Dimension dimension, double factor,
                         std::initializer_list<const char*> names) {
      for (const char* name : names) table[name] = {dimension, factor};
    };
    add(Dimension::kMass, 1e-6, {"mg", "milligram", "milligrams"});
    add(Dimension::kMass, 1e-3, {"g", "gm", "gms", "gr", "gram", "grams", "gramme", "grammes"});
    add(Dimension::kMass, 1.0, {"kg", "kgs", "kilo", "kilos", "kilogram", "kilograms"});
    add(Dimension::kMass, 1e3, {"tonne", "tonnes"});
    add(Dimension::kMass, kPound, {"lb", "lbs", "pound", "pounds"});
    add(Dimension::kMass, kOunce, {"oz", "ounce", "ounces"});
    add(Dimension::kLength, 1e-3, {"mm", "millimeter", "millimeters", "millimetre", "millimetres"});
    add(Dimension::kLength, 1e-2,
        {"cm", "cms", "centimeter", "centimeters", "centimetre", "centimetres"});
    add(Dimension::kLength, 0.1, {"dm", "decimeter", "decimeters", "decimetre", "decimetres"});
    add(Dimension::kLength, 1.0, {"m", "meter", "meters", "metre", "metres"});
    add(Dimension::kLength, kInch, {"in", "inch", "inches"});
    add(Dimension::kLength, kFoot, {"ft", "foot", "feet"});
    return table;
  }();
  const auto found = units.find(word);
  return found == units.end() ? std::nullopt : std::optional<Unit>(found->second);
}

std::vector<TextRange> ReadRanges(std::string_view text, Comma comma) {
  const std::vector<NumberIn> numbers = ReadNumbers(text, comma);
  std::vector<TextRange> ranges;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const NumberIn& first = numbers[i];
    const double low = first.minus ? -first.value : first.value;
    TextRange range{first.begin, first.end, {low, low}, first.unit};
    if (i + 1 < numbers.size()) {
      const NumberIn& second = numbers[i + 1];
      const bool spread = TrimmedMeasure(text.substr(first.end, second.begin - first.end)) == "+/-";
      if (spread || Joins(text, first, second)) {
        // "200 g - 0.3 kg": convert the first number to the second's unit.
        double from = low;
        if (first.unit && second.unit) from *= first.unit->factor / second.unit->factor;
        range.unit = second.unit ? second.unit : first.unit;
        range.value = spread ? Interval{from - second.value, from + second.value}
                             : Interval{from, second.value};
        range.end = second.end;
        ++i;
      }
    }
    ranges.push_back(range);
  }
  return ranges;
}

std::string PlainText(std::string_view text) {
  static constexpr std::array<std::array<const char*, 2>, 16> kReplacements = {{{"\u2010", "-"},
                                                                                {"\u2011", "-"},
                                                                                {"\u2012", "-"},
                                                                                {"\u2013", "-"},
                                                                                {"\u2014", "-"},
                                                                                {"\u2015", "-"},
                                                                                {"\u2212", "-"},
                                                                                {"\u00d7", "x"},
                                                                                {"\u00b1", "+/-"},
                                                                                {"\u00a0", " "},
                                                                                {"\u2009", " "},
                                                                                {"\u202f", " "},
                                                                                {"\u2248", " "},
                                                                                {"\u2033", "\""},
                                                                                {"\u201c", "\""},
                                                                                {"\u201d", "\""}}};
  std::string plain;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80) {
      const char lower = static_cast<char>(std::tolower(byte));
      const bool blank = byte < 0x20 || lower == '*' || lower == '`';
      plain += blank ? ' ' : lower;
      ++i;
      continue;
    }
    const auto found =
        std::find_if(kReplacements.begin(), kReplacements.end(),
                     [&](const auto& entry) { return text.substr(i).starts_with(entry[0]); });
    if (found != kReplacements.end()) {
      plain += (*found)[1];
      i += std::string_view((*found)[0]).size();
    } else {
      plain += text[i++];
    }
  }
  return plain;
}

}  // namespace simwright::physics_params
