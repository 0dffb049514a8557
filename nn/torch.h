#pragma once

// The only include of libtorch. Clang in C++20 refuses <torch/torch.h> unless <ATen/core/ivalue.h>
// comes first. It costs 10 s per file: include it from .cpp files, and from the headers of nn/ that
// declare network modules.
#include <ATen/core/ivalue.h>
#include <torch/torch.h>
// clang-format on
