#include "core/json.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_text.h"

namespace simwright::core {
namespace {

constexpr std::size_t kLongestName = 200;       // bytes
constexpr std::size_t kLongestShownKey = 40;    // bytes, in messages
constexpr std::size_t kLongestShownValue = 60;  // bytes
constexpr std::size_t kMostShownElements = 8;

std::size_t EndOfString(std::string_view text, std::size_t begin) {
  for (std::size_t i = begin + 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      return i;
    }
  }
  return text.size();
}

// Returns the last character of the comment that begins at `begin`; `begin` if none does.
std::size_t EndOfComment(std::string_view text, std::size_t begin) {
  constexpr std::string_view kLineEnds("\n\r\0", 3);
  const std::string_view opening = text.substr(begin, 2);
  if (opening == "//") return std::min(text.find_first_of(kLineEnds, begin), text.size());
  if (opening != "/*") return begin;
  const std::size_t end = text.find("*/", begin + 2);
  return end == std::string_view::npos ? text.size() : end + 1;
}

// Returns the length of the longest beginning of `text` that is nested at most kMaxJsonDepth
// levels. It is measured before parsing, because a parser would build any depth.
std::size_t LengthWithinDepth(std::string_view text, bool comments) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      i = EndOfString(text, i);
    } else if (c == '/' && comments) {
      i = EndOfComment(text, i);
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxJsonDepth) return i;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return text.size();
}

// A listener of the parser that keeps the position of the first fault.
class FaultFinder : public Json::json_sax_t {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t position, const std::string& last_token,
                   const Json::exception& error) override {
    constexpr int kNumberOverflow = 406;
    huge_number_ = error.id == kNumberOverflow && !last_token.empty();
    bytes_read_ = huge_number_ ? position + 1 - std::min(position, last_token.size()) : position;
    return false;
  }

  bool huge_number() const { return huge_number_; }
  // Returns the number of bytes up to and including the first wrong one; one more than the text has
  // if it ends too early.
  std::size_t bytes_read() const { return bytes_read_; }

 private:
  bool huge_number_ = false;
  std::size_t bytes_read_ = 0;
};

FaultFinder FindFault(std::string_view text, bool comments) {
  FaultFinder finder;
  Json::sax_parse(text, &finder, Json::input_format_t::json, true, comments);
  return finder;
}

// Returns "line L, column C" of the byte `at`; columns are counted in bytes, from 1.
std::string LineAndColumn(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const std::size_t line_break = before.rfind('\n');
  const std::size_t column =
      line_break == std::string_view::npos ? before.size() : before.size() - line_break - 1;
  return "line " + std::to_string(1 + std::count(before.begin(), before.end(), '\n')) +
         ", column " + std::to_string(column + 1);
}

[[noreturn]] void FailToParse(std::string_view text, std::size_t within_depth,
                              const std::string& file, const std::string& remedy) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    throw Error("is empty, where JSON was expected", file, remedy);
  }
  const FaultFinder fault = FindFault(text.substr(0, within_depth), false);
  const bool ends_early = fault.bytes_read() > within_depth;
  std::size_t at = std::max<std::size_t>(fault.bytes_read(), 1) - 1;
  std::string what = fault.huge_number() ? "has a number that is too large" : "is invalid";
  std::string usual_remedy = "correct it there";
  if (ends_early && within_depth < text.size()) {
    at = within_depth;
    what = "is nested deeper than " + std::to_string(kMaxJsonDepth) + " levels";
    usual_remedy = "";
  } else if (ends_early) {
    at = text.size();
    what = "ends too early,";
    usual_remedy = "the file is truncated, write it again";
  }
  throw Error("the JSON " + what + " at " + LineAndColumn(text, at), file,
              remedy.empty() ? usual_remedy : remedy);
}

template <typename AnyJson>
AnyJson Parse(std::string_view text, const std::string& file, const std::string& remedy) {
  const std::size_t within_depth = LengthWithinDepth(text, false);
  if (within_depth == text.size()) {
    AnyJson json = AnyJson::parse(text, nullptr, false);
    if (!json.is_discarded()) return json;
  }
  FailToParse(text, within_depth, file, remedy);
}

template <typename AnyJson>
std::string Dump(const AnyJson& json, InvalidUtf8 invalid, int indent) {
  using Handler = typename AnyJson::error_handler_t;
  try {
    return json.dump(indent, ' ', false,
                     invalid == InvalidUtf8::kReplace ? Handler::replace : Handler::strict);
  } catch (const typename AnyJson::exception&) {
    throw Error("a text that is not UTF-8 cannot be written as JSON");
  }
}

