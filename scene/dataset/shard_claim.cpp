#include "scene/dataset/shard_claim.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"

namespace simwright::scene {

ShardClaim::ShardClaim(const std::filesystem::path& part) : path_(part.string() + ".lock") {
  for (;;) {
    file_ = open(path_.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (file_ < 0) throw core::Error("cannot lock the shard", path_.string());
    if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
      close(file_);
      file_ = -1;
      return;
    }
    // The previous owner may have removed the file between the two calls: then the lock is on a
    // file that no other worker can find.
    struct stat held, named;
    const bool same = fstat(file_, &held) == 0 && stat(path_.c_str(), &named) == 0 &&
                      held.st_ino == named.st_ino && held.st_dev == named.st_dev;
    if (same) return;
    close(file_);
  }
}

ShardClaim::~ShardClaim() {
  if (file_ < 0) return;
  unlink(path_.c_str());
  close(file_);
}

}  // namespace simwright::scene
