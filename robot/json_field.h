#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace simwright::robot {

// A value of a JSON file with its location. Every accessor throws core::Error, naming the file and
// the location, if the value does not have the requested type. Holds references to the document and
// to the file name.
class JsonField {
 public:
  JsonField(const nlohmann::json& json, std::string place, const std::string& file)
      : json_(json), place_(std::move(place)), file_(file) {}

  [[noreturn]] void Fail(const std::string& what, const std::string& remedy = "") const;

  // Throws unless this is an object with all `required` members and no others but `optional` ones.
  void RequireMembers(std::initializer_list<const char*> required,
                      std::initializer_list<const char*> optional = {}) const;
  bool Has(const std::string& name) const;
  JsonField operator[](const std::string& name) const;  // requires Has(name)
  std::vector<std::pair<std::string, JsonField>> Members() const;
  std::vector<JsonField> Elements() const;

  std::string Text() const;  // at most 200 bytes
  double Number() const;     // finite
  double PositiveNumber() const;
  std::int64_t Integer() const;
  std::vector<double> Numbers() const;
  std::vector<std::string> Texts() const;

 private:
  const nlohmann::json& json_;
  std::string place_;
  const std::string& file_;
};

// Returns the JSON document in `text`. Throws core::Error if it is invalid: truncated, NaN, or with
// numbers that are too large.
nlohmann::json ParseJson(const std::string& text, const std::string& file);

}  // namespace simwright::robot
