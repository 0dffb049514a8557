#pragma once

#include <CLI/CLI.hpp>

namespace simwright::cli {

// Returns a validator that accepts a finite number above 0. Its message states the bound;
// CLI::PositiveNumber prints the smallest and the largest double instead.
CLI::Validator Positive();

// Returns a validator that accepts a whole number of at least 0. An option of an unsigned type
// accepts "-1" without it, as a very large number.
CLI::Validator WholeNumber();

}  // namespace simwright::cli
