#include "core/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace simwright::core {
namespace {

constexpr char kLockFile[] = ".lock";

// Returns true if the folder can be read and has no other entry than the lock's file.
bool HoldsLockOnly(const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::directory_iterator entry(folder, code);
  const std::filesystem::directory_iterator end;
  while (!code && entry != end) {
    if (entry->path().filename() != kLockFile) return false;
    entry.increment(code);
  }
  return !code;
}

// Returns the holder's process number; empty if the file states none.
std::string HolderOf(int file) {
  char text[24] = {};
  const ssize_t count = pread(file, text, sizeof(text) - 1, 0);
  const std::string holder(text, static_cast<size_t>(std::max<ssize_t>(count, 0)));
  const auto end = std::find_if_not(holder.begin(), holder.end(),
                                    [](unsigned char c) { return std::isdigit(c); });
  return std::string(holder.begin(), end);
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& work)
    : folder_(folder) {
  std::error_code code;
  created_ = std::filesystem::create_directories(folder, code);
  const std::filesystem::path path = folder / kLockFile;
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0) {
    throw Error(std::string("cannot be written: ") + std::strerror(errno), path.string(),
                "check that the folder exists and may be written");
  }
  int locked;
  do {
    locked = flock(file_, LOCK_EX | LOCK_NB);
  } while (locked != 0 && errno == EINTR);
  if (locked == 0) {
    const std::string holder = std::to_string(getpid()) + "\n";
    if (ftruncate(file_, 0) == 0 &&
        pwrite(file_, holder.data(), holder.size(), 0) == static_cast<ssize_t>(holder.size())) {
      return;
    }
    const std::string fault = std::strerror(errno);
    close(file_);
    throw Error("cannot be written: " + fault, path.string(), "free some disk space");
  }
  if (errno != EWOULDBLOCK) return;
  const std::string holder = HolderOf(file_);
  close(file_);
  throw Error(work + " is already running there" + (holder.empty() ? "" : ", process " + holder),
              folder.string(), "wait until it ends, or choose another folder");
}

FolderLock::~FolderLock() {
  if (created_ && HoldsLockOnly(folder_)) {
    std::error_code code;
    std::filesystem::remove_all(folder_, code);
  }
  close(file_);
}

}  // namespace simwright::core
