#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tasks/task.h"

namespace simwright::tasks {

// Returns the set as the text of a tasks.json (docs/formats.md). Asset paths are written relative
// to `folder`, the folder of the file, if they lie below it or below its parent; other paths are
// absolute. The same set and folder give the same bytes. Throws core::Error, naming the place, if a
// number is not finite.
std::string TaskFileText(const TaskSet& set, const std::filesystem::path& folder);

// Parses the set in `text`; relative paths are resolved against `folder`. The parser is strict: it
// throws core::Error "WHERE: tasks[3].subtasks[0].program: ..." at the first member that is
// missing, unknown or of the wrong type, at duplicate names or names of no asset, at an invalid
// rotation, and at a file of another format number. `where` names the file.
TaskSet ReadTaskFileText(std::string_view text, const std::string& where,
                         const std::filesystem::path& folder);

// Writes the file atomically. Throws core::Error as TaskFileText and core::WriteFile do.
void WriteTaskFile(const TaskSet& set, const std::filesystem::path& file);

// Reads a task file. Throws core::Error if the file is missing, over 64 MiB, or rejected by
// ReadTaskFileText.
TaskSet ReadTaskFile(const std::filesystem::path& file);

}  // namespace simwright::tasks
