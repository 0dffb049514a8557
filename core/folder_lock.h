#pragma once

#include <filesystem>
#include <string>

namespace simwright::core {

// Locks a folder for this process through flock on FOLDER/.lock. The system releases the lock when
// the process ends, even by a crash, so no stale lock blocks the next run. The file stays and names
// its last holder. On file systems without locks (some network ones) nothing is locked.
class FolderLock {
 public:
  // Creates the folder if it is missing. `work` names the activity, such as "a training". Throws
  // core::Error if another process holds the lock, naming that process, or the folder is not
  // writable.
  FolderLock(const std::filesystem::path& folder, const std::string& work);
  // Removes the folder where the constructor created it and nothing else was written there, so that
  // work that is stopped early leaves no empty folder.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  int file_ = -1;
  bool created_ = false;
};

}  // namespace simwright::core
