#include "assets/ply_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>

#include "core/error.h"

namespace simwright::assets {
namespace {

enum class Layout { kAscii, kLittle, kBig };

// Returns the canonical name of a type that has an old and a new name.
std::string PlainType(const std::string& type) {
  static constexpr const char* kNames[][2] = {
      {"int8", "char"}, {"uint8", "uchar"}, {"int16", "short"},   {"uint16", "ushort"},
      {"int32", "int"}, {"uint32", "uint"}, {"float32", "float"}, {"float64", "double"}};
  for (const auto& [alias, plain] : kNames) {
    if (type == alias || type == plain) return plain;
  }
  return "";
}

size_t BytesOf(std::string_view type) {
  if (type == "char" || type == "uchar") return 1;
  if (type == "short" || type == "ushort") return 2;
  return type == "double" ? 8 : 4;
}

template <typename Value>
double PlyValueAs(const unsigned char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof(Value));
  return static_cast<double>(value);
}

double DecodePly(std::string_view type, const unsigned char* bytes) {
  if (type == "char") return PlyValueAs<std::int8_t>(bytes);
  if (type == "uchar") return PlyValueAs<std::uint8_t>(bytes);
  if (type == "short") return PlyValueAs<std::int16_t>(bytes);
  if (type == "ushort") return PlyValueAs<std::uint16_t>(bytes);
  if (type == "int") return PlyValueAs<std::int32_t>(bytes);
  if (type == "uint") return PlyValueAs<std::uint32_t>(bytes);
  return type == "float" ? PlyValueAs<float>(bytes) : PlyValueAs<double>(bytes);
}

struct CountType {
  std::string type;  // of the list's length; empty: not a list
};

class PlyTableReader {
 public:
  PlyTableReader(std::string_view bytes, const std::string& where) : rest_(bytes), where_(where) {}

  PlyTable Read() {
    ReadHeader();
    for (size_t e = 0; e < table_.elements.size(); ++e) ReadElement(e);
    return std::move(table_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what, const std::string& remedy) const {
    throw core::Error(what, where_, remedy);
  }
  [[noreturn]] void FailShort(const PlyElement& element, size_t row) const {
    Fail("the file ends in " + element.name + " " + std::to_string(row) + " of " +
             std::to_string(element.rows),
         "it was cut short: copy or export it again");
  }

  std::string TakeLine();
  void ReadHeader();
  void ReadProperty(std::istringstream* words);
  void ReadElement(size_t e);
  bool TakeValue(const std::string& type, double* value);

  std::string_view rest_;
  std::string where_;
  PlyTable table_;
  std::vector<std::vector<CountType>> counts_;  // per element and column
  Layout layout_ = Layout::kAscii;
};

std::string PlyTableReader::TakeLine() {
  const size_t end = std::min(rest_.find('\n'), rest_.size());
  std::string line(rest_.substr(0, end));
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  return line;
}

void PlyTableReader::ReadProperty(std::istringstream* words) {
  if (table_.elements.empty()) Fail("a property comes before any element", "export the file again");
  PlyColumn column;
  std::string type, count;
  *words >> type;
  column.is_list = type == "list";
  if (column.is_list) *words >> count >> type;
  *words >> column.name;
  column.type = PlainType(type);
  const std::string count_type = column.is_list ? PlainType(count) : "";
  if (column.name.empty() || column.type.empty() || (column.is_list && count_type.empty())) {
    Fail("a property's type is not known: '" + type + "'", "export the file again");
  }
  table_.elements.back().columns.push_back(column);
  counts_.back().push_back({count_type});
}

void PlyTableReader::ReadHeader() {
  if (TakeLine() != "ply") Fail("this is not a PLY file", "export it again");
  bool has_format = false;
  for (;;) {
    if (rest_.empty()) Fail("the header has no end", "it was cut short: copy or export it again");
    const std::string line = TakeLine();
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "end_header") break;
    if (keyword == "format") {
      std::string layout;
      words >> layout;
      has_format =
          layout == "ascii" || layout == "binary_little_endian" || layout == "binary_big_endian";
      layout_ = layout == "ascii"               ? Layout::kAscii
                : layout == "binary_big_endian" ? Layout::kBig
                                                : Layout::kLittle;
    } else if (keyword == "element") {
      PlyElement element;
      long long rows = -1;
      words >> element.name >> rows;
      if (rows < 0) Fail("the count of '" + element.name + "' is not a number", "export it again");
      element.rows = static_cast<size_t>(rows);
      table_.elements.push_back(element);
      counts_.emplace_back();
    } else if (keyword == "property") {
      ReadProperty(&words);
    } else if (keyword == "comment" || keyword == "obj_info") {
      table_.comments.push_back(line.substr(std::min(keyword.size() + 1, line.size())));
    }
  }
  if (!has_format) Fail("the header names no known format", "export it as binary PLY");
}

bool PlyTableReader::TakeValue(const std::string& type, double* value) {
  if (layout_ == Layout::kAscii) {
    const size_t start = rest_.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos) return false;
    rest_.remove_prefix(start);
    if (rest_.front() == '+') rest_.remove_prefix(1);
    const auto [end, code] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), *value);
    if (code != std::errc() && code != std::errc::result_out_of_range) {
      Fail("'" + std::string(rest_.substr(0, 20)) + "' is not a number", "export the file again");
    }
    rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
    return true;
  }
  const size_t size = BytesOf(type);
  if (rest_.size() < size) return false;
  unsigned char bytes[8];
  std::memcpy(bytes, rest_.data(), size);
  if (layout_ == Layout::kBig) std::reverse(bytes, bytes + size);
  *value = DecodePly(type, bytes);
  rest_.remove_prefix(size);
  return true;
}

void PlyTableReader::ReadElement(size_t e) {
  PlyElement& element = table_.elements[e];
  if (element.columns.empty() && element.rows > 0) return;
  // A row takes at least one byte: a row count above the byte count is forged and is rejected
  // before memory is allocated.
  if (element.rows > rest_.size()) FailShort(element, 0);
  for (size_t row = 0; row < element.rows; ++row) {
    for (size_t c = 0; c < element.columns.size(); ++c) {
      PlyColumn& column = element.columns[c];
      double value = 0.0;
      if (!column.is_list) {
        if (!TakeValue(column.type, &value)) FailShort(element, row);
        column.values.push_back(value);
        continue;
      }
      if (!TakeValue(counts_[e][c].type, &value)) FailShort(element, row);
      if (!(value >= 0.0) || value > static_cast<double>(rest_.size())) FailShort(element, row);
      for (size_t i = static_cast<size_t>(value); i > 0; --i) {
        if (!TakeValue(column.type, &value)) FailShort(element, row);
        column.values.push_back(value);
      }
      column.starts.push_back(column.values.size());
    }
  }
}

}  // namespace

const PlyColumn* PlyElement::Find(std::string_view column) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == column; });
  return found == columns.end() ? nullptr : &*found;
}

const PlyElement* PlyTable::Find(std::string_view element) const {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const auto& e) { return e.name == element; });
  return found == elements.end() ? nullptr : &*found;
}

PlyTable ReadPlyTable(std::string_view bytes, const std::string& where) {
  return PlyTableReader(bytes, where).Read();
}

}  // namespace simwright::assets
