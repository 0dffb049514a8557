#pragma once

#include <string_view>

#include "core/progress.h"
#include "llm/retry_schedule.h"
#include "workflows/generator/generator_options.h"

namespace simwright::workflows {

// Posts a photo to the server `options.url` and returns the mesh that it generates. Connections
// that fail or break, status 429 and 5xx are retried with growing waits or as Retry-After says; a
// task is polled until it is complete; the address of a mesh is fetched. The key is sent to the
// scheme, host and port of `options.url` only, and appears in no error, finding or log. Throws
// core::Error for a refusal, an answer that is no mesh, one beyond max_answer_bytes (the transfer
// is stopped), and beyond the timeout; throws core::Cancelled if `clock` is cancelled.
GeneratedMesh AskGeneratorServer(std::string_view png, const GeneratorOptions& options,
                                 core::Progress* progress, llm::Clock& clock = llm::SystemClock());

// Throws core::Error unless the options name a server by a valid address or a command with {in} and
// {out}, not both, and the timeout and the names of fields are valid.
void Validate(const GeneratorOptions& options);

}  // namespace simwright::workflows
