#pragma once

#include <gtest/gtest.h>

// Skips a test that takes minutes under the sanitizers, where faster tests run the same code.
#ifdef SIMWRIGHT_SANITIZED
#define SKIP_UNDER_SANITIZERS() GTEST_SKIP() << "slow under sanitizers; faster tests run this code"
#else
#define SKIP_UNDER_SANITIZERS() static_cast<void>(0)
#endif
