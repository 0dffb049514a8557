#include "core/free_memory.h"

#include <atomic>
#include <chrono>
#include <cstdint>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace simwright::core {

void ReturnFreeMemory() {
  static std::atomic<std::int64_t> last{0};
  const std::int64_t now = std::chrono::duration_cast<std::chrono::seconds>(
                               std::chrono::steady_clock::now().time_since_epoch())
                               .count();
  std::int64_t before = last.load();
  if (now == before || !last.compare_exchange_strong(before, now)) return;
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace simwright::core
