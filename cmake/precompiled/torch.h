#pragma once

// Precompiled for the modules that use libtorch, which takes 10 to 20 s per file to parse.
#include "cmake/precompiled/standard.h"
#include "nn/torch.h"
