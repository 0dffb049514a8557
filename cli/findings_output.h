#pragma once

#include <string>

#include "cli/command.h"
#include "core/finding.h"
#include "core/json.h"

namespace simwright::cli {

// Returns the line width of stderr, in characters, if it is a terminal, else 0: output to a file or
// a pipe is not wrapped, so that it can be searched.
std::size_t LineWidth();

// Prints an error on stderr; with --json, also as the result. A rank other than the first prints
// "rank 3: " before it, and nothing where it is ended within a moment: an error of all ranks is
// then printed once, because mpirun ends the other ranks after the first one's error.
void PrintError(const core::Finding& error, bool json);

// Prints findings as core::FindingText on stderr, as every command does, so that stdout has only
// its result. With --quiet only errors are printed; with --json none, because the JSON has them.
void PrintFindings(const core::Findings& findings, const CommonOptions& common);

// Prints findings without those of severity kInfo, which it counts in `notes`; for the findings of
// many assets at once.
void PrintWarnings(const core::Findings& findings, const CommonOptions& common, int* notes);

// Prints a command's --json result on stdout: one object with the array `findings`.
void PrintJson(core::OrderedJson object, const core::Findings& findings);
// Prints the text of a JSON object likewise.
void PrintJson(const std::string& object, const core::Findings& findings);

}  // namespace simwright::cli
