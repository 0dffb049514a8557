#include "cli/number_validators.h"

#include <cmath>
#include <string>

namespace simwright::cli {

CLI::Validator Positive() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value > 0.0 && std::isfinite(value))
          return "";
        return "'" + text + "' has to be a number above 0";
      },
      "POSITIVE");
}

CLI::Validator WholeNumber() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        const bool digits = !text.empty() && text.find_first_not_of("0123456789") == text.npos;
        return digits ? "" : "'" + text + "' has to be a whole number of at least 0";
      },
      "WHOLE");
}

}  // namespace simwright::cli
