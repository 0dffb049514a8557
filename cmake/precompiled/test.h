#pragma once

// Precompiled for the test programs.
#include "cmake/precompiled/standard.h"

#include <gtest/gtest.h>