// Describes a value in a message.
std::string Shown(const Json& json) {
  if (json.is_object()) return "an object";
  if (json.is_string()) {
    const std::string& text = json.get_ref<const std::string&>();
    return JsonLine(Json(Truncated(text, kLongestShownValue)), InvalidUtf8::kReplace);
  }
  if (!json.is_array()) return JsonLine(json);
  const bool is_short = json.size() <= kMostShownElements &&
                        std::none_of(json.begin(), json.end(), [](const Json& element) {
                          return element.is_structured() || element.is_string();
                        });
  return is_short ? JsonLine(json) : "an array of " + std::to_string(json.size());
}

bool IsNamed(std::initializer_list<const char*> names, const std::string& wanted) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return wanted == name; });
}

std::string NumberShown(double number) {
  return JsonLine(Json(number));
}

}  // namespace

std::optional<Json> TryParseJson(std::string_view text, bool comments, bool* too_deep) {
  const std::size_t within_depth = LengthWithinDepth(text, comments);
  if (too_deep != nullptr) {
    *too_deep = within_depth < text.size() &&
                FindFault(text.substr(0, within_depth), comments).bytes_read() > within_depth;
  }
  if (within_depth < text.size()) return std::nullopt;
  Json json = Json::parse(text, nullptr, false, comments);
  if (json.is_discarded()) return std::nullopt;
  return std::optional<Json>(std::in_place, std::move(json));
}

Json ParseJson(std::string_view text, const std::string& file, const std::string& remedy) {
  return Parse<Json>(text, file, remedy);
}

OrderedJson ParseOrderedJson(std::string_view text, const std::string& file,
                             const std::string& remedy) {
  return Parse<OrderedJson>(text, file, remedy);
}

std::string JsonText(const Json& json, InvalidUtf8 invalid, int indent) {
  return Dump(json, invalid, indent) + "\n";
}

std::string JsonText(const OrderedJson& json, InvalidUtf8 invalid, int indent) {
  return Dump(json, invalid, indent) + "\n";
}

std::string JsonLine(const Json& json, InvalidUtf8 invalid) {
  return Dump(json, invalid, -1);
}

std::string JsonLine(const OrderedJson& json, InvalidUtf8 invalid) {
  return Dump(json, invalid, -1);
}

const Json* FindMember(const Json& json, const char* name) {
  if (!json.is_object()) return nullptr;
  const auto found = json.find(name);
  return found == json.end() ? nullptr : &*found;
}

std::string TextMember(const Json& json, const char* name) {
  const Json* member = FindMember(json, name);
  return member != nullptr && member->is_string() ? member->get<std::string>() : "";
}

double NumberMember(const Json& json, const char* name, double otherwise) {
  const Json* member = FindMember(json, name);
  if (member == nullptr || !member->is_number()) return otherwise;
  const double number = member->get<double>();
  return std::isfinite(number) ? number : otherwise;
}

JsonDocument::JsonDocument(std::string_view text, std::string file, std::string remedy)
    : file_(std::move(file)), remedy_(std::move(remedy)), json_(ParseJson(text, file_, remedy_)) {}

JsonDocument JsonDocument::Read(const std::filesystem::path& file, std::uint64_t max_bytes,
                                std::string remedy) {
  return JsonDocument(ReadFile(file, max_bytes), file.string(), std::move(remedy));
}

JsonField JsonDocument::root() const& {
  return JsonField(*this, json_, "");
}

void JsonField::Fail(const std::string& what, const std::string& remedy) const {
  const std::string& file = document_->file();
  throw Error(what, file.empty() || path_.empty() ? file + path_ : file + ": " + path_,
              document_->remedy().empty() ? remedy : document_->remedy());
}

void JsonField::FailAs(const std::string& expected) const {
  Fail("must be " + expected + ", is " + Shown(*json_));
}

void JsonField::RequireMembers(std::initializer_list<const char*> required,
                               std::initializer_list<const char*> optional) const {
  if (!json_->is_object()) FailAs("an object");
  for (const auto& member : json_->items()) {
    const std::string& key = member.key();
    if (IsNamed(required, key) || IsNamed(optional, key)) continue;
    Fail("'" + Truncated(key, kLongestShownKey) + "' is not a known member", "remove it");
  }
  for (const char* name : required) {
    if (!json_->contains(name)) Fail(std::string("'") + name + "' is missing", "add it");
  }
}

bool JsonField::Has(const std::string& name) const {
  return json_->is_object() && json_->contains(name);
}

JsonField JsonField::operator[](const std::string& name) const {
  if (!json_->is_object()) FailAs("an object");
  const auto found = json_->find(name);
  if (found == json_->end()) Fail("'" + name + "' is missing", "add it");
  return JsonField(*document_, *found, path_.empty() ? name : path_ + "." + name);
}

std::vector<std::pair<std::string, JsonField>> JsonField::Members() const {
  if (!json_->is_object()) FailAs("an object");
  std::vector<std::pair<std::string, JsonField>> members;
  for (const auto& member : json_->items()) {
    const std::string shown = Truncated(member.key(), kLongestName);
    members.emplace_back(member.key(), JsonField(*document_, member.value(),
                                                 path_.empty() ? shown : path_ + "." + shown));
  }
  return members;
}

