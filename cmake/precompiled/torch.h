#pragma once

// Precompiled for the modules that use libtorch: parsing it takes 10 to 20 s a file.
#include "nn/torch.h"
#include "cmake/precompiled/standard.h"
