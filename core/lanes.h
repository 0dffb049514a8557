#pragma once

#include <cstring>

// Compiles a function for AVX2 too; the program's start chooses. GCC's sanitizers and Clang's for
// threads do without.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SIMWRIGHT_THREAD_SANITIZER
#endif
#endif
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(SIMWRIGHT_THREAD_SANITIZER)
#define SIMWRIGHT_WIDEST_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define SIMWRIGHT_WIDEST_VECTORS
#endif

namespace simwright::core {

constexpr int kLanes = 4;

// Four numbers at once: one AVX register, or two of SSE. Sums have the same order in both, and
// products and sums are not contracted, so that results do not depend on the processor.
// The attributes precede the type, since Clang ignores `aligned` behind it.
using Lanes __attribute__((vector_size(kLanes * sizeof(double)), aligned(8), may_alias)) = double;
static_assert(alignof(Lanes) == alignof(double), "rows of numbers start at any double");

// Both work at any double, also where Clang drops the alignment of Lanes: from deduced types.
__attribute__((always_inline)) inline void LoadLanes(const double* from, Lanes* to) {
  std::memcpy(to, from, sizeof(Lanes));
}

__attribute__((always_inline)) inline void StoreLanes(const Lanes& from, double* to) {
  std::memcpy(to, &from, sizeof(Lanes));
}

}  // namespace simwright::core
