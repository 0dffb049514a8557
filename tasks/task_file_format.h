#pragma once

#include <cstdint>

// The constants that the writer and the reader of tasks.json share.
namespace simwright::tasks::task_file {

inline constexpr int kFormat = 1;
inline constexpr std::uint64_t kLargest = 64u << 20;  // bytes

}  // namespace simwright::tasks::task_file
