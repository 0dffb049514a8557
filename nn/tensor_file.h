#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "nn/torch.h"

namespace simwright::nn {

// Tensors by name. In a file they are a pickled dictionary, which Python's torch.load reads too;
// libtorch's own archives turn names into code and trip over some.
using NamedTensors = std::map<std::string, torch::Tensor>;

// Written beside `path` and renamed in. Throws core::Error.
void WriteTensors(const NamedTensors& tensors, const std::filesystem::path& path);

// Throws core::Error: missing, or no such file.
NamedTensors ReadTensors(const std::filesystem::path& path);

// The module's parameters and buffers, `prefix` before each name.
void CollectTensors(const torch::nn::Module& module, const std::string& prefix,
                    NamedTensors* tensors);
// ... and back into the module. Returns the first name that is missing or of another shape, in
// which case the module is changed in part; empty where all is well.
std::string RestoreTensors(const NamedTensors& tensors, const std::string& prefix,
                           torch::nn::Module* module);

}  // namespace simwright::nn
