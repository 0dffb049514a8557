#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "viewer/content.h"

namespace simwright::viewer {

// A version of the content that was read without a fault.
struct ContentVersion {
  std::int64_t number = 0;  // from 1
  std::shared_ptr<Content> content;
};

// The content of files that may change while they are shown. A change is read by the next call of
// Refresh; where it cannot be read, as with a file that is half written, the last good version
// stays and `fault` says why. Thread-safe.
class LiveContent {
 public:
  // Reads the first version. Throws core::Error.
  explicit LiveContent(ContentSource source);

  // Reads the content again if its files have changed and have then stayed unchanged for
  // `quiet_seconds`, so that a program that is writing may finish.
  void Refresh(double quiet_seconds = 0.3);

  ContentVersion Current() const;
  // Returns a version that pages may still show: the current one or the one before, else null.
  std::shared_ptr<Content> Version(std::int64_t number) const;
  // Returns the fault of the last reading; empty if there was none.
  std::string fault() const;

 private:
  using Clock = std::chrono::steady_clock;

  ContentSource source_;
  std::mutex reading_;  // held while the files are read, by one thread at a time
  mutable std::mutex mutex_;
  std::string read_;     // fingerprint at the last reading
  std::string changed_;  // fingerprint seen since
  Clock::time_point changed_at_;
  ContentVersion current_, previous_;
  std::string fault_;
};

}  // namespace simwright::viewer
