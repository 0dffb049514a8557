#pragma once

#include <functional>

namespace simwright::core {

// Returns the number of threads for long work, >= 1: `--threads`, by default all that this process
// may use, of which the ranks on one machine (core/ranks.h) get equal shares.
int ThreadCount();
void SetThreadCount(int count);  // count <= 0: the default

// Calls body(i) once for each i in [0, count), from up to ThreadCount() threads, and waits. Indices
// are handed out in ascending order. The first exception is rethrown here after all threads have
// stopped. Nested calls run on the calling thread alone.
void ParallelFor(int count, const std::function<void(int)>& body);

}  // namespace simwright::core
