#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace simwright::core {

// Returns the whole file. Throws core::Error if it is missing, not a regular file, or larger than
// `limit` bytes.
std::string ReadFile(const std::filesystem::path& path, std::uint64_t limit = 2ull << 30);

// Writes to a sibling of `path` and renames it: afterwards the file holds either all of `bytes` or
// its former content. Throws core::Error (disk full, folder missing or not writable).
void WriteFile(const std::filesystem::path& path, std::string_view bytes);

// An output file that a library writes by name. It is written at `staging()`, a hidden sibling, and
// `Commit` renames it into place. If destroyed before `Commit`, it leaves nothing behind.
class StagedFile {
 public:
  explicit StagedFile(const std::filesystem::path& target);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  const std::filesystem::path& staging() const { return staging_; }
  // Moves the file into place; the library must have closed it. Throws core::Error on failure.
  void Commit();

 private:
  std::filesystem::path target_, staging_;
};

// Resolves `relative` below `root`, following links. Throws core::Error if it leads outside `root`.
// The file need not exist.
std::filesystem::path ResolveInside(const std::filesystem::path& root,
                                    const std::filesystem::path& relative);

// Throws core::Error if `folder` can be no output of ours that may be replaced: if it is a
// repository or the current or home folder, or contains one of these two.
void RequireReplaceable(const std::filesystem::path& folder);

// An output folder that appears complete or not at all. Files are written into `staging()`, a
// hidden sibling, and `Commit` renames it into place. If destroyed before `Commit`, it leaves
// nothing behind.
class StagedFolder {
 public:
  // Throws core::Error if `target` exists and `force` is not set, as RequireReplaceable does, or if
  // its parent (created if missing) is not writable.
  StagedFolder(const std::filesystem::path& target, bool force);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& staging() const { return staging_; }
  // Moves the folder into place; the folder that it replaces (`force`) is removed only afterwards.
  void Commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::filesystem::path created_parent_;  // topmost folder that had to be created, or empty
  bool force_;
  bool committed_ = false;
};

// Removes the staging files and folders that a killed program left in `folder` and below. No other
// process may be writing there.
void RemoveStagingLeftovers(const std::filesystem::path& folder);

// A new folder below the system's temporary folder; the destructor deletes it.
class TemporaryFolder {
 public:
  TemporaryFolder();  // throws core::Error if the folder cannot be created
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace simwright::core
