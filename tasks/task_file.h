#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tasks/task.h"

namespace simwright::tasks {

// The set as the text of a tasks.json (docs/formats.md). Paths of assets are written relative to
// `folder`, where the file will lie, when they lie below it or below the folder above it; others
// are absolute. The same set and folder give the same bytes. Throws core::Error, naming the place,
// where a number is not finite.
std::string TaskFileText(const TaskSet& set, const std::filesystem::path& folder);

// The set that `text` holds; relative paths are taken from `folder`. Strict: throws core::Error
// "WHERE: tasks[3].subtasks[0].program: ..." at the first thing that is missing, unknown or of
// another type, at names that are double or name no asset, at a rotation that is none, and at a
// file of another format number. `where` names the file.
TaskSet ReadTaskFileText(std::string_view text, const std::string& where,
                         const std::filesystem::path& folder);

// Writes the file whole or not at all. Throws core::Error as TaskFileText and core::WriteFile do.
void WriteTaskFile(const TaskSet& set, const std::filesystem::path& file);

// Throws core::Error where the file is missing, over 64 MiB, or not as ReadTaskFileText wants it.
TaskSet ReadTaskFile(const std::filesystem::path& file);

}  // namespace simwright::tasks
