#include "robot/json_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/error.h"

namespace simwright::robot {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongestText = 200;

bool Contains(std::initializer_list<const char*> names, const std::string& wanted) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return wanted == name; });
}

}  // namespace

void JsonField::Fail(const std::string& what, const std::string& remedy) const {
  throw core::Error(what, file_ + (place_.empty() ? "" : ": " + place_), remedy);
}

void JsonField::RequireMembers(std::initializer_list<const char*> required,
                               std::initializer_list<const char*> optional) const {
  if (!json_.is_object()) Fail("must be an object");
  for (const auto& member : json_.items()) {
    const std::string& key = member.key();
    if (Contains(required, key) || Contains(optional, key)) continue;
    Fail("'" + key.substr(0, 40) + "' is not a known member", "remove it");
  }
  for (const char* name : required) {
    if (!json_.contains(name)) Fail(std::string("'") + name + "' is missing", "add it");
  }
}

bool JsonField::Has(const std::string& name) const {
  return json_.is_object() && json_.contains(name);
}

JsonField JsonField::operator[](const std::string& name) const {
  return JsonField(json_.at(name), place_.empty() ? name : place_ + "." + name, file_);
}

std::vector<std::pair<std::string, JsonField>> JsonField::Members() const {
  if (!json_.is_object()) Fail("must be an object");
  std::vector<std::pair<std::string, JsonField>> members;
  for (const auto& member : json_.items()) {
    const std::string shown = member.key().substr(0, kLongestText);
    members.emplace_back(
        shown, JsonField(member.value(), place_.empty() ? shown : place_ + "." + shown, file_));
  }
  return members;
}

std::vector<JsonField> JsonField::Elements() const {
  if (!json_.is_array()) Fail("must be an array");
  std::vector<JsonField> elements;
  elements.reserve(json_.size());
  for (std::size_t i = 0; i < json_.size(); ++i) {
    elements.emplace_back(json_[i], place_ + "[" + std::to_string(i) + "]", file_);
  }
  return elements;
}

std::string JsonField::Text() const {
  if (!json_.is_string()) Fail("must be a string");
  std::string text = json_.get<std::string>();
  if (text.size() > kLongestText) Fail("the text is longer than 200 bytes");
  return text;
}

double JsonField::Number() const {
  if (!json_.is_number()) Fail("must be a number");
  const double number = json_.get<double>();
  if (!std::isfinite(number)) Fail("the number is not finite");
  return number;
}

double JsonField::PositiveNumber() const {
  const double number = Number();
  if (!(number > 0.0)) Fail("must be above 0, is " + json_.dump());
  return number;
}

std::int64_t JsonField::Integer() const {
  // An unsigned number above the signed range would convert to a negative one.
  if (!json_.is_number_integer() ||
      (json_.is_number_unsigned() && json_.get<std::uint64_t>() > INT64_MAX)) {
    Fail("must be an integer");
  }
  return json_.get<std::int64_t>();
}

// Locations are only built for errors: a trajectory holds millions of numbers.
std::vector<double> JsonField::Numbers() const {
  if (!json_.is_array()) Fail("must be an array");
  std::vector<double> numbers;
  numbers.reserve(json_.size());
  for (std::size_t i = 0; i < json_.size(); ++i) {
    const double number = json_[i].is_number() ? json_[i].get<double>() : std::nan("");
    numbers.push_back(
        std::isfinite(number)
            ? number
            : JsonField(json_[i], place_ + "[" + std::to_string(i) + "]", file_).Number());
  }
  return numbers;
}

std::vector<std::string> JsonField::Texts() const {
  std::vector<std::string> texts;
  for (const JsonField& element : Elements()) texts.push_back(element.Text());
  return texts;
}

Json ParseJson(const std::string& text, const std::string& file) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw core::Error("invalid or truncated JSON at byte " + std::to_string(error.byte), file,
                      "correct the file there");
  } catch (const Json::exception& error) {
    throw core::Error(std::string("cannot parse JSON: ") + error.what(), file);
  }
}

}  // namespace simwright::robot
