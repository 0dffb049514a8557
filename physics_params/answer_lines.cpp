#include "physics_params/answer_lines.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>

#include "core/json.h"
#include "llm/json_text.h"
#include "physics_params/measure_text.h"

namespace simwright::physics_params {
namespace {

using core::Json;

constexpr std::size_t kMostRead = 64u << 10;  // bytes; an answer has a few hundred
constexpr std::size_t kLongestName = 60;      // bytes

std::string TrimmedLine(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(kBlanks) - first + 1));
}

std::vector<std::string> SplitLines(std::string_view text, char separator) {
  std::vector<std::string> pieces;
  for (;;) {
    const std::size_t end = text.find(separator);
    pieces.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return pieces;
    text.remove_prefix(end + 1);
  }
}

bool HasDigit(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Returns true if a label names a quantity.
bool IsQuantity(std::string_view text) {
  constexpr std::array kWords = {"mass", "weight",   "length",   "width",     "height",   "depth",
                                 "size", "diameter", "material", "dimension", "l x w x h"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](const char* word) { return text.find(word) != std::string_view::npos; });
}

bool IsNamingLine(std::string_view label) {
  constexpr std::array kWords = {"object", "name", "item", "category", "thing", "product"};
  return std::find(kWords.begin(), kWords.end(), label) != kWords.end();
}

// Converts "mass_g" to "mass (g)" and "Height [cm]" to "height (cm)": the unit is then in brackets.
std::string Label(std::string_view key) {
  std::string label = PlainText(key);
  std::replace(label.begin(), label.end(), '_', ' ');
  std::replace(label.begin(), label.end(), '[', '(');
  std::replace(label.begin(), label.end(), ']', ')');
  std::replace(label.begin(), label.end(), ':', ' ');
  label = TrimmedLine(label);
  const std::size_t blank = label.rfind(' ');
  if (blank != std::string::npos && FindUnit(label.substr(blank + 1))) {
    label = label.substr(0, blank) + " (" + label.substr(blank + 1) + ")";
  }
  return label;
}

std::string NumberText(double value) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.15g", value);
  return text;
}

const Json* Member(const Json& object, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const auto found = object.find(name);
    if (found != object.end()) return &*found;
  }
  return nullptr;
}

// Returns a value as text, e.g. "200-300 g"; empty if it is a container of other values.
std::string ValueText(const Json& json) {
  if (json.is_number()) return NumberText(json.get<double>());
  if (json.is_string()) return PlainText(json.get<std::string>());
  if (json.is_array() && !json.empty()) {
    const bool range = json.size() == 2 && json[0].is_number() && json[1].is_number();
    std::string text;
    for (const Json& element : json) {
      const std::string piece = ValueText(element);
      if (piece.empty()) return "";
      text += (text.empty() ? "" : range ? " - " : ", ") + piece;
    }
    return text;
  }
  if (!json.is_object()) return "";
  const Json* low = Member(json, {"min", "minimum", "low", "lower", "from"});
  const Json* high = Member(json, {"max", "maximum", "high", "upper", "to"});
  const Json* single = Member(json, {"value", "average", "mean", "range", "typical"});
  const Json* unit = Member(json, {"unit", "units"});
  std::string text;
  if (low != nullptr && high != nullptr && low->is_primitive() && high->is_primitive()) {
    text = ValueText(*low) + " - " + ValueText(*high);
  } else if (single != nullptr && !single->is_object()) {
    text = ValueText(*single);
  }
  if (!text.empty() && unit != nullptr && unit->is_string()) text += " " + ValueText(*unit);
  return text;
}

// Converts JSON to lines. `above` is the label of the quantity that `json` is a part of: {"mass":
// {"grams": [1, 2]}}.
void JsonLines(const Json& json, const std::string& above, std::vector<std::string>* lines) {
  if (json.is_array()) {
    for (const Json& element : json) {
      // An empty name separates the unnamed objects of a list.
      if (element.is_object() && above.empty()) lines->push_back("object:");
      JsonLines(element, above, lines);
    }
    return;
  }
  if (!json.is_object()) return;
  // The name first, wherever it is among the members.
  for (const auto& [key, value] : json.items()) {
    if (IsNamingLine(Label(key)) && value.is_string())
      lines->push_back("object: " + ValueText(value));
  }
  for (const auto& [key, value] : json.items()) {
    const std::string label = Label(above.empty() ? key : above + " " + key);
    const std::string text = ValueText(value);
    if (!text.empty()) {
      if (!IsNamingLine(label)) lines->push_back(label + ": " + text);
    } else {
      const bool quantity = IsQuantity(label);
      if (value.is_object() && !quantity && !IsNamingLine(label))
        lines->push_back("object: " + label);
      JsonLines(value, quantity ? label : "", lines);
    }
  }
}

