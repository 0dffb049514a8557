#include "viewer/live_content.h"

#include <exception>
#include <utility>

#include "core/error.h"

namespace simwright::viewer {

LiveContent::LiveContent(ContentSource source) : source_(std::move(source)) {
  read_ = source_.fingerprint();
  current_ = {1, source_.read()};
}

void LiveContent::Refresh(double quiet_seconds) {
  const std::unique_lock reading(reading_, std::try_to_lock);
  if (!reading.owns_lock()) return;  // another request is at it
  const std::string now = source_.fingerprint();
  {
    const std::lock_guard lock(mutex_);
    if (now == read_) {
      changed_.clear();
      return;
    }
    const auto time = Clock::now();
    if (now != changed_) {
      changed_ = now;
      changed_at_ = time;
    }
    if (std::chrono::duration<double>(time - changed_at_).count() < quiet_seconds) return;
  }
  std::shared_ptr<Content> content;
  std::string fault;
  try {
    content = source_.read();
  } catch (const core::Cancelled&) {
    return;
  } catch (const std::exception& error) {
    fault = error.what();
  }
  const std::lock_guard lock(mutex_);
  read_ = now;
  changed_.clear();
  fault_ = fault;
  if (!content) return;
  previous_ = std::exchange(current_, {current_.number + 1, std::move(content)});
}

ContentVersion LiveContent::Current() const {
  const std::lock_guard lock(mutex_);
  return current_;
}

std::shared_ptr<Content> LiveContent::Version(std::int64_t number) const {
  const std::lock_guard lock(mutex_);
  if (number == current_.number) return current_.content;
  if (number == previous_.number) return previous_.content;
  return nullptr;
}

std::string LiveContent::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

}  // namespace simwright::viewer
