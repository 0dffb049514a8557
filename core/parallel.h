#pragma once

#include <functional>

namespace simwright::core {

// Threads that long work may use: `--threads`, at the start all that the machine gives to this
// process. >= 1.
int ThreadCount();
void SetThreadCount(int count);  // count <= 0: as at the start

// Calls body(i) once for each i in [0, count), from up to ThreadCount() threads, and waits.
// Work is handed out in ascending order. The first exception is thrown again here after all
// threads have stopped. Calls from inside a body run on the calling thread alone.
void ParallelFor(int count, const std::function<void(int)>& body);

}  // namespace simwright::core
