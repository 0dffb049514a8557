#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::assets {

// A column of a PLY element. Lists are concatenated: row i spans starts[i] to starts[i + 1].
struct PlyColumn {
  std::string name;
  std::string type;  // PLY type of its values: "uchar", "float" ...
  bool is_list = false;
  std::vector<double> values;     // one value per row, or the lists' values
  std::vector<size_t> starts{0};  // lists only: (rows + 1)
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

// Reads a PLY's header and all its rows: ascii, binary of either byte order. Throws core::Error,
// naming `where`, if the text is not a PLY, has an unknown type, or rows are missing or not
// numbers.
PlyTable ReadPlyTable(std::string_view bytes, const std::string& where);

}  // namespace simwright::assets