std::vector<std::string> Cells(const std::string& row) {
  std::string inner = TrimmedLine(row);
  if (inner.starts_with("|")) inner.erase(0, 1);
  if (inner.ends_with("|")) inner.pop_back();
  std::vector<std::string> cells = SplitLines(inner, '|');
  for (std::string& cell : cells) cell = TrimmedLine(cell);
  return cells;
}

bool IsRule(const std::string& row) {
  return row.find_first_not_of("|-: +=") == std::string::npos;
}

// Converts a table: one quantity per row ("mass | 200 g") or, under a header of labels, one object
// per row.
void TableLines(const std::vector<std::string>& rows, std::vector<std::string>* lines) {
  std::vector<std::string> head;
  for (const std::string& row : rows) {
    if (IsRule(row)) continue;
    const std::vector<std::string> cells = Cells(row);
    if (head.empty()) {
      for (const std::string& cell : cells) head.push_back(Label(cell));
      const auto labels = std::count_if(head.begin() + 1, head.end(),
                                        [](const std::string& cell) { return IsQuantity(cell); });
      if (labels > 0) continue;
      head.assign(1, "");  // no header: each row is a quantity
    }
    if (head.size() == 1) {
      std::string line = Label(cells[0]) + ":";
      for (std::size_t i = 1; i < cells.size(); ++i) line += (i == 1 ? " " : ", ") + cells[i];
      lines->push_back(line);
      continue;
    }
    if (!IsQuantity(head[0])) lines->push_back("object: " + cells[0]);
    for (std::size_t i = 0; i < std::min(cells.size(), head.size()); ++i) {
      if (IsQuantity(head[i])) lines->push_back(head[i] + ": " + cells[i]);
    }
  }
}

// Converts a heading, or a line that only names the next object, to "object: NAME". Removes list
// markers.
std::string ProseLine(const std::string& raw) {
  const std::string plain = TrimmedLine(PlainText(raw));
  const bool bold = TrimmedLine(raw).starts_with("**") && TrimmedLine(raw).ends_with("**");
  std::string line = plain;
  const bool heading = line.starts_with("#");
  line.erase(0, line.find_first_not_of("#> "));
  bool listed = false;
  if (line.starts_with("- ") || line.starts_with("+ ") || line.starts_with("\u2022")) {
    line = TrimmedLine(line.substr(line.starts_with("\u2022") ? 3 : 2));
  }
  const std::size_t digits = line.find_first_not_of("0123456789");
  if (digits > 0 && digits != std::string::npos && digits + 1 < line.size() &&
      (line[digits] == '.' || line[digits] == ')') && line[digits + 1] == ' ') {
    line = TrimmedLine(line.substr(digits + 1));
    listed = true;
  }
  const bool colon = line.ends_with(":");
  const std::string name = TrimmedLine(colon ? line.substr(0, line.size() - 1) : line);
  const bool names = (heading || bold || listed || colon) && !name.empty() &&
                     name.size() <= kLongestName && !HasDigit(name) && !IsQuantity(name) &&
                     name.find_first_of(":,;.!?") == std::string::npos;
  return names ? "object: " + name : line;
}

}  // namespace

std::vector<std::string> AnswerLines(std::string_view answer) {
  answer = answer.substr(0, kMostRead);
  std::vector<std::string> lines;
  for (const Json& json : llm::JsonInText(answer)) JsonLines(json, "", &lines);
  // Brackets in prose ("[approximate]") may parse as useless JSON; then read the prose.
  if (std::any_of(lines.begin(), lines.end(),
                  [](const std::string& line) { return IsQuantity(line) && HasDigit(line); })) {
    return lines;
  }
  lines.clear();
  std::vector<std::string> table;
  const auto end_table = [&] {
    if (!table.empty()) TableLines(table, &lines);
    table.clear();
  };
  for (const std::string& raw : SplitLines(answer, '\n')) {
    if (std::count(raw.begin(), raw.end(), '|') >= (table.empty() ? 2 : 1)) {
      table.push_back(PlainText(raw));
      continue;
    }
    end_table();
    const std::string line = ProseLine(raw);
    if (!line.empty()) lines.push_back(line);
  }
  end_table();
  return lines;
}

}  // namespace simwright::physics_params
