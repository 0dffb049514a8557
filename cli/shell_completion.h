#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace simwright::cli {

// The shells that ShellCompletion knows.
enum class Shell { kBash, kZsh, kFish };

// Returns a script that completes the subcommands of `app`, their options, the values of options
// with a fixed set of values, and else the names of files. bash and fish read it from their folders
// of completions, zsh from a folder of $fpath.
std::string ShellCompletion(const CLI::App& app, Shell shell);

}  // namespace simwright::cli
