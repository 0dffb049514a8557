#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace simwright::cli {

constexpr int kWrongUsage = 2;

// Applies the settings of all subcommands: help shows each option's default, and a configuration
// file may only contain options of a subcommand. Call it before adding subcommands.
void PrepareApp(CLI::App* app);

// Returns the program's arguments with "--config FILE" moved to the front: it belongs to the
// program itself but may follow the subcommand as all other common flags do.
std::vector<std::string> ArgumentsOf(int argc, char** argv);

// Describes the fault of the arguments in one line: the unknown subcommand, option or configuration
// key with the nearest known one; else CLI11's message.
std::string Diagnosis(const CLI::App& app, const std::vector<std::string>& arguments,
                      const CLI::ParseError& error);

// Prints help, or "error: DIAGNOSIS" on stderr. Returns the exit code, 0 or kWrongUsage.
int ReportUsage(const CLI::App& app, const std::vector<std::string>& arguments,
                const CLI::ParseError& error);

// Adds an option whose value is one of `names`, which help lists.
CLI::Option* AddChoice(CLI::App* command, const std::string& option,
                       const std::vector<std::string>& names, const std::string& usual,
                       const std::string& description,
                       const std::function<void(const std::string&)>& take);

}  // namespace simwright::cli
