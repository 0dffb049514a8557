#pragma once

// Precompiled for the test programs that use libtorch.
#include "cmake/precompiled/torch.h"

#include <gtest/gtest.h>
