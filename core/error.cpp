#include "core/error.h"

namespace simwright::core {
namespace {

std::string ErrorLine(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return text;
}

std::string Compose(const std::string& what, const std::string& where, const std::string& remedy) {
  std::string message = where.empty() ? what : where + ": " + what;
  if (!remedy.empty()) message += " (" + remedy + ")";
  return ErrorLine(message);
}

}  // namespace

Error::Error(const std::string& what, const std::string& where, const std::string& remedy)
    : std::runtime_error(Compose(what, where, remedy)), where_(where) {}

}  // namespace simwright::core
