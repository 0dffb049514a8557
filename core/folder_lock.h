#pragma once

#include <filesystem>
#include <string>

namespace simwright::core {

// Keeps a folder for this process: a lock on FOLDER/.lock (flock) that the system lets go of when
// the process ends, however it does, so that a crash leaves nothing behind that is in the way. The
// file stays and says who held it last. Where the file system knows no locks (some network ones)
// nothing is kept.
class FolderLock {
 public:
  // Makes the folder where it is missing. `work` is what is done in it, as "a training". Throws
  // core::Error where another process has it, naming that, or the folder cannot be written.
  FolderLock(const std::filesystem::path& folder, const std::string& work);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace simwright::core