JsonField JsonField::Element(std::size_t index) const {
  return JsonField(*document_, (*json_)[index], path_ + "[" + std::to_string(index) + "]");
}

std::vector<JsonField> JsonField::Elements() const {
  if (!json_->is_array()) FailAs("an array");
  std::vector<JsonField> elements;
  elements.reserve(json_->size());
  for (std::size_t i = 0; i < json_->size(); ++i) elements.push_back(Element(i));
  return elements;
}

std::vector<JsonField> JsonField::Elements(std::size_t count) const {
  if (!json_->is_array() || json_->size() != count) FailAs("an array of " + std::to_string(count));
  return Elements();
}

bool JsonField::Flag() const {
  if (!json_->is_boolean()) FailAs("true or false");
  return json_->get<bool>();
}

std::string JsonField::Text() const {
  if (!json_->is_string()) FailAs("a string");
  return json_->get<std::string>();
}

std::string JsonField::Name() const {
  std::string text = Text();
  if (text.size() > kLongestName) {
    Fail("the text is longer than " + std::to_string(kLongestName) + " bytes");
  }
  return text;
}

double JsonField::Number() const {
  const double number = json_->is_number() ? json_->get<double>() : std::nan("");
  if (!std::isfinite(number)) FailAs("a number");
  return number;
}

double JsonField::PositiveNumber() const {
  const double number = json_->is_number() ? json_->get<double>() : std::nan("");
  if (!(std::isfinite(number) && number > 0.0)) FailAs("a number above 0");
  return number;
}

double JsonField::NumberWithin(double low, double high) const {
  const double number = json_->is_number() ? json_->get<double>() : std::nan("");
  if (std::isfinite(number) && low <= number && number <= high) return number;
  FailAs(std::isfinite(high) ? "a number from " + NumberShown(low) + " to " + NumberShown(high)
                             : "a number of at least " + NumberShown(low));
}

int JsonField::Int(int low, int high) const {
  if (!json_->is_number_integer()) FailAs("an integer");
  const bool is_huge = json_->is_number_unsigned() && json_->get<std::uint64_t>() > INT64_MAX;
  const std::int64_t number = is_huge ? INT64_MAX : json_->get<std::int64_t>();
  if (number < low || number > high) {
    FailAs("an integer from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return static_cast<int>(number);
}

std::int64_t JsonField::Integer() const {
  // An unsigned number above the signed range would convert to a negative one.
  if (!json_->is_number_integer() ||
      (json_->is_number_unsigned() && json_->get<std::uint64_t>() > INT64_MAX)) {
    FailAs("an integer");
  }
  return json_->get<std::int64_t>();
}

std::uint64_t JsonField::Unsigned() const {
  if (!json_->is_number_unsigned()) FailAs("an integer of at least 0");
  return json_->get<std::uint64_t>();
}

// Paths are only built for errors: a trajectory holds millions of numbers.
std::vector<double> JsonField::Numbers() const {
  if (!json_->is_array()) FailAs("an array of numbers");
  std::vector<double> numbers;
  numbers.reserve(json_->size());
  for (std::size_t i = 0; i < json_->size(); ++i) {
    const Json& element = (*json_)[i];
    const double number = element.is_number() ? element.get<double>() : std::nan("");
    numbers.push_back(std::isfinite(number) ? number : Element(i).Number());
  }
  return numbers;
}

std::vector<double> JsonField::Numbers(std::size_t count) const {
  if (!json_->is_array() || json_->size() != count) {
    FailAs("an array of " + std::to_string(count) + " numbers");
  }
  return Numbers();
}

std::vector<int> JsonField::Ints() const {
  std::vector<int> numbers;
  for (const JsonField& element : Elements()) numbers.push_back(element.Int());
  return numbers;
}

std::vector<std::string> JsonField::Texts() const {
  std::vector<std::string> texts;
  for (const JsonField& element : Elements()) texts.push_back(element.Text());
  return texts;
}

std::vector<std::string> JsonField::Names() const {
  std::vector<std::string> names;
  for (const JsonField& element : Elements()) names.push_back(element.Name());
  return names;
}

bool JsonField::FlagOr(const char* name, bool otherwise) const {
  return Has(name) ? (*this)[name].Flag() : otherwise;
}

double JsonField::NumberOr(const char* name, double otherwise) const {
  return Has(name) ? (*this)[name].Number() : otherwise;
}

int JsonField::IntOr(const char* name, int otherwise) const {
  return Has(name) ? (*this)[name].Int() : otherwise;
}

std::string JsonField::TextOr(const char* name, const std::string& otherwise) const {
  return Has(name) ? (*this)[name].Text() : otherwise;
}

}  // namespace simwright::core
