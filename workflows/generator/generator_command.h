#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "workflows/generator/generator_options.h"

namespace simwright::workflows {

// Splits a command into its program and arguments, and replaces {in} and {out} in each by the
// paths. Blanks separate arguments; '...' and "..." keep blanks; a backslash takes the next
// character literally, except inside '...'. Nothing else has a meaning, because no shell runs.
// Throws core::Error for an empty command, an open quote, and a command without {in} or {out}.
std::vector<std::string> GeneratorArguments(const std::string& command, const std::string& in,
                                            const std::string& out);

// Runs the program `options.command` on the photo and returns the mesh that it writes. Throws
// core::Error, with the last lines of its stderr, if it cannot be started, fails, takes longer than
// the timeout, or writes no file, one that is no mesh, or one beyond max_answer_bytes; throws
// core::Cancelled if `cancelled` returns true.
GeneratedMesh RunGeneratorCommand(std::string_view png, const GeneratorOptions& options,
                                  core::Progress* progress,
                                  const std::function<bool()>& cancelled = core::CancelRequested);

}  // namespace simwright::workflows
