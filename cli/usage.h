#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace simwright::cli {

constexpr int kWrongUsage = 2;

// Settings that hold for all subcommands: help shows each option's default, and a configuration
// file may hold nothing but what a subcommand has. Before subcommands are added.
void PrepareApp(CLI::App* app);

// The arguments of the program with "--config FILE" first, wherever it stood: it is the program's
// own and may follow the subcommand as all other common flags do.
std::vector<std::string> ArgumentsOf(int argc, char** argv);

// What is wrong with the arguments, in one line: the subcommand, option or key of a configuration
// file that is not known, with the nearest one that is; else what CLI11 says.
std::string Diagnosis(const CLI::App& app, const std::vector<std::string>& arguments,
                      const CLI::ParseError& error);

// Prints help, or "error: DIAGNOSIS" on stderr. Returns the exit code, 0 or kWrongUsage.
int ReportUsage(const CLI::App& app, const std::vector<std::string>& arguments,
                const CLI::ParseError& error);

// Of a text that is one of `names`: help lists them.
CLI::Option* AddChoice(CLI::App* command, const std::string& option,
                       const std::vector<std::string>& names, const std::string& usual,
                       const std::string& description,
                       const std::function<void(const std::string&)>& take);

}  // namespace simwright::cli
