#include "physics_params/knowledge_base.h"

#include <algorithm>
#include <charconv>
#include <map>

#include "core/error.h"

namespace simwright::physics_params {
namespace data {
std::string_view categories_txt();
std::string_view materials_txt();
std::string_view sources_txt();
std::string_view variants_txt();
}  // namespace data
namespace {

constexpr const char* kFillNames[] = {"solid", "hollow", "open", "frame"};
constexpr const char* kShapeNames[] = {"round", "revolved", "box", "flat", "long", "free"};
constexpr const char* kBasisNames[] = {"family", "objects"};
constexpr const char* kSizeClassNames[] = {"small", "medium", "large"};

std::vector<std::string> SplitColumns(std::string_view text, char separator) {
  std::vector<std::string> pieces;
  for (size_t start = 0;;) {
    const size_t end = text.find(separator, start);
    pieces.emplace_back(text.substr(start, end - start));
    if (end == std::string_view::npos) return pieces;
    start = end + 1;
  }
}

// A row of a table, with its location for errors.
struct Row {
  std::vector<std::string> cells;
  std::string where;

  [[noreturn]] void Fail(const std::string& what) const { throw core::Error(what, where); }
  Interval Range(size_t cell, double unit) const;
  template <size_t N>
  int Choice(size_t cell, const char* const (&names)[N]) const;
};

double ParseNumber(const Row& row, std::string_view text) {
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) {
    row.Fail("'" + std::string(text) + "' is not a number");
  }
  return value;
}

Interval Row::Range(size_t cell, double unit) const {
  const std::vector<std::string> ends = SplitColumns(cells[cell], '-');
  if (ends.size() != 2) Fail("'" + cells[cell] + "' is not a range such as 2-5");
  const Interval range{ParseNumber(*this, ends[0]) * unit, ParseNumber(*this, ends[1]) * unit};
  if (!(range.min > 0.0 && range.min <= range.max)) {
    Fail("'" + cells[cell] + "' is not a positive, ascending range");
  }
  return range;
}

template <size_t N>
int Row::Choice(size_t cell, const char* const (&names)[N]) const {
  for (size_t i = 0; i < N; ++i) {
    if (cells[cell] == names[i]) return static_cast<int>(i);
  }
  Fail("'" + cells[cell] + "' is not a known word");
}

std::vector<Row> Rows(std::string_view table, const std::string& name, size_t columns) {
  std::vector<Row> rows;
  int line_number = 0;
  for (const std::string& line : SplitColumns(table, '\n')) {
    ++line_number;
    if (line.empty() || line[0] == '#') continue;
    Row row{SplitColumns(line, '|'), name + " line " + std::to_string(line_number)};
    if (row.cells.size() != columns) {
      row.Fail("has " + std::to_string(row.cells.size()) + " columns instead of " +
               std::to_string(columns));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

template <typename T>
const T* FindNamed(const std::vector<T>& entries, std::string_view name) {
  const std::string wanted = NormaliseName(name);
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const T& entry) { return entry.name == wanted; });
  return found == entries.end() ? nullptr : &*found;
}

// Converts "std [EN 13698]" to the sentence of "std", with the note.
std::string SourceSentence(const Row& row, const std::string& cell,
                           const std::map<std::string, std::string>& sources) {
  const size_t blank = cell.find(' ');
  const auto found = sources.find(cell.substr(0, blank));
  if (found == sources.end()) row.Fail("'" + cell + "' is not a known source");
  return blank == std::string::npos ? found->second : found->second + cell.substr(blank);
}

}  // namespace

KnowledgeBase::KnowledgeBase(std::string_view categories, std::string_view materials,
                             std::string_view sources, std::string_view variants) {
  std::map<std::string, std::string> source_of;
  for (const Row& row : Rows(sources, "sources", 2)) source_of[row.cells[0]] = row.cells[1];
  for (const Row& row : Rows(materials, "materials", 5)) {
    materials_.push_back(
        {row.cells[0], row.Range(1, 1.0), row.Range(2, 1.0), row.Range(3, 1.0), row.cells[4]});
  }
  constexpr double kCentimetre = 0.01, kGram = 0.001;
  for (const Row& row : Rows(categories, "categories", 9)) {
    Category category;
    category.name = row.cells[0];
    category.length = row.Range(1, kCentimetre);
    category.width = row.Range(2, kCentimetre);
    category.height = row.Range(3, kCentimetre);
    category.mass = row.Range(4, kGram);
    category.materials = SplitColumns(row.cells[5], ',');
    for (const std::string& material : category.materials) {
      if (FindMaterial(material) == nullptr) row.Fail("unknown material '" + material + "'");
    }
    category.fill = static_cast<Fill>(row.Choice(6, kFillNames));
    category.shape = static_cast<Shape>(row.Choice(7, kShapeNames));
    category.source = SourceSentence(row, row.cells[8], source_of);
    if (FindCategory(category.name) != nullptr) row.Fail("the name is repeated");
    categories_.push_back(std::move(category));
  }
  ReadVariants(variants);
}

void KnowledgeBase::ReadVariants(std::string_view variants) {
  for (const Row& row : Rows(variants, "variants", 5)) {
    const auto owner = std::find_if(categories_.begin(), categories_.end(),
                                    [&](const Category& one) { return one.name == row.cells[0]; });
    if (owner == categories_.end()) row.Fail("unknown row '" + row.cells[0] + "'");
    Variant variant;
    variant.category = row.cells[1];
    if (FindCategory(variant.category) == nullptr) {
      row.Fail("unknown row '" + variant.category + "'");
    }
    variant.weight = ParseNumber(row, row.cells[2]);
    if (row.cells[3] != "-") variant.size_class = SizeClass{row.Choice(3, kSizeClassNames)};
    variant.from_objects = row.Choice(4, kBasisNames) == 1;
    owner->variants.push_back(std::move(variant));
    double total = 0.0;
    for (const Variant& one : owner->variants) total += one.weight;
    if (!(owner->variants.back().weight > 0.0 && total < 1.0)) {
      row.Fail("weights must be above 0, and below 1 in all");
    }
  }
}

const KnowledgeBase& KnowledgeBase::Shipped() {
  static const KnowledgeBase base(data::categories_txt(), data::materials_txt(),
                                  data::sources_txt(), data::variants_txt());
  return base;
}

const Category* KnowledgeBase::FindCategory(std::string_view name) const {
  return FindNamed(categories_, name);
}

const Material* KnowledgeBase::FindMaterial(std::string_view name) const {
  return FindNamed(materials_, name);
}

std::string NormaliseName(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const bool blank = c == '_' || c == '-' || std::isspace(static_cast<unsigned char>(c));
    if (!blank) {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!result.empty() && result.back() != ' ') {
      result += ' ';
    }
  }
  if (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

const char* FillName(Fill fill) {
  return kFillNames[static_cast<int>(fill)];
}
const char* ShapeName(Shape shape) {
  return kShapeNames[static_cast<int>(shape)];
}
const char* SizeClassName(SizeClass size_class) {
  return kSizeClassNames[static_cast<int>(size_class)];
}

SizeClass SizeClassOf(std::string_view name) {
  for (int i = 0; i < 3; ++i) {
    if (name == kSizeClassNames[i]) return SizeClass{i};
  }
  throw core::Error("unknown size class", std::string(name), "one of small, medium, large");
}

}  // namespace simwright::physics_params
