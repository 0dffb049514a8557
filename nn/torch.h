#pragma once

// libtorch's one door. Clang in C++20 refuses <torch/torch.h> unless the header before it comes
// first. 10 s a file: from .cpp files, and from the headers of nn/ that declare network modules.
// clang-format off
#include <ATen/core/ivalue.h>
#include <torch/torch.h>
// clang-format on
