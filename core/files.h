#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace simwright::core {

// The whole file. Throws core::Error when it is missing, no regular file, or over `limit` bytes.
std::string ReadFile(const std::filesystem::path& path, std::uint64_t limit = 2ull << 30);

// Writes beside `path` and renames in: afterwards the file holds all of `bytes`, or what it held
// before. Throws core::Error (a full disk, a folder that is missing or not writable).
void WriteFile(const std::filesystem::path& path, std::string_view bytes);

// An output file that a library writes by its name. It is written at `staging()`, a hidden sibling;
// `Commit` renames it into place. Destroyed before that, nothing is left behind.
class StagedFile {
 public:
  explicit StagedFile(const std::filesystem::path& target);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  const std::filesystem::path& staging() const { return staging_; }
  // Throws core::Error where the file cannot be moved. The library must have closed it.
  void Commit();

 private:
  std::filesystem::path target_, staging_;
};

// `relative` below `root`, following links. Throws core::Error when it leads outside `root`.
// The file need not exist.
std::filesystem::path ResolveInside(const std::filesystem::path& root,
                                    const std::filesystem::path& relative);

// An output folder that appears whole or not at all. Files are written into `staging()`, a hidden
// sibling; `Commit` renames it into place. Destroyed before that, nothing is left behind.
class StagedFolder {
 public:
  // Throws core::Error when `target` exists and `force` is not set, or its parent (created where
  // missing) cannot be written.
  StagedFolder(const std::filesystem::path& target, bool force);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& staging() const { return staging_; }
  // Moves the folder into place; an older one (force) is removed only after that.
  void Commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::filesystem::path created_parent_;  // topmost folder that had to be made, or empty
  bool force_;
  bool committed_ = false;
};

// Removes what writers above left in `folder` and below when the program was killed. Nobody else
// may be writing there.
void RemoveHalfWritten(const std::filesystem::path& folder);

// A new folder below the system's temporary one that is gone when this is.
class TemporaryFolder {
 public:
  TemporaryFolder();  // throws core::Error where none can be made
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace simwright::core
