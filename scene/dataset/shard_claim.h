#pragma once

#include <filesystem>

namespace simwright::scene {

// The claim of one worker on a shard, among workers that share a folder: a lock on "FILE.lock". A
// worker that dies releases it; a lock file that is left behind can be claimed again.
class ShardClaim {
 public:
  // Throws core::Error if the lock file cannot be created.
  explicit ShardClaim(const std::filesystem::path& part);
  ~ShardClaim();
  ShardClaim(const ShardClaim&) = delete;
  ShardClaim& operator=(const ShardClaim&) = delete;

  // Returns false if another worker holds the claim.
  bool held() const { return file_ >= 0; }

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace simwright::scene
