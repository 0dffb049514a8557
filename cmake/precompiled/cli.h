#pragma once

// Precompiled for the program: each subcommand parses its flags with CLI11 and prints JSON.
#include "cmake/precompiled/standard.h"

#include <CLI/CLI.hpp>

#include "core/json.h"
