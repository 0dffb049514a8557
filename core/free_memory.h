#pragma once

namespace simwright::core {

// Returns freed memory to the operating system, at most once a second. Between the items of long
// work: glibc keeps what lies below a block that is still in use, and grew to gigabytes over
// hundreds of assets of which 94 MB were in use. Thread-safe; without effect in other C libraries.
void ReturnFreeMemory();

}  // namespace simwright::core
