#pragma once

#include <CLI/CLI.hpp>

namespace simwright::cli {

// Accepts a finite number above 0. Its message names the bound; CLI::PositiveNumber prints the
// smallest and the largest double instead.
CLI::Validator Positive();

}  // namespace simwright::cli
