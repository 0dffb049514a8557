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

}  // namespace simwright::cli
