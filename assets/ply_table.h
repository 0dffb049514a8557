#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::assets {

// One column of a PLY element. Lists lie end to end: row i's from starts[i] to starts[i + 1].
struct PlyColumn {
  std::string name;
  std::string type;                // of its values: "uchar", "float" ..., as PLY calls them
  bool is_list = false;
  std::vector<double> values;      // a value a row, or the lists'
  std::vector<size_t> starts{0};   // lists alone: (rows + 1)
};

struct PlyElement {
  std::string name;
  size_t rows = 0;
  std::vector<PlyColumn> columns;

  const PlyColumn* Find(std::string_view column) const;
};

struct PlyTable {
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;

  const PlyElement* Find(std::string_view element) const;
};

// A PLY's header and all its rows: ascii, binary of either byte order. Throws core::Error, naming
// `where`: no PLY, an unknown type, rows that are missing or not numbers.
PlyTable ReadPlyTable(std::string_view bytes, const std::string& where);

}  // namespace simwright::assets
