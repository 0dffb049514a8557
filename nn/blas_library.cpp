#include "nn/blas_library.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

namespace simwright::nn {

std::string BlasLibrary() {
  void* product = dlsym(RTLD_DEFAULT, "sgemm_");
  Dl_info info;
  if (product == nullptr || dladdr(product, &info) == 0 || info.dli_fname == nullptr) return "";
  // Debian's libblas.so.3 is a link to the chosen library.
  std::error_code missing;
  const std::filesystem::path file = std::filesystem::canonical(info.dli_fname, missing);
  return missing ? info.dli_fname : file.string();
}

}  // namespace simwright::nn
