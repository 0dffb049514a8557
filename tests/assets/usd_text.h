#pragma once

#include <cmath>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace simwright::assets {

// Returns the text of the prim `name`, without its own name, up to its closing brace.
inline std::string PrimText(const std::string& text, const std::string& name) {
  const size_t begin = text.find(" \"" + name + "\"");
  if (begin == std::string::npos) return "";
  const size_t line = text.rfind('\n', begin) + 1;
  const std::string indent(text.find_first_not_of(' ', line) - line, ' ');
  return text.substr(begin, text.find("\n" + indent + "}\n", begin) - begin);
}

// Returns the numbers of a property's value: those of the first line that has `property`.
inline std::vector<double> NumbersOf(const std::string& text, const std::string& property) {
  const size_t begin = text.find(property + " = ");
  if (begin == std::string::npos) return {};
  const std::string line = text.substr(begin + property.size() + 3,
                                       text.find('\n', begin) - begin - property.size() - 3);
  const std::regex number("[-+]?[0-9][-+.e0-9]*");
  std::vector<double> numbers;
  for (std::sregex_iterator it(line.begin(), line.end(), number), end; it != end; ++it) {
    numbers.push_back(std::strtod(it->str().c_str(), nullptr));
  }
  return numbers;
}

inline Eigen::Vector3d VectorOf(const std::string& text, const std::string& property) {
  const std::vector<double> n = NumbersOf(text, property);
  return n.size() == 3 ? Eigen::Vector3d(n[0], n[1], n[2]) : Eigen::Vector3d::Constant(NAN);
}

inline Eigen::Quaterniond RotationOf(const std::string& text, const std::string& property) {
  const std::vector<double> n = NumbersOf(text, property);
  return n.size() == 4 ? Eigen::Quaterniond(n[0], n[1], n[2], n[3])
                       : Eigen::Quaterniond(NAN, NAN, NAN, NAN);
}

inline double NumberOf(const std::string& text, const std::string& property) {
  const std::vector<double> n = NumbersOf(text, property);
  return n.size() == 1 ? n[0] : NAN;
}

}  // namespace simwright::assets
