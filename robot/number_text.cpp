#include "robot/number_text.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

namespace simwright::robot {

void AppendNumber(double value, std::string* text) {
  char buffer[40];
  const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  const std::string_view shortest(buffer, static_cast<std::size_t>(result.ptr - buffer));
  if (shortest.find('.') != std::string_view::npos) {
    *text += shortest;
    return;
  }
  const std::size_t exponent = shortest.find('e');
  *text += shortest.substr(0, exponent);
  *text += ".0";
  if (exponent != std::string_view::npos) *text += shortest.substr(exponent);
}

std::string DisplayText(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::optional<double> NumberFrom(std::string_view text) {
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<std::int64_t> IntegerFrom(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace simwright::robot
