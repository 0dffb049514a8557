#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "cli/command.h"
#include "core/finding.h"

namespace simwright::cli {

// Characters of a line of stderr where it is a terminal, else 0: what goes to a file or a pipe is
// not broken, so that it can be searched.
std::size_t LineWidth();

// Findings as core::FindingText on stderr, where every command prints them, so that stdout is its
// result alone. With --quiet only errors; with --json none, since they are in the JSON.
void PrintFindings(const core::Findings& findings, const CommonOptions& common);

// The same without what is of severity kInfo, which `notes` counts: of many things at once.
void PrintWarnings(const core::Findings& findings, const CommonOptions& common, int* notes);

// Prints a command's result for --json on stdout: one object, with the array `findings`.
void PrintJson(nlohmann::ordered_json object, const core::Findings& findings);
// The same of an object's text.
void PrintJson(const std::string& object, const core::Findings& findings);

}  // namespace simwright::cli
