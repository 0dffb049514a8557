#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

// The one door to JSON: every module reads and writes it through this header.
namespace simwright::core {

// A JSON value whose objects sort their members by key: for reading, and for formats written so.
using Json = nlohmann::json;
// A JSON value whose objects keep the order in which members were added: for writing.
using OrderedJson = nlohmann::ordered_json;

// The deepest nesting of arrays and objects that is read. No format needs more, and writing out a
// value of any depth would exhaust the stack.
constexpr int kMaxJsonDepth = 64;

// Parses `text`. Returns nothing if it is not JSON, has a number beyond the range of a double, or
// is nested too deeply, which `too_deep` (may be null) tells. `comments` accepts /* */ and //.
std::optional<Json> TryParseJson(std::string_view text, bool comments = false,
                                 bool* too_deep = nullptr);

// Parses the JSON of the file `file`, which messages name. Throws core::Error with the line and the
// column of the fault if it is invalid, and with `remedy` or, if that is empty, a general one.
Json ParseJson(std::string_view text, const std::string& file, const std::string& remedy = "");
OrderedJson ParseOrderedJson(std::string_view text, const std::string& file,
                             const std::string& remedy = "");

// The reaction of a writer to a text that is not UTF-8.
enum class InvalidUtf8 { kThrow, kReplace };

// Returns the text of a file: `indent` blanks per level and a final line break. Numbers have the
// fewest digits that read back as the same double; numbers that are not finite become null. Throws
// core::Error for a text that is not UTF-8, unless it is replaced by U+FFFD.
std::string JsonText(const Json& json, InvalidUtf8 invalid = InvalidUtf8::kThrow, int indent = 2);
std::string JsonText(const OrderedJson& json, InvalidUtf8 invalid = InvalidUtf8::kThrow,
                     int indent = 2);
// Returns the same in one line, without blanks and without a line break.
std::string JsonLine(const Json& json, InvalidUtf8 invalid = InvalidUtf8::kThrow);
std::string JsonLine(const OrderedJson& json, InvalidUtf8 invalid = InvalidUtf8::kThrow);

// Access to foreign JSON in which anything may be missing. Returns the member of an object; null if
// there is none or `json` is not an object.
const Json* FindMember(const Json& json, const char* name);
// Returns a member that is a string, else "".
std::string TextMember(const Json& json, const char* name);
// Returns a member that is a finite number, else `otherwise`.
double NumberMember(const Json& json, const char* name, double otherwise);

class JsonField;

// A document of our own formats, with the name of its file for messages.
class JsonDocument {
 public:
  // Parses `text` as ParseJson does. A `remedy` that is not empty ends every message about the
  // document, e.g. "make the asset again" for a file that nobody writes by hand.
  JsonDocument(std::string_view text, std::string file, std::string remedy = "");
  // Reads a file of at most `max_bytes`.
  static JsonDocument Read(const std::filesystem::path& file, std::uint64_t max_bytes,
                           std::string remedy = "");

  // Returns the outermost value, which refers to this document.
  JsonField root() const&;
  JsonField root() const&& = delete;
  const Json& json() const { return json_; }
  const std::string& file() const { return file_; }
  const std::string& remedy() const { return remedy_; }

 private:
  std::string file_, remedy_;
  Json json_;
};

// A value of a document with its path, e.g. "objects[3].mass". Accessors throw core::Error, which
// names the file, the path, the expected type and the value found, e.g. "scene.json:
// objects[3].mass: must be a number above 0, is "x"". Fields refer to their document.
class JsonField {
 public:
  JsonField(const JsonDocument& document, const Json& json, std::string path)
      : document_(&document), json_(&json), path_(std::move(path)) {}

  const Json& json() const { return *json_; }
  [[noreturn]] void Fail(const std::string& what, const std::string& remedy = "") const;
  // Fails with "must be `expected`, is ..." and the value.
  [[noreturn]] void FailAs(const std::string& expected) const;

  // Throws unless this is an object with all `required` members and no others but `optional` ones.
  void RequireMembers(std::initializer_list<const char*> required,
                      std::initializer_list<const char*> optional = {}) const;
  // Returns true if this is an object with the member.
  bool Has(const std::string& name) const;
  JsonField operator[](const std::string& name) const;  // throws if it is missing
  std::vector<std::pair<std::string, JsonField>> Members() const;
  std::vector<JsonField> Elements() const;
  std::vector<JsonField> Elements(std::size_t count) const;  // throws for another number of them

  bool IsNull() const { return json_->is_null(); }
  bool Flag() const;
  std::string Text() const;
  std::string Name() const;  // a text of at most 200 bytes
  double Number() const;     // finite
  double PositiveNumber() const;
  double NumberWithin(double low, double high = std::numeric_limits<double>::infinity()) const;
  int Int(int low = std::numeric_limits<int>::min(),
          int high = std::numeric_limits<int>::max()) const;
  std::int64_t Integer() const;
  std::uint64_t Unsigned() const;
  std::vector<double> Numbers() const;
  std::vector<double> Numbers(std::size_t count) const;
  std::vector<int> Ints() const;
  std::vector<std::string> Texts() const;
  std::vector<std::string> Names() const;
  template <int kSize>
  Eigen::Matrix<double, kSize, 1> Vector() const {
    const std::vector<double> numbers = Numbers(kSize);
    return Eigen::Map<const Eigen::Matrix<double, kSize, 1>>(numbers.data());
  }

  // Return an optional member, or `otherwise` if this object does not have it.
  bool FlagOr(const char* name, bool otherwise) const;
  double NumberOr(const char* name, double otherwise) const;
  int IntOr(const char* name, int otherwise) const;
  std::string TextOr(const char* name, const std::string& otherwise) const;

 private:
  JsonField Element(std::size_t index) const;

  const JsonDocument* document_;
  const Json* json_;
  std::string path_;
};

}  // namespace simwright::core
