#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "nn/torch.h"

namespace simwright::nn {

// Tensors by name. The file is a pickled dictionary, which Python's torch.load reads too;
// libtorch's own archives turn names into code and fail for some names.
using NamedTensors = std::map<std::string, torch::Tensor>;

// Writes to a sibling of `path` and renames it into place. Throws core::Error.
void WriteTensors(const NamedTensors& tensors, const std::filesystem::path& path);

// Reads tensors. Throws core::Error if the file is missing or of another format.
NamedTensors ReadTensors(const std::filesystem::path& path);

// Collects the module's parameters and buffers, with `prefix` before each name.
void CollectTensors(const torch::nn::Module& module, const std::string& prefix,
                    NamedTensors* tensors);
// Restores the module from `tensors`. Returns the first name that is missing or of another shape,
// in which case the module has partly changed; empty on success.
std::string RestoreTensors(const NamedTensors& tensors, const std::string& prefix,
                           torch::nn::Module* module);

}  // namespace simwright::nn
