#pragma once

#include <CLI/CLI.hpp>

namespace simwright::cli {

// Returns a validator that accepts a finite number above 0. Its message states the bound;
// CLI::PositiveNumber prints the smallest and the largest double instead.
CLI::Validator Positive();

}  // namespace simwright::cli
