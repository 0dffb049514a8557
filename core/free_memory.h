#pragma once

namespace simwright::core {

// Returns freed memory to the operating system, at most once a second. Long work calls it between
// its items: glibc keeps what lies below a block that is still in use, so that a process with 94 MB
// in use held 1.3 GB after 134 assets. Thread-safe; without effect in other C libraries.
void ReturnFreeMemory();

}  // namespace simwright::core
