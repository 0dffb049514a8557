#pragma once

#include <filesystem>

namespace simwright::scene {

// Who makes a part, among workers that share a folder: one that holds the lock of "FILE.lock".
// A worker that dies lets go of it; the lock's file may be left, and is taken over.
class PartClaim {
 public:
  // Throws core::Error where the lock's file cannot be made.
  explicit PartClaim(const std::filesystem::path& part);
  ~PartClaim();
  PartClaim(const PartClaim&) = delete;
  PartClaim& operator=(const PartClaim&) = delete;

  // False where another worker has it.
  bool held() const { return file_ >= 0; }

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace simwright::scene
