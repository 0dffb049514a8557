#include "physics_params/rounded_text.h"

#include <cstdio>

namespace simwright::physics_params {

std::string RoundedText(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value);
  return text;
}

}  // namespace simwright::physics_params
